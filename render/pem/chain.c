#include "render/pem/chain.h"

#include "render/pem/regions.h"

#include "config/base/memory.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Choices that the paper leaves open:
 *  - Level l + 1 is level l shrunk and then filtered, so that level 0 stays the mirror [Knuth et al. 2014,
 * figure 2: the pyramid "contains a convolution with a mirror reflective glossiness at the top resolution"].
 *  - Beyond a border the plane of the face is continued, and the colour in that direction is fetched from the
 *    neighbouring faces as GL does: seamless, bilinear. So borders and corners need no special case.
 *  - Each face is filtered with these borders by rows, then by columns.
 *  - Texels are not weighted by solid angle, because the paper does not; the test measures the loss of
 * energy. */

const char *const tl_chain_filter_names[] = {"none", "gauss", "cosine", "box", "sqrt_cosine", NULL};

#define REACH 2 /* texels on either side that a filter of five taps reads */

static double raw_weight(enum tl_chain_filter filter, int offset)
{
    double cosine = cos(offset * M_PI / 6);
    switch (filter) {
    case TL_CHAIN_NONE:
        break;
    case TL_CHAIN_GAUSS:
        return exp(-0.5 * offset * offset);
    case TL_CHAIN_COSINE:
        return cosine;
    case TL_CHAIN_BOX:
        return 1;
    case TL_CHAIN_SQRT_COSINE:
        return sqrt(cosine);
    }
    return offset == 0 ? 1 : 0;
}

void tl_chain_weights(enum tl_chain_filter filter, float weights[5])
{
    double sum = 0;
    for (int i = 0; i < 5; i++)
        sum += raw_weight(filter, i - REACH);
    for (int i = 0; i < 5; i++)
        weights[i] = (float)(raw_weight(filter, i - REACH) / sum);
    /* The centre takes the rounding error, so that a constant does not drift from level to level. */
    weights[REACH] = 1 - 2 * (weights[0] + weights[1]);
}

/* The part of a face, or of a face with its borders, that may differ from black. Most of a PEM is black;
 * skipping that part changes no bit of the result. */
struct extent {
    int x0, y0, x1, y1; /* [x0, x1) x [y0, y1); empty when x0 >= x1 */
};

static const struct extent extent_none = {INT_MAX, INT_MAX, INT_MIN, INT_MIN};

static void extent_add(struct extent *extent, int x, int y)
{
    extent->x0 = x < extent->x0 ? x : extent->x0;
    extent->y0 = y < extent->y0 ? y : extent->y0;
    extent->x1 = x + 1 > extent->x1 ? x + 1 : extent->x1;
    extent->y1 = y + 1 > extent->y1 ? y + 1 : extent->y1;
}

static bool is_black(const float *texel)
{
    return texel[0] == 0 && texel[1] == 0 && texel[2] == 0;
}

static float *texel_of(const tl_cube *cube, int face, int x, int y)
{
    return cube->texels + 3 * ((size_t)(face * cube->size + y) * (size_t)cube->size + (size_t)x);
}

static struct extent find_extent(const tl_cube *cube, int face)
{
    struct extent extent = extent_none;
    for (int y = 0; y < cube->size; y++)
        for (int x = 0; x < cube->size; x++)
            if (!is_black(texel_of(cube, face, x, y)))
                extent_add(&extent, x, y);
    return extent;
}

/* 2x2 mean. */
static void shrink(const tl_cube *fine, tl_cube *coarse)
{
    for (int face = 0; face < 6; face++) {
        struct extent lit = find_extent(fine, face);
        if (lit.x0 >= lit.x1)
            continue;
        for (int y = lit.y0 / 2; y < (lit.y1 + 1) / 2; y++) {
            for (int x = lit.x0 / 2; x < (lit.x1 + 1) / 2; x++) {
                const float *top = texel_of(fine, face, 2 * x, 2 * y);
                const float *bottom = texel_of(fine, face, 2 * x, 2 * y + 1);
                float *target = texel_of(coarse, face, x, y);
                for (int c = 0; c < 3; c++)
                    target[c] = 0.25f * ((top[c] + top[c + 3]) + (bottom[c] + bottom[c + 3]));
            }
        }
    }
}

/* A face with REACH texels of its neighbours around it; row 0 and column 0 are the outermost. */
struct bordered {
    int side;             /* size + 2 REACH */
    float *texels, *rows; /* [side][side][3]: as fetched; after filtering along x */
    struct extent lit;
};

static float *bordered_texel(const struct bordered *bordered, float *plane, int x, int y)
{
    return plane + 3 * ((size_t)y * (size_t)bordered->side + (size_t)x);
}

static void bordered_fetch(struct bordered *bordered, const tl_cube *cube, int face)
{
    int size = cube->size;
    bordered->lit = extent_none;
    for (int y = 0; y < bordered->side; y++) {
        for (int x = 0; x < bordered->side; x++) {
            float *target = bordered_texel(bordered, bordered->texels, x, y);
            int inner_x = x - REACH, inner_y = y - REACH;
            if (inner_x >= 0 && inner_x < size && inner_y >= 0 && inner_y < size) {
                memcpy(target, texel_of(cube, face, inner_x, inner_y), 3 * sizeof(float));
            } else {
                float s = ((float)inner_x + 0.5f) / (float)size, t = ((float)inner_y + 0.5f) / (float)size;
                vec3s colour = tl_cube_sample(cube, tl_cube_direction(face, s, t));
                memcpy(target, colour.raw, sizeof colour.raw);
            }
            if (!is_black(target))
                extent_add(&bordered->lit, x, y);
        }
    }
}

/* Filters five texels, `stride` floats apart, with the middle one at `centre`. */
static void filter_texel(const float *centre, ptrdiff_t stride, const float weights[5], float *target)
{
    for (int c = 0; c < 3; c++)
        target[c] = weights[0] * (centre[c - 2 * stride] + centre[c + 2 * stride]) +
                    weights[1] * (centre[c - stride] + centre[c + stride]) + weights[2] * centre[c];
}

static int clamp_index(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* Filters by rows, then by columns, the texels that lit texels can reach. */
static void bordered_filter(struct bordered *bordered, const float weights[5], const tl_cube *target,
                            int face)
{
    const struct extent *lit = &bordered->lit;
    if (lit->x0 >= lit->x1)
        return;
    int low = REACH, high = bordered->side - REACH;
    int x0 = clamp_index(lit->x0 - REACH, low, high), x1 = clamp_index(lit->x1 + REACH, low, high);
    int y0 = clamp_index(lit->y0 - REACH, low, high), y1 = clamp_index(lit->y1 + REACH, low, high);
    for (int y = y0 - REACH; y < y1 + REACH; y++)
        for (int x = x0; x < x1; x++)
            filter_texel(bordered_texel(bordered, bordered->texels, x, y), 3, weights,
                         bordered_texel(bordered, bordered->rows, x, y));
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            filter_texel(bordered_texel(bordered, bordered->rows, x, y), 3 * (ptrdiff_t)bordered->side,
                         weights, texel_of(target, face, x - REACH, y - REACH));
}

static void filter_cube(const tl_cube *source, const float weights[5], const tl_cube *target)
{
    int side = source->size + 2 * REACH;
    struct bordered bordered = {.side = side,
                                .texels = TL_NEW_ARRAY(float, 3 * (size_t)side * (size_t)side),
                                .rows = TL_NEW_ARRAY(float, 3 * (size_t)side * (size_t)side)};
    for (int face = 0; face < 6; face++) {
        bordered_fetch(&bordered, source, face);
        bordered_filter(&bordered, weights, target, face);
    }
    free(bordered.texels);
    free(bordered.rows);
}

struct tl_chain tl_chain_build(const tl_cube *base, enum tl_chain_filter filter)
{
    assert((base->size & (base->size - 1)) == 0 && base->size < 1 << TL_CHAIN_LEVELS_MAX);
    struct tl_chain chain = {.level_count = 1, .levels = {tl_cube_copy(base)}};
    float weights[5];
    tl_chain_weights(filter, weights);
    for (int size = base->size / 2; size > 0; size /= 2) {
        const tl_cube *previous = &chain.levels[chain.level_count - 1];
        tl_cube *next = &chain.levels[chain.level_count++];
        *next = tl_cube_create(size);
        shrink(previous, next);
        if (filter == TL_CHAIN_NONE)
            continue;
        tl_cube shrunk = *next;
        *next = tl_cube_create(size);
        filter_cube(&shrunk, weights, next);
        tl_cube_release(&shrunk);
    }
    return chain;
}

void tl_chain_release(struct tl_chain *chain)
{
    for (int i = 0; i < chain->level_count; i++)
        tl_cube_release(&chain->levels[i]);
    *chain = (struct tl_chain){0};
}

vec3s tl_chain_sample(const struct tl_chain *chain, vec3s direction, float level)
{
    float last = (float)(chain->level_count - 1);
    level = fminf(fmaxf(level, 0), last);
    int below = (int)level;
    vec3s fine = tl_cube_sample(&chain->levels[below], direction);
    if (below + 1 == chain->level_count)
        return fine;
    vec3s coarse = tl_cube_sample(&chain->levels[below + 1], direction);
    return glms_vec3_lerp(fine, coarse, level - (float)below);
}

tl_cube tl_pem_cut(const tl_cube *cube, const struct tl_regions *regions, int i)
{
    tl_cube pem = tl_cube_create(cube->size);
    for (uint32_t k = regions->first[i]; k < regions->first[i + 1]; k++) {
        size_t texel = 3 * (size_t)regions->texels[k];
        memcpy(pem.texels + texel, cube->texels + texel, 3 * sizeof(float));
    }
    return pem;
}
