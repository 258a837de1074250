/* Loads a scene, an environment or an appearance on a worker thread, so that the window stays responsive, and
 * prepares what renderers need of its light.
 *
 * The worker makes no GL call. It reads copies and immutable data only: nothing that a playing session
 * writes. Ownership: a loader owns what it has loaded until it is taken. Threads: these calls belong to the
 * window's thread. Errors: those of tl_session_create, tl_moving_light_open and tl_session_make_appearance;
 * TL_DEVICE when no thread can be started. */
#ifndef TOILE_APP_VIEW_LOADER_LOADER_H
#define TOILE_APP_VIEW_LOADER_LOADER_H

#include "app/scene/session.h"
#include "render/renderer.h"

typedef struct tl_loader tl_loader;

enum tl_load { TL_LOAD_SCENE, TL_LOAD_LIGHT, TL_LOAD_APPEARANCE };

struct tl_load_progress {
    char what[64];  /* the current step: "settling the cloth"; "" before the first */
    double share;   /* [0, 1] */
    double seconds; /* since the start */
};

#define TL_LOADER_LIGHTS_MAX 2 /* renderers: two appearances may be compared */

/* The light to prepare, one request for each renderer. Its environment is the loaded one unless the request
 * names another; the exponents that the loaded materials need are added to the request's. The loader owns
 * `known` from the start. */
struct tl_load_lights {
    int count;
    struct tl_prepared_request of[TL_LOADER_LIGHTS_MAX];
};

/* The loaded objects; null or zero: none of this kind. */
struct tl_loaded {
    tl_session *session;
    struct tl_moving_light light;
    struct tl_appearance appearance;
    tl_prepared *prepared[TL_LOADER_LIGHTS_MAX]; /* in the order of the requests */
};
void tl_loaded_release(struct tl_loaded *loaded);

/* Everything that the thread reads is copied here or immutable. `models`: those of the scene that gets
 * another appearance; copied, and alive until the loader has ended; NULL for the other kinds. `lights`:
 * copied; the environments that its requests name stay as they are until the loader has ended. `wake` is
 * called, on the loader's thread, when it has finished. `threads`: the number that its loops may use, 0: all.
 */
tl_loader *tl_loader_start(enum tl_load kind, const struct tl_settings *settings,
                           const struct tl_session_models *models, const struct tl_load_lights *lights,
                           int threads, void (*wake)(void));
enum tl_load tl_loader_kind(const tl_loader *loader);
const struct tl_settings *tl_loader_settings(const tl_loader *loader); /* those that it was started with */
bool tl_loader_is_done(const tl_loader *loader);
struct tl_load_progress tl_loader_progress(tl_loader *loader);

/* Ends a loader that is done: hands over what it has loaded, which the caller then owns, or fails as loading
 * did. Nulls the handle. */
bool tl_loader_take(tl_loader **handle, struct tl_loaded *out, tl_error *error);
/* Asks it to stop. It is done after its current step, and can then only be cancelled. */
void tl_loader_stop(tl_loader *loader);
bool tl_loader_is_stopped(const tl_loader *loader);
/* Stops it, waits until it is done, and frees what it has loaded. Nulls the handle; null is fine. */
void tl_loader_cancel(tl_loader **handle);

#endif
