/* The filter chain of a PEM [Knuth et al. 2014, figure 2]: alternating 2x2 shrinking and separable 5x5
 * filtering, across the borders of faces. Level 0 is the input (the mirror); the last level has one texel per
 * face. Pure; threads: any. */
#ifndef TOILE_RENDER_PEM_CHAIN_H
#define TOILE_RENDER_PEM_CHAIN_H

#include "render/env/cube.h"

enum tl_chain_filter {
    TL_CHAIN_NONE,
    TL_CHAIN_GAUSS,  /* sigma = 1 texel */
    TL_CHAIN_COSINE, /* cos at -60 -30 0 30 60 degrees, normalised */
    TL_CHAIN_BOX,
    TL_CHAIN_SQRT_COSINE, /* the choice of the paper: cos^0.5 */
};
extern const char *const tl_chain_filter_names[]; /* none gauss cosine box sqrt_cosine, NULL */

#define TL_CHAIN_LEVELS_MAX 12

struct tl_chain {
    int level_count;
    tl_cube levels[TL_CHAIN_LEVELS_MAX]; /* sizes halve; size must be a power of two */
};

/* The five weights of the 1D filter; they sum to 1. NONE gives 0 0 1 0 0. */
void tl_chain_weights(enum tl_chain_filter filter, float weights[5]);

/* Builds all levels from a copy of `base`. Released by tl_chain_release. */
struct tl_chain tl_chain_build(const tl_cube *base, enum tl_chain_filter filter);
void tl_chain_release(struct tl_chain *chain);

/* Trilinear look-up at a fractional level; clamped to the levels that exist. */
vec3s tl_chain_sample(const struct tl_chain *chain, vec3s direction, float level);

/* One PEM: a copy of the cube, black outside of region i [Knuth et al. 2014, 4]. */
struct tl_regions;
tl_cube tl_pem_cut(const tl_cube *cube, const struct tl_regions *regions, int i);

#endif
