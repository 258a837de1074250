#include "app/scene/camera.h"

#include <math.h>

#define MARGIN 1.12f

/* Distance at which the box's vertical extent and its widest horizontal radius fit, so that turning does not
 * zoom. */
static float fitting_distance(struct tl_box box, float fov_y, float aspect)
{
    vec3s size = glms_vec3_sub(box.upper, box.lower);
    float half_height = 0.5f * size.y, radius = 0.5f * hypotf(size.x, size.z);
    float tangent = tanf(0.5f * fov_y);
    float for_height = half_height / tangent, for_width = radius / (tangent * aspect);
    return MARGIN * fmaxf(for_height, for_width) + radius;
}

static vec3s target_of(const struct tl_camera_params *params)
{
    return (vec3s){{params->target[0], params->target[1], params->target[2]}};
}

bool tl_camera_is_placed(const struct tl_camera_params *params)
{
    return params->distance_m > 0 && !glms_vec3_eqv(target_of(params), glms_vec3_zero());
}

struct tl_camera tl_camera_frame(const struct tl_camera_params *params, struct tl_box box, float aspect)
{
    float fov_y = glm_rad(params->fov_deg);
    float yaw = glm_rad(params->yaw_deg), pitch = glm_rad(params->pitch_deg);
    bool framed = params->distance_m <= 0;
    vec3s target = tl_camera_is_placed(params) ? target_of(params)
                                               : glms_vec3_scale(glms_vec3_add(box.lower, box.upper), 0.5f);
    float distance = framed ? fitting_distance(box, fov_y, aspect) : params->distance_m;
    vec3s back = {{sinf(yaw) * cosf(pitch), sinf(pitch), cosf(yaw) * cosf(pitch)}};
    float reach = glms_vec3_norm(glms_vec3_sub(box.upper, box.lower));
    return (struct tl_camera){
        .eye = glms_vec3_add(target, glms_vec3_scale(back, distance)),
        .target = target,
        .up = {{-sinf(yaw) * sinf(pitch), cosf(pitch),
                -cosf(yaw) * sinf(pitch)}}, /* never parallel to back */
        .fov_y = fov_y,
        .near_m = fmaxf(0.01f * distance, 1e-4f * reach),
        .far_m = distance + 20 * reach,
    };
}
