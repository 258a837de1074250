/* A scene, an environment, or a look, made ready on a thread of its own, so that the window goes on
 * meanwhile; with all that renderers make of its light.
 *
 * Nothing of it touches GL. Ownership: a loader owns what it makes until it is taken. Threads: these calls
 * belong to one thread, the window's. */
#ifndef TOILE_APP_VIEW_WINDOW_LOADER_H
#define TOILE_APP_VIEW_WINDOW_LOADER_H

#include "app/scene/session.h"
#include "render/renderer.h"

typedef struct tl_loader tl_loader;

enum tl_load { TL_LOAD_SCENE, TL_LOAD_LIGHT, TL_LOAD_LOOK };

struct tl_load_progress {
    char what[64];  /* "settling the cloth"; "" until something is known */
    double share;   /* [0, 1] */
    double seconds; /* since the start */
};

#define TL_LOADER_LIGHTS_MAX 2 /* renderers: two looks may be compared */

/* What light is made ready for, by renderer. Its environment is the one that is loaded, unless a request
 * names another; the exponents of what is loaded are added to the request's. What is `known` is the loader's
 * from the start. */
struct tl_load_lights {
    int count;
    struct tl_prepared_request of[TL_LOADER_LIGHTS_MAX];
};

/* What has been made; what the loader did not make is null or zero. */
struct tl_loaded {
    tl_session *session;
    struct tl_moving_light light;
    struct tl_looks looks;
    tl_prepared *prepared[TL_LOADER_LIGHTS_MAX]; /* in the order of the requests */
};
void tl_loaded_release(struct tl_loaded *loaded);

/* Everything that the thread reads is copied here or immutable. `models`: those of the scene that gets
 * another look; copied, and alive until the loader has ended; NULL for the other kinds. `lights`: copied; the
 * environments that its requests name keep_present as they are until the loader has ended. `wake` is called,
 * on the loader's thread, when it has finished. `threads`: the number that its loops may use, 0: all. */
tl_loader *tl_loader_start(enum tl_load kind, const struct tl_settings *settings,
                           const struct tl_session_models *models, const struct tl_load_lights *lights,
                           int threads, void (*wake)(void));
enum tl_load tl_loader_kind(const tl_loader *loader);
const struct tl_settings *tl_loader_settings(const tl_loader *loader); /* that it was started with */
bool tl_loader_is_done(const tl_loader *loader);
struct tl_load_progress tl_loader_progress(tl_loader *loader);

/* Ends a loader that is done: hands over what it has made, or fails as the making did. */
bool tl_loader_take(tl_loader **handle, struct tl_loaded *out, tl_error *error);
/* Asks it to stop: it is done soon, and then fit for nothing but to be cancelled. */
void tl_loader_stop(tl_loader *loader);
bool tl_loader_is_stopped(const tl_loader *loader);
/* Stops it, waits until it is done, and forgets what it made; null is fine. */
void tl_loader_cancel(tl_loader **handle);

#endif
