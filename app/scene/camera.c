#include "app/scene/camera.h"

#include <math.h>

#define WIDEST 0.9f /* share of the frame's width that may be filled */

/* The axes of a picture: across it, upwards, and towards the eye. */
struct axes {
    vec3s across, up, back;
};

static struct axes axes_of(const struct tl_camera_params *params)
{
    float yaw = glm_rad(params->yaw_deg), pitch = glm_rad(params->pitch_deg);
    return (struct axes){.across = {{cosf(yaw), 0, -sinf(yaw)}},
                         .up = {{-sinf(yaw) * sinf(pitch), cosf(pitch), -cosf(yaw) * sinf(pitch)}},
                         .back = {{sinf(yaw) * cosf(pitch), sinf(pitch), cosf(yaw) * cosf(pitch)}}};
}

struct tl_framing tl_framing_of_box(struct tl_box box, float share)
{
    struct tl_framing framing = {.box = box, .share = share, .count = TL_FRAMING_POINTS};
    float radius = 0.5f * hypotf(box.upper.x - box.lower.x, box.upper.z - box.lower.z);
    for (int i = 0; i < TL_FRAMING_POINTS; i++) {
        float angle = 4 * (float)M_PI * (float)(i / 2) / TL_FRAMING_POINTS;
        framing.points[i] = (vec3s){{0.5f * (box.lower.x + box.upper.x) + radius * sinf(angle),
                                     i % 2 ? box.upper.y : box.lower.y,
                                     0.5f * (box.lower.z + box.upper.z) + radius * cosf(angle)}};
    }
    return framing;
}

/* The i-th of directions that are spread evenly over the sphere [Vogel's spiral]. */
static vec3s spread_direction(int i)
{
    float height = 1 - 2 * ((float)i + 0.5f) / TL_FRAMING_POINTS, angle = 2.39996323f * (float)i;
    float across = sqrtf(1 - height * height);
    return (vec3s){{across * sinf(angle), height, across * cosf(angle)}};
}

/* Keeps the most distant of the points, and of those that are kept, in each direction. */
static int keep_furthest(vec3s kept[TL_FRAMING_POINTS], int kept_count, const vec3s *points, size_t count)
{
    for (int i = 0; count > 0 && i < TL_FRAMING_POINTS; i++) {
        vec3s direction = spread_direction(i), *furthest = &kept[i];
        if (kept_count == 0)
            *furthest = points[0];
        for (size_t k = 0; k < count; k++)
            if (glms_vec3_dot(points[k], direction) > glms_vec3_dot(*furthest, direction))
                *furthest = points[k];
    }
    return count > 0 ? TL_FRAMING_POINTS : kept_count;
}

void tl_framing_add(struct tl_framing *framing, const vec3s *points, size_t count)
{
    struct tl_box box = tl_box_of(points, count);
    framing->box = framing->count > 0 ? tl_box_of_both(framing->box, box) : box;
    framing->count = keep_furthest(framing->points, framing->count, points, count);
}

void tl_framing_add_head(struct tl_framing *framing, const vec3s *points, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (points[k].y > framing->box.upper.y)
            framing->head_count = keep_furthest(framing->head, framing->head_count, &points[k], 1);
}

/* Places in the picture seen from a distance of the box's middle, in half heights from its centre. */
struct picture_extent {
    float lowest, highest, widest;
};

static struct picture_extent extent_of(const vec3s *points, int count, const struct axes *axes, vec3s middle,
                                       float distance, float tangent)
{
    struct picture_extent extent = {INFINITY, -INFINITY, 0};
    for (int i = 0; i < count; i++) {
        vec3s from = glms_vec3_sub(points[i], middle);
        float reach = (distance - glms_vec3_dot(from, axes->back)) * tangent;
        float up = glms_vec3_dot(from, axes->up) / reach;
        extent.lowest = fminf(extent.lowest, up);
        extent.highest = fmaxf(extent.highest, up);
        extent.widest = fmaxf(extent.widest, fabsf(glms_vec3_dot(from, axes->across)) / reach);
    }
    return extent;
}

/* Share of the allowed part of the picture that is filled. */
static float fill_of(const struct tl_framing *framing, const struct axes *axes, vec3s middle, float distance,
                     float tangent, float aspect)
{
    struct picture_extent own = extent_of(framing->points, framing->count, axes, middle, distance, tangent),
                          head =
                              extent_of(framing->head, framing->head_count, axes, middle, distance, tangent);
    float fill = fmaxf(0.5f * (own.highest - own.lowest) / framing->share, own.widest / (aspect * WIDEST));
    return fmaxf(fill, 0.5f * (head.highest - own.lowest) / TL_CAMERA_BODY);
}

/* The box's middle, or a point above it from which what stands out above is in the picture. */
static vec3s middle_of(const struct tl_framing *framing, const struct axes *axes, vec3s middle,
                       float distance, float tangent)
{
    struct picture_extent head =
        extent_of(framing->head, framing->head_count, axes, middle, distance, tangent);
    float above = fmaxf(head.highest - TL_CAMERA_BODY, 0) * distance * tangent;
    return glms_vec3_add(middle, glms_vec3_scale(axes->up, above));
}

static float fitting_distance(const struct tl_framing *framing, const struct axes *axes, vec3s middle,
                              float fov_y, float aspect)
{
    float tangent = tanf(0.5f * fov_y), near = 0;
    for (int i = 0; i < framing->count; i++)
        near = fmaxf(near, glms_vec3_norm(glms_vec3_sub(framing->points[i], middle)));
    float far = near * (1 + 2 / (tangent * fminf(framing->share, fminf(aspect, 1) * WIDEST)));
    for (int i = 0; i < 30; i++) { /* the nearer, the more is filled */
        float between = 0.5f * (near + far);
        *(fill_of(framing, axes, middle, between, tangent, aspect) > 1 ? &near : &far) = between;
    }
    return far;
}

static vec3s target_of(const struct tl_camera_params *params)
{
    return (vec3s){{params->target[0], params->target[1], params->target[2]}};
}

bool tl_camera_is_placed(const struct tl_camera_params *params)
{
    return params->distance_m > 0 && !glms_vec3_eqv(target_of(params), glms_vec3_zero());
}

struct tl_camera tl_camera_frame(const struct tl_camera_params *params, const struct tl_framing *framing,
                                 float aspect)
{
    float fov_y = glm_rad(params->fov_deg);
    struct axes axes = axes_of(params);
    bool framed = params->distance_m <= 0;
    vec3s middle = glms_vec3_scale(glms_vec3_add(framing->box.lower, framing->box.upper), 0.5f);
    float distance = framed ? fitting_distance(framing, &axes, middle, fov_y, aspect) : params->distance_m;
    if (framed)
        middle = middle_of(framing, &axes, middle, distance, tanf(0.5f * fov_y));
    vec3s target = tl_camera_is_placed(params) ? target_of(params) : middle;
    float reach = glms_vec3_norm(glms_vec3_sub(framing->box.upper, framing->box.lower));
    return (struct tl_camera){
        .eye = glms_vec3_add(target, glms_vec3_scale(axes.back, distance)),
        .target = target,
        .up = axes.up, /* never parallel to back */
        .fov_y = fov_y,
        .near_m = fmaxf(0.01f * distance, 1e-4f * reach),
        .far_m = distance + 20 * reach,
    };
}
