#include "assets/fabric/fabric_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

const char *const tl_picture_names[] = {"colour",  "normal",    "roughness", "metalness", "specular",
                                        "opacity", "occlusion", "height",    NULL};

void tl_fabric_add_field(tl_fabric_file *file, const char *name, char *value, bool is_used, char *use)
{
    file->fields = tl_resize(file->fields, file->field_count + 1, sizeof *file->fields);
    file->fields[file->field_count++] = (struct tl_fabric_field){tl_copy_string(name), value, use, is_used};
}

void tl_fabric_add_missing(tl_fabric_file *file, const char *name)
{
    file->missing = tl_resize(file->missing, file->missing_count + 1, sizeof *file->missing);
    file->missing[file->missing_count++] = tl_copy_string(name);
}

struct tl_fabric_picture tl_picture_plain(char *name)
{
    return (struct tl_fabric_picture){.file = name, .channel = -1, .factor = {1, 1, 1}};
}

cJSON *tl_fabric_parse_json(const tl_store *store, const char *name, tl_error *error)
{
    char *data, *place = tl_store_place(store, name);
    size_t size;
    const char *end = NULL;
    cJSON *root = NULL;
    if (tl_store_read(store, name, TL_LIMIT_FABRIC_JSON, &data, &size, error)) {
        root = cJSON_ParseWithLengthOpts(data, size, &end, false);
        size_t line = 1;
        for (const char *at = data; !root && end && at < end; at++)
            line += *at == '\n';
        if (!root)
            tl_fail(error, TL_INPUT, "%s:%zu: is no sound JSON: correct it, or write it again", place, line);
        free(data);
    }
    if (root && !cJSON_IsObject(root)) {
        cJSON_Delete(root);
        root = NULL;
        tl_fail(error, TL_INPUT, "%s: expected a JSON object", place);
    }
    free(place);
    return root;
}

void tl_fabric_set_name(tl_fabric_file *file, const char *name)
{
    size_t bytes = strlen(name);
    while (bytes >= sizeof file->name || (bytes > 0 && ((unsigned char)name[bytes] & 0xc0) == 0x80))
        bytes--; /* not within a letter of UTF-8 */
    memcpy(file->name, name, bytes);
    file->name[bytes] = '\0';
}

bool tl_fabric_file_has_pictures(const tl_fabric_file *file)
{
    for (int use = 0; use < TL_PICTURE_USES; use++)
        if (file->pictures[use].file)
            return true;
    return false;
}
