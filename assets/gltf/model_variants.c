/* KHR_materials_variants: the material of each part in each variant. */
#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <string.h>

#define VARIANTS_MAX 256

/* Variants are chosen by name, so one without a name, or with a name in use, gets a number. */
static void name_variant(const tl_model *model, const char *given, size_t number, char name[64])
{
    snprintf(name, 64, "%s", given);
    if (name[0] == '\0' || tl_model_find_variant(model, name))
        snprintf(name, 64, "%.30s%svariant %zu", given, given[0] ? " " : "", number);
}

/* Starts every variant with each part's own material; mappings then replace it. */
static void begin_variants(const gltf_document *document, tl_model *model)
{
    model->variants = TL_NEW_ARRAY(struct tl_variant, document->variant_count);
    for (size_t i = 0; i < document->variant_count; i++) {
        struct tl_variant *variant = &model->variants[i];
        name_variant(model, document->variants[i], i, variant->name);
        variant->materials = TL_NEW_ARRAY(int, model->mesh.part_count);
        for (size_t p = 0; p < model->mesh.part_count; p++)
            variant->materials[p] = model->mesh.parts[p].material;
        model->variant_count++;
    }
}

static bool read_mapping(const gltf_document *document, const struct gltf_mapping *mapping, size_t part,
                         tl_model *model, tl_error *error)
{
    if (mapping->material < 0 || (size_t)mapping->material >= document->material_count)
        return tl_fail(error, TL_INPUT,
                       "%s: KHR_materials_variants: material %d does not exist: export the file again",
                       document->path, mapping->material);
    for (size_t i = 0; i < mapping->variant_count; i++) {
        int variant = document->mapped_variants[mapping->first_variant + i];
        if (variant < 0 || (size_t)variant >= model->variant_count)
            return tl_fail(error, TL_INPUT,
                           "%s: KHR_materials_variants: variant %d does not exist: export the file again",
                           document->path, variant);
        model->variants[variant].materials[part] = mapping->material;
    }
    return true;
}

bool model_read_variants(const gltf_document *document, const struct gltf_primitive *const *sources,
                         tl_model *model, tl_error *error)
{
    if (document->variant_count > VARIANTS_MAX)
        return tl_fail(error, TL_INPUT, "%s: has %zu material variants, more than %d: split it",
                       document->path, document->variant_count, VARIANTS_MAX);
    begin_variants(document, model);
    for (size_t p = 0; p < model->mesh.part_count; p++)
        for (size_t m = 0; m < sources[p]->mapping_count; m++)
            if (!read_mapping(document, &document->mappings[sources[p]->first_mapping + m], p, model, error))
                return false;
    return true;
}
