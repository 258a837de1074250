/* A garment that is not simulated but moved by a point cache (assets/motion/point_cache.h) or by a clip of a
 * glTF file with the same vertices, the garment's own as a rule: someone else's simulation, under review
 * here.
 *
 * Ownership: a tl_playback owns its motion and borrows its model. Threads: one at a time. */
#ifndef TOILE_APP_SCENE_PLAYBACK_H
#define TOILE_APP_SCENE_PLAYBACK_H

#include "app/settings/settings.h"
#include "assets/model.h"

typedef struct tl_playback tl_playback;

/* Opens scene.motion for the garment's model; refuses one with another number of points. Of a
 * glTF file the clip that scene.clip names, else the first. Logs whether frames are missing from the motion.
 */
tl_playback *tl_playback_open(const struct tl_settings *settings, const tl_model *model, tl_error *error);
void tl_playback_close(tl_playback **handle); /* nulls it; null is fine */

/* Duration at its own rate, or at scene.motion_rate; seconds. */
double tl_playback_length_s(const tl_playback *playback, const struct tl_settings *settings);

/* The lowest height that it is known to reach, metres: of a sequence and a clip at the start. */
float tl_playback_lowest(const tl_playback *playback);

/* Render vertices at frame `number` of the animation, metres. */
bool tl_playback_pose(tl_playback *playback, const struct tl_settings *settings, int number, vec3s *positions,
                      tl_error *error);

#endif
