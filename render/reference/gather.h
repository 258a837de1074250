/* Light from the environment that up to sixteen shading points reflect, by ray tracing with multiple
 * importance sampling:
 * directions sampled from the environment, the same for all points, and directions sampled from each glossy
 * lobe of a point, combined by the balance heuristic [Veach 1997, 9.2.2]. Pure; threads: any. */
#ifndef TOILE_RENDER_REFERENCE_GATHER_H
#define TOILE_RENDER_REFERENCE_GATHER_H

#include "render/reference/random.h"
#include "render/reference/shading_point.h"

enum { TL_SHADING_POINTS = 16 };

/* A batch of struct tl_shading_point as a structure of arrays: by axis or channel, then by point. */
struct tl_shading_points {
    int count;
    float point[3][TL_SHADING_POINTS], horizon[3][TL_SHADING_POINTS], normal[3][TL_SHADING_POINTS],
        axis[3][TL_SHADING_POINTS];
    float exponent[TL_SHADING_POINTS];
    float diffuse[3][TL_SHADING_POINTS], glossy[3][TL_SHADING_POINTS];
    /* Layers of the points that have them, by point. */
    bool any_layered, layered[TL_SHADING_POINTS];
    struct tl_shading_layers layers[TL_SHADING_POINTS];
    vec3s viewer[TL_SHADING_POINTS];
};

/* A vector of point i. */
static inline vec3s tl_shading_lane(const float vectors[3][TL_SHADING_POINTS], int i)
{
    return (vec3s){{vectors[0][i], vectors[1][i], vectors[2][i]}};
}

/* Appends a point; there must be fewer than TL_SHADING_POINTS. */
void tl_shading_points_add(struct tl_shading_points *points, const struct tl_shading_point *point);

/* Samples `count` directions from as many strata of the sky's curve. Every stratum is divided further among
 * `slots` calls with the same random numbers `shared`; this call is number `slot`. */
void tl_gather_sample_sky(const struct tl_sky *sky, int count, int slot, int slots, struct tl_random shared,
                          struct tl_random own, struct tl_sky_sample *out);

struct tl_gather_request {
    const struct tl_reference_scene *scene;
    int strata;
    const struct tl_sky_sample *sky; /* one sample from each stratum */
    int lobe_samples;                /* number of directions sampled from each lobe */
    struct tl_random random;
};

/* Adds up the radiance towards the viewer, light[channel][point]. Returns the number of rays traced. Results
 * are finite. */
size_t tl_gather(const struct tl_gather_request *request, const struct tl_shading_points *points,
                 float light[3][TL_SHADING_POINTS]);

#endif
