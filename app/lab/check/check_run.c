#include "app/lab/check/check_run.h"

#include "app/budget/governor.h"
#include "app/lab/check/check_keep.h"
#include "app/lab/check/check_monitor.h"
#include "app/lab/check/check_trials.h"
#include "app/lab/truth/truth.h"
#include "app/measure/cost.h"
#include "app/measure/motion.h"
#include "config/base/hash.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Auxiliary renderers for the furnace and reuse checks, created on first use. */
struct auxiliary {
    tl_renderer *white, *white_shadowed, *fresh;
    tl_environment light;
};

struct check_run {
    struct tl_headless *headless;
    const struct tl_check_params *params;
    struct tl_check_outcome *outcome;
    struct tl_motion motion;
    struct auxiliary auxiliary;
    uint64_t *hashes, *position_hashes; /* [frames]: of all that is seen; of positions alone */
    int played;                         /* number of frames played so far */
    tl_quality_governor *governor;      /* NULL: no budget */
    struct tl_quality *levels;          /* [frames] */
    struct tl_quality_choice choice;
    double chosen_ms, moved_ms, drawn_ms; /* wall time of this frame: governor, cloth, image */
    struct tl_cloth_monitor watch;
    struct tl_progress progress;
    int steps; /* all that progress counts */
};

static bool is_swung(const struct check_run *run, int number)
{
    int frames = run->params->frames;
    return run->motion.pulls && !run->params->still && number > frames / 10 && number <= frames * 2 / 3;
}

/* The settings that frame `number` is drawn with. */
static struct tl_render_settings settings_of(const struct check_run *run, int number)
{
    const struct tl_render_settings full = tl_settings_render(&run->headless->settings);
    return tl_quality_at(&run->levels[number], &full);
}

static bool advance(struct check_run *run, int number, tl_error *error)
{
    tl_session *session = run->headless->session;
    if (is_swung(run, number))
        return tl_motion_advance(&run->motion, number - run->params->frames / 10, error);
    if (is_swung(run, number - 1))
        tl_cloth_release(tl_session_cloth(session));
    return tl_session_advance(session, error);
}

static tl_frame frame_of(const struct check_run *run, int number)
{
    tl_frame frame = tl_session_frame(run->headless->session);
    frame.camera = tl_motion_camera(&frame.camera, number, run->headless->settings.cloth.frame_rate);
    return frame;
}

static bool draw_with(tl_renderer **renderer, const struct check_run *run, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_image *image, tl_error *error)
{
    if (!*renderer)
        *renderer = tl_renderer_create(run->headless->gpu, error);
    return *renderer && tl_renderer_draw(*renderer, frame, settings, error) &&
           tl_renderer_read(*renderer, image, error);
}

/* ---- One frame ---- */

static void release_images(tl_image *images, size_t count)
{
    for (size_t i = 0; i < count; i++)
        tl_image_release(&images[i]);
}

enum { DRAWN, FRESH, IN_MOTION, WHITE, WHITE_SHADOWED, IMAGES };

/* If the image is upsampled from fewer samples than pixels, the furnace compares the samples: the sharpening
 * filter does not conserve light. */
static void show_samples(struct tl_image_params *image)
{
    int width, height;
    if (image->scale >= 1)
        return;
    tl_image_samples(image, &width, &height);
    image->width = width;
    image->height = height;
    image->supersample = 1;
    image->scale = 1;
}

static bool draw_white(struct check_run *run, const tl_frame *frame, tl_image images[IMAGES],
                       struct tl_checked *checked, tl_error *error)
{
    struct auxiliary *auxiliary = &run->auxiliary;
    struct tl_render_settings settings = *checked->settings;
    tl_frame lit = *frame;
    if (!auxiliary->light.image.texels)
        auxiliary->light = tl_environment_constant(1, 1, 1);
    lit.environment = &auxiliary->light;
    lit.environment_revision = 1;
    lit.lamp_count = 0;
    settings.light.bounce = TL_BOUNCE_OFF; /* shadows alone can only take light away */
    settings.image.view = TL_VIEW_LIGHT;
    show_samples(&settings.image);
    if (!draw_with(&auxiliary->white_shadowed, run, &lit, &settings, &images[WHITE_SHADOWED], error))
        return false;
    settings.light.method = TL_METHOD_UNSHADOWED;
    if (!draw_with(&auxiliary->white, run, &lit, &settings, &images[WHITE], error))
        return false;
    checked->white = auxiliary->white;
    checked->white_image = &images[WHITE];
    checked->white_shadowed = &images[WHITE_SHADOWED];
    return true;
}

/* Draws the frame that is checked, and reports its time to the governor. */
static bool draw_frame(struct check_run *run, const tl_frame *frame,
                       const struct tl_render_settings *settings, tl_image *image, tl_error *error)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    if (!tl_renderer_draw(run->headless->renderer, frame, settings, error))
        return false;
    run->drawn_ms = tl_stopwatch_read(&watch).wall_ms;
    if (run->governor)
        tl_quality_governor_learn(run->governor, tl_renderer_last_plan(run->headless->renderer),
                                  run->moved_ms, run->chosen_ms + run->moved_ms + run->drawn_ms);
    return tl_renderer_read(run->headless->renderer, image, error);
}

/* Draws with a renderer that knows nothing of earlier frames but their environment. */
static bool draw_fresh(struct check_run *run, const tl_frame *frame,
                       const struct tl_render_settings *settings, tl_image *image, tl_error *error)
{
    tl_renderer **fresh = &run->auxiliary.fresh;
    return (!*fresh || tl_renderer_forget_scene(*fresh, error)) &&
           draw_with(fresh, run, frame, settings, image, error);
}

/* Draws the frame as budgets and the window do, where that is another way. */
static bool draw_in_motion(struct check_run *run, const tl_frame *frame, tl_image images[IMAGES],
                           struct tl_checked *checked, tl_error *error)
{
    struct tl_render_settings settings = *checked->settings;
    if (checked->is_reduced || !tl_truth_is_comparable(checked->settings) ||
        settings.light.visibility != TL_VISIBILITY_RAYS || settings.light.ratio_at == TL_RATIO_AT_VERTICES)
        return true;
    settings.light.ratio_at = TL_RATIO_AT_VERTICES;
    if (!draw_fresh(run, frame, &settings, &images[IN_MOTION], error))
        return false;
    checked->in_motion = &images[IN_MOTION];
    return true;
}

/* Draws all images that the frame's invariants need. */
static bool prepare(struct check_run *run, const tl_frame *frame, tl_image images[IMAGES],
                    struct tl_checked *checked, tl_error *error)
{
    if (!draw_frame(run, frame, checked->settings, &images[DRAWN], error))
        return false;
    checked->renderer = run->headless->renderer;
    checked->image = &images[DRAWN];
    checked->hash = tl_check_hash(frame, checked->image);
    checked->positions_hash = tl_check_hash(frame, NULL);
    if (!checked->is_sampled)
        return true;
    if (!draw_fresh(run, frame, checked->settings, &images[FRESH], error))
        return false;
    checked->fresh = &images[FRESH];
    if (!draw_in_motion(run, frame, images, checked, error))
        return false;
    return !run->params->furnace || draw_white(run, frame, images, checked, error);
}

static bool is_finite(const tl_frame *frame)
{
    for (size_t s = 0; s < frame->surface_count; s++)
        for (size_t i = 0; i < 3 * frame->surfaces[s].vertex_count; i++)
            if (!isfinite(frame->surfaces[s].positions->raw[i]))
                return false;
    return true;
}

static bool note(struct check_run *run, const struct tl_checked *checked, tl_error *error)
{
    struct tl_finding found;
    struct tl_check_outcome *outcome = run->outcome;
    int broken = tl_check_frame(checked, &outcome->verdicts, &found);
    if (broken < 0 || outcome->broken >= 0)
        return true;
    outcome->broken = broken;
    outcome->broken_frame = checked->number;
    outcome->found = found;
    if (!run->params->keep)
        return true;
    outcome->is_kept = true;
    return tl_check_keep(run->params->keep, run->headless, checked, &found, error);
}

/* Checks frame `number`, the session's current one. A frame with non-finite positions is not drawn, but its
 * geometry is checked. */
static bool check_frame(struct check_run *run, int number, tl_error *error)
{
    tl_image images[IMAGES] = {0};
    tl_frame frame = frame_of(run, number);
    const struct tl_render_settings settings = settings_of(run, number);
    struct tl_checked_cloth cloth;
    struct tl_checked checked = {.number = number,
                                 .frame = &frame,
                                 .settings = &settings,
                                 .is_sampled = number % run->params->every == 0,
                                 .predicted_ms = run->choice.lasting_ms,
                                 .budget_ms = run->params->budget_ms,
                                 .min_ms = run->choice.min_ms,
                                 .is_reduced = run->choice.error > 0};
    if (tl_session_cloth(run->headless->session)) {
        /* A budget changes the solver's substeps, and with them its effective stiffness. */
        cloth = tl_cloth_monitor_measure(&run->watch, &frame, is_swung(run, number), run->governor);
        if (number == 0) {
            const struct tl_check_baseline *baseline = run->params->baseline;
            run->outcome->elastic_j = cloth.report.elastic_energy;
            cloth.first_elastic_j = baseline ? baseline->elastic_j : (double)NAN;
        }
        checked.cloth = &cloth;
    }
    bool done = !is_finite(&frame) || prepare(run, &frame, images, &checked, error);
    done = done && note(run, &checked, error);
    run->hashes[number] = checked.hash;
    run->position_hashes[number] = checked.positions_hash;
    run->played = number + 1;
    release_images(images, IMAGES);
    return done;
}

static bool report_progress(struct check_run *run, int step, tl_error *error)
{
    tl_progress_update(&run->progress, step, run->steps);
    return !tl_interrupted() ||
           tl_fail(error, TL_INTERRUPTED, "check: stopped at frame %d of %d", step, run->steps);
}

static void begin(struct check_run *run)
{
    tl_motion_begin(&run->motion, run->headless->session);
}

static void choose(struct check_run *run, int number)
{
    if (!run->governor)
        return;
    struct tl_stopwatch watch = tl_stopwatch_start();
    tl_frame frame = frame_of(run, number);
    run->choice =
        tl_quality_governor_choose(run->governor, run->headless->renderer, &frame, &run->headless->settings);
    run->levels[number] = run->choice.levels;
    run->chosen_ms = tl_stopwatch_read(&watch).wall_ms;
}

static bool move_on(struct check_run *run, int number, tl_error *error)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool moved = number == 0 || advance(run, number, error);
    run->moved_ms = tl_stopwatch_read(&watch).wall_ms;
    return moved;
}

static bool play(struct check_run *run, tl_error *error)
{
    bool done = true;
    begin(run);
    for (int number = 0; done && number < run->params->frames; number++) {
        choose(run, number);
        done = move_on(run, number, error) && check_frame(run, number, error);
        done = report_progress(run, run->played, error) && done;
        if (done && run->hashes[number] == 0)
            break; /* a state that is not finite does not recover */
    }
    return done;
}

/* Plays the first frames once more from the start, with a renderer that knows nothing of them. */
static bool play_again(struct check_run *run, int count, tl_error *error)
{
    if (!tl_session_apply(run->headless->session, &run->headless->settings, error) ||
        !tl_session_reset(run->headless->session, error))
        return false;
    tl_renderer **renderer = &run->auxiliary.fresh;
    bool done = !*renderer || tl_renderer_forget_scene(*renderer, error);
    begin(run);
    for (int number = 0; done && number < count; number++) {
        tl_image image = {0};
        const struct tl_render_settings settings = settings_of(run, number);
        done = number == 0 || advance(run, number, error);
        tl_frame frame = frame_of(run, number);
        done = done && draw_with(renderer, run, &frame, &settings, &image, error);
        if (done) {
            struct tl_verdicts *verdicts = &run->outcome->verdicts;
            const struct tl_checked checked = {.number = number,
                                               .frame = &frame,
                                               .settings = &settings,
                                               .renderer = *renderer,
                                               .image = &image,
                                               .hash = tl_check_hash(&frame, &image),
                                               .first_hash = run->hashes[number],
                                               .positions_hash = tl_check_hash(&frame, NULL),
                                               .first_positions_hash = run->position_hashes[number]};
            done = note(run, &checked, error);
            verdicts->frames--; /* the frame has been counted already */
        }
        done = report_progress(run, run->params->frames + number + 1, error) && done;
        tl_image_release(&image);
    }
    return done;
}

/* Measures what needs the cloth for itself: nothing is played after it. */
static bool run_trials(struct check_run *run, tl_error *error)
{
    struct tl_trials trials;
    const struct tl_settings *settings = &run->headless->settings;
    if (!tl_trials_run(run->headless->session, settings, &trials, error))
        return false;
    tl_frame frame = frame_of(run, 0);
    const struct tl_render_settings drawn = tl_settings_render(settings);
    const struct tl_checked checked = {.frame = &frame, .settings = &drawn, .trials = &trials};
    run->outcome->verdicts.frames--; /* no frame of its own */
    return note(run, &checked, error);
}

static uint64_t hash_of(const struct check_run *run)
{
    return tl_hash(TL_HASH_START, run->hashes, (size_t)run->played * sizeof run->hashes[0]);
}

static void release(struct check_run *run)
{
    tl_renderer_destroy(&run->auxiliary.white);
    tl_renderer_destroy(&run->auxiliary.white_shadowed);
    tl_renderer_destroy(&run->auxiliary.fresh);
    tl_environment_release(&run->auxiliary.light);
    tl_quality_governor_destroy(&run->governor);
    free(run->levels);
    free(run->hashes);
    free(run->position_hashes);
    tl_cloth_monitor_release(&run->watch);
}

bool tl_check_play(struct tl_headless *headless, const struct tl_check_params *params,
                   struct tl_check_outcome *out, tl_error *error)
{
    *out = (struct tl_check_outcome){.broken = -1, .elastic_j = NAN, .verdicts.baseline = params->baseline};
    struct check_run run = {.headless = headless,
                            .params = params,
                            .outcome = out,
                            .hashes = TL_NEW_ARRAY(uint64_t, (size_t)params->frames),
                            .position_hashes = TL_NEW_ARRAY(uint64_t, (size_t)params->frames),
                            .governor =
                                params->budget_ms > 0 ? tl_quality_governor_create(params->budget_ms) : NULL,
                            .levels = TL_NEW_ARRAY(struct tl_quality, (size_t)params->frames),
                            .progress = tl_progress_begin("checking")};
    int again = params->frames < 20 ? (params->frames + 1) / 2 : params->frames / 10;
    run.steps = params->frames + again;
    run.watch = tl_cloth_monitor_begin(headless->session, &headless->settings);
    bool done = play(&run, error);
    if (done && run.played == params->frames)
        done = play_again(&run, again, error) && run_trials(&run, error);
    out->hash = hash_of(&run);
    tl_progress_end(&run.progress);
    release(&run);
    return done;
}
