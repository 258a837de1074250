/* Clips triangles to the view frustum as Mesa's draw module does: by [Sutherland and Hodgman 1974],
 * plane by plane, in float. Pure. */
#ifndef TOILE_RENDER_GBUFFER_CLIP_H
#define TOILE_RENDER_GBUFFER_CLIP_H

#include <cglm/struct.h>

enum { TL_CLIP_PLANES = 6, TL_CLIP_CORNERS_MAX = 3 + TL_CLIP_PLANES };

struct tl_clip_corner {
    vec4s at;   /* clip space */
    int source; /* the corner of the triangle that it is, or -1 where an edge was cut */
};

/* The planes that a point in clip space lies outside of: one bit each, in the order x <= w, -w <= x, y <= w,
 * -w <= y, -w <= z, z <= w. */
static inline unsigned tl_clip_outside(float x, float y, float z, float w)
{
    return (unsigned)(x > w) | (unsigned)(x + w < 0) << 1 | (unsigned)(y > w) << 2 |
           (unsigned)(y + w < 0) << 3 | (unsigned)(z + w < 0) << 4 | (unsigned)(z > w) << 5;
}

/* Cuts a triangle, the first three of `corners`, by the planes whose bits are set. Returns the number of
 * corners of the polygon, 0 when nothing remains or a corner is not finite. */
int tl_clip_triangle(struct tl_clip_corner corners[TL_CLIP_CORNERS_MAX], unsigned planes);

#endif
