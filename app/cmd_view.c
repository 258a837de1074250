/* toile view: the review window. Its life, its loop, and when an image is drawn.
 *
 * A window in which nothing happens costs nothing: the loop sleeps. An image is drawn when the session's
 * state or the settings changed; coarsely while something moves, on machines that need it, and sharply as
 * soon as it rests. */
#include "app/commands.h"
#include "app/stage.h"
#include "app/view.h"
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

void tl_view_size(const struct tl_view *view, int *width, int *height)
{
    tl_window_size(view->window, width, height);
    *width -= tl_view_panel_width(view);
}

static void set_message(struct tl_view *view, bool is_error, const char *text)
{
    snprintf(view->message, sizeof view->message, "%s", text);
    view->message_is_error = is_error;
}

void tl_view_say(struct tl_view *view, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char text[sizeof view->message];
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    set_message(view, false, text);
    tl_info("view: %s", text);
}

void tl_view_complain(struct tl_view *view, const tl_error *error)
{
    set_message(view, true, error->message);
    tl_warn("view: %s", error->message);
    view->playing = false;
}

void tl_view_touch(struct tl_view *view)
{
    view->moved_s = tl_clock_s();
}

/* True while coarse images are in order. */
static bool is_moving(const struct tl_view *view)
{
    const double rest_s = 0.25;
    return view->playing || view->drag != TL_DRAG_NONE || tl_clock_s() - view->moved_s < rest_s;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void update_title(struct tl_view *view)
{
    const struct tl_scene_params *scene = &view->good.scene;
    char *title = tl_format("toile \u2014 %s, %s, %s", base_name(scene->garment), base_name(scene->fabric),
                            base_name(scene->environment));
    if (!view->title || strcmp(title, view->title) != 0)
        tl_window_set_title(view->window, title);
    free(view->title);
    view->title = title;
}

/* Puts the last image, and the panel as it was built, on the screen. */
static bool present(struct tl_view *view, tl_error *error)
{
    int width, height;
    tl_view_size(view, &width, &height);
    if (!tl_renderer_show_window(view->renderer, width, height, error))
        return false;
    tl_panel_draw(view->panel);
    tl_window_show(view->window);
    view->shown_count++;
    return true;
}

/* What makes the cloth or the light anew takes seconds: it waits until a slider is let go. */
static bool is_slow_change(const struct tl_view *view)
{
    struct tl_settings quick = view->good;
    quick.camera = view->wanted.camera;
    quick.material = view->wanted.material;
    quick.scene.environment_yaw_deg = view->wanted.scene.environment_yaw_deg;
    quick.image.exposure_ev = view->wanted.image.exposure_ev;
    quick.image.background = view->wanted.image.background;
    quick.image.width = view->wanted.image.width;
    quick.image.height = view->wanted.image.height;
    return !tl_settings_equal(&quick, &view->wanted);
}

static void log_changes(const struct tl_scene_params *old, const struct tl_scene_params *new)
{
    const struct {
        const char *what, *old, *new;
    } names[] = {
        {"garment", old->garment, new->garment},
        {"avatar", old->avatar, new->avatar},
        {"environment", old->environment, new->environment},
        {"fabric", old->fabric, new->fabric},
        {"preset", old->preset, new->preset},
    };
    for (size_t i = 0; i < TL_COUNT(names); i++)
        if (strcmp(names[i].old, names[i].new) != 0)
            tl_info("view: %s %s", names[i].what, names[i].new);
}

/* Brings the session to what is wanted, at a resolution of one texel for scale x scale pixels. On failure it
 * stays at what is good. */
static bool follow(struct tl_view *view, int scale, tl_error *error)
{
    int width, height;
    tl_view_size(view, &width, &height);
    view->wanted.image.width = width;
    view->wanted.image.height = height;
    struct tl_settings scaled = view->wanted;
    scaled.image.width = width > scale ? width / scale : 1;
    scaled.image.height = height > scale ? height / scale : 1;
    if (scale > 1)
        scaled.image.supersample = 1;
    return tl_session_apply(view->session, &scaled, error);
}

static bool draw_image(struct tl_view *view, tl_error *error)
{
    double started_s = tl_clock_s();
    tl_frame frame = tl_session_frame(view->session);
    const struct tl_settings *settings = tl_session_settings(view->session);
    const struct tl_render_settings render = {.light = settings->light, .image = settings->image};
    if (!tl_renderer_draw(view->renderer, &frame, &render, error))
        return false;
    glFinish(); /* else the time, and with it the coarse scale, would be the driver's, not the image's */
    view->times.draw = 1e3 * (tl_clock_s() - started_s);
    view->drawn_count++;
    tl_debug("view: image %d, frame %d, 1/%d, %.1f ms", view->drawn_count,
             tl_session_frame_number(view->session), view->scale, view->times.draw);
    return true;
}

/* Follows and draws. What cannot be loaded or drawn is reported, and what was good is drawn instead; false
 * only when that fails too. */
static bool renew_image(struct tl_view *view, int scale, tl_error *error)
{
    view->scale = scale;
    if (!follow(view, scale, error) || !draw_image(view, error)) {
        if (tl_interrupted())
            return false;
        tl_view_complain(view, error);
        view->wanted = view->good;
        if (!follow(view, scale, error) || !draw_image(view, error))
            return false;
    } else if (!tl_settings_equal(&view->good, &view->wanted)) {
        log_changes(&view->good.scene, &view->wanted.scene);
        view->good = view->wanted;
        if (view->message_is_error)
            set_message(view, false, "");
        update_title(view);
    }
    view->changed = view->image_is_old = false;
    view->redraws = view->redraws > 1 ? view->redraws : 1;
    return true;
}

bool tl_view_draw_sharp(struct tl_view *view, tl_error *error)
{
    return view->scale == 1 && !view->changed && !view->image_is_old ? true : renew_image(view, 1, error);
}

/* Coarser when a moving image takes too long, finer when there is time to spare. */
static void adapt_coarse_scale(struct tl_view *view)
{
    const double slow_ms = 60, quick_ms = 12;
    const int coarsest = 2;
    if (view->times.draw > slow_ms && view->coarse_scale < coarsest)
        view->coarse_scale++;
    else if (view->times.draw < quick_ms && view->coarse_scale > 1)
        view->coarse_scale--;
}

static bool update_image(struct tl_view *view, tl_error *error)
{
    bool moving = is_moving(view);
    bool waits = view->changed && view->editing && is_slow_change(view);
    bool is_due = (view->changed && !waits) || view->image_is_old || (view->scale > 1 && !moving);
    if (!is_due || waits)
        return true;
    if (!renew_image(view, moving ? view->coarse_scale : 1, error))
        return false;
    if (moving)
        adapt_coarse_scale(view);
    return true;
}

/* One simulated frame when it is due. A machine that is too slow plays slower, and skips nothing. */
static void play(struct tl_view *view)
{
    double now_s = tl_clock_s();
    if (!view->playing || now_s < view->next_step_s)
        return;
    tl_error error;
    tl_view_move_hand(view);
    if (!tl_session_advance(view->session, &error))
        tl_view_complain(view, &error);
    double frame_s = 1 / view->good.cloth.frame_rate;
    view->next_step_s = fmax(view->next_step_s + frame_s, now_s);
    view->times.cloth = 1e3 * (tl_clock_s() - now_s);
    view->image_is_old = true;
}

static double patience_s(const struct tl_view *view)
{
    const double idle_s = 0.5, settling_s = 0.05; /* idle: only Ctrl-C is looked for */
    if (view->changed || view->image_is_old || view->redraws > 0)
        return 0;
    if (view->playing)
        return fmax(0, view->next_step_s - tl_clock_s());
    return view->scale > 1 ? settling_s : idle_s;
}

static bool is_minimised(const struct tl_view *view)
{
    int width, height;
    tl_view_size(view, &width, &height);
    return width < 1 || height < 1;
}

static bool run(struct tl_view *view, int max_frames, tl_error *error)
{
    while (!view->closing && (max_frames == 0 || view->shown_count < max_frames)) {
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "view: stopped");
        tl_window_wait(view->window, max_frames > 0 ? 0 : patience_s(view));
        double started_s = tl_clock_s();
        tl_view_listen(view);
        if (is_minimised(view))
            continue;
        int drawn_before = view->drawn_count;
        play(view);
        if (!update_image(view, error))
            return false;
        if (view->redraws == 0 && !view->editing && max_frames == 0)
            continue;
        view->redraws -= view->redraws > 0;
        tl_view_build_panel(view);
        if (!present(view, error))
            return false;
        if (view->drawn_count > drawn_before)
            view->times.frame = 1e3 * (tl_clock_s() - started_s);
    }
    return true;
}

/* Every image of the default quality takes a software driver about a second. Unless quality was asked for, a
 * review there begins with less of it. */
static bool needs_draft(const struct tl_view *view, const struct tl_arguments *arguments)
{
    if (arguments->positional_count > 0 || !strstr(tl_gpu_name(view->gpu), "llvmpipe"))
        return false; /* a scene means what it says */
    for (size_t i = 0; i < arguments->assignment_count; i++)
        if (strncmp(arguments->assignments[i], "scene.preset", 12) == 0 ||
            strncmp(arguments->assignments[i], "light.", 6) == 0)
            return false;
    return true;
}

static bool open_window(struct tl_view *view, tl_error *error)
{
    view->window = tl_window_create("toile: loading", WINDOW_WIDTH, WINDOW_HEIGHT, error);
    if (!view->window)
        return false;
    const float surround = 0.13f; /* the panel's grey */
    glClearColor(surround, surround, surround, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    tl_window_show(view->window);
    view->gpu = tl_gpu_create_current(error);
    view->panel = view->gpu
                      ? tl_panel_create(tl_window_handle(view->window), tl_window_scale(view->window), error)
                      : NULL;
    view->renderer = view->panel ? tl_renderer_create(view->gpu, error) : NULL;
    return view->renderer != NULL;
}

static bool open_view(struct tl_view *view, const struct tl_arguments *arguments, tl_error *error)
{
    if (!tl_stage_settings(arguments, &view->wanted, error) || !open_window(view, error))
        return false;
    bool is_draft = needs_draft(view, arguments);
    if (is_draft && !tl_settings_apply_preset(&view->wanted, "draft", error))
        return false;
    view->session = tl_session_create(&view->wanted, error);
    if (!view->session)
        return false;
    view->good = view->wanted;
    update_title(view);
    tl_view_know_environment(view, "studio");
    tl_view_know_environment(view, view->wanted.scene.environment);
    /* The first image must come off: there is nothing good to go back to yet. */
    if (!follow(view, 1, error) || !draw_image(view, error))
        return false;
    tl_info("view: ready with %s; H lists keys and gestures", tl_gpu_name(view->gpu));
    if (is_draft)
        tl_view_say(view, "no graphics card: preset draft instead of review, to stay quick");
    return true;
}

static void close_view(struct tl_view *view)
{
    tl_renderer_destroy(&view->renderer);
    tl_panel_destroy(&view->panel);
    tl_gpu_destroy(&view->gpu);
    tl_window_destroy(&view->window);
    tl_session_destroy(&view->session);
    for (size_t i = 0; i < view->environment_count; i++)
        free(view->environments[i]);
    free(view->environments);
    free(view->dropped);
    free(view->title);
}

bool tl_command_view(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_view *view = TL_NEW(struct tl_view);
    view->scale = view->coarse_scale = 1;
    view->redraws = 1;
    view->reported_frame = -1;
    view->screenshot_folder = arguments->screenshots ? arguments->screenshots : ".";
    bool done = open_view(view, arguments, error);
    if (done) {
        const double megabyte = 1 << 20;
        double before = (double)tl_view_resident_bytes() / megabyte;
        done = run(view, arguments->max_frames, error);
        tl_info("view: closed after %d images, %d shown, %zu GL messages, resident %.0f MB at start, %.0f MB "
                "at end",
                view->drawn_count, view->shown_count, tl_gpu_message_count(view->gpu), before,
                (double)tl_view_resident_bytes() / megabyte);
    }
    close_view(view);
    free(view);
    return done;
}
