/* The maps on the GPU that detail derives from those of the materials: heights, horizons, cones, moments of
 * normals. Made only where an option asks for them. Owns its textures; one GL thread. */
#ifndef TOILE_RENDER_DETAIL_MAPS_H
#define TOILE_RENDER_DETAIL_MAPS_H

#include "assets/base/surface.h"
#include "render/detail/options.h"
#include "render/gpu/gpu.h"

/* Texture units from the first on, as detail.glsl's bindings run. */
enum tl_detail_unit {
    TL_DETAIL_HEIGHTS,
    TL_DETAIL_HORIZONS,
    TL_DETAIL_OWN_MOMENTS,
    TL_DETAIL_WEAVE_MOMENTS,
    TL_DETAIL_CONES,
    TL_DETAIL_UNITS
};
/* Uniform locations, counted from the first one. */
enum { TL_DETAIL_FLAGS, TL_DETAIL_RANGE, TL_DETAIL_ROWS, TL_DETAIL_STEPS = 4 };

/* Horizons are baked from at most so many texels a side: a larger map's heights are averaged. */
#define TL_HORIZON_SIDE_MAX 512
/* And so are cones; of crests that are finer than that a ray may step over one. */
#define TL_CONE_SIDE_MAX 512

struct tl_detail_entry;
struct tl_detail_maps {
    struct tl_detail_params params;
    size_t surface_count;
    size_t *first_parts; /* by surface: number of its first part */
    size_t part_count;
    int *entry_of_part; /* index into entries; -1: nothing */
    size_t entry_count;
    struct tl_detail_entry *entries; /* parts with the same maps share one */
};

/* Makes everything anew for these surfaces. False when a map is larger than GL holds. */
bool tl_detail_maps_make(struct tl_detail_maps *maps, tl_gpu *gpu, const tl_surface *const *surfaces,
                         size_t count, const struct tl_detail_params *params, tl_error *error);
void tl_detail_maps_release(struct tl_detail_maps *maps);

/* Sets uniforms and textures for a part; for maps of NULL, or surfaces they do not know, those of no detail.
 */
void tl_detail_maps_bind(const struct tl_detail_maps *maps, size_t surface, size_t part, float uv_metres,
                         int first_location, int first_unit);

size_t tl_detail_maps_bytes(const struct tl_detail_maps *maps);

#endif
