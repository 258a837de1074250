#include "app/view/command/review_input.h"

#include "app/scene/orbit.h"
#include "app/view/command/review_commands.h"
#include "app/view/review/review_edit.h"
#include "app/view/review/review_hand.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_place.h"
#include "app/view/review/review_wipe.h"
#include "config/base/log.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <math.h>

static void focus(struct tl_review *review, float x, float y)
{
    uint32_t vertex;
    vec3s point;
    if (!tl_review_pick(review, x, y, &vertex, &point))
        return;
    tl_review_fix_camera(review);
    tl_orbit_focus(&review->wanted.camera, point);
    tl_review_mark_changed(review);
    tl_info("view: looks at vertex %u", (unsigned)vertex);
}

static bool is_double_click(struct tl_review *review, const struct tl_window_event *event)
{
    const double pause_max_s = 0.35;
    const float distance_max = 5; /* pixels */
    double now_s = tl_clock_s();
    bool is_second = now_s - review->input.pressed_s < pause_max_s &&
                     fabsf(event->x - review->input.pressed_x) < distance_max &&
                     fabsf(event->y - review->input.pressed_y) < distance_max;
    review->input.pressed_s = is_second ? 0 : now_s;
    review->input.pressed_x = event->x;
    review->input.pressed_y = event->y;
    return is_second;
}

/* The line between two appearances can be caught within a few pixels. */
static bool is_on_wipe(const struct tl_review *review, float x, int width)
{
    const float reach = 8 * tl_window_scale(review->screen.window);
    int column = tl_review_wipe_column(review, width);
    return column > 0 && fabsf(x - (float)column) < reach;
}

static bool places(int modifiers)
{
    return (modifiers & GLFW_MOD_CONTROL) && (modifiers & GLFW_MOD_SHIFT);
}

static void on_press(struct tl_review *review, const struct tl_window_event *event)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (review->input.drag != TL_DRAG_NONE || event->x >= (float)width ||
        tl_panel_wants_pointer(review->screen.panel, event->x, event->y))
        return;
    review->input.button = event->button;
    review->input.x = event->x;
    review->input.y = event->y;
    tl_review_stop_moving(review);
    if (places(event->modifiers))
        tl_review_place_begin(review, event->x, event->y, event->button != GLFW_MOUSE_BUTTON_LEFT);
    else if (event->button != GLFW_MOUSE_BUTTON_LEFT)
        tl_review_set_drag(review, TL_DRAG_PAN);
    else if (tl_review_place_catch(review, event->x, event->y))
        return;
    else if (is_on_wipe(review, event->x, width))
        tl_review_set_drag(review, TL_DRAG_WIPE);
    else if (event->modifiers & GLFW_MOD_CONTROL)
        tl_review_hand_begin(review, event->x, event->y);
    else if (event->modifiers & GLFW_MOD_SHIFT)
        tl_review_set_drag(review, TL_DRAG_LIGHT);
    else if (is_double_click(review, event))
        focus(review, event->x, event->y);
    else
        tl_review_set_drag(review, TL_DRAG_ORBIT);
}

static void on_release(struct tl_review *review, const struct tl_window_event *event)
{
    if (review->input.drag == TL_DRAG_NONE || event->button != review->input.button)
        return;
    tl_review_place_end(review);
    tl_review_hand_release(review);
}

static void on_move(struct tl_review *review, const struct tl_window_event *event)
{
    int width, height;
    tl_review_size(review, &width, &height);
    const float right = event->x - review->input.x, down = event->y - review->input.y;
    float dx = right / (float)height, dy = down / (float)height;
    review->input.x = event->x;
    review->input.y = event->y;
    switch (review->input.drag) {
    case TL_DRAG_NONE:
        tl_review_place_hover(review, event->x, event->y);
        return;
    case TL_DRAG_ORBIT:
        tl_orbit_turn(&review->wanted.camera, dx, dy);
        break;
    case TL_DRAG_PAN:
        tl_review_fix_camera(review);
        tl_orbit_pan(&review->wanted.camera, dx, dy);
        break;
    case TL_DRAG_LIGHT:
        review->wanted.scene.environment_yaw_deg =
            tl_orbit_wrap_deg(review->wanted.scene.environment_yaw_deg - dx * TL_ORBIT_DEG_PER_HEIGHT);
        break;
    case TL_DRAG_WIPE:
        tl_review_move_wipe(review, event->x / (float)width);
        return;
    case TL_DRAG_PLACE:
        if (review->input.button == GLFW_MOUSE_BUTTON_LEFT)
            tl_review_place_drag(review, right, down, event->modifiers);
        else
            tl_review_place_turn(review, dx);
        return;
    case TL_DRAG_CLOTH:
        tl_review_hand_aim(review, event->x, event->y);
        return;
    }
    tl_review_mark_changed(review);
    tl_review_note_motion(review);
}

static void on_wheel(struct tl_review *review, const struct tl_window_event *event)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (event->x >= (float)width || tl_panel_wants_pointer(review->screen.panel, event->x, event->y))
        return;
    tl_review_stop_moving(review);
    if (places(event->modifiers)) {
        const float factor_per_step = 1.02f;
        if (tl_review_place_begin(review, event->x, event->y, false))
            tl_review_place_scale(review, powf(factor_per_step, event->steps));
        tl_review_place_end(review);
        return;
    }
    tl_review_fix_camera(review);
    float x = (event->x - 0.5f * (float)width) / (float)height;
    float y = (event->y - 0.5f * (float)height) / (float)height;
    tl_orbit_zoom(&review->wanted.camera, event->steps, x, y);
    tl_review_mark_changed(review);
    tl_review_note_motion(review);
}

/* A question of the panel takes all keys but Esc: its answers are numbered from 1, the tenth is 0. */
static bool answer(struct tl_review *review, const struct tl_window_event *event)
{
    size_t count;
    if (!tl_review_answers(review, &count) || event->key == GLFW_KEY_ESCAPE)
        return false;
    if (event->key >= GLFW_KEY_1 && event->key <= GLFW_KEY_9)
        tl_review_answer(review, (size_t)(event->key - GLFW_KEY_1));
    else if (event->key == GLFW_KEY_0)
        tl_review_answer(review, 9);
    return true;
}

static void on_key(struct tl_review *review, const struct tl_window_event *event)
{
    if (tl_panel_wants_keys(review->screen.panel) && event->key != GLFW_KEY_ESCAPE)
        return;
    if (answer(review, event))
        return;
    int modifiers = event->modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER),
        argument;
    if (review->input.drag == TL_DRAG_CLOTH) /* Ctrl is held in order to pull */
        modifiers &= ~GLFW_MOD_CONTROL;
    if (review->input.drag == TL_DRAG_PLACE) /* they choose how fine it is */
        modifiers &= ~(GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
    const struct tl_review_command *command = tl_review_command_of_key(event->key, modifiers, &argument);
    if (command && (!event->repeated || command->repeats))
        command->act(review, argument);
}

static void handle(struct tl_review *review, const struct tl_window_event *event)
{
    switch (event->type) {
    case TL_WINDOW_KEY:
        on_key(review, event);
        break;
    case TL_WINDOW_KEY_UP:
    case TL_WINDOW_TEXT:
        break; /* for the panel only */
    case TL_WINDOW_PRESS:
        on_press(review, event);
        break;
    case TL_WINDOW_RELEASE:
        on_release(review, event);
        break;
    case TL_WINDOW_MOVE:
        on_move(review, event);
        break;
    case TL_WINDOW_WHEEL:
        on_wheel(review, event);
        break;
    case TL_WINDOW_DROP:
        tl_review_open_dropped(review, event->path);
        break;
    case TL_WINDOW_REDRAW: {
        int width, height;
        tl_review_size(review, &width, &height);
        if (width != review->good.image.width || height != review->good.image.height)
            tl_review_mark_changed(review);
        break;
    }
    case TL_WINDOW_CLOSE:
        review->due.closing = true;
        break;
    }
}

void tl_review_handle_events(struct tl_review *review)
{
    const int panel_frames = 3; /* ImGui reacts to an event within this many frames */
    struct tl_window_event event;
    while (tl_window_next(review->screen.window, &event)) {
        tl_panel_take(review->screen.panel, &event);
        handle(review, &event);
        tl_window_event_release(&event);
        review->due.redraws = panel_frames;
    }
}
