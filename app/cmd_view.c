/* toile view: the review window. Its life, its loop, and when an image is drawn.
 *
 * A window in which nothing happens costs nothing: the loop sleeps. An image is drawn when the session's
 * state or the settings changed; coarsely while something moves, on machines that need it, and sharply as
 * soon as it rests. */
#include "app/commands.h"
#include "app/review.h"
#include "app/stage.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WINDOW_WIDTH  1280
#define WINDOW_HEIGHT 800

void tl_review_size(const struct tl_review *review, int *width, int *height)
{
    tl_window_size(review->window, width, height);
    *width -= tl_review_panel_width(review);
}

static void set_message(struct tl_review *review, bool is_error, const char *text)
{
    snprintf(review->message, sizeof review->message, "%s", text);
    review->message_is_error = is_error;
}

void tl_review_say(struct tl_review *review, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char text[sizeof review->message];
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    set_message(review, false, text);
    tl_info("view: %s", text);
}

void tl_review_complain(struct tl_review *review, const tl_error *error)
{
    set_message(review, true, error->message);
    tl_warn("view: %s", error->message);
    review->playing = false;
}

void tl_review_touch(struct tl_review *review)
{
    review->moved_s = tl_clock_s();
}

/* True while coarse images are in order. */
static bool is_moving(const struct tl_review *review)
{
    const double rest_s = 0.25;
    return review->playing || review->drag != TL_DRAG_NONE || tl_clock_s() - review->moved_s < rest_s;
}

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

/* Puts the last image, and the panel as it was built, on the screen. */
static bool present(struct tl_review *review, tl_error *error)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (!tl_renderer_show_window(review->renderer, width, height, error))
        return false;
    tl_panel_draw(review->panel);
    tl_window_show(review->window);
    review->shown_count++;
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

/* Brings the session to what is wanted, at a resolution of one texel for scale x scale pixels. On failure it
 * stays at what is good. */
static bool follow(struct tl_review *review, int scale, tl_error *error)
{
    int width, height;
    tl_review_size(review, &width, &height);
    review->wanted.image.width = width;
    review->wanted.image.height = height;
    struct tl_settings scaled = review->wanted;
    scaled.image.width = width > scale ? width / scale : 1;
    scaled.image.height = height > scale ? height / scale : 1;
    if (scale > 1)
        scaled.image.supersample = 1;
    return tl_session_apply(review->session, &scaled, error);
}

static bool draw_image(struct tl_review *review, tl_error *error)
{
    double started_s = tl_clock_s();
    tl_frame frame = tl_session_frame(review->session);
    const struct tl_settings *settings = tl_session_settings(review->session);
    const struct tl_render_settings render = tl_settings_render(settings);
    if (!tl_renderer_draw(review->renderer, &frame, &render, error))
        return false;
    glFinish(); /* else the time, and with it the coarse scale, would be the driver's, not the image's */
    review->times.draw = 1e3 * (tl_clock_s() - started_s);
    review->drawn_count++;
    tl_debug("view: image %d, frame %d, 1/%d, %.1f ms", review->drawn_count,
             tl_session_frame_number(review->session), review->scale, review->times.draw);
    return true;
}

/* Follows and draws. What cannot be loaded or drawn is reported, and what was good is drawn instead; false
 * only when that fails too. */
static bool renew_image(struct tl_review *review, int scale, tl_error *error)
{
    review->scale = scale;
    if (!follow(review, scale, error) || !draw_image(review, error)) {
        if (tl_interrupted())
            return false;
        tl_review_complain(review, error);
        review->wanted = review->good;
        if (!follow(review, scale, error) || !draw_image(review, error))
            return false;
    } else if (!tl_settings_equal(&review->good, &review->wanted)) {
        log_changes(&review->good.scene, &review->wanted.scene);
        review->good = review->wanted;
        if (review->message_is_error)
            set_message(review, false, "");
        update_title(review);
    }
    review->changed = review->image_is_old = false;
    review->redraws = review->redraws > 1 ? review->redraws : 1;
    return true;
}

bool tl_review_draw_sharp(struct tl_review *review, tl_error *error)
{
    return review->scale == 1 && !review->changed && !review->image_is_old ? true
                                                                           : renew_image(review, 1, error);
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

static bool update_image(struct tl_review *review, tl_error *error)
{
    bool moving = is_moving(review);
    bool waits = review->changed && review->editing && is_slow_change(review);
    bool improves =
        !moving && !tl_renderer_is_at_rest(review->renderer); /* jittered rounds are left to average */
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

/* One simulated frame when it is due. A machine that is too slow plays slower, and skips nothing. */
static void play(struct tl_review *review)
{
    double now_s = tl_clock_s();
    if (!review->playing || now_s < review->next_step_s)
        return;
    tl_error error;
    tl_review_move_hand(review);
    if (!tl_session_advance(review->session, &error))
        tl_review_complain(review, &error);
    double frame_s = 1 / review->good.cloth.frame_rate;
    review->next_step_s = fmax(review->next_step_s + frame_s, now_s);
    review->times.cloth = 1e3 * (tl_clock_s() - now_s);
    review->image_is_old = true;
}

static double patience_s(const struct tl_review *review)
{
    const double idle_s = 0.5, settling_s = 0.05; /* idle: only Ctrl-C is looked for */
    if (review->changed || review->image_is_old || review->redraws > 0)
        return 0;
    if (review->playing)
        return fmax(0, review->next_step_s - tl_clock_s());
    if (!is_moving(review) && !tl_renderer_is_at_rest(review->renderer))
        return 0;
    return review->scale > 1 ? settling_s : idle_s;
}

static bool is_minimised(const struct tl_review *review)
{
    int width, height;
    tl_review_size(review, &width, &height);
    return width < 1 || height < 1;
}

static bool run(struct tl_review *review, int max_frames, tl_error *error)
{
    while (!review->closing && (max_frames == 0 || review->shown_count < max_frames)) {
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "view: stopped");
        tl_window_wait(review->window, max_frames > 0 ? 0 : patience_s(review));
        double started_s = tl_clock_s();
        tl_review_listen(review);
        if (is_minimised(review))
            continue;
        int drawn_before = review->drawn_count;
        play(review);
        if (!update_image(review, error))
            return false;
        if (review->redraws == 0 && !review->editing && max_frames == 0)
            continue;
        review->redraws -= review->redraws > 0;
        tl_review_build_panel(review);
        if (!present(review, error))
            return false;
        if (review->drawn_count > drawn_before)
            review->times.frame = 1e3 * (tl_clock_s() - started_s);
    }
    return true;
}

/* Every image of the default quality takes a software driver about a second. Unless quality was asked for, a
 * review there begins with less of it. */
static bool needs_draft(const struct tl_review *review, const struct tl_arguments *arguments)
{
    if (arguments->positional_count > 0 || !strstr(tl_gpu_name(review->gpu), "llvmpipe"))
        return false; /* a scene means what it says */
    for (size_t i = 0; i < arguments->assignment_count; i++)
        if (strncmp(arguments->assignments[i], "scene.preset", 12) == 0 ||
            strncmp(arguments->assignments[i], "light.", 6) == 0)
            return false;
    return true;
}

static bool open_window(struct tl_review *review, tl_error *error)
{
    review->window = tl_window_create("toile: loading", WINDOW_WIDTH, WINDOW_HEIGHT, error);
    if (!review->window)
        return false;
    const float surround = 0.13f; /* the panel's grey */
    glClearColor(surround, surround, surround, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    tl_window_show(review->window);
    review->gpu = tl_gpu_create_current(error);
    review->panel = review->gpu ? tl_panel_create(tl_window_handle(review->window),
                                                  tl_window_scale(review->window), error)
                                : NULL;
    review->renderer = review->panel ? tl_renderer_create(review->gpu, error) : NULL;
    return review->renderer != NULL;
}

static bool open_review(struct tl_review *review, const struct tl_arguments *arguments, tl_error *error)
{
    if (!tl_stage_settings(arguments, &review->wanted, error) || !open_window(review, error))
        return false;
    bool is_draft = needs_draft(review, arguments);
    if (is_draft && !tl_settings_apply_preset(&review->wanted, "draft", error))
        return false;
    review->session = tl_session_create(&review->wanted, error);
    if (!review->session)
        return false;
    review->good = review->wanted;
    update_title(review);
    tl_review_know_environment(review, "studio");
    tl_review_know_environment(review, review->wanted.scene.environment);
    /* The first image must come off: there is nothing good to go back to yet. */
    if (!follow(review, 1, error) || !draw_image(review, error))
        return false;
    tl_info("view: ready with %s; H lists keys and gestures", tl_gpu_name(review->gpu));
    if (is_draft)
        tl_review_say(review, "no graphics card: preset draft instead of review, to stay quick");
    return true;
}

static void close_review(struct tl_review *review)
{
    tl_renderer_destroy(&review->renderer);
    tl_panel_destroy(&review->panel);
    tl_gpu_destroy(&review->gpu);
    tl_window_destroy(&review->window);
    tl_session_destroy(&review->session);
    for (size_t i = 0; i < review->environment_count; i++)
        free(review->environments[i]);
    free(review->environments);
    free(review->dropped);
    free(review->title);
}

bool tl_command_view(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_review *review = TL_NEW(struct tl_review);
    review->scale = review->coarse_scale = 1;
    review->redraws = 1;
    review->reported_frame = -1;
    review->screenshot_folder = arguments->screenshots ? arguments->screenshots : ".";
    bool done = open_review(review, arguments, error);
    if (done) {
        const double megabyte = 1 << 20;
        double before = (double)tl_review_resident_bytes() / megabyte;
        done = run(review, arguments->max_frames, error);
        tl_info("view: closed after %d images, %d shown, %zu GL messages, resident %.0f MB at start, %.0f MB "
                "at end",
                review->drawn_count, review->shown_count, tl_gpu_message_count(review->gpu), before,
                (double)tl_review_resident_bytes() / megabyte);
    }
    close_review(review);
    free(review);
    return done;
}
