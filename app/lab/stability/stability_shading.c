/* The extremes of shading: every reflectance model under lights and degenerate views, from the
 * dullest gloss to the sharpest. Below the surface no light is sent back at all; above it never more than the
 * peak of the model's formula (render/brdf/brdf.h) under a Fresnel term of 1. */
#include "app/lab/experiments/experiment.h"
#include "app/lab/stability/stability.h"
#include "config/memory.h"
#include "render/brdf/brdf.h"

#include <math.h>
#include <stdio.h>

#define ROUNDING 1e-3 /* of a float's share of the peak */

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

static void run_cell(const struct shading_extreme *extreme, int model, const char *name, float glossiness,
                     bool prints, struct tl_stability *out)
{
    tl_material material = tl_material_default("extreme");
    material.gloss.model = model;
    const struct tl_brdf brdf = tl_brdf_of(&material, (vec3s){{1, 1, 1}}, glossiness);
    const struct tl_brdf_frame frame = tl_brdf_frame_make(extreme->normal, extreme->tangent, 1, 0);
    vec3s l = glms_vec3_normalize(extreme->light), v = glms_vec3_normalize(extreme->viewer);
    double a = (double)glms_vec3_dot(frame.normal, l), b = (double)glms_vec3_dot(frame.normal, v);
    bool dark = !(a > 0 && b > 0);
    double peak = dark ? 0 : peak_of(&brdf, a, b), sent = (double)tl_brdf_gloss(&brdf, &frame, l, v).x;
    enum tl_outcome outcome = TL_OUTCOME_SILENT;
    if (!isfinite(sent))
        outcome = TL_OUTCOME_NAN;
    else if (sent >= 0 && sent <= peak * (1 + ROUNDING))
        outcome = dark ? TL_OUTCOME_EXACT : TL_OUTCOME_BOUNDED;
    cJSON *row = tl_stability_add(out, "shading", outcome);
    cJSON_AddStringToObject(row, "extreme", extreme->name);
    cJSON_AddStringToObject(row, "method", name);
    cJSON_AddNumberToObject(row, "glossiness", (double)glossiness);
    cJSON_AddNumberToObject(row, "sent", isfinite(sent) ? sent : -1);
    cJSON_AddNumberToObject(row, "bound", peak);
    if (prints)
        printf("%-28s %-17s g %-9.7g %-8s %9.3g of %.3g\n", extreme->name, name, (double)glossiness,
               tl_outcome_names[outcome], sent, peak);
}

bool tl_stability_shading(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    const char *const *models = tl_experiment_choices(&tl_material_options, "model");
    (void)error;
    for (size_t e = 0; e < TL_COUNT(extremes); e++)
        for (int model = 0; models[model]; model++)
            for (size_t g = 0; g < TL_COUNT(glossinesses); g++)
                run_cell(&extremes[e], model, models[model], glossinesses[g], !arguments->json, out);
    return true;
}
