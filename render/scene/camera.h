/* A camera: world space, metres. */
#ifndef TOILE_RENDER_SCENE_CAMERA_H
#define TOILE_RENDER_SCENE_CAMERA_H

#include "assets/base/surface.h"

struct tl_camera {
    vec3s eye, target, up; /* metres */
    float fov_y;           /* rad */
    float near_m, far_m;
};

#endif
