/* A scene file is a mapping of tables to mappings of options. The reader follows libyaml's events, which
 * carry line numbers, and hands each scalar to tl_options_set as text: YAML's own types (is `on` a boolean?
 * is 1e3?) never matter, the option's row decides. */
#include "config/file.h"
#include "config/memory.h"
#include "config/options.h"
#include "config/options_value.h"

#include <yaml.h>

#include <stdlib.h>
#include <string.h>

struct reader {
    const struct tl_binding *bindings;
    size_t count;
    const struct tl_record_section *section; /* or NULL */
    size_t section_line;                     /* where it was given, 0: not yet */
    const char *name;
    const char *data;
    size_t size;
    yaml_parser_t parser;
    yaml_event_t event; /* the current one */
    /* [binding][row, or the table itself as the last]: line where it was given, 0: not yet */
    size_t **given;
    tl_error *error;
};

static size_t line_of(const yaml_event_t *event)
{
    return event->start_mark.line + 1;
}

static bool fail(const struct reader *reader, size_t line, const char *what)
{
    return tl_fail(reader->error, TL_USAGE, "%s:%zu: %s", reader->name, line, what);
}

/* Bytes that are no characters have no line yet; libyaml knows their offset. */
static size_t line_of_offset(const struct reader *reader, size_t offset)
{
    size_t line = 1;
    for (size_t i = 0; i < offset && i < reader->size; i++)
        line += reader->data[i] == '\n';
    return line;
}

static bool fail_parser(const struct reader *reader)
{
    const yaml_parser_t *parser = &reader->parser;
    const char *problem = parser->problem ? parser->problem : "out of memory";
    if (parser->error == YAML_READER_ERROR)
        return tl_fail(reader->error, TL_USAGE, "%s:%zu: %s: write the file as UTF-8 text", reader->name,
                       line_of_offset(reader, parser->problem_offset), problem);
    return tl_fail(
        reader->error, TL_USAGE,
        "%s:%zu: not valid YAML: %s%s%s: check the indentation (spaces, no tabs), quotes and brackets",
        reader->name, parser->problem_mark.line + 1, parser->context ? parser->context : "",
        parser->context ? ", " : "", problem);
}

static bool next(struct reader *reader)
{
    yaml_event_delete(&reader->event);
    if (!yaml_parser_parse(&reader->parser, &reader->event))
        return fail_parser(reader);
    const yaml_event_t *event = &reader->event;
    const yaml_char_t *anchor = NULL, *tag = NULL;
    switch (event->type) {
    case YAML_ALIAS_EVENT:
        return fail(reader, line_of(event), "aliases (*name) are not used here: write the value out");
    case YAML_SCALAR_EVENT:
        anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
        if (memchr(event->data.scalar.value, '\0', event->data.scalar.length))
            return fail(reader, line_of(event), "a zero byte stands in the text: remove it");
        break;
    case YAML_SEQUENCE_START_EVENT:
        anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
        break;
    case YAML_MAPPING_START_EVENT:
        anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
        break;
    default:
        break;
    }
    if (anchor)
        return fail(reader, line_of(event), "anchors (&name) are not used here: remove it");
    if (tag)
        return fail(reader, line_of(event), "tags (!name) are not used here: remove it");
    return true;
}

static const char *scalar_text(const struct reader *reader)
{
    return (const char *)reader->event.data.scalar.value;
}

/* Nothing stands where a value or a table could: `light:` alone. */
static bool is_empty(const struct reader *reader)
{
    return reader->event.type == YAML_SCALAR_EVENT && reader->event.data.scalar.length == 0;
}

/* The text of a value: a scalar as it is, a list of scalars as "[a, b, c]". `row` is NULL when the key is
 * unknown. New string, NULL on failure. */
static char *read_value(struct reader *reader, const struct tl_option *row, const char *key)
{
    if (reader->event.type == YAML_SCALAR_EVENT)
        return tl_copy_string(scalar_text(reader));
    size_t line = line_of(&reader->event);
    bool list = reader->event.type == YAML_SEQUENCE_START_EVENT;
    if (!list || (row && (row->type == TL_STRING || row->type == TL_PATH))) {
        tl_fail(reader->error, TL_USAGE, "%s:%zu: %s: is a %s: expected one value", reader->name, line, key,
                list ? "list" : "table inside a table");
        return NULL;
    }
    char *text = tl_copy_string("[");
    for (int items = 0; next(reader); items++) {
        bool end = reader->event.type == YAML_SEQUENCE_END_EVENT;
        if (!end && (reader->event.type != YAML_SCALAR_EVENT || items == 3)) {
            tl_fail(reader->error, TL_USAGE,
                    "%s:%zu: %s: is a long or nested list: expected one value or [a, b, c]", reader->name,
                    line, key);
            break;
        }
        char *longer = tl_format("%s%s%s", text, items && !end ? ", " : "", end ? "]" : scalar_text(reader));
        free(text);
        text = longer;
        if (end)
            return text;
    }
    free(text);
    return NULL;
}

/* Remembers that something is given on `line`; false when it was given before. */
static bool give(const struct reader *reader, size_t *given, const char *key, size_t line)
{
    if (*given)
        return tl_fail(reader->error, TL_USAGE, "%s:%zu: %s: is given twice, first on line %zu: remove one",
                       reader->name, line, key, *given);
    *given = line;
    return true;
}

/* The current event is an option's name; its value follows. */
static bool read_option(struct reader *reader, const struct tl_binding *binding)
{
    size_t line = line_of(&reader->event);
    if (reader->event.type != YAML_SCALAR_EVENT)
        return fail(reader, line, "a list or table stands where an option's name was expected");
    const struct tl_option *row = tl_options_find_row(binding->table, scalar_text(reader));
    char *key = tl_format("%s.%s", binding->table->name, scalar_text(reader));
    char *where = tl_format("%s:%zu", reader->name, line);
    char *text = next(reader) ? read_value(reader, row, key) : NULL;
    bool set = text &&
               tl_options_set(reader->bindings, reader->count, key, text, where, reader->name, reader->error);
    if (set)
        set = give(reader, &reader->given[binding - reader->bindings][row - binding->table->rows], key, line);
    free(text);
    free(where);
    free(key);
    return set;
}

static bool fail_no_table(const struct reader *reader, const char *key, size_t line)
{
    const char *dot = strchr(key, '.');
    if (dot)
        return tl_fail(reader->error, TL_USAGE,
                       "%s:%zu: %s: stands outside a table: write it as `%.*s: {%s: ...}`", reader->name,
                       line, tl_excerpt_of(key).text, (int)(dot - key), key, dot + 1);
    return tl_fail(reader->error, TL_USAGE, "%s:%zu: %s: is no table: expected options, indented below it",
                   reader->name, line, tl_excerpt_of(key).text);
}

/* The binding that the table's name in the current event belongs to, given for the first time; NULL on
 * failure. The next event, already current, is its mapping or an empty scalar. */
static const struct tl_binding *read_table_name(struct reader *reader)
{
    size_t line = line_of(&reader->event);
    char *name = tl_copy_string(scalar_text(reader));
    char *where = tl_format("%s:%zu", reader->name, line);
    const struct tl_binding *binding =
        tl_options_find_table(reader->bindings, reader->count, name, strlen(name));
    bool good = next(reader);
    if (good && !is_empty(reader) && reader->event.type != YAML_MAPPING_START_EVENT)
        good = fail_no_table(reader, name, line);
    if (good && !binding)
        tl_options_fail_table(reader->bindings, reader->count, name, where, reader->error);
    if (good && binding)
        good =
            give(reader, &reader->given[binding - reader->bindings][binding->table->row_count], name, line);
    free(where);
    free(name);
    return good ? binding : NULL;
}

/* ---- The section of records ---- */

static bool read_records(struct reader *reader, const struct tl_record_place *above, int depth);

/* The current event is the name of what is at `depth` in the section: a record, a part or a key; what
 * belongs to it follows. */
static bool read_record(struct reader *reader, const struct tl_record_place *above, int depth)
{
    if (reader->event.type != YAML_SCALAR_EVENT)
        return fail(reader, line_of(&reader->event), "a list or table stands where a name was expected");
    char *name = tl_copy_string(scalar_text(reader)), *text = NULL;
    struct tl_record_place place = *above;
    place.line = line_of(&reader->event);
    const char **const names[] = {&place.record, &place.part, &place.key};
    *names[depth] = name;
    const struct tl_record_section *section = reader->section;
    bool good = next(reader);
    if (good && place.key) {
        char *key = tl_format("%s.%s.%s.%s", section->name, place.record, place.part, place.key);
        text = read_value(reader, NULL, key);
        free(key);
        good = text != NULL;
    }
    good = good && section->take(section->context, &place, text, reader->error);
    if (good && !place.key)
        good = read_records(reader, &place, depth + 1);
    free(text);
    free(name);
    return good;
}

/* The current event begins a mapping of names at `depth`, or is empty. */
static bool read_records(struct reader *reader, const struct tl_record_place *above, int depth)
{
    static const char *const expected[] = {
        "expected names, each with its parts, indented below",
        "expected parts, as in `bodice: {fabric: denim}`",
        "expected options, as in `{diffuse: [0.1, 0.2, 0.5]}`",
    };
    if (is_empty(reader))
        return true;
    if (reader->event.type != YAML_MAPPING_START_EVENT)
        return fail(reader, line_of(&reader->event), expected[depth]);
    while (next(reader)) {
        if (reader->event.type == YAML_MAPPING_END_EVENT)
            return true;
        if (!read_record(reader, above, depth))
            return false;
    }
    return false;
}

static bool is_section(const struct reader *reader)
{
    return reader->section && reader->event.type == YAML_SCALAR_EVENT &&
           strcmp(scalar_text(reader), reader->section->name) == 0;
}

/* The current event is the section's name. */
static bool read_section(struct reader *reader)
{
    const struct tl_record_place place = {.file = reader->name};
    size_t line = line_of(&reader->event);
    return give(reader, &reader->section_line, reader->section->name, line) && next(reader) &&
           read_records(reader, &place, 0);
}

/* The current event is a table's name; its mapping follows. */
static bool read_table(struct reader *reader)
{
    if (reader->event.type != YAML_SCALAR_EVENT)
        return fail(reader, line_of(&reader->event),
                    "a list or table stands where a table's name was expected");
    if (is_section(reader))
        return read_section(reader);
    const struct tl_binding *binding = read_table_name(reader);
    if (!binding || is_empty(reader))
        return binding != NULL;
    while (next(reader)) {
        if (reader->event.type == YAML_MAPPING_END_EVENT)
            return true;
        if (!read_option(reader, binding))
            return false;
    }
    return false;
}

static bool read_root(struct reader *reader)
{
    const yaml_event_t *event = &reader->event;
    if (is_empty(reader))
        return true;
    if (event->type != YAML_MAPPING_START_EVENT)
        return fail(reader, line_of(event), "expected tables of options, as in `light: {regions: 96}`");
    while (next(reader)) {
        if (event->type == YAML_MAPPING_END_EVENT)
            return true;
        if (!read_table(reader))
            return false;
    }
    return false;
}

static bool read_stream(struct reader *reader)
{
    bool started = next(reader);
    if (!started || !next(reader))
        return false;
    if (reader->event.type == YAML_STREAM_END_EVENT)
        return true; /* nothing but comments */
    if (!next(reader) || !read_root(reader))
        return false;
    bool ended = next(reader);
    if (!ended || !next(reader))
        return false;
    if (reader->event.type != YAML_STREAM_END_EVENT)
        return fail(reader, line_of(&reader->event), "a second document begins: keep one to a file");
    return true;
}

bool tl_options_read_yaml(const struct tl_binding *bindings, size_t count, const char *name, const char *data,
                          size_t size, tl_error *error)
{
    return tl_options_read_yaml_with(bindings, count, NULL, name, data, size, error);
}

bool tl_options_read_yaml_with(const struct tl_binding *bindings, size_t count,
                               const struct tl_record_section *section, const char *name, const char *data,
                               size_t size, tl_error *error)
{
    if (size > TL_LIMIT_YAML_BYTES)
        return tl_fail(error, TL_USAGE, "%s: is larger than 1 MiB: that is no list of options", name);
    /* Told the encoding, libyaml refuses UTF-16, but also takes the mark that some editors put before UTF-8
     * for a character that indents the first line. */
    size_t mark = size >= 3 && memcmp(data, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    struct reader reader = {.bindings = bindings,
                            .count = count,
                            .section = section,
                            .name = name,
                            .data = data + mark,
                            .size = size - mark,
                            .error = error};
    if (!yaml_parser_initialize(&reader.parser))
        return tl_fail(error, TL_USAGE, "%s: the YAML reader could not be started", name);
    yaml_parser_set_encoding(&reader.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&reader.parser, (const unsigned char *)reader.data, reader.size);
    reader.given = TL_NEW_ARRAY(size_t *, count);
    for (size_t i = 0; i < count; i++)
        reader.given[i] = TL_NEW_ARRAY(size_t, bindings[i].table->row_count + 1);
    bool read = read_stream(&reader);
    for (size_t i = 0; i < count; i++)
        free(reader.given[i]);
    free(reader.given);
    yaml_event_delete(&reader.event);
    yaml_parser_delete(&reader.parser);
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
