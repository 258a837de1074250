/* The light that up to sixteen points send back, by rays: directions drawn from the environment, the same for
 * all, and from each of a point's glossy lobes, combined by the balance heuristic [Veach 1997, 9.2.2]. */
#ifndef TOILE_RENDER_REFERENCE_GATHER_H
#define TOILE_RENDER_REFERENCE_GATHER_H

#include "render/reference/random.h"
#include "render/reference/shading_point.h"

enum { TL_SHADING_POINTS = 16 };

/* As struct tl_shading_point; by axis or channel, then by spot. */
struct tl_shading_points {
    int count;
    float point[3][TL_SHADING_POINTS], horizon[3][TL_SHADING_POINTS], normal[3][TL_SHADING_POINTS],
        axis[3][TL_SHADING_POINTS];
    float exponent[TL_SHADING_POINTS];
    float diffuse[3][TL_SHADING_POINTS], glossy[3][TL_SHADING_POINTS];
    /* Of those that have any, by spot. */
    bool any_layered, layered[TL_SHADING_POINTS];
    struct tl_shading_layers layers[TL_SHADING_POINTS];
    vec3s viewer[TL_SHADING_POINTS];
};

void tl_shading_points_add(struct tl_shading_points *spots, const struct tl_shading_point *spot);

/* `count` directions from as many strata of the environment's curve. Every stratum is parted again among
 * `slots` calls with the same `shared` numbers, of which this is number `slot`. */
void tl_gather_sample_sky(const struct tl_sky *sky, int count, int slot, int slots, struct tl_random shared,
                          struct tl_random own, struct tl_sky_sample *out);

struct tl_gather_request {
    const struct tl_reference_scene *scene;
    int strata;
    const struct tl_sky_sample *sky; /* one direction from each stratum */
    int lobe_samples;                /* directions from the lobe */
    bool reflect;                    /* near mirrors see the directly lit scene */
    struct tl_random random;
};

/* Radiance towards the viewer by channel, then by spot. Returns how many rays it took. */
size_t tl_gather(const struct tl_gather_request *asked, const struct tl_shading_points *spots,
                 float light[3][TL_SHADING_POINTS]);

#endif
