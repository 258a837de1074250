/* The texels of a cube as point emitters, convolved with cosine lobes; shared by env/lobes.h and
 * pem/slices.h. Pure; threads: any.
 *
 * Emitters follow a Z-order curve over each face, so that a run of them is compact and is skipped as a whole
 * where it lies outside of a lobe. For wide lobes neighbouring emitters are merged at their
 * luminance-weighted centroid. The extent of a texel, or of merged texels, is kept as a variance by which the
 * lobe is widened. So merging is exact to second order in the distance, except for the anisotropy of the
 * extent. */
#ifndef TOILE_RENDER_ENV_EMITTERS_H
#define TOILE_RENDER_ENV_EMITTERS_H

#include "render/env/cube.h"

#include "config/base/simd.h"

#include <math.h>

typedef struct tl_emitter {
    vec3s direction; /* unit, environment's frame */
    vec3s power;     /* radiance x solid angle, summed over merged texels */
    float weight;    /* luminance of `power` */
    float variance;  /* rad^2: of its light about `direction`, along one axis */
    uint32_t code;   /* position on the curve: of 2^k x 2^k texels after k merges */
} tl_emitter;

/* Directions of a block of neighbouring emitters. The unused lanes of a block hold NaN, which fails every
 * comparison with a cosine. */
struct tl_directions {
    float x[TL_LANES], y[TL_LANES], z[TL_LANES];
};
struct tl_emitter_block {
    struct tl_directions directions;
    float fall[TL_LANES]; /* decrease of the exponent for the emitter's variance, divided by (s + 1)(s + 2) */
    float power[TL_LANES][3];
};

/* Blocks of emitters, with a bounding cone for culling. */
struct tl_emitters {
    size_t count; /* number of blocks */
    struct tl_emitter_block *blocks;
    struct tl_directions *axes; /* [count / TL_LANES, rounded up]: axes of the blocks */
    float radius;               /* rad: largest angle between an emitter and the axis of its block */
};

/* The radiance of a texel; values that are negative or not finite count as black. */
static inline float tl_emitter_radiance(float value)
{
    return value > 0 && isfinite(value) ? value : 0;
}

/* All texels of a cube along the curve. The caller frees the array. */
uint32_t *tl_emitters_order(int cube_size);
/* One emitter for each of `texels` [count], which follow the curve. `solid_angles` is [size][size], of the
 * texels of any face. The caller frees the array. */
tl_emitter *tl_emitters_collect(const tl_cube *cube, const float *solid_angles, const uint32_t *texels,
                                size_t count);
/* The emitters of `texels` that are not black, with neighbours merged as far as lobes of exponent s allow
 * with an error below 0.2 % [test_emitters.c]. Released by tl_emitters_release. */
struct tl_emitters tl_emitters_merge(const tl_emitter *texels, size_t count, int cube_size, float exponent);
void tl_emitters_release(struct tl_emitters *emitters);

/* A packet of sixteen neighbouring lobes, each with its own exponent, which are convolved together. */
struct tl_lobe_packet {
    struct tl_directions directions; /* unit */
    float exponent[TL_LANES];
    vec3s axis;   /* unit: mean of the sixteen directions */
    float radius; /* rad: largest angle between a direction and the axis */
};

/* Sets all fields. The exponents are such that a bilinear fetch of the convolved values has the first moment
 * of K_s: they are raised to compensate the blur of target texels whose distance is `steps` (rad, root mean
 * square of both axes). */
void tl_lobe_packet_set(struct tl_lobe_packet *packet, const vec3s directions[TL_LANES],
                        const float steps[TL_LANES], float s);

/* The sum over all emitters of power x K_exponent(direction, emitter) for every lobe of the packet, RGB. */
void tl_emitters_convolve(const struct tl_emitters *emitters, const struct tl_lobe_packet *packet,
                          float out[3][TL_LANES]);

#endif
