/* The textures that detail derives from the maps of materials: heights, horizons, cones, moments of normals.
 * Made only if an option needs them. Owns its textures; needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_DETAIL_MAPS_H
#define TOILE_RENDER_DETAIL_MAPS_H

#include "assets/base/surface.h"
#include "render/detail/options.h"
#include "render/gpu/gpu.h"

/* Texture units relative to the first one, in the order of the bindings of detail.glsl. */
enum tl_detail_unit {
    TL_DETAIL_HEIGHTS,
    TL_DETAIL_HORIZONS,
    TL_DETAIL_OWN_MOMENTS,
    TL_DETAIL_WEAVE_MOMENTS,
    TL_DETAIL_CONES,
    TL_DETAIL_UNITS
};
/* Uniform locations relative to the first one. */
enum { TL_DETAIL_FLAGS, TL_DETAIL_RANGE, TL_DETAIL_ROWS, TL_DETAIL_STEPS = 4 };

/* Largest side of horizon maps; heights of larger maps are averaged first. */
#define TL_HORIZON_SIDE_MAX 512
/* Largest side of cone maps, likewise. A ray may step over crests that are finer than that. */
#define TL_CONE_SIDE_MAX 512

struct tl_detail_entry;
struct tl_detail_maps {
    struct tl_detail_params params;
    size_t surface_count;
    size_t *first_parts; /* by surface: index of its first part */
    size_t part_count;
    int *entry_of_part; /* index into entries; -1: no detail */
    size_t entry_count;
    struct tl_detail_entry *entries; /* parts with the same maps share one */
};

/* Makes the textures of all parts of the surfaces; replaces the previous ones. Errors: TL_INPUT if a height
 * map exceeds the texture size of GL. */
bool tl_detail_maps_make(struct tl_detail_maps *maps, tl_gpu *gpu, const tl_surface *const *surfaces,
                         size_t count, const struct tl_detail_params *params, tl_error *error);
/* Frees all textures; keeps the parameters. */
void tl_detail_maps_release(struct tl_detail_maps *maps);

/* Sets the uniforms and textures of a part. With NULL maps, or for surfaces that they do not contain, those
 * without detail. */
void tl_detail_maps_bind(const struct tl_detail_maps *maps, size_t surface, size_t part, float uv_metres,
                         int first_location, int first_unit);

/* Size of all textures. */
size_t tl_detail_maps_bytes(const struct tl_detail_maps *maps);

#endif
