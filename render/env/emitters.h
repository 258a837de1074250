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
    uint32_t *first; /* [block_count + 1] */
    float *axes;     /* [blocks / TL_LANES, rounded up][3][TL_LANES]: unit mean directions */
    float radius;    /* rad: no emitter is farther from its block's axis */
    float
        texel_variance; /* rad^2: mean square distance of a texel's points from its centre, along one axis */
};

/* The texels of region i go to out[i]; `labels` [6][size][size], or NULL for one region that is all. Black
 * texels are left out; of a texel that is not finite or negative, what is. */
void tl_emitters_collect(const tl_cube *cube, const uint16_t *labels, int region_count,
                         struct tl_emitters out[]);

/* Neighbours merged as far as lobes of exponent s allow with an error below 0.2 % [test_lobes.c]. */
struct tl_emitters tl_emitters_merge(const struct tl_emitters *emitters, int cube_size, float exponent);
void tl_emitters_release(struct tl_emitters *emitters);

/* Sixteen neighbouring directions to look into, each with an exponent of its own. */
struct tl_gaze {
    tl_lanes x, y, z; /* unit */
    tl_lanes exponent;
    vec3s axis;   /* unit: the middle of the sixteen */
    float radius; /* rad: none is farther from the axis */
};

/* The sum over all emitters of power x K_exponent(direction, emitter), RGB. */
void tl_emitters_gather(const struct tl_emitters *emitters, const struct tl_gaze *gaze, tl_lanes out[3]);

#endif
