/* When an image of the review window is drawn: when the session's state or the settings changed; coarsely
 * while something moves, on machines that need it, and sharply as soon as it rests. */
#include "app/review.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void update_title(struct tl_review *review)
{
    const struct tl_scene_params *scene = &review->good.scene;
    char *title = tl_format("toile \u2014 %s, %s, %s", base_name(scene->garment), base_name(scene->fabric),
                            base_name(scene->environment));
    if (!review->title || strcmp(title, review->title) != 0)
        tl_window_set_title(review->window, title);
    free(review->title);
    review->title = title;
}

static bool show_image(struct tl_review *review, int width, int height, tl_error *error)
{
    int line = tl_review_wipe_column(review, width);
    return (line == 0 || tl_renderer_show_columns(review->wipe.renderer, width, height, 0, line, error)) &&
           tl_renderer_show_columns(review->renderer, width, height, line, width, error);
}

bool tl_review_present(struct tl_review *review, tl_error *error)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (!show_image(review, width, height, error))
        return false;
    tl_panel_draw(review->panel);
    tl_window_show(review->window);
    review->shown_count++;
    review->shown_s = tl_clock_s();
    return true;
}

/* What makes the cloth or the light anew takes seconds: it waits until a slider is let go. */
static bool is_slow_change(const struct tl_review *review)
{
    struct tl_settings quick = review->good;
    quick.camera = review->wanted.camera;
    quick.material = review->wanted.material;
    quick.scene.environment_yaw_deg = review->wanted.scene.environment_yaw_deg;
    quick.image.exposure_ev = review->wanted.image.exposure_ev;
    quick.image.background = review->wanted.image.background;
    quick.image.width = review->wanted.image.width;
    quick.image.height = review->wanted.image.height;
    return !tl_settings_equal(&quick, &review->wanted);
}

static void log_changes(const struct tl_scene_params *old, const struct tl_scene_params *new)
{
    const struct {
        const char *what, *old, *new;
    } names[] = {
        {"garment", old->garment, new->garment}, {"avatar", old->avatar, new->avatar},
        {"motion", old->motion, new->motion},    {"environment", old->environment, new->environment},
        {"fabric", old->fabric, new->fabric},    {"preset", old->preset, new->preset},
    };
    for (size_t i = 0; i < TL_COUNT(names); i++)
        if (strcmp(names[i].old, names[i].new) != 0)
            tl_info("view: %s %s", names[i].what, names[i].new);
}

/* Settings at a resolution of one texel for scale x scale pixels. */
static struct tl_settings scaled(const struct tl_settings *settings, int scale)
{
    struct tl_settings result = *settings;
    result.image.width = settings->image.width > scale ? settings->image.width / scale : 1;
    result.image.height = settings->image.height > scale ? settings->image.height / scale : 1;
    if (scale > 1)
        result.image.supersample = 1;
    return result;
}

static bool draw_with(struct tl_review *review, tl_renderer *renderer, const struct tl_settings *settings,
                      tl_error *error)
{
    if (!tl_session_apply(review->session, settings, error))
        return false;
    tl_frame frame = tl_session_frame(review->session);
    const struct tl_render_settings render = tl_settings_render(settings);
    return tl_renderer_draw(renderer, &frame, &render, error);
}

/* Brings the session to what can be followed, and draws it; both looks where two are compared. On failure it
 * stays at what is good. */
static bool draw_image(struct tl_review *review, const struct tl_settings *settings, int scale,
                       tl_error *error)
{
    double started_s = tl_clock_s();
    const struct tl_settings b = scaled(settings, scale);
    if (review->wipe.renderer) {
        const struct tl_settings other = tl_review_look_a(review, settings), a = scaled(&other, scale);
        if (!draw_with(review, review->wipe.renderer, &a, error))
            return false;
    }
    if (!draw_with(review, review->renderer, &b, error))
        return false;
    glFinish(); /* else the time, and with it the coarse scale, would be the driver's, not the image's */
    review->times.draw = 1e3 * (tl_clock_s() - started_s);
    review->drawn_count++;
    tl_debug("view: image %d, frame %d, 1/%d, %.1f ms", review->drawn_count,
             tl_session_frame_number(review->session), scale, review->times.draw);
    return true;
}

static void take_as_good(struct tl_review *review, const struct tl_settings *drawn)
{
    if (review->title && tl_settings_equal(&review->good, drawn))
        return;
    log_changes(&review->good.scene, &drawn->scene);
    review->good = *drawn;
    if (review->message_is_error)
        tl_review_quiet(review);
    update_title(review);
    tl_review_follow_views(review);
}

/* Draws what is wanted. What cannot be drawn is reported, and what was good is drawn instead; false only when
 * that fails too. */
static bool renew_image(struct tl_review *review, int scale, tl_error *error)
{
    int width, height;
    tl_review_size(review, &width, &height);
    review->wanted.image.width = width;
    review->wanted.image.height = height;
    struct tl_settings followed = tl_review_followed(review);
    review->scale = scale;
    if (!draw_image(review, &followed, scale, error)) {
        if (tl_interrupted())
            return false;
        tl_review_complain(review, error);
        tl_renderer_destroy(&review->wipe.renderer);
        review->good.image.width = width;
        review->good.image.height = height;
        review->wanted = review->good;
        if (!draw_image(review, &review->good, scale, error))
            return false;
    } else {
        take_as_good(review, &followed);
    }
    review->changed = review->image_is_old = false;
    review->redraws = review->redraws > 1 ? review->redraws : 1;
    return true;
}

bool tl_review_draw_sharp(struct tl_review *review, tl_error *error)
{
    bool is_sharp = review->scale == 1 && !review->changed && !review->image_is_old;
    return is_sharp || renew_image(review, 1, error);
}

bool tl_review_is_at_rest(const struct tl_review *review)
{
    return tl_renderer_is_at_rest(review->renderer) &&
           (!review->wipe.renderer || tl_renderer_is_at_rest(review->wipe.renderer));
}

/* Coarser when a moving image takes too long, finer when there is time to spare. */
static void adapt_coarse_scale(struct tl_review *review)
{
    const double slow_ms = 60, quick_ms = 12;
    const int coarsest = 2;
    if (review->times.draw > slow_ms && review->coarse_scale < coarsest)
        review->coarse_scale++;
    else if (review->times.draw < quick_ms && review->coarse_scale > 1)
        review->coarse_scale--;
}

bool tl_review_update_image(struct tl_review *review, tl_error *error)
{
    bool moving = tl_review_is_moving(review);
    bool waits = review->changed && review->editing && is_slow_change(review);
    bool improves = !moving && !tl_review_is_at_rest(review); /* jittered rounds are left to average */
    bool is_due =
        (review->changed && !waits) || review->image_is_old || (review->scale > 1 && !moving) || improves;
    if (!is_due || waits)
        return true;
    if (!renew_image(review, moving ? review->coarse_scale : 1, error))
        return false;
    if (moving)
        adapt_coarse_scale(review);
    return true;
}
