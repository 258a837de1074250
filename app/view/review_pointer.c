/* Pointer and gestures of the review window. */
#include "app/scene/orbit.h"
#include "app/view/review.h"
#include "config/log.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <math.h>

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
    tl_review_fix_camera(review);
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

/* The line between two looks, caught within a few pixels. */
static bool is_on_wipe(const struct tl_review *review, float x, int width)
{
    const float reach = 8 * tl_window_scale(review->window);
    int column = tl_review_wipe_column(review, width);
    return column > 0 && fabsf(x - (float)column) < reach;
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
    tl_review_stop_moving(review);
    if (event->button != GLFW_MOUSE_BUTTON_LEFT)
        review->drag = TL_DRAG_PAN;
    else if (is_on_wipe(review, event->x, width))
        review->drag = TL_DRAG_WIPE;
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
    tl_review_stop_moving(review);
    tl_review_fix_camera(review);
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
        tl_review_on_key(review, event);
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
