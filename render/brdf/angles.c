#include "render/brdf/angles.h"

#include "render/brdf/facets.h"

#include <math.h>

#define PI ((float)M_PI)

struct tl_brdf_frame tl_brdf_frame_make(vec3s normal, vec3s tangent, float handedness, float rotation)
{
    const vec3s t = thread_direction(normal, tangent, cosf(rotation), sinf(rotation));
    return (struct tl_brdf_frame){normal, t,
                                  glms_vec3_scale(glms_vec3_cross(normal, t), handedness < 0 ? -1.0f : 1.0f)};
}

struct tl_brdf_angles tl_brdf_angles_of(const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    struct tl_brdf_angles angles = {.cos_a = glms_vec3_dot(frame->normal, l),
                                    .cos_b = glms_vec3_dot(frame->normal, v)};
    vec3s sum = glms_vec3_add(l, v);
    float length = glms_vec3_norm(sum);
    if (length < 1e-7f)
        return angles;
    vec3s h = glms_vec3_scale(sum, 1 / length);
    angles.cos_t = fminf(length / 2, 1); /* |l + v| = 2 cos t */
    angles.h = (vec3s){{glms_vec3_dot(frame->tangent, h), glms_vec3_dot(frame->bitangent, h),
                        glms_vec3_dot(frame->normal, h)}};
    return angles;
}

vec3s tl_brdf_mirror(vec3s normal, vec3s v)
{
    return glms_vec3_sub(glms_vec3_scale(normal, 2 * glms_vec3_dot(normal, v)), v);
}

/* cosine^exponent. Near the peak 1 - cosine is below float's last digit, where the squared sine still has all
 * of its digits; there cos^s = exp(s/2 log(1 - sin^2)) is used. */
float tl_cosine_power(float cosine, float sine_squared, float exponent)
{
    if (cosine <= 0)
        return 0;
    return sine_squared < 0.5f ? expf(exponent / 2 * log1pf(-sine_squared)) : powf(cosine, exponent);
}

float tl_brdf_cosine_power(vec3s a, vec3s b, float exponent)
{
    return tl_cosine_power(glms_vec3_dot(a, b), glms_vec3_norm2(glms_vec3_cross(a, b)), exponent);
}

float tl_brdf_thread_angle(float t_dot_l, float t_dot_v)
{
    return acosf(fminf(fmaxf(t_dot_l, -1), 1)) + acosf(fminf(fmaxf(t_dot_v, -1), 1)) - PI;
}
