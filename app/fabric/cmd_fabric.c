/* toile fabric: lists, writes and bakes fabrics. */
#include "app/cli/json.h"
#include "app/fabric/bake.h"
#include "app/fabric/commands.h"
#include "app/fabric/fabric.h"
#include "config/file.h"
#include "config/memory.h"

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

static void print_fields(const tl_fabric_file *file)
{
    size_t used = 0;
    for (size_t i = 0; i < file->field_count; i++) {
        const struct tl_fabric_field *field = &file->fields[i];
        printf("%-44s %-34s %s\n", field->name, field->value, field->use);
        used += field->is_used;
    }
    printf("%zu of %zu fields are used\n\n", used, file->field_count);
}

static cJSON *fields_of(const tl_fabric_file *file)
{
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < file->field_count; i++) {
        const struct tl_fabric_field *field = &file->fields[i];
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "name", field->name);
        cJSON_AddStringToObject(row, "value", field->value);
        cJSON_AddBoolToObject(row, "used", field->is_used);
        cJSON_AddStringToObject(row, "use", field->use);
        cJSON_AddItemToArray(list, row);
    }
    return list;
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
            print_fields(&fabric->file);
        tl_options_print_yaml(bindings, TL_FABRIC_TABLES, stdout);
        return;
    }
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "fabric", tl_fabric_name(fabric));
    if (fabric->is_foreign)
        cJSON_AddItemToObject(object, "fields", fields_of(&fabric->file));
    for (int i = 0; i < TL_FABRIC_TABLES; i++)
        add_options(object, &bindings[i]);
    tl_json_print(object);
}

bool tl_command_fabric(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count != 1)
        return tl_fail(error, TL_USAGE,
                       "fabric: expected one fabric or height map: a name, a file or a folder, as in "
                       "`toile fabric denim`");
    if (is_height_map(arguments->positionals[0]))
        return tl_fabric_bake(arguments, error);
    struct tl_fabric *fabric = TL_NEW(struct tl_fabric);
    char *source = source_of(arguments->positionals[0]);
    bool done = tl_fabric_open(source, fabric, error);
    if (done && arguments->output)
        done = tl_fabric_write(fabric, arguments->output, error);
    else if (done)
        print_fabric(fabric, arguments->json);
    tl_fabric_release(fabric);
    free(fabric);
    free(source);
    return done;
}
