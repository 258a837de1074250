/* The review camera: an orbit about a target. Pure. */
#ifndef TOILE_APP_CAMERA_H
#define TOILE_APP_CAMERA_H

#include "app/settings.h"

/* The camera of the frame. With distance_m = 0 the box (metres, world) fills the image of the given aspect
 * (width / height) with a small margin, whatever the yaw. */
struct tl_camera tl_camera_frame(const struct tl_camera_params *params, struct tl_box box, float aspect);

#endif
