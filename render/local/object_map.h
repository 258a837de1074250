/* Normal maps in object space [Heidrich and Seidel 1999, 5.1]: the normals of a part with its bumps, at
 * texels over its UVs, as they are where the part is first drawn. One matrix takes them to the space of the
 * lamps from then on. Cloth has no such matrix: the rotation that brings the vertices of that pose nearest to
 * where they are now, in the mean of squares, stands for it. What moves rigidly is exact; bends since then
 * are not in the map, and the light is that of the pose in which it was made. A map stays until its surface
 * or what it was made with changes, drawn or not, because its pose does not come again. Needs the GL context
 * of its tl_gpu. */
#ifndef TOILE_RENDER_LOCAL_OBJECT_MAP_H
#define TOILE_RENDER_LOCAL_OBJECT_MAP_H

#include "render/local/lit_texture.h"

struct tl_object_map {
    size_t surface, part; /* with the next four the key */
    uint64_t revision;
    int side, target;
    uint64_t detail;               /* hash of its options */
    struct tl_lit_texture texture; /* one layer: (n + 1) / 2, cover */
    vec3s *pose;                   /* positions of the surface's vertices */
};

struct tl_object_maps {
    size_t count;
    struct tl_object_map *items;
};

/* Frees and zeroes. */
void tl_object_maps_release(struct tl_object_maps *maps);
size_t tl_object_maps_bytes(const struct tl_object_maps *maps);

/* Destroys the maps of surfaces that are no longer or changed. */
void tl_object_maps_keep(struct tl_object_maps *maps, const tl_surface *const *surfaces, size_t count);
/* The map of a part, valid until the next call. It is empty, for the caller to draw, where it is new. */
struct tl_object_map *tl_object_maps_find(struct tl_object_maps *maps, const tl_surface *surface,
                                          const struct tl_object_map *key, bool *is_new);
/* The rotation from the pose of the map to where the surface is now. */
mat3s tl_object_map_turn(const struct tl_object_map *map, const tl_surface *surface);

#endif
