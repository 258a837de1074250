#include "render/brdf/brdf.h"

#include "render/brdf/brdf_internal.h"
#include "render/env/exponent.h"

#include <math.h>

#define LEAST_WIDTH 1e-3f
#define PI          ((float)M_PI)

static float finite_or(float x, float otherwise)
{
    return isfinite(x) ? x : otherwise;
}

static float width_of(float width, float exponent)
{
    float from_exponent = sqrtf(2 / (4 * exponent + 2));
    return fminf(fmaxf(width > 0 ? width : from_exponent, LEAST_WIDTH), 1);
}

struct tl_brdf tl_brdf_of(const tl_material *material, vec3s f0, float glossiness)
{
    struct tl_brdf brdf = {
        .gloss = material->gloss, .f0 = f0, .exponent = tl_lobe_exponent(finite_or(glossiness, 0))};
    struct tl_gloss *gloss = &brdf.gloss;
    gloss->width_weft = width_of(finite_or(gloss->width_weft, 0), brdf.exponent);
    gloss->width_warp = width_of(finite_or(gloss->width_warp, 0), brdf.exponent);
    gloss->index = gloss->index > 0 ? finite_or(gloss->index, 1) : 1;
    gloss->extinction = fmaxf(finite_or(gloss->extinction, 0), 0);
    for (int c = 0; c < 3; c++)
        brdf.f0.raw[c] = fminf(fmaxf(finite_or(f0.raw[c], 0), 0), 1);
    return brdf;
}

/* Unit and at right angles to the unit normal. */
static vec3s any_tangent(vec3s n)
{
    vec3s axis = fabsf(n.x) < 0.6f ? (vec3s){{1, 0, 0}} : (vec3s){{0, 1, 0}};
    return glms_vec3_normalize(glms_vec3_cross(axis, n));
}

struct tl_brdf_frame tl_brdf_frame_make(vec3s normal, vec3s tangent, float handedness, float rotation)
{
    vec3s t = glms_vec3_sub(tangent, glms_vec3_scale(normal, glms_vec3_dot(normal, tangent)));
    float length = glms_vec3_norm(t);
    t = length > 1e-6f ? glms_vec3_scale(t, 1 / length) : any_tangent(normal);
    vec3s left = glms_vec3_cross(normal, t);
    t = glms_vec3_add(glms_vec3_scale(t, cosf(rotation)), glms_vec3_scale(left, sinf(rotation)));
    vec3s b = glms_vec3_scale(glms_vec3_cross(normal, t), handedness < 0 ? -1.0f : 1.0f);
    return (struct tl_brdf_frame){normal, t, b};
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

/* Near the peak a cosine in float has lost the angle: 1 - cos is below its last digit where the sine is not.
 */
static float power_of(float cosine, float sine_squared, float exponent)
{
    if (cosine <= 0)
        return 0;
    return sine_squared < 0.5f ? expf(exponent / 2 * log1pf(-sine_squared)) : powf(cosine, exponent);
}

float tl_brdf_cosine_power(vec3s a, vec3s b, float exponent)
{
    return power_of(glms_vec3_dot(a, b), glms_vec3_norm2(glms_vec3_cross(a, b)), exponent);
}

/* P: the integral of 2 d exp(-(d/w)^2) cos d sin d / (d w^2) over d in [0, pi/2], which is 1 for narrow
 * facets; met at five Chebyshev nodes of w^2 in [0, 1], within 1e-4. */
static float gaussian_volume(float w2)
{
    return 0.99992717f + w2 * (-0.66309756f + w2 * (0.24115347f + w2 * (-0.02326816f - w2 * 0.00701674f)));
}

float tl_brdf_facets(const struct tl_brdf *brdf, float tangent_squared)
{
    float w2 = brdf->gloss.width_weft * brdf->gloss.width_weft;
    if (brdf->gloss.facets == TL_FACETS_BECKMANN) {
        float rise = 1 + tangent_squared; /* 1 / cos^2 */
        float fall = expf(-tangent_squared / w2);
        return fall > 0 ? fall * rise * rise / (4 * w2) : 0;
    }
    float d = atanf(sqrtf(tangent_squared));
    return expf(-d * d / w2) / (4 * w2 * gaussian_volume(w2));
}

/* Smith's lambda: the share of facets hidden over the share seen. */
static float hidden(float width, float cosine)
{
    float sine = sqrtf(fmaxf(1 - cosine * cosine, 0));
    if (sine <= 0)
        return 0;
    float k = cosine / (width * sine);
    return fmaxf((expf(-k * k) / (k * sqrtf(PI)) - erfcf(k)) / 2, 0);
}

float tl_brdf_smith(const struct tl_brdf *brdf, float cos_a, float cos_b)
{
    float width = brdf->gloss.width_weft;
    return 1 / (1 + hidden(width, cos_a) + hidden(width, cos_b));
}

float tl_brdf_v_grooves(float cos_a, float cos_b, float cos_t, float cos_d)
{
    return fminf(1, 2 * cos_d * fminf(cos_a, cos_b) / cos_t);
}

/* Gamma(z + 1/2) / Gamma(z), z = s/2 + 3/2, by the first terms of its series: within 5e-4 for s >= 1. */
static float thread_scale(float s)
{
    float z = s / 2 + 1.5f;
    return sqrtf(z - 0.25f + 1 / (32 * z)) / (2 * sqrtf(PI));
}

float tl_brdf_lobe_scale(const struct tl_brdf *brdf)
{
    float s = brdf->exponent;
    switch (brdf->gloss.model) {
    case TL_REFLECT_BLINN_PHONG:
        return (4 * s + 2) / (8 * PI);
    case TL_REFLECT_COSINE_LOBE:
        return (s + 2) / (2 * PI);
    case TL_REFLECT_BANKS:
        return thread_scale(s);
    default:
        return (s + 1) / (2 * PI);
    }
}

/* G / (pi cos b), which stays finite where G itself does: both vanish with cos b. */
static float torrance_sparrow(const struct tl_brdf *brdf, const struct tl_brdf_angles *at)
{
    float tangent_squared = (at->h.x * at->h.x + at->h.y * at->h.y) / (at->h.z * at->h.z);
    float masking = brdf->gloss.masking == TL_MASKING_SMITH
                        ? tl_brdf_smith(brdf, at->cos_a, at->cos_b)
                        : tl_brdf_v_grooves(at->cos_a, at->cos_b, at->cos_t, at->h.z);
    return tl_brdf_facets(brdf, tangent_squared) * masking / (PI * at->cos_b);
}

static float ward(const struct tl_brdf *brdf, const struct tl_brdf_angles *at)
{
    float u = brdf->gloss.width_weft, v = brdf->gloss.width_warp;
    float x = at->h.x / (u * at->h.z), y = at->h.y / (v * at->h.z);
    return expf(-(x * x + y * y)) / (4 * PI * u * v) * sqrtf(at->cos_a / at->cos_b);
}

static float half_power(const struct tl_brdf *brdf, const struct tl_brdf_angles *at)
{
    return power_of(at->h.z, at->h.x * at->h.x + at->h.y * at->h.y, 4 * brdf->exponent);
}

float tl_brdf_thread_angle(float t_dot_l, float t_dot_v)
{
    return acosf(fminf(fmaxf(t_dot_l, -1), 1)) + acosf(fminf(fmaxf(t_dot_v, -1), 1)) - PI;
}

static float thread_power(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    float angle = tl_brdf_thread_angle(glms_vec3_dot(frame->tangent, l), glms_vec3_dot(frame->tangent, v));
    float sine = sinf(angle);
    return power_of(cosf(angle), sine * sine, brdf->exponent);
}

/* Without F. */
static float lobe_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame,
                     const struct tl_brdf_angles *at, vec3s l, vec3s v)
{
    switch (brdf->gloss.model) {
    case TL_REFLECT_TORRANCE_SPARROW:
        return torrance_sparrow(brdf, at);
    case TL_REFLECT_WARD:
        return ward(brdf, at);
    case TL_REFLECT_BLINN_PHONG:
        return tl_brdf_lobe_scale(brdf) * half_power(brdf, at);
    case TL_REFLECT_BANKS:
        return tl_brdf_lobe_scale(brdf) * thread_power(brdf, frame, l, v) * at->cos_a;
    case TL_REFLECT_COSINE_LOBE:
        return tl_brdf_lobe_scale(brdf) * at->cos_a *
               tl_brdf_cosine_power(tl_brdf_mirror(frame->normal, v), l, brdf->exponent);
    default:
        return tl_brdf_lobe_scale(brdf) *
               tl_brdf_cosine_power(tl_brdf_mirror(frame->normal, v), l, brdf->exponent);
    }
}

vec3s tl_brdf_gloss(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    struct tl_brdf_angles at = tl_brdf_angles_of(frame, l, v);
    if (!(at.cos_a > 0 && at.cos_b > 0 && at.h.z > 0))
        return (vec3s){{0, 0, 0}};
    bool by_view = brdf->gloss.model == TL_REFLECT_PHONG || brdf->gloss.model == TL_REFLECT_BANKS;
    vec3s reflectance = tl_brdf_fresnel(brdf, by_view ? at.cos_b : at.cos_t);
    float lobe = lobe_of(brdf, frame, &at, l, v);
    return glms_vec3_scale(reflectance, finite_or(lobe, 0));
}
