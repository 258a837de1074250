#include "app/settings/layers.h"

#include "app/settings/imported.h"
#include "cloth/energy/fabric.h"
#include "config/base/memory.h"
#include "config/base/words.h"
#include "render/construction/options.h"

#include <stdlib.h>

const struct tl_option_layer tl_option_layer_preset = {"preset", tl_embedded_presets,
                                                       tl_embedded_presets_names};
const struct tl_option_layer tl_option_layer_fabric = {"fabric", tl_embedded_fabrics,
                                                       tl_embedded_fabrics_names};
const struct tl_option_layer tl_option_layer_scene = {"scene", tl_embedded_scenes, tl_embedded_scenes_names};

static bool fail_name(const struct tl_option_layer *layer, const char *name, tl_error *error)
{
    size_t count = tl_count_words(layer->names);
    char *list = tl_join_words(layer->names, count, ", ", ", ");
    const char *near = tl_nearest_word(name, layer->names, count);
    const char *others =
        layer == &tl_option_layer_fabric ? "a file, or a folder/ with its slash" : "a YAML file";
    tl_fail(error, TL_USAGE, "%s: no such %s: expected %s, or %s%s%s%s", name, layer->kind, list, others,
            near ? ": did you mean " : "", near ? near : "", near ? "?" : "");
    free(list);
    return false;
}

/* A fabric's file: options, or what another program wrote. */
static bool apply_fabric_file(const char *path, const struct tl_binding *bindings, size_t count,
                              const struct tl_record_section *section, tl_error *error)
{
    char *own = tl_imported_own_file(path);
    bool applied = !own && tl_fabric_file_is(path)
                       ? tl_imported_apply(path, bindings, count, error)
                       : tl_options_read_yaml_file_with(bindings, count, section, own ? own : path, error);
    free(own);
    return applied;
}

bool tl_option_layer_apply(const struct tl_option_layer *layer, const char *name,
                           const struct tl_binding *bindings, size_t count,
                           const struct tl_record_section *section, tl_error *error)
{
    if (tl_option_is_file_name(name) && layer == &tl_option_layer_fabric)
        return apply_fabric_file(name, bindings, count, section, error);
    if (tl_option_is_file_name(name))
        return tl_options_read_yaml_file_with(bindings, count, section, name, error);
    char *file = tl_format("%s.yaml", name);
    const struct tl_embedded *entry = tl_embedded_find(layer->list, file);
    free(file);
    if (!entry)
        return fail_name(layer, name, error);
    return tl_options_read_yaml_with(bindings, count, section, entry->name, entry->data, entry->size, error);
}

bool tl_option_layer_read_appearance(const char *fabric, struct tl_material_params *params,
                                     struct tl_weave_params *weave, tl_error *error)
{
    struct tl_cloth_fabric ignored;
    struct tl_construction_params unused; /* a garment is sewn in one way, that of its first fabric */
    const struct tl_binding bindings[] = {{&tl_cloth_fabric_options, &ignored},
                                          {&tl_weave_options, weave},
                                          {&tl_material_options, params},
                                          {&tl_construction_options, &unused}};
    tl_options_reset(bindings, TL_COUNT(bindings));
    return tl_option_layer_apply(&tl_option_layer_fabric, fabric, bindings, TL_COUNT(bindings), NULL, error);
}
