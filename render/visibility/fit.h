/* Orthographic views of the casters along a direction, fitted to their outline: two to three times the
 * resolution of a view of their sphere for a standing figure. Pure. */
#ifndef TOILE_RENDER_VISIBILITY_FIT_H
#define TOILE_RENDER_VISIBILITY_FIT_H

#include "assets/base/surface.h"

/* Width of the empty border of a map in texels: neither a blurred silhouette nor a look-up from outside
 * reaches across it. */
#define TL_MAP_MARGIN_TEXELS 2

struct tl_region_view {
    vec4s map_rows[3]; /* world point -> map u, map v, depth; depth grows away from the light, in [0, 1] */
    vec4s direction;   /* towards the light, world, unit; 0 */
};

/* All positions, by coordinate, for wide loops; padded with repetitions of the last. */
struct tl_caster_cloud {
    size_t count, capacity;
    float *coordinates[3];
};
void tl_caster_cloud_fill(struct tl_caster_cloud *cloud, const tl_surface *surfaces, size_t surface_count);
void tl_caster_cloud_release(struct tl_caster_cloud *cloud);

/* Axes of every view along `direction`: right, up; a right-handed frame with the direction. */
void tl_view_axes(vec3s direction, vec3s *right, vec3s *up);

/* World point -> 0.5 + axis . (point - centre) * scale. */
vec4s tl_view_row(vec3s axis, vec3s centre, float scale);

/* The shadow of the point cloud fills the map except for the border; depths 0 and 1 lie slightly outside the
 * cloud. */
struct tl_region_view tl_region_view_fit(vec3s direction, const struct tl_caster_cloud *cloud, int map_size);

#endif
