#include "app/fabric/fields.h"

#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tl_fabric_fields_print(const tl_fabric_file *file)
{
    size_t used = 0;
    for (size_t i = 0; i < file->field_count; i++) {
        const struct tl_fabric_field *field = &file->fields[i];
        printf("%-44s %-34s %s\n", field->name, field->value, field->use);
        used += field->is_used;
    }
    printf("%zu of %zu fields are used\n\n", used, file->field_count);
}

cJSON *tl_fabric_fields_json(const tl_fabric_file *file)
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

const struct tl_fabric_field *tl_fabric_field_of(const tl_fabric_file *file, const char *option)
{
    for (size_t i = 0; i < file->field_count; i++)
        if (file->fields[i].is_used && strncmp(file->fields[i].use, option, strlen(option)) == 0)
            return &file->fields[i];
    return NULL;
}

static const char *reason_of(const struct tl_fabric_field *field)
{
    static const char prefix[] = "not used: ";
    bool has_prefix = strncmp(field->use, prefix, strlen(prefix)) == 0;
    return field->use + (has_prefix ? strlen(prefix) : 0);
}

char *tl_fabric_fields_unused(const tl_fabric_file *file)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    const char *last = ""; /* neighbours often share a reason, which is then given once */
    for (size_t i = 0; i < file->field_count; i++) {
        const struct tl_fabric_field *field = &file->fields[i];
        if (field->is_used)
            continue;
        bool is_same = strcmp(reason_of(field), last) == 0;
        if (last[0] && !is_same)
            fprintf(out, " (%s); ", last);
        fprintf(out, "%s%s", is_same ? ", " : "", field->name);
        last = reason_of(field);
    }
    if (last[0])
        fprintf(out, " (%s)", last);
    fclose(out);
    return text;
}
