#include "render/envmap/prefiltered_map.h"

#include "config/base/memory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Look-ups along the side of a texel for the environment itself, whose texels have edges. Lobes are smooth
 * and need one. */
#define EDGE_LOOK_UPS 2

static vec3s mean_over_texel(const struct tl_sphere_map *map, const struct tl_lobes *lobes, int exponent,
                             const mat3s *turn, int x, int y)
{
    int side = exponent == TL_EXPONENT_COUNT ? EDGE_LOOK_UPS : 1;
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < side * side; i++) {
        int column = i % side, row = i / side;
        double at_x = x + (column + 0.5) / side, at_y = y + (row + 0.5) / side;
        vec3s direction = glms_mat3_mulv(*turn, tl_layout_direction(map, at_x, at_y));
        sum = glms_vec3_add(sum,
                            tl_lobes_fetch(lobes, direction, (struct tl_exponent_blend){.index = exponent}));
    }
    return glms_vec3_scale(sum, 1 / (float)(side * side));
}

struct tl_prefiltered_map tl_prefiltered_map_make(const struct tl_mip_levels *levels,
                                                  const struct tl_lobes *lobes, int exponent, mat3s turn)
{
    const struct tl_sphere_map *map = &levels->maps[0];
    struct tl_prefiltered_map picture = {.level_count = levels->count};
    assert(levels->count > 0);
    for (int level = 0; level < levels->count; level++)
        picture.texels[level] =
            TL_NEW_ARRAY(float, 4 * (size_t)levels->maps[level].width * (size_t)levels->maps[level].height);
#pragma omp parallel for
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            float *texel = picture.texels[0] + 4 * ((size_t)y * (size_t)map->width + (size_t)x);
            vec3s light = mean_over_texel(map, lobes, exponent, &turn, x, y);
            memcpy(texel, light.raw, sizeof light);
            texel[3] = tl_mip_levels_reads_first(map, x, y) ? 1 : 0;
        }
    for (int level = 1; level < levels->count; level++)
        tl_mip_levels_reduce(levels, level, picture.texels[level - 1], picture.texels[level]);
    return picture;
}

void tl_prefiltered_map_release(struct tl_prefiltered_map *picture)
{
    for (int level = 0; level < picture->level_count; level++)
        free(picture->texels[level]);
    *picture = (struct tl_prefiltered_map){0};
}
