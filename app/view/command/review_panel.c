#include "app/view/command/review_panel.h"

#include "app/view/command/review_commands.h"
#include "app/view/review/review_draw.h"
#include "app/view/review/review_edit.h"
#include "app/view/review/review_load.h"
#include "app/view/review/review_memory.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_place.h"
#include "app/view/review/review_read.h"
#include "app/view/review/review_reading.h"
#include "app/view/review/review_wipe.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define MEASURES_MAX 13
#define HELP_MAX     96

static const char *const favourites[] = {
    "scene.garment",       "scene.motion",      "scene.avatar",      "scene.fabric",
    "material.glossiness", "material.diffuse",  "scene.environment", "scene.environment_yaw_deg",
    "scene.preset",        "scene.colourway",   "image.view",        "light.method",
    "light.regions",       "image.exposure_ev", "image.background",
};

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
    *line = (struct tl_panel_line){0};
    snprintf(line->cells[0], sizeof line->cells[0], "%s", label);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line->cells[1], sizeof line->cells[1], format, arguments);
    va_end(arguments);
}

/* Measuring the cloth costs one closest-point query a vertex: while it plays, twice a second is enough. */
static const struct tl_cloth_report *cloth_report(struct tl_review *review)
{
    const double interval_s = 0.5;
    int frame = tl_session_frame_number(review->session);
    double now_s = tl_clock_s();
    if (frame != review->input.reported_frame &&
        (!review->play.is_on || now_s - review->input.reported_s > interval_s)) {
        review->input.report = tl_session_report(review->session);
        review->input.reported_frame = frame;
        review->input.reported_s = now_s;
    }
    return &review->input.report;
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
             review->image.times.frame);
    add_line(lines, &count, "cloth", "%.1f ms%s", review->image.times.cloth,
             review->play.is_beside ? ", and beside drawing: a frame late" : "");
    add_line(lines, &count, "drawing", "%.0f ms", review->image.times.draw);
    int samples_x, samples_y;
    const struct tl_render_settings full = tl_settings_render(&review->good);
    const struct tl_image_params drawn = tl_quality_at(&review->image.choice.levels, &full).image;
    tl_image_samples(&drawn, &samples_x, &samples_y);
    add_line(lines, &count, "image", "%d x %d of %d x %d samples", width, height, samples_x, samples_y);
    count_triangles(review, &triangles, &vertices);
    add_line(lines, &count, "surfaces", "%zu triangles, %zu vertices", triangles, vertices);
    if (tl_session_cloth(review->session)) {
        const struct tl_cloth_report *report = cloth_report(review);
        add_line(lines, &count, "cloth mesh", "%zu vertices, %zu edges", report->vertex_count,
                 report->edge_count);
        add_line(lines, &count, "substep", "%.3g ms; critical %.3g ms", 1000 * report->substep_s,
                 1000 * report->critical_step_s);
        add_line(lines, &count, "strain", "%.1f %% at most", 100 * report->max_strain);
        add_line(lines, &count, "speed", "%.2f m/s at most", report->max_speed);
        add_line(lines, &count, "crossing", "%zu pairs of triangles", report->crossing_count);
    }
    struct tl_render_memory memory = tl_renderer_memory(review->renderer);
    add_line(lines, &count, "GL memory", "%.0f MB: light %.0f, maps %.0f, image %.0f",
             megabytes(memory.total), megabytes(memory.pems), megabytes(memory.maps),
             megabytes(memory.targets));
    add_line(lines, &count, "memory", "%.0f MB", megabytes(tl_review_resident_bytes()));
    if (tl_gpu_message_count(review->screen.gpu) > 0)
        add_line(lines, &count, "GL messages", "%zu, see the log", tl_gpu_message_count(review->screen.gpu));
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

struct question {
    char text[TL_STRING_SIZE];
    struct tl_panel_button answers[TL_REVIEW_ANSWERS_MAX];
    size_t answer_count;
};

/* Fills the question about the use of a dropped file, when one is open. */
static void set_question(const struct tl_review *review, struct question *question,
                         struct tl_panel_input *input)
{
    const struct tl_review_answer *answers = tl_review_answers(review, &question->answer_count);
    if (!answers)
        return;
    for (size_t i = 0; i < question->answer_count; i++)
        question->answers[i] = (struct tl_panel_button){answers[i].label, answers[i].help};
    const char *slash = review->edit.dropped ? strrchr(review->edit.dropped, '/') : NULL;
    if (review->edit.offered > 0)
        snprintf(question->text, sizeof question->text, "Open again (Esc: none)");
    else
        snprintf(question->text, sizeof question->text, "%s: use it as",
                 slash ? slash + 1 : review->edit.dropped);
    input->answers_below = review->edit.offered > 0;
    input->question = question->text;
    input->answers = question->answers;
    input->answer_count = question->answer_count;
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

static bool is_worn(const struct tl_review *review)
{
    return strcmp(tl_settings_avatar(&tl_session_settings(review->session)->scene), "none") != 0;
}

/* Prints the garment's state; motion without input, and the key that ends it. */
static void describe_status(const struct tl_review *review, char *status, size_t size)
{
    const struct tl_review_path *path = &review->path;
    enum tl_garment_state state = tl_session_garment_state(review->session);
    char words[96];
    const char *stop = status + size;
    char *end = status;
    *end = '\0';
    tl_session_describe_state(review->session, words, sizeof words);
    bool undraped = state == TL_GARMENT_AUTHORED || state == TL_GARMENT_SEWN;
    bool drapes = review->load.loader &&
                  (review->load.drapes_again || (undraped && review->wanted.scene.drape == TL_DRAPE_SETTLE));
    if (drapes)
        end = append(end, stop, "draping  ");
    else if (state != TL_GARMENT_IS_NOT_CLOTH)
        end = append(end, stop, "%s%s  ", words,
                     !undraped         ? ""
                     : is_worn(review) ? " (D drapes it)"
                                       : " on nobody (drop a body, D drapes it)");
    if (review->play.is_on && review->play.speed < 0.95)
        end =
            append(end, stop, "plays at %.1f x: this machine is slower than the cloth  ", review->play.speed);
    if (path->records)
        end = append(end, stop, "recording: %.1f s (Shift+K ends)  ", tl_clock_s() - path->began_s);
    if (path->plays)
        end = append(end, stop, "path: %.1f of %.1f s (L ends)  ", tl_clock_s() - path->began_s,
                     tl_path_length_s(&path->path));
    if (review->motion.turntable)
        end = append(end, stop, "turntable (T ends)  ");
    if (review->motion.environment)
        end = append(end, stop, "environment turns (Shift+T ends)  ");
    if (tl_panel_wants_keys(review->screen.panel))
        append(end, stop, "keys go to the panel (Esc ends)");
}

/* The window's own options, listed among the scene's, change no image: `before` and `wanted` are then equal.
 */
static void apply_result(struct tl_review *review, const struct tl_panel_result *result,
                         const struct tl_settings *before, const struct tl_review_buttons *buttons)
{
    review->input.editing = result->editing;
    if (result->behind && review->due.redraws == 0)
        review->due.redraws = 1;
    review->input.listed = result->listed;
    if (review->input.panel_has_keys != tl_panel_wants_keys(review->screen.panel))
        tl_debug("view: keys go to the %s", review->input.panel_has_keys ? "view" : "panel");
    review->input.panel_has_keys = tl_panel_wants_keys(review->screen.panel);
    if (result->note.error.code != TL_OK)
        tl_review_report_error(review, &result->note.error);
    else if (result->note.remark[0])
        tl_review_report(review, "%s", result->note.remark);
    if (result->changed && !tl_settings_equal(before, &review->wanted)) {
        tl_review_apply_names(review);
        tl_review_add_environment(review, review->wanted.scene.environment);
        tl_review_note_motion(review);
        tl_review_mark_changed(review);
    }
    if (result->frame >= 0)
        tl_review_go_to_frame(review, result->frame);
    if (result->choice >= 0)
        tl_review_choose_reading(review, (size_t)result->choice);
    if (result->answer >= 0)
        tl_review_answer(review, (size_t)result->answer);
    else if (result->button >= 0)
        buttons->commands[result->button]->act(review, buttons->commands[result->button]->keys[0].argument);
}

/* Percent of the settings' samples that are drawn at the present levels. */
static double share_of_samples(const struct tl_review *review)
{
    const struct tl_render_settings full = tl_settings_render(&review->good);
    const struct tl_image_params drawn = tl_quality_at(&review->image.choice.levels, &full).image;
    int full_x, full_y, x, y;
    tl_image_samples(&full.image, &full_x, &full_y);
    tl_image_samples(&drawn, &x, &y);
    return 100.0 * x * y / ((double)full_x * full_y);
}

static struct tl_panel_strip strip_of(const struct tl_review *review, float *times, char *label, size_t size)
{
    const struct tl_frame_times *all = &review->image.frame_times;
    float budget_ms = review->screen.params.budget_ms;
    for (size_t i = 0; i < all->count; i++)
        times[i] = tl_frame_times_at(all, i);
    const struct tl_quality *levels = &review->image.choice.levels;
    char *end = label;
    const char *stop = label + size;
    bool has_frames = all->count > 0;
    if (has_frames)
        end = append(end, stop, "%.0f ms", review->image.times.frame);
    if (budget_ms > 0)
        end = append(end, stop, "%s%.0f ms", has_frames ? " of " : "budget ", (double)budget_ms);
    else
        end = append(end, stop, "%sno budget", has_frames ? ", " : "");
    if (tl_review_is_sharp(review)) { /* ratios at vertices are all that an image at rest may save */
        append(end, stop, levels->of[TL_CONTROL_RATIO] > 0 ? ": sharp" : ": full quality");
        return (struct tl_panel_strip){times, all->count, budget_ms, label};
    }
    const char *before = ": ";
    for (int i = 0; i < TL_CONTROL_COUNT; i++)
        if (levels->of[i] > 0 && i != TL_CONTROL_SCALE) {
            end = append(end, stop, "%s%s -%d", before, tl_control_names[i], levels->of[i]);
            before = ", ";
        }
    if (levels->of[TL_CONTROL_SCALE] > 0)
        append(end, stop, "%s%.0f %% of the pixels", before, share_of_samples(review));
    return (struct tl_panel_strip){times, all->count, budget_ms, label};
}

static struct tl_panel_timeline timeline_of(const struct tl_review *review, char *label, size_t size)
{
    double rate = review->good.cloth.frame_rate;
    int frame = tl_session_frame_number(review->session), last = tl_session_last_frame(review->session);
    snprintf(label, size, "%d: %.2f of %.2f s", frame, frame / rate, last / rate);
    return (struct tl_panel_timeline){frame, last, label};
}

void tl_review_build_panel(struct tl_review *review)
{
    struct tl_review_buttons buttons;
    struct tl_panel_line measures[MEASURES_MAX], plan[TL_JOBS_MAX], help[HELP_MAX];
    const struct tl_panel_lines groups[] = {
        {.title = "Measures",
         .lines = measures,
         .count = list_measures(review, measures),
         .columns = 2,
         .open = true},
        {.title = "Plan",
         .help = "jobs of the last image: job, action, predicted time, reason",
         .lines = plan,
         .count = list_plan(review, plan),
         .columns = 4},
    };
    struct tl_binding bindings[TL_SETTINGS_TABLES + 1];
    tl_settings_bind(&review->wanted, bindings);
    bindings[TL_SETTINGS_TABLES] = (struct tl_binding){&tl_window_options, &review->screen.params};
    int width, height;
    tl_review_size(review, &width, &height);
    struct question question;
    char status[256], progress[256], left[256] = "", right[256] = "", label[256], moment[64];
    float times[TL_FRAME_TIMES_SHOWN];
    char read_out[512], amount[96];
    float marks[TL_REVIEW_MARKS][2];
    struct tl_panel_legend legend;
    struct tl_panel_choice choices[TL_REVIEW_CHOICES];
    tl_review_list_buttons(review, &buttons);
    struct tl_gizmo_shapes shapes;
    tl_review_place_shapes(review, &shapes);
    tl_review_place_amount(review, amount, sizeof amount);
    tl_review_read_out(review, read_out, sizeof read_out);
    if (review->wipe.renderer)
        tl_review_wipe_labels(review, left, right, sizeof left);
    describe_status(review, status, sizeof status);
    struct tl_panel_input input = {
        .title = review->image.title,
        .message = review->screen.message.text,
        .message_is_error = review->screen.message.is_error,
        .status = status,
        .notice = review->reading.notice,
        .choices = choices,
        .choice_count = tl_review_reading_choices(review, choices),
        .strip = strip_of(review, times, label, sizeof label),
        .timeline = timeline_of(review, moment, sizeof moment),
        .wipe = {tl_review_wipe_column(review, width), left, right},
        .legend = tl_review_legend(review, &legend) ? &legend : NULL,
        .read_out = read_out,
        .amount = amount,
        .marks = (const float(*)[2])marks,
        .mark_count = tl_review_marks(review, marks),
        .shapes = shapes.of,
        .shape_count = shapes.count,
        .progress = tl_review_progress(review, progress, sizeof progress),
        .buttons = buttons.of,
        .button_count = buttons.count,
        .favourites = favourites,
        .favourite_count = TL_COUNT(favourites),
        .measures = groups,
        .measure_count = TL_COUNT(groups),
        .bindings = bindings,
        .binding_count = TL_COUNT(bindings),
        .help = help,
        .help_count = review->input.help_shown ? tl_review_help(help, HELP_MAX) : 0,
        .x = width,
        .width = tl_review_panel_width(review),
        .height = height,
    };
    input.list.row = review->input.listed;
    input.list.images = tl_thumbnails_images(review->screen.thumbnails, &input.list.count);
    if (!input.list.images)
        input.list.row = NULL;
    set_question(review, &question, &input);
    struct tl_settings before = review->wanted;
    bool had_panel = review->screen.params.panel;
    struct tl_panel_result result = tl_panel_build(review->screen.panel, &input);
    apply_result(review, &result, &before, &buttons);
    if (review->screen.params.panel != had_panel)
        tl_review_mark_changed(review); /* the view has another size */
}
