/* A session: settings -> a running garment. Loads what the scene names, drapes it, and hands one frame after
 * the other to the renderer. Knows no GL. */
#ifndef TOILE_APP_SCENE_SESSION_H
#define TOILE_APP_SCENE_SESSION_H

#include "app/scene/appearance.h"
#include "app/scene/moving_light.h"
#include "app/settings/settings.h"
#include "cloth/cloth.h"
#include "render/renderer.h"

typedef struct tl_session tl_session;

/* Loads and settles; shows progress. */
tl_session *tl_session_create(const struct tl_settings *settings, tl_error *error);
void tl_session_destroy(tl_session **handle); /* nulls it; null is fine */

/* One frame (1/frame_rate s) further: avatar, cloth, normals and tangents. */
bool tl_session_advance(tl_session *session, tl_error *error);
/* To frame `number` (0 = settled), from the start when it lies behind. */
bool tl_session_go_to(tl_session *session, int number, tl_error *error);
int tl_session_frame_number(const tl_session *session);
/* Settled state again, frame 0. */
bool tl_session_reset(tl_session *session, tl_error *error);

/* Takes over changed settings: reloads or re-weaves only what differs. On failure the session is as it was.
 * To and fro between two appearance costs nothing: the last ones are kept. */
bool tl_session_apply(tl_session *session, const struct tl_settings *settings, tl_error *error);
/* The same, but all is loaded and draped anew: as another fabric would fall, which only moves the cloth on
 * when it is applied. A new session in a renderer's sight begins like this, not with tl_session_create. */
bool tl_session_restart(tl_session *session, const struct tl_settings *settings, tl_error *error);
const struct tl_settings *tl_session_settings(const tl_session *session);

/* For those who make a scene beside the one that is shown (app/view/review/loader.h). True when from `old` to
 * `new` the scene has to be made anew; or another environment be read; or cloth look different, or be drawn
 * in another way. Pure. */
bool tl_session_needs_scene(const struct tl_settings *old, const struct tl_settings *new);
bool tl_session_needs_light(const struct tl_settings *old, const struct tl_settings *new);
bool tl_session_needs_appearance(const struct tl_settings *old, const struct tl_settings *new);
/* Sets the options that decide the first two to those of `kept`; tl_appearance_take does so with the third.
 * Pure.
 */
void tl_session_keep_scene(const struct tl_settings *kept, struct tl_settings *settings);
/* Becomes what was made beside it; *made is nulled. */
void tl_session_replace(tl_session *session, tl_session **made);
void tl_session_replace_light(tl_session *session, struct tl_moving_light *made, const char *name);
/* The models of a session's scene: all that another look of it is made from. Nothing writes to them while the
 * session keeps its scene, so that another thread may read them while the session plays. Borrowed: they are
 * freed with the scene. NULL: the scene has none. */
struct tl_session_models {
    const tl_model *garment, *avatar;
};
struct tl_session_models tl_session_models(const tl_session *session);
/* The models in another look; on any thread. */
bool tl_session_make_appearance(const struct tl_session_models *models, const struct tl_settings *settings,
                                struct tl_appearance *out, tl_error *error);
/* A frame of the models at rest in a look, in which only what depends on materials is meaningful; on any
 * thread. Borrows all three. */
tl_frame tl_session_frame_in(const struct tl_session_models *models, const struct tl_appearance *appearance,
                             tl_surface surfaces[2]);
/* To apply these settings then costs little. *made is emptied. */
void tl_session_keep_appearance(tl_session *session, const struct tl_settings *made_of,
                                struct tl_appearance *made);
bool tl_session_light_plays(const tl_session *session); /* its environment is a sequence's */
/* The colourways there are, for scene.colourway beside "": those of the scene's section, then the variants of
 * the garment's and the avatar's files. Valid until the next call that changes the session. To change to one:
 * tl_settings_apply_colourway, then tl_session_apply, which makes new materials and leaves the cloth as it
 * is.
 */
size_t tl_session_colourways(const tl_session *session, const char *const **names);

/* The frame as the renderer wants it; valid until the next call that changes the session. Orbit camera from
 * settings.camera, framed on the avatar and garment when camera.distance_m is 0. */
tl_frame tl_session_frame(tl_session *session);

/* Whether frames tell the garment's strains whatever they show; else they do in the views of strain. */
void tl_session_want_strains(tl_session *session, bool wanted);

/* Where a ray meets the garment: its nearest render vertex and the distance along the ray; false when it
 * misses. */
bool tl_session_pick(const tl_session *session, vec3s origin, vec3s direction, uint32_t *vertex,
                     float *distance_m);
bool tl_session_plays_clip(const tl_session *session); /* the avatar's */
/* NULL when the scene has no garment, or one that is played back instead of simulated. */
tl_cloth *tl_session_cloth(tl_session *session);
const tl_model *tl_session_garment(const tl_session *session); /* NULL when the scene has none */
struct tl_cloth_report tl_session_report(const tl_session *session);

#endif
