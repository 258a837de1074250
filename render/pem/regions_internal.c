#include "render/pem/regions_internal.h"

#include "config/base/memory.h"
#include "config/colour/luminance.h"

#include <math.h>
#include <string.h>

static size_t texel_count(const struct tl_regions *regions)
{
    return 6 * (size_t)regions->size * (size_t)regions->size;
}

static float solid_angle_of(const struct tl_regions *regions, uint32_t texel)
{
    return regions->solid_angles[texel % ((uint32_t)regions->size * (uint32_t)regions->size)];
}

static void allocate(int size, struct tl_regions *out)
{
    tl_regions_release(out);
    out->size = size;
    out->labels = TL_NEW_ARRAY(uint16_t, texel_count(out));
    out->solid_angles = TL_NEW_ARRAY(float, texel_count(out) / 6);
    out->importance = TL_NEW_ARRAY(float, texel_count(out));
    out->texels = TL_NEW_ARRAY(uint32_t, texel_count(out));
    out->cumulative = TL_NEW_ARRAY(float, texel_count(out));
}

void tl_regions_begin(const tl_cube *cube, struct tl_regions *out)
{
    allocate(cube->size, out);
    tl_cube_solid_angles(cube->size, out->solid_angles);
    for (size_t i = 0; i < texel_count(out); i++) {
        const float *colour = cube->texels + 3 * i;
        out->importance[i] = (float)(tl_luminance_exact(colour) * (double)solid_angle_of(out, (uint32_t)i));
    }
}

/* Extracts the even bits of a Morton code. */
static int even_bits(uint32_t code)
{
    int value = 0;
    for (int bit = 0; bit < 16; bit++)
        value |= (int)(code >> (2 * bit) & 1) << bit;
    return value;
}

/* Sorts the texels by region (counting sort), in Morton order within each face. */
void tl_regions_order(struct tl_regions *regions)
{
    uint32_t next[TL_REGIONS_MAX] = {0}; /* counts, then write positions */
    int size = regions->size;
    for (size_t i = 0; i < texel_count(regions); i++)
        next[regions->labels[i]]++;
    uint32_t place = 0;
    for (int i = 0; i < regions->count; i++) {
        regions->first[i] = place;
        place += next[i];
        next[i] = regions->first[i];
    }
    regions->first[regions->count] = place;

    uint32_t side = 1;
    while (side < (uint32_t)size)
        side *= 2;
    for (int face = 0; face < 6; face++) {
        for (uint32_t code = 0; code < side * side; code++) {
            int x = even_bits(code), y = even_bits(code >> 1);
            if (x >= size || y >= size)
                continue;
            int texel = (face * size + y) * size + x;
            regions->texels[next[regions->labels[texel]]++] = (uint32_t)texel;
        }
    }
}

static void measure(struct tl_regions *regions, int index)
{
    double importance = 0, solid_angle = 0;
    double bright[3] = {0},
           uniform[3] = {0}; /* sums of directions, weighted by importance and by solid angle */
    vec3s direction = {{0, 1, 0}};
    for (uint32_t i = regions->first[index]; i < regions->first[index + 1]; i++) {
        uint32_t texel = regions->texels[i];
        double weight = (double)regions->importance[texel];
        double area = (double)solid_angle_of(regions, texel);
        direction = tl_cube_texel_direction(regions->size, (int)texel);
        importance += weight;
        solid_angle += area;
        for (int c = 0; c < 3; c++) {
            bright[c] += weight * (double)direction.raw[c];
            uniform[c] += area * (double)direction.raw[c];
        }
    }
    const double *sum = importance > 0 ? bright : uniform;
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    /* If the sum cancels out, as for a whole sphere, the direction is that of one of the texels. */
    if (length > 1e-9 * (importance > 0 ? importance : solid_angle))
        for (int c = 0; c < 3; c++)
            direction.raw[c] = (float)(sum[c] / length);
    regions->items[index] = (struct tl_region){
        .face = -1,
        .direction = direction,
        .solid_angle = (float)solid_angle,
        .importance = (float)importance,
        .cone = (float)acos(fmax(1 - solid_angle / (2 * M_PI), -1)),
    };
}

void tl_regions_measure(struct tl_regions *regions)
{
#pragma omp parallel for schedule(dynamic) if (texel_count(regions) >= TL_REGIONS_PARALLEL_TEXELS)
    for (int i = 0; i < regions->count; i++)
        measure(regions, i);
}

static double squared_angle(vec3s a, vec3s b)
{
    double half_chord = 0.5 * sqrt((double)glms_vec3_distance2(a, b));
    double angle = 2 * asin(fmin(half_chord, 1));
    return angle * angle;
}

/* The weight of a texel when the region is sampled: its importance, or in a black region its solid angle. */
static double weight_of(const struct tl_regions *regions, uint32_t texel, bool black)
{
    return (double)(black ? solid_angle_of(regions, texel) : regions->importance[texel]);
}

static void weigh(struct tl_regions *regions, int index)
{
    uint32_t first = regions->first[index], last = regions->first[index + 1];
    struct tl_region *region = &regions->items[index];
    if (first == last)
        return;
    double importance = 0, solid_angle = 0;
    for (uint32_t i = first; i < last; i++) {
        importance += weight_of(regions, regions->texels[i], false);
        solid_angle += weight_of(regions, regions->texels[i], true);
    }
    bool black = !(importance > 0);
    double total = black ? solid_angle : importance, sum = 0, squares = 0;
    for (uint32_t i = first; i < last; i++) {
        uint32_t texel = regions->texels[i];
        double weight = weight_of(regions, texel, black);
        double angle2 = squared_angle(tl_cube_texel_direction(regions->size, (int)texel), region->direction);
        sum += weight;
        /* The mean square distance from the centre of a square is a sixth of its area. */
        squares += weight * (angle2 + (double)solid_angle_of(regions, texel) / 6);
        regions->cumulative[i] = (float)(sum / total);
    }
    regions->cumulative[last - 1] = 1;
    region->spread = (float)sqrt(squares / total);
}

void tl_regions_weigh(struct tl_regions *regions)
{
#pragma omp parallel for schedule(dynamic) if (texel_count(regions) >= TL_REGIONS_PARALLEL_TEXELS)
    for (int i = 0; i < regions->count; i++)
        weigh(regions, i);
}

static vec3s power_of(const tl_cube *cube, const struct tl_regions *regions, int index)
{
    double power[3] = {0};
    for (uint32_t i = regions->first[index]; i < regions->first[index + 1]; i++) {
        uint32_t texel = regions->texels[i];
        const float *colour = cube->texels + 3 * (size_t)texel;
        for (int c = 0; c < 3; c++)
            power[c] += (double)solid_angle_of(regions, texel) * (double)colour[c];
    }
    return (vec3s){{(float)power[0], (float)power[1], (float)power[2]}};
}

void tl_regions_colour(const tl_cube *cube, struct tl_regions *regions)
{
#pragma omp parallel for schedule(dynamic) if (texel_count(regions) >= TL_REGIONS_PARALLEL_TEXELS)
    for (int i = 0; i < regions->count; i++)
        regions->items[i].power = power_of(cube, regions, i);
}
