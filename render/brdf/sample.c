#include "render/brdf/brdf.h"
#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/brdf/sample_terms.glsl"

#include "render/gpu/terms_end.h"

#include <math.h>

#define PI ((float)M_PI)

static bool has_facets(const struct tl_brdf *brdf)
{
    return brdf->gloss.model == TL_REFLECT_BLINN_PHONG || brdf->gloss.model == TL_REFLECT_TORRANCE_SPARROW ||
           brdf->gloss.model == TL_REFLECT_WARD;
}

static vec3s from_frame(const struct tl_brdf_frame *frame, float x, float y, float z)
{
    vec3s flat = glms_vec3_add(glms_vec3_scale(frame->tangent, x), glms_vec3_scale(frame->bitangent, y));
    return glms_vec3_add(flat, glms_vec3_scale(frame->normal, z));
}

/* The part of the integral of the Gaussian of an angle that lies below a right angle. */
static float gaussian_share(float width)
{
    float end = PI / 2 / width;
    return 1 - expf(-end * end);
}

static bool has_gaussian_slopes(const struct tl_gloss *gloss)
{
    return gloss->model == TL_REFLECT_WARD ||
           (gloss->model == TL_REFLECT_TORRANCE_SPARROW && gloss->facets == TL_FACETS_BECKMANN);
}

static vec3s squares_of(const struct tl_gloss *gloss)
{
    const float across = gloss->model == TL_REFLECT_WARD ? gloss->width_warp : gloss->width_weft;
    return (vec3s){{gloss->width_weft * gloss->width_weft, across * across, 0}};
}

/* Samples a half vector, in the frame, by inverting the cumulative distribution of each model. Slopes are
 * Gaussian for Ward and Beckmann facets, and follow a distribution with long tails for GGX; the angle is
 * Gaussian for Gaussian facets; Blinn-Phong is a power of the cosine. */
static vec3s sample_half_vector(const struct tl_brdf *brdf, float u1, float u2)
{
    const struct tl_gloss *gloss = &brdf->gloss;
    float c = cosf(2 * PI * u2), s = sinf(2 * PI * u2), x, y, z;
    if (has_gaussian_slopes(gloss)) {
        const vec2s slope = facet_slope(squares_of(gloss), u1, u2);
        return glms_vec3_normalize((vec3s){{slope.x, slope.y, 1}});
    }
    if (gloss->model == TL_REFLECT_BLINN_PHONG) {
        z = powf(1 - u1, 1 / (4 * brdf->exponent + 1));
        float radius = sqrtf(
            fmaxf(-expm1f(2 * log1pf(-u1) / (4 * brdf->exponent + 1)), 0)); /* 1 - z^2 without cancellation */
        x = radius * c, y = radius * s;
    } else if (gloss->model == TL_REFLECT_TORRANCE_SPARROW && gloss->facets == TL_FACETS_GAUSSIAN) {
        float angle = gloss->width_weft * sqrtf(-log1pf(-u1 * gaussian_share(gloss->width_weft)));
        x = sinf(angle) * c, y = sinf(angle) * s, z = cosf(angle);
    } else {
        float slope = gloss->width_weft * sqrtf(u1 / (1 - u1));
        z = 1 / sqrtf(1 + slope * slope);
        x = slope * z * c, y = slope * z * s;
    }
    return (vec3s){{x, y, z}};
}

/* The pdf of a half vector, by its solid angle. */
static float half_vector_pdf(const struct tl_brdf *brdf, vec3s h)
{
    const struct tl_gloss *gloss = &brdf->gloss;
    float sine = hypotf(h.x, h.y);
    if (!(h.z > 0))
        return 0;
    if (gloss->model == TL_REFLECT_BLINN_PHONG) {
        vec3s up = {{0, 0, 1}};
        return (4 * brdf->exponent + 1) / (2 * PI) * tl_brdf_cosine_power(h, up, 4 * brdf->exponent);
    }
    if (has_gaussian_slopes(gloss))
        return facet_slope_pdf(squares_of(gloss), h);
    float u = gloss->width_weft;
    if (gloss->facets == TL_FACETS_GAUSSIAN) {
        float angle = atan2f(sine, h.z);
        float spread = sine > 1e-4f ? angle / sine : 1;
        return spread * expf(-angle * angle / (u * u)) / (PI * u * u * gaussian_share(u));
    }
    float slope = sine / (u * h.z), square = 1 + slope * slope, fall = 1 / (square * square);
    return fall > 0 ? fall / (PI * u * u * h.z * h.z * h.z) : 0;
}

/* Distribution of the angle from a thread's mirror cone: logistic, of width 0.6/sqrt(s), truncated where the
 * angle to the thread leaves [0, pi]. A logistic is invertible in closed form and its tails are heavier than
 * those of cos^s, so that no weight grows without bound. */
struct sampling_cone {
    float mirror, scale, low,
        high; /* the cone's angle to the thread and the width, rad; cumulative distribution at both ends */
};

static float logistic(float x)
{
    return 1 / (1 + expf(-x));
}

static struct sampling_cone cone_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v)
{
    float t_dot_v = fminf(fmaxf(glms_vec3_dot(frame->tangent, v), -1), 1);
    struct sampling_cone cone = {.mirror = PI - acosf(t_dot_v), .scale = 0.6f / sqrtf(brdf->exponent)};
    cone.low = logistic(-cone.mirror / cone.scale);
    cone.high = logistic((PI - cone.mirror) / cone.scale);
    return cone;
}

static vec3s sample_cone(const struct sampling_cone *cone, const struct tl_brdf_frame *frame, float u1,
                         float u2)
{
    float share = cone->low + u1 * (cone->high - cone->low);
    share = fminf(fmaxf(share, 1e-7f), 1 - 1e-7f);
    float angle = cone->mirror + cone->scale * logf(share / (1 - share));
    angle = fminf(fmaxf(angle, 0), PI);
    float across = 2 * u2 - 1, sine = sinf(angle);
    return from_frame(frame, cosf(angle), sine * across, sine * sqrtf(fmaxf(1 - across * across, 0)));
}

static float cone_pdf(const struct sampling_cone *cone, const struct tl_brdf_frame *frame, vec3s l)
{
    float along = fminf(fmaxf(glms_vec3_dot(frame->tangent, l), -1), 1);
    float sine_squared = 1 - along * along, up = glms_vec3_dot(frame->normal, l);
    if (!(sine_squared > 1e-12f && up > 0))
        return 0;
    float share = logistic((acosf(along) - cone->mirror) / cone->scale);
    float by_angle = share * (1 - share) / (cone->scale * (cone->high - cone->low));
    return by_angle * up / (2 * sine_squared);
}

float tl_brdf_pdf(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    const struct tl_brdf_frame own = tl_brdf_own_frame(brdf, frame);
    struct tl_brdf_angles at = tl_brdf_angles_of(&own, l, v);
    if (!(at.cos_a > 0 && at.cos_b > 0))
        return 0;
    if (brdf->gloss.model == TL_REFLECT_BANKS) {
        struct sampling_cone cone = cone_of(brdf, frame, v);
        return cone_pdf(&cone, frame, l);
    }
    if (has_facets(brdf))
        return at.cos_t > 0 ? half_vector_pdf(brdf, at.h) / (4 * at.cos_t) : 0;
    float s = brdf->exponent;
    return (s + 1) / (2 * PI) * tl_brdf_cosine_power(tl_brdf_mirror(frame->normal, v), l, s);
}

vec3s tl_brdf_sample(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, float u1,
                     float u2, float *pdf)
{
    vec3s l;
    if (brdf->gloss.model == TL_REFLECT_BANKS) {
        struct sampling_cone cone = cone_of(brdf, frame, v);
        l = sample_cone(&cone, frame, u1, u2);
    } else if (has_facets(brdf)) {
        vec3s h = sample_half_vector(brdf, u1, u2);
        const struct tl_brdf_frame own = tl_brdf_own_frame(brdf, frame);
        h = from_frame(&own, h.x, h.y, h.z);
        l = tl_brdf_mirror(h, v);
        if (glms_vec3_dot(h, v) <= 0)
            l = glms_vec3_negate(frame->normal);
    } else {
        l = lobe_direction(tl_brdf_mirror(frame->normal, v), lobe_off_axis(brdf->exponent, u1), u2);
    }
    l = glms_vec3_normalize(l);
    *pdf = tl_brdf_pdf(brdf, frame, l, v);
    return l;
}
