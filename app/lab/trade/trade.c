#include "app/lab/trade/trade.h"

#include "app/budget/governor.h"
#include "app/cli/topic.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define QUICK_ROUNDS 4

struct run {
    const struct tl_trade_axis *axis;
    struct tl_stage *stage;
    struct tl_settings scene; /* without a look */
    struct tl_trade *trade;
    int warm, measured; /* frames before the first measured one, and those; the last is the one that rests */
    bool quick;
    tl_recording *recording;
    tl_environment sky;
    struct tl_variant_run oracle;
    struct tl_reference_frame
        truths[2]; /* of the current look: the first and the last measured frame; empty until needed */
    int look;
};

/* One that draws, and who chooses its levels. */
struct entry {
    const struct tl_entrant *entrant;
    struct tl_variant_run variant;
    struct tl_settings settings; /* as chosen, before any level */
    tl_pace *pace;               /* NULL: as chosen */
};

static tl_frame frame_of(const struct run *run, int number)
{
    tl_frame frame = tl_recording_frame(run->recording, number);
    if (run->axis->looks[run->look].sky) {
        frame.environment = &run->sky;
        frame.environment_revision = 0; /* sessions count from 1 */
    }
    return frame;
}

static int last_frame(const struct run *run)
{
    return run->warm + run->measured - 1;
}

static bool keep_picture(struct run *run, struct tl_variant_run *variant, const char *name,
                         const struct tl_measured_error *measured, tl_error *error)
{
    struct tl_trade_picture picture = {.name = name, .look = run->look, .error = *measured};
    tl_image image = {0};
    bool kept = tl_renderer_show_image(variant->renderer, &image, error) &&
                tl_image_encode_png(name, &image, &picture.png, &picture.size, error);
    tl_image_release(&image);
    if (!kept)
        return false;
    struct tl_trade *trade = run->trade;
    trade->pictures = tl_resize(trade->pictures, trade->picture_count + 1, sizeof *trade->pictures);
    trade->pictures[trade->picture_count++] = picture;
    return true;
}

static bool need_truth(struct run *run, int number, const struct tl_reference_frame **truth, tl_error *error)
{
    bool last = number == last_frame(run);
    struct tl_reference_frame *kept = &run->truths[last];
    *truth = kept;
    if (kept->image.texels)
        return true;
    tl_frame frame = frame_of(run, number);
    return tl_reference_frame_draw(&run->oracle, &frame, kept, error) &&
           (!last || keep_picture(run, &run->oracle, "the truth", &(struct tl_measured_error){0}, error));
}

static bool compare(struct run *run, struct tl_variant_run *variant, int number,
                    struct tl_measured_error *out, tl_error *error)
{
    const struct tl_reference_frame *truth;
    return need_truth(run, number, &truth, error) && tl_variant_run_compare(variant, truth, out, error);
}

static void add_row(struct run *run, const struct entry *entry, int draws, const double *cpu_ms,
                    const double *wall_ms, int count, struct tl_measured_error measured)
{
    struct tl_trade *trade = run->trade;
    trade->rows = tl_resize(trade->rows, trade->row_count + 1, sizeof *trade->rows);
    trade->rows[trade->row_count++] = (struct tl_trade_row){
        .group = entry->entrant->group,
        .name = entry->entrant->choice.name,
        .look = run->look,
        .rest = draws > 1,
        .draws = draws,
        .budget_ms = entry->entrant->budget_ms,
        .settings = entry->variant.settings,
        .taken = {tl_median(cpu_ms, (size_t)count), tl_median(wall_ms, (size_t)count)},
        .error = measured,
        .memory = tl_renderer_memory(entry->variant.renderer),
    };
}

/* Under a budget a frame's time is that of drawing: the cloth's motion was recorded before. */
static bool draw(struct run *run, struct entry *entry, int number, struct tl_taken *taken, tl_error *error)
{
    if (tl_interrupted())
        return tl_fail(error, TL_INTERRUPTED, "trade: stopped: what was measured is written");
    struct tl_variant_run *variant = &entry->variant;
    tl_frame frame = frame_of(run, number);
    if (!entry->pace)
        return tl_variant_run_draw(variant, &frame, taken, error);
    struct tl_pace_choice choice = tl_pace_choose(entry->pace, variant->renderer, &frame, &entry->settings);
    struct tl_settings levelled = tl_levels_apply(&choice.levels, &entry->settings);
    variant->settings = tl_settings_render(&levelled);
    if (!tl_variant_run_draw(variant, &frame, taken, error))
        return false;
    tl_pace_learn(entry->pace, tl_renderer_last_plan(variant->renderer), 0, taken->wall_ms);
    return true;
}

#define FRAMES_MAX     16
#define REST_DRAWS_MAX 1024

static bool measure_motion(struct run *run, struct entry *entry, tl_error *error)
{
    int warm = run->warm, count = run->measured;
    double cpu_ms[FRAMES_MAX], wall_ms[FRAMES_MAX];
    struct tl_taken taken = {0};
    struct tl_measured_error first = {0}, last;
    struct tl_variant_run *variant = &entry->variant;
    bool remembers = entry->pace || tl_variant_run_has_history(variant);
    for (int number = remembers ? 0 : warm - 1; number < warm; number++)
        if (!draw(run, entry, number, &taken, error))
            return false;
    for (int i = 0; i < count; i++) {
        if (!draw(run, entry, warm + i, &taken, error))
            return false;
        cpu_ms[i] = taken.cpu_ms;
        wall_ms[i] = taken.wall_ms;
        if (i == 0 && !compare(run, variant, warm, &first, error))
            return false;
    }
    if (!compare(run, variant, warm + count - 1, &last, error))
        return false;
    add_row(run, entry, 1, cpu_ms, wall_ms, count,
            (struct tl_measured_error){.rel_rmse = 0.5 * (first.rel_rmse + last.rel_rmse),
                                       .standard_error = 0.5 * (first.standard_error + last.standard_error),
                                       .flip_mean = 0.5 * (first.flip_mean + last.flip_mean),
                                       .max_abs = fmax(first.max_abs, last.max_abs),
                                       .covered = last.covered});
    return !entry->entrant->picture || keep_picture(run, variant, variant->name, &last, error);
}

/* The last frame again until nothing is left to average; a row whenever its draws have doubled, and at the
 * end. */
static bool measure_rest(struct run *run, struct entry *entry, tl_error *error)
{
    int draws = run->quick ? QUICK_ROUNDS : REST_DRAWS_MAX, since = 0;
    double cpu_ms[REST_DRAWS_MAX], wall_ms[REST_DRAWS_MAX];
    bool done = true, at_rest = false;
    for (int drawn = 2; done && !at_rest && drawn <= draws; drawn++) {
        struct tl_taken taken = {0};
        struct tl_measured_error measured;
        done = draw(run, entry, last_frame(run), &taken, error);
        cpu_ms[since] = taken.cpu_ms;
        wall_ms[since++] = taken.wall_ms;
        at_rest = tl_renderer_is_at_rest(entry->variant.renderer);
        if (!done || ((drawn & (drawn - 1)) != 0 && drawn != draws && !at_rest))
            continue;
        done = compare(run, &entry->variant, last_frame(run), &measured, error);
        if (done)
            add_row(run, entry, drawn, cpu_ms, wall_ms, since, measured);
        since = 0;
    }
    return done;
}

static bool same_settings(const struct tl_render_settings *a, const struct tl_render_settings *b)
{
    return tl_options_equal(&tl_light_options, &a->light, &b->light) &&
           tl_options_equal(&tl_detail_options, &a->detail, &b->detail) &&
           tl_options_equal(&tl_maps_options, &a->maps, &b->maps) &&
           tl_options_equal(&tl_shading_options, &a->shading, &b->shading) &&
           tl_options_equal(&tl_image_options, &a->image, &b->image);
}

/* An entrant that is drawn with the settings of an earlier one has measured the same. */
static bool repeat(struct run *run, const struct entry *entry)
{
    struct tl_trade *trade = run->trade;
    size_t count = trade->row_count;
    const char *earlier = NULL;
    for (size_t i = 0; i < count && !entry->pace; i++) {
        struct tl_trade_row same = trade->rows[i];
        if (same.look != run->look || same.budget_ms > 0 ||
            !same_settings(&same.settings, &entry->variant.settings))
            continue;
        if (earlier && strcmp(earlier, same.name) != 0)
            continue; /* itself a repetition */
        earlier = same.name;
        same.group = entry->entrant->group;
        same.name = entry->entrant->choice.name;
        trade->rows = tl_resize(trade->rows, trade->row_count + 1, sizeof *trade->rows);
        trade->rows[trade->row_count++] = same;
    }
    return earlier != NULL;
}

static void note_refusal(struct tl_trade *trade, const char *name, const tl_error *error)
{
    tl_warn("trade: %s: %s", name, error->message);
    for (size_t i = 0; i < trade->refusal_count; i++)
        if (strncmp(trade->refusals[i], name, strlen(name)) == 0)
            return; /* the same for every look */
    trade->refusals = tl_resize(trade->refusals, trade->refusal_count + 1, sizeof *trade->refusals);
    trade->refusals[trade->refusal_count++] = tl_format("%s: %s", name, error->message);
}

static bool enter(struct run *run, const struct tl_entrant *entrant, struct entry *out, tl_error *error)
{
    const struct tl_settings *scene = &run->stage->settings;
    *out = (struct entry){.entrant = entrant,
                          .pace = entrant->budget_ms > 0 ? tl_pace_create(entrant->budget_ms) : NULL};
    return tl_setup_apply(&entrant->choice, scene, &out->settings, error) &&
           tl_variant_run_create(&out->variant, run->stage->gpu, &entrant->choice, scene, error);
}

/* An entrant that the renderer refuses is noted, and the others go on; only Ctrl-C and a failing truth end
 * the run. */
static bool measure_entrant(struct run *run, const struct tl_entrant *entrant, tl_error *error)
{
    struct entry entry;
    tl_error refusal = {0};
    bool done = enter(run, entrant, &entry, &refusal);
    if (done && !repeat(run, &entry))
        done = measure_motion(run, &entry, &refusal) &&
               (!run->axis->rests || measure_rest(run, &entry, &refusal));
    tl_variant_run_release(&entry.variant);
    tl_pace_destroy(&entry.pace);
    if (done)
        return true;
    if (refusal.code != TL_USAGE) {
        *error = refusal;
        return false;
    }
    note_refusal(run->trade, entrant->choice.name, &refusal);
    return true;
}

static bool make_oracle(struct run *run, const struct tl_trade_look *look, tl_error *error)
{
    struct tl_setup truth = run->axis->truth;
    size_t own = 0;
    while (own < TL_COUNT(truth.assignments) && truth.assignments[own])
        own++;
    for (size_t i = 0; i < TL_COUNT(look->truth) && look->truth[i] && own < TL_COUNT(truth.assignments); i++)
        truth.assignments[own++] = look->truth[i];
    tl_variant_run_release(&run->oracle);
    return tl_variant_run_create(&run->oracle, run->stage->gpu, &truth, &run->stage->settings, error);
}

static bool begin_look(struct run *run, int number, tl_error *error)
{
    const struct tl_trade_look *look = &run->axis->looks[number];
    run->look = number;
    tl_reference_frame_release(&run->truths[0]);
    tl_reference_frame_release(&run->truths[1]);
    run->stage->settings = run->scene;
    return tl_settings_assign(&run->stage->settings, look->scene, TL_COUNT(look->scene), error) &&
           tl_session_apply(run->stage->session, &run->stage->settings, error) &&
           make_oracle(run, look, error);
}

static bool measure_all(struct run *run, tl_error *error)
{
    const struct tl_trade_axis *axis = run->axis;
    char label[64];
    snprintf(label, sizeof label, "measuring the trade of %s", axis->name);
    struct tl_progress progress = tl_progress_begin(label);
    int looks = run->quick ? 1 : axis->look_count;
    bool done = true;
    for (int i = 0; done && i < looks; i++) {
        done = begin_look(run, run->quick ? axis->quick_look : i, error);
        for (size_t e = 0; done && e < axis->entrant_count; e++) {
            if (!run->quick || axis->entrants[e].quick)
                done = measure_entrant(run, &axis->entrants[e], error);
            tl_progress_update(&progress, (double)((size_t)i * axis->entrant_count + e + 1),
                               (double)(axis->entrant_count * (size_t)looks));
        }
    }
    tl_progress_end(&progress);
    return done;
}

/* What the command line says counts more than the axis's base. */
bool tl_trade_stage(const struct tl_trade_axis *axis, const struct tl_arguments *arguments,
                    struct tl_stage *stage, tl_error *error)
{
    struct tl_arguments own = *arguments;
    char *assignments[TL_TRADE_ASSIGNMENTS];
    size_t count = 0;
    while (count < TL_COUNT(axis->base) && axis->base[count]) {
        assignments[count] = tl_copy_string(axis->base[count]);
        count++;
    }
    own.assignments = tl_alloc(count + arguments->assignment_count, sizeof(char *));
    own.assignment_count = count + arguments->assignment_count;
    memcpy(own.assignments, assignments, count * sizeof(char *));
    for (size_t i = 0; i < arguments->assignment_count; i++)
        own.assignments[count + i] = arguments->assignments[i];
    tl_topic_default_scene(&own, axis->scene);
    bool created = tl_stage_create(stage, &own, error);
    for (size_t i = 0; i < count; i++)
        free(assignments[i]);
    free(own.assignments);
    return created;
}

bool tl_trade_measure(const struct tl_trade_axis *axis, struct tl_stage *stage, bool quick,
                      struct tl_trade *out, tl_error *error)
{
    struct run run = {
        .axis = axis,
        .stage = stage,
        .scene = stage->settings,
        .trade = out,
        .warm = quick ? 2 : axis->warm,
        .measured = quick ? 2 : axis->measured,
        .quick = quick,
        .sky = tl_environment_constant(1, 1, 1),
    };
    *out = (struct tl_trade){.axis = axis,
                             .width = stage->settings.image.width,
                             .height = stage->settings.image.height,
                             .quick = quick,
                             .environment = tl_session_frame(stage->session).environment};
    run.recording = tl_motion_record(stage->session, run.warm + run.measured, error);
    bool done = run.recording != NULL;
    if (done) {
        out->recording = tl_recording_report(run.recording);
        done = out->complete = measure_all(&run, error);
    }
    tl_variant_run_release(&run.oracle);
    tl_reference_frame_release(&run.truths[0]);
    tl_reference_frame_release(&run.truths[1]);
    tl_environment_release(&run.sky);
    tl_recording_destroy(&run.recording);
    return done;
}

void tl_trade_release(struct tl_trade *trade)
{
    for (size_t i = 0; i < trade->picture_count; i++)
        free(trade->pictures[i].png);
    for (size_t i = 0; i < trade->refusal_count; i++)
        free(trade->refusals[i]);
    free(trade->pictures);
    free(trade->refusals);
    free(trade->rows);
    *trade = (struct tl_trade){0};
}
