#include "render/brdf/material_lobes.h"

#include "render/brdf/facets.h"
#include "render/env/exponent.h"

#include <math.h>

/* The coat's share of the light that fibres leave. */
static float coat_share(const struct tl_material_sample *sample)
{
    if (!(sample->material->coat > 0))
        return 0;
    const float cosine = glms_vec3_dot(sample->smooth, sample->viewer);
    return sample->material->coat * fresnel_dielectric(COAT_INDEX, tl_minf(tl_maxf(cosine, 0), 1));
}

static vec3s fibres_of(const struct tl_material_sample *sample)
{
    return fuzz_axis(sample->material->fuzz.follow, sample->smooth, sample->normal);
}

float tl_material_base(const struct tl_material_sample *sample)
{
    return tl_fuzz_under(sample->material, glms_vec3_dot(fibres_of(sample), sample->viewer)) *
           (1 - coat_share(sample));
}

static struct tl_brdf_sum gloss_of(const struct tl_material_sample *sample)
{
    return tl_brdf_sum_of(sample->material, sample->f0, sample->diffuse, sample->glossiness,
                          sample->handedness * sample->side, sample->widening);
}

static struct tl_brdf_frame frame_of(const struct tl_material_sample *sample)
{
    return tl_brdf_frame_make(sample->normal, sample->tangent, sample->handedness,
                              sample->side * sample->material->gloss.rotation);
}

int tl_material_gloss_fit(const struct tl_material_sample *sample, int max_count,
                          struct tl_fitted_lobe items[TL_LOBE_FIT_SUM_MAX])
{
    const struct tl_brdf_sum gloss = gloss_of(sample);
    const struct tl_brdf_frame frame = frame_of(sample);
    return tl_lobe_fit_sum(&gloss, &frame, sample->viewer, max_count, items);
}

struct tl_material_lobes tl_material_lobes_of(const struct tl_material_sample *sample)
{
    const tl_material *material = sample->material;
    struct tl_material_lobes lobes = {.viewer = sample->viewer,
                                      .fuzz = material->fuzz,
                                      .fuzz_axis = fibres_of(sample),
                                      .is_faceted = material->gloss.model != TL_REFLECT_PHONG};
    lobes.base = tl_fuzz_under(material, glms_vec3_dot(lobes.fuzz_axis, sample->viewer));
    if (material->coat > 0) {
        const float share = coat_share(sample);
        lobes.coat = lobes.base * share;
        lobes.base *= 1 - share;
        lobes.coat_axis = mirror_direction(sample->smooth, sample->viewer);
        lobes.coat_exponent = tl_lobe_exponent(material->coat_glossiness);
    }
    if (lobes.is_faceted)
        lobes.gloss = gloss_of(sample);
    if (lobes.is_faceted || material->measured)
        lobes.frame = frame_of(sample);
    return lobes;
}

int tl_material_lobes_fit(const struct tl_material_lobes *lobes, int max_count,
                          struct tl_fitted_lobe items[TL_MATERIAL_LOBES_MAX], int *facets)
{
    int count = 0;
    if (lobes->is_faceted)
        count = tl_lobe_fit_sum(&lobes->gloss, &lobes->frame, lobes->viewer, max_count, items);
    for (int k = 0; k < count; k++)
        items[k].weight = glms_vec3_scale(items[k].weight, lobes->base);
    *facets = count;
    if (lobes->coat > 0)
        items[count++] = (struct tl_fitted_lobe){
            lobes->coat_axis, lobes->coat_exponent, {{lobes->coat, lobes->coat, lobes->coat}}};
    return count;
}

vec3s tl_material_facets(const struct tl_material_lobes *lobes, vec3s l, float radius)
{
    vec3s gloss = {{0, 0, 0}};
    for (int k = 0; lobes->is_faceted && k < lobes->gloss.count; k++)
        gloss = glms_vec3_add(
            gloss, tl_brdf_gloss_under_disc(&lobes->gloss.items[k], &lobes->frame, l, lobes->viewer, radius));
    return gloss;
}

vec3s tl_material_over(const struct tl_material_lobes *lobes, vec3s below, vec3s l, float radius)
{
    vec3s sent = glms_vec3_scale(below, lobes->base);
    if (lobes->coat > 0) {
        /* The mean square angle of a disc is half its radius squared. */
        const float exponent = lobe_broadened_exponent(lobes->coat_exponent, radius * GLM_SQRT1_2f);
        sent = glms_vec3_adds(sent, lobes->coat * lobe_cosine(exponent, glms_vec3_dot(l, lobes->coat_axis)));
    }
    if (glms_vec3_max(lobes->fuzz.colour) > 0)
        sent = glms_vec3_muladds(lobes->fuzz.colour,
                                 fuzz_value(lobes->fuzz.roughness, lobes->fuzz_axis, l, lobes->viewer), sent);
    return sent;
}
