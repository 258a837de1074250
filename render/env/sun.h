/* Suns: compact lights so strong that no region may hold them (FRONTIER, finding 3). They are taken out of
 * the cube, whose texels there become what surrounds them, and shadowed by rays or a map of their own. Pure.
 */
#ifndef TOILE_RENDER_ENV_SUN_H
#define TOILE_RENDER_ENV_SUN_H

#include "render/env/cube.h"

#define TL_SUNS_MAX        4
#define TL_SUN_SAMPLES_MAX 16

struct tl_sun {
    vec3s direction; /* unit, environment's frame: luminance-weighted centroid */
    vec3s power;     /* integral of its radiance over its solid angle, RGB: irradiance at normal incidence */
    float radius;    /* rad: of the disc of the same second moment */
    /* Directions of equal power inside it, for penumbrae; the first is nearest to `direction`. */
    int sample_count;
    vec3s samples[TL_SUN_SAMPLES_MAX];
};

struct tl_suns {
    int count;
    struct tl_sun items[TL_SUNS_MAX];
};

/* Finds the suns of `cube` and removes them from it. A sun is a connected patch, compact against the regions'
 * size, that holds a share of all light worth its own rays; what counts as such, and why, stands in sun.c. */
void tl_suns_take(tl_cube *cube, struct tl_suns *out);

#endif
