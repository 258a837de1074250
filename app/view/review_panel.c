/* What the panel of the review window shows: options, measures, the plan. */
#include "app/view/review.h"
#include "config/log.h"
#include "config/memory.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define MEASURES_MAX 12
#define HELP_MAX     64

static const char *const favourites[] = {
    "scene.garment",
    "scene.motion",
    "scene.avatar",
    "scene.fabric",
    "material.glossiness",
    "scene.environment",
    "scene.environment_yaw_deg",
    "scene.preset",
    "scene.colourway",
    "image.view",
    "light.method",
    "light.regions",
    "image.exposure_ev",
    "image.background",
};

static const struct tl_panel_button model_answers[] = {
    {"Garment", "worn by the avatar", TL_REVIEW_USE_GARMENT},
    {"Avatar", "wears the garment", TL_REVIEW_USE_AVATAR},
    {"Cancel", "", TL_REVIEW_USE_NOTHING},
};

static const struct tl_panel_button text_answers[] = {
    {"Scene", "replaces all options", TL_REVIEW_USE_SCENE},
    {"Fabric", "replaces fabric, weave and material", TL_REVIEW_USE_FABRIC},
    {"Preset", "replaces the quality of light, image and cloth", TL_REVIEW_USE_PRESET},
    {"Cancel", "", TL_REVIEW_USE_NOTHING},
};

int tl_review_panel_width(const struct tl_review *review)
{
    const float wished = 380;
    int width, height;
    tl_window_size(review->window, &width, &height);
    int panel = (int)(wished * tl_window_scale(review->window));
    return !review->params.panel ? 0 : panel < width / 2 ? panel : width / 2;
}

static double megabytes(size_t bytes)
{
    return (double)bytes / (1 << 20);
}

static void add_line(struct tl_panel_line *lines, size_t *count, const char *label, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void add_line(struct tl_panel_line *lines, size_t *count, const char *label, const char *format, ...)
{
    if (*count == MEASURES_MAX)
        return;
    struct tl_panel_line *line = &lines[(*count)++];
    snprintf(line->cells[0], sizeof line->cells[0], "%s", label);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line->cells[1], sizeof line->cells[1], format, arguments);
    va_end(arguments);
}

/* Measuring the cloth costs a query a vertex: not for every frame. */
static const struct tl_cloth_report *cloth_report(struct tl_review *review)
{
    const double patience_s = 0.5;
    int frame = tl_session_frame_number(review->session);
    double now_s = tl_clock_s();
    if (frame != review->reported_frame && (!review->playing || now_s - review->reported_s > patience_s)) {
        review->report = tl_session_report(review->session);
        review->reported_frame = frame;
        review->reported_s = now_s;
    }
    return &review->report;
}

static void count_triangles(struct tl_review *review, size_t *triangles, size_t *vertices)
{
    tl_frame frame = tl_session_frame(review->session);
    *triangles = *vertices = 0;
    for (size_t i = 0; i < frame.surface_count; i++) {
        *triangles += frame.surfaces[i].index_count / 3;
        *vertices += frame.surfaces[i].vertex_count;
    }
}

static size_t list_measures(struct tl_review *review, struct tl_panel_line *lines)
{
    size_t count = 0, triangles, vertices;
    int width, height;
    tl_review_size(review, &width, &height);
    add_line(lines, &count, "frame", "%d, %.0f ms", tl_session_frame_number(review->session),
             review->times.frame);
    add_line(lines, &count, "cloth", "%.1f ms", review->times.cloth);
    add_line(lines, &count, "drawing", "%.0f ms", review->times.draw);
    int samples_x, samples_y;
    const struct tl_settings drawn = tl_levels_apply(&review->pace_choice.levels, &review->good);
    tl_image_samples(&drawn.image, &samples_x, &samples_y);
    add_line(lines, &count, "image", "%d x %d of %d x %d samples", width, height, samples_x, samples_y);
    count_triangles(review, &triangles, &vertices);
    add_line(lines, &count, "surfaces", "%zu triangles, %zu vertices", triangles, vertices);
    if (tl_session_cloth(review->session)) {
        const struct tl_cloth_report *report = cloth_report(review);
        add_line(lines, &count, "sheet", "%zu vertices, %zu edges", report->vertex_count, report->edge_count);
        add_line(lines, &count, "substep", "%.3g ms; critical %.3g ms", 1000 * report->substep_s,
                 1000 * report->critical_step_s);
        add_line(lines, &count, "strain", "%.1f %% at most", 100 * report->max_strain);
        add_line(lines, &count, "speed", "%.2f m/s at most", report->max_speed);
    }
    struct tl_render_memory memory = tl_renderer_memory(review->renderer);
    add_line(lines, &count, "GL memory", "%.0f MB: light %.0f, maps %.0f, image %.0f",
             megabytes(memory.total), megabytes(memory.pems), megabytes(memory.maps),
             megabytes(memory.targets));
    add_line(lines, &count, "memory", "%.0f MB", megabytes(tl_review_resident_bytes()));
    if (tl_gpu_message_count(review->gpu) > 0)
        add_line(lines, &count, "GL messages", "%zu, see the log", tl_gpu_message_count(review->gpu));
    return count;
}

static size_t list_plan(struct tl_review *review, struct tl_panel_line *lines)
{
    const tl_plan *plan = tl_renderer_last_plan(review->renderer);
    for (int i = 0; i < plan->count; i++) {
        const struct tl_plan_row *row = &plan->rows[i];
        snprintf(lines[i].cells[0], sizeof lines[i].cells[0], "%s", row->name);
        snprintf(lines[i].cells[1], sizeof lines[i].cells[1], "%s", tl_job_action_names[row->action]);
        if (row->action == TL_JOB_RUN && isfinite(row->predicted_ms))
            snprintf(lines[i].cells[2], sizeof lines[i].cells[2], "%.1f ms", row->predicted_ms);
        else
            lines[i].cells[2][0] = '\0';
        snprintf(lines[i].cells[3], sizeof lines[i].cells[3], "%s", row->reason);
    }
    return (size_t)plan->count;
}

const struct tl_panel_button *tl_review_answers(const struct tl_review *review, size_t *count)
{
    if (!review->dropped)
        return NULL;
    bool is_model = tl_model_is_file(review->dropped);
    *count = is_model ? TL_COUNT(model_answers) : TL_COUNT(text_answers);
    return is_model ? model_answers : text_answers;
}

static void ask_about_dropped(const struct tl_review *review, char *question, size_t size,
                              struct tl_panel_input *input)
{
    input->answers = tl_review_answers(review, &input->answer_count);
    if (!input->answers)
        return;
    const char *slash = strrchr(review->dropped, '/');
    snprintf(question, size, "%s: use it as", slash ? slash + 1 : review->dropped);
    input->question = question;
}

static char *append(char *end, const char *stop, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static char *append(char *end, const char *stop, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(end, (size_t)(stop - end), format, arguments);
    va_end(arguments);
    return length < stop - end ? end + length : end;
}

/* What goes on by itself, and how it is ended. */
static void describe_status(const struct tl_review *review, char *status, size_t size)
{
    const struct tl_review_path *path = &review->path;
    const char *stop = status + size;
    char *end = status;
    *end = '\0';
    if (path->records)
        end = append(end, stop, "recording: %.1f s (Shift+K ends)  ", tl_clock_s() - path->began_s);
    if (path->plays)
        end = append(end, stop, "path: %.1f of %.1f s (L ends)  ", tl_clock_s() - path->began_s,
                     tl_path_length_s(&path->path));
    if (review->motion.turntable)
        end = append(end, stop, "turntable (T ends)  ");
    if (review->motion.environment)
        end = append(end, stop, "environment turns (Shift+T ends)  ");
    if (tl_panel_wants_keys(review->panel))
        append(end, stop, "keys go to the panel (Esc ends)");
}

static struct tl_panel_progress progress_of(const struct tl_review *review, char *text, size_t size)
{
    if (!review->loader || tl_loader_is_stopped(review->loader))
        return (struct tl_panel_progress){0};
    const struct tl_scene_params *scene = &tl_loader_settings(review->loader)->scene;
    enum tl_load kind = tl_loader_kind(review->loader);
    const char *name = kind == TL_LOAD_LIGHT                 ? scene->environment
                       : kind == TL_LOAD_LOOK                ? scene->fabric
                       : strcmp(scene->garment, "none") == 0 ? scene->avatar
                                                             : scene->garment;
    const char *slash = strrchr(name, '/');
    struct tl_load_progress progress = tl_loader_progress(review->loader);
    const double unseen_s = 0.3; /* most looks are there sooner: nothing flickers */
    if (kind == TL_LOAD_LOOK && progress.seconds < unseen_s)
        return (struct tl_panel_progress){0};
    bool is_known = progress.what[0] != '\0';
    snprintf(text, size, "Loading %.100s%s%s", slash ? slash + 1 : name, is_known ? ": " : "", progress.what);
    return (struct tl_panel_progress){.what = text,
                                      .share = is_known ? (float)progress.share : -1,
                                      .hint = review->session ? "Esc stops it" : "Esc leaves"};
}

void tl_review_build_progress(struct tl_review *review)
{
    char text[256];
    int width, height;
    tl_window_size(review->window, &width, &height);
    const struct tl_panel_input input = {
        .message = "", .status = "", .progress = progress_of(review, text, sizeof text), .height = height};
    const float surround = 0.13f; /* the panel's grey */
    glViewport(0, 0, width, height);
    glClearColor(surround, surround, surround, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    tl_panel_build(review->panel, &input);
    tl_panel_draw(review->panel);
    tl_window_show(review->window);
}

/* The window's own options, which stand among the scene's, change no picture. */
static void take_result(struct tl_review *review, const struct tl_panel_result *result,
                        const struct tl_settings *before)
{
    review->editing = result->editing;
    if (result->changed && !tl_settings_equal(before, &review->wanted)) {
        tl_review_layer(review);
        tl_review_know_environment(review, review->wanted.scene.environment);
        tl_review_touch(review);
        review->changed = true;
    }
    if (result->command >= 0)
        tl_review_act(review, result->command);
}

/* Percent, of those that the settings ask for. */
static double share_of_samples(const struct tl_review *review)
{
    const struct tl_settings drawn = tl_levels_apply(&review->pace_choice.levels, &review->good);
    int full_x, full_y, x, y;
    tl_image_samples(&review->good.image, &full_x, &full_y);
    tl_image_samples(&drawn.image, &x, &y);
    return 100.0 * x * y / ((double)full_x * full_y);
}

static struct tl_panel_strip strip_of(const struct tl_review *review, float *times, char *label, size_t size)
{
    const struct tl_frame_times *all = &review->frame_times;
    float budget_ms = review->params.budget_ms;
    for (size_t i = 0; i < all->count; i++)
        times[i] = tl_frame_times_at(all, i);
    const struct tl_levels *levels = &review->pace_choice.levels;
    char *end = label;
    const char *stop = label + size;
    bool has_frames = all->count > 0;
    if (has_frames)
        end = append(end, stop, "%.0f ms", review->times.frame);
    if (budget_ms > 0)
        end = append(end, stop, "%s%.0f ms", has_frames ? " of " : "budget ", (double)budget_ms);
    else
        end = append(end, stop, "%sno budget", has_frames ? ", " : "");
    if (tl_review_is_sharp(review))
        end = append(end, stop, ": full quality");
    const char *before = ": ";
    for (int i = 0; i < TL_KNOB_COUNT; i++)
        if (levels->of[i] > 0 && i != TL_KNOB_SCALE) {
            end = append(end, stop, "%s%s -%d", before, tl_knob_names[i], levels->of[i]);
            before = ", ";
        }
    if (levels->of[TL_KNOB_SCALE] > 0)
        append(end, stop, "%s%.0f %% of the pixels", before, share_of_samples(review));
    return (struct tl_panel_strip){times, all->count, budget_ms, label};
}

void tl_review_build_panel(struct tl_review *review)
{
    const struct tl_panel_button buttons[] = {
        {review->playing ? "Pause" : "Play", "Space", TL_REVIEW_PLAY},
        {"Step", "one frame on: .", TL_REVIEW_STEP},
        {"Reset", "back to the settled start: R", TL_REVIEW_RESET},
        {"Frame", "frame the whole figure: F", TL_REVIEW_FRAME_ALL},
        {"Next light", "next environment: E", TL_REVIEW_NEXT_ENVIRONMENT},
        {"Colours", "next colourway: C", TL_REVIEW_NEXT_COLOURWAY},
        {"Inspect", "normals, UVs, visibility, strain: V; B: light again", TL_REVIEW_NEXT_VIEW},
        {"Compare", "splits the view: the look of now beside the next one: W", TL_REVIEW_COMPARE},
        {"Turn", "turntable: T", TL_REVIEW_TURNTABLE},
        {"Undo", "the last edit: Ctrl+Z", TL_REVIEW_UNDO},
        {"Picture", "screenshot: S, or Shift+S for a linear EXR", TL_REVIEW_SCREENSHOT},
        {"Keys", "keys and gestures: H", TL_REVIEW_HELP},
    };
    struct tl_panel_line measures[MEASURES_MAX], plan[TL_JOBS_MAX], help[HELP_MAX];
    const struct tl_panel_lines groups[] = {
        {.title = "Measures",
         .lines = measures,
         .count = list_measures(review, measures),
         .columns = 2,
         .open = true},
        {.title = "Plan",
         .help = "what the last image needed: job, action, usual time, reason",
         .lines = plan,
         .count = list_plan(review, plan),
         .columns = 4},
    };
    struct tl_binding bindings[TL_SETTINGS_TABLES + 1];
    tl_settings_bind(&review->wanted, bindings);
    bindings[TL_SETTINGS_TABLES] = (struct tl_binding){&tl_window_options, &review->params};
    int width, height;
    tl_review_size(review, &width, &height);
    char question[TL_STRING_SIZE], status[256], progress[256], left[256] = "", right[256] = "", label[256];
    float times[TL_FRAME_TIMES_SHOWN];
    char read_out[512];
    struct tl_panel_legend legend;
    tl_review_read_out(review, read_out, sizeof read_out);
    if (review->wipe.renderer)
        tl_review_wipe_labels(review, left, right, sizeof left);
    describe_status(review, status, sizeof status);
    struct tl_panel_input input = {
        .title = review->title,
        .message = review->message,
        .message_is_error = review->message_is_error,
        .status = status,
        .strip = strip_of(review, times, label, sizeof label),
        .wipe = {tl_review_wipe_column(review, width), left, right},
        .legend = tl_review_legend(review, &legend) ? &legend : NULL,
        .read_out = read_out,
        .progress = progress_of(review, progress, sizeof progress),
        .buttons = buttons,
        .button_count = TL_COUNT(buttons),
        .favourites = favourites,
        .favourite_count = TL_COUNT(favourites),
        .measures = groups,
        .measure_count = TL_COUNT(groups),
        .bindings = bindings,
        .binding_count = TL_COUNT(bindings),
        .help = help,
        .help_count = review->help_shown ? tl_review_help(help, HELP_MAX) : 0,
        .x = width,
        .width = tl_review_panel_width(review),
        .height = height,
    };
    ask_about_dropped(review, question, sizeof question, &input);
    struct tl_settings before = review->wanted;
    bool had_panel = review->params.panel;
    struct tl_panel_result result = tl_panel_build(review->panel, &input);
    take_result(review, &result, &before);
    review->changed |= review->params.panel != had_panel; /* the picture's size */
}
