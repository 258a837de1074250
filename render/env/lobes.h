/* The whole environment seen through cosine lobes, exactly: E(d, s) = integral of L(w) K_s(d, w) dw [DESIGN
 * 4], for the exponents that a frame needs. Pure; results do not depend on the number of threads.
 *
 * One octahedral map an exponent, its side following the lobe's width, with a border of one texel, so that a
 * bilinear fetch needs no seam. */
#ifndef TOILE_RENDER_ENV_LOBES_H
#define TOILE_RENDER_ENV_LOBES_H

#include "render/env/cube.h"

/* Exponents 1 to 1024 in steps whose ratio is TL_EXPONENT_RATIO; beyond them the environment itself. The
 * ratio is justified by tests/render/pem/test_slices.c. */
#define TL_EXPONENT_COUNT 31
#define TL_EXPONENT_RATIO 1.25992105f

/* Which two exponents stand for s, and the weight of the second: fitted so that the blend's lobe is nearest
 * to K_s in L1. index + 1 == TL_EXPONENT_COUNT: between 1024 and the environment itself. */
struct tl_exponent_blend {
    int index;
    float weight;
};
float tl_exponent(int index);
struct tl_exponent_blend tl_exponent_blend(float s);
/* Bits of the exponents that glossiness from `low` to `high` needs; bit 0, the diffuse one, is always set;
 * bit TL_EXPONENT_COUNT is the environment itself. */
uint32_t tl_exponents_needed(float glossiness_low, float glossiness_high);

struct tl_lobe_map {
    int side;      /* texels, without the border; 0: not made */
    float *texels; /* [side + 2][side + 2][4]: RGB, 0 */
};
struct tl_lobes {
    uint32_t made; /* bits by exponent */
    struct tl_lobe_map maps[TL_EXPONENT_COUNT + 1];
};

/* Makes those of `needed` that are not there yet. Call tl_lobes_release when the cube changes. */
void tl_lobes_make(struct tl_lobes *lobes, const tl_cube *cube, uint32_t needed);
void tl_lobes_release(struct tl_lobes *lobes);
void tl_lobes_keep(struct tl_lobes *lobes, uint32_t which); /* releases the others */

/* Maps laid out as those of `from` are, of the exponents in `which`: each texel is what `change` makes of it.
 * May be called from several threads at once. */
typedef vec3s tl_lobe_map_function(vec3s direction, float exponent, vec3s light, const void *context);
struct tl_lobes tl_lobes_map(const struct tl_lobes *from, uint32_t which, tl_lobe_map_function *change,
                             const void *context);

struct tl_lobes tl_lobes_copy(const struct tl_lobes *lobes);
/* Those of `more` that `lobes` does not have become its own; the rest goes. */
void tl_lobes_merge(struct tl_lobes *lobes, struct tl_lobes *more);

/* E(d, s); d unit, in the environment's frame. The exponents that s needs must have been made. */
vec3s tl_lobes_fetch(const struct tl_lobes *lobes, vec3s direction, struct tl_exponent_blend blend);
size_t tl_lobes_bytes(const struct tl_lobes *lobes);

#endif
