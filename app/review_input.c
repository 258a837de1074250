/* Keys and pointer of the review window. */
#include "app/orbit.h"
#include "app/review.h"
#include "config/log.h"
#include "config/memory.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <math.h>
#include <stdio.h>

struct key_row {
    int key, modifiers;
    int command;
    const char *label; /* NULL: another key for the row above */
    const char *help;
};

static const struct key_row key_rows[] = {
    {GLFW_KEY_SPACE, 0, TL_REVIEW_PLAY, "Space", "play, pause"},
    {GLFW_KEY_PERIOD, 0, TL_REVIEW_STEP, ".  or  Right", "one frame on"},
    {GLFW_KEY_RIGHT, 0, TL_REVIEW_STEP, NULL, NULL},
    {GLFW_KEY_R, 0, TL_REVIEW_RESET, "R", "back to the settled start"},
    {GLFW_KEY_P, 0, TL_REVIEW_PIN, "P", "while pulling: pin the cloth here; else: take those pins out"},
    {GLFW_KEY_F, 0, TL_REVIEW_FRAME_ALL, "F", "frame the whole figure"},
    {GLFW_KEY_E, 0, TL_REVIEW_NEXT_ENVIRONMENT, "E", "next environment"},
    {GLFW_KEY_LEFT_BRACKET, 0, TL_REVIEW_TURN_LEFT, "[  ]", "turn the environment by 15\u00b0"},
    {GLFW_KEY_RIGHT_BRACKET, 0, TL_REVIEW_TURN_RIGHT, NULL, NULL},
    {GLFW_KEY_S, 0, TL_REVIEW_SCREENSHOT, "S  or  F12", "screenshot as PNG"},
    {GLFW_KEY_F12, 0, TL_REVIEW_SCREENSHOT, NULL, NULL},
    {GLFW_KEY_S, GLFW_MOD_SHIFT, TL_REVIEW_SCREENSHOT_LINEAR, "Shift+S", "screenshot as EXR, linear"},
    {GLFW_KEY_TAB, 0, TL_REVIEW_PANEL, "Tab", "hide or show the panel"},
    {GLFW_KEY_H, 0, TL_REVIEW_HELP, "H  or  F1", "this list"},
    {GLFW_KEY_F1, 0, TL_REVIEW_HELP, NULL, NULL},
    {GLFW_KEY_ESCAPE, 0, TL_REVIEW_BACK, "Esc", "close what is open, or leave"},
    {GLFW_KEY_Q, 0, TL_REVIEW_QUIT, "Q", "leave"},
    {GLFW_KEY_1, 0, TL_REVIEW_FABRIC, "1 to 9", "fabrics, in the order of the panel's list"},
    {GLFW_KEY_2, 0, TL_REVIEW_FABRIC + 1, NULL, NULL},
    {GLFW_KEY_3, 0, TL_REVIEW_FABRIC + 2, NULL, NULL},
    {GLFW_KEY_4, 0, TL_REVIEW_FABRIC + 3, NULL, NULL},
    {GLFW_KEY_5, 0, TL_REVIEW_FABRIC + 4, NULL, NULL},
    {GLFW_KEY_6, 0, TL_REVIEW_FABRIC + 5, NULL, NULL},
    {GLFW_KEY_7, 0, TL_REVIEW_FABRIC + 6, NULL, NULL},
    {GLFW_KEY_8, 0, TL_REVIEW_FABRIC + 7, NULL, NULL},
    {GLFW_KEY_9, 0, TL_REVIEW_FABRIC + 8, NULL, NULL},
};

static const char *const gesture_rows[][2] = {
    {"left drag", "turn about the figure"},
    {"right or middle drag", "move the figure"},
    {"wheel", "nearer, farther"},
    {"double click", "look closely at that point"},
    {"Ctrl + left drag", "pull on the cloth"},
    {"Shift + left drag", "turn the environment"},
    {"drop a file", ".glb .gltf: garment or avatar; .exr .hdr: environment; .yaml: scene, fabric or preset"},
};

static void add_help(struct tl_panel_line *line, const char *label, const char *help)
{
    snprintf(line->cells[0], sizeof line->cells[0], "%s", label);
    snprintf(line->cells[1], sizeof line->cells[1], "%s", help);
}

size_t tl_review_help(struct tl_panel_line *lines, size_t capacity)
{
    size_t count = 0;
    for (size_t i = 0; i < TL_COUNT(gesture_rows) && count < capacity; i++)
        add_help(&lines[count++], gesture_rows[i][0], gesture_rows[i][1]);
    for (size_t i = 0; i < TL_COUNT(key_rows) && count < capacity; i++)
        if (key_rows[i].label)
            add_help(&lines[count++], key_rows[i].label, key_rows[i].help);
    return count;
}

static void on_key(struct tl_review *review, const struct tl_window_event *event)
{
    const int others = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    bool pulls = review->drag == TL_DRAG_CLOTH; /* with Ctrl held */
    if (tl_panel_wants_keys(review->panel) || (!pulls && (event->modifiers & others)))
        return;
    int modifiers = event->modifiers & GLFW_MOD_SHIFT;
    for (size_t i = 0; i < TL_COUNT(key_rows); i++)
        if (key_rows[i].key == event->key && key_rows[i].modifiers == modifiers) {
            tl_review_act(review, key_rows[i].command);
            return;
        }
}

static struct tl_ray ray_under(const struct tl_review *review, const struct tl_camera *camera, float x,
                               float y)
{
    int width, height;
    tl_review_size(review, &width, &height);
    return tl_orbit_ray(camera, x, y, (float)width, (float)height);
}

static float depth_of(const struct tl_camera *camera, vec3s point)
{
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    return glms_vec3_dot(glms_vec3_sub(point, camera->eye), forward);
}

/* The garment's point under the pointer. */
static bool pick(const struct tl_review *review, const struct tl_camera *camera, float x, float y,
                 uint32_t *vertex, vec3s *point)
{
    struct tl_ray ray = ray_under(review, camera, x, y);
    float distance_m;
    if (!tl_session_pick(review->session, ray.origin, ray.direction, vertex, &distance_m))
        return false;
    *point = glms_vec3_muladds(ray.direction, distance_m, ray.origin);
    return true;
}

/* Moves but for a turn need to know how far the eye is, which an automatic frame leaves open. */
static void fix_camera(struct tl_review *review)
{
    struct tl_camera camera = tl_session_frame(review->session).camera;
    if (review->wanted.camera.distance_m <= 0)
        tl_orbit_take(&review->wanted.camera, &camera);
}

/* The pointer in the plane in which the cloth is pulled. */
static vec3s pull_target(const struct tl_review *review, const struct tl_camera *camera, float x, float y)
{
    struct tl_ray ray = ray_under(review, camera, x, y);
    float depth_per_m = depth_of(camera, glms_vec3_add(camera->eye, ray.direction));
    return glms_vec3_muladds(ray.direction, review->grab_depth_m / depth_per_m, ray.origin);
}

/* Where images come slowly the pointer runs away from the simulated time, and a hand that followed at once
 * would tear the cloth along at many metres a second. */
void tl_review_move_hand(struct tl_review *review)
{
    const float quickest_m_s = 1.5f;
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (review->drag != TL_DRAG_CLOTH || !cloth)
        return;
    float reach_m = quickest_m_s / (float)review->good.cloth.frame_rate;
    vec3s way = glms_vec3_sub(review->grab_target, review->grab_at);
    float length_m = glms_vec3_norm(way);
    float share = length_m > reach_m ? reach_m / length_m : 1;
    review->grab_at = glms_vec3_muladds(way, share, review->grab_at);
    tl_cloth_grab(cloth, review->grab_vertex, review->grab_at);
}

static void begin_pull(struct tl_review *review, float x, float y)
{
    struct tl_camera camera = tl_session_frame(review->session).camera;
    vec3s point;
    if (!pick(review, &camera, x, y, &review->grab_vertex, &point)) {
        tl_review_say(review, "nothing to pull here: hold Ctrl and drag on the garment");
        return;
    }
    if (!tl_session_cloth(review->session)) {
        tl_review_say(review, "the garment is played back, not simulated: it cannot be pulled on");
        return;
    }
    review->drag = TL_DRAG_CLOTH;
    review->grab_depth_m = depth_of(&camera, point);
    review->grab_target = review->grab_at = point;
    if (!review->playing)
        tl_review_act(review, TL_REVIEW_PLAY); /* cloth that stands still cannot follow */
    tl_info("view: pulls on vertex %u", (unsigned)review->grab_vertex);
}

static void focus(struct tl_review *review, float x, float y)
{
    struct tl_camera camera = tl_session_frame(review->session).camera;
    uint32_t vertex;
    vec3s point;
    if (!pick(review, &camera, x, y, &vertex, &point))
        return;
    fix_camera(review);
    tl_orbit_focus(&review->wanted.camera, point);
    review->changed = true;
    tl_info("view: looks at vertex %u", (unsigned)vertex);
}

static bool is_double_click(struct tl_review *review, const struct tl_window_event *event)
{
    const double patience_s = 0.35;
    const float slack = 5; /* pixels */
    double now_s = tl_clock_s();
    bool is_second = now_s - review->pressed_s < patience_s && fabsf(event->x - review->pressed_x) < slack &&
                     fabsf(event->y - review->pressed_y) < slack;
    review->pressed_s = is_second ? 0 : now_s;
    review->pressed_x = event->x;
    review->pressed_y = event->y;
    return is_second;
}

static void on_press(struct tl_review *review, const struct tl_window_event *event)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (review->drag != TL_DRAG_NONE || event->x >= (float)width || tl_panel_wants_pointer(review->panel))
        return;
    review->drag_button = event->button;
    review->pointer_x = event->x;
    review->pointer_y = event->y;
    if (event->button != GLFW_MOUSE_BUTTON_LEFT)
        review->drag = TL_DRAG_PAN;
    else if (event->modifiers & GLFW_MOD_CONTROL)
        begin_pull(review, event->x, event->y);
    else if (event->modifiers & GLFW_MOD_SHIFT)
        review->drag = TL_DRAG_LIGHT;
    else if (is_double_click(review, event))
        focus(review, event->x, event->y);
    else
        review->drag = TL_DRAG_ORBIT;
}

static void on_release(struct tl_review *review, const struct tl_window_event *event)
{
    if (review->drag == TL_DRAG_NONE || event->button != review->drag_button)
        return;
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (review->drag == TL_DRAG_CLOTH && cloth)
        tl_cloth_release(cloth);
    review->drag = TL_DRAG_NONE;
}

static void on_move(struct tl_review *review, const struct tl_window_event *event)
{
    int width, height;
    tl_review_size(review, &width, &height);
    float dx = (event->x - review->pointer_x) / (float)height,
          dy = (event->y - review->pointer_y) / (float)height;
    review->pointer_x = event->x;
    review->pointer_y = event->y;
    switch (review->drag) {
    case TL_DRAG_NONE:
        return;
    case TL_DRAG_ORBIT:
        tl_orbit_turn(&review->wanted.camera, dx, dy);
        break;
    case TL_DRAG_PAN:
        fix_camera(review);
        tl_orbit_pan(&review->wanted.camera, dx, dy);
        break;
    case TL_DRAG_LIGHT:
        review->wanted.scene.environment_yaw_deg =
            tl_orbit_wrap_deg(review->wanted.scene.environment_yaw_deg - dx * TL_ORBIT_DEG_PER_HEIGHT);
        break;
    case TL_DRAG_CLOTH: {
        struct tl_camera camera = tl_session_frame(review->session).camera;
        review->grab_target = pull_target(review, &camera, event->x, event->y);
        return;
    }
    }
    review->changed = true;
    tl_review_touch(review);
}

static void on_wheel(struct tl_review *review, const struct tl_window_event *event)
{
    int width, height;
    tl_review_size(review, &width, &height);
    if (event->x >= (float)width || tl_panel_wants_pointer(review->panel))
        return;
    fix_camera(review);
    float x = (event->x - 0.5f * (float)width) / (float)height;
    float y = (event->y - 0.5f * (float)height) / (float)height;
    tl_orbit_zoom(&review->wanted.camera, event->steps, x, y);
    review->changed = true;
    tl_review_touch(review);
}

static void handle(struct tl_review *review, const struct tl_window_event *event)
{
    switch (event->type) {
    case TL_WINDOW_KEY:
        on_key(review, event);
        break;
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
        tl_review_drop(review, event->path);
        break;
    case TL_WINDOW_REDRAW: {
        int width, height;
        tl_review_size(review, &width, &height);
        review->changed |= width != review->good.image.width || height != review->good.image.height;
        break;
    }
    case TL_WINDOW_CLOSE:
        review->closing = true;
        break;
    }
}

void tl_review_listen(struct tl_review *review)
{
    const int panel_settles = 3; /* ImGui answers to an event within so many frames */
    struct tl_window_event event;
    while (tl_window_next(review->window, &event)) {
        handle(review, &event);
        tl_window_event_release(&event);
        review->redraws = panel_settles;
    }
}
