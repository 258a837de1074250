#include "render/env/mip_levels.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static struct tl_sphere_map map_of(enum tl_layout layout, int size)
{
    int64_t width, height;
    tl_layout_extent(layout, size, &width, &height);
    return (struct tl_sphere_map){layout, (int)width, (int)height};
}

static size_t texel_count(const struct tl_sphere_map *map)
{
    return (size_t)map->width * (size_t)map->height;
}

static double *first_solid_angles(const struct tl_sphere_map *map)
{
    double *solid_angles = TL_NEW_ARRAY(double, texel_count(map));
#pragma omp parallel for
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++)
            solid_angles[(size_t)y * (size_t)map->width + (size_t)x] = tl_layout_solid_angle(map, x, y);
    return solid_angles;
}

/* Indices of the children finer texels under one. The pieces of every layout have even sides. */
static void find_children(int finer_width, int x, int y, size_t children[4])
{
    for (int i = 0; i < 4; i++)
        children[i] = (size_t)(2 * y + (i >> 1)) * (size_t)finer_width + (size_t)(2 * x + (i & 1));
}

static double *summed_solid_angles(const struct tl_mip_levels *levels, int level)
{
    const struct tl_sphere_map *map = &levels->maps[level];
    double *solid_angles = TL_NEW_ARRAY(double, texel_count(map));
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            size_t children[4];
            find_children(2 * map->width, x, y, children);
            for (int i = 0; i < 4; i++)
                solid_angles[(size_t)y * (size_t)map->width + (size_t)x] +=
                    levels->solid_angles[level - 1][children[i]];
        }
    return solid_angles;
}

struct tl_mip_levels tl_mip_levels_create(enum tl_layout layout, int size)
{
    assert(size > 0 && (size & (size - 1)) == 0 && size <= 1 << (TL_MIP_LEVELS_MAX - 1));
    struct tl_mip_levels levels = {.count = 0};
    for (; size > 0; size /= 2) {
        int level = levels.count++;
        levels.maps[level] = map_of(layout, size);
        levels.solid_angles[level] =
            level == 0 ? first_solid_angles(&levels.maps[0]) : summed_solid_angles(&levels, level);
    }
    return levels;
}

void tl_mip_levels_release(struct tl_mip_levels *levels)
{
    for (int level = 0; level < levels->count; level++)
        free(levels->solid_angles[level]);
    *levels = (struct tl_mip_levels){0};
}

bool tl_mip_levels_reads_first(const struct tl_sphere_map *map, int x, int y)
{
    if (map->layout != TL_LAYOUT_PARABOLOID)
        return true;
    double radius = 0.5 * map->height;
    return x < map->height && hypot(x + 0.5 - radius, y + 0.5 - radius) < radius - 1;
}

/* The point on the sphere whose colour a texel outside of the discs gets: in the other paraboloid in the same
 * direction, or at the nearest point of the rim of the ball. Returns its piece. */
static int find_replacement(const struct tl_sphere_map *map, int x, int y, double *found_x, double *found_y)
{
    if (map->layout == TL_LAYOUT_PARABOLOID)
        return tl_layout_locate(map, tl_layout_direction(map, x + 0.5, y + 0.5), found_x, found_y);
    double radius = 0.5 * map->height, across = x + 0.5 - radius, down = y + 0.5 - radius;
    double length = hypot(across, down);
    *found_x = radius * (1 + across / length);
    *found_y = radius * (1 + down / length);
    return 0;
}

/* Fills a texel by a bilinear fetch at that point, among the texels that cover some of the sphere. */
static void fill_texel(const struct tl_mip_levels *levels, int level, int x, int y, float *texels)
{
    const struct tl_sphere_map *map = &levels->maps[level];
    double point_x, point_y, weights = 0, sum[3] = {0, 0, 0};
    struct tl_layout_piece piece = tl_layout_piece(map, find_replacement(map, x, y, &point_x, &point_y));
    int left = (int)floor(point_x - 0.5), top = (int)floor(point_y - 0.5);
    for (int i = 0; i < 4; i++) {
        int column = left + (i & 1), row = top + (i >> 1);
        if (column < piece.x0 || column >= piece.x1 || row < piece.y0 || row >= piece.y1)
            continue;
        size_t texel = (size_t)row * (size_t)map->width + (size_t)column;
        double weight = fmax(1 - fabs(point_x - 0.5 - column), 0) * fmax(1 - fabs(point_y - 0.5 - row), 0);
        if (levels->solid_angles[level][texel] <= 0)
            continue;
        weights += weight;
        for (size_t c = 0; c < 3; c++)
            sum[c] += weight * (double)texels[4 * texel + c];
    }
    for (size_t c = 0; c < 3 && weights > 0; c++)
        texels[4 * ((size_t)y * (size_t)map->width + (size_t)x) + c] = (float)(sum[c] / weights);
}

static void fill_outside(const struct tl_mip_levels *levels, int level, float *texels)
{
    const struct tl_sphere_map *map = &levels->maps[level];
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++)
            if (levels->solid_angles[level][(size_t)y * (size_t)map->width + (size_t)x] <= 0)
                fill_texel(levels, level, x, y, texels);
}

void tl_mip_levels_reduce(const struct tl_mip_levels *levels, int level, const float *finer, float *coarser)
{
    const struct tl_sphere_map *map = &levels->maps[level];
    const double *weights = levels->solid_angles[level - 1];
#pragma omp parallel for
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            size_t children[4], texel = (size_t)y * (size_t)map->width + (size_t)x;
            double sum[3] = {0, 0, 0}, whole = levels->solid_angles[level][texel];
            find_children(2 * map->width, x, y, children);
            for (int i = 0; i < 4; i++)
                for (size_t c = 0; c < 3; c++)
                    sum[c] += weights[children[i]] * (double)finer[4 * children[i] + c];
            for (size_t c = 0; c < 3; c++)
                coarser[4 * texel + c] = whole > 0 ? (float)(sum[c] / whole) : 0;
            coarser[4 * texel + 3] = tl_mip_levels_reads_first(map, x, y) ? 1 : 0;
        }
    fill_outside(levels, level, coarser);
}
