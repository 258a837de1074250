/* toile plan: what would run for a frame, and why. */
#include "app/commands.h"
#include "app/json.h"
#include "app/stage.h"

#include <math.h>
#include <stdio.h>

static void print_plan(const tl_plan *plan, const struct tl_render_memory *memory)
{
    printf("%-12s %-6s %5s %10s  %s\n", "job", "action", "level", "ms", "reason");
    for (int i = 0; i < plan->count; i++) {
        const struct tl_plan_row *row = &plan->rows[i];
        char cost[16] = "-";
        if (isfinite(row->predicted_ms))
            snprintf(cost, sizeof cost, "%.2f", row->predicted_ms);
        printf("%-12s %-6s %5d %10s  %s\n", row->name, tl_job_action_names[row->action], row->level, cost,
               row->reason);
    }
    const double mebibyte = 1024.0 * 1024.0;
    printf("\nmemory (MiB): PEMs %.2f, maps %.2f, sheets %.2f, targets %.2f, surfaces %.2f, other %.2f, "
           "total %.2f\n",
           (double)memory->pems / mebibyte, (double)memory->maps / mebibyte,
           (double)memory->sheets / mebibyte, (double)memory->targets / mebibyte,
           (double)memory->surfaces / mebibyte, (double)memory->other / mebibyte,
           (double)memory->total / mebibyte);
}

/* ---- The cloth ---- */

static int substeps_per_frame(const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    return (int)lround(1 / (settings->cloth.frame_rate * report->substep_s));
}

/* What the cloth is kept from passing through, and at what cost. */
static void describe_self_repulsion(const struct tl_settings *settings, const struct tl_cloth_report *cloth,
                                    char *out, size_t size)
{
    const char *price = "up to twice the time for the cloth";
    if (settings->cloth.self_repulsion)
        snprintf(out, size, "on: %zu piece%s in %zu layer%s, and folds, keep their distance: %s",
                 cloth->piece_count, cloth->piece_count == 1 ? "" : "s", cloth->layer_count,
                 cloth->layer_count == 1 ? "" : "s", price);
    else if (cloth->piece_count > 1)
        snprintf(out, size,
                 "off: the garment's %zu pieces, and folds, pass through one another; "
                 "cloth.self_repulsion true keeps them apart for %s",
                 cloth->piece_count, price);
    else
        snprintf(out, size, "off: folds pass through one another");
}

static void print_cloth(const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    char self_repulsion[256];
    describe_self_repulsion(settings, report, self_repulsion, sizeof self_repulsion);
    printf("cloth: %zu vertices, critical step %.3g ms, %s %d substeps of %.3g ms a frame\n"
           "cloth against itself: %s\n",
           report->vertex_count, 1000 * report->critical_step_s,
           tl_cloth_solver_names[settings->cloth.solver], substeps_per_frame(settings, report),
           1000 * report->substep_s, self_repulsion);
    if (report->caught_count + report->unconverged_steps + report->shortened_steps > 0)
        printf("cloth's doubts: %zu vertices caught between parts of the avatar, %zu steps cut short before "
               "they "
               "converged, %zu shortened because they would have gained energy\n",
               report->caught_count, report->unconverged_steps, report->shortened_steps);
}

static void add_cloth(cJSON *object, const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    char self_repulsion[256];
    describe_self_repulsion(settings, report, self_repulsion, sizeof self_repulsion);
    cJSON *cloth = cJSON_AddObjectToObject(object, "cloth");
    cJSON_AddNumberToObject(cloth, "vertices", (double)report->vertex_count);
    cJSON_AddItemToObject(cloth, "critical_step_s",
                          isfinite(report->critical_step_s) ? cJSON_CreateNumber(report->critical_step_s)
                                                            : cJSON_CreateNull());
    cJSON_AddStringToObject(cloth, "solver", tl_cloth_solver_names[settings->cloth.solver]);
    cJSON_AddNumberToObject(cloth, "substeps", substeps_per_frame(settings, report));
    cJSON_AddNumberToObject(cloth, "substep_s", report->substep_s);
    cJSON_AddStringToObject(cloth, "self_repulsion", self_repulsion);
    cJSON_AddNumberToObject(cloth, "caught", (double)report->caught_count);
    cJSON_AddNumberToObject(cloth, "unconverged_steps", (double)report->unconverged_steps);
    cJSON_AddNumberToObject(cloth, "shortened_steps", (double)report->shortened_steps);
}

/* ---- The whole ---- */

static void print_plan_json(const tl_plan *plan, const struct tl_render_memory *memory,
                            const struct tl_settings *settings, const struct tl_cloth_report *report)
{
    cJSON *object = cJSON_CreateObject();
    cJSON *jobs = cJSON_AddArrayToObject(object, "jobs");
    for (int i = 0; i < plan->count; i++) {
        const struct tl_plan_row *row = &plan->rows[i];
        cJSON *job = cJSON_CreateObject();
        cJSON_AddStringToObject(job, "name", row->name);
        cJSON_AddNumberToObject(job, "level", row->level);
        cJSON_AddStringToObject(job, "action", tl_job_action_names[row->action]);
        cJSON_AddStringToObject(job, "reason", row->reason);
        cJSON_AddItemToObject(job, "predicted_ms",
                              isfinite(row->predicted_ms) ? cJSON_CreateNumber(row->predicted_ms)
                                                          : cJSON_CreateNull());
        cJSON_AddItemToArray(jobs, job);
    }
    cJSON *bytes = cJSON_AddObjectToObject(object, "memory_bytes");
    cJSON_AddNumberToObject(bytes, "pems", (double)memory->pems);
    cJSON_AddNumberToObject(bytes, "maps", (double)memory->maps);
    cJSON_AddNumberToObject(bytes, "sheets", (double)memory->sheets);
    cJSON_AddNumberToObject(bytes, "targets", (double)memory->targets);
    cJSON_AddNumberToObject(bytes, "surfaces", (double)memory->surfaces);
    cJSON_AddNumberToObject(bytes, "other", (double)memory->other);
    cJSON_AddNumberToObject(bytes, "total", (double)memory->total);
    if (report->vertex_count > 0)
        add_cloth(object, settings, report);
    tl_json_print(object);
}

/* The plan of frame N is that of an animation at N: the frame before it is drawn, so that what it leaves
 * behind is reused and costs are known. Frame 0 is the first frame, where all is new. */
bool tl_command_plan(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_stage stage;
    if (!tl_stage_create(&stage, arguments, error))
        return false;
    bool done = true;
    int frame = arguments->first_frame;
    if (frame > 0)
        done = tl_session_go_to(stage.session, frame - 1, error) && tl_stage_draw(&stage, error) &&
               tl_session_advance(stage.session, error);
    if (done) {
        tl_frame next = tl_session_frame(stage.session);
        const struct tl_render_settings settings = tl_settings_render(&stage.settings);
        tl_plan plan;
        tl_renderer_plan(stage.renderer, &next, &settings, &plan);
        done = tl_stage_draw(&stage, error); /* memory is what the frame really holds */
        struct tl_render_memory memory = tl_renderer_memory(stage.renderer);
        struct tl_cloth_report report = tl_session_report(stage.session);
        if (done && arguments->json)
            print_plan_json(&plan, &memory, &stage.settings, &report);
        else if (done)
            print_plan(&plan, &memory);
        if (done && !arguments->json && report.vertex_count > 0)
            print_cloth(&stage.settings, &report);
    }
    tl_stage_release(&stage);
    return done;
}
