/* Moves of the review window's camera (app/scene/camera.h): drags and the wheel.
 *
 * Pure. Metres; right-handed, +Y up; angles in degrees in tl_camera_params. Pixels count from the view's
 * upper left corner, x to the right, y down; all moves are in units of the view's height, so a drag does the
 * same in a window of any size. Moves other than a turn need a known distance (tl_orbit_take). */
#ifndef TOILE_APP_SCENE_ORBIT_H
#define TOILE_APP_SCENE_ORBIT_H

#include "app/settings/settings.h"

struct tl_ray {
    vec3s origin, direction; /* metres; unit */
};

/* Takes target and distance from a camera that was framed automatically (tl_camera_is_placed was false). */
void tl_orbit_take(struct tl_camera_params *params, const struct tl_camera *framed);

#define TL_ORBIT_DEG_PER_HEIGHT 180.0f /* of a drag over the view's whole height */

/* The same angle in [-180, 180). */
float tl_orbit_wrap_deg(float angle_deg);

/* A drag by (dx, dy) view heights turns what is seen along with the pointer: half a turn per height. Pitch
 * stays within +-89 degrees, yaw within [-180, 180). */
void tl_orbit_turn(struct tl_camera_params *params, float dx, float dy);

/* A drag by (dx, dy) view heights moves what lies at the target's depth along with the pointer. */
void tl_orbit_pan(struct tl_camera_params *params, float dx, float dy);

/* `steps` of the wheel, positive nearer, an eighth of the distance each; what lies at the target's depth
 * under the pointer, (x, y) view heights right of and below the view's centre, stays there. */
void tl_orbit_zoom(struct tl_camera_params *params, float steps, float x, float y);

/* Makes `point` the target and goes to half the distance. */
void tl_orbit_focus(struct tl_camera_params *params, vec3s point);

/* `share` of the way from one to the other: the shorter way round, distances by ratios. Both distances above
 * 0. The angle is within [-180, 180) but at the way's end, where it is exactly `to`. */
float tl_orbit_angle_between(float from_deg, float to_deg, float share);
struct tl_camera_params tl_orbit_between(const struct tl_camera_params *from,
                                         const struct tl_camera_params *to, float share);

/* Through the pixel position (x, y) of a view of width x height pixels. */
struct tl_ray tl_orbit_ray(const struct tl_camera *camera, float x, float y, float width, float height);

#endif
