#include "render/env/lobes.h"

#include "config/base/memory.h"
#include "config/cache/cache.h"
#include "render/env/emitters.h"
#include "render/env/exponent.h"
#include "render/env/lobes_fetch.h"
#include "render/env/version.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Texels along the side of a map. They follow the width of the lobe. The widest lobes, which end at a horizon
 * instead of fading out, need more, and the lobe of s = 1, which ends in a crease, needs most. Across the
 * crease linear interpolation between texels errs by a quarter of their distance, which is 2 sqrt(6) / side
 * in the middle of a face of the octahedron: 1.5 % of the peak of a single light (2.6 % without
 * SIDE_OF_CREASE). */
#define SIDE_PER_WIDTH  16
#define SIDE_OF_HORIZON 32
#define SIDE_OF_CREASE  32
/* Sixteen lanes process a square of the map. */
#define TILE 4
/* Samples along a side of a texel in the map of the environment itself. */
#define AREA_SAMPLES 8

float tl_exponent(int index)
{
    return powf(TL_EXPONENT_RATIO, (float)index);
}

/* Exponent that the environment itself has in the blend beyond the last exponent: that of a texel of a cube
 * with 128 texels a face, fetched bilinearly. */
#define MIRROR_EXPONENT 32768.0f

/* The best weights in L1 are linear in log(s + 1), plus a bend that hardly depends on s. For the ratio sqrt 2
 * this fit is within 0.0003 of the smallest error [test_slices.c]. */
#define BLEND_BEND 0.033f

struct tl_exponent_blend tl_exponent_blend(float s)
{
    float last = tl_exponent(TL_EXPONENT_COUNT - 1);
    s = s > 1 ? fminf(s, MIRROR_EXPONENT) : 1;
    int index = TL_EXPONENT_COUNT - 1;
    if (s < last)
        index = (int)(logf(s) / logf(TL_EXPONENT_RATIO));
    float low = tl_exponent(index),
          high = index + 1 < TL_EXPONENT_COUNT ? tl_exponent(index + 1) : MIRROR_EXPONENT;
    float t = logf((s + 1) / (low + 1)) / logf((high + 1) / (low + 1));
    t = fminf(fmaxf(t, 0), 1);
    return (struct tl_exponent_blend){index, t - BLEND_BEND * t * (1 - t)};
}

uint32_t tl_exponents_needed(float glossiness_low, float glossiness_high)
{
    struct tl_exponent_blend low = tl_exponent_blend(tl_lobe_exponent(glossiness_low));
    struct tl_exponent_blend high = tl_exponent_blend(tl_lobe_exponent(glossiness_high));
    int last = high.index + (high.weight > 0);
    return 1 | ((2u << last) - (1u << low.index));
}

/* Point on the octahedron |x| + |y| + |z| = 1, unfolded about +Y, for u and v in [-1, 1]. Below the horizon
 * the corners are folded outwards. */
static vec3s unfold(float u, float v)
{
    float y = 1 - fabsf(u) - fabsf(v);
    if (y >= 0)
        return (vec3s){{u, y, v}};
    return (vec3s){{copysignf(1 - fabsf(v), u), y, copysignf(1 - fabsf(u), v)}};
}

/* Mean square, over the two axes of the map, of the angle of a step of 1 in u or v: at a point p of the
 * octahedron a step (1, -1, 0) turns the direction w by |step - (step . w) w| / |p|. */
static float square_scale(vec3s p)
{
    float square = glms_vec3_norm2(p), sum = 0;
    for (int axis = 0; axis < 3; axis += 2) {
        float along = fabsf(p.raw[axis]) - fabsf(p.y); /* step . p up to the common signs */
        sum += (2 - along * along / square) / square;
    }
    return sum / 2;
}

static void set_packet(int side, int left, int top, float s, struct tl_lobe_packet *packet)
{
    float step = 2 / (float)side, steps[TL_LANES];
    vec3s directions[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        int column = left + i % TILE, row = top + i / TILE;
        vec3s p = unfold(((float)column + 0.5f) * step - 1, ((float)row + 0.5f) * step - 1);
        directions[i] = glms_vec3_normalize(p);
        steps[i] = step * sqrtf(square_scale(p));
    }
    tl_lobe_packet_set(packet, directions, steps, s);
}

static float *texel_of(const struct tl_lobe_map *map, int x, int y)
{
    return map->texels + 4 * ((size_t)(y + 1) * (size_t)(map->side + 2) + (size_t)(x + 1));
}

/* Beyond a side of the unfolded octahedron the same side continues in reverse order. */
static void fill_border(const struct tl_lobe_map *map)
{
    int last = map->side - 1;
    for (int i = 0; i <= last; i++) {
        memcpy(texel_of(map, i, -1), texel_of(map, last - i, 0), 4 * sizeof(float));
        memcpy(texel_of(map, i, last + 1), texel_of(map, last - i, last), 4 * sizeof(float));
        memcpy(texel_of(map, -1, i), texel_of(map, 0, last - i), 4 * sizeof(float));
        memcpy(texel_of(map, last + 1, i), texel_of(map, last, last - i), 4 * sizeof(float));
    }
    for (int corner = 0; corner < 4; corner++) {
        int x = corner & 1 ? last : 0, y = corner & 2 ? last : 0;
        memcpy(texel_of(map, x ? last + 1 : -1, y ? last + 1 : -1), texel_of(map, last - x, last - y),
               4 * sizeof(float));
    }
}

static struct tl_lobe_map create_map(int side)
{
    size_t texels = (size_t)(side + 2) * (size_t)(side + 2);
    return (struct tl_lobe_map){side, TL_NEW_ARRAY(float, 4 * texels)};
}

static int whole_tiles(float side)
{
    return TILE * (int)ceilf(side / TILE);
}

static int side_for(float s)
{
    float width = 1 / sqrtf(s);
    return whole_tiles(SIDE_PER_WIDTH / width + SIDE_OF_HORIZON * width + (s > 1 ? 0 : SIDE_OF_CREASE));
}

static struct tl_lobe_map convolve(const tl_emitter *texels, int cube_size, float s)
{
    size_t count = 6 * (size_t)cube_size * (size_t)cube_size;
    struct tl_emitters emitters = tl_emitters_merge(texels, count, cube_size, s);
    struct tl_lobe_map map = create_map(side_for(s));
    int tiles = map.side / TILE;
#pragma omp parallel for schedule(dynamic, 4)
    for (int tile = 0; tile < tiles * tiles; tile++) {
        struct tl_lobe_packet packet;
        float colour[3][TL_LANES];
        int left = tile % tiles * TILE, top = tile / tiles * TILE;
        set_packet(map.side, left, top, s, &packet);
        tl_emitters_convolve(&emitters, &packet, colour);
        for (int i = 0; i < TL_LANES; i++)
            for (int c = 0; c < 3; c++)
                texel_of(&map, left + i % TILE, top + i / TILE)[c] = colour[c][i];
    }
    fill_border(&map);
    tl_emitters_release(&emitters);
    return map;
}

/* The side of the environment's own map: as many texels as the cube has. */
static int side_for_cube(const tl_cube *cube)
{
    return whole_tiles(sqrtf(6) * (float)cube->size);
}

/* The map of the environment itself: the mean radiance over every texel. */
static struct tl_lobe_map sample_area(const tl_cube *cube)
{
    struct tl_lobe_map map = create_map(side_for_cube(cube));
    float step = 2 / (float)(map.side * AREA_SAMPLES);
#pragma omp parallel for
    for (int y = 0; y < map.side; y++) {
        for (int x = 0; x < map.side; x++) {
            float *texel = texel_of(&map, x, y);
            for (int i = 0; i < AREA_SAMPLES * AREA_SAMPLES; i++) {
                int column = x * AREA_SAMPLES + i % AREA_SAMPLES, row = y * AREA_SAMPLES + i / AREA_SAMPLES;
                vec3s p = unfold(((float)column + 0.5f) * step - 1, ((float)row + 0.5f) * step - 1);
                const float *source = cube->texels + 3 * (size_t)tl_cube_texel(cube->size, p);
                for (int c = 0; c < 3; c++)
                    texel[c] += tl_emitter_radiance(source[c]) / (AREA_SAMPLES * AREA_SAMPLES);
            }
        }
    }
    fill_border(&map);
    return map;
}

static tl_emitter *collect_all(const tl_cube *cube)
{
    int size = cube->size, half = (size + 1) / 2;
    float *solid_angles = TL_NEW_ARRAY(float, (size_t)size *(size_t)size);
    for (int y = 0; y < half; y++)
        for (int x = 0; x < half; x++)
            solid_angles[y * size + x] = solid_angles[y * size + size - 1 - x] =
                solid_angles[(size - 1 - y) * size + x] = solid_angles[(size - 1 - y) * size + size - 1 - x] =
                    tl_cube_solid_angle(size, x, y);
    uint32_t *order = tl_emitters_order(size);
    tl_emitter *texels = tl_emitters_collect(cube, solid_angles, order, 6 * (size_t)size * (size_t)size);
    free(order);
    free(solid_angles);
    return texels;
}

/* ---- Maps that are kept between runs ---- */

static size_t map_bytes(const struct tl_lobe_map *map)
{
    size_t side = (size_t)map->side + 2;
    return map->side > 0 ? 4 * side * side * sizeof(float) : 0;
}

static struct tl_cache_key key_of(const tl_cube *cube)
{
    struct tl_cache_key key = tl_cache_key_begin();
    size_t size = (size_t)cube->size;
    tl_cache_key_add(&key, TL_ENV_VERSION, sizeof TL_ENV_VERSION);
    tl_cache_key_add(&key, &size, sizeof size);
    tl_cache_key_add(&key, cube->texels, 18 * size * size * sizeof *cube->texels);
    return key;
}

static bool load_map(struct tl_cache_key key, int index, int side, struct tl_lobe_map *map)
{
    struct tl_lobe_map kept = create_map(side);
    tl_cache_key_add(&key, &index, sizeof index);
    if (tl_cache_read(&key, kept.texels, map_bytes(&kept))) {
        *map = kept;
        return true;
    }
    free(kept.texels);
    return false;
}

static void keep_map(struct tl_cache_key key, int index, const struct tl_lobe_map *map)
{
    tl_cache_key_add(&key, &index, sizeof index);
    tl_cache_store(&key, map->texels, map_bytes(map));
}

void tl_lobes_make(struct tl_lobes *lobes, const tl_cube *cube, uint32_t needed)
{
    const uint32_t missing = needed & ~lobes->made;
    const bool is_black = missing && tl_cube_is_black(cube);
    const bool is_kept = tl_cache_is_used() && missing && !is_black;
    const struct tl_cache_key key = is_kept ? key_of(cube) : tl_cache_key_begin();
    tl_emitter *texels = NULL;
    for (int i = 0; i <= TL_EXPONENT_COUNT; i++) {
        struct tl_lobe_map *map = &lobes->maps[i];
        const bool is_itself = i == TL_EXPONENT_COUNT;
        const int side = is_itself ? side_for_cube(cube) : side_for(tl_exponent(i));
        if (!(missing & 1u << i) || (is_kept && load_map(key, i, side, map)))
            continue;
        if (is_black) { /* black is black at any size */
            *map = create_map(1);
            continue;
        }
        if (!is_itself && !texels)
            texels = collect_all(cube);
        if (is_itself)
            *map = sample_area(cube);
        else
            *map = convolve(texels, cube->size, tl_exponent(i));
        if (is_kept)
            keep_map(key, i, map);
    }
    lobes->made |= missing;
    free(texels);
}

static struct tl_lobe_map apply(const struct tl_lobe_map *source, float exponent,
                                tl_lobe_map_function *function, const void *context)
{
    struct tl_lobe_map map = create_map(source->side);
    float step = 2 / (float)source->side;
#pragma omp parallel for schedule(dynamic, 4)
    for (int y = 0; y < source->side; y++)
        for (int x = 0; x < source->side; x++) {
            const float *light = texel_of(source, x, y);
            vec3s direction = unfold(((float)x + 0.5f) * step - 1, ((float)y + 0.5f) * step - 1);
            vec3s result = function(glms_vec3_normalize(direction), exponent,
                                    (vec3s){{light[0], light[1], light[2]}}, context);
            memcpy(texel_of(&map, x, y), result.raw, sizeof result);
        }
    fill_border(&map);
    return map;
}

struct tl_lobes tl_lobes_map(const struct tl_lobes *from, uint32_t which, tl_lobe_map_function *function,
                             const void *context, const struct tl_cache_key *key)
{
    struct tl_lobes lobes = {.made = from->made & which};
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++) {
        if (!(lobes.made & 1u << k))
            continue;
        const struct tl_lobe_map *source = &from->maps[k];
        struct tl_cache_key of_map = *key;
        if (tl_cache_is_used())
            tl_cache_key_add(&of_map, source->texels, map_bytes(source));
        if (load_map(of_map, k, source->side, &lobes.maps[k]))
            continue;
        lobes.maps[k] =
            apply(source, k < TL_EXPONENT_COUNT ? tl_exponent(k) : MIRROR_EXPONENT, function, context);
        keep_map(of_map, k, &lobes.maps[k]);
    }
    return lobes;
}

struct tl_lobes tl_lobes_copy(const struct tl_lobes *lobes)
{
    struct tl_lobes copy = {.made = lobes->made};
    for (size_t i = 0; i < TL_COUNT(copy.maps); i++) {
        if (lobes->maps[i].side == 0)
            continue;
        copy.maps[i] = create_map(lobes->maps[i].side);
        memcpy(copy.maps[i].texels, lobes->maps[i].texels, map_bytes(&lobes->maps[i]));
    }
    return copy;
}

void tl_lobes_keep(struct tl_lobes *lobes, uint32_t which)
{
    for (size_t i = 0; i < TL_COUNT(lobes->maps); i++)
        if (!(which & 1u << i)) {
            free(lobes->maps[i].texels);
            lobes->maps[i] = (struct tl_lobe_map){0};
        }
    lobes->made &= which;
}

void tl_lobes_merge(struct tl_lobes *lobes, struct tl_lobes *more)
{
    for (size_t i = 0; i < TL_COUNT(lobes->maps); i++)
        if (lobes->maps[i].side == 0) {
            lobes->maps[i] = more->maps[i];
            more->maps[i] = (struct tl_lobe_map){0};
        }
    lobes->made |= more->made;
    tl_lobes_release(more);
}

void tl_lobes_release(struct tl_lobes *lobes)
{
    for (size_t i = 0; i < TL_COUNT(lobes->maps); i++)
        free(lobes->maps[i].texels);
    *lobes = (struct tl_lobes){0};
}

vec3s tl_lobes_fetch(const struct tl_lobes *lobes, vec3s direction, struct tl_exponent_blend blend)
{
    assert(lobes->maps[blend.index].side);
    tl_quad colour = tl_lobes_fetch_quad(lobes, octahedral_place(direction), blend);
    return (vec3s){{colour[0], colour[1], colour[2]}};
}

size_t tl_lobes_bytes(const struct tl_lobes *lobes)
{
    size_t bytes = 0;
    for (size_t i = 0; i < TL_COUNT(lobes->maps); i++)
        bytes += map_bytes(&lobes->maps[i]);
    return bytes;
}

size_t tl_lobes_texels(uint32_t exponents)
{
    size_t texels = 0;
    for (int i = 0; i < TL_EXPONENT_COUNT; i++) {
        const size_t side = (size_t)side_for(tl_exponent(i));
        texels += exponents & 1u << i ? side * side : 0;
    }
    return texels;
}
