#include "render/pem/slices.h"

#include "config/base/memory.h"
#include "render/env/emitters.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Texels of a map per radian at its centre. They follow the width of the lobe; the widest lobes, which end at
 * a horizon instead of fading out, need more. The worst lobe errs by 0.8 %. With 2.5 and 5, at 0.7 of the
 * memory, it errs by 1.2 %; the limit is 1 %. (If the size of a map followed its own region instead of the
 * widest one, it would take 0.72 of the memory with 96 regions and 0.80 with 384.) */
#define DENSITY_PER_WIDTH  3
#define DENSITY_OF_HORIZON 6
/* The map ends where the lobe is below this fraction of its peak. The lost energy is a smaller fraction,
 * because the tail of the lobe beyond cosine c holds c^(s + 1). */
#define CROP 3e-4f
/* A ring of black texels around the map, so that a fetch outside, clamped to the edge, returns black. */
#define RING 1
#define TILE 4
/* Samples along a side of a texel in the map of the region itself. */
#define AREA_SAMPLES 4

/* Distance from the centre of Lambert's map of directions at an angle from its axis. */
static float lambert(float angle)
{
    return 2 * sinf(fminf(angle, (float)M_PI) / 2);
}

/* The direction of a point of the map; points beyond radius 2, the antipode, are clamped to it. */
static vec3s unproject(const struct tl_slice_frame *frame, float x, float y)
{
    float square = fminf(x * x + y * y, 4), sine = sqrtf(1 - square / 4);
    vec3s d = glms_vec3_scale(frame->direction, 1 - square / 2);
    d = glms_vec3_muladds(frame->right, x * sine, d);
    return glms_vec3_muladds(frame->up, y * sine, d);
}

/* Mean square, over two axes, of the angle of a step of 1 in the map. */
static float square_scale(float x, float y)
{
    float square = fmaxf(1 - (x * x + y * y) / 4, 0.05f); /* the stretch is unbounded at the antipode */
    return (1 / square + square) / 2;
}

/* Approximate axis of the smallest cone around the directions: repeated steps of decreasing size towards the
 * farthest direction [Badoiu and Clarkson 2003]. */
#define CENTRE_STEPS 60
static vec3s middle_of(const tl_emitter *emitters, size_t count, vec3s start)
{
    vec3s centre = start;
    for (int step = 1; step <= CENTRE_STEPS && count > 0; step++) {
        size_t farthest = 0;
        float min = 2;
        for (size_t i = 0; i < count; i++) {
            float cosine = emitters[i].weight > 0 ? glms_vec3_dot(emitters[i].direction, centre) : 2;
            if (cosine < min) {
                min = cosine;
                farthest = i;
            }
        }
        vec3s towards = glms_vec3_sub(emitters[farthest].direction, centre);
        centre = glms_vec3_normalize(glms_vec3_muladds(towards, 1 / (float)(step + 1), centre));
    }
    return centre;
}

struct region {
    size_t count;
    tl_emitter *texels;
    float radius; /* rad: of the cone about the direction of the frame that contains the texels */
};

static float angle_between(vec3s a, vec3s b)
{
    return 2 * asinf(fminf(glms_vec3_distance(a, b) / 2, 1));
}

static struct region prepare(const tl_cube *cube, const struct tl_regions *regions, int i,
                             struct tl_slice_frame *frame)
{
    struct region region = {.count = regions->first[i + 1] - regions->first[i]};
    region.texels =
        tl_emitters_collect(cube, regions->solid_angles, regions->texels + regions->first[i], region.count);
    frame->direction = middle_of(region.texels, region.count, regions->items[i].direction);
    frame->right = glms_vec3_normalize(glms_vec3_ortho(frame->direction));
    frame->up = glms_vec3_cross(frame->direction, frame->right);
    for (size_t k = 0; k < region.count; k++)
        if (region.texels[k].weight > 0)
            region.radius = fmaxf(region.radius, angle_between(frame->direction, region.texels[k].direction));
    return region;
}

/* The angle beyond which the lobe is cut off. */
static float reach(int exponent, int cube_size)
{
    if (exponent == TL_EXPONENT_COUNT)
        return 1.5f / (float)cube_size; /* half of the diagonal of a texel at the centre of a face */
    return acosf(powf(CROP, 1 / tl_exponent(exponent)));
}

static float step_of(int exponent, int cube_size)
{
    if (exponent == TL_EXPONENT_COUNT)
        return (float)sqrt(4 * M_PI / 6) / (float)cube_size;
    float width = 1 / sqrtf(tl_exponent(exponent));
    return 1 / (DENSITY_PER_WIDTH / width + DENSITY_OF_HORIZON * width);
}

/* Sets side and scales of all maps of one exponent. The widest region determines the side. */
static void lay_out(struct tl_slices *slices, const struct region *regions, int exponent, int cube_size)
{
    float lobe = reach(exponent, cube_size), widest = 0;
    for (int i = 0; i < slices->region_count; i++)
        widest = fmaxf(widest, lambert(regions[i].radius + lobe));
    int inner = (int)ceilf(2 * widest / step_of(exponent, cube_size)) + 1;
    int side = TILE * ((inner + 2 * RING + TILE - 1) / TILE);
    slices->side[exponent] = side;
    for (int i = 0; i < slices->region_count; i++) {
        /* The cut-off angle lies on the centres of the outermost texels inside the ring. */
        float half = lambert(regions[i].radius + lobe) * (float)side / (float)(side - 1 - 2 * RING);
        slices->frames[i].scale[exponent] = 0.5f / half;
    }
}

static float *texel_of(const struct tl_slices *slices, int exponent, int region, int x, int y)
{
    size_t side = (size_t)slices->side[exponent];
    return slices->texels[exponent] + 3 * (((size_t)region * side + (size_t)y) * side + (size_t)x);
}

/* True for texels of the ring, which are black. A map of all directions has no ring. */
static bool in_ring(const struct tl_slices *slices, int exponent, int region, int x, int y)
{
    int last = slices->side[exponent] - 1;
    bool border = x < RING || y < RING || x > last - RING || y > last - RING;
    return border && slices->frames[region].scale[exponent] > 0.25f;
}

static void convolve_tile(const struct tl_slices *slices, int exponent, int region, int left, int top,
                          const struct tl_emitters *emitters)
{
    const struct tl_slice_frame *frame = &slices->frames[region];
    float step = 1 / (frame->scale[exponent] * (float)slices->side[exponent]);
    float middle = (float)slices->side[exponent] / 2 - 0.5f;
    vec3s directions[TL_LANES];
    float steps[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        int column = left + i % TILE, row = top + i / TILE;
        float x = ((float)column - middle) * step, y = ((float)row - middle) * step;
        directions[i] = unproject(frame, x, y);
        steps[i] = step * sqrtf(square_scale(x, y));
    }
    struct tl_lobe_packet packet;
    float colour[3][TL_LANES];
    tl_lobe_packet_set(&packet, directions, steps, tl_exponent(exponent));
    tl_emitters_convolve(emitters, &packet, colour);
    for (int i = 0; i < TL_LANES; i++) {
        int x = left + i % TILE, y = top + i / TILE;
        bool black = in_ring(slices, exponent, region, x, y);
        for (int c = 0; c < 3; c++)
            texel_of(slices, exponent, region, x, y)[c] = black ? 0 : colour[c][i];
    }
}

static void convolve(const struct tl_slices *slices, int exponent, int region, const struct region *source,
                     int cube_size)
{
    struct tl_emitters emitters =
        tl_emitters_merge(source->texels, source->count, cube_size, tl_exponent(exponent));
    for (int top = 0; top < slices->side[exponent]; top += TILE)
        for (int left = 0; left < slices->side[exponent]; left += TILE)
            convolve_tile(slices, exponent, region, left, top, &emitters);
    tl_emitters_release(&emitters);
}

/* The map of the region itself: the mean radiance over every texel. */
static void sample_area(const struct tl_slices *slices, int region, const tl_cube *cube,
                        const struct tl_regions *regions)
{
    const struct tl_slice_frame *frame = &slices->frames[region];
    int side = slices->side[TL_EXPONENT_COUNT], fine = side * AREA_SAMPLES;
    float step = 1 / (frame->scale[TL_EXPONENT_COUNT] * (float)fine), middle = (float)fine / 2 - 0.5f;
    for (int i = 0; i < fine * fine; i++) {
        int column = i % fine, row = i / fine;
        vec3s direction = unproject(frame, ((float)column - middle) * step, ((float)row - middle) * step);
        size_t source = (size_t)tl_cube_texel(cube->size, direction);
        if (regions->labels[source] != region)
            continue;
        float *target =
            texel_of(slices, TL_EXPONENT_COUNT, region, column / AREA_SAMPLES, row / AREA_SAMPLES);
        for (size_t c = 0; c < 3; c++)
            target[c] += tl_emitter_radiance(cube->texels[3 * source + c]) / (AREA_SAMPLES * AREA_SAMPLES);
    }
}

static struct region *prepare_all(const tl_cube *cube, const struct tl_regions *regions,
                                  struct tl_slice_frame *frames)
{
    struct region *sources = TL_NEW_ARRAY(struct region, (size_t)regions->count);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < regions->count; i++)
        sources[i] = prepare(cube, regions, i, &frames[i]);
    return sources;
}

static void release_all(struct region *sources, int count)
{
    for (int i = 0; i < count; i++)
        free(sources[i].texels);
    free(sources);
}

static void lay_out_all(struct tl_slices *slices, const struct region *sources, uint32_t exponents,
                        int cube_size)
{
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++)
        if (exponents & 1u << k)
            lay_out(slices, sources, k, cube_size);
    slices->made |= exponents;
}

void tl_slices_make(struct tl_slices *slices, const tl_cube *cube, const struct tl_regions *regions,
                    uint32_t needed)
{
    uint32_t missing = needed & ~slices->made;
    if (!missing)
        return;
    slices->region_count = regions->count;
    struct region *sources = prepare_all(cube, regions, slices->frames);
    lay_out_all(slices, sources, missing, cube->size);
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++)
        if (missing & 1u << k)
            slices->texels[k] = TL_NEW_ARRAY(float, 3 * (size_t)regions->count * (size_t)slices->side[k] *
                                                        (size_t)slices->side[k]);
#pragma omp parallel for collapse(2) schedule(dynamic)
    for (int k = TL_EXPONENT_COUNT; k >= 0; k--) { /* the most expensive first */
        for (int i = 0; i < regions->count; i++) {
            if (!(missing & 1u << k))
                continue;
            if (k == TL_EXPONENT_COUNT)
                sample_area(slices, i, cube, regions);
            else
                convolve(slices, k, i, &sources[i], cube->size);
        }
    }
    release_all(sources, regions->count);
}

size_t tl_slices_bytes_of(const tl_cube *cube, const struct tl_regions *regions, uint32_t exponents)
{
    struct tl_slices *slices = TL_NEW(struct tl_slices);
    slices->region_count = regions->count;
    struct region *sources = prepare_all(cube, regions, slices->frames);
    lay_out_all(slices, sources, exponents, cube->size);
    size_t bytes = tl_slices_bytes(slices);
    release_all(sources, regions->count);
    free(slices);
    return bytes;
}

void tl_slices_release(struct tl_slices *slices)
{
    for (size_t i = 0; i < TL_COUNT(slices->texels); i++)
        free(slices->texels[i]);
    *slices = (struct tl_slices){0};
}

/* Bilinear fetch; outside of the map the black texels of the ring. */
static vec3s fetch(const struct tl_slices *slices, int exponent, int region, float x, float y)
{
    assert(slices->texels[exponent]);
    int side = slices->side[exponent];
    float last = (float)(side - 1), scale = slices->frames[region].scale[exponent];
    x = (0.5f + x * scale) * (float)side - 0.5f;
    y = (0.5f + y * scale) * (float)side - 0.5f;
    x = x > 0 ? x < last ? x : last : 0; /* NaN becomes 0, too */
    y = y > 0 ? y < last ? y : last : 0;
    int column = (int)x, row = (int)y;
    column -= column == side - 1;
    row -= row == side - 1;
    float right = x - (float)column, below = y - (float)row;
    const float *top = texel_of(slices, exponent, region, column, row), *bottom = top + 3 * (size_t)side;
    vec3s colour;
    for (int c = 0; c < 3; c++) {
        float upper = top[c] + right * (top[c + 3] - top[c]);
        float lower = bottom[c] + right * (bottom[c + 3] - bottom[c]);
        colour.raw[c] = upper + below * (lower - upper);
    }
    return colour;
}

vec3s tl_slices_fetch(const struct tl_slices *slices, int region, vec3s direction,
                      struct tl_exponent_blend blend)
{
    const struct tl_slice_frame *frame = &slices->frames[region];
    float above = 1 + glms_vec3_dot(direction, frame->direction), x = 2, y = 0; /* the antipode */
    if (above > 1e-6f) {
        x = glms_vec3_dot(direction, frame->right) * sqrtf(2 / above);
        y = glms_vec3_dot(direction, frame->up) * sqrtf(2 / above);
    }
    vec3s colour = fetch(slices, blend.index, region, x, y);
    if (blend.weight > 0) /* the next map need not exist otherwise */
        colour = glms_vec3_lerp(colour, fetch(slices, blend.index + 1, region, x, y), blend.weight);
    return colour;
}

size_t tl_slices_bytes(const struct tl_slices *slices)
{
    size_t texels = 0;
    for (size_t i = 0; i < TL_COUNT(slices->side); i++)
        if (slices->made & 1u << i)
            texels += (size_t)slices->side[i] * (size_t)slices->side[i];
    return 4 * texels * (size_t)slices->region_count;
}
