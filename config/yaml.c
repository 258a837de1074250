#include "config/yaml.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

size_t tl_yaml_line(const struct tl_yaml *yaml)
{
    return yaml->event.start_mark.line + 1;
}

bool tl_yaml_fail(const struct tl_yaml *yaml, size_t line, const char *what)
{
    return tl_fail(yaml->error, TL_USAGE, "%s:%zu: %s", yaml->name, line, what);
}

const char *tl_yaml_text(const struct tl_yaml *yaml)
{
    return (const char *)yaml->event.data.scalar.value;
}

bool tl_yaml_is_empty(const struct tl_yaml *yaml)
{
    return yaml->event.type == YAML_SCALAR_EVENT && yaml->event.data.scalar.length == 0;
}

/* For bytes that are not UTF-8 libyaml reports an offset but no line. */
static size_t line_of_offset(const struct tl_yaml *yaml, size_t offset)
{
    size_t line = 1;
    for (size_t i = 0; i < offset && i < yaml->size; i++)
        line += yaml->data[i] == '\n';
    return line;
}

static bool fail_parser(const struct tl_yaml *yaml)
{
    const yaml_parser_t *parser = &yaml->parser;
    const char *problem = parser->problem ? parser->problem : "out of memory";
    if (parser->error == YAML_READER_ERROR)
        return tl_fail(yaml->error, TL_USAGE, "%s:%zu: %s: write the file as UTF-8 text", yaml->name,
                       line_of_offset(yaml, parser->problem_offset), problem);
    return tl_fail(
        yaml->error, TL_USAGE,
        "%s:%zu: not valid YAML: %s%s%s: check the indentation (spaces, no tabs), quotes and brackets",
        yaml->name, parser->problem_mark.line + 1, parser->context ? parser->context : "",
        parser->context ? ", " : "", problem);
}

bool tl_yaml_next(struct tl_yaml *yaml)
{
    yaml_event_delete(&yaml->event);
    if (!yaml_parser_parse(&yaml->parser, &yaml->event))
        return fail_parser(yaml);
    const yaml_event_t *event = &yaml->event;
    const yaml_char_t *anchor = NULL, *tag = NULL;
    switch (event->type) {
    case YAML_ALIAS_EVENT:
        return tl_yaml_fail(yaml, tl_yaml_line(yaml),
                            "aliases (*name) are not used here: write the value out");
    case YAML_SCALAR_EVENT:
        anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
        if (memchr(event->data.scalar.value, '\0', event->data.scalar.length))
            return tl_yaml_fail(yaml, tl_yaml_line(yaml), "a zero byte stands in the text: remove it");
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
        return tl_yaml_fail(yaml, tl_yaml_line(yaml), "anchors (&name) are not used here: remove it");
    if (tag)
        return tl_yaml_fail(yaml, tl_yaml_line(yaml), "tags (!name) are not used here: remove it");
    return true;
}

char *tl_yaml_value(struct tl_yaml *yaml, bool may_be_list, const char *key)
{
    if (yaml->event.type == YAML_SCALAR_EVENT)
        return tl_copy_string(tl_yaml_text(yaml));
    size_t line = tl_yaml_line(yaml);
    bool list = yaml->event.type == YAML_SEQUENCE_START_EVENT;
    if (!list || !may_be_list) {
        tl_fail(yaml->error, TL_USAGE, "%s:%zu: %s: is a %s: expected one value", yaml->name, line, key,
                list ? "list" : "table inside a table");
        return NULL;
    }
    char *text = tl_copy_string("[");
    for (int items = 0; tl_yaml_next(yaml); items++) {
        bool end = yaml->event.type == YAML_SEQUENCE_END_EVENT;
        if (!end && (yaml->event.type != YAML_SCALAR_EVENT || items == 3)) {
            tl_fail(yaml->error, TL_USAGE,
                    "%s:%zu: %s: is a long or nested list: expected one value or [a, b, c]", yaml->name, line,
                    key);
            break;
        }
        char *longer = tl_format("%s%s%s", text, items && !end ? ", " : "", end ? "]" : tl_yaml_text(yaml));
        free(text);
        text = longer;
        if (end)
            return text;
    }
    free(text);
    return NULL;
}

bool tl_yaml_read(struct tl_yaml *yaml, bool (*read_root)(void *context), void *context)
{
    bool started = tl_yaml_next(yaml);
    if (!started || !tl_yaml_next(yaml))
        return false;
    if (yaml->event.type == YAML_STREAM_END_EVENT)
        return true;
    if (!tl_yaml_next(yaml) || !read_root(context))
        return false;
    bool ended = tl_yaml_next(yaml);
    if (!ended || !tl_yaml_next(yaml))
        return false;
    return yaml->event.type == YAML_STREAM_END_EVENT ||
           tl_yaml_fail(yaml, tl_yaml_line(yaml), "a second document begins: keep one to a file");
}

/* The encoding is set so that libyaml refuses UTF-16. It then takes the byte order mark that some editors put
 * before UTF-8 for a character that indents the first line, so the mark is skipped here. */
bool tl_yaml_begin(struct tl_yaml *yaml, const char *name, const char *data, size_t size, tl_error *error)
{
    size_t mark = size >= 3 && memcmp(data, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    *yaml = (struct tl_yaml){.name = name, .data = data + mark, .size = size - mark, .error = error};
    if (!yaml_parser_initialize(&yaml->parser))
        return tl_fail(error, TL_USAGE, "%s: the YAML reader could not be started", name);
    yaml_parser_set_encoding(&yaml->parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&yaml->parser, (const unsigned char *)yaml->data, yaml->size);
    return true;
}

void tl_yaml_end(struct tl_yaml *yaml)
{
    yaml_event_delete(&yaml->event);
    yaml_parser_delete(&yaml->parser);
}
