/* Named layers of the settings: presets, fabrics and scenes, each built in or a YAML file.
 *
 * Failure: TL_USAGE for an unknown name or a wrong value, with one line that names file, line and field, or
 * lists the names there are and the nearest of them; the bound values are then partly set. Threads: pure, but
 * for reading the file. */
#ifndef TOILE_APP_SETTINGS_LAYERS_H
#define TOILE_APP_SETTINGS_LAYERS_H

#include "assets/weave/weave.h"
#include "config/embedded.h"
#include "config/options.h"
#include "render/brdf/options.h"

/* One kind of layer. */
struct tl_option_layer {
    const char *kind; /* for messages */
    const struct tl_embedded *list;
    const char *const *names; /* of the built-in ones, NULL-terminated */
};
extern const struct tl_option_layer tl_option_layer_preset, tl_option_layer_fabric, tl_option_layer_scene;

/* Sets the bound options that the layer `name` gives; the others keep their values. `name` is that of a
 * built-in layer or a file's path. `section`: the records that the file may have besides, or NULL. */
bool tl_option_layer_apply(const struct tl_option_layer *layer, const char *name,
                           const struct tl_binding *bindings, size_t count,
                           const struct tl_record_section *section, tl_error *error);

/* The appearance that a fabric gives, over default values: how it moves is left out. */
bool tl_option_layer_read_appearance(const char *fabric, struct tl_material_params *params,
                                     struct tl_weave_params *weave, tl_error *error);

#endif
