/* A camera path: keys in time, smooth between them. Written as YAML, by `view` or by hand; flown by `fly`.
 *
 *     keys:
 *       - {time_s: 0, yaw_deg: 0, pitch_deg: 5, distance_m: 2.5, target: [0, 1, 0], fov_deg: 30}
 *       - {time_s: 4, yaw_deg: 360, environment_yaw_deg: 90}
 *
 * A field that a key leaves out has the value of the key before it (the first: the scene's, and time 0).
 * Angles are not wrapped: from 0 to 720 turns twice. A distance of 0 frames the scene (app/scene/camera.h):
 * so do all keys or none, because no distance can be interpolated between a given one and an automatic one. A
 * target of 0 0 0 is the scene's. Failure: as scene files (config/yaml.h), with file, line and field. Pure
 * but for the files. */
#ifndef TOILE_APP_SCENE_PATH_H
#define TOILE_APP_SCENE_PATH_H

#include "app/settings/settings.h"

struct tl_path_key {
    double time_s; /* rising from key to key */
    struct tl_camera_params camera;
    float environment_yaw_deg;
};

struct tl_path {
    struct tl_path_key *keys; /* owned */
    size_t count;             /* at least 1 */
};

bool tl_path_load(const char *file, const struct tl_settings *scene, struct tl_path *out, tl_error *error);
bool tl_path_save(const char *file, const struct tl_path *path, tl_error *error);
void tl_path_add(struct tl_path *path, const struct tl_path_key *key); /* at its end */
void tl_path_release(struct tl_path *path);

/* The built-in path round a scene: one turn, a look close up, the environment turning; TL_PATH_BUILT_IN_S
 * long. A scene whose camera frames itself (distance 0) is not gone close to: tl_orbit_take first. */
struct tl_path tl_path_built_in(const struct tl_settings *scene);
#define TL_PATH_BUILT_IN_S 20.0

bool tl_path_same_key(const struct tl_path_key *a, const struct tl_path_key *b);

double tl_path_length_s(const struct tl_path *path); /* time of the last key */
/* Between keys by a monotone cubic of each number (no overshoot, so a camera that stops does not swing beyond
 * its key); before the first and after the last key it rests. */
struct tl_path_key tl_path_at(const struct tl_path *path, double time_s);

#endif
