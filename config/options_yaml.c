/* A scene file is a mapping of tables to mappings of options. The reader hands each scalar to tl_options_set
 * as text: YAML's own types (is `on` a boolean? is 1e3?) never matter, the option's row decides. */
#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/options.h"
#include "config/options_value.h"
#include "config/yaml.h"

#include <stdlib.h>
#include <string.h>

struct yaml_reader {
    struct tl_yaml yaml;
    const struct tl_binding *bindings;
    size_t count;
    const struct tl_record_section *section; /* or NULL */
    size_t section_line;                     /* where it was given, 0: not yet */
    const struct tl_option_list *list;       /* or NULL */
    /* [binding][row, or the table itself as the last]: line where it was given, 0: not yet */
    size_t **given;
};

/* Remembers that something is given on `line`; false when it was given before. */
static bool give(const struct yaml_reader *reader, size_t *given, const char *key, size_t line)
{
    if (*given)
        return tl_fail(reader->yaml.error, TL_USAGE,
                       "%s:%zu: %s: is given twice, first on line %zu: remove one", reader->yaml.name, line,
                       key, *given);
    *given = line;
    return true;
}

/* The current event is an option's name; its value follows. */
static bool read_option(struct yaml_reader *reader, const struct tl_binding *binding)
{
    size_t line = tl_yaml_line(&reader->yaml);
    if (reader->yaml.event.type != YAML_SCALAR_EVENT)
        return tl_yaml_fail(&reader->yaml, line,
                            "a list or table stands where an option's name was expected");
    const struct tl_option *row = tl_options_find_row(binding->table, tl_yaml_text(&reader->yaml));
    char *key = tl_format("%s.%s", binding->table->name, tl_yaml_text(&reader->yaml));
    char *where = tl_format("%s:%zu", reader->yaml.name, line);
    bool is_list = !row || (row->type != TL_STRING && row->type != TL_PATH);
    char *text = tl_yaml_next(&reader->yaml) ? tl_yaml_value(&reader->yaml, is_list, key) : NULL;
    bool set = text && tl_options_set(reader->bindings, reader->count, key, text, where, reader->yaml.name,
                                      reader->yaml.error);
    if (set)
        set = give(reader, &reader->given[binding - reader->bindings][row - binding->table->rows], key, line);
    free(text);
    free(where);
    free(key);
    return set;
}

static bool fail_no_table(const struct yaml_reader *reader, const char *key, size_t line)
{
    const char *dot = strchr(key, '.');
    if (dot)
        return tl_fail(reader->yaml.error, TL_USAGE,
                       "%s:%zu: %s: stands outside a table: write it as `%.*s: {%s: ...}`", reader->yaml.name,
                       line, tl_excerpt_of(key).text, (int)(dot - key), key, dot + 1);
    return tl_fail(reader->yaml.error, TL_USAGE,
                   "%s:%zu: %s: is no table: expected options, indented below it", reader->yaml.name, line,
                   tl_excerpt_of(key).text);
}

/* The binding that the table's name in the current event belongs to, given for the first time; NULL on
 * failure. The next event, already current, is its mapping or an empty scalar. */
static const struct tl_binding *read_table_name(struct yaml_reader *reader)
{
    size_t line = tl_yaml_line(&reader->yaml);
    char *name = tl_copy_string(tl_yaml_text(&reader->yaml));
    char *where = tl_format("%s:%zu", reader->yaml.name, line);
    const struct tl_binding *binding =
        tl_options_find_table(reader->bindings, reader->count, name, strlen(name));
    bool good = tl_yaml_next(&reader->yaml);
    bool listed = binding && reader->list && binding->table == reader->list->table;
    if (good && listed && reader->yaml.event.type != YAML_SEQUENCE_START_EVENT)
        good = tl_fail(reader->yaml.error, TL_USAGE, "%s: %s: expected a list, as in `- {%s: ...}`", where,
                       name, binding->table->rows->name);
    else if (good && !listed && !tl_yaml_is_empty(&reader->yaml) &&
             reader->yaml.event.type != YAML_MAPPING_START_EVENT)
        good = fail_no_table(reader, name, line);
    if (good && !binding)
        tl_options_fail_table(reader->bindings, reader->count, name, where, reader->yaml.error);
    if (good && binding)
        good =
            give(reader, &reader->given[binding - reader->bindings][binding->table->row_count], name, line);
    free(where);
    free(name);
    return good ? binding : NULL;
}

/* ---- The section of records ---- */

static bool read_records(struct yaml_reader *reader, const struct tl_record_place *above, int depth);

/* The current event is the name of what is at `depth` in the section: a record, a part or a key; what
 * belongs to it follows. */
static bool read_record(struct yaml_reader *reader, const struct tl_record_place *above, int depth)
{
    if (reader->yaml.event.type != YAML_SCALAR_EVENT)
        return tl_yaml_fail(&reader->yaml, tl_yaml_line(&reader->yaml),
                            "a list or table stands where a name was expected");
    char *name = tl_copy_string(tl_yaml_text(&reader->yaml)), *text = NULL;
    struct tl_record_place place = *above;
    place.line = tl_yaml_line(&reader->yaml);
    const char **const names[] = {&place.record, &place.part, &place.key};
    *names[depth] = name;
    const struct tl_record_section *section = reader->section;
    bool good = tl_yaml_next(&reader->yaml);
    if (good && place.key) {
        char *key = tl_format("%s.%s.%s.%s", section->name, place.record, place.part, place.key);
        text = tl_yaml_value(&reader->yaml, true, key);
        free(key);
        good = text != NULL;
    }
    good = good && section->take(section->context, &place, text, reader->yaml.error);
    if (good && !place.key)
        good = read_records(reader, &place, depth + 1);
    free(text);
    free(name);
    return good;
}

/* The current event begins a mapping of names at `depth`, or is empty. */
static bool read_records(struct yaml_reader *reader, const struct tl_record_place *above, int depth)
{
    static const char *const expected[] = {
        "expected names, each with its parts, indented below",
        "expected parts, as in `bodice: {fabric: denim}`",
        "expected options, as in `{diffuse: [0.1, 0.2, 0.5]}`",
    };
    if (tl_yaml_is_empty(&reader->yaml))
        return true;
    if (reader->yaml.event.type != YAML_MAPPING_START_EVENT)
        return tl_yaml_fail(&reader->yaml, tl_yaml_line(&reader->yaml), expected[depth]);
    while (tl_yaml_next(&reader->yaml)) {
        if (reader->yaml.event.type == YAML_MAPPING_END_EVENT)
            return true;
        if (!read_record(reader, above, depth))
            return false;
    }
    return false;
}

static bool is_section(const struct yaml_reader *reader)
{
    return reader->section && reader->yaml.event.type == YAML_SCALAR_EVENT &&
           strcmp(tl_yaml_text(&reader->yaml), reader->section->name) == 0;
}

/* The current event is the section's name. */
static bool read_section(struct yaml_reader *reader)
{
    const struct tl_record_place place = {.file = reader->yaml.name};
    size_t line = tl_yaml_line(&reader->yaml);
    return give(reader, &reader->section_line, reader->section->name, line) && tl_yaml_next(&reader->yaml) &&
           read_records(reader, &place, 0);
}

/* The current event begins a mapping of options. */
static bool read_options(struct yaml_reader *reader, const struct tl_binding *binding)
{
    while (tl_yaml_next(&reader->yaml)) {
        if (reader->yaml.event.type == YAML_MAPPING_END_EVENT)
            return true;
        if (!read_option(reader, binding))
            return false;
    }
    return false;
}

/* The current event begins a list of mappings. */
static bool read_list(struct yaml_reader *reader, const struct tl_binding *binding)
{
    while (tl_yaml_next(&reader->yaml)) {
        if (reader->yaml.event.type == YAML_SEQUENCE_END_EVENT)
            return true;
        size_t line = tl_yaml_line(&reader->yaml);
        if (reader->yaml.event.type != YAML_MAPPING_START_EVENT)
            return tl_yaml_fail(&reader->yaml, line, "expected `- {option: value}`");
        tl_options_reset(binding, 1);
        memset(reader->given[binding - reader->bindings], 0, binding->table->row_count * sizeof(size_t));
        if (!read_options(reader, binding) ||
            !reader->list->take(reader->list->context, reader->yaml.name, line, reader->yaml.error))
            return false;
    }
    return false;
}

/* The current event is a table's name; its mapping follows. */
static bool read_table(struct yaml_reader *reader)
{
    if (reader->yaml.event.type != YAML_SCALAR_EVENT)
        return tl_yaml_fail(&reader->yaml, tl_yaml_line(&reader->yaml),
                            "a list or table stands where a table's name was expected");
    if (is_section(reader))
        return read_section(reader);
    const struct tl_binding *binding = read_table_name(reader);
    if (!binding || tl_yaml_is_empty(&reader->yaml))
        return binding != NULL;
    return reader->yaml.event.type == YAML_SEQUENCE_START_EVENT ? read_list(reader, binding)
                                                                : read_options(reader, binding);
}

static bool read_root(void *context)
{
    struct yaml_reader *reader = context;
    const yaml_event_t *event = &reader->yaml.event;
    if (tl_yaml_is_empty(&reader->yaml))
        return true;
    if (event->type != YAML_MAPPING_START_EVENT)
        return tl_yaml_fail(&reader->yaml, tl_yaml_line(&reader->yaml),
                            "expected tables of options, as in `light: {regions: 96}`");
    while (tl_yaml_next(&reader->yaml)) {
        if (event->type == YAML_MAPPING_END_EVENT)
            return true;
        if (!read_table(reader))
            return false;
    }
    return false;
}

bool tl_options_read_yaml(const struct tl_binding *bindings, size_t count, const char *name, const char *data,
                          size_t size, tl_error *error)
{
    return tl_options_read_yaml_with(bindings, count, NULL, name, data, size, error);
}

static bool read_document(struct yaml_reader *reader, const char *name, const char *data, size_t size,
                          tl_error *error)
{
    if (size > TL_LIMIT_YAML_BYTES)
        return tl_fail(error, TL_USAGE, "%s: is larger than 1 MiB: that is no list of options", name);
    if (!tl_yaml_begin(&reader->yaml, name, data, size, error))
        return false;
    reader->given = TL_NEW_ARRAY(size_t *, reader->count);
    for (size_t i = 0; i < reader->count; i++)
        reader->given[i] = TL_NEW_ARRAY(size_t, reader->bindings[i].table->row_count + 1);
    bool read = tl_yaml_read(&reader->yaml, read_root, reader);
    for (size_t i = 0; i < reader->count; i++)
        free(reader->given[i]);
    free(reader->given);
    tl_yaml_end(&reader->yaml);
    return read;
}

bool tl_options_read_yaml_with(const struct tl_binding *bindings, size_t count,
                               const struct tl_record_section *section, const char *name, const char *data,
                               size_t size, tl_error *error)
{
    struct yaml_reader reader = {.bindings = bindings, .count = count, .section = section};
    return read_document(&reader, name, data, size, error);
}

bool tl_options_read_yaml_list(const struct tl_binding *bindings, size_t count,
                               const struct tl_option_list *list, const char *path, tl_error *error)
{
    struct yaml_reader reader = {.bindings = bindings, .count = count, .list = list};
    char *data = NULL;
    size_t size = 0;
    if (!tl_file_read_small(path, TL_LIMIT_YAML_BYTES, &data, &size, error))
        return false;
    bool read = read_document(&reader, path, data, size, error);
    free(data);
    return read;
}

bool tl_options_read_yaml_file(const struct tl_binding *bindings, size_t count, const char *path,
                               tl_error *error)
{
    return tl_options_read_yaml_file_with(bindings, count, NULL, path, error);
}

bool tl_options_read_yaml_file_with(const struct tl_binding *bindings, size_t count,
                                    const struct tl_record_section *section, const char *path,
                                    tl_error *error)
{
    char *data = NULL;
    size_t size = 0;
    if (!tl_file_read_small(path, TL_LIMIT_YAML_BYTES, &data, &size, error))
        return false;
    bool read = tl_options_read_yaml_with(bindings, count, section, path, data, size, error);
    free(data);
    return read;
}
