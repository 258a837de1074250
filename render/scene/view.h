/* A camera's matrices and axes for the passes. Pure. A degenerate camera (eye on its target, up along the
 * view, near behind far) is corrected to the nearest valid one, so that no matrix ever holds a NaN. */
#ifndef TOILE_RENDER_SCENE_VIEW_H
#define TOILE_RENDER_SCENE_VIEW_H

#include "render/scene/camera.h"

/* Layers that the camera sees behind open cloth; the last of them counts as closed. */
#define TL_TRANSPARENCY_LAYERS 4

struct tl_view {
    mat4s view_projection;
    vec3s eye;
    /* The plane at distance 1: its middle from the eye, and from there its right and upper edge. */
    vec3s forward, right, up;
    float near_m, far_m; /* depths along `forward` */
};

struct tl_view tl_view_make(const struct tl_camera *camera, int width, int height);

/* The turn from the world into eye space: x right, y up, z backwards. */
mat3s tl_view_turn(const struct tl_view *view);

/* The same eye behind an image plane that is moved: what was seen at x, y in [-1, 1] is seen at x + right,
 * y + up. `forward` then leads to the plane's new middle and is no unit vector any more. */
struct tl_view tl_view_shift(const struct tl_view *view, float right, float up);

#endif
