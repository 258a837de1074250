#include "render/local/object_map.h"

#include "assets/topology/rotation.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

static void release(struct tl_object_map *map)
{
    tl_lit_texture_release(&map->texture);
    free(map->pose);
}

void tl_object_maps_release(struct tl_object_maps *maps)
{
    for (size_t i = 0; i < maps->count; i++)
        release(&maps->items[i]);
    free(maps->items);
    *maps = (struct tl_object_maps){0};
}

size_t tl_object_maps_bytes(const struct tl_object_maps *maps)
{
    size_t bytes = 0;
    for (size_t i = 0; i < maps->count; i++)
        bytes += tl_lit_texture_bytes(&maps->items[i].texture);
    return bytes;
}

void tl_object_maps_keep(struct tl_object_maps *maps, const tl_surface *const *surfaces, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < maps->count; i++) {
        struct tl_object_map *map = &maps->items[i];
        if (map->surface < count && map->revision == surfaces[map->surface]->topology_revision)
            maps->items[kept++] = *map;
        else
            release(map);
    }
    maps->count = kept;
}

struct tl_object_map *tl_object_maps_find(struct tl_object_maps *maps, const tl_surface *surface,
                                          const struct tl_object_map *key, bool *is_new)
{
    size_t i = 0;
    while (i < maps->count && (maps->items[i].surface != key->surface || maps->items[i].part != key->part))
        i++;
    if (i == maps->count) {
        maps->items = tl_resize(maps->items, ++maps->count, sizeof *maps->items);
        maps->items[i] = (struct tl_object_map){0};
    }
    struct tl_object_map *map = &maps->items[i];
    *is_new = !map->pose || map->revision != key->revision || map->side != key->side ||
              map->target != key->target || map->detail != key->detail;
    if (*is_new) {
        release(map);
        *map = *key;
        map->pose = TL_NEW_ARRAY(vec3s, surface->vertex_count);
        memcpy(map->pose, surface->positions, surface->vertex_count * sizeof *map->pose);
    }
    return map;
}

mat3s tl_object_map_turn(const struct tl_object_map *map, const tl_surface *surface)
{
    const struct tl_rotation fit = tl_rotation_fit(map->pose, surface->positions, surface->vertex_count);
    mat3s turn;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            turn.raw[column][row] = (float)fit.rows[row][column];
    return turn;
}
