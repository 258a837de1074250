/* The use of the extensions that a material names. */
#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void model_approximate_extension(const struct material_build *build, const char *format, ...)
{
    char text[256];
    struct extension_notes *notes = build->notes;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    model_approximate(build->model, "%s", text);
    if (notes->count < EXTENSIONS_MAX)
        snprintf(notes->names[notes->count++], sizeof notes->names[0], "%.*s", (int)strcspn(text, ":"), text);
}

/* Those that have an effect, as their names are in model_gltf.c. */
static bool is_known(const char *name)
{
    static const char *const known[] = {
        "anisotropy",           "clearcoat",        "ior", "sheen", "specular", "transmission",
        "diffuse_transmission", "emissive_strength"};
    static const char prefix[] = "KHR_materials_";
    for (size_t i = 0; i < TL_COUNT(known); i++)
        if (strncmp(name, prefix, strlen(prefix)) == 0 && strcmp(name + strlen(prefix), known[i]) == 0)
            return true;
    return false;
}

void model_list_extensions(const struct material_build *build, size_t material)
{
    tl_model *model = build->model;
    const struct gltf_material *from = build->from;
    for (size_t i = 0; i < from->used_count; i++) {
        struct tl_material_extension added = {.material = material,
                                              .shown = is_known(from->used[i]) ? "exact" : "ignored"};
        snprintf(added.name, sizeof added.name, "%s", from->used[i]);
        for (size_t k = 0; k < build->notes->count; k++)
            if (strcmp(build->notes->names[k], added.name) == 0)
                added.shown = "approximated";
        model->extensions =
            tl_resize(model->extensions, model->extension_count + 1, sizeof *model->extensions);
        model->extensions[model->extension_count++] = added;
    }
}
