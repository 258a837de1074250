/* Shadow maps of the regions, each seen along one direction of its region, of two kinds:
 *
 * vsm: a variance shadow map a region, fitted to the casters' sphere and blurred by a Gaussian that follows
 * the region's cone [Knuth et al. 2014, 3.3 and 4]. Depth is linear, 0 and 1 where the sphere begins and
 * ends, so one unit is its diameter. Moments are RG32F, or RG16F, which takes half the memory: there a depth
 * of half a unit has steps of 2^-12, and its variance an error of as much, so that light leaks where the
 * shadow's caster is less than 1 / 64 of a unit away: several centimetres.
 *
 * depth: a plain depth map a region, fitted to the casters as they are seen along its direction; four texels
 * compared and blended by a look-up. A blur wider than that costs more truth than it gives beauty (hard maps
 * of 96 regions err by 3.9 %, blurred ones by 6 to 11 %: docs/notes/visibility.md); soft shadows come from
 * many regions, and from directions that vary from round to round.
 *
 * Suns have depth maps of their own, of higher resolution, whatever the kind of the regions' maps. Receivers
 * outside of a map are lit. */
#ifndef TOILE_RENDER_VISIBILITY_MAPS_H
#define TOILE_RENDER_VISIBILITY_MAPS_H

#include "render/env/sun.h"
#include "render/pem/regions.h"
#include "render/surfaces/ground.h"
#include "render/surfaces/surfaces.h"
#include "render/visibility/fit.h"
#include "render/visibility/options.h"

#define TL_BLUR_RADIUS_MAX    64   /* texels; a wider Gaussian is cut to it, with a warning */
#define TL_BLUR_SIGMA_MIN     0.3f /* texels; a narrower one would change the third digit only */
#define TL_SHADOW_TEXEL_BYTES 8    /* of a variance map; one in half precision, and a depth map, take half */
#define TL_SUN_MAP_SIZE_MIN   1024 /* texels: a sun is sharp; 1 to 2 mm on a dress */

typedef struct tl_shadow_maps tl_shadow_maps;

struct tl_shadow_request {
    enum tl_visibility kind; /* VSM or DEPTH */
    enum tl_moments moments; /* of VSM */
    const struct tl_regions *regions;
    const struct tl_suns *suns;
    float environment_yaw; /* rad */
    /* The shadow casters, without the ground. */
    const tl_surface *caster_surfaces;
    size_t caster_count;
    struct tl_casters casters;
    /* All surfaces to draw, with the ground. */
    const tl_surfaces *surfaces;
    size_t surface_count;
    int ground_index; /* which of them is the ground; -1: none */
    int map_size;     /* texels */
    int maps_per_array;
    float blur_m;
    uint64_t regions_revision; /* changes when the regions do: then all maps are drawn */
    int refresh;               /* so many maps are drawn at most (render/visibility/map_order.h); 0: all */
    int round; /* 0: regions are seen along their own direction; else one that is jittered inside them */
};

tl_shadow_maps *tl_shadow_maps_create(tl_gpu *gpu, tl_error *error);
void tl_shadow_maps_destroy(tl_shadow_maps **maps);

/* Draws the regions' maps whose turn it is, and every sun's; then blurs variance maps that were drawn, in
 * place. */
void tl_shadow_maps_draw(tl_shadow_maps *maps, const struct tl_shadow_request *request);
/* The next draw draws every map. */
void tl_shadow_maps_forget(tl_shadow_maps *maps);
void tl_shadow_maps_blur(tl_shadow_maps *maps, const struct tl_shadow_request *request);

/* Returns whether maps wait for their turn. Such maps show an earlier state, along the views that they were
 * drawn with. */
bool tl_shadow_maps_wait(const tl_shadow_maps *maps);

/* The array texture that holds the maps of pass `index`; that of the suns' maps. */
unsigned tl_shadow_maps_texture(const tl_shadow_maps *maps, int index);
unsigned tl_shadow_maps_sun_texture(const tl_shadow_maps *maps);
/* The view of each region and each sun with which its map was drawn. */
const struct tl_region_view *tl_shadow_maps_views(const tl_shadow_maps *maps);
const struct tl_region_view *tl_shadow_maps_sun_views(const tl_shadow_maps *maps);
/* The map of region `index` as it is on the GPU, rows upwards: for checks. */
struct tl_shadow_texels {
    int size, channels; /* VSM: two moments a texel; DEPTH: the depth */
    float *texels;      /* [size][size][channels]; free it */
};
struct tl_shadow_texels tl_shadow_maps_read(const tl_shadow_maps *maps, int index);
size_t tl_shadow_maps_bytes(const tl_shadow_maps *maps);
bool tl_shadow_maps_reload(tl_shadow_maps *maps, tl_error *error); /* programs, from disk */

/* A 2D array of depth maps whose look-ups compare four texels with a depth and blend the answers; and the
 * side of a map that is as sharp as a sun's where the regions' have `map_size`. */
tl_texture tl_depth_array_create(tl_gpu *gpu, int size, int layers);
int tl_sun_map_size(const tl_gpu *gpu, int map_size);

/* A region's view of the casters' sphere; world direction. Pure. */
struct tl_region_view tl_region_view_make(vec3s direction, const struct tl_casters *casters, int map_size);

/* The direction along which region i is seen in a round, environment's frame. Pure. */
vec3s tl_region_seen_direction(const struct tl_regions *regions, int i, int round);

/* The Gaussian's standard deviation in texels: blur_m x tan(cone), on a map of `map_size` over the casters.
 */
float tl_shadow_sigma(const struct tl_region *region, const struct tl_casters *casters, int map_size,
                      float blur_m);

#endif
