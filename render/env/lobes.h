/* The whole environment convolved exactly with cosine lobes: E(d, s) = integral of L(w) K_s(d, w) dw, for the
 * exponents that a frame needs. Pure, but for the cache of files (config/cache/cache.h), in which slow
 * results are kept between runs; results do not depend on it, nor on the number of threads.
 *
 * One octahedral map per exponent, its side following the width of the lobe, with a border of one texel, so
 * that a bilinear fetch needs no special case at seams. */
#ifndef TOILE_RENDER_ENV_LOBES_H
#define TOILE_RENDER_ENV_LOBES_H

#include "render/env/cube.h"

/* Exponents 1 to 1024 with the constant ratio TL_EXPONENT_RATIO, then the environment itself.
 * tests/render/pem/test_slices.c justifies the ratio. */
#define TL_EXPONENT_COUNT 31
#define TL_EXPONENT_RATIO 1.25992105f

/* The two exponents between which s is interpolated, and the weight of the second. The weight is fitted so
 * that the blended lobe is nearest to K_s in L1. index + 1 == TL_EXPONENT_COUNT: between 1024 and the
 * environment itself. */
struct tl_exponent_blend {
    int index;
    float weight;
};
/* The exponent with an index. */
float tl_exponent(int index);
/* The blend for exponent s. */
struct tl_exponent_blend tl_exponent_blend(float s);
/* Bit mask of the exponents that glossiness from `low` to `high` needs. Bit 0, the diffuse lobe, is always
 * set; bit TL_EXPONENT_COUNT is the environment itself. */
uint32_t tl_exponents_needed(float glossiness_low, float glossiness_high);

struct tl_lobe_map {
    int side;      /* texels, without the border; 0: does not exist */
    float *texels; /* [side + 2][side + 2][4]: RGB, 0 */
};
struct tl_lobes {
    uint32_t made; /* bits by exponent */
    struct tl_lobe_map maps[TL_EXPONENT_COUNT + 1];
};

/* Computes the maps of `needed` that do not exist yet, or takes them from the cache, if one is used. Call
 * tl_lobes_release when the cube changes. */
void tl_lobes_make(struct tl_lobes *lobes, const tl_cube *cube, uint32_t needed);
void tl_lobes_release(struct tl_lobes *lobes);
/* Releases all maps except those of `which`. */
void tl_lobes_keep(struct tl_lobes *lobes, uint32_t which);

/* Applies a function to every texel of the exponents in `which` and returns the results as maps of the same
 * sizes. `function` is called from several threads at once. `key` covers all that the function's results
 * depend on but for its arguments: results are kept under it, where a cache is used. */
struct tl_cache_key; /* config/cache/cache.h */
typedef vec3s tl_lobe_map_function(vec3s direction, float exponent, vec3s light, const void *context);
struct tl_lobes tl_lobes_map(const struct tl_lobes *from, uint32_t which, tl_lobe_map_function *function,
                             const void *context, const struct tl_cache_key *key);

/* A deep copy. */
struct tl_lobes tl_lobes_copy(const struct tl_lobes *lobes);
/* Moves the maps of `more` that `lobes` does not have into it and releases the rest. */
void tl_lobes_merge(struct tl_lobes *lobes, struct tl_lobes *more);

/* E(d, s) for a unit direction in the environment's frame. The exponents of the blend must exist. */
vec3s tl_lobes_fetch(const struct tl_lobes *lobes, vec3s direction, struct tl_exponent_blend blend);
/* Size of all maps. */
size_t tl_lobes_bytes(const struct tl_lobes *lobes);
/* Texels of the maps of these exponents, without those of the environment itself. */
size_t tl_lobes_texels(uint32_t exponents);

#endif
