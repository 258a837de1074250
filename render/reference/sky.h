/* The environment as the reference renderer samples it. Every texel of its own layout is a patch of constant
 * radiance, the mean of the light that it stands for (the renderer's cubes are area averages of the same
 * patches). Directions are importance sampled: 0.9 of the pdf follows the brightness of the texels and 0.1 is
 * uniform over the sphere. The texels lie along a Hilbert curve, so that an interval of the curve is a
 * compact region and strata of the curve are strata of the sphere.
 *
 * World space. Borrows the environment. Threads: pure once made. */
#ifndef TOILE_RENDER_REFERENCE_SKY_H
#define TOILE_RENDER_REFERENCE_SKY_H

#include "assets/environment/environment.h"
#include "render/env/cube.h"

struct tl_sky {
    const tl_environment *environment;
    float turn_cos, turn_sin; /* of the yaw */
    double brightness;        /* mean of the channels, integrated over the sphere */
    double *row_angles;       /* lat-long: solid angle of a row's texels, sr */
    size_t texel_count;
    uint32_t *order; /* texels along the curve */
    double *before;  /* cumulative distribution: probability of the texels before place i of the curve;
                        texel_count + 1 numbers */
    uint32_t *guide; /* place of the curve where the distribution reaches i / TL_SKY_GUIDES; TL_SKY_GUIDES + 1
                        numbers */
};
#define TL_SKY_GUIDES 65536

/* The radiance in a direction. */
struct tl_sky_sample {
    vec3s direction; /* unit */
    vec3s radiance;
    float pdf; /* of a sample of the whole curve, per sr */
};

/* Builds the tables of an environment that is turned by `yaw` (rad). Released by tl_sky_release. */
void tl_sky_make(const tl_environment *environment, float yaw, struct tl_sky *out);
void tl_sky_release(struct tl_sky *sky);

/* Samples the sky: the direction where the cumulative distribution is `share`, in [0, 1). The curve continues
 * inside the texels. */
struct tl_sky_sample tl_sky_sample_at(const struct tl_sky *sky, double share);
/* Radiance and pdf in a given unit direction. */
struct tl_sky_sample tl_sky_lookup(const struct tl_sky *sky, vec3s direction);

#endif
