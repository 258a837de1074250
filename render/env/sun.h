/* Suns: compact lights so strong that no region may hold them (FRONTIER, finding 3). They are taken out of
 * the cube, whose texels there become what surrounds them, and shadowed by rays or a map of their own. Pure.
 */
#ifndef TOILE_RENDER_ENV_SUN_H
#define TOILE_RENDER_ENV_SUN_H

#include "assets/environment.h"
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

/* Finds the suns of `cube` and removes them from it: the light of cube and suns together is what it was. A
 * sun is a connected patch, compact against the regions' size, that holds a share of all light worth its own
 * rays; what counts as such, and why, stands in sun.c. How much light it holds is the cube's; where within
 * the patch it comes from is read from `environment`, of which the cube was made and whose texels may be
 * finer. */
void tl_suns_extract(tl_cube *cube, const tl_environment *environment, struct tl_suns *out);

#endif
