#include "assets/base/material.h"

#include <math.h>
#include <stdio.h>

tl_material tl_material_default(const char *name)
{
    const struct tl_uv_transform identity = {.scale = {1, 1}};
    const struct tl_map none = {.transform = identity};
    tl_material material = {.diffuse = {{0.5f, 0.5f, 0.5f}},
                            .specular = {{0.04f, 0.04f, 0.04f}},
                            .gloss = {.index = 1.5f},
                            .coat_glossiness = 0.95f,
                            .fuzz = {.roughness = 0.5f},
                            .normal_scale = 1,
                            .occlusion_strength = 1,
                            .diffuse_map = none,
                            .normal_map = none,
                            .gloss_map = none,
                            .specular_map = none,
                            .occlusion_map = none,
                            .height_map = none};
    snprintf(material.name, sizeof material.name, "%s", name);
    return material;
}

bool tl_material_emits(const tl_material *material)
{
    return glms_vec3_max(material->emission) > 0;
}

bool tl_material_is_sewn(const tl_material *material)
{
    return material->construction.seam != TL_SEAM_NONE || material->construction.hem != TL_HEM_NONE;
}

bool tl_material_transmits(const tl_material *material)
{
    return material->transmission.x > 0 || material->transmission.y > 0 || material->transmission.z > 0;
}

bool tl_material_is_lambert(const tl_material *material)
{
    return !(material->diffuse_roughness > 0) && material->gloss.model != TL_REFLECT_BANKS;
}

bool tl_material_is_layered(const tl_material *material)
{
    return material->gloss.model != TL_REFLECT_PHONG || !tl_material_is_lambert(material) ||
           material->coat > 0 || material->openness > 0 || tl_material_has_fuzz(material) ||
           tl_material_transmits(material);
}

vec3s tl_material_thread_gain(const tl_material *material)
{
    vec3s gain = glms_vec3_one();
    for (int i = 0; i < material->thread_count; i++)
        gain = glms_vec3_add(gain, material->threads[i].ratio);
    return gain;
}

vec3s tl_material_colour(const tl_material *material)
{
    return glms_vec3_minv(glms_vec3_mul(material->diffuse, tl_material_thread_gain(material)),
                          glms_vec3_one());
}

bool tl_material_has_fuzz(const tl_material *material)
{
    return glms_vec3_max(material->fuzz.colour) > 0;
}

/* The rotation is counter-clockwise with v down, as KHR_texture_transform has it. */
void tl_uv_transform_rows(const struct tl_uv_transform *transform, float rows[6])
{
    float c = cosf(transform->rotation), s = sinf(transform->rotation);
    rows[0] = c * transform->scale[0];
    rows[1] = s * transform->scale[1];
    rows[2] = transform->offset[0];
    rows[3] = -s * transform->scale[0];
    rows[4] = c * transform->scale[1];
    rows[5] = transform->offset[1];
}

bool tl_gloss_has_tails(const struct tl_gloss *gloss)
{
    return gloss->model == TL_REFLECT_TORRANCE_SPARROW && gloss->facets == TL_FACETS_GGX;
}

struct tl_gloss tl_gloss_from_roughness(float roughness, bool varies)
{
    struct tl_gloss gloss = {.index = tl_material_default("").gloss.index};
    if (!(roughness >= TL_GGX_SMOOTHEST))
        return gloss;
    gloss.model = TL_REFLECT_TORRANCE_SPARROW;
    gloss.facets = TL_FACETS_GGX;
    gloss.masking = TL_MASKING_SMITH;
    gloss.width_weft = gloss.width_warp = varies ? 0 : fminf(roughness, 1) * fminf(roughness, 1);
    return gloss;
}

float tl_glossiness_from_roughness(float roughness)
{
    float alpha = roughness * roughness;
    float exponent = (2 / fmaxf(alpha * alpha, 1e-12f) - 2) / 4;
    return 1 - 1 / fmaxf(exponent, 1);
}

vec2s tl_uv_transformed(const struct tl_uv_transform *transform, vec2s uv)
{
    float rows[6];
    tl_uv_transform_rows(transform, rows);
    return (vec2s){{rows[0] * uv.x + rows[1] * uv.y + rows[2], rows[3] * uv.x + rows[4] * uv.y + rows[5]}};
}
