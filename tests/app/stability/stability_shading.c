/* The extremes of shading: every reflectance model under lights and degenerate views, from the
 * dullest gloss to the sharpest. Below the surface no light is sent back at all; above it what is sent is
 * compared with the formula (render/brdf/brdf.h) in double precision: the error is a share of that, and
 * absolute in 1/sr. Light below a millionth of the peak counts as none. */
#include "app/lab/experiments/experiment.h"
#include "config/base/memory.h"
#include "render/brdf/brdf.h"
#include "tests/app/stability/stability.h"

#include <math.h>

#define ROUNDING 1e-3 /* of a float: the share of what is right within which it is exact */
#define BLACK    1e-6 /* of the peak */
#define STEPS    2000 /* of an integral */

static const float glossinesses[] = {0, 0.5f, 0.99f, 0.999999f, 1};

static const struct shading_extreme {
    const char *name;
    vec3s normal, tangent, light, viewer;
} extremes[] = {
    {"light, view and normal equal", {{0, 0, 1}}, {{1, 0, 0}}, {{0, 0, 1}}, {{0, 0, 1}}},
    {"light opposite to the view", {{0, 0, 1}}, {{1, 0, 0}}, {{1, 0, 0}}, {{-1, 0, 0}}},
    {"light in the surface", {{0, 0, 1}}, {{1, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}},
    {"view in the surface", {{0, 0, 1}}, {{1, 0, 0}}, {{0, 0, 1}}, {{1, 0, 0}}},
    {"both nearly in the surface", {{0, 0, 1}}, {{1, 0, 0}}, {{1, 0, 1e-6f}}, {{-1, 0, 1e-6f}}},
    {"view from below", {{0, 0, 1}}, {{1, 0, 0}}, {{0, 0, 1}}, {{0, 0, -1}}},
    {"light from below", {{0, 0, 1}}, {{1, 0, 0}}, {{0.6f, 0, -0.8f}}, {{0, 0, 1}}},
    {"normal of length 0", {{0, 0, 0}}, {{1, 0, 0}}, {{0, 0.6f, 0.8f}}, {{0, 0, 1}}},
    {"no tangent", {{0, 0, 1}}, {{0, 0, 0}}, {{0, 0.6f, 0.8f}}, {{0, 0, 1}}},
    {"tangent along the normal", {{0, 0, 1}}, {{0, 0, 1}}, {{0, 0.6f, 0.8f}}, {{0, 0, 1}}},
};

/* The largest that f_r cos a can be with cosines a and b of light and viewer. */
static double peak_of(const struct tl_brdf *brdf, double a, double b)
{
    switch (brdf->gloss.model) {
    case TL_REFLECT_TORRANCE_SPARROW:
        return (double)tl_brdf_facets(brdf, 0) / (M_PI * b);
    case TL_REFLECT_WARD:
        return sqrt(a / b) / (4 * M_PI * (double)brdf->gloss.width_weft * (double)brdf->gloss.width_warp);
    default:
        return (double)tl_brdf_lobe_scale(brdf);
    }
}

struct triple {
    double x, y, z;
};

static double dot(struct triple a, struct triple b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct triple unit(vec3s v)
{
    struct triple d = {(double)v.x, (double)v.y, (double)v.z};
    double length = sqrt(dot(d, d));
    return (struct triple){d.x / length, d.y / length, d.z / length};
}

/* The integral of D cos d of Gaussian facets of squared width `w2` without its factor, over pi; nothing is
 * left of them beyond eight widths. */
static double gaussian_volume(double w2)
{
    double sum = 0, step = fmin(M_PI / 2, 8 * sqrt(w2)) / STEPS;
    for (int i = 0; i < STEPS; i++) {
        double d = (i + 0.5) * step;
        sum += exp(-d * d / w2) * 2 * sin(d) * cos(d) * step;
    }
    return sum;
}

static double smith_lambda(double width, double cosine)
{
    double k = cosine / (width * sqrt(fmax(1 - cosine * cosine, 0)));
    return isfinite(k) ? fmax((exp(-k * k) / (k * sqrt(M_PI)) - erfc(k)) / 2, 0) : 0;
}

/* f_r cos a of a default material's model: Gaussian facets, Smith's masking, Ward's as published, Schlick's
 * Fresnel term. */
static double formula(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, struct triple l,
                      struct triple v)
{
    struct triple n = unit(frame->normal), t = unit(frame->tangent), b = unit(frame->bitangent);
    double cos_a = dot(n, l), cos_b = dot(n, v), s = (double)brdf->exponent;
    struct triple sum = {l.x + v.x, l.y + v.y, l.z + v.z};
    double length = sqrt(dot(sum, sum)), cos_t = dot(sum, l) / length, cos_d = dot(sum, n) / length;
    double mirrored = 2 * cos_a * cos_b - dot(l, v), tl = dot(t, l), tv = dot(t, v);
    double w = (double)brdf->gloss.width_weft, across = (double)brdf->gloss.width_warp;
    double x = dot(sum, t) / (length * cos_d), y = dot(sum, b) / (length * cos_d), d = acos(fmin(cos_d, 1));
    bool by_view = brdf->gloss.model == TL_REFLECT_PHONG || brdf->gloss.model == TL_REFLECT_BANKS;
    double f0 = (double)brdf->f0.x, f90 = fmin(50 * f0, 1);
    double fresnel = f0 + (f90 - f0) * pow(1 - (by_view ? cos_b : cos_t), 5);
    switch (brdf->gloss.model) {
    case TL_REFLECT_PHONG:
        return fresnel * (s + 1) / (2 * M_PI) * pow(fmax(mirrored, 0), s);
    case TL_REFLECT_COSINE_LOBE:
        return fresnel * (s + 2) / (2 * M_PI) * pow(fmax(mirrored, 0), s) * cos_a;
    case TL_REFLECT_BLINN_PHONG:
        return fresnel * (4 * s + 2) / (8 * M_PI) * pow(cos_d, 4 * s);
    case TL_REFLECT_TORRANCE_SPARROW:
        return fresnel * exp(-d * d / (w * w)) / (4 * gaussian_volume(w * w)) /
               (1 + smith_lambda(w, cos_a) + smith_lambda(w, cos_b)) / (M_PI * cos_b);
    case TL_REFLECT_WARD:
        return fresnel * exp(-(x * x / (w * w) + y * y / (across * across))) / (4 * M_PI * w * across) *
               sqrt(cos_a / cos_b);
    default: /* BANKS */
        return fresnel * exp(lgamma(s / 2 + 2) - lgamma(s / 2 + 1.5)) / (2 * sqrt(M_PI)) * cos_a *
               pow(fmax(sqrt((1 - tl * tl) * (1 - tv * tv)) - tl * tv, 0), s);
    }
}

static struct tl_cell_error measure(double sent, double right, double peak)
{
    struct tl_cell_error error = {.own = fabs(sent - right), .unit = "1/sr"};
    error.share = error.own > 0 ? error.own / fmax(fabs(right), BLACK * peak) : 0;
    return error;
}

static void run_cell(const struct shading_extreme *extreme, int model, const char *name, float glossiness,
                     struct tl_stability *out)
{
    tl_material material = tl_material_default("extreme");
    material.gloss.model = model;
    const struct tl_brdf brdf = tl_brdf_of(&material, (vec3s){{1, 1, 1}}, glossiness);
    const struct tl_brdf_frame frame = tl_brdf_frame_make(extreme->normal, extreme->tangent, 1, 0);
    vec3s l = glms_vec3_normalize(extreme->light), v = glms_vec3_normalize(extreme->viewer);
    double a = (double)glms_vec3_dot(frame.normal, l), b = (double)glms_vec3_dot(frame.normal, v);
    bool dark = !(a > 0 && b > 0);
    double peak = dark ? 0 : peak_of(&brdf, a, b), sent = (double)tl_brdf_gloss(&brdf, &frame, l, v).x;
    double right = dark ? 0 : formula(&brdf, &frame, unit(extreme->light), unit(extreme->viewer));
    struct tl_cell_error error = measure(sent, right, peak);
    enum tl_outcome outcome = tl_outcome_of(error.share, ROUNDING, TL_STATED_SHARE);
    if (isfinite(sent) && !(sent >= 0 && sent <= peak * (1 + ROUNDING)))
        outcome = TL_OUTCOME_SILENT;
    cJSON *row = tl_stability_add(out, "shading", outcome, &error);
    cJSON_AddStringToObject(row, "extreme", extreme->name);
    cJSON_AddStringToObject(row, "method", name);
    cJSON_AddNumberToObject(row, "glossiness", (double)glossiness);
    cJSON_AddNumberToObject(row, "sent", isfinite(sent) ? sent : -1);
    cJSON_AddNumberToObject(row, "bound", peak);
}

bool tl_stability_shading(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    const char *const *models = tl_experiment_choices(&tl_material_options, "model");
    (void)arguments;
    (void)error;
    for (size_t e = 0; e < TL_COUNT(extremes); e++)
        for (int model = 0; models[model]; model++)
            for (size_t g = 0; g < TL_COUNT(glossinesses); g++)
                run_cell(&extremes[e], model, models[model], glossinesses[g], out);
    return true;
}
