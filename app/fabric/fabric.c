#include "app/fabric/fabric.h"

#include "app/settings/imported.h"
#include "app/settings/layers.h"

#include <string.h>

void tl_fabric_bind(struct tl_fabric *fabric, struct tl_binding bindings[TL_FABRIC_TABLES])
{
    bindings[0] = (struct tl_binding){&tl_cloth_fabric_options, &fabric->mechanics};
    bindings[1] = (struct tl_binding){&tl_weave_options, &fabric->weave};
    bindings[2] = (struct tl_binding){&tl_material_options, &fabric->material};
    bindings[3] = (struct tl_binding){&tl_construction_options, &fabric->construction};
}

static bool is_foreign(const char *source)
{
    char *own = tl_imported_own_file(source);
    bool foreign = !own && tl_option_is_file_name(source) && tl_fabric_file_is(source);
    free(own);
    return foreign;
}

bool tl_fabric_open(const char *source, struct tl_fabric *out, tl_error *error)
{
    struct tl_binding bindings[TL_FABRIC_TABLES];
    *out = (struct tl_fabric){.source = source, .is_foreign = is_foreign(source)};
    tl_fabric_bind(out, bindings);
    tl_options_reset(bindings, TL_FABRIC_TABLES);
    bool opened =
        out->is_foreign
            ? tl_fabric_file_open(source, &out->file, error) &&
                  tl_imported_apply_file(source, &out->file, bindings, TL_FABRIC_TABLES, error)
            : tl_option_layer_apply(&tl_option_layer_fabric, source, bindings, TL_FABRIC_TABLES, NULL, error);
    if (!opened)
        tl_fabric_release(out);
    return opened;
}

void tl_fabric_release(struct tl_fabric *fabric)
{
    tl_fabric_file_release(&fabric->file);
}

const char *tl_fabric_name(const struct tl_fabric *fabric)
{
    const char *slash = strrchr(fabric->source, '/');
    if (fabric->is_foreign && fabric->file.name[0])
        return fabric->file.name;
    return slash && slash[1] ? slash + 1 : fabric->source;
}
