/* Scenes under lamps for the tests of local lighting, and what the CPU says of them. */
#ifndef TOILE_TESTS_RENDER_LAMPLIGHT_H
#define TOILE_TESTS_RENDER_LAMPLIGHT_H

#include "tests/render/shapes.h"

#define LAMPLIT_SHAPES_MAX 3

/* Shapes in the dark but for lamps; unshadowed and one sample a pixel, to begin with. */
struct lamplit {
    tl_environment environment;
    size_t shape_count;
    struct test_shape shapes[LAMPLIT_SHAPES_MAX];
    tl_surface surfaces[LAMPLIT_SHAPES_MAX];
    struct tl_lamp lamps[TL_LAMPS_MAX];
    tl_frame frame;
    struct tl_render_settings settings;
};

/* Takes over the shape; seen from (0, 0.3, 2.5) under a directional lamp from the upper left. */
void lamplit_open(struct lamplit *scene, struct test_shape shape, int width, int height);
void lamplit_add(struct lamplit *scene, struct test_shape shape);
/* After shapes were edited in place. */
void lamplit_refresh(struct lamplit *scene);
void lamplit_close(struct lamplit *scene);

struct tl_lamp lamp_towards(vec3s direction, float irradiance);
struct tl_lamp lamp_at(vec3s position, float irradiance);

/* What every pixel's ray finds, lit by the lamps without shadows: kd/pi cos + tl_brdf_gloss, in full float.
 */
tl_image lamplit_evaluate(const struct lamplit *scene);
tl_image lamplit_draw(const struct lamplit *scene, tl_renderer *renderer);

/* Over pixels that both cover with all their neighbours, so that no outline's tie counts. */
struct lamplit_difference {
    double rel_rmse; /* root mean square difference / mean of the expected */
    double largest;  /* ... largest / its peak */
    size_t pixels;
};
struct lamplit_difference lamplit_compare(const tl_image *drawn, const tl_image *expected);
/* Draws, compares with `expected`, frees what was drawn. */
struct lamplit_difference lamplit_error(const struct lamplit *scene, tl_renderer *renderer,
                                        const tl_image *expected);

#endif
