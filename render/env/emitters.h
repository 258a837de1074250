/* The texels of a cube as point lights, ready to be seen through cosine lobes: what lobes.h and
 * pem/slices.h convolve from. Pure.
 *
 * Emitters follow a Z-order curve over each face, so that a run of them is compact: runs of up to
 * TL_EMITTER_BLOCK are skipped as one where a lobe does not reach. For wide lobes, neighbours are merged into
 * one emitter at their luminance-weighted centroid, which is exact to first order in the distance. */
#ifndef TOILE_RENDER_ENV_EMITTERS_H
#define TOILE_RENDER_ENV_EMITTERS_H

#include "render/env/cube.h"

#include "config/simd.h"

#define TL_EMITTER_BLOCK 16

typedef struct tl_emitter {
    vec3s direction; /* unit, environment's frame */
    vec3s power;     /* radiance x solid angle, summed over what was merged */
    float weight;    /* luminance of `power` */
    uint32_t code;   /* place on the curve: of 2^k x 2^k texels after k merges */
} tl_emitter;

struct tl_emitters {
    size_t count;
    tl_emitter *items;
    size_t block_count;
    uint32_t *first;            /* [block_count + 1] */
    float (*axes)[3][TL_LANES]; /* [blocks / TL_LANES, rounded up]: unit mean directions */
    float radius;               /* rad: no emitter is farther from its block's axis */
};

/* All texels of a cube along the curve; free() releases them. */
uint32_t *tl_emitters_order(int cube_size);
/* One emitter for each of `texels` [count], which follow the curve: [count], free() releases them.
 * `solid_angles` is [size][size], of the texels of any face. What is not finite or negative is taken as
 * black. */
tl_emitter *tl_emitters_collect(const tl_cube *cube, const float *solid_angles, const uint32_t *texels,
                                size_t count);
/* Those of `texels` that are not black, neighbours merged as far as lobes of exponent s allow with an error
 * below 0.2 % [test_lobes.c]. */
struct tl_emitters tl_emitters_merge(const tl_emitter *texels, size_t count, int cube_size, float exponent);
void tl_emitters_release(struct tl_emitters *emitters);

/* Sixteen neighbouring directions to look into, each with an exponent of its own. */
struct tl_gaze {
    float x[TL_LANES], y[TL_LANES], z[TL_LANES]; /* unit */
    float exponent[TL_LANES];
    vec3s axis;   /* unit: the middle of the sixteen */
    float radius; /* rad: none is farther from the axis */
};

/* Sets axis and radius, and the exponents with which a bilinear fetch of what is gathered has the first
 * moment of K_s: it widens a lobe by what texels of the target, `steps` (rad, root mean square of both axes)
 * apart, blur; and a texel of the source is no point. */
void tl_gaze_set(struct tl_gaze *gaze, const vec3s directions[TL_LANES], const float steps[TL_LANES], float s,
                 int cube_size);

/* The sum over all emitters of power x K_exponent(direction, emitter), RGB. */
void tl_emitters_gather(const struct tl_emitters *emitters, const struct tl_gaze *gaze,
                        float out[3][TL_LANES]);

#endif
