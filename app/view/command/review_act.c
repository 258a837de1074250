#include "app/view/command/review_act.h"

#include "app/scene/orbit.h"
#include "app/view/review/review.h"
#include "app/view/review/review_draw.h"
#include "app/view/review/review_edit.h"
#include "app/view/review/review_hand.h"
#include "app/view/review/review_keep.h"
#include "app/view/review/review_load.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_place.h"
#include "app/view/review/review_reading.h"
#include "app/view/review/review_wipe.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <stdlib.h>
#include <string.h>

#define ENVIRONMENT_STEP_DEG 15.0f
#define CAMERA_STEP_DEG      5.0f
#define WIPE_STEP            0.05f

void tl_act_play(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_set_playing(review, !review->play.is_on);
}

void tl_act_step(struct tl_review *review, int argument)
{
    int frame = tl_session_frame_number(review->session) + argument;
    if (argument < 0 && tl_session_cloth(review->session))
        tl_review_report(review, "cloth is simulated forwards only: R goes back to the start");
    else if (frame >= 0)
        tl_review_go_to_frame(review, frame);
}

void tl_act_end(struct tl_review *review, int argument)
{
    int last = tl_session_last_frame(review->session);
    if (argument < 0)
        tl_review_go_to_frame(review, 0);
    else if (last > 0)
        tl_review_go_to_frame(review, last);
    else
        tl_review_report(review, "no recording is playing");
}

void tl_act_reset(struct tl_review *review, int argument)
{
    (void)argument;
    tl_error error;
    if (!tl_session_reset(review->session, &error))
        tl_review_report_error(review, &error);
    tl_review_mark_old(review);
    tl_info("view: reset");
}

void tl_act_drape(struct tl_review *review, int argument)
{
    const struct tl_settings *shown = tl_session_settings(review->session);
    if (!tl_session_cloth(review->session))
        tl_review_report(review, "there is no cloth to drape");
    else if (tl_session_is_undraped(review->session))
        tl_review_set(review, "scene.drape", "settle");
    else
        tl_act_reset(review, argument);
    if (strcmp(tl_settings_avatar(&shown->scene), "none") == 0 && tl_session_is_undraped(review->session))
        tl_review_report(review, "draping without an avatar: nothing holds the garment up");
}

void tl_act_pin(struct tl_review *review, int argument)
{
    (void)argument;
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (!cloth) {
        tl_review_report(review, "the garment is not simulated: there is nothing to pin");
    } else if (review->input.drag == TL_DRAG_CLOTH) {
        tl_review_hand_release(review);
        tl_cloth_pin(cloth, review->hand.vertex);
        tl_review_report(review, "pinned; P takes the pins out again");
    } else {
        size_t count = tl_cloth_unpin(cloth);
        if (count > 0)
            tl_review_report(review, "%zu %s taken out", count, count == 1 ? "pin" : "pins");
        else
            tl_review_report(review, "no pins: pull on the cloth with Ctrl + drag and press P to set one");
    }
}

void tl_act_turn_environment(struct tl_review *review, int argument)
{
    float *yaw_deg = &review->wanted.scene.environment_yaw_deg;
    *yaw_deg = tl_orbit_wrap_deg(*yaw_deg + (float)argument * ENVIRONMENT_STEP_DEG);
    tl_review_mark_changed(review);
    tl_review_note_motion(review);
    tl_info("view: environment at %g degrees", (double)*yaw_deg);
}

void tl_act_turn_camera(struct tl_review *review, int argument)
{
    const float turn = CAMERA_STEP_DEG / TL_ORBIT_DEG_PER_HEIGHT; /* view heights, as a drag of this length */
    float dx = argument == TL_ACT_LEFT ? -turn : argument == TL_ACT_RIGHT ? turn : 0;
    float dy = argument == TL_ACT_UP ? -turn : argument == TL_ACT_DOWN ? turn : 0;
    tl_review_stop_moving(review);
    tl_orbit_turn(&review->wanted.camera, dx, dy);
    tl_review_mark_changed(review);
    tl_review_note_motion(review);
}

void tl_act_zoom(struct tl_review *review, int argument)
{
    tl_review_stop_moving(review);
    tl_review_fix_camera(review);
    tl_orbit_zoom(&review->wanted.camera, (float)argument, 0, 0);
    tl_review_mark_changed(review);
    tl_review_note_motion(review);
}

void tl_act_frame_all(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_stop_moving(review);
    review->wanted.camera.distance_m = 0;
    tl_review_mark_changed(review);
}

void tl_act_budget(struct tl_review *review, int argument)
{
    static const float ladder_ms[] = {16, 25, 33, 50, 75, 100, 150, 200, 400, 0}; /* 0: none */
    const int last = TL_COUNT(ladder_ms) - 1;
    int at = 0;
    while (at < last &&
           (review->screen.params.budget_ms <= 0 || ladder_ms[at] < review->screen.params.budget_ms))
        at++;
    at += argument;
    at = at < 0 ? 0 : at > last ? last : at;
    review->screen.params.budget_ms = ladder_ms[at];
    if (ladder_ms[at] > 0)
        tl_review_report(review, "budget: %g ms for a frame", (double)ladder_ms[at]);
    else
        tl_review_report(review, "budget: none, a frame may take as long as it needs");
}

/* The first unused name in the folder. New string. */
static char *free_name(const struct tl_review *review, const char *extension)
{
    for (int number = 1;; number++) {
        char *path = tl_format("%s/toile-%04d.%s", review->keep.output_folder, number, extension);
        if (!tl_file_exists(path))
            return path;
        free(path);
    }
}

static bool save_linear(struct tl_review *review, const char *path, tl_image *image, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B", "A"};
    return tl_renderer_read(review->renderer, image, error) &&
           tl_exr_save(path, &(struct tl_exr_layer){.channel_names = channels, .image = image}, 1, error);
}

/* The image as the window shows it: the columns left of the line come from appearance A. */
static bool save_shown(struct tl_review *review, const char *path, tl_image *image, tl_error *error)
{
    if (!tl_renderer_show_image(review->renderer, image, error))
        return false;
    if (review->wipe.renderer) {
        tl_image other;
        if (!tl_renderer_show_image(review->wipe.renderer, &other, error))
            return false;
        size_t row = 3 * (size_t)image->width, left = 3 * (size_t)tl_review_wipe_column(review, image->width);
        for (int y = 0; y < image->height; y++)
            memcpy((char *)image->texels + (size_t)y * row, (char *)other.texels + (size_t)y * row, left);
        tl_image_release(&other);
    }
    return tl_image_save_png(path, image, error);
}

void tl_act_screenshot(struct tl_review *review, int argument)
{
    tl_error error;
    tl_image image = {0};
    bool linear = argument != 0;
    char *path = free_name(review, linear ? "exr" : "png");
    bool saved = tl_folder_make(review->keep.output_folder, &error) && tl_review_draw_sharp(review, &error) &&
                 (linear ? save_linear : save_shown)(review, path, &image, &error);
    if (saved)
        tl_review_report(review, "screenshot saved: %s", path);
    else
        tl_review_report_error(review, &error);
    tl_image_release(&image);
    free(path);
}

void tl_act_next_units(struct tl_review *review, int argument)
{
    tl_review_next_units(review, argument);
}

void tl_act_next_up(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_next_up(review);
}

void tl_act_keep_reading(struct tl_review *review, int argument)
{
    (void)argument;
    if (!tl_review_keep_reading(review))
        tl_review_report(review, "nothing was guessed that could be kept");
}

void tl_act_place(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_place_toggle(review);
}

void tl_act_options(struct tl_review *review, int argument)
{
    (void)argument;
    if (!review->screen.params.panel) {
        review->screen.params.panel = true;
        tl_review_mark_changed(review);
    }
    tl_panel_use_keys(review->screen.panel, true);
    review->due.redraws = 3;
    tl_review_report(review, "arrows choose, Enter or Space edits, Esc ends");
}

/* Closes one thing at a time, the topmost first. */
void tl_act_back(struct tl_review *review, int argument)
{
    (void)argument;
    if (tl_review_place_cancel(review) || tl_review_cancel_question(review))
        return;
    if (tl_panel_close(review->screen.panel))
        review->due.redraws = 3;
    else if (tl_panel_wants_keys(review->screen.panel))
        tl_panel_use_keys(review->screen.panel, false);
    else if (review->input.help_shown)
        review->input.help_shown = false;
    else if (tl_review_stop_loading(review) || tl_review_keep_reading(review) || tl_review_place_hide(review))
        return;
    else if (review->screen.message.is_error && review->screen.message.text[0])
        tl_review_clear_message(review);
    else if (tl_review_moves_itself(review)) {
        tl_review_stop_moving(review);
        review->motion = (struct tl_review_motion){0};
    } else if (review->wipe.renderer)
        tl_review_compare(review);
    else
        review->due.closing = true;
}

void tl_act_turntable(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_toggle(review, &review->motion.turntable, "turntable");
}

void tl_act_view(struct tl_review *review, int argument)
{
    tl_review_go_to_view(review, argument);
}

void tl_act_save_view(struct tl_review *review, int argument)
{
    tl_review_save_view(review, argument);
}

void tl_act_path_key(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_path_add(review);
}

void tl_act_path_record(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_path_record(review);
}

void tl_act_path_play(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_path_play(review);
}

void tl_act_next_environment(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_next_environment(review);
}

void tl_act_environment_turntable(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_toggle(review, &review->motion.environment, "the environment");
}

void tl_act_open(struct tl_review *review, int argument)
{
    (void)argument;
    tl_error error;
    if (!review->edit.chooser && !(review->edit.chooser = tl_file_chooser_open("toile: open", &error)))
        tl_review_report_error(review, &error);
}

void tl_act_next_fabric(struct tl_review *review, int argument)
{
    tl_review_next_fabric(review, argument);
}

void tl_act_fabric(struct tl_review *review, int argument)
{
    int count = 0;
    while (count < argument && tl_embedded_fabrics_names[count])
        count++;
    if (tl_embedded_fabrics_names[count])
        tl_review_use_fabric(review, tl_embedded_fabrics_names[count]);
}

void tl_act_next_colourway(struct tl_review *review, int argument)
{
    tl_review_next_colourway(review, argument);
}

void tl_act_compare(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_compare(review);
}

void tl_act_swap(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_swap(review);
}

void tl_act_move_wipe(struct tl_review *review, int argument)
{
    tl_review_move_wipe(review, review->wipe.place + (float)argument * WIPE_STEP);
}

void tl_act_next_view(struct tl_review *review, int argument)
{
    tl_review_next_view(review, argument);
}

void tl_act_light_view(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_next_view(review, TL_VIEW_LIGHT - review->wanted.image.view);
}

void tl_act_pattern(struct tl_review *review, int argument)
{
    bool *shown = &review->wanted.scene.pattern;
    if (!*shown && !tl_session_has_pattern(review->session)) {
        tl_review_report(review, "no pattern is known of this garment (toile info states why)");
        return;
    }
    *shown = !*shown;
    tl_review_report(review, *shown ? "shows the pattern beside the garment" : "hides the pattern");
    tl_act_frame_all(review, argument);
}

void tl_act_read_out(struct tl_review *review, int argument)
{
    (void)argument;
    review->input.reads_out = !review->input.reads_out;
    tl_review_report(review,
                     review->input.reads_out ? "prints the values under the pointer" : "prints no values");
}

void tl_act_undo(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_undo(review, false);
}

void tl_act_redo(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_undo(review, true);
}

void tl_act_panel(struct tl_review *review, int argument)
{
    (void)argument;
    review->screen.params.panel = !review->screen.params.panel;
    tl_review_mark_changed(review); /* the view has another size */
}

void tl_act_help(struct tl_review *review, int argument)
{
    (void)argument;
    review->input.help_shown = !review->input.help_shown;
}

void tl_act_recent(struct tl_review *review, int argument)
{
    (void)argument;
    tl_review_offer_recent(review);
}

void tl_act_quit(struct tl_review *review, int argument)
{
    (void)argument;
    review->due.closing = true;
}
