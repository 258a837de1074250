#include "assets/swatch/swatch_internal.h"

#include <string.h>

#define SHADOW    0.02 /* share of the brightest lamp's light: darker is shadow ... */
#define LIT       0.05 /* ... and brighter is not */
#define LAMPS_MIN 2.5  /* sum of weights */

void tl_swatch_texel_read(const struct tl_swatch_rig *rig, double mean_mm, const tl_image *pictures,
                          size_t index, struct tl_swatch_texel *out)
{
    int width = pictures->width, height = pictures->height;
    size_t row = index / (size_t)width, column = index % (size_t)width;
    double texel_mm = (double)rig->width_mm / width, x = texel_mm * ((double)column + 0.5 - 0.5 * width),
           y = -texel_mm * ((double)row + 0.5 - 0.5 * height), brightest = 0;
    out->count = rig->count;
    memcpy(out->to_camera, (const double[3]){0, 0, 1}, sizeof out->to_camera);
    if (rig->camera_mm > 0) {
        memcpy(out->to_camera, (const double[3]){-x, -y, (double)rig->camera_mm}, sizeof out->to_camera);
        tl_swatch_unit(out->to_camera);
    }
    for (size_t k = 0; k < rig->count; k++) {
        const float *value = tl_image_floats(&pictures[k]) + 3 * index;
        out->lights[k] = tl_swatch_light_at(&rig->lamps[k], mean_mm, x, y);
        out->values[k] = ((double)value[0] + (double)value[1] + (double)value[2]) / 3;
        brightest = fmax(brightest, out->values[k] / out->lights[k].strength);
    }
    for (size_t k = 0; k < rig->count; k++) {
        double share = brightest > 0 ? out->values[k] / out->lights[k].strength / brightest : 0;
        out->weights[k] = fmin(fmax((share - SHADOW) / (LIT - SHADOW), 0), 1);
    }
}

double tl_swatch_highlight(const struct tl_swatch_gloss *gloss, const struct tl_swatch_texel *texel,
                           const double normal[3], size_t lamp, double gradient[3])
{
    const double *v = texel->to_camera, *l = texel->lights[lamp].direction;
    double up = tl_swatch_dot(normal, v), facing = tl_swatch_dot(normal, l),
           cosine = 2 * up * facing - tl_swatch_dot(v, l);
    bool is_lit = gloss->specular > 0 && facing > 0 && cosine > 0;
    double value = is_lit ? gloss->specular * (gloss->exponent + 1) / 2 * pow(cosine, gloss->exponent) : 0;
    for (int i = 0; gradient && i < 3; i++)
        gradient[i] = is_lit ? value * gloss->exponent / cosine * 2 * (facing * v[i] + up * l[i]) : 0;
    return value;
}

double tl_swatch_errors(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                        const double *weights, const double body[3], double *errors, double (*rows)[3])
{
    double normal[3], sum = 0;
    memcpy(normal, body, sizeof normal);
    double albedo = tl_swatch_unit(normal);
    for (size_t k = 0; k < texel->count; k++) {
        const struct tl_swatch_light *light = &texel->lights[k];
        double gradient[3], facing = tl_swatch_dot(body, light->direction),
                            shine = tl_swatch_highlight(gloss, texel, normal, k, gradient),
                            radial = tl_swatch_dot(gradient, normal);
        errors[k] = texel->values[k] - light->strength * (fmax(facing, 0) + shine);
        sum += weights[k] * errors[k] * errors[k];
        for (int i = 0; rows && i < 3; i++)
            rows[k][i] = light->strength * ((facing > 0 ? light->direction[i] : 0) +
                                            (gradient[i] - radial * normal[i]) / albedo);
    }
    return sum;
}

double tl_swatch_descend(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                         const double *weights, int steps, double body[3])
{
    double errors[TL_SWATCH_LAMPS_MAX], rows[TL_SWATCH_LAMPS_MAX][3],
        damping = 1e-4, sum = tl_swatch_errors(texel, gloss, weights, body, errors, rows);
    for (int i = 0; i < steps; i++) {
        struct tl_swatch_normal_equations equations = {0};
        double by[3], spread;
        for (size_t k = 0; k < texel->count; k++)
            tl_swatch_add(&equations, rows[k], weights[k], errors[k]);
        for (int j = 0; j < 3; j++)
            equations.m[(const int[]){0, 3, 5}[j]] *= 1 + damping;
        if (!tl_swatch_invert(&equations, by, &spread))
            break;
        const double to[3] = {body[0] + by[0], body[1] + by[1], body[2] + by[2]};
        double there = to[2] > 0 ? tl_swatch_errors(texel, gloss, weights, to, errors, NULL) : INFINITY;
        bool is_lower = there < sum;
        damping *= is_lower ? 0.2 : 10;
        if (is_lower)
            memcpy(body, to, sizeof to);
        sum = tl_swatch_errors(texel, gloss, weights, body, errors, rows);
    }
    return sum;
}

bool tl_swatch_matt(const struct tl_swatch_texel *texel, const double *weights, double body[3])
{
    struct tl_swatch_normal_equations sum = {0};
    double spread, used = 0, row[3];
    for (size_t k = 0; k < texel->count; k++) {
        for (int i = 0; i < 3; i++)
            row[i] = texel->lights[k].strength * texel->lights[k].direction[i];
        tl_swatch_add(&sum, row, weights[k], texel->values[k]);
        used += texel->weights[k];
    }
    return used > LAMPS_MIN && tl_swatch_invert(&sum, body, &spread) && spread < TL_SWATCH_SPREAD_MAX &&
           body[2] > 0;
}

double tl_swatch_settle(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                        const double *weights, int steps, double body[3])
{
    double level[3] = {0, 0, sqrt(tl_swatch_dot(body, body))},
           own = tl_swatch_descend(texel, gloss, weights, steps, body),
           other = tl_swatch_descend(texel, gloss, weights, steps, level);
    if (other < own)
        memcpy(body, level, sizeof level);
    return fmin(own, other);
}
