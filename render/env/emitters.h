/* The texels of a cube as points of light, ready to be seen through cosine lobes: what lobes.h and
 * pem/slices.h convolve from. Pure.
 *
 * Emitters follow a Z-order curve over each face, so that a run of them is compact and can be skipped as one
 * where a lobe does not reach. For wide lobes neighbours are merged into one at their luminance-weighted
 * centroid. What a texel or several have of extent is kept as a variance, by which the lobe is widened; so
 * merging is exact to second order in the distance, but for its direction. */
#ifndef TOILE_RENDER_ENV_EMITTERS_H
#define TOILE_RENDER_ENV_EMITTERS_H

#include "render/env/cube.h"

#include "config/simd.h"

#include <math.h>

typedef struct tl_emitter {
    vec3s direction; /* unit, environment's frame */
    vec3s power;     /* radiance x solid angle, summed over what was merged */
    float weight;    /* luminance of `power` */
    float variance;  /* rad^2, along one axis, of its light about `direction` */
    uint32_t code;   /* place on the curve: of 2^k x 2^k texels after k merges */
} tl_emitter;

/* Neighbours. Directions of those that fill up a block are not numbers, and so above no cosine. */
struct tl_directions {
    float x[TL_LANES], y[TL_LANES], z[TL_LANES];
};
struct tl_emitter_block {
    struct tl_directions directions;
    float fall[TL_LANES]; /* of the exponent, for the emitter's variance, in parts of (s + 1)(s + 2) */
    float power[TL_LANES][3];
};

struct tl_emitters {
    size_t count; /* of blocks */
    struct tl_emitter_block *blocks;
    struct tl_directions *axes; /* [count / TL_LANES, rounded up]: middles of the blocks */
    float radius;               /* rad: no emitter is farther from its block's middle */
};

/* The light of a texel: what is not finite or negative is black. */
static inline float tl_emitter_radiance(float value)
{
    return value > 0 && isfinite(value) ? value : 0;
}

/* All texels of a cube along the curve; free() releases them. */
uint32_t *tl_emitters_order(int cube_size);
/* One emitter for each of `texels` [count], which follow the curve: [count], free() releases them.
 * `solid_angles` is [size][size], of the texels of any face. */
tl_emitter *tl_emitters_collect(const tl_cube *cube, const float *solid_angles, const uint32_t *texels,
                                size_t count);
/* Those of `texels` that are not black, neighbours merged as far as lobes of exponent s allow with an error
 * below 0.2 % [test_emitters.c]. */
struct tl_emitters tl_emitters_merge(const tl_emitter *texels, size_t count, int cube_size, float exponent);
void tl_emitters_release(struct tl_emitters *emitters);

/* Sixteen neighbouring directions to look into, each with an exponent of its own. */
struct tl_lobe_packet {
    struct tl_directions directions; /* unit */
    float exponent[TL_LANES];
    vec3s axis;   /* unit: the middle of the sixteen */
    float radius; /* rad: none is farther from the axis */
};

/* Sets all of it, with exponents such that a bilinear fetch of what is gathered has the first moment of K_s:
 * it widens lobes by what texels of the target, `steps` (rad, root mean square of both axes) apart, blur. */
void tl_lobe_packet_set(struct tl_lobe_packet *gaze, const vec3s directions[TL_LANES],
                        const float steps[TL_LANES], float s);

/* The sum over all emitters of power x K_exponent(direction, emitter), RGB. */
void tl_emitters_convolve(const struct tl_emitters *emitters, const struct tl_lobe_packet *gaze,
                          float out[3][TL_LANES]);

#endif
