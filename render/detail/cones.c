#include "render/detail/cones.h"

#include "config/base/memory.h"
#include "render/detail/detail_terms.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* Up to two texels the field is sampled at half texels; bounds by whole texels would leave a cone of width
 * 0. */
#define NEAR_HALVES 4
#define MARGIN      (NEAR_HALVES + 2)
/* A block counts as a whole when its distance exceeds its size by this factor. The cone gets slightly
 * narrower by that. */
#define FAR 6.0f

/* Range of the field within half a texel of a texel centre. */
struct patch {
    float low, high;
    float slope_min[2], slope_max[2]; /* along columns and rows, per texel */
};

/* Maximum heights of blocks of patches; each level has half as many blocks per side. */
struct level {
    int width, height;
    float *high;
};

#define LEVELS_MAX 16
struct cells {
    int width, height, copies_x, copies_y; /* number of repeats examined on each side */
    float *halves; /* heights at every half texel, texel centres at odd indices, with a margin all around */
    struct patch *patches;
    int level_count;
    struct level levels[LEVELS_MAX];
};

static int wrapped(int at, int size, bool clamp)
{
    if (clamp)
        return at < 0 ? 0 : at >= size ? size - 1 : at;
    return (at % size + size) % size;
}

static void widen(float range[2], float value)
{
    range[0] = fminf(range[0], value);
    range[1] = fmaxf(range[1], value);
}

/* The range of a patch. The field is bilinear between texel centres, so its extremes around a texel, and
 * those of its slopes, lie at the centre, half way to the neighbours, and where four texels meet. */
static struct patch patch_of(const struct tl_height_field *field, int column, int row)
{
    const tl_image *heights = field->heights;
    float at[3][3], sign = field->turned_over ? -1.0f : 1.0f;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            int x = wrapped(column + i - 1, heights->width, field->clamp_u);
            int y = wrapped(row + j - 1, heights->height, field->clamp_v);
            at[j][i] = sign * tl_image_floats(heights)[(size_t)y * (size_t)heights->width + (size_t)x];
        }
    float range[2] = {INFINITY, -INFINITY}, across[2] = {INFINITY, -INFINITY},
          down[2] = {INFINITY, -INFINITY};
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            widen(range, 0.25f * (at[1][1] + at[1][i] + at[j][1] + at[j][i]));
            int column_pair = i == 0 ? 0 : 1, row_pair = j == 0 ? 0 : 1;
            if (i != 1)
                widen(across, 0.5f * (at[1][column_pair + 1] - at[1][column_pair] + at[j][column_pair + 1] -
                                      at[j][column_pair]));
            if (j != 1)
                widen(down,
                      0.5f * (at[row_pair + 1][1] - at[row_pair][1] + at[row_pair + 1][i] - at[row_pair][i]));
        }
    return (struct patch){range[0], range[1], {across[0], down[0]}, {across[1], down[1]}};
}

static void add_level(struct cells *cells)
{
    const struct level *fine = &cells->levels[cells->level_count - 1];
    struct level level = {(fine->width + 1) / 2, (fine->height + 1) / 2, NULL};
    level.high = TL_NEW_ARRAY(float, (size_t)level.width *(size_t)level.height);
    for (int i = 0; i < level.width * level.height; i++) {
        level.high[i] = -INFINITY;
        for (int k = 0; k < 4; k++) {
            int x = 2 * (i % level.width) + (k & 1), y = 2 * (i / level.width) + (k >> 1);
            if (x < fine->width && y < fine->height)
                level.high[i] = fmaxf(level.high[i], fine->high[(size_t)y * (size_t)fine->width + (size_t)x]);
        }
    }
    cells->levels[cells->level_count++] = level;
}

static float *halves_of(const struct tl_height_field *field)
{
    int width = 2 * field->heights->width, height = 2 * field->heights->height,
        row_length = width + 2 * MARGIN;
    float *halves = TL_NEW_ARRAY(float, (size_t)row_length *(size_t)(height + 2 * MARGIN));
    for (int row = -MARGIN; row < height + MARGIN; row++)
        for (int column = -MARGIN; column < width + MARGIN; column++) {
            const vec2s uv = {{(float)column / (float)width, (float)row / (float)height}};
            halves[(row + MARGIN) * (ptrdiff_t)row_length + column + MARGIN] = tl_field_height(field, uv);
        }
    return halves;
}

static struct cells cells_of(const struct tl_height_field *field)
{
    int width = field->heights->width, height = field->heights->height;
    size_t count = (size_t)width * (size_t)height;
    struct cells cells = {.width = width,
                          .height = height,
                          .copies_x = field->clamp_u ? 0 : 1,
                          .copies_y = field->clamp_v ? 0 : 1,
                          .halves = halves_of(field),
                          .patches = TL_NEW_ARRAY(struct patch, count),
                          .level_count = 1,
                          .levels = {{width, height, TL_NEW_ARRAY(float, count)}}};
    for (size_t i = 0; i < count; i++) {
        cells.patches[i] = patch_of(field, (int)(i % (size_t)width), (int)(i / (size_t)width));
        cells.levels[0].high[i] = cells.patches[i].high;
    }
    while (cells.levels[cells.level_count - 1].width > 1 || cells.levels[cells.level_count - 1].height > 1)
        add_level(&cells);
    return cells;
}

static void release(struct cells *cells)
{
    for (int i = 0; i < cells->level_count; i++)
        free(cells->levels[i].high);
    free(cells->halves);
    free(cells->patches);
}

/* A cone; it gets narrower as more of the field is examined. */
struct cone {
    int column, row;
    float apex;  /* the lowest position of the apex */
    float ratio; /* texels per metre */
};

/* True if a field with slopes in the ranges of the patch can fall along any line between two texels that are
 * (x, y) apart. */
static bool may_fall(const struct patch *patch, float x, float y)
{
    const float to[2] = {x, y};
    float min = 0;
    for (int axis = 0; axis < 2; axis++) {
        float a = patch->slope_min[axis], b = patch->slope_max[axis], near = to[axis] - 1, far = to[axis] + 1;
        min += fminf(fminf(a * near, a * far), fminf(b * near, b * far));
    }
    return min < 0;
}

static void narrow_by_patch(struct cone *cone, const struct cells *cells, int x, int y)
{
    const struct patch *patch =
        &cells->patches[(size_t)wrapped(y, cells->height, false) * (size_t)cells->width +
                        (size_t)wrapped(x, cells->width, false)];
    float across = (float)(x - cone->column), down = (float)(y - cone->row), rise = patch->high - cone->apex;
    float distance = hypotf(fmaxf(fabsf(across) - 1, 0), fmaxf(fabsf(down) - 1, 0));
    if (distance > 0 && distance < cone->ratio * rise && may_fall(patch, across, down))
        cone->ratio = distance / rise;
}

static float outside(float at, float from, float to)
{
    return fmaxf(fmaxf(from - at, at - to), 0);
}

struct height_block {
    int level, x, y;
};

/* The tightest bound that a block, shifted by whole repeats, can set on a cone. */
struct cone_bound {
    float distance, rise;
};

/* Texels extend half a texel to each side, hence the margin of one. */
static struct cone_bound bound_of(const struct cone *cone, const struct cells *cells,
                                  struct height_block block, int shift_x, int shift_y)
{
    const struct level *level = &cells->levels[block.level];
    int side = 1 << block.level, left = block.x * side + shift_x, top = block.y * side + shift_y;
    float across = outside((float)cone->column, (float)(left - 1), (float)(left + side));
    float down = outside((float)cone->row, (float)(top - 1), (float)(top + side));
    float high = level->high[(size_t)block.y * (size_t)level->width + (size_t)block.x];
    float distance = (float)sqrt((double)across * (double)across + (double)down * (double)down);
    return (struct cone_bound){distance, high - cone->apex};
}

static void narrow_by_repeat(struct cone *cone, const struct cells *cells, int shift_x, int shift_y)
{
    struct height_block stack[4 * LEVELS_MAX] = {{cells->level_count - 1, 0, 0}};
    for (int count = 1; count > 0;) {
        struct height_block block = stack[--count];
        struct cone_bound bound = bound_of(cone, cells, block, shift_x, shift_y);
        if (!(bound.distance < cone->ratio * bound.rise))
            continue;
        if (bound.distance > FAR * (float)(1 << block.level) && block.level > 0) {
            cone->ratio = bound.distance / bound.rise;
            continue;
        }
        if (block.level == 0) {
            narrow_by_patch(cone, cells, block.x + shift_x, block.y + shift_y);
            continue;
        }
        /* The nearest quarter is examined first, because it usually makes the others irrelevant. */
        const struct level *finer = &cells->levels[block.level - 1];
        int half = 1 << (block.level - 1);
        int nearest = (cone->column >= (2 * block.x + 1) * half + shift_x ? 1 : 0) |
                      (cone->row >= (2 * block.y + 1) * half + shift_y ? 2 : 0);
        for (int k = 3; k >= 0; k--) {
            int quarter = nearest ^ k;
            struct height_block part = {block.level - 1, 2 * block.x + (quarter & 1),
                                        2 * block.y + (quarter >> 1)};
            if (part.x < finer->width && part.y < finer->height)
                stack[count++] = part;
        }
    }
}

/* Narrows the cone by the point (x, y) half texels away, if the field falls from there on. */
static void narrow_by_half(struct cone *cone, const float *from, ptrdiff_t row_length, int x, int y)
{
    const float *here = from + y * row_length + x;
    float rise = *here - *from;
    if (!(rise > 0))
        return;
    float distance = sqrtf((float)(x * x + y * y));
    if (!(distance < 2 * cone->ratio * rise))
        return;
    int beyond_x = (int)lrintf((float)x / distance), beyond_y = (int)lrintf((float)y / distance);
    if (here[beyond_y * row_length + beyond_x] < *here)
        cone->ratio = distance / (2 * rise);
}

static void narrow_near(struct cone *cone, const struct cells *cells)
{
    ptrdiff_t row_length = 2 * cells->width + 2 * MARGIN;
    const float *corner = cells->halves + (ptrdiff_t)(2 * cone->row + MARGIN) * row_length +
                          (ptrdiff_t)(2 * cone->column + MARGIN);
    for (int k = 0; k < 9; k++)
        for (int y = -NEAR_HALVES; y <= NEAR_HALVES; y++)
            for (int x = -NEAR_HALVES; x <= NEAR_HALVES; x++)
                narrow_by_half(cone, corner + (k / 3) * row_length + k % 3, row_length, x, y);
}

/* The cone at a texel. Beyond the examined repeats the field is assumed to have its maximum height
 * everywhere. */
static float cone_at(const struct cells *cells, int column, int row)
{
    const struct patch *patch = &cells->patches[(size_t)row * (size_t)cells->width + (size_t)column];
    struct cone cone = {column, row, patch->low, 0};
    float rise = cells->levels[cells->level_count - 1].high[0] - cone.apex;
    if (!(rise > 0))
        return INFINITY;
    cone.ratio = (float)(cells->width < cells->height ? cells->width : cells->height) / rise;
    narrow_near(&cone, cells);
    narrow_by_repeat(&cone, cells, 0, 0);
    for (int j = -cells->copies_y; j <= cells->copies_y; j++)
        for (int i = -cells->copies_x; i <= cells->copies_x; i++)
            if (i != 0 || j != 0)
                narrow_by_repeat(&cone, cells, i * cells->width, j * cells->height);
    return cone.ratio;
}

static uint8_t encoded(float ratio, float depth_m)
{
    float texels = ratio * depth_m;
    return isfinite(texels) ? (uint8_t)(255 * (texels / (texels + DETAIL_CONE_TEXELS))) : 255;
}

tl_image tl_bake_cones(const struct tl_height_field *field, float texel)
{
    const struct tl_height_field sides[2] = {*field, tl_height_field_back(field)};
    int width = field->heights->width, height = field->heights->height;
    tl_image cones = tl_image_create(width, height, 2, TL_IMAGE_U8);
    cones.linear = true;
    for (int side = 0; side < 2; side++) {
        struct cells cells = cells_of(&sides[side]);
#pragma omp parallel for schedule(dynamic)
        for (int row = 0; row < height; row++)
            for (int column = 0; column < width; column++) {
                size_t at = (size_t)row * (size_t)width + (size_t)column;
                tl_image_bytes(&cones)[2 * at + (size_t)side] =
                    encoded(texel * cone_at(&cells, column, row), field->high_m - field->low_m);
            }
        release(&cells);
    }
    return cones;
}
