/* A session: settings -> a running garment. It loads what the scene names, drapes it, and hands one frame
 * after the other to the renderer. It uses no GL.
 *
 * Units: metres, seconds; world space is right-handed, +Y up.
 *
 * Errors: a function that can fail takes a tl_error and says below which codes it sets. TL_USAGE: an option
 * without meaning in this scene; TL_INPUT: a file that cannot be read; TL_INTERRUPTED: the user stopped
 * it.
 *
 * Lifetime: a session owns all that it loads. Its results are borrowed until the call that each
 * function names.
 *
 * Threads: a session is used by one thread at a time, which may be any. Two sessions do not share anything
 * that is written to, so one may be created on a worker thread while another plays. Functions marked pure may
 * be called on any thread. */
#ifndef TOILE_APP_SCENE_SESSION_H
#define TOILE_APP_SCENE_SESSION_H

#include "app/scene/appearance.h"
#include "app/scene/moving_light.h"
#include "app/settings/settings.h"
#include "cloth/cloth.h"
#include "render/renderer.h"

typedef struct tl_session tl_session;

/* ---- A session's life ---- */

/* Loads avatar, garment and environment, drapes the garment, and reports progress in the log. Decides what a
 * model in place of a scene is, when `settings` leave that open: tl_session_settings has the decision.
 * Errors: NULL, with TL_USAGE (an unknown colourway; neither garment nor avatar), TL_INPUT (a file, a clip),
 * TL_INTERRUPTED, or the error of the drape.
 * Lifetime: `settings` is copied; the caller destroys the session.
 * Threads: any; it runs for seconds. */
tl_session *tl_session_create(const struct tl_settings *settings, tl_error *error);

/* Frees the session and nulls *handle; a null *handle is fine.
 * Lifetime: everything that was borrowed from the session ends.
 * Threads: any, once no other one uses the session or its models. */
void tl_session_destroy(tl_session **handle);

/* ---- Time ---- */

/* Advances by one frame (1/frame_rate s): environment, avatar, cloth, normals and tangents.
 * Errors: TL_INPUT when a sequence's or a motion's next file cannot be read, or the error of tl_cloth_step.
 * The frame number then stays, but parts may have moved: reset the session or destroy it. Lifetime: ends the
 * last tl_session_frame. Threads: the session's. */
bool tl_session_advance(tl_session *session, tl_error *error);

/* Whether a window steps the cloth beside the drawing: where a graphics card draws, the processor has nothing
 * else to do, if there is a core to spare. Pure. */
bool tl_session_steps_beside(const tl_session *session, bool card_draws);
/* Begins the cloth's step of the next frame on a thread of its own; the second function waits for it, and the
 * next tl_session_advance takes it, with its error, so that every frame is as without them. What the last
 * tl_session_frame holds may be read in between, and tl_session_apply, _advance, _reset and _destroy wait
 * themselves; other functions of this session must not be called. False, and nothing was begun: there is no
 * simulated cloth, a clip moves what is drawn, or a step has been begun and not taken. Errors: none. Threads:
 * the session's. */
bool tl_session_begin_step(tl_session *session);
void tl_session_end_step(tl_session *session);
/* Advances where a step has been begun and not taken. Errors and lifetime: as tl_session_advance. */
bool tl_session_take_step(tl_session *session, tl_error *error);

/* Advances to frame `number` (0: the start, settled or as authored); an earlier frame is reached from the
 * start, because cloth cannot be stepped backwards. Without cloth a frame is reached at once. Errors: as
 * tl_session_advance, and TL_INTERRUPTED at the frame that was reached. Lifetime: ends the last
 * tl_session_frame. Threads: the session's. */
bool tl_session_go_to(tl_session *session, int number, tl_error *error);

/* The last frame of what is played back: a motion, or an avatar's clip where nothing is simulated; any frame
 * can then be gone to at once. 0: there is none. Errors: none. Threads: the session's. */
int tl_session_last_frame(const tl_session *session);

/* The number of the present frame. Errors: none. Threads: the session's. */
int tl_session_frame_number(const tl_session *session);

/* Goes back to frame 0, settled or as authored, without draping again.
 * Errors: as tl_session_advance, without the cloth's.
 * Lifetime: ends the last tl_session_frame.
 * Threads: the session's. */
bool tl_session_reset(tl_session *session, tl_error *error);

/* ---- Changes ---- */

/* Changes the settings: loads or rebuilds only what differs. The last two appearances are kept, so that to
 * switch between two of them costs nothing.
 * Errors: as tl_session_create when the scene has to be loaded again, else those of the appearance, the
 * environment or tl_cloth_set; the settings stay as they were.
 * Lifetime: `settings` is copied; ends the last tl_session_frame, and all else that is borrowed when the
 * scene is loaded again. Threads: the session's. */
bool tl_session_apply(tl_session *session, const struct tl_settings *settings, tl_error *error);

/* Loads and drapes everything again. tl_session_apply lets a draped cloth of another fabric move on from
 * where it is; this shows how that fabric falls from the start. A renderer that has drawn the session needs
 * this instead of a new session: revisions go on rising. Errors: as tl_session_create; the session stays as
 * it was. Lifetime: `settings` is copied; ends all that is borrowed. Threads: the session's. */
bool tl_session_restart(tl_session *session, const struct tl_settings *settings, tl_error *error);

/* The present settings. Errors: none. Lifetime: borrowed until the session is destroyed; the values change
 * with the session. Threads: the session's. */
const struct tl_settings *tl_session_settings(const tl_session *session);

/* ---- Loading on a worker thread (app/view/loader/loader.h) ---- */

/* Whether a change from `old` to `new` requires: loading the scene again; reading another environment;
 * rebuilding or redrawing the appearance. Errors: none. Threads: pure. */
bool tl_session_needs_scene(const struct tl_settings *old, const struct tl_settings *new);
bool tl_session_needs_light(const struct tl_settings *old, const struct tl_settings *new);
bool tl_session_needs_appearance(const struct tl_settings *old, const struct tl_settings *new);

/* Copies from `kept` into `settings` the options that decide the first two; tl_appearance_take copies those
 * of the third. Errors: none. Threads: pure. */
void tl_session_keep_scene(const struct tl_settings *kept, struct tl_settings *settings);

/* Raises the revisions of a new session above those of the one whose place it takes, so that a renderer that
 * has drawn that one uploads everything.
 * Errors: none.
 * Lifetime: either stays its owner's; a renderer may go on drawing the old one while it lives.
 * Threads: the sessions'. */
void tl_session_succeed(tl_session *fresh, const tl_session *old);

/* Gives the session another environment, and its name in scene.environment.
 * Errors: none.
 * Lifetime: takes the contents of *made and empties it; ends the last tl_session_frame.
 * Threads: the session's. */
void tl_session_replace_light(tl_session *session, struct tl_moving_light *made, const char *name);

/* Gives the options units, up, avatar_units and avatar_up the values that their models were read with: those
 * of `scene`, where auto was decided so. The scene is the same, and is not loaded again for it.
 * Errors: none. Threads: the session's. */
void tl_session_name_reading(tl_session *session, const struct tl_scene_params *scene);

/* Exchanges the environments of two sessions, and the options that decide them.
 * Errors: none.
 * Lifetime: ends the last tl_session_frame of either.
 * Threads: the sessions'. */
void tl_session_exchange_light(tl_session *session, tl_session *other);

/* The models of the scene; NULL where the scene has none. Appearances are made of them and of settings alone.
 */
struct tl_session_models {
    const tl_model *garment, *avatar;
};

/* Errors: none. Lifetime: borrowed until the scene is loaded again, replaced or destroyed. Threads: the
 * session's; the models themselves may be read on any thread, for the session does not write to them. */
struct tl_session_models tl_session_models(const tl_session *session);

/* Makes another appearance of the models.
 * Errors: as tl_appearance_make; `out` is then empty.
 * Lifetime: the caller releases `out`, or gives it to tl_session_keep_appearance.
 * Threads: any. */
bool tl_session_make_appearance(const struct tl_session_models *models, const struct tl_settings *settings,
                                struct tl_appearance *out, tl_error *error);

/* A frame of the models in their rest pose, with only surfaces in it: enough to prepare what depends on
 * materials.
 * Errors: none.
 * Lifetime: borrows all three arguments.
 * Threads: any. */
tl_frame tl_session_frame_in(const struct tl_session_models *models, const struct tl_appearance *appearance,
                             tl_surface surfaces[2]);

/* Keeps an appearance, so that tl_session_apply of the settings `made_of` does not make it again. The oldest
 * kept one is released.
 * Errors: none.
 * Lifetime: takes the contents of *made and empties it; `made_of` is copied.
 * Threads: the session's. */
void tl_session_keep_appearance(tl_session *session, const struct tl_settings *made_of,
                                struct tl_appearance *made);

/* ---- The present state ---- */

/* True when the environment is a sequence. Errors: none. Threads: the session's. */
bool tl_session_light_plays(const tl_session *session);

/* The values that scene.colourway can have beside "": the scene's colourways, then the variants of the
 * garment's and the avatar's files. To change to one: tl_settings_apply_colourway, then tl_session_apply,
 * which makes new materials and leaves the cloth as it is. Returns their number. Errors: none. Lifetime:
 * borrowed until the next call that changes the session. Threads: the session's. */
size_t tl_session_colourways(const tl_session *session, const char *const **names);

/* Surfaces of a frame at most: avatar, pattern board, garment, in this order. */
#define TL_SESSION_SURFACES 3

/* Whether scene.pattern can show the garment's pieces. Errors: none. Threads: the session's. */
bool tl_session_has_pattern(const tl_session *session);

/* The present frame for the renderer. Its camera is that of settings.camera; a distance_m of 0 frames avatar
 * and garment as they are at frame 0.
 * Errors: none.
 * Lifetime: borrowed until the next call that changes the session.
 * Threads: the session's. */
tl_frame tl_session_frame(tl_session *session);

/* True makes frames hold the garment's strains in every view; else only the views of strain have them.
 * Errors: none. Threads: the session's. */
void tl_session_want_strains(tl_session *session, bool wanted);

/* Intersects a ray with the garment, from both sides: the render vertex nearest to the first hit, and the
 * distance along the ray in units of `direction`'s length. `origin` in metres. False when the ray misses:
 * *vertex is then not set. Errors: none. Threads: the session's. */
bool tl_session_pick(const tl_session *session, vec3s origin, vec3s direction, uint32_t *vertex,
                     float *distance_m);

/* The garment's state in the present frame: as its file has it, at rest under gravity, or on its way. */
enum tl_garment_state {
    TL_GARMENT_IS_NOT_CLOTH, /* none, a solid, or one that plays a recorded motion */
    TL_GARMENT_AUTHORED,
    TL_GARMENT_SEWN, /* and not draped: nobody wears it */
    TL_GARMENT_AT_REST,
    TL_GARMENT_STILL, /* stands still, and its forces have not been in balance */
    TL_GARMENT_MOVED, /* not at rest */
};
extern const char *const tl_garment_state_names[]; /* "", "as authored", ... */

/* At rest: settled in balance, and tl_cloth_is_still where it has moved since. Errors: none. Threads: the
 * session's. */
enum tl_garment_state tl_session_garment_state(const tl_session *session);

/* Writes the state in words, and by how much a drape was out of balance when it had settled: "at rest, out of
 * balance by 0.06 of its weight". Errors: none. Threads: the session's. */
void tl_session_describe_state(const tl_session *session, char *out, size_t size);

/* True for cloth that starts as its file has it (scene.drape). Errors: none. Threads: the session's. */
bool tl_session_is_authored(const tl_session *session);

/* True for cloth that has not been draped: as authored, or only sewn. Errors: none. Threads: the session's.
 */
bool tl_session_is_undraped(const tl_session *session);

/* The height of the garment above where its file has it: one without an avatar is lifted out of the
 * ground. Errors: none. Threads: the session's. */
float tl_session_lifted_m(const tl_session *session);

/* Draws the garment as if it were placed so on top of how it was loaded, until it is loaded again: what a
 * drag shows before the scene follows. The cloth and its contacts stay where they are. False: it is drawn so
 * already, or is no cloth. Errors: none. Lifetime: ends the last tl_session_frame. Threads: the session's. */
bool tl_session_show_placed(tl_session *session, const struct tl_placing *placing);

/* One line about a garment that is of another size than the body that wears it, or lies inside it; NULL:
 * nothing is to be reported. Errors: none. Lifetime: borrowed until the scene is loaded again, replaced or
 * destroyed. Threads: the session's. */
const char *tl_session_size_note(const tl_session *session);

/* True when the avatar plays an animation. Errors: none. Threads: the session's. */
bool tl_session_plays_clip(const tl_session *session);

/* The simulated cloth; NULL when the scene has no garment, or one that is solid or played back.
 * Errors: none. Lifetime: borrowed until the scene is loaded again, replaced or destroyed. Threads: the
 * session's. */
tl_cloth *tl_session_cloth(tl_session *session);

/* The garment's model in its rest pose; NULL when the scene has none.
 * Errors: none. Lifetime: borrowed until the scene is loaded again, replaced or destroyed. Threads: the
 * session's; the model itself may be read on any. */
const tl_model *tl_session_garment(const tl_session *session);

/* The garment as it was cut or read: its mesh, pattern and seams; NULL when the scene has none.
 * Errors: none. Lifetime and threads: as tl_session_garment. */
const tl_garment *tl_session_cut(const tl_session *session);

/* Measures the cloth (tl_cloth_measure); all 0 when none is simulated.
 * Errors: none. Threads: the session's. */
struct tl_cloth_report tl_session_report(const tl_session *session);

/* States how far from balance the cloth of frame 0 is: as it was settled (tl_cloth_balance), or as authored
 * (tl_cloth_residual). Zeros without cloth, and where it has moved. */
struct tl_balance tl_session_balance(const tl_session *session);

#endif
