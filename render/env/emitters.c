#include "render/env/emitters.h"

#include "config/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A lobe is cut off where it is below this part of its peak: at the edge of a sun that outshines all the rest
 * ten thousand times that is a tenth of what is there. */
#define LOBE_CUT 1e-5f

/* Cells are at most this many lobe widths 1 / sqrt(s) wide. */
#define MERGE_WIDTH 0.2f

/* Bits of x or of y in a code; the face stands above them. */
#define CODE_BITS 13

/* Every second bit of a code. */
static uint32_t compact_bits(uint32_t code)
{
    code &= 0x55555555u;
    code = (code | code >> 1) & 0x33333333u;
    code = (code | code >> 2) & 0x0f0f0f0fu;
    code = (code | code >> 4) & 0x00ff00ffu;
    return (code | code >> 8) & 0x0000ffffu;
}

static float luminance(vec3s colour)
{
    return 0.2126f * colour.x + 0.7152f * colour.y + 0.0722f * colour.z;
}

static float sane(float radiance)
{
    return radiance > 0 && isfinite(radiance) ? radiance : 0;
}

/* Where texel after texel of the curve lies. */
struct texel {
    size_t index; /* (face * size + y) * size + x */
    int face, x, y;
    uint32_t code;
};

/* All texels, along the curve. */
static struct texel *order_texels(int size)
{
    struct texel *texels = TL_NEW_ARRAY(struct texel, 6 * (size_t)size * (size_t)size);
    uint32_t side = 1;
    while (side < (uint32_t)size)
        side *= 2;
    size_t count = 0;
    for (int face = 0; face < 6; face++) {
        for (uint32_t code = 0; code < side * side; code++) {
            int x = (int)compact_bits(code), y = (int)compact_bits(code >> 1);
            if (x < size && y < size)
                texels[count++] =
                    (struct texel){((size_t)face * (size_t)size + (size_t)y) * (size_t)size + (size_t)x, face,
                                   x, y, (uint32_t)face << 2 * CODE_BITS | code};
        }
    }
    return texels;
}

/* Solid angles of the texels of one quarter of a face, [half][half]; the others mirror it. */
static float *quarter_solid_angles(int size, int half)
{
    float *angles = TL_NEW_ARRAY(float, (size_t)half *(size_t)half);
    for (int i = 0; i < half * half; i++)
        angles[i] = tl_cube_solid_angle(size, i % half, i / half);
    return angles;
}

static int fold(int x, int size)
{
    return x < size - 1 - x ? x : size - 1 - x;
}

static tl_emitter emitter_of(const tl_cube *cube, const struct texel *texel, float solid_angle)
{
    float step = 1 / (float)cube->size;
    tl_emitter emitter = {.code = texel->code};
    emitter.direction = glms_vec3_normalize(
        tl_cube_direction(texel->face, ((float)texel->x + 0.5f) * step, ((float)texel->y + 0.5f) * step));
    for (int c = 0; c < 3; c++)
        emitter.power.raw[c] = solid_angle * sane(cube->texels[3 * texel->index + (size_t)c]);
    emitter.weight = luminance(emitter.power);
    return emitter;
}

/* Runs of the curve that share their leading bits become blocks: 4 x 4 emitters or what is left of them. */
static uint32_t block_of(const tl_emitter *emitter)
{
    return emitter->code / TL_EMITTER_BLOCK;
}

static void set_axis(struct tl_emitters *emitters, size_t block)
{
    const tl_emitter *items = emitters->items;
    vec3s sum = {{0, 0, 0}};
    for (uint32_t i = emitters->first[block]; i < emitters->first[block + 1]; i++)
        sum = glms_vec3_add(sum, items[i].direction);
    vec3s axis = glms_vec3_normalize(sum);
    float *axes = emitters->axes + 3 * TL_LANES * (block / TL_LANES) + block % TL_LANES;
    for (size_t c = 0; c < 3; c++)
        axes[c * TL_LANES] = axis.raw[c];
    for (uint32_t i = emitters->first[block]; i < emitters->first[block + 1]; i++)
        emitters->radius = fmaxf(emitters->radius, glms_vec3_angle(axis, items[i].direction));
}

static void make_blocks(struct tl_emitters *emitters)
{
    emitters->first = TL_NEW_ARRAY(uint32_t, emitters->count + 1);
    for (size_t i = 0; i < emitters->count; i++)
        if (i == 0 || block_of(&emitters->items[i]) != block_of(&emitters->items[i - 1]))
            emitters->first[emitters->block_count++] = (uint32_t)i;
    emitters->first[emitters->block_count] = (uint32_t)emitters->count;
    size_t groups = (emitters->block_count + TL_LANES - 1) / TL_LANES;
    emitters->axes = TL_NEW_ARRAY(float, 3 * TL_LANES * groups);
    for (size_t block = 0; block < emitters->block_count; block++)
        set_axis(emitters, block);
}

void tl_emitters_collect(const tl_cube *cube, const uint16_t *labels, int region_count,
                         struct tl_emitters out[])
{
    assert(cube->size <= 1 << CODE_BITS);
    int half = (cube->size + 1) / 2;
    size_t count = 6 * (size_t)cube->size * (size_t)cube->size;
    struct texel *texels = order_texels(cube->size);
    float *angles = quarter_solid_angles(cube->size, half);
    size_t *counts = TL_NEW_ARRAY(size_t, (size_t)region_count);
    for (size_t i = 0; i < count; i++)
        counts[labels ? labels[i] : 0]++;
    for (int region = 0; region < region_count; region++) {
        double texel_solid_angle = 4 * M_PI / (double)count;
        out[region] = (struct tl_emitters){.items = TL_NEW_ARRAY(tl_emitter, counts[region]),
                                           .texel_variance = (float)(texel_solid_angle / 12)};
    }
    for (size_t i = 0; i < count; i++) {
        struct tl_emitters *region = &out[labels ? labels[texels[i].index] : 0];
        int x = fold(texels[i].x, cube->size), y = fold(texels[i].y, cube->size);
        tl_emitter emitter = emitter_of(cube, &texels[i], angles[y * half + x]);
        if (emitter.weight > 0)
            region->items[region->count++] = emitter;
    }
    for (int region = 0; region < region_count; region++)
        make_blocks(&out[region]);
    free(counts);
    free(angles);
    free(texels);
}

static int merges_for(int cube_size, float exponent)
{
    float texel = (float)M_PI_2 / (float)cube_size, widest = MERGE_WIDTH / sqrtf(exponent);
    int merges = 0;
    while (texel * (float)(2 << merges) <= widest)
        merges++;
    return merges;
}

/* The emitters [first, end) as one. */
static tl_emitter merge_run(const tl_emitter *first, const tl_emitter *end, uint32_t code)
{
    tl_emitter merged = {.code = code};
    for (const tl_emitter *emitter = first; emitter < end; emitter++) {
        merged.direction = glms_vec3_muladds(emitter->direction, emitter->weight, merged.direction);
        merged.power = glms_vec3_add(merged.power, emitter->power);
        merged.weight += emitter->weight;
    }
    merged.direction = glms_vec3_normalize(merged.direction);
    return merged;
}

struct tl_emitters tl_emitters_merge(const struct tl_emitters *emitters, int cube_size, float exponent)
{
    int shift = 2 * merges_for(cube_size, exponent);
    struct tl_emitters merged = {.items = TL_NEW_ARRAY(tl_emitter, emitters->count),
                                 .texel_variance = emitters->texel_variance};
    const tl_emitter *items = emitters->items, *end = items + emitters->count;
    while (items < end) {
        const tl_emitter *next = items;
        while (next < end && next->code >> shift == items->code >> shift)
            next++;
        merged.items[merged.count++] = merge_run(items, next, items->code >> shift);
        items = next;
    }
    make_blocks(&merged);
    return merged;
}

void tl_emitters_release(struct tl_emitters *emitters)
{
    free(emitters->items);
    free(emitters->first);
    free(emitters->axes);
    *emitters = (struct tl_emitters){0};
}

/* log2 of x > 0, to 2e-7 of its value also near 1: polynomial in m - 1 for the mantissa m in [sqrt 1/2, sqrt
 * 2), interpolating at Chebyshev's nodes. */
TL_LANES_INLINE tl_lanes lanes_log2(tl_lanes x)
{
    tl_lanes_int bits = (tl_lanes_int)x, exponent = (bits - 0x3f3504f3) >> 23;
    tl_lanes f = (tl_lanes)(bits - (exponent << 23)) - 1;
    tl_lanes p = f * -0.142759734f + 0.232652579f;
    p = f * p - 0.249271822f;
    p = f * p + 0.287288882f;
    p = f * p - 0.360225182f;
    p = f * p + 0.480916708f;
    p = f * p - 0.721352931f;
    p = f * p + 1.44269499f;
    return f * p + __builtin_convertvector(exponent, tl_lanes);
}

/* 2^x for x <= 0, to 1e-7 of its value; below 2^-126 that. */
TL_LANES_INLINE tl_lanes lanes_exp2(tl_lanes x)
{
    tl_lanes_int low = x < -126;
    x = (tl_lanes)((~low & (tl_lanes_int)x) | (low & (tl_lanes_int)((tl_lanes){0} - 126)));
    tl_lanes_int whole = __builtin_convertvector(x - 0.5f, tl_lanes_int); /* truncation rounds, below 0 */
    tl_lanes f = x - __builtin_convertvector(whole, tl_lanes);
    tl_lanes p = f * 0.00133908634f + 0.00967603192f;
    p = f * p + 0.0555035711f;
    p = f * p + 0.240221075f;
    p = f * p + 0.693147188f;
    p = f * p + 1.00000008f;
    return (tl_lanes)((tl_lanes_int)p + (whole << 23));
}

/* max(0, cosine)^exponent */
TL_LANES_INLINE tl_lanes lanes_lobe(tl_lanes cosine, tl_lanes exponent)
{
    tl_lanes_int above = cosine > 0;
    cosine = (tl_lanes)((tl_lanes_int)cosine & above); /* log2(0) comes out as -127 */
    return (tl_lanes)((tl_lanes_int)lanes_exp2(exponent * lanes_log2(cosine)) & above);
}

TL_LANES_INLINE void add_block(const tl_emitter *emitter, const tl_emitter *end, const struct tl_gaze *gaze,
                               tl_lanes sums[3])
{
    for (; emitter < end; emitter++) {
        tl_lanes cosine =
            gaze->x * emitter->direction.x + gaze->y * emitter->direction.y + gaze->z * emitter->direction.z;
        tl_lanes lobe = lanes_lobe(cosine, gaze->exponent);
        sums[0] += lobe * emitter->power.x;
        sums[1] += lobe * emitter->power.y;
        sums[2] += lobe * emitter->power.z;
    }
}

TL_LANES_INLINE float smallest(tl_lanes lanes)
{
    float least = lanes[0];
    for (int i = 1; i < TL_LANES; i++)
        least = lanes[i] < least ? lanes[i] : least;
    return least;
}

/* Cosine below which a block cannot reach any of the sixteen. */
static float reach_cosine(const struct tl_emitters *emitters, const struct tl_gaze *gaze)
{
    float reach = acosf(powf(LOBE_CUT, 1 / smallest(gaze->exponent))) + emitters->radius + gaze->radius;
    return reach < (float)M_PI ? cosf(reach) : -2;
}

TL_CLONES void tl_emitters_gather(const struct tl_emitters *emitters, const struct tl_gaze *gaze,
                                  tl_lanes out[3])
{
    float near = reach_cosine(emitters, gaze);
    tl_lanes sums[3] = {{0}};
    for (size_t group = 0; group < emitters->block_count; group += TL_LANES) {
        tl_lanes axes[3];
        memcpy(axes, emitters->axes + 3 * group, sizeof axes);
        tl_lanes cosine = axes[0] * gaze->axis.x + axes[1] * gaze->axis.y + axes[2] * gaze->axis.z;
        tl_lanes_int reached = cosine >= near;
        size_t end = group + TL_LANES < emitters->block_count ? group + TL_LANES : emitters->block_count;
        for (size_t block = group; block < end; block++)
            if (reached[block - group])
                add_block(emitters->items + emitters->first[block],
                          emitters->items + emitters->first[block + 1], gaze, sums);
    }
    tl_lanes norm = (gaze->exponent + 1) * (float)(1 / (2 * M_PI));
    for (int c = 0; c < 3; c++)
        out[c] = sums[c] * norm;
}
