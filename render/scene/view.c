#include "render/scene/view.h"

#include <math.h>

#define FOV_MIN           0.001f /* rad */
#define FOV_MAX           3.1f   /* rad */
#define NEAR_MIN          1e-5f  /* metres */
#define FAR_OVER_NEAR_MIN 1.001f /* nearer planes leave depth no steps */

static vec3s direction_or(vec3s v, vec3s fallback)
{
    float length = glms_vec3_norm(v);
    return isfinite(length) && length > 1e-12f ? glms_vec3_divs(v, length) : fallback;
}

struct tl_view tl_view_make(const struct tl_camera *camera, int width, int height)
{
    vec3s forward = direction_or(glms_vec3_sub(camera->target, camera->eye), (vec3s){{0, 0, -1}});
    vec3s sideways = fabsf(forward.y) < 0.99f ? (vec3s){{0, 1, 0}} : (vec3s){{0, 0, -1}};
    vec3s usual_right = glms_vec3_normalize(glms_vec3_cross(forward, sideways));
    vec3s right = direction_or(glms_vec3_cross(forward, camera->up), usual_right);
    vec3s up = glms_vec3_cross(right, forward);

    float fov = fminf(fmaxf(camera->fov_y, FOV_MIN), FOV_MAX);
    float aspect = (float)width / (float)height;
    float near_m = fmaxf(camera->near_m, NEAR_MIN), far_m = fmaxf(camera->far_m, near_m * FAR_OVER_NEAR_MIN);
    mat4s projection = glms_perspective(fov, aspect, near_m, far_m);
    mat4s view = glms_look(camera->eye, forward, up);
    float half_height = tanf(fov / 2);
    return (struct tl_view){.view_projection = glms_mat4_mul(projection, view),
                            .eye = camera->eye,
                            .forward = forward,
                            .right = glms_vec3_scale(right, half_height * aspect),
                            .up = glms_vec3_scale(up, half_height),
                            .near_m = near_m,
                            .far_m = far_m};
}

struct tl_view tl_view_shift(const struct tl_view *view, float right, float up)
{
    struct tl_view shifted = *view;
    /* Clip coordinates are multiples of w: so are the shifts added to them. */
    for (int column = 0; column < 4; column++) {
        float w = view->view_projection.raw[column][3];
        shifted.view_projection.raw[column][0] += right * w;
        shifted.view_projection.raw[column][1] += up * w;
    }
    shifted.forward = glms_vec3_sub(shifted.forward, glms_vec3_scale(view->right, right));
    shifted.forward = glms_vec3_sub(shifted.forward, glms_vec3_scale(view->up, up));
    return shifted;
}

mat3s tl_view_turn(const struct tl_view *view)
{
    vec3s right = glms_vec3_normalize(view->right), up = glms_vec3_normalize(view->up);
    const mat3s columns = {.col = {right, up, glms_vec3_cross(right, up)}};
    return glms_mat3_transpose(columns);
}
