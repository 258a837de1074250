#include "render/env/emitters.h"

#include "config/base/memory.h"
#include "config/colour/luminance.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A lobe is cut off where it is below this fraction of its peak. At the edge of a sun that is ten thousand
 * times as strong as everything else, this loses a tenth of the light there. */
#define LOBE_CUT 1e-4f

/* Largest size of merged cells in lobe widths 1 / sqrt(s). Half of it applies to lobes that end in a crease
 * at their horizon (s = 1), because across a crease a mean and a variance do not describe the emitters of a
 * cell. */
#define MERGE_WIDTH 0.25f

/* Bits of x or y in a code; the face is stored above them. */
#define CODE_BITS 13

/* Extracts every second bit of a code. */
static uint32_t compact_bits(uint32_t code)
{
    code &= 0x55555555u;
    code = (code | code >> 1) & 0x33333333u;
    code = (code | code >> 2) & 0x0f0f0f0fu;
    code = (code | code >> 4) & 0x00ff00ffu;
    return (code | code >> 8) & 0x0000ffffu;
}

static const vec3s no_direction = {{NAN, NAN, NAN}};

/* The inverse: inserts a zero bit between all bits, for those of another number. */
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
        emitter.power.raw[c] =
            solid_angles[y * size + x] * tl_emitter_radiance(cube->texels[3 * (size_t)texel + c]);
    emitter.weight = tl_luminance(emitter.power.raw);
    emitter.variance =
        solid_angles[y * size + x] / 12; /* a square of area A has the variance A / 12 along each axis */
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

static int merges_for(int cube_size, float exponent)
{
    float texel = (float)M_PI_2 / (float)cube_size,
          widest = MERGE_WIDTH / (sqrtf(exponent) + 1 / sqrtf(exponent));
    int merges = 0;
    while (texel * (float)(2 << merges) <= widest)
        merges++;
    return merges;
}

/* Merges the emitters [first, end) into one at their luminance-weighted centroid; their variance is the mean
 * of their own variances and of their squared distances. */
static tl_emitter merge_range(const tl_emitter *first, const tl_emitter *end, uint32_t code)
{
    tl_emitter merged = {.code = code};
    for (const tl_emitter *emitter = first; emitter < end; emitter++) {
        merged.power = glms_vec3_add(merged.power, emitter->power);
        merged.weight += emitter->weight;
    }
    if (merged.weight <= 0)
        return merged;
    for (const tl_emitter *emitter = first; emitter < end; emitter++)
        merged.direction =
            glms_vec3_muladds(emitter->direction, emitter->weight / merged.weight, merged.direction);
    merged.direction = glms_vec3_normalize(merged.direction);
    for (const tl_emitter *emitter = first; emitter < end; emitter++) {
        float square = glms_vec3_distance2(emitter->direction, merged.direction);
        merged.variance += emitter->weight / merged.weight * (emitter->variance + square / 2);
    }
    return merged;
}

/* Decrease of the exponent of a blurred lobe, divided by (s + 1)(s + 2). Blurring multiplies the mean cosine
 * (s + 1) / (s + 2) by 1 - the variance along one axis. The quotient is nearly independent of s for a small
 * variance. It is bounded, because a lobe much narrower than a texel cannot result from blurring. */
static float exponent_decrease(float s, float variance)
{
    float blurred = 1 / (1 - (s + 1) / (s + 2) * (1 - fminf(variance, 0.5f))) - 2;
    return fminf(s - blurred, s / 2) / ((s + 1) * (s + 2));
}

/* Merges in place, omitting black emitters. Returns the number that remains. */
static size_t merge_all(tl_emitter *emitters, size_t count, int shift)
{
    size_t remaining = 0, next;
    for (size_t i = 0; i < count; i = next) {
        uint32_t code = emitters[i].code >> shift;
        for (next = i; next < count && emitters[next].code >> shift == code;)
            next++;
        tl_emitter merged = merge_range(emitters + i, emitters + next, code);
        if (merged.weight > 0)
            emitters[remaining++] = merged;
    }
    return remaining;
}

static void set_direction(struct tl_directions *directions, size_t i, vec3s direction)
{
    directions->x[i] = direction.x;
    directions->y[i] = direction.y;
    directions->z[i] = direction.z;
}

static void fill_block(struct tl_emitters *emitters, size_t index, const tl_emitter *items, size_t count,
                       float exponent)
{
    struct tl_emitter_block *block = &emitters->blocks[index];
    vec3s sum = {{0, 0, 0}};
    for (size_t i = 0; i < TL_LANES; i++) {
        set_direction(&block->directions, i, i < count ? items[i].direction : no_direction);
        if (i >= count)
            continue;
        block->fall[i] = exponent_decrease(exponent, items[i].variance);
        memcpy(block->power[i], items[i].power.raw, sizeof items[i].power.raw);
        sum = glms_vec3_add(sum, items[i].direction);
    }
    vec3s axis = glms_vec3_normalize(sum);
    set_direction(&emitters->axes[index / TL_LANES], index % TL_LANES, axis);
    for (size_t i = 0; i < count; i++)
        emitters->radius = fmaxf(emitters->radius, glms_vec3_angle(axis, items[i].direction));
}

/* Groups squares of 4 x 4 emitters, or fewer, into blocks: runs of the curve that share their leading
 * bits. */
static struct tl_emitters make_blocks(const tl_emitter *items, size_t count, float exponent)
{
    struct tl_emitters emitters = {0};
    for (size_t i = 0; i < count; i++)
        emitters.count += i == 0 || items[i].code / TL_LANES != items[i - 1].code / TL_LANES;
    size_t groups = (emitters.count + TL_LANES - 1) / TL_LANES;
    emitters.blocks = TL_NEW_ARRAY(struct tl_emitter_block, emitters.count);
    emitters.axes = TL_NEW_ARRAY(struct tl_directions, groups);
    for (size_t i = emitters.count; i < groups * TL_LANES; i++)
        set_direction(&emitters.axes[i / TL_LANES], i % TL_LANES, no_direction);
    for (size_t index = 0, first = 0, next; first < count; first = next, index++) {
        for (next = first; next < count && items[next].code / TL_LANES == items[first].code / TL_LANES;)
            next++;
        fill_block(&emitters, index, items + first, next - first, exponent);
    }
    return emitters;
}

struct tl_emitters tl_emitters_merge(const tl_emitter *texels, size_t count, int cube_size, float exponent)
{
    tl_emitter *items = TL_NEW_ARRAY(tl_emitter, count);
    memcpy(items, texels, count * sizeof *items);
    size_t remaining = merge_all(items, count, 2 * merges_for(cube_size, exponent));
    struct tl_emitters emitters = make_blocks(items, remaining, exponent);
    free(items);
    return emitters;
}

void tl_emitters_release(struct tl_emitters *emitters)
{
    free(emitters->blocks);
    free(emitters->axes);
    *emitters = (struct tl_emitters){0};
}

void tl_lobe_packet_set(struct tl_lobe_packet *packet, const vec3s directions[TL_LANES],
                        const float steps[TL_LANES], float s)
{
    vec3s sum = {{0, 0, 0}};
    for (size_t i = 0; i < TL_LANES; i++) {
        set_direction(&packet->directions, i, directions[i]);
        sum = glms_vec3_add(sum, directions[i]);
        float mean = (s + 1) / (s + 2) / (1 - steps[i] * steps[i] / 6);
        packet->exponent[i] = 1 / (1 - mean) - 2;
    }
    packet->axis = glms_vec3_normalize(sum);
    float farthest = 0;
    for (int i = 0; i < TL_LANES; i++)
        farthest = tl_maxf(farthest, glms_vec3_distance2(packet->axis, directions[i]));
    packet->radius = 2 * asinf(tl_minf(sqrtf(farthest) / 2, 1));
}

/* The angle from the axis of the packet beyond which all lobes are cut off. */
static float packet_reach(const struct tl_lobe_packet *packet)
{
    float min = packet->exponent[0];
    for (int i = 1; i < TL_LANES; i++)
        min = tl_minf(min, packet->exponent[i]);
    return acosf(powf(LOBE_CUT, 1 / min)) + packet->radius;
}

static float cosine_of(float angle)
{
    return angle < (float)M_PI ? cosf(angle) : -2;
}

/* Bit mask of the directions whose cosine with the axis is at least `cosine`. */
TL_INLINE uint32_t find_within(const struct tl_directions *directions, vec3s axis, float cosine)
{
    float cosines[TL_LANES];
    int32_t within[TL_LANES];
    for (int i = 0; i < TL_LANES; i++)
        cosines[i] = directions->x[i] * axis.x + directions->y[i] * axis.y + directions->z[i] * axis.z;
    for (int i = 0; i < TL_LANES; i++)
        within[i] = cosines[i] >= cosine ? 1 << i : 0;
    int32_t bits = 0;
    for (int i = 0; i < TL_LANES; i++)
        bits |= within[i];
    return (uint32_t)bits;
}

TL_INLINE void add_emitter(const struct tl_emitter_block *block, int k, const struct tl_lobe_packet *packet,
                           const float widening[TL_LANES], float sums[3][TL_LANES])
{
    const struct tl_directions *directions = &packet->directions;
    for (int i = 0; i < TL_LANES; i++) {
        float cosine = directions->x[i] * block->directions.x[k] + directions->y[i] * block->directions.y[k] +
                       directions->z[i] * block->directions.z[k];
        float exponent = packet->exponent[i] - widening[i] * block->fall[k];
        float lobe = (exponent + 1) * tl_power(cosine, exponent);
        for (int c = 0; c < 3; c++)
            sums[c][i] += lobe * block->power[k][c];
    }
}

TL_CLONES void tl_emitters_convolve(const struct tl_emitters *emitters, const struct tl_lobe_packet *packet,
                                    float out[3][TL_LANES])
{
    float angle = packet_reach(packet), min_cosine = cosine_of(angle),
          block_cosine = cosine_of(angle + emitters->radius);
    struct tl_lobe_packet own = *packet; /* a local copy has no aliases, so that it stays in registers */
    float widening[TL_LANES], sums[3][TL_LANES] = {{0}};
    for (int i = 0; i < TL_LANES; i++)
        widening[i] = (own.exponent[i] + 1) * (own.exponent[i] + 2);
    for (size_t group = 0; group * TL_LANES < emitters->count; group++) {
        uint32_t blocks = find_within(&emitters->axes[group], own.axis, block_cosine);
        for (; blocks; blocks &= blocks - 1) {
            const struct tl_emitter_block *block =
                &emitters->blocks[group * TL_LANES + (size_t)__builtin_ctz(blocks)];
            uint32_t items = find_within(&block->directions, own.axis, min_cosine);
            for (; items; items &= items - 1)
                add_emitter(block, __builtin_ctz(items), &own, widening, sums);
        }
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TL_LANES; i++)
            out[c][i] = sums[c][i] * (float)(1 / (2 * M_PI));
}
