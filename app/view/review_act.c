/* What the commands of the review window do. */
#include "app/scene/orbit.h"
#include "app/view/review.h"
#include "assets/image/exr.h"
#include "config/embedded.h"
#include "config/file.h"
#include "config/log.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

#define ENVIRONMENT_STEP_DEG 15.0f
#define WIPE_STEP            0.05f

static void play(struct tl_review *review)
{
    review->playing = !review->playing;
    review->next_step_s = tl_clock_s();
    tl_info("view: %s at frame %d", review->playing ? "plays" : "paused",
            tl_session_frame_number(review->session));
}

static void step(struct tl_review *review)
{
    tl_error error;
    review->playing = false;
    if (!tl_session_advance(review->session, &error))
        tl_review_complain(review, &error);
    review->image_is_old = true;
    tl_info("view: frame %d", tl_session_frame_number(review->session));
}

static void reset(struct tl_review *review)
{
    tl_error error;
    if (!tl_session_reset(review->session, &error))
        tl_review_complain(review, &error);
    review->image_is_old = true;
    tl_info("view: reset");
}

static void pin(struct tl_review *review)
{
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (!cloth) {
        tl_review_say(review, "the garment is not simulated: there is nothing to pin");
    } else if (review->drag == TL_DRAG_CLOTH) {
        tl_cloth_release(cloth);
        tl_cloth_pin(cloth, review->grab_vertex);
        review->drag = TL_DRAG_NONE;
        tl_review_say(review, "pinned: P takes the pins out again");
    } else {
        size_t count = tl_cloth_unpin(cloth);
        if (count > 0)
            tl_review_say(review, "%zu %s taken out", count, count == 1 ? "pin" : "pins");
        else
            tl_review_say(review, "no pins: pull on the cloth with Ctrl + drag and press P to set one");
    }
}

static void turn_environment(struct tl_review *review, float by_deg)
{
    float *yaw_deg = &review->wanted.scene.environment_yaw_deg;
    *yaw_deg = tl_orbit_wrap_deg(*yaw_deg + by_deg);
    review->changed = true;
    tl_review_touch(review);
    tl_info("view: environment at %g degrees", (double)*yaw_deg);
}

/* In view heights, as a drag. */
static void turn_camera(struct tl_review *review, float dx, float dy)
{
    tl_review_stop_moving(review);
    tl_orbit_turn(&review->wanted.camera, dx, dy);
    review->changed = true;
    tl_review_touch(review);
}

static void zoom(struct tl_review *review, float steps)
{
    tl_review_stop_moving(review);
    tl_review_fix_camera(review);
    tl_orbit_zoom(&review->wanted.camera, steps, 0, 0);
    review->changed = true;
    tl_review_touch(review);
}

static void frame_all(struct tl_review *review)
{
    tl_review_stop_moving(review);
    review->wanted.camera.distance_m = 0;
    review->changed = true;
}

static void change_budget(struct tl_review *review, int by)
{
    static const float ladder_ms[] = {16, 25, 33, 50, 75, 100, 150, 200, 400, 0}; /* 0: none */
    const int last = TL_COUNT(ladder_ms) - 1;
    int at = 0;
    while (at < last && (review->params.budget_ms <= 0 || ladder_ms[at] < review->params.budget_ms))
        at++;
    at = at + by < 0 ? 0 : at + by > last ? last : at + by;
    review->params.budget_ms = ladder_ms[at];
    if (ladder_ms[at] > 0)
        tl_review_say(review, "budget: %g ms for a frame", (double)ladder_ms[at]);
    else
        tl_review_say(review, "budget: none, a frame takes what it takes");
}

/* The first name in the folder that is not taken. New string. */
static char *free_name(const struct tl_review *review, const char *extension)
{
    for (int number = 1;; number++) {
        char *path = tl_format("%s/toile-%04d.%s", review->output_folder, number, extension);
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

/* As it is shown, both looks where two are compared. */
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

static void screenshot(struct tl_review *review, bool linear)
{
    tl_error error;
    tl_image image = {0};
    char *path = free_name(review, linear ? "exr" : "png");
    bool saved = tl_folder_make(review->output_folder, &error) && tl_review_draw_sharp(review, &error) &&
                 (linear ? save_linear : save_shown)(review, path, &image, &error);
    if (saved)
        tl_review_say(review, "screenshot saved: %s", path);
    else
        tl_review_complain(review, &error);
    tl_image_release(&image);
    free(path);
}

static void use_options(struct tl_review *review)
{
    if (!review->params.panel) {
        review->params.panel = true;
        review->changed = true;
    }
    tl_panel_use_keys(review->panel, true);
    review->redraws = 3;
    tl_review_say(review, "arrows choose, Enter or Space edits, Esc ends");
}

/* One thing at a time: what lies on top first. */
static void back(struct tl_review *review)
{
    if (review->dropped)
        tl_review_forget_dropped(review);
    else if (tl_panel_wants_keys(review->panel))
        tl_panel_use_keys(review->panel, false);
    else if (review->help_shown)
        review->help_shown = false;
    else if (tl_review_stop_loading(review))
        return;
    else if (review->message_is_error && review->message[0])
        tl_review_quiet(review);
    else if (tl_review_moves_itself(review)) {
        tl_review_stop_moving(review);
        review->motion = (struct tl_review_motion){0};
    } else if (review->wipe.renderer)
        tl_review_compare(review);
    else
        review->closing = true;
}

static bool act_on_range(struct tl_review *review, int command)
{
    if (command >= TL_REVIEW_FABRIC) {
        int index = command - TL_REVIEW_FABRIC, count = 0;
        while (count < index && tl_embedded_fabrics_names[count])
            count++;
        if (tl_embedded_fabrics_names[count])
            tl_review_use_fabric(review, tl_embedded_fabrics_names[count]);
    } else if (command >= TL_REVIEW_SAVE_VIEW) {
        tl_review_save_view(review, command - TL_REVIEW_SAVE_VIEW);
    } else if (command >= TL_REVIEW_VIEW) {
        tl_review_go_to_view(review, command - TL_REVIEW_VIEW);
    }
    return command >= TL_REVIEW_VIEW;
}

void tl_review_act(struct tl_review *review, int command)
{
    const float turn = 5 / TL_ORBIT_DEG_PER_HEIGHT;
    if (act_on_range(review, command))
        return;
    switch ((enum tl_review_command)command) {
    case TL_REVIEW_PLAY:
        play(review);
        break;
    case TL_REVIEW_STEP:
        step(review);
        break;
    case TL_REVIEW_RESET:
        reset(review);
        break;
    case TL_REVIEW_PIN:
        pin(review);
        break;
    case TL_REVIEW_FRAME_ALL:
        frame_all(review);
        break;
    case TL_REVIEW_TURN_CAMERA_LEFT:
        turn_camera(review, -turn, 0);
        break;
    case TL_REVIEW_TURN_CAMERA_RIGHT:
        turn_camera(review, turn, 0);
        break;
    case TL_REVIEW_TURN_CAMERA_UP:
        turn_camera(review, 0, -turn);
        break;
    case TL_REVIEW_TURN_CAMERA_DOWN:
        turn_camera(review, 0, turn);
        break;
    case TL_REVIEW_NEARER:
        zoom(review, 1);
        break;
    case TL_REVIEW_FARTHER:
        zoom(review, -1);
        break;
    case TL_REVIEW_TURNTABLE:
        tl_review_turn(review, &review->motion.turntable, "turntable");
        break;
    case TL_REVIEW_NEXT_ENVIRONMENT:
        tl_review_next_environment(review);
        break;
    case TL_REVIEW_TURN_LEFT:
        turn_environment(review, ENVIRONMENT_STEP_DEG);
        break;
    case TL_REVIEW_TURN_RIGHT:
        turn_environment(review, -ENVIRONMENT_STEP_DEG);
        break;
    case TL_REVIEW_TURN_ENVIRONMENT:
        tl_review_turn(review, &review->motion.environment, "the environment");
        break;
    case TL_REVIEW_NEXT_FABRIC:
        tl_review_next_fabric(review, 1);
        break;
    case TL_REVIEW_PREVIOUS_FABRIC:
        tl_review_next_fabric(review, -1);
        break;
    case TL_REVIEW_NEXT_COLOURWAY:
        tl_review_next_colourway(review, 1);
        break;
    case TL_REVIEW_PREVIOUS_COLOURWAY:
        tl_review_next_colourway(review, -1);
        break;
    case TL_REVIEW_NEXT_VIEW:
        tl_review_next_view(review, 1);
        break;
    case TL_REVIEW_PREVIOUS_VIEW:
        tl_review_next_view(review, -1);
        break;
    case TL_REVIEW_PLAIN_VIEW:
        tl_review_next_view(review, TL_VIEW_LIGHT - review->wanted.image.view);
        break;
    case TL_REVIEW_READ_OUT:
        review->reads_out = !review->reads_out;
        tl_review_say(review, review->reads_out ? "reads out what lies under the pointer" : "no read-out");
        break;
    case TL_REVIEW_COMPARE:
        tl_review_compare(review);
        break;
    case TL_REVIEW_EXCHANGE:
        tl_review_exchange(review);
        break;
    case TL_REVIEW_WIPE_LEFT:
        tl_review_move_wipe(review, review->wipe.place - WIPE_STEP);
        break;
    case TL_REVIEW_WIPE_RIGHT:
        tl_review_move_wipe(review, review->wipe.place + WIPE_STEP);
        break;
    case TL_REVIEW_PATH_KEY:
        tl_review_path_add(review);
        break;
    case TL_REVIEW_PATH_RECORD:
        tl_review_path_record(review);
        break;
    case TL_REVIEW_PATH_PLAY:
        tl_review_path_play(review);
        break;
    case TL_REVIEW_UNDO:
        tl_review_undo(review, false);
        break;
    case TL_REVIEW_REDO:
        tl_review_undo(review, true);
        break;
    case TL_REVIEW_BUDGET_LESS:
        change_budget(review, -1);
        break;
    case TL_REVIEW_BUDGET_MORE:
        change_budget(review, 1);
        break;
    case TL_REVIEW_SCREENSHOT:
        screenshot(review, false);
        break;
    case TL_REVIEW_SCREENSHOT_LINEAR:
        screenshot(review, true);
        break;
    case TL_REVIEW_PANEL:
        review->params.panel = !review->params.panel;
        review->changed = true; /* the picture's size */
        break;
    case TL_REVIEW_OPTIONS:
        use_options(review);
        break;
    case TL_REVIEW_HELP:
        review->help_shown = !review->help_shown;
        break;
    case TL_REVIEW_BACK:
        back(review);
        break;
    case TL_REVIEW_QUIT:
        review->closing = true;
        break;
    case TL_REVIEW_USE_GARMENT:
    case TL_REVIEW_USE_AVATAR:
    case TL_REVIEW_USE_SCENE:
    case TL_REVIEW_USE_FABRIC:
    case TL_REVIEW_USE_PRESET:
    case TL_REVIEW_USE_NOTHING:
    case TL_REVIEW_VIEW:
    case TL_REVIEW_SAVE_VIEW:
    case TL_REVIEW_FABRIC:
        tl_review_use_dropped(review, command);
        break;
    }
}
