/* toile plan: prints which jobs a frame runs, why, and what they cost in time and memory. */
#include "app/batch/commands.h"
#include "app/budget/back_end.h"
#include "app/budget/governor.h"
#include "app/cli/json.h"
#include "app/measure/cost.h"
#include "app/scene/headless.h"
#include "render/gpu/clocks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MEBIBYTE (1024.0 * 1024.0)

/* The cost of jobs that levels leave out: measured, by a renderer of its own that draws the
 * frame in full. */
struct savings {
    bool are_measured;
    double ms[TL_JOBS_MAX];    /* by job; 0: it does not run in full either */
    size_t bytes[TL_JOBS_MAX]; /* ... that the plan's renderer does not hold */
};

/* The cloth's step, which every frame begins with. */
struct stepped {
    bool is_stepped;
    double ms;
};

static void print_cost(double ms)
{
    if (isfinite(ms))
        printf(" %10.2f", ms);
    else
        printf(" %10s", "-");
}

static const char *cloth_reason(const struct stepped *cloth, const struct tl_cloth_report *report)
{
    return cloth->is_stepped          ? "every frame: it moves"
           : report->vertex_count > 0 ? "as it was settled or loaded"
                                      : "no cloth here";
}

static const char *cloth_action(const struct stepped *cloth, const struct tl_cloth_report *report)
{
    return tl_job_action_names[cloth->is_stepped          ? TL_JOB_RUN
                               : report->vertex_count > 0 ? TL_JOB_REUSE
                                                          : TL_JOB_DROP];
}

static void print_plan(const tl_plan *plan, const struct savings *saved, const struct stepped *cloth,
                       const struct tl_cloth_report *report)
{
    printf("%-12s %-6s %5s %10s", "job", "action", "level", "ms");
    printf(saved->are_measured ? " %10s %10s  reason\n" : "  reason\n", "saves ms", "MiB");
    printf("%-12s %-6s %5d", "cloth", cloth_action(cloth, report), 0);
    print_cost(cloth->ms);
    printf("%*s  %s\n", saved->are_measured ? 22 : 0, "", cloth_reason(cloth, report));
    for (int i = 0; i < plan->count; i++) {
        const struct tl_plan_row *row = &plan->rows[i];
        printf("%-12s %-6s %5d", row->name, tl_job_action_names[row->action], row->level);
        print_cost(row->predicted_ms);
        if (saved->ms[i] > 0)
            printf(" %10.2f %10.2f", saved->ms[i], (double)saved->bytes[i] / MEBIBYTE);
        else if (saved->are_measured)
            printf("%22s", "");
        printf("  %s\n", row->reason);
    }
}

static void print_memory(const tl_renderer *renderer)
{
    struct tl_resource_memory rows[TL_RESOURCES_MAX];
    size_t count = tl_renderer_resources(renderer, rows);
    printf("\n%-26s %10s\n", "memory of", "MiB");
    for (size_t i = 0; i < count; i++)
        printf("%-26s %10.2f\n", rows[i].name, (double)rows[i].bytes / MEBIBYTE);
    printf("%-26s %10.2f\n", "total", (double)tl_renderer_memory(renderer).total / MEBIBYTE);
}

/* ---- The budget ---- */

/* The levels that a budget allows for the frame, and what the next better level would change for each
 * control. */
struct budgeted {
    double budget_ms; /* 0: none was given */
    struct tl_quality_choice choice;
    struct tl_quality_step steps[TL_CONTROL_COUNT];
};

static void print_budget(const struct budgeted *budgeted)
{
    const struct tl_quality_choice *choice = &budgeted->choice;
    printf("\nlevels for %g ms: ", budgeted->budget_ms);
    if (isfinite(choice->predicted_ms))
        printf("predicted %.1f ms, cloth and drawing, ", choice->predicted_ms);
    else
        printf("nothing was measured yet: --frame 2 or more, ");
    printf("%.2g %% of error\n%-8s %6s %8s  %s\n", 100 * choice->error, "control", "level", "setting",
           "next better level");
    for (int k = 0; k < TL_CONTROL_COUNT; k++) {
        const struct tl_quality_step *step = &budgeted->steps[k];
        printf("%-8s %2d of %d %8.4g  ", tl_control_names[k], step->level, step->level_count - 1,
               step->value);
        if (isfinite(step->error))
            printf("%+.1f ms, %+.2g of FLIP\n", step->ms, -step->error);
        else
            printf("%s\n", step->level > 0         ? "none alone: too few regions are renewed in a frame"
                           : step->level_count > 1 ? "as asked for"
                                                   : "has no effect in this scene");
    }
}

static void add_budget(cJSON *object, const struct budgeted *budgeted)
{
    cJSON *budget = cJSON_AddObjectToObject(object, "budget");
    cJSON_AddNumberToObject(budget, "budget_ms", budgeted->budget_ms);
    tl_json_add_number(budget, "predicted_ms", budgeted->choice.predicted_ms);
    cJSON_AddNumberToObject(budget, "error", budgeted->choice.error);
    cJSON *controls = cJSON_AddArrayToObject(budget, "controls");
    for (int k = 0; k < TL_CONTROL_COUNT; k++) {
        const struct tl_quality_step *step = &budgeted->steps[k];
        cJSON *control = cJSON_CreateObject();
        cJSON_AddStringToObject(control, "name", tl_control_names[k]);
        cJSON_AddNumberToObject(control, "level", step->level);
        cJSON_AddNumberToObject(control, "levels", step->level_count);
        cJSON_AddNumberToObject(control, "value", step->value);
        tl_json_add_number(control, "next_ms", step->ms);
        tl_json_add_number(control, "next_error", -step->error);
        cJSON_AddItemToArray(controls, control);
    }
}

/* ---- The cloth ---- */

static int substeps_per_frame(const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    return (int)lround(1 / (settings->cloth.frame_rate * report->substep_s));
}

/* Describes whether the cloth may pass through itself, and whether it does. */
static void describe_self_contact(const struct tl_settings *settings, const struct tl_cloth_report *cloth,
                                  char *out, size_t size)
{
    snprintf(out, size, "%s, %zu piece%s, %zu pairs of triangles cross",
             settings->cloth.self_contact ? "cannot pass through itself" : "passes through itself",
             cloth->piece_count, cloth->piece_count == 1 ? "" : "s", cloth->crossing_count);
}

static void print_cloth(const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    char self_contact[256];
    describe_self_contact(settings, report, self_contact, sizeof self_contact);
    printf("cloth: %zu vertices, critical step %.3g ms, %s %d substeps of %.3g ms a frame\n"
           "cloth against itself: %s\n",
           report->vertex_count, 1000 * report->critical_step_s,
           tl_cloth_solver_names[settings->cloth.solver], substeps_per_frame(settings, report),
           1000 * report->substep_s, self_contact);
    if (report->caught_count > 0)
        printf("cloth: %zu vertices caught between parts of the avatar\n", report->caught_count);
}

static void add_cloth(cJSON *object, const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    char self_contact[256];
    describe_self_contact(settings, report, self_contact, sizeof self_contact);
    cJSON *cloth = cJSON_AddObjectToObject(object, "cloth");
    cJSON_AddNumberToObject(cloth, "vertices", (double)report->vertex_count);
    tl_json_add_number(cloth, "critical_step_s", report->critical_step_s);
    cJSON_AddStringToObject(cloth, "solver", tl_cloth_solver_names[settings->cloth.solver]);
    cJSON_AddNumberToObject(cloth, "substeps", substeps_per_frame(settings, report));
    cJSON_AddNumberToObject(cloth, "substep_s", report->substep_s);
    cJSON_AddStringToObject(cloth, "self_contact", self_contact);
    cJSON_AddNumberToObject(cloth, "crossings", (double)report->crossing_count);
    cJSON_AddNumberToObject(cloth, "caught", (double)report->caught_count);
}

/* ---- The report ---- */

static void add_cloth_job(cJSON *jobs, const struct stepped *cloth, const struct tl_cloth_report *report)
{
    cJSON *job = cJSON_CreateObject();
    cJSON_AddStringToObject(job, "name", "cloth");
    cJSON_AddNumberToObject(job, "level", 0);
    cJSON_AddStringToObject(job, "action", cloth_action(cloth, report));
    cJSON_AddStringToObject(job, "reason", cloth_reason(cloth, report));
    cJSON_AddNumberToObject(job, "predicted_ms", cloth->ms);
    cJSON_AddNumberToObject(job, "work_ms", 0);
    cJSON_AddItemToArray(jobs, job);
}

static void add_jobs(cJSON *jobs, const tl_plan *plan, const tl_plan *drawn, const struct savings *saved)
{
    for (int i = 0; i < plan->count; i++) {
        const struct tl_plan_row *row = &plan->rows[i];
        cJSON *job = cJSON_CreateObject();
        cJSON_AddStringToObject(job, "name", row->name);
        cJSON_AddNumberToObject(job, "level", row->level);
        cJSON_AddStringToObject(job, "action", tl_job_action_names[row->action]);
        cJSON_AddStringToObject(job, "reason", row->reason);
        tl_json_add_number(job, "predicted_ms", row->predicted_ms);
        cJSON_AddNumberToObject(job, "work_ms", drawn->rows[i].work_ms);
        if (saved->ms[i] > 0) {
            cJSON_AddNumberToObject(job, "saved_ms", saved->ms[i]);
            cJSON_AddNumberToObject(job, "saved_bytes", (double)saved->bytes[i]);
        }
        cJSON_AddItemToArray(jobs, job);
    }
}

static void add_memory(cJSON *object, const tl_renderer *renderer)
{
    const struct tl_render_memory memory = tl_renderer_memory(renderer);
    cJSON *bytes = cJSON_AddObjectToObject(object, "memory_bytes");
    cJSON_AddNumberToObject(bytes, "pems", (double)memory.pems);
    cJSON_AddNumberToObject(bytes, "maps", (double)memory.maps);
    cJSON_AddNumberToObject(bytes, "rays", (double)memory.rays);
    cJSON_AddNumberToObject(bytes, "sheets", (double)memory.transparency);
    cJSON_AddNumberToObject(bytes, "targets", (double)memory.targets);
    cJSON_AddNumberToObject(bytes, "surfaces", (double)memory.surfaces);
    cJSON_AddNumberToObject(bytes, "other", (double)memory.other);
    cJSON_AddNumberToObject(bytes, "total", (double)memory.total);
    struct tl_resource_memory rows[TL_RESOURCES_MAX];
    size_t count = tl_renderer_resources(renderer, rows);
    cJSON *resources = cJSON_AddObjectToObject(object, "resource_bytes");
    for (size_t i = 0; i < count; i++)
        cJSON_AddNumberToObject(resources, rows[i].name, (double)rows[i].bytes);
}

static void print_clocks(const struct tl_gpu_clocks *clocks)
{
    printf("clock: the CPU's, read after the work is finished; GL's timer measures %.3g ms of %.3g: %s\n",
           clocks->timer_ms, clocks->cpu_ms, clocks->timer_is_trusted ? "it agrees" : "it is not used");
}

static void add_clocks(cJSON *object, const struct tl_gpu_clocks *clocks)
{
    cJSON *clock = cJSON_AddObjectToObject(object, "clock");
    cJSON_AddNumberToObject(clock, "cpu_ms", clocks->cpu_ms);
    cJSON_AddNumberToObject(clock, "timer_ms", clocks->timer_ms);
    cJSON_AddBoolToObject(clock, "timer_is_trusted", clocks->timer_is_trusted);
}

static void add_back_end(cJSON *object, const struct tl_back_end *back_end)
{
    cJSON *visibility = cJSON_AddObjectToObject(object, "visibility");
    cJSON_AddStringToObject(visibility, "reason", back_end->reason);
    tl_json_add_number(visibility, "rays_ms", back_end->rays_ms);
    tl_json_add_number(visibility, "maps_ms", back_end->maps_ms);
}

static void describe_device(const struct tl_headless *headless, char *out, size_t size)
{
    const tl_frame frame = tl_session_frame(headless->session);
    const struct tl_render_settings settings = tl_settings_render(&headless->settings);
    tl_renderer_describe_device(headless->renderer, &frame, &settings, out, size);
    const size_t length = strlen(out);
    if (tl_session_steps_beside(headless->session,
                                tl_renderer_is_on_card(headless->renderer, &frame, &settings)))
        snprintf(out + length, size - length,
                 "; a window steps the cloth beside it, and shows it one frame later");
}

static void print_report(const struct tl_headless *headless, const tl_plan *plan, const struct savings *saved,
                         const struct stepped *cloth_step, const struct budgeted *budgeted,
                         const struct tl_back_end *back_end, const struct tl_gpu_clocks *clocks, bool json)
{
    struct tl_cloth_report report = tl_session_report(headless->session);
    char device[256];
    describe_device(headless, device, sizeof device);
    if (json) {
        cJSON *object = cJSON_CreateObject();
        cJSON *jobs = cJSON_AddArrayToObject(object, "jobs");
        add_cloth_job(jobs, cloth_step, &report);
        add_jobs(jobs, plan, tl_renderer_last_plan(headless->renderer), saved);
        add_memory(object, headless->renderer);
        if (budgeted->budget_ms > 0)
            add_budget(object, budgeted);
        add_back_end(object, back_end);
        cJSON_AddStringToObject(object, "device", device);
        add_clocks(object, clocks);
        if (report.vertex_count > 0)
            add_cloth(object, &headless->settings, &report);
        tl_json_print(object);
        return;
    }
    print_plan(plan, saved, cloth_step, &report);
    print_memory(headless->renderer);
    if (budgeted->budget_ms > 0)
        print_budget(budgeted);
    printf("visibility: %s\ndrawn by: %s\n", back_end->reason, device);
    print_clocks(clocks);
    if (report.vertex_count > 0)
        print_cloth(&headless->settings, &report);
}

/* Simulates and draws a frame as toile fly does: the governor chooses the levels, then learns from the
 * measured times. */
static bool draw_within_budget(struct tl_headless *headless, tl_quality_governor *governor, tl_error *error)
{
    const struct tl_settings full = headless->settings;
    struct tl_stopwatch watch = tl_stopwatch_start();
    const tl_frame frame = tl_session_frame(headless->session);
    struct tl_quality_choice choice = tl_quality_governor_choose(governor, headless->renderer, &frame, &full);
    tl_quality_apply(&choice.levels, &headless->settings);
    struct tl_stopwatch cloth = tl_stopwatch_start();
    bool done = tl_session_advance(headless->session, error);
    double cloth_ms = tl_stopwatch_read(&cloth).wall_ms;
    done = done && tl_headless_draw(headless, error);
    if (done)
        tl_quality_governor_learn(governor, tl_renderer_last_plan(headless->renderer), cloth_ms,
                                  tl_stopwatch_read(&watch).wall_ms);
    headless->settings = full;
    return done;
}

/* Draws the frames before `number` within the budget and chooses the levels of `number`. The session is left
 * at the frame before it. */
static bool choose_levels(struct tl_headless *headless, int number, struct budgeted *out, tl_error *error)
{
    const int learned_from = 30; /* frames */
    tl_quality_governor *governor = tl_quality_governor_create(out->budget_ms);
    int first = number - 1 > learned_from ? number - 1 - learned_from : 0;
    bool done = tl_session_go_to(headless->session, first, error);
    while (done && tl_session_frame_number(headless->session) < number - 1)
        done = draw_within_budget(headless, governor, error);
    if (done) {
        const tl_frame frame = tl_session_frame(headless->session);
        out->choice = tl_quality_governor_choose(governor, headless->renderer, &frame, &headless->settings);
        tl_quality_governor_steps(governor, headless->renderer, &frame, &headless->settings, out->steps);
        tl_quality_apply(&out->choice.levels, &headless->settings);
    }
    tl_quality_governor_destroy(&governor);
    return done;
}

/* Draws the session's frame in full, twice, because the first draw also compiles and allocates, and notes
 * what the jobs took and hold that `plan` leaves out. */
static bool measure_savings(struct tl_headless *headless, const struct tl_settings *full, const tl_plan *plan,
                            struct savings *out, tl_error *error)
{
    struct tl_headless whole = *headless;
    size_t held[TL_JOBS_MAX];
    whole.settings = *full;
    whole.renderer = tl_renderer_create(headless->gpu, error);
    bool done = whole.renderer != NULL;
    for (int i = 0; done && i < 2; i++) {
        tl_renderer_forget(whole.renderer);
        done = tl_headless_draw(&whole, error);
        const tl_plan *drawn = tl_renderer_last_plan(whole.renderer);
        for (int job = 0; done && job < drawn->count; job++)
            if (plan->rows[job].action == TL_JOB_DROP && drawn->rows[job].action == TL_JOB_RUN)
                out->ms[job] = drawn->rows[job].took_ms;
    }
    if (done) {
        tl_renderer_job_bytes(whole.renderer, out->bytes);
        tl_renderer_job_bytes(headless->renderer, held);
        for (int job = 0; job < plan->count; job++)
            out->bytes[job] -= held[job] < out->bytes[job] ? held[job] : out->bytes[job];
    }
    out->are_measured = done;
    tl_renderer_destroy(&whole.renderer);
    return done;
}

/* Steps the cloth to the frame that is planned. */
static bool step_cloth(struct tl_headless *headless, struct stepped *out, tl_error *error)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool done = tl_session_advance(headless->session, error);
    *out = (struct stepped){.is_stepped = true, .ms = tl_stopwatch_read(&watch).wall_ms};
    return done;
}

static bool calibrate(struct tl_headless *headless, const struct tl_arguments *arguments,
                      struct tl_back_end *out, tl_error *error)
{
    if (arguments->calibrate && arguments->budget_ms <= 0)
        return tl_fail(error, TL_USAGE,
                       "--calibrate: whether maps are needed depends on a budget: add --budget MS");
    const tl_frame first = tl_session_frame(headless->session);
    const struct tl_back_end_start start = {.renderer = headless->renderer,
                                            .frame = &first,
                                            .budget_ms = arguments->budget_ms,
                                            .is_software = tl_gpu_is_software(headless->gpu),
                                            .measures_both = arguments->calibrate};
    return tl_back_end_calibrate(&start, &headless->settings, out, error) &&
           tl_session_apply(headless->session, &headless->settings, error);
}

/* The frame that a budget is shown for when none is named: those before it are measured. */
#define BUDGETED_FRAME 6

/* Plans frame N as a part of an animation: draws the frame before it, so that its results can be reused and
 * its costs are known. Frame 0 is the first, for which everything is computed; a budget needs costs. */
bool tl_command_plan(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_headless headless;
    struct budgeted budgeted = {.budget_ms = arguments->budget_ms};
    if (!tl_headless_create(&headless, arguments, error))
        return false;
    struct tl_back_end back_end = {0};
    bool done = calibrate(&headless, arguments, &back_end, error);
    int frame =
        arguments->first_frame == 0 && budgeted.budget_ms > 0 ? BUDGETED_FRAME : arguments->first_frame;
    const struct tl_settings full = headless.settings;
    struct savings saved = {0};
    struct stepped cloth = {0};
    if (done && budgeted.budget_ms > 0)
        done = choose_levels(&headless, frame, &budgeted, error);
    if (done && frame > 0)
        done = tl_session_go_to(headless.session, frame - 1, error) && tl_headless_draw(&headless, error) &&
               step_cloth(&headless, &cloth, error);
    if (done) {
        tl_frame next = tl_session_frame(headless.session);
        const struct tl_render_settings settings = tl_settings_render(&headless.settings);
        tl_plan plan;
        tl_renderer_plan(headless.renderer, &next, &settings, &plan);
        done = tl_headless_draw(&headless, error); /* so that the memory is what the frame really takes */
        if (done && budgeted.budget_ms > 0)
            done = measure_savings(&headless, &full, &plan, &saved, error);
        struct tl_gpu_clocks clocks;
        done = done && tl_gpu_compare_clocks(headless.gpu, &clocks, error);
        if (done)
            print_report(&headless, &plan, &saved, &cloth, &budgeted, &back_end, &clocks, arguments->json);
    }
    tl_headless_release(&headless);
    return done;
}
