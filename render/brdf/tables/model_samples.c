#include "config/base/memory.h"
#include "render/brdf/tables/factor.h"

#include <math.h>
#include <stdlib.h>

/* Neither vector lies nearer to the horizon than this cosine. */
#define LOWEST 0.02f

/* Point i of the additive sequence in four dimensions, whose steps are powers of the root of x^5 = x + 1. */
static void sequence(size_t i, double out[4])
{
    static const double root = 1.1673039782614187;
    double step = 1;
    for (int d = 0; d < 4; d++) {
        step /= root;
        out[d] = fmod(0.5 + step * (double)(i + 1), 1);
    }
}

/* The half vector whose coordinates on q's map fill a disc evenly. */
static vec3s half_at(double radius, double turn)
{
    double map = radius * radius, square = map * map, plane = 2 * map / (1 + square);
    return (vec3s){
        {(float)(plane * cos(turn)), (float)(plane * sin(turn)), (float)((1 - square) / (1 + square))}};
}

static vec3s around(vec3s axis, double cosine, double turn)
{
    vec3s t = glms_vec3_normalize(
        glms_vec3_cross(fabsf(axis.x) < 0.6f ? (vec3s){{1, 0, 0}} : (vec3s){{0, 1, 0}}, axis));
    vec3s b = glms_vec3_cross(axis, t);
    double sine = sqrt(fmax(1 - cosine * cosine, 0));
    vec3s sum = glms_vec3_scale(axis, (float)cosine);
    sum = glms_vec3_add(sum, glms_vec3_scale(t, (float)(sine * cos(turn))));
    return glms_vec3_normalize(glms_vec3_add(sum, glms_vec3_scale(b, (float)(sine * sin(turn)))));
}

struct tl_reflectance_samples tl_brdf_model_samples(const struct tl_brdf *brdf, size_t count)
{
    static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
    struct tl_reflectance_samples out = {TL_NEW_ARRAY(struct tl_reflectance_sample, count), 0};
    for (size_t i = 0; out.count < count; i++) {
        double at[4];
        sequence(i, at);
        vec3s h = half_at(sqrt(at[0]), 2 * M_PI * at[1]);
        vec3s l = around(h, at[2], 2 * M_PI * at[3]);
        vec3s v = tl_brdf_mirror(h, l);
        if (!(l.z > LOWEST && v.z > LOWEST))
            continue;
        vec3s gloss = tl_brdf_gloss(brdf, &frame, l, v);
        out.items[out.count++] = (struct tl_reflectance_sample){l, v, glms_vec3_scale(gloss, 1 / l.z)};
    }
    return out;
}

struct tl_brdf_tables tl_brdf_tables_refactor(const struct tl_brdf *brdf, int size)
{
    int limited = size < TL_FACTOR_SIZE_MIN   ? TL_FACTOR_SIZE_MIN
                  : size > TL_FACTOR_SIZE_MAX ? TL_FACTOR_SIZE_MAX
                                              : size;
    struct tl_reflectance_samples samples =
        tl_brdf_model_samples(brdf, (size_t)12 * (size_t)limited * (size_t)limited);
    struct tl_brdf_tables tables = tl_brdf_tables_factor(&samples, limited, NULL);
    tl_reflectance_samples_release(&samples);
    return tables;
}
