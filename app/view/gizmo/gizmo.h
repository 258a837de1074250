/* Handles over the image that move, turn and size what stands at a point, the pivot: where they are in the
 * view, which of them is under the pointer, and what a drag of one amounts to.
 *
 * Arrows along the world's axes move along them, a square at the pivot moves in the plane of the image, a
 * ring about the vertical turns, and a box on a diagonal sizes. Handles keep their size in pixels, whatever
 * the distance. Pixels count from the view's upper left corner, x to the right, y down; metres; world axes
 * with y up. Pure. */
#ifndef TOILE_APP_VIEW_GIZMO_GIZMO_H
#define TOILE_APP_VIEW_GIZMO_GIZMO_H

#include "app/scene/orbit.h"

#include <stdbool.h>

enum tl_gizmo_handle {
    TL_GIZMO_NONE,
    TL_GIZMO_X,
    TL_GIZMO_Y,
    TL_GIZMO_Z,
    TL_GIZMO_VIEW, /* moves in the plane of the image */
    TL_GIZMO_TURN,
    TL_GIZMO_SIZE,
    TL_GIZMO_COUNT
};

struct tl_gizmo {
    struct tl_camera camera;
    int width, height; /* of the view */
    float scale;       /* of the window's content, 1 on a plain screen */
    vec3s pivot;
    float stretch; /* of the box's distance from the pivot; 1 but in a drag of it */
};

#define TL_GIZMO_RING_POINTS 65 /* the last is the first again */

/* The handles as they are seen. */
struct tl_gizmo_drawing {
    vec2s centre;
    float half_side;      /* of the square at the centre and of the box */
    bool has_arrow[3];    /* false: the axis points at the eye, or away from it */
    vec2s from[3], to[3]; /* of each arrow */
    vec2s ring[TL_GIZMO_RING_POINTS];
    bool is_far[TL_GIZMO_RING_POINTS]; /* behind the pivot */
    vec2s box;
};

/* False when the pivot is behind the eye: nothing can then be drawn or caught. */
bool tl_gizmo_draw(const struct tl_gizmo *gizmo, struct tl_gizmo_drawing *out);

/* The handle that a pointer at `at` would catch. */
enum tl_gizmo_handle tl_gizmo_under(const struct tl_gizmo *gizmo, vec2s at);

struct tl_gizmo_change {
    vec3s move_m;
    float turn_deg; /* positive turns +Z towards +X */
    float factor;
};

/* The change by a drag of the handle from one pixel position to another; the gizmo is that of its start.
 *
 * An arrow's drag is projected onto the axis as it is seen; the change is that of the axis's points under the
 * pointer. The ring's is the angle about the vertical between the points of the ring's plane under the
 * pointer, within [-180, 180); a ring that is seen from less than 30 degrees above or below its plane is
 * turned by what the pointer goes along its tangent, a radian for each radius. The box's factor is the ratio
 * of the distances from the pivot along the drag's first direction. */
struct tl_gizmo_change tl_gizmo_drag(const struct tl_gizmo *gizmo, enum tl_gizmo_handle handle, vec2s from,
                                     vec2s to);

/* The change in whole steps: 10 mm along each axis, 15 degrees, a twentieth of the size. */
struct tl_gizmo_change tl_gizmo_snap(const struct tl_gizmo_change *change);

/* The parameter of the point of a line, point + parameter * axis, that is nearest to a ray; `axis` is
 * of length 1. False when they are parallel. */
bool tl_gizmo_nearest_on_axis(const struct tl_ray *ray, vec3s point, vec3s axis, float *parameter);

/* Intersects a ray with the plane through `point`. False when it does not, or behind its origin. */
bool tl_gizmo_on_plane(const struct tl_ray *ray, vec3s point, vec3s normal, vec3s *hit);

#endif
