/* Scenes and environments are made ready beside the review window. Until one is there the old one stays, with
 * all that can be done to it; one that cannot be had changes nothing. */
#include "app/review.h"
#include "config/interrupt.h"
#include "config/log.h"

#include <omp.h>
#include <string.h>

/* A built-in environment is there at once. */
static bool is_slow_light(const struct tl_review *review, const struct tl_settings *settings)
{
    return tl_session_needs_light(tl_session_settings(review->session), settings) &&
           tl_option_is_file_name(settings->scene.environment);
}

static bool is_slow(const struct tl_review *review, const struct tl_settings *settings)
{
    return tl_session_needs_scene(tl_session_settings(review->session), settings) ||
           is_slow_light(review, settings);
}

struct tl_settings tl_review_followed(const struct tl_review *review)
{
    struct tl_settings followed = review->wanted;
    if (is_slow(review, &followed))
        tl_session_keep_scene(tl_session_settings(review->session), &followed);
    return followed;
}

/* Leaves a core to the window. */
static int loader_threads(void)
{
    int cores = omp_get_num_procs();
    return cores > 1 ? cores - 1 : 1;
}

static void start(struct tl_review *review)
{
    bool is_scene = tl_session_needs_scene(tl_session_settings(review->session), &review->wanted);
    review->loader = tl_loader_start(is_scene ? TL_LOAD_SCENE : TL_LOAD_LIGHT, &review->wanted,
                                     loader_threads(), tl_window_wake);
    tl_info("view: loads %s", is_scene ? review->wanted.scene.garment : review->wanted.scene.environment);
}

/* Whether what is being made is still what is wanted. */
static bool is_outdated(const struct tl_review *review)
{
    const struct tl_settings *made = tl_loader_settings(review->loader);
    return tl_session_needs_scene(made, &review->wanted) || tl_session_needs_light(made, &review->wanted);
}

static void finish(struct tl_review *review)
{
    enum tl_load kind = tl_loader_kind(review->loader);
    const char *environment = review->wanted.scene.environment;
    tl_session *session;
    struct tl_moving_light light;
    tl_error error;
    if (!tl_loader_take(&review->loader, &session, &light, &error)) {
        tl_session_keep_scene(tl_session_settings(review->session), &review->wanted);
        tl_review_complain(review, &error);
    } else if (kind == TL_LOAD_SCENE) {
        tl_session_replace(review->session, &session);
        review->reported_frame = -1;
        review->drag = TL_DRAG_NONE; /* what was held is gone */
    } else {
        tl_session_replace_light(review->session, &light, environment);
    }
    review->changed = true;
}

void tl_review_load(struct tl_review *review)
{
    if (review->loader && is_outdated(review))
        tl_loader_cancel(&review->loader);
    if (review->loader && tl_loader_is_done(review->loader))
        finish(review);
    else if (!review->loader && review->changed && !review->editing && is_slow(review, &review->wanted))
        start(review);
}

bool tl_review_stop_loading(struct tl_review *review)
{
    if (!review->loader)
        return false;
    tl_loader_cancel(&review->loader);
    tl_session_keep_scene(tl_session_settings(review->session), &review->wanted);
    review->changed = true;
    tl_review_say(review, "loading was stopped: the scene stays as it was");
    return true;
}

static void listen_while_waiting(struct tl_review *review)
{
    struct tl_window_event event;
    while (tl_window_next(review->window, &event)) {
        review->closing |= event.type == TL_WINDOW_CLOSE || tl_window_is_escape(&event);
        tl_window_event_release(&event);
    }
}

bool tl_review_load_first(struct tl_review *review, tl_error *error)
{
    const double tick_s = 0.1;
    review->loader = tl_loader_start(TL_LOAD_SCENE, &review->wanted, 0, tl_window_wake);
    while (!tl_loader_is_done(review->loader)) {
        tl_window_wait(review->window, tick_s);
        listen_while_waiting(review);
        if (review->closing)
            return tl_fail(error, TL_INTERRUPTED, "view: closed");
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "view: stopped");
        tl_review_build_progress(review);
    }
    struct tl_moving_light none;
    return tl_loader_take(&review->loader, &review->session, &none, error);
}
