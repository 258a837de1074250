#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

static float unit(float value, float otherwise)
{
    return isfinite(value) ? fminf(fmaxf(value, 0), 1) : otherwise;
}

/* The file's alpha is factor times texel; a tl_material tests the texel alone, so the cutoff is divided by
 * the factor. */
static float mask_cutoff(const struct gltf_material *from)
{
    float factor = fmaxf(unit(from->base_colour[3], 1), 1e-3f);
    return fmaxf(unit(from->alpha_cutoff, 0.5f), 1e-3f) / factor;
}

/* Blending shows the surface by its alpha, and what is behind by the rest: as holes between threads do. A
 * tl_material is equally open everywhere: texels of less than half of the highest alpha are cut away, and the
 * others have their mean. */
static void apply_blending(const struct material_build *build, const struct texture_loaded *base)
{
    const float closed_from = 0.995f, max_open = 0.99f;
    float opacity = unit(build->from->base_colour[3], 1);
    tl_material *to = build->to;
    if (base->has_alpha) {
        opacity *= base->alpha_mean;
        to->alpha_cutoff = 0.5f * base->alpha_highest;
        if (base->alpha_varies || base->alpha_mean < 1)
            model_approximate(build->model,
                              "alphaMode BLEND: %s: alpha varies over a texture: cut at half of the "
                              "highest, the mean of the rest above that",
                              to->name);
    }
    float open = 1 - (1 - to->openness) * opacity;
    to->openness = open > 1 - closed_from ? fminf(open, max_open) : 0;
}

/* glTF 2.0, 3.9.3, and KHR_materials_emissive_strength: radiance, in the units of the environment. */
static void read_emission(struct texture_reader *textures, const struct gltf_material *from, tl_material *to)
{
    const float strongest = 1e4f; /* a sun's disc has more, no garment has */
    float strength = fminf(fmaxf(from->emissive_strength, 0), strongest);
    for (int i = 0; i < 3; i++)
        to->emission.raw[i] = unit(from->emission[i], 0) * strength;
    if (!tl_material_emits(to))
        return;
    texture_read_map(textures, &from->emission_map, TEXTURE_COLOUR, 0, &to->emission_map);
    model_approximate(textures->model, "emission: it is seen, and lights nothing else");
}

/* glTF's metallic-roughness model in two lobes: diffuse = base (1 - metallic), F0 = mix(F0 of the
 * dielectric, base, metallic). */
static tl_material read_material(struct texture_reader *textures, const struct gltf_material *from,
                                 size_t index)
{
    tl_material to = tl_material_default(from->name && from->name[0] ? from->name : "unnamed");
    float metallic = unit(from->metallic, 1), roughness = unit(from->roughness, 1);
    to.double_sided = from->double_sided;
    to.normal_scale = isfinite(from->normal_scale) ? from->normal_scale : 1;
    to.occlusion_strength = unit(from->occlusion_strength, 1);
    to.glossiness = tl_glossiness_from_roughness(roughness);
    const struct texture_loaded *base =
        texture_read_map(textures, &from->base_colour_map, TEXTURE_COLOUR, 0, &to.diffuse_map);
    texture_read_map(textures, &from->normal_map, TEXTURE_DATA, 0, &to.normal_map);
    texture_read_map(textures, &from->occlusion_map, TEXTURE_DATA, 0, &to.occlusion_map);
    const struct texture_loaded *packed =
        texture_read_map(textures, &from->metallic_roughness_map, TEXTURE_GLOSS, roughness, &to.gloss_map);
    if (packed->image) {
        to.glossiness = packed->glossiest;
        metallic *= packed->metallic_mean;
    }
    struct extension_notes notes = {0};
    struct material_build build = {.textures = textures,
                                   .notes = &notes,
                                   .model = textures->model,
                                   .from = from,
                                   .metallic = metallic,
                                   .roughness = roughness * (packed->image ? packed->roughness_mean : 1),
                                   .roughness_varies = packed->roughness_varies,
                                   .to = &to};
    const float index_of_file = to.gloss.index;
    to.gloss = tl_gloss_from_roughness(build.roughness, packed->image != NULL);
    to.gloss.index = index_of_file;
    vec3s f0 = model_dielectric_f0(&build);
    for (int i = 0; i < 3; i++) {
        build.base[i] = unit(from->base_colour[i], 1);
        to.diffuse.raw[i] = build.base[i] * (1 - metallic);
        to.specular.raw[i] = f0.raw[i] * (1 - metallic) + build.base[i] * metallic;
    }
    if (packed->metallic_varies && !model_bake_metal(&build, unit(from->metallic, 1), f0))
        model_approximate(textures->model, "%s: metalness varies over a texture: its mean is used", to.name);
    else if (!packed->metallic_varies && metallic > 0.5f)
        to.specular_map = to.diffuse_map; /* a metal's colour is that of its reflection */
    to.alpha_cutoff = from->alpha == GLTF_MASK ? mask_cutoff(from) : 0;
    model_apply_extensions(&build);
    if (from->alpha == GLTF_BLEND)
        apply_blending(&build, base);
    read_emission(textures, from, &to);
    model_list_extensions(&build, index);
    return to;
}

bool model_read_materials(const gltf_document *document, tl_model *model, tl_error *error)
{
    size_t count = document->material_count;
    const size_t map_bytes = sizeof(struct texture_loaded) + sizeof(tl_image);
    if (!tl_memory_request_for_file(document->path, document->file_bytes,
                                    count * (MAPS_MAX * map_bytes + sizeof(tl_material)), error))
        return false;
    struct texture_reader textures = {.document = document,
                                      .model = model,
                                      .loaded = TL_NEW_ARRAY(struct texture_loaded, MAPS_MAX * count)};
    model->images = TL_NEW_ARRAY(tl_image, MAPS_MAX * count); /* never moved: materials point into it */
    model->materials = TL_NEW_ARRAY(tl_material, count + 1);
    model->material_count = count + 1;
    for (size_t i = 0; i < count; i++)
        model->materials[i] = read_material(&textures, &document->materials[i], i);
    model->materials[count] = tl_material_default("default");
    free(textures.loaded);
    return true;
}
