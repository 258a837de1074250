/* Cutting polygons into triangles. Pure. */
#ifndef TOILE_ASSETS_OBJ_POLYGON_H
#define TOILE_ASSETS_OBJ_POLYGON_H

#include <cglm/struct.h>

#include <stddef.h>
#include <stdint.h>

/* Cuts a polygon of `count` (at least 3) corners, nearly flat, convex or not, into count - 2 triangles:
 * triangles[3 (count - 2)] are corner numbers in the polygon's own winding. By ear clipping; a polygon
 * that crosses itself still gives that many triangles. The time grows with the square of `count`, also for
 * polygons that cross themselves. `scratch` [count]. */
void tl_polygon_cut(const vec3s *corners, size_t count, uint32_t *triangles, uint32_t *scratch);

#endif
