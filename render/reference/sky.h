/* The environment as the oracle sees it: every texel of its own layout is a patch of constant radiance, the
 * mean of what the texel stands for (the renderer's cubes are area averages of the same patches). Directions
 * are drawn from it with a density that follows the texels' brightness, a tenth of it uniform over the
 * sphere, along a curve that keeps neighbours together, so that an interval of the curve is a compact region.
 *
 * World space. Borrows the environment. Threads: pure once made. */
#ifndef TOILE_RENDER_REFERENCE_SKY_H
#define TOILE_RENDER_REFERENCE_SKY_H

#include "assets/environment.h"
#include "render/env/cube.h"

struct tl_sky {
    const tl_environment *environment;
    float turn_cos, turn_sin; /* of the yaw */
    double brightness;        /* mean of the channels, integrated over the sphere */
    double *row_angles;       /* lat-long: solid angle of a row's texels, sr */
    size_t texel_count;
    uint32_t *order; /* texels along the curve */
    double *before;  /* share of all draws that fall before place i of the curve; texel_count + 1 numbers */
    uint32_t *guide; /* place of the curve where share i / TL_SKY_GUIDES lies; TL_SKY_GUIDES + 1 numbers */
};
#define TL_SKY_GUIDES 65536

/* What is seen in a direction. */
struct tl_sky_sample {
    vec3s direction; /* unit */
    vec3s radiance;
    float density; /* of a draw over the whole curve, per sr */
};

void tl_sky_make(const tl_environment *environment, float yaw, struct tl_sky *out);
void tl_sky_release(struct tl_sky *sky);

/* The direction at `share` of the curve, [0, 1), which goes on inside the texels. */
struct tl_sky_sample tl_sky_sample_at(const struct tl_sky *sky, double share);
struct tl_sky_sample tl_sky_lookup(const struct tl_sky *sky, vec3s direction);

#endif
