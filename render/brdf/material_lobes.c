#include "render/brdf/material_lobes.h"

vec4s tl_material_law(const tl_material *material)
{
    return (vec4s){{material->diffuse_roughness, material->gloss.model == TL_REFLECT_BANKS, 0, 0}};
}

static MaterialLayers layers_of(const struct tl_material_sample *sample, vec3s thread)
{
    const tl_material *material = sample->material;
    return material_layers(tl_material_law(material), material->coat,
                           tl_lobe_exponent(material->coat_glossiness), material->fuzz.colour,
                           material->fuzz.roughness, material->fuzz.follow, sample->smooth, sample->normal,
                           thread, sample->viewer);
}

float tl_material_base(const struct tl_material_sample *sample)
{
    return layers_of(sample, glms_vec3_zero()).base;
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
    struct tl_material_lobes lobes = {.is_faceted = material->gloss.model != TL_REFLECT_PHONG};
    if (lobes.is_faceted)
        lobes.gloss = gloss_of(sample);
    if (lobes.is_faceted || material->measured)
        lobes.frame = frame_of(sample);
    lobes.over = layers_of(sample, lobes.frame.tangent);
    return lobes;
}

int tl_material_lobes_fit(const struct tl_material_lobes *lobes, int max_count,
                          struct tl_fitted_lobe items[TL_MATERIAL_LOBES_MAX], int *facets)
{
    int count = 0;
    if (lobes->is_faceted)
        count = tl_lobe_fit_sum(&lobes->gloss, &lobes->frame, lobes->over.viewer, max_count, items);
    for (int k = 0; k < count; k++)
        items[k].weight = glms_vec3_scale(items[k].weight, lobes->over.base);
    *facets = count;
    if (lobes->over.coat > 0)
        items[count++] = (struct tl_fitted_lobe){lobes->over.coat_axis,
                                                 lobes->over.coat_exponent,
                                                 {{lobes->over.coat, lobes->over.coat, lobes->over.coat}}};
    return count;
}

vec3s tl_material_facets(const struct tl_material_lobes *lobes, vec3s l, float radius)
{
    vec3s gloss = {{0, 0, 0}};
    for (int k = 0; lobes->is_faceted && k < lobes->gloss.count; k++)
        gloss = glms_vec3_add(gloss, tl_brdf_gloss_under_disc(&lobes->gloss.items[k], &lobes->frame, l,
                                                              lobes->over.viewer, radius));
    return gloss;
}
