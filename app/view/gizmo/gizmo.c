#include "app/view/gizmo/gizmo.h"

#include "app/scene/orbit.h"
#include "render/scene/view.h"

#include <math.h>

/* Pixels on a plain screen, from the pivot. */
#define ARROW_FROM 18.0f
#define ARROW_TO   110.0f
#define RING       80.0f
#define BOX        78.0f /* to the right, and up */
#define HALF_SIDE  7.0f
#define REACH      8.0f /* a handle is caught within this distance */

/* An arrow that is seen shorter than this share of its length points at the eye: a pixel of its drag would be
 * many of its metres. */
#define SHORTEST 0.25f

/* Sine of the angle between a ray and the ring's plane below which the plane is seen too flat to be aimed at.
 */
#define FLAT 0.5f

static const vec3s axes[3] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
static const vec3s vertical = {{0, 1, 0}};

/* ---- The view ---- */

static struct tl_view view_of(const struct tl_gizmo *gizmo)
{
    return tl_view_make(&gizmo->camera, gizmo->width, gizmo->height);
}

/* Pixel of a point (w = 1), or of the end of a direction at infinity (w = 0). False: behind the eye. */
static bool see(const struct tl_gizmo *gizmo, const struct tl_view *view, vec3s point, float w, vec2s *pixel)
{
    vec4s clip = glms_mat4_mulv(view->view_projection, (vec4s){{point.x, point.y, point.z, w}});
    if (!(clip.w > 1e-6f))
        return false;
    *pixel = (vec2s){{(float)gizmo->width * (0.5f + 0.5f * clip.x / clip.w),
                      (float)gizmo->height * (0.5f - 0.5f * clip.y / clip.w)}};
    return true;
}

static struct tl_ray ray_through(const struct tl_gizmo *gizmo, vec2s pixel)
{
    return tl_orbit_ray(&gizmo->camera, pixel.x, pixel.y, (float)gizmo->width, (float)gizmo->height);
}

static float depth_of(const struct tl_gizmo *gizmo, const struct tl_view *view)
{
    return glms_vec3_dot(glms_vec3_sub(gizmo->pivot, view->eye), view->forward);
}

/* Metres at the pivot's depth that a pixel of the view covers. */
static float metres_per_pixel(const struct tl_gizmo *gizmo, const struct tl_view *view)
{
    return 2 * depth_of(gizmo, view) * glms_vec3_norm(view->up) / (float)gizmo->height;
}

/* ---- The handles ---- */

static vec3s ring_point(const struct tl_gizmo *gizmo, float radius_m, float angle)
{
    return glms_vec3_muladds((vec3s){{sinf(angle), 0, cosf(angle)}}, radius_m, gizmo->pivot);
}

static bool draw_arrow(const struct tl_gizmo *gizmo, const struct tl_view *view, int k, float pixel_m,
                       struct tl_gizmo_drawing *out)
{
    vec3s from = glms_vec3_muladds(axes[k], ARROW_FROM * pixel_m, gizmo->pivot);
    vec3s to = glms_vec3_muladds(axes[k], ARROW_TO * pixel_m, gizmo->pivot);
    return see(gizmo, view, from, 1, &out->from[k]) && see(gizmo, view, to, 1, &out->to[k]) &&
           glms_vec2_distance(out->centre, out->to[k]) > SHORTEST * ARROW_TO * gizmo->scale;
}

bool tl_gizmo_draw(const struct tl_gizmo *gizmo, struct tl_gizmo_drawing *out)
{
    const struct tl_view view = view_of(gizmo);
    const float pixel_m = gizmo->scale * metres_per_pixel(gizmo, &view), depth = depth_of(gizmo, &view);
    const float box = BOX * gizmo->scale * gizmo->stretch;
    if (!(depth > view.near_m) || !see(gizmo, &view, gizmo->pivot, 1, &out->centre))
        return false;
    out->half_side = HALF_SIDE * gizmo->scale;
    out->box = glms_vec2_add(out->centre, (vec2s){{box, -box}});
    for (int k = 0; k < 3; k++)
        out->has_arrow[k] = draw_arrow(gizmo, &view, k, pixel_m, out);
    for (int i = 0; i < TL_GIZMO_RING_POINTS; i++) {
        float angle = 2 * (float)M_PI * (float)i / (TL_GIZMO_RING_POINTS - 1);
        vec3s point = ring_point(gizmo, RING * pixel_m, angle);
        if (!see(gizmo, &view, point, 1, &out->ring[i]))
            return false; /* the eye is within the ring */
        out->is_far[i] = glms_vec3_dot(glms_vec3_sub(point, view.eye), view.forward) > depth;
    }
    return true;
}

static float distance_to_segment(vec2s at, vec2s from, vec2s to)
{
    vec2s along = glms_vec2_sub(to, from);
    float length2 = glms_vec2_dot(along, along);
    float share = length2 > 0 ? glms_vec2_dot(glms_vec2_sub(at, from), along) / length2 : 0;
    return glms_vec2_distance(at, glms_vec2_lerp(from, to, fminf(fmaxf(share, 0), 1)));
}

static float distance_to_ring(const struct tl_gizmo_drawing *drawing, vec2s at)
{
    float nearest = INFINITY;
    for (int i = 0; i + 1 < TL_GIZMO_RING_POINTS; i++)
        nearest = fminf(nearest, distance_to_segment(at, drawing->ring[i], drawing->ring[i + 1]));
    return nearest;
}

enum tl_gizmo_handle tl_gizmo_under(const struct tl_gizmo *gizmo, vec2s at)
{
    struct tl_gizmo_drawing drawing;
    if (!tl_gizmo_draw(gizmo, &drawing))
        return TL_GIZMO_NONE;
    float distances[TL_GIZMO_COUNT] = {
        [TL_GIZMO_VIEW] = fmaxf(0, glms_vec2_distance(at, drawing.centre) - drawing.half_side),
        [TL_GIZMO_SIZE] = fmaxf(0, glms_vec2_distance(at, drawing.box) - drawing.half_side),
        [TL_GIZMO_TURN] = distance_to_ring(&drawing, at),
    };
    for (int k = 0; k < 3; k++)
        distances[TL_GIZMO_X + k] =
            drawing.has_arrow[k] ? distance_to_segment(at, drawing.from[k], drawing.to[k]) : INFINITY;
    enum tl_gizmo_handle nearest = TL_GIZMO_NONE;
    float reach = REACH * gizmo->scale;
    for (int handle = TL_GIZMO_X; handle < TL_GIZMO_COUNT; handle++)
        if (distances[handle] < reach) {
            nearest = (enum tl_gizmo_handle)handle;
            reach = distances[handle];
        }
    return nearest;
}

/* ---- Drags ---- */

bool tl_gizmo_nearest_on_axis(const struct tl_ray *ray, vec3s point, vec3s axis, float *parameter)
{
    vec3s offset = glms_vec3_sub(point, ray->origin);
    float cosine = glms_vec3_dot(axis, ray->direction), sine2 = 1 - cosine * cosine;
    if (!(sine2 > 1e-6f))
        return false;
    *parameter = (cosine * glms_vec3_dot(ray->direction, offset) - glms_vec3_dot(axis, offset)) / sine2;
    return true;
}

bool tl_gizmo_on_plane(const struct tl_ray *ray, vec3s point, vec3s normal, vec3s *hit)
{
    float slope = glms_vec3_dot(ray->direction, normal);
    if (!(fabsf(slope) > 1e-6f))
        return false;
    float distance = glms_vec3_dot(glms_vec3_sub(point, ray->origin), normal) / slope;
    *hit = glms_vec3_muladds(ray->direction, distance, ray->origin);
    return distance > 0;
}

/* The axis's parameter under a pixel, which is first projected onto the axis as it is seen, and kept short of
 * the axis's vanishing point. */
static float parameter_under(const struct tl_gizmo *gizmo, const struct tl_view *view, int k, vec2s pixel)
{
    const float before_end = 0.95f;
    struct tl_gizmo_drawing drawing;
    vec2s end;
    float parameter = 0;
    if (!tl_gizmo_draw(gizmo, &drawing) || !drawing.has_arrow[k])
        return 0;
    vec2s along = glms_vec2_normalize(glms_vec2_sub(drawing.to[k], drawing.centre));
    float length = glms_vec2_dot(glms_vec2_sub(pixel, drawing.centre), along);
    if (see(gizmo, view, axes[k], 0, &end))
        length = fminf(length, before_end * glms_vec2_dot(glms_vec2_sub(end, drawing.centre), along));
    else if (see(gizmo, view, glms_vec3_negate(axes[k]), 0, &end))
        length = fmaxf(length, before_end * glms_vec2_dot(glms_vec2_sub(end, drawing.centre), along));
    vec2s on_axis = glms_vec2_add(drawing.centre, glms_vec2_scale(along, length));
    const struct tl_ray ray = ray_through(gizmo, on_axis);
    tl_gizmo_nearest_on_axis(&ray, gizmo->pivot, axes[k], &parameter);
    return parameter;
}

static vec3s drag_in_view(const struct tl_gizmo *gizmo, const struct tl_view *view, vec2s from, vec2s to)
{
    const struct tl_ray first = ray_through(gizmo, from), last = ray_through(gizmo, to);
    vec3s start, end;
    if (!tl_gizmo_on_plane(&first, gizmo->pivot, view->forward, &start) ||
        !tl_gizmo_on_plane(&last, gizmo->pivot, view->forward, &end))
        return glms_vec3_zero();
    return glms_vec3_sub(end, start);
}

/* Angle about the vertical from +Z towards +X of the ring's plane under a pixel. */
static bool angle_under(const struct tl_gizmo *gizmo, vec2s pixel, float *angle)
{
    const struct tl_ray ray = ray_through(gizmo, pixel);
    vec3s hit;
    if (!tl_gizmo_on_plane(&ray, gizmo->pivot, vertical, &hit))
        return false;
    *angle = atan2f(hit.x - gizmo->pivot.x, hit.z - gizmo->pivot.z);
    return true;
}

/* The ring's segment nearest to the drag's start, as it is seen: the direction in which the angle grows.
 * Where both sides are as near, it is the near side's. */
static vec2s tangent_at(const struct tl_gizmo *gizmo, vec2s from)
{
    const float farther = 2; /* pixels */
    struct tl_gizmo_drawing drawing;
    float nearest = INFINITY;
    int best = 0;
    if (!tl_gizmo_draw(gizmo, &drawing))
        return glms_vec2_zero();
    for (int i = 0; i + 1 < TL_GIZMO_RING_POINTS; i++) {
        float distance = distance_to_segment(from, drawing.ring[i], drawing.ring[i + 1]);
        distance += drawing.is_far[i] ? farther * gizmo->scale : 0;
        if (distance < nearest) {
            nearest = distance;
            best = i;
        }
    }
    return glms_vec2_normalize(glms_vec2_sub(drawing.ring[best + 1], drawing.ring[best]));
}

static float drag_ring(const struct tl_gizmo *gizmo, const struct tl_view *view, vec2s from, vec2s to)
{
    vec3s line_of_view = glms_vec3_normalize(glms_vec3_sub(gizmo->pivot, view->eye));
    float start, end;
    if (fabsf(line_of_view.y) < FLAT)
        return glm_deg(glms_vec2_dot(glms_vec2_sub(to, from), tangent_at(gizmo, from)) /
                       (RING * gizmo->scale));
    if (!angle_under(gizmo, from, &start) || !angle_under(gizmo, to, &end))
        return 0;
    float turn_deg = glm_deg(end - start);
    return turn_deg - 360 * floorf((turn_deg + 180) / 360);
}

static float drag_box(vec2s centre, vec2s from, vec2s to)
{
    const float smallest = 0.05f, largest = 20;
    vec2s start = glms_vec2_sub(from, centre);
    float length2 = glms_vec2_dot(start, start);
    float factor = length2 > 0 ? glms_vec2_dot(glms_vec2_sub(to, centre), start) / length2 : 1;
    return fminf(fmaxf(factor, smallest), largest);
}

struct tl_gizmo_change tl_gizmo_drag(const struct tl_gizmo *gizmo, enum tl_gizmo_handle handle, vec2s from,
                                     vec2s to)
{
    const struct tl_view view = view_of(gizmo);
    struct tl_gizmo_change change = {.factor = 1};
    vec2s centre;
    switch (handle) {
    case TL_GIZMO_X:
    case TL_GIZMO_Y:
    case TL_GIZMO_Z: {
        int k = (int)handle - TL_GIZMO_X;
        change.move_m.raw[k] = parameter_under(gizmo, &view, k, to) - parameter_under(gizmo, &view, k, from);
        break;
    }
    case TL_GIZMO_VIEW:
        change.move_m = drag_in_view(gizmo, &view, from, to);
        break;
    case TL_GIZMO_TURN:
        change.turn_deg = drag_ring(gizmo, &view, from, to);
        break;
    case TL_GIZMO_SIZE:
        if (see(gizmo, &view, gizmo->pivot, 1, &centre))
            change.factor = drag_box(centre, from, to);
        break;
    case TL_GIZMO_NONE:
    case TL_GIZMO_COUNT:
        break;
    }
    return change;
}

static float whole_steps(float value, float step)
{
    return roundf(value / step) * step;
}

struct tl_gizmo_change tl_gizmo_snap(const struct tl_gizmo_change *change)
{
    const float move_m = 0.01f, turn_deg = 15, size = 0.05f;
    struct tl_gizmo_change snapped = {.turn_deg = whole_steps(change->turn_deg, turn_deg),
                                      .factor = fmaxf(whole_steps(change->factor, size), size)};
    for (int k = 0; k < 3; k++)
        snapped.move_m.raw[k] = whole_steps(change->move_m.raw[k], move_m);
    return snapped;
}
