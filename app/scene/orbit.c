#include "app/scene/orbit.h"

#include <string.h>

#define PITCH_LIMIT_DEG     89.0f
#define DISTANCE_NEAREST_M  0.05f
#define DISTANCE_FARTHEST_M 100.0f

struct basis {
    vec3s right, up; /* of the image */
};

static struct basis basis_of(const struct tl_camera_params *params)
{
    float yaw = glm_rad(params->yaw_deg), pitch = glm_rad(params->pitch_deg);
    return (struct basis){
        .right = {{cosf(yaw), 0, -sinf(yaw)}},
        .up = {{-sinf(yaw) * sinf(pitch), cosf(pitch), -cosf(yaw) * sinf(pitch)}},
    };
}

static vec3s target_of(const struct tl_camera_params *params)
{
    return (vec3s){{params->target[0], params->target[1], params->target[2]}};
}

static void set_target(struct tl_camera_params *params, vec3s target)
{
    memcpy(params->target, target.raw, sizeof params->target);
}

/* Moves the target by (x, y) view heights, measured at the target's depth. */
static void shift_target(struct tl_camera_params *params, float x, float y)
{
    struct basis basis = basis_of(params);
    float height_m = 2.0f * params->distance_m * tanf(0.5f * glm_rad(params->fov_deg));
    vec3s target = glms_vec3_muladds(basis.right, x * height_m, target_of(params));
    set_target(params, glms_vec3_muladds(basis.up, -y * height_m, target));
}

void tl_orbit_take(struct tl_camera_params *params, const struct tl_camera *framed)
{
    set_target(params, framed->target);
    params->distance_m = glms_vec3_distance(framed->eye, framed->target);
}

float tl_orbit_wrap_deg(float angle_deg)
{
    return angle_deg - 360.0f * floorf((angle_deg + 180.0f) / 360.0f);
}

void tl_orbit_turn(struct tl_camera_params *params, float dx, float dy)
{
    params->yaw_deg = tl_orbit_wrap_deg(params->yaw_deg - dx * TL_ORBIT_DEG_PER_HEIGHT);
    params->pitch_deg =
        glm_clamp(params->pitch_deg + dy * TL_ORBIT_DEG_PER_HEIGHT, -PITCH_LIMIT_DEG, PITCH_LIMIT_DEG);
}

void tl_orbit_pan(struct tl_camera_params *params, float dx, float dy)
{
    shift_target(params, -dx, -dy);
}

void tl_orbit_zoom(struct tl_camera_params *params, float steps, float x, float y)
{
    const float ratio_per_step = 0.875f;
    float distance_m =
        glm_clamp(params->distance_m * powf(ratio_per_step, steps), DISTANCE_NEAREST_M, DISTANCE_FARTHEST_M);
    float kept = 1.0f - distance_m / params->distance_m;
    shift_target(params, x * kept, y * kept);
    params->distance_m = distance_m;
}

void tl_orbit_focus(struct tl_camera_params *params, vec3s point)
{
    set_target(params, point);
    params->distance_m = glm_max(0.5f * params->distance_m, DISTANCE_NEAREST_M);
}

float tl_orbit_angle_between(float from_deg, float to_deg, float share)
{
    if (share >= 1)
        return to_deg;
    return tl_orbit_wrap_deg(from_deg + share * tl_orbit_wrap_deg(to_deg - from_deg));
}

struct tl_camera_params tl_orbit_between(const struct tl_camera_params *from,
                                         const struct tl_camera_params *to, float share)
{
    if (share >= 1)
        return *to;
    struct tl_camera_params between = {
        .yaw_deg = tl_orbit_angle_between(from->yaw_deg, to->yaw_deg, share),
        .pitch_deg = glm_lerp(from->pitch_deg, to->pitch_deg, share),
        .distance_m = from->distance_m * powf(to->distance_m / from->distance_m, share),
        .fov_deg = glm_lerp(from->fov_deg, to->fov_deg, share),
    };
    set_target(&between, glms_vec3_lerp(target_of(from), target_of(to), share));
    return between;
}

struct tl_ray tl_orbit_ray(const struct tl_camera *camera, float x, float y, float width, float height)
{
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    vec3s right = glms_vec3_normalize(glms_vec3_cross(forward, camera->up));
    vec3s up = glms_vec3_cross(right, forward);
    float slope = 2.0f * tanf(0.5f * camera->fov_y);
    vec3s direction = glms_vec3_muladds(right, (x - 0.5f * width) / height * slope, forward);
    direction = glms_vec3_muladds(up, (0.5f * height - y) / height * slope, direction);
    return (struct tl_ray){.origin = camera->eye, .direction = glms_vec3_normalize(direction)};
}
