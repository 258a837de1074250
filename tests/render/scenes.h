/* Shared scenes for the tests of the renderer: surfaces, environments, lamps, cameras, settings, and a GL
 * device. Every function fails the running test when what it calls fails. Not for threads. */
#ifndef TOILE_TESTS_RENDER_SCENES_H
#define TOILE_TESTS_RENDER_SCENES_H

#include "render/renderer.h"

/* A surface that owns its arrays. */
struct test_shape {
    tl_surface surface; /* points into this struct's arrays */
    tl_mesh mesh;
    tl_material material;
    struct tl_light_mesh light_mesh; /* empty: light is computed at all vertices */
};
void test_shape_release(struct test_shape *shape);
/* Rebuilds `surface` after `mesh` or `material` was edited in place or the struct was moved; new revisions.
 */
void test_shape_refresh(struct test_shape *shape);

/* Builders, in metres. Normals are analytic; the tangent runs along u, the bitangent along minus v. */
struct test_shape test_sphere(vec3s centre, float radius, int segments);
/* (2 half)^2 square with normal `normal` about `centre`, `cells` x `cells` quads; u along `right`. */
struct test_shape test_square(vec3s centre, vec3s right, vec3s normal, float half, int cells);
/* A draped sheet: y = height + amplitude sin(k x) cos(k z) over a square. */
struct test_shape test_sheet(float height, float half, float amplitude, float waves, int cells);
/* Numbers the vertices of a sheet or square of so many cells, an even number, as those of cloth that is drawn
 * smoothly: one in four is its own, the others follow and lie on edges between two of these. */
void test_shape_split(struct test_shape *shape, int cells);

/* Radiance as a function of direction; a few that several tests share. */
typedef vec3s test_radiance(vec3s direction);
test_radiance test_black, test_white;
test_radiance test_daylight; /* a blue gradient with a sun of 8 degrees radius */

/* A lat-long environment from a function of direction. */
tl_environment test_environment(int width, int height, test_radiance *radiance);

/* Paper settings with small sizes; no ground. */
struct tl_render_settings test_settings(int width, int height);
/* A frame that looks from `eye` at `target`. Its environment revision is that of the newest test_environment.
 */
tl_frame test_frame(vec3s eye, vec3s target, float fov_deg, const tl_surface *surfaces, size_t count,
                    const tl_environment *environment);

/* Draws and reads back. */
tl_image test_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings);
const float *test_pixel(const tl_image *image, int x, int y);
/* Largest red value of an RGBA image. */
double test_brightest(const tl_image *image);

/* cmocka group setup and teardown: one headless context and renderer; teardown fails when GL logged a
 * message. Maps of environments are kept in a folder of this process, so that cases that share an environment
 * compute them once. */
struct test_device {
    tl_gpu *gpu;
    tl_renderer *renderer;
    char *cache; /* the folder */
};
int test_device_open(void **state);
int test_device_close(void **state);

/* A whole scene. The frame points into the struct, which must not be moved. Owns shapes, environment and
 * weave. */
#define TEST_SHAPES_MAX 3
struct test_scene {
    tl_environment environment;
    size_t shape_count;
    struct test_shape shapes[TEST_SHAPES_MAX];
    tl_surface surfaces[TEST_SHAPES_MAX]; /* those of the shapes */
    tl_weave weave;                       /* for a material to point at; empty: none */
    struct tl_lamp lamps[TL_LAMPS_MAX];   /* frame.lamp_count of them are lit */
    tl_frame frame;
    struct tl_render_settings settings;
};

/* An empty scene with test_settings(width, height). Takes over the environment. */
void test_scene_open(struct test_scene *scene, tl_environment environment, vec3s eye, vec3s target,
                     float fov_deg, int width, int height);
/* Regions shadowed by rays, as the presets have it: two lobes, jitter, suns apart; one sample a pixel. */
void test_scene_use_rays(struct test_scene *scene, int regions, int rounds);
/* Adds a shape and takes it over. Returns its material, for editing. */
tl_material *test_scene_add(struct test_scene *scene, struct test_shape shape);
/* Rebuilds all surfaces after shapes were edited in place. */
void test_scene_refresh(struct test_scene *scene);
void test_scene_close(struct test_scene *scene);
tl_image test_scene_draw(const struct test_scene *scene, tl_renderer *renderer);

/* A ball of radius 0.4 m under a waved sheet, above the ground; 48 x 32 pixels. */
void test_scene_open_ball_and_sheet(struct test_scene *scene, test_radiance *radiance);

/* One shape in the dark, lit by a directional lamp from the upper left without shadows and seen from
 * (0, 0.3, 2.5); one sample a pixel. Takes over the shape. */
void test_scene_open_lamplit(struct test_scene *scene, struct test_shape shape, int width, int height);
/* Lamps with a warm colour; red has `irradiance`. */
struct tl_lamp test_lamp_towards(vec3s direction, float irradiance);
struct tl_lamp test_lamp_at(vec3s position, float irradiance);

/* The scene lit by its lamps without shadows, on the CPU in full float: kd/pi cos + tl_brdf_gloss. */
tl_image test_scene_evaluate(const struct test_scene *scene);

/* Differences over pixels that both images cover with all their neighbours, so that outlines do not count. */
struct test_difference {
    double rel_rmse; /* root mean square difference / mean of the expected */
    double largest;  /* largest difference / peak of the expected */
    size_t pixels;
    double moved_rmse, moved_largest; /* of the expected and itself TEST_PLACE of a pixel aside, at most */
};
struct test_difference test_compare(const tl_image *drawn, const tl_image *expected);
/* Draws the scene and compares it with `expected`. */
struct test_difference test_scene_error(const struct test_scene *scene, tl_renderer *renderer,
                                        const tl_image *expected);

#endif
