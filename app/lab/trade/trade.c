#include "app/lab/trade/trade.h"

#include "app/budget/governor.h"
#include "app/cli/topic.h"
#include "app/settings/command.h"
#include "assets/image/image_file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define QUICK_ROUNDS 4

struct run {
    const struct tl_experiment *experiment;
    const struct tl_arguments *arguments;
    struct tl_headless *headless;
    struct tl_trade *trade;
    int warm, measured; /* frames before the first measured one, and those measured; the last one rests */
    struct tl_progress progress;
    size_t finished, count; /* techniques, over all appearances */
    bool quick;
    tl_recording *recording;
    tl_environment sky;
    const struct tl_trade_options *options;
    struct tl_variant_run reference;
    struct tl_reference_frame frames[2]; /* the reference's first and last measured frame under this
                                            appearance; empty until needed */
    int appearance;
};

#define FRAMES_MAX     16
#define REST_DRAWS_MAX 1024

/* One technique with its renderer, and the governor that chooses its levels. */
struct entry {
    const struct tl_technique *technique;
    struct tl_variant_run variant;
    struct tl_settings settings;   /* before the governor's levels */
    tl_quality_governor *governor; /* NULL: no budget */
    double cpu_ms[FRAMES_MAX], wall_ms[FRAMES_MAX];
    struct tl_measured_error first, last; /* of the measured frames */
};

/* The scene's own, where no appearance of the experiment is measured. */
static const struct tl_experiment_appearance as_read = {.name = "as read", .title = "as read"};

static const struct tl_experiment_appearance *
appearance_of(const struct tl_experiment *experiment, const struct tl_trade_options *options, int number)
{
    return options->as_read ? &as_read : &experiment->appearances[number];
}

static tl_frame frame_of(const struct run *run, int number)
{
    tl_frame frame = tl_recording_frame(run->recording, number);
    if (appearance_of(run->experiment, run->options, run->appearance)->uniform_sky) {
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
    struct tl_trade_picture picture = {.name = name, .appearance = run->appearance, .error = *measured};
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

static bool need_reference(struct run *run, int number, const struct tl_reference_frame **reference,
                           tl_error *error)
{
    bool last = number == last_frame(run);
    struct tl_reference_frame *kept = &run->frames[last];
    *reference = kept;
    if (kept->image.texels)
        return true;
    tl_frame frame = frame_of(run, number);
    frame.aovs = run->experiment->by_flip; /* whose error is the garment's */
    return tl_reference_frame_draw(&run->reference, &frame, kept, error) &&
           (!last || keep_picture(run, &run->reference, "the truth", &(struct tl_measured_error){0}, error));
}

static bool compare(struct run *run, struct tl_variant_run *variant, int number,
                    struct tl_measured_error *out, tl_error *error)
{
    const struct tl_reference_frame *reference;
    return need_reference(run, number, &reference, error) &&
           tl_variant_run_compare(variant, reference, out, error);
}

static void add_row(struct run *run, const struct entry *entry, int draws, const double *cpu_ms,
                    const double *wall_ms, int count, struct tl_measured_error measured)
{
    struct tl_trade *trade = run->trade;
    trade->rows = tl_resize(trade->rows, trade->row_count + 1, sizeof *trade->rows);
    trade->rows[trade->row_count++] = (struct tl_trade_row){
        .group = entry->technique->group,
        .name = entry->technique->page,
        .appearance = run->appearance,
        .rest = draws > 1,
        .draws = draws,
        .budget_ms = entry->technique->budget_ms,
        .settings = entry->variant.settings,
        .taken = {tl_median(cpu_ms, (size_t)count), tl_median(wall_ms, (size_t)count)},
        .error = measured,
        .memory = tl_renderer_memory(entry->variant.renderer),
    };
}

/* Draws one frame. Under a budget the time counts drawing only: the cloth's motion was recorded before. */
static bool draw(struct run *run, struct entry *entry, int number, struct tl_taken *taken, tl_error *error)
{
    if (tl_interrupted())
        return tl_fail(error, TL_INTERRUPTED, "trade: stopped: what was measured is written");
    struct tl_variant_run *variant = &entry->variant;
    tl_frame frame = frame_of(run, number);
    if (!entry->governor)
        return tl_variant_run_draw(variant, &frame, taken, error);
    struct tl_quality_choice choice =
        tl_quality_governor_choose(entry->governor, variant->renderer, &frame, &entry->settings);
    const struct tl_render_settings full = tl_settings_render(&entry->settings);
    variant->settings = tl_quality_at(&choice.levels, &full);
    if (!tl_variant_run_draw(variant, &frame, taken, error))
        return false;
    tl_quality_governor_learn(entry->governor, tl_renderer_last_plan(variant->renderer), 0, taken->wall_ms);
    return true;
}

/* `share` is that of the techniques that are measured now, in techniques. */
static void show_progress(struct run *run, double share)
{
    tl_progress_update(&run->progress, (double)run->finished + share, (double)run->count);
}

/* Draws one frame and compares the first and the last of the measured ones. What does not depend on earlier
 * frames draws only the last one before them, to fill its caches. */
static bool measure_frame(struct run *run, struct entry *entry, int number, tl_error *error)
{
    struct tl_taken taken = {0};
    bool remembers = entry->governor || tl_variant_run_has_history(&entry->variant);
    if (number < run->warm - 1 && !remembers)
        return true;
    if (!draw(run, entry, number, &taken, error))
        return false;
    if (number < run->warm)
        return true;
    entry->cpu_ms[number - run->warm] = taken.cpu_ms;
    entry->wall_ms[number - run->warm] = taken.wall_ms;
    return (number != run->warm || compare(run, &entry->variant, number, &entry->first, error)) &&
           (number != last_frame(run) || compare(run, &entry->variant, number, &entry->last, error));
}

static struct tl_measured_error mean_error(const struct tl_measured_error *first,
                                           const struct tl_measured_error *last)
{
    return (struct tl_measured_error){
        .rel_rmse = 0.5 * (first->rel_rmse + last->rel_rmse),
        .standard_error = 0.5 * (first->standard_error + last->standard_error),
        .flip_mean = 0.5 * (first->flip_mean + last->flip_mean),
        .max_abs = fmax(first->max_abs, last->max_abs),
        .worst_share = fmax(first->worst_share, last->worst_share),
        .covered = last->covered,
        .garment = {.pixels = last->garment.pixels,
                    .flip_mean = 0.5 * (first->garment.flip_mean + last->garment.flip_mean),
                    .flip_worst = 0.5 * (first->garment.flip_worst + last->garment.flip_worst)}};
}

/* Every frame is drawn by all entries in turn, so that other load on the machine affects all alike. */
static bool measure_motion(struct run *run, struct entry *entries, size_t count, tl_error *error)
{
    bool done = true;
    for (int number = 0; done && number <= last_frame(run); number++) {
        for (size_t i = 0; done && i < count; i++)
            done = measure_frame(run, &entries[i], number, error);
        show_progress(run, (double)count * (number + 1.0) / (last_frame(run) + 1.0));
    }
    for (size_t i = 0; done && i < count; i++) {
        struct entry *entry = &entries[i];
        add_row(run, entry, 1, entry->cpu_ms, entry->wall_ms, run->measured,
                mean_error(&entry->first, &entry->last));
        done = !entry->technique->shown ||
               keep_picture(run, &entry->variant, entry->technique->page, &entry->last, error);
    }
    return done;
}

/* Draws the last frame until the renderer is at rest. Adds a row whenever the number of draws has doubled,
 * and at the end. */
static bool measure_rest(struct run *run, struct entry *entry, tl_error *error)
{
    int draws = run->quick ? QUICK_ROUNDS : REST_DRAWS_MAX, since = 0;
    double cpu_ms[REST_DRAWS_MAX], wall_ms[REST_DRAWS_MAX];
    bool done = true, at_rest = false;
    for (int drawn = 2; done && !at_rest && drawn <= draws; drawn++) {
        struct tl_taken taken = {0};
        struct tl_measured_error measured;
        done = draw(run, entry, last_frame(run), &taken, error);
        show_progress(run, 1); /* nobody knows how many it takes */
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

/* A technique whose settings equal those of an earlier one repeats its rows: they were measured once. */
static bool repeat(struct run *run, const struct entry *entry)
{
    struct tl_trade *trade = run->trade;
    size_t count = trade->row_count;
    const char *earlier = NULL;
    for (size_t i = 0; i < count && !entry->governor; i++) {
        struct tl_trade_row same = trade->rows[i];
        if (same.appearance != run->appearance || same.budget_ms > 0 ||
            !same_settings(&same.settings, &entry->variant.settings))
            continue;
        if (earlier && strcmp(earlier, same.name) != 0)
            continue; /* itself a repetition */
        earlier = same.name;
        same.group = entry->technique->group;
        same.name = entry->technique->page;
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
            return; /* the same for every appearance */
    trade->refusals = tl_resize(trade->refusals, trade->refusal_count + 1, sizeof *trade->refusals);
    trade->refusals[trade->refusal_count++] = tl_format("%s: %s", name, error->message);
}

static bool enter(struct run *run, const struct tl_technique *technique, struct entry *out, tl_error *error)
{
    const struct tl_settings *scene = &run->headless->settings;
    *out = (struct entry){
        .technique = technique,
        .governor = technique->budget_ms > 0 ? tl_quality_governor_create(technique->budget_ms) : NULL};
    return tl_setup_apply(&technique->setup, scene, &out->settings, error) &&
           tl_variant_run_create(&out->variant, run->headless->gpu, &technique->setup, scene, error);
}

static void leave(struct entry *entry)
{
    tl_variant_run_release(&entry->variant);
    tl_quality_governor_destroy(&entry->governor);
}

/* The next technique that is measured under this appearance. */
static const struct tl_technique *next_technique(const struct run *run, const struct tl_technique *after)
{
    const struct tl_trade_options *options = run->options;
    const struct tl_technique *next = after;
    bool first = options->quick || run->appearance == 0;
    do
        next = tl_experiment_next(run->experiment, TL_OUTPUT_PAGE, next);
    while (next && ((options->group && strcmp(options->group, next->group) != 0) ||
                    (options->quick && !options->group && !next->quick) || (next->once && !first)));
    return next;
}

/* All techniques in turn: each has a renderer at the same time. */
static bool measure_in_turn(struct run *run, tl_error *error)
{
    struct entry *entries = TL_NEW_ARRAY(struct entry, run->count);
    const struct tl_technique *technique = NULL;
    size_t count = 0;
    bool done = true;
    while (done && (technique = next_technique(run, technique)))
        done = enter(run, technique, &entries[count++], error);
    done = done && measure_motion(run, entries, count, error);
    for (size_t i = 0; done && run->experiment->rests && i < count; i++)
        done = measure_rest(run, &entries[i], error);
    for (size_t i = 0; i < count; i++)
        leave(&entries[i]);
    free(entries);
    return done;
}

/* A technique that the renderer refuses is noted and skipped; Ctrl-C or a failing reference ends the run. */
static bool measure_technique(struct run *run, const struct tl_technique *technique, tl_error *error)
{
    struct entry entry;
    tl_error refusal = {0};
    bool done = enter(run, technique, &entry, &refusal);
    if (done && !repeat(run, &entry))
        done = measure_motion(run, &entry, 1, &refusal) &&
               (!run->experiment->rests || measure_rest(run, &entry, &refusal));
    leave(&entry);
    if (done)
        return true;
    if (refusal.code != TL_USAGE) {
        *error = refusal;
        return false;
    }
    note_refusal(run->trade, technique->page, &refusal);
    return true;
}

static bool make_reference(struct run *run, const struct tl_experiment_appearance *appearance,
                           tl_error *error)
{
    struct tl_setup reference = run->experiment->reference;
    size_t own = 0;
    while (own < TL_COUNT(reference.assignments) && reference.assignments[own])
        own++;
    for (size_t i = 0; i < TL_COUNT(appearance->reference) && appearance->reference[i] &&
                       own < TL_COUNT(reference.assignments);
         i++)
        reference.assignments[own++] = appearance->reference[i];
    tl_variant_run_release(&run->reference);
    return tl_variant_run_create(&run->reference, run->headless->gpu, &reference, &run->headless->settings,
                                 error);
}

/* The appearance that is measured first: the only one of a quick run. */
static int first_appearance(const struct tl_experiment *experiment, const struct tl_trade_options *options)
{
    return options->quick ? experiment->quick_appearance : 0;
}

/* The scene as an appearance has it. It is read from its file again, because a fabric that an assignment
 * names is a layer below the other assignments. */
static bool read_appearance(const struct tl_experiment *experiment,
                            const struct tl_experiment_appearance *appearance,
                            const struct tl_arguments *arguments, struct tl_settings *out, tl_error *error)
{
    const char *const *parts[] = {experiment->base, appearance->assignments};
    struct tl_arguments own = *arguments;
    own.assignments =
        tl_alloc(TL_COUNT(parts) * TL_EXPERIMENT_ASSIGNMENTS + arguments->assignment_count, sizeof(char *));
    size_t count = 0, copied;
    for (size_t p = 0; p < TL_COUNT(parts); p++)
        for (size_t i = 0; i < TL_EXPERIMENT_ASSIGNMENTS && parts[p][i]; i++)
            own.assignments[count++] = tl_copy_string(parts[p][i]);
    copied = count;
    for (size_t i = 0; i < arguments->assignment_count; i++)
        own.assignments[count++] = arguments->assignments[i];
    own.assignment_count = count;
    tl_topic_default_scene(&own, experiment->scene);
    bool read = tl_settings_of_command(&own, false, out, error);
    for (size_t i = 0; i < copied; i++)
        free(own.assignments[i]);
    free(own.assignments);
    return read;
}

/* Another fabric falls and moves otherwise, so every appearance has a drape and a recording of its own. The
 * session has the first appearance's drape. */
static bool begin_appearance(struct run *run, int number, tl_error *error)
{
    const struct tl_experiment *experiment = run->experiment;
    struct tl_headless *headless = run->headless;
    struct tl_trade *trade = run->trade;
    struct tl_settings settings;
    const struct tl_experiment_appearance *appearance = appearance_of(experiment, run->options, number);
    bool first = number == first_appearance(experiment, run->options);
    run->appearance = number;
    tl_reference_frame_release(&run->frames[0]);
    tl_reference_frame_release(&run->frames[1]);
    tl_recording_destroy(&run->recording);
    if (!first) {
        if (!read_appearance(experiment, appearance, run->arguments, &settings, error) ||
            !tl_session_restart(headless->session, &settings, error))
            return false;
        headless->settings = *tl_session_settings(headless->session);
    }
    trade->environment = tl_session_frame(headless->session).environment;
    run->recording = tl_motion_record(headless->session, run->warm + run->measured, error);
    if (run->recording && first)
        trade->recording = tl_recording_report(run->recording);
    return run->recording && make_reference(run, appearance, error);
}

static bool measure_all(struct run *run, tl_error *error)
{
    const struct tl_experiment *experiment = run->experiment;
    char label[64];
    snprintf(label, sizeof label, "measuring the trade of %s", experiment->name);
    int first = first_appearance(experiment, run->options),
        appearances = run->quick || run->options->as_read ? 1 : experiment->appearance_count;
    run->progress = tl_progress_begin(label);
    run->count = tl_experiment_count(experiment, TL_OUTPUT_PAGE) * (size_t)appearances;
    bool done = true;
    for (int i = 0; done && i < appearances; i++) {
        const struct tl_technique *technique = NULL;
        done = begin_appearance(run, first + i, error) &&
               (!run->options->in_turn || measure_in_turn(run, error));
        while (done && !run->options->in_turn && (technique = next_technique(run, technique))) {
            done = measure_technique(run, technique, error);
            run->finished++;
            show_progress(run, 0);
        }
    }
    tl_progress_end(&run->progress);
    return done;
}

bool tl_trade_headless(const struct tl_experiment *experiment, const struct tl_arguments *arguments,
                       const struct tl_trade_options *options, struct tl_headless *headless, tl_error *error)
{
    struct tl_settings settings;
    const struct tl_experiment_appearance *appearance =
        appearance_of(experiment, options, first_appearance(experiment, options));
    return read_appearance(experiment, appearance, arguments, &settings, error) &&
           tl_headless_may_repeat(&settings, "trade", error) && tl_headless_open(headless, &settings, error);
}

bool tl_trade_measure(const struct tl_experiment *experiment, const struct tl_arguments *arguments,
                      const struct tl_trade_options *options, struct tl_headless *headless,
                      struct tl_trade *out, tl_error *error)
{
    bool quick = options->quick;
    int frames = options->frames ? options->frames : experiment->measured;
    struct run run = {
        .experiment = experiment,
        .arguments = arguments,
        .options = options,
        .headless = headless,
        .trade = out,
        .warm = quick ? 2 : experiment->warm_up,
        .measured = quick ? 2 : frames,
        .quick = quick,
        .sky = tl_environment_constant(1, 1, 1),
    };
    *out = (struct tl_trade){.experiment = experiment, .quick = quick};
    bool done = out->complete = measure_all(&run, error);
    tl_variant_run_release(&run.reference);
    tl_reference_frame_release(&run.frames[0]);
    tl_reference_frame_release(&run.frames[1]);
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
