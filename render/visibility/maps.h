/* Shadow maps of the regions: one variance shadow map a region, seen along its direction, blurred by a
 * Gaussian that follows the region's cone [002, sections 3.3 and 4].
 *
 * The maps are fitted to the sphere of the casters; receivers outside of it are lit. Depth is linear, 0 and 1
 * where the sphere begins and ends, so one unit is its diameter. RG32F: in half precision a depth of 1 m has
 * steps of 1 mm and, worse, its variance a floor of several centimetres. */
#ifndef TOILE_RENDER_VISIBILITY_MAPS_H
#define TOILE_RENDER_VISIBILITY_MAPS_H

#include "render/pem/regions.h"
#include "render/surfaces/ground.h"
#include "render/surfaces/surfaces.h"

#define TL_BLUR_RADIUS_MAX    64   /* texels; a wider Gaussian is cut to it, with a warning */
#define TL_BLUR_SIGMA_MIN     0.3f /* texels; a narrower one would change the third digit only */
#define TL_SHADOW_TEXEL_BYTES 8

/* What the light passes read of one region (std140: struct Region in light.frag). */
struct tl_region_view {
    vec4s map_rows[3]; /* world point -> map u, map v, depth */
    vec4s direction;   /* towards the light, world, unit */
};

typedef struct tl_shadow_maps tl_shadow_maps;

struct tl_shadow_request {
    const struct tl_regions *regions;
    float environment_yaw; /* rad */
    struct tl_casters casters;
    const tl_surfaces *surfaces;
    size_t surface_count;
    int ground_index; /* which of them is the ground; -1: none */
    int map_size;     /* texels */
    int maps_per_array;
    float blur_m;
};

tl_shadow_maps *tl_shadow_maps_create(tl_gpu *gpu, tl_error *error);
void tl_shadow_maps_destroy(tl_shadow_maps **maps);

/* Draws every region's map; then blurs what was drawn, in place. */
void tl_shadow_maps_draw(tl_shadow_maps *maps, const struct tl_shadow_request *request);
void tl_shadow_maps_blur(tl_shadow_maps *maps, const struct tl_shadow_request *request);

/* The array texture that holds the maps of pass `index`. */
unsigned tl_shadow_maps_texture(const tl_shadow_maps *maps, int index);
size_t tl_shadow_maps_bytes(const tl_shadow_maps *maps);
bool tl_shadow_maps_reload(tl_shadow_maps *maps, tl_error *error); /* programs, from disk */

/* A region's view of the casters; world direction. Pure. */
struct tl_region_view tl_region_view_make(vec3s direction, const struct tl_casters *casters, int map_size);

/* The Gaussian's standard deviation in texels: blur_m x tan(cone), on a map of `map_size` over the casters.
 */
float tl_shadow_sigma(const struct tl_region *region, const struct tl_casters *casters, int map_size,
                      float blur_m);

#endif
