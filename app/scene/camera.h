/* The review camera: an orbit about a target. Pure. */
#ifndef TOILE_APP_SCENE_CAMERA_H
#define TOILE_APP_SCENE_CAMERA_H

#include "app/settings/settings.h"

/* True when the settings place the camera. A distance of 0 stands for the one that frames the scene, a target
 * of 0 0 0 for the middle of the scene. */
bool tl_camera_is_placed(const struct tl_camera_params *params);

/* The camera of the frame. With distance_m = 0 the box (metres, world) fills the image of the given aspect
 * (width / height) with a small margin, whatever the yaw; with a distance but no target the eye looks at the
 * box's middle from there. */
struct tl_camera tl_camera_frame(const struct tl_camera_params *params, struct tl_box box, float aspect);

#endif
