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

/* The opposite: room for another number's bits between those of one. */
static uint32_t spread_bits(uint32_t number)
{
    number = (number | number << 8) & 0x00ff00ffu;
    number = (number | number << 4) & 0x0f0f0f0fu;
    number = (number | number << 2) & 0x33333333u;
    return (number | number << 1) & 0x55555555u;
}

uint32_t *tl_emitters_order(int cube_size)
{
    assert(cube_size <= 1 << CODE_BITS);
    uint32_t size = (uint32_t)cube_size, side = 1, count = 0;
    uint32_t *texels = TL_NEW_ARRAY(uint32_t, 6 * (size_t)size * size);
    while (side < size)
        side *= 2;
    for (uint32_t face = 0; face < 6; face++) {
        for (uint32_t code = 0; code < side * side; code++) {
            uint32_t x = compact_bits(code), y = compact_bits(code >> 1);
            if (x < size && y < size)
                texels[count++] = (face * size + y) * size + x;
        }
    }
    return texels;
}

static tl_emitter emitter_of(const tl_cube *cube, const float *solid_angles, uint32_t texel)
{
    uint32_t size = (uint32_t)cube->size, x = texel % size, y = texel / size % size,
             face = texel / (size * size);
    float step = 1 / (float)size;
    tl_emitter emitter = {.code = face << 2 * CODE_BITS | spread_bits(y) << 1 | spread_bits(x)};
    emitter.direction =
        glms_vec3_normalize(tl_cube_direction((int)face, ((float)x + 0.5f) * step, ((float)y + 0.5f) * step));
    for (size_t c = 0; c < 3; c++)
        emitter.power.raw[c] = solid_angles[y * size + x] * sane(cube->texels[3 * (size_t)texel + c]);
    emitter.weight = luminance(emitter.power);
    return emitter;
}

tl_emitter *tl_emitters_collect(const tl_cube *cube, const float *solid_angles, const uint32_t *texels,
                                size_t count)
{
    tl_emitter *emitters = TL_NEW_ARRAY(tl_emitter, count);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < count; i++)
        emitters[i] = emitter_of(cube, solid_angles, texels[i]);
    return emitters;
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
    for (int c = 0; c < 3; c++)
        emitters->axes[block / TL_LANES][c][block % TL_LANES] = axis.raw[c];
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
    emitters->axes = tl_alloc(groups, sizeof *emitters->axes);
    /* Those that fill up the last group are nowhere: no cosine is above theirs. */
    for (size_t block = emitters->block_count; block < groups * TL_LANES; block++)
        emitters->axes[block / TL_LANES][0][block % TL_LANES] = NAN;
    for (size_t block = 0; block < emitters->block_count; block++)
        set_axis(emitters, block);
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

struct tl_emitters tl_emitters_merge(const tl_emitter *texels, size_t count, int cube_size, float exponent)
{
    int shift = 2 * merges_for(cube_size, exponent);
    struct tl_emitters merged = {.items = TL_NEW_ARRAY(tl_emitter, count)};
    const tl_emitter *end = texels + count;
    while (texels < end) {
        const tl_emitter *next = texels;
        while (next < end && next->code >> shift == texels->code >> shift)
            next++;
        tl_emitter cell = merge_run(texels, next, texels->code >> shift);
        if (cell.weight > 0)
            merged.items[merged.count++] = cell;
        texels = next;
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

void tl_gaze_set(struct tl_gaze *gaze, const vec3s directions[TL_LANES], const float steps[TL_LANES], float s,
                 int cube_size)
{
    /* Variances along one axis: each multiplies a lobe's mean cosine, (s + 1) / (s + 2), by 1 - variance. */
    float source = (float)(4 * M_PI / 6 / 12) / (float)(cube_size * cube_size);
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < TL_LANES; i++) {
        gaze->x[i] = directions[i].x;
        gaze->y[i] = directions[i].y;
        gaze->z[i] = directions[i].z;
        sum = glms_vec3_add(sum, directions[i]);
        float mean = (s + 1) / (s + 2) * (1 - source) / (1 - steps[i] * steps[i] / 6);
        gaze->exponent[i] = 1 / (1 - mean) - 2;
    }
    gaze->axis = glms_vec3_normalize(sum);
    gaze->radius = 0;
    for (int i = 0; i < TL_LANES; i++)
        gaze->radius = fmaxf(gaze->radius, glms_vec3_angle(gaze->axis, directions[i]));
}

/* Cosine below which a block cannot reach any of the sixteen. */
static float reach_cosine(const struct tl_emitters *emitters, const struct tl_gaze *gaze)
{
    float least = gaze->exponent[0];
    for (int i = 1; i < TL_LANES; i++)
        least = tl_lesser(least, gaze->exponent[i]);
    float reach = acosf(powf(LOBE_CUT, 1 / least)) + emitters->radius + gaze->radius;
    return reach < (float)M_PI ? cosf(reach) : -2;
}

/* Bit i: block i of the group is reached. */
TL_INLINE uint32_t reached_blocks(const float axes[3][TL_LANES], vec3s axis, float cosine)
{
    uint32_t bits = 0;
    for (int i = 0; i < TL_LANES; i++)
        bits |= (uint32_t)(axes[0][i] * axis.x + axes[1][i] * axis.y + axes[2][i] * axis.z >= cosine) << i;
    return bits;
}

TL_INLINE void add_emitters(const tl_emitter *emitter, const tl_emitter *end, const struct tl_gaze *gaze,
                            float sums[3][TL_LANES])
{
    for (; emitter < end; emitter++) {
        for (int i = 0; i < TL_LANES; i++) {
            float cosine = gaze->x[i] * emitter->direction.x + gaze->y[i] * emitter->direction.y +
                           gaze->z[i] * emitter->direction.z;
            float lobe = tl_power(cosine, gaze->exponent[i]);
            sums[0][i] += lobe * emitter->power.x;
            sums[1][i] += lobe * emitter->power.y;
            sums[2][i] += lobe * emitter->power.z;
        }
    }
}

TL_CLONES void tl_emitters_gather(const struct tl_emitters *emitters, const struct tl_gaze *gaze,
                                  float out[3][TL_LANES])
{
    float near = reach_cosine(emitters, gaze), sums[3][TL_LANES] = {{0}};
    struct tl_gaze own = *gaze; /* nothing else points to it, so that it stays in registers */
    size_t groups = (emitters->block_count + TL_LANES - 1) / TL_LANES;
    for (size_t group = 0; group < groups; group++) {
        uint32_t reached = reached_blocks(emitters->axes[group], own.axis, near);
        for (; reached; reached &= reached - 1) {
            size_t block = group * TL_LANES + (size_t)__builtin_ctz(reached);
            add_emitters(emitters->items + emitters->first[block],
                         emitters->items + emitters->first[block + 1], &own, sums);
        }
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TL_LANES; i++)
            out[c][i] = sums[c][i] * (own.exponent[i] + 1) * (float)(1 / (2 * M_PI));
}
