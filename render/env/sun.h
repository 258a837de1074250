/* Suns: compact lights so strong that no region may hold them (docs/notes/visibility.md, 3). They are removed
 * from the cube, whose texels there get the colour of their surroundings, and are shadowed by their own rays
 * or shadow map. Pure; threads: any. */
#ifndef TOILE_RENDER_ENV_SUN_H
#define TOILE_RENDER_ENV_SUN_H

#include "assets/environment/environment.h"
#include "render/env/cube.h"

#define TL_SUNS_MAX        4
#define TL_SUN_SAMPLES_MAX 16

struct tl_sun {
    vec3s direction; /* unit, environment's frame: luminance-weighted centroid */
    vec3s power;     /* integral of its radiance over its solid angle, RGB: irradiance at normal incidence */
    float radius;    /* rad: of the disc with the same second moment */
    /* Directions of equal power inside the sun, for penumbrae. The first is the nearest to `direction`. */
    int sample_count;
    vec3s samples[TL_SUN_SAMPLES_MAX];
};

struct tl_suns {
    int count;
    struct tl_sun items[TL_SUNS_MAX];
};

/* Finds the suns of `cube` and removes them from it. Cube and suns together hold the same light as before. A
 * sun is a connected patch that is compact compared with the regions' size and holds enough of all light to
 * be worth its own rays; sun.c states the criteria and why. Its power is that of the cube; its distribution
 * within the patch is read from `environment`, from which the cube was made and whose texels may be finer. */
void tl_suns_extract(tl_cube *cube, const tl_environment *environment, struct tl_suns *out);

#endif
