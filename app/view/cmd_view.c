/* toile view: opens the review window, runs its loop, closes it.
 *
 * The loop sleeps while nothing happens, so that an idle window uses no processor time. */
#include "app/budget/back_end.h"
#include "app/settings/command.h"
#include "app/view/command/review_begin.h"
#include "app/view/command/review_input.h"
#include "app/view/command/review_panel.h"
#include "app/view/commands.h"
#include "app/view/review/review_draw.h"
#include "app/view/review/review_edit.h"
#include "app/view/review/review_keep.h"
#include "app/view/review/review_load.h"
#include "app/view/review/review_memory.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_place.h"
#include "app/view/review/review_wipe.h"
#include "app/view/window/rhythm.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Seconds that the loop may sleep when no event arrives. */
static double event_timeout_s(const struct tl_review *review)
{
    const double idle_s = 0.5; /* the interval at which interrupts and edited files are checked */
    const double settling_s = 0.05, tick_s = 0.1; /* tick: between updates of the progress */
    const double screen_s = 1 / 60.0;             /* a turntable needs no more images than the screen shows */
    if (review->due.redraws > 0)
        return 0;
    if (tl_review_moves_itself(review) || review->path.records)
        return fmax(0, review->image.shown_s + screen_s - tl_clock_s());
    if (review->load.loader)
        return review->play.is_on ? 0 : tick_s;
    if (review->due.changed || review->due.image_is_old)
        return 0;
    if (review->play.is_on)
        return fmax(0, review->play.next_step_s - tl_clock_s());
    bool is_done = tl_review_is_sharp(review) && tl_review_is_at_rest(review);
    if (!is_done)
        return tl_review_is_moving(review) ? settling_s : 0;
    return idle_s;
}

static bool is_minimised(const struct tl_review *review)
{
    int width, height;
    tl_review_size(review, &width, &height);
    return width < 1 || height < 1;
}

static bool panel_is_due(const struct tl_review *review)
{
    int width, height;
    tl_review_size(review, &width, &height);
    bool is_used = review->input.drag == TL_DRAG_WIPE || review->placing.shown || review->input.editing ||
                   tl_panel_wants_pointer(review->screen.panel, review->input.x, review->input.y) ||
                   tl_panel_wants_keys(review->screen.panel) ||
                   (review->input.drag == TL_DRAG_NONE && review->input.x >= (float)width);
    return tl_panel_is_due(tl_clock_s(), review->image.times.panel_s, is_used, review->image.is_budgeted);
}

/* The work between two checks for events. */
static bool run_one_frame(struct tl_review *review, bool always_shows, tl_error *error)
{
    review->image.times.began_s = review->image.times.lap_s = tl_clock_s();
    review->image.times.cloth = review->image.times.longest_ms = 0;
    tl_review_take_chosen(review);
    tl_review_reload_edited(review);
    tl_review_lap(review, "watching files");
    tl_review_load(review);
    tl_review_lap(review, "taking over what was loaded");
    tl_review_move(review);
    tl_review_follow_place(review);
    if (!tl_review_update_image(review, error))
        return false;
    review->image.times.lap_s = tl_clock_s();
    tl_review_note_edit(review);
    tl_review_lap(review, "undo");
    tl_review_expire_message(review);
    if (tl_thumbnails_follow(review->screen.thumbnails, review->input.listed) && review->due.redraws == 0)
        review->due.redraws = 1;
    if (review->due.redraws == 0 && !review->input.editing && !review->load.loader && !always_shows)
        return true;
    review->due.redraws -= review->due.redraws > 0;
    if (panel_is_due(review)) {
        tl_review_build_panel(review);
        review->image.times.panel_s = tl_clock_s();
    }
    tl_review_lap(review, "the panel");
    return tl_review_present(review, error);
}

static bool run(struct tl_review *review, int max_frames, tl_error *error)
{
    while (!review->due.closing && (max_frames == 0 || review->image.shown_count < max_frames)) {
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "view: stopped");
        tl_window_wait(review->screen.window, max_frames > 0 ? 0 : event_timeout_s(review));
        tl_review_handle_events(review);
        if (!is_minimised(review) && !run_one_frame(review, max_frames > 0, error))
            return false;
        tl_journal_sync(review->keep.journal);
        tl_review_trim_memory(review);
    }
    return true;
}

/* A software driver takes about a second for an image at the default quality. Unless the command line asks
 * for a quality, a review on such a driver starts with the preset draft. */
static bool needs_draft(const struct tl_review *review)
{
    const struct tl_arguments *arguments = review->keep.arguments;
    bool has_scene = arguments->positional_count > 0 && tl_settings_is_scene(arguments->positionals[0]);
    if (has_scene || !tl_gpu_is_software(review->screen.gpu))
        return false; /* the scene decides its quality; a garment's file has none */
    for (size_t i = 0; i < arguments->assignment_count; i++)
        if (strncmp(arguments->assignments[i], "scene.preset", 12) == 0 ||
            strncmp(arguments->assignments[i], "light.", 6) == 0)
            return false;
    return true;
}

static bool open_window(struct tl_review *review, tl_error *error)
{
    review->screen.window =
        tl_window_create("toile: loading", review->screen.params.width, review->screen.params.height, error);
    if (!review->screen.window)
        return false;
    review->screen.gpu = tl_gpu_create_current(error);
    review->screen.panel = review->screen.gpu
                               ? tl_panel_create(tl_window_handle(review->screen.window), review->screen.gpu,
                                                 tl_window_scale(review->screen.window), error)
                               : NULL;
    review->renderer = review->screen.panel ? tl_renderer_create(review->screen.gpu, error) : NULL;
    return review->renderer != NULL;
}

/* Restored settings may name files that no longer exist: then the built-in review is opened. */
static bool open_scene(struct tl_review *review, bool is_restored, tl_error *error)
{
    struct tl_settings restored = review->wanted;
    if (tl_review_load_first(review, error))
        return true;
    if (review->due.closing || !is_restored || tl_interrupted())
        return false;
    tl_warn("view: the last review cannot be restored (%s): opening the built-in one", error->message);
    tl_journal_park(&review->keep.journal);
    tl_history_destroy(&review->keep.history);
    if (!tl_settings_of_command(review->keep.arguments, false, &review->wanted, error))
        return false;
    review->wanted.camera = restored.camera;
    return tl_review_load_first(review, error);
}

/* Chooses what light.visibility auto means here, before anything is shown. */
static bool calibrate(struct tl_review *review, tl_error *error)
{
    const tl_frame first = tl_session_frame(review->session);
    const struct tl_back_end_start start = {.renderer = review->renderer,
                                            .frame = &first,
                                            .budget_ms = (double)review->screen.params.budget_ms,
                                            .is_software = tl_gpu_is_software(review->screen.gpu)};
    struct tl_back_end chosen;
    return tl_back_end_calibrate(&start, &review->wanted, &chosen, error);
}

static bool open_review(struct tl_review *review, tl_error *error)
{
    const struct tl_arguments *arguments = review->keep.arguments;
    if (!tl_settings_of_command(arguments, false, &review->wanted, error))
        return false;
    bool is_restored = tl_review_restore_state(review);
    int steps = tl_review_recover(review);
    is_restored = is_restored || steps >= 0;
    if (arguments->budget_ms > 0)
        review->screen.params.budget_ms = (float)arguments->budget_ms;
    if (!open_window(review, error))
        return false;
    bool is_draft = !is_restored && needs_draft(review);
    if (is_draft && !tl_settings_apply_preset(&review->wanted, "draft", error))
        return false;
    if (!open_scene(review, is_restored, error) || !calibrate(review, error))
        return false;
    if (!review->keep.history)
        review->keep.history = tl_history_create(&review->wanted);
    review->image.governor = tl_quality_governor_create((double)review->screen.params.budget_ms);
    tl_review_add_environment(review, "studio");
    tl_review_add_environment(review, review->wanted.scene.environment);
    /* The first image must succeed: there are no earlier settings to go back to. */
    review->good = review->wanted;
    tl_review_mark_changed(review);
    if (!tl_review_draw_first(review, error))
        return false;
    tl_info("view: ready with %s; H lists keys and gestures", tl_gpu_name(review->screen.gpu));
    bool is_recovered = review->keep.journal != NULL;
    tl_review_begin_journal(review);
    if (is_recovered)
        tl_review_report(review, "recovered, %d step%s: the last window did not close", steps,
                         steps == 1 ? "" : "s");
    else if (is_draft)
        tl_review_report(review, "no graphics card: preset draft instead of review, for speed; H lists keys");
    else if (!is_restored)
        tl_review_report(review, "H lists keys and gestures");
    return true;
}

/* A window that was not closed by its user keeps its journal. */
static void close_review(struct tl_review *review, bool keeps_journal)
{
    tl_review_save_state(review);
    tl_journal_close(&review->keep.journal, keeps_journal);
    tl_review_end_comparison(review);
    tl_renderer_destroy(&review->renderer);
    tl_panel_destroy(&review->screen.panel);
    tl_thumbnails_destroy(&review->screen.thumbnails);
    tl_gpu_destroy(&review->screen.gpu);
    tl_window_destroy(&review->screen.window); /* before the loader, which may take a while to stop */
    tl_loader_cancel(&review->load.loader);
    tl_session_destroy(&review->session);
    tl_history_destroy(&review->keep.history);
    tl_quality_governor_destroy(&review->image.governor);
    tl_review_path_release(&review->path);
    for (size_t i = 0; i < review->edit.environment_count; i++)
        free(review->edit.environments[i]);
    free(review->edit.environments);
    tl_file_chooser_close(&review->edit.chooser);
    while (review->edit.dropped)
        tl_review_cancel_question(review);
    free(review->edit.waiting);
    free(review->image.title);
    free(review->keep.scene_file);
    free(review->keep.views_file);
    free(review->keep.state_folder);
}

static void log_times(const struct tl_frame_times *times, const char *when)
{
    tl_info("view: %zu images %s: p50 %.1f ms, p95 %.1f ms, p99 %.1f ms, worst %.1f ms", times->total, when,
            tl_frame_times_quantile(times, 0.5), tl_frame_times_quantile(times, 0.95),
            tl_frame_times_quantile(times, 0.99), times->worst_ms);
}

static void log_end(const struct tl_review *review, size_t bytes_before)
{
    const double megabyte = 1 << 20;
    log_times(&review->image.frame_times, "in motion");
    log_times(&review->image.window_times, "in motion, without drawing and cloth");
    log_times(&review->image.rest_times, "at rest");
    tl_info("view: closed after %d images, %d shown, %zu GL messages, resident %.0f MB at start, %.0f MB "
            "at end",
            review->image.drawn_count, review->image.shown_count, tl_gpu_message_count(review->screen.gpu),
            (double)bytes_before / megabyte, (double)tl_review_resident_bytes() / megabyte);
}

bool tl_command_view(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->device)
        return tl_fail(error, TL_USAGE, "--device: the window is drawn by the screen's device: leave it out");
    struct tl_review *review = TL_NEW(struct tl_review);
    review->keep.arguments = arguments;
    tl_settings_reset(&review->wanted);
    review->good = review->load.appearance = review->wipe.settings = review->wanted;
    review->due.redraws = 1;
    review->input.reported_frame = -1;
    review->screen.thumbnails = tl_thumbnails_create(tl_window_wake);
    review->keep.output_folder = arguments->screenshots ? arguments->screenshots : ".";
    bool done = open_review(review, error), loading = !done;
    if (done) {
        size_t bytes_before = tl_review_resident_bytes();
        done = run(review, arguments->max_frames, error);
        log_end(review, bytes_before);
    } else if (review->due.closing) {
        tl_info("view: closed while the scene was loaded");
        done = true;
    }
    close_review(review, !done || loading);
    free(review);
    return done;
}
