/* The sum over the regions of what a sample sees of them through several lobes at once, for compose.c: its
 * loops are compiled there for each instruction set. Environment's frame. Pure; threads: any. */
#ifndef TOILE_RENDER_LIGHT_SEEN_LOBES_INTERNAL_H
#define TOILE_RENDER_LIGHT_SEEN_LOBES_INTERNAL_H

#include "render/brdf/material_lobes.h"
#include "render/env/exponent.h"
#include "render/light/compose.h"

/* Visibility of group g at a sample. */
TL_INLINE void tl_read_visibility(const uint16_t *values, size_t stride, const struct tl_taps *taps, int g,
                                  float visibility[TL_LANES])
{
    const uint16_t *rows[TL_TAPS];
    float weights[TL_TAPS];
    for (int t = 0; t < TL_TAPS; t++) {
        rows[t] = values + taps->point[t] * stride + (size_t)g * TL_LANES;
        weights[t] = taps->weight[t] * (1 / TL_VISIBILITY_ONE);
    }
    for (int lane = 0; lane < TL_LANES; lane++)
        visibility[lane] = weights[0] * (float)rows[0][lane] + weights[1] * (float)rows[1][lane] +
                           weights[2] * (float)rows[2][lane];
}

/* Values of each lobe for the loops over the regions. */
struct tl_lobe_terms {
    vec3s direction;
    float exponent;
    float coefficient[3];           /* weight times the regions' gain, by channel */
    float reach_cosine, reach_sine; /* the lobe counts for nothing further from its axis */
};

/* Share of a lobe's peak, 1e-12, below which it is left out. Beside a sun, 1e5 times as bright as the rest
 * where suns stay in their regions, that is what a float's last digit is to the sum. */
#define TL_NEGLIGIBLE_LOG2 (-40.0f)

TL_INLINE void tl_find_lobe_terms(const struct tl_region_lights *lights, const struct tl_fitted_lobe *lobes,
                                  int count, struct tl_lobe_terms *terms)
{
    for (int k = 0; k < count; k++) {
        const struct tl_fitted_lobe *lobe = &lobes[k];
        const float s = tl_minf(lobe->exponent, TL_REGION_LOBE_MAX);
        const float widest = lobe_broadened_exponent(s, lights->spread_max);
        const float cosine = tl_exp2(TL_NEGLIGIBLE_LOG2 / widest);
        vec3s gain = {{1, 1, 1}};
        if (lights->gain.made)
            gain = tl_lobes_fetch(&lights->gain, lobe->direction, tl_exponent_blend(lobe->exponent));
        terms[k] = (struct tl_lobe_terms){.direction = lobe->direction,
                                          .exponent = s,
                                          .reach_cosine = cosine,
                                          .reach_sine = sqrtf(1 - cosine * cosine)};
        for (int c = 0; c < 3; c++)
            terms[k].coefficient[c] = gain.raw[c] * lobe->weight.raw[c];
    }
}

/* Sixteen regions through all of the lobes, their visibility read once. */
TL_INLINE void tl_add_group_of_lobes(float sums[3][TL_LANES], const struct tl_region_group *group,
                                     const struct tl_lobe_terms *terms, int count, vec3s smooth,
                                     const float visibility[TL_LANES])
{
    float through[3][TL_LANES] = {0};
    for (int k = 0; k < count; k++) {
        const vec3s d = terms[k].direction;
        const float limit =
            terms[k].reach_cosine * group->reach_cosine - terms[k].reach_sine * group->reach_sine;
        if (glms_vec3_dot(group->axis, d) < limit)
            continue;
        const float r = terms[k].coefficient[0], g = terms[k].coefficient[1], b = terms[k].coefficient[2];
        for (int lane = 0; lane < TL_LANES; lane++) {
            float cosine = group->x[lane] * d.x + group->y[lane] * d.y + group->z[lane] * d.z;
            float exponent = lobe_broadened_exponent(terms[k].exponent, group->spread[lane]);
            float lobe = region_lobe(cosine, group->sine[lane], group->inverse_sine[lane], exponent);
            through[0][lane] += r * lobe;
            through[1][lane] += g * lobe;
            through[2][lane] += b * lobe;
        }
    }
    float above[TL_LANES];
    for (int lane = 0; lane < TL_LANES; lane++) {
        float cosine = group->x[lane] * smooth.x + group->y[lane] * smooth.y + group->z[lane] * smooth.z;
        above[lane] = disc_share(cosine * group->inverse_sine[lane]) * visibility[lane];
    }
    for (int c = 0; c < 3; c++)
        for (int lane = 0; lane < TL_LANES; lane++)
            sums[c][lane] += group->power[c][lane] * through[c][lane] * above[lane];
}

/* The sum of the regions through all lobes of a sample: light sent to the viewer. */
TL_INLINE vec3s tl_see_lobes(const struct tl_compose_request *request, size_t index,
                             const struct tl_fitted_lobe *lobes, int count, vec3s smooth)
{
    const struct tl_region_lights *lights = request->lights;
    struct tl_lobe_terms terms[TL_MATERIAL_LOBES_MAX];
    float sums[3][TL_LANES] = {0};
    tl_find_lobe_terms(lights, lobes, count, terms);
    for (int g = 0; g < lights->group_count; g++) {
        const struct tl_region_group *group = &lights->groups[g];
        if (glms_vec3_dot(group->axis, smooth) < -group->reach_sine)
            continue;
        float visibility[TL_LANES];
        tl_read_visibility(request->values, request->stride, &request->taps[index], g, visibility);
        tl_add_group_of_lobes(sums, group, terms, count, smooth, visibility);
    }
    return (vec3s){{tl_sum_lanes(sums[0]), tl_sum_lanes(sums[1]), tl_sum_lanes(sums[2])}};
}

#endif
