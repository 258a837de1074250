/* toile fabric: lists, writes and bakes fabrics. */
#include "app/cli/json.h"
#include "app/fabric/bake.h"
#include "app/fabric/card.h"
#include "app/fabric/commands.h"
#include "app/fabric/fabric.h"
#include "app/fabric/fields.h"
#include "app/fabric/swatch.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>

/* A picture alone is a height map; everything else is a fabric. */
static bool is_height_map(const char *path)
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "exr", "tif", "tiff"};
    for (size_t i = 0; i < TL_COUNT(extensions); i++)
        if (tl_path_has_extension(path, extensions[i]))
            return true;
    return false;
}

/* The name of a folder here becomes a path, so that it is none of the built-in names. */
static char *source_of(const char *name)
{
    bool is_path = tl_option_is_file_name(name) || !tl_fabric_file_is(name);
    return is_path ? tl_copy_string(name) : tl_format("./%s", name);
}

static void add_options(cJSON *object, const struct tl_binding *binding)
{
    cJSON *table = cJSON_AddObjectToObject(object, binding->table->name);
    for (size_t i = 0; i < binding->table->row_count; i++) {
        char *text = tl_options_get_text(binding, &binding->table->rows[i]);
        cJSON_AddStringToObject(table, binding->table->rows[i].name, text);
        free(text);
    }
}

/* Prints what the fabric's file holds, and the options that follow from it. */
static void print_fabric(struct tl_fabric *fabric, bool json)
{
    struct tl_binding bindings[TL_FABRIC_TABLES];
    tl_fabric_bind(fabric, bindings);
    if (!json) {
        printf("# %s\n", tl_fabric_name(fabric));
        if (fabric->is_foreign)
            tl_fabric_fields_print(&fabric->file);
        tl_options_print_yaml(bindings, TL_FABRIC_TABLES, stdout);
        return;
    }
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "fabric", tl_fabric_name(fabric));
    if (fabric->is_foreign)
        cJSON_AddItemToObject(object, "fields", tl_fabric_fields_json(&fabric->file));
    for (int i = 0; i < TL_FABRIC_TABLES; i++)
        add_options(object, &bindings[i]);
    tl_json_print(object);
}

/* Takes what --set gives over the fabric's own options. */
static bool assign(struct tl_fabric *fabric, const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_binding bindings[TL_FABRIC_TABLES];
    tl_fabric_bind(fabric, bindings);
    for (size_t i = 0; i < arguments->assignment_count; i++)
        if (!tl_options_set_assignment(bindings, TL_FABRIC_TABLES, arguments->assignments[i], error))
            return false;
    return true;
}

static bool list_or_write(const char *source, const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_fabric *fabric = TL_NEW(struct tl_fabric);
    bool done = tl_fabric_open(source, fabric, error) && assign(fabric, arguments, error);
    if (done && arguments->output)
        done = tl_fabric_write(fabric, arguments->output, error);
    else if (done)
        print_fabric(fabric, arguments->json);
    tl_fabric_release(fabric);
    free(fabric);
    return done;
}

bool tl_command_fabric(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->lights)
        return tl_fabric_swatch(arguments, error);
    if (arguments->positional_count != 1)
        return tl_fail(error, TL_USAGE,
                       "fabric: expected one fabric or height map: a name, a file or a folder, as in "
                       "`toile fabric denim`");
    if (arguments->card && (arguments->output || arguments->json))
        return tl_fail(error, TL_USAGE, "--card: writes the card alone: leave out %s",
                       arguments->output ? "-o" : "--json, and end the card's name in .json for one");
    if (is_height_map(arguments->positionals[0]))
        return arguments->card ? tl_fail(error, TL_USAGE,
                                         "%s: a height map alone is no fabric: bake it with -o FOLDER, and "
                                         "make the card of that folder's .yaml",
                                         arguments->positionals[0])
                               : tl_fabric_bake(arguments, error);
    char *source = source_of(arguments->positionals[0]);
    bool done =
        arguments->card ? tl_fabric_card(source, arguments, error) : list_or_write(source, arguments, error);
    free(source);
    return done;
}
