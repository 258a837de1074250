#include "app/view/review/review_draw.h"

#include "app/view/review/review.h"
#include "app/view/review/review_hand.h"
#include "app/view/review/review_keep.h"
#include "app/view/review/review_load.h"
#include "app/view/review/review_wipe.h"
#include "app/view/window/rhythm.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REST_SIDE 2 /* samples a pixel side, unless they take too long */

/* The purpose of an image, which limits its time, and so its quality: the budget, TL_REST_MS, or none. */
enum image_use { IMAGE_IN_MOTION, IMAGE_AT_REST, IMAGE_FIRST, IMAGE_SAVED };

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void update_title(struct tl_review *review)
{
    const struct tl_scene_params *scene = &review->good.scene;
    bool is_body = strcmp(scene->garment, "none") == 0;
    bool is_plain = strcmp(scene->fabric, "none") == 0; /* the file's own materials */
    char *title = tl_format(
        "toile \u2014 %s, %s%s%s", base_name(is_body ? tl_settings_avatar(scene) : scene->garment),
        is_plain ? "" : base_name(scene->fabric), is_plain ? "" : ", ", base_name(scene->environment));
    if (!review->image.title || strcmp(title, review->image.title) != 0)
        tl_window_set_title(review->screen.window, title);
    free(review->image.title);
    review->image.title = title;
}

static bool show_image(struct tl_review *review, int width, int height, tl_error *error)
{
    int line = tl_review_wipe_column(review, width);
    return (line == 0 || tl_renderer_show_columns(review->wipe.renderer, width, height, 0, line, error)) &&
           tl_renderer_show_columns(review->renderer, width, height, line, width, error);
}

void tl_review_lap(struct tl_review *review, const char *part)
{
    struct tl_review_times *times = &review->image.times;
    double now_s = tl_clock_s(), ms = 1e3 * (now_s - times->lap_s);
    times->lap_s = now_s;
    if (ms <= times->longest_ms)
        return;
    times->longest = part;
    times->longest_ms = ms;
}

/* Logs the parts of an image that took noticeably long. */
static void log_slow_image(const struct tl_review *review, double image_ms)
{
    const double slow_ms = 250;
    if (image_ms < slow_ms)
        return;
    const tl_plan *plan = tl_renderer_last_plan(review->renderer);
    tl_debug("view: slow image %d, %s: %.0f ms, of which cloth %.0f ms%s", review->image.drawn_count,
             review->image.is_budgeted ? "in motion" : "at rest", image_ms, review->image.times.cloth,
             review->wipe.renderer ? ", compared" : "");
    if (review->image.times.longest_ms > 0.1 * image_ms)
        tl_debug("view:   %s %.0f ms", review->image.times.longest, review->image.times.longest_ms);
    for (int i = 0; i < plan->count; i++)
        if (plan->rows[i].took_ms > 0.1 * image_ms)
            tl_debug("view:   %s %.0f ms: %s", plan->rows[i].name, plan->rows[i].took_ms,
                     plan->rows[i].reason);
}

/* Called before the swap of buffers, which may wait for the screen. Images at rest are drawn at full quality
 * whatever they take, so that only images in motion teach the governor. */
static void record_time(struct tl_review *review)
{
    if (!review->image.is_new)
        return;
    double frame_ms = 1e3 * (tl_clock_s() - review->image.times.began_s);
    review->image.is_new = false;
    log_slow_image(review, frame_ms);
    if (!review->image.is_budgeted) {
        tl_frame_times_add(&review->image.rest_times, frame_ms);
        return;
    }
    review->image.times.frame = frame_ms;
    tl_frame_times_add(&review->image.frame_times, frame_ms);
    if (!review->wipe.renderer) /* whose drawing is not a part of frame_ms */
        tl_frame_times_add(&review->image.window_times,
                           frame_ms - review->image.times.cloth - review->image.times.draw);
    tl_quality_governor_learn(review->image.governor, tl_renderer_last_plan(review->renderer),
                              review->image.times.cloth, frame_ms);
}

bool tl_review_present(struct tl_review *review, tl_error *error)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (!show_image(review, width, height, error))
        return false;
    review->image.times.lap_s = tl_clock_s();
    tl_panel_draw(review->screen.panel);
    glFinish(); /* GL has only taken the commands: what it draws is part of the frame */
    tl_review_lap(review, "drawing the panel");
    record_time(review);
    tl_window_show(review->screen.window);
    review->image.shown_count++;
    review->image.shown_s = tl_clock_s();
    return true;
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

/* A machine that is too slow plays more slowly; it skips no frame. */
static bool is_step_due(const struct tl_review *review)
{
    return review->play.is_on && tl_clock_s() >= review->play.next_step_s;
}

/* Playback keeps its rate; cloth is simulated frame by frame. */
static bool advance(struct tl_review *review, double late_s, tl_error *error)
{
    int last = tl_session_last_frame(review->session), frame = tl_session_frame_number(review->session);
    if (last == 0)
        return tl_session_advance(review->session, error);
    double frame_s = 1 / review->good.cloth.frame_rate;
    if (frame >= last && !review->screen.params.loop) {
        tl_review_set_playing(review, false);
        return true;
    }
    return tl_session_go_to(review->session,
                            tl_play_next(frame, last, frame_s, late_s, review->screen.params.loop), error);
}

static void step(struct tl_review *review)
{
    double now_s = tl_clock_s(), frame_s = 1 / review->good.cloth.frame_rate;
    double late_s = now_s - review->play.next_step_s;
    bool plays_back = tl_session_last_frame(review->session) > 0;
    tl_error error;
    tl_review_hand_step(review);
    if (!advance(review, late_s, &error))
        tl_review_report_error(review, &error);
    review->play.speed = plays_back ? 1 : tl_play_speed(review->play.speed, frame_s, late_s);
    review->play.next_step_s += frame_s * (plays_back ? 1 + floor(fmax(late_s, 0) / frame_s) : 1);
    review->play.next_step_s = fmax(review->play.next_step_s, plays_back ? 0 : now_s);
    review->image.times.cloth = 1e3 * (tl_clock_s() - now_s);
}

/* Both appearances share the budget. */
static void choose_levels(struct tl_review *review, const struct tl_settings *settings)
{
    double budget_ms = (double)review->screen.params.budget_ms;
    tl_quality_governor_set_budget(review->image.governor, review->wipe.renderer ? budget_ms / 2 : budget_ms);
    const tl_frame coming = tl_session_frame(review->session);
    review->image.choice =
        tl_quality_governor_choose(review->image.governor, review->renderer, &coming, settings);
}

/* The levels of an image at rest, and the samples that it needs so that edges have no steps: more a pixel
 * than a preset for motion asks for, or, where these would hold a gesture up, images that are shifted by
 * parts of a pixel one after the other; these are what the graphics card's rounds are. The choice stands
 * until something changes: another one would begin again. */
static void choose_rest(struct tl_review *review, struct tl_render_settings *settings, bool goes_on)
{
    struct tl_review_rest *rest = &review->image.rest;
    const int requested = settings->image.supersample;
    const tl_frame coming = tl_session_frame(review->session);
    if (!goes_on) {
        tl_frame shifted = coming;
        shifted.smooth = true;
        const bool has_rounds = tl_renderer_is_on_card(review->renderer, &shifted, settings);
        settings->image.supersample = requested > REST_SIDE || has_rounds ? requested : REST_SIDE;
        struct tl_quality_rest chosen = tl_quality_governor_rest(review->renderer, &coming, settings);
        *rest = (struct tl_review_rest){.samples = settings->image.supersample, .is_shifted = has_rounds};
        if (chosen.is_slow && !has_rounds && settings->light.visibility == TL_VISIBILITY_RAYS) {
            *rest = (struct tl_review_rest){.samples = requested, .is_shifted = true};
            settings->image.supersample = requested;
            chosen = tl_quality_governor_rest(review->renderer, &coming, settings);
        }
        rest->levels = chosen.levels;
    }
    settings->image.supersample = rest->samples;
    review->image.choice.levels = rest->levels;
}

/* Chooses the levels of the image, and its samples in *settings. The session is where the image will be. */
static void choose_quality(struct tl_review *review, const struct tl_settings *wanted, enum image_use use,
                           struct tl_render_settings *settings)
{
    const bool goes_on = review->image.is_resting && !review->due.changed && !review->due.image_is_old;
    if (use == IMAGE_IN_MOTION)
        choose_levels(review, wanted);
    else
        review->image.choice.levels = (struct tl_quality){{0}};
    if (use == IMAGE_AT_REST)
        choose_rest(review, settings, goes_on);
    if (use == IMAGE_SAVED && settings->image.supersample < REST_SIDE)
        settings->image.supersample = REST_SIDE;
}

/* Begins the cloth's next step beside the drawing. Cloth is then shown one frame after the hand that pulls
 * it.
 */
static bool begin_step(struct tl_review *review, const tl_frame *frame,
                       const struct tl_render_settings *render)
{
    return review->play.is_on && !review->wipe.renderer &&
           tl_session_steps_beside(review->session,
                                   tl_renderer_is_on_card(review->renderer, frame, render)) &&
           tl_session_begin_step(review->session);
}

static bool draw_b(struct tl_review *review, const struct tl_render_settings *full, bool smooth,
                   tl_error *error)
{
    const struct tl_render_settings render = tl_quality_at(&review->image.choice.levels, full);
    tl_frame frame = tl_session_frame(review->session);
    frame.smooth = smooth;
    review->play.is_beside |= begin_step(review, &frame, &render);
    return tl_renderer_draw(review->renderer, &frame, &render, error);
}

/* Applies `settings` to the session, simulates a frame when one is due, and draws; both appearances when two
 * are compared. */
static bool draw_image(struct tl_review *review, const struct tl_settings *settings, enum image_use use,
                       tl_error *error)
{
    struct tl_render_settings full = tl_settings_render(settings);
    review->image.times.lap_s = tl_clock_s();
    if (!tl_session_apply(review->session, settings, error))
        return false;
    choose_quality(review, settings, use, &full);
    tl_review_lap(review, "settings and levels");
    if (is_step_due(review))
        step(review);
    const bool is_shifted = use == IMAGE_AT_REST && review->image.rest.is_shifted;
    double started_s = tl_clock_s();
    if (review->wipe.renderer) {
        if (!tl_review_draw_a(review, settings, is_shifted, error))
            return false;
        review->image.times.began_s +=
            tl_clock_s() - started_s; /* the governor learns from one renderer, B's */
    }
    const bool is_drawn = draw_b(review, &full, is_shifted, error);
    const double drawn_s = tl_clock_s();
    tl_session_end_step(review->session); /* nothing else runs beside a step */
    if (!is_drawn)
        return false;
    review->image.times.draw = 1e3 * (drawn_s - started_s);
    review->image.times.cloth += 1e3 * (tl_clock_s() - drawn_s);
    review->image.drawn_count++;
    review->image.is_new = true;
    review->image.is_budgeted = use == IMAGE_IN_MOTION;
    review->image.is_resting = use == IMAGE_AT_REST;
    review->image.is_exact = use == IMAGE_SAVED;
    tl_debug("view: image %d, frame %d, %.1f ms", review->image.drawn_count,
             tl_session_frame_number(review->session), review->image.times.draw);
    return true;
}

static void accept_settings(struct tl_review *review, const struct tl_settings *drawn)
{
    if (review->image.title && tl_settings_equal(&review->good, drawn))
        return;
    log_changes(&review->good.scene, &drawn->scene);
    review->good = *drawn;
    if (review->screen.message.is_error)
        tl_review_clear_message(review);
    update_title(review);
    tl_review_load_views(review);
}

/* Draws `wanted`. When that fails, reports it and draws `good` instead; false only when that fails too. */
static bool redraw(struct tl_review *review, enum image_use use, tl_error *error)
{
    int width, height;
    bool is_another =
        review->due.changed || review->due.image_is_old; /* new content, rather than a refinement */
    tl_review_size(review, &width, &height);
    review->wanted.image.width = width;
    review->wanted.image.height = height;
    struct tl_settings followed;
    tl_review_drawable_settings(review, &followed);
    if (!draw_image(review, &followed, use, error)) {
        if (tl_interrupted())
            return false;
        tl_review_report_error(review, error);
        tl_review_end_comparison(review);
        review->good.image.width = width;
        review->good.image.height = height;
        review->wanted = review->good;
        if (!draw_image(review, &review->good, use, error))
            return false;
    } else {
        accept_settings(review, &followed);
    }
    review->due.changed = review->due.image_is_old = false;
    int redraws_min = use == IMAGE_IN_MOTION || !is_another
                          ? 1
                          : 2; /* ImGui needs a second frame to find the size of new texts */
    review->due.redraws = review->due.redraws > redraws_min ? review->due.redraws : redraws_min;
    return true;
}

bool tl_review_is_sharp(const struct tl_review *review)
{
    return review->image.drawn_count > 0 && !review->image.is_budgeted;
}

bool tl_review_draw_first(struct tl_review *review, tl_error *error)
{
    return redraw(review, IMAGE_FIRST, error);
}

bool tl_review_draw_sharp(struct tl_review *review, tl_error *error)
{
    bool is_done = review->image.is_exact && !review->due.changed && !review->due.image_is_old;
    return is_done || redraw(review, IMAGE_SAVED, error);
}

bool tl_review_is_at_rest(const struct tl_review *review)
{
    return tl_renderer_is_at_rest(review->renderer) &&
           (!review->wipe.renderer || tl_renderer_is_at_rest(review->wipe.renderer));
}

/* While nothing is to be drawn, what motion will need is made. */
static void prepare_motion(struct tl_review *review)
{
    const tl_frame present = tl_session_frame(review->session);
    tl_quality_governor_prepare(review->image.governor, review->renderer, &present, &review->good);
}

bool tl_review_update_image(struct tl_review *review, tl_error *error)
{
    bool waits = review->due.changed && review->input.editing &&
                 tl_settings_differ_slowly(&review->good, &review->wanted);
    /* At rest the renderer averages jittered rounds, which may wait until input and the panel are handled. */
    bool is_refined = tl_review_is_at_rest(review) || review->due.redraws > 0;
    bool improves = !tl_review_is_moving(review) && !(is_refined && tl_review_is_sharp(review));
    bool is_due = review->due.changed || review->due.image_is_old || is_step_due(review) || improves;
    if (!is_due && !improves && tl_review_is_sharp(review) && !review->play.is_on && !review->load.loader)
        prepare_motion(review);
    if (waits || !is_due)
        return true;
    if (!redraw(review, tl_review_is_moving(review) ? IMAGE_IN_MOTION : IMAGE_AT_REST, error))
        return false;
    if (review->image.is_resting && tl_review_is_at_rest(review))
        tl_debug("view: at rest with image %d: samples a pixel side %d, %s", review->image.drawn_count,
                 review->image.rest.samples, review->image.rest.is_shifted ? "shifted" : "not shifted");
    return true;
}
