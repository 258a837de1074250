/* YAML as this program takes it: libyaml's events one by one, with the line of each. Anchors, aliases, tags,
 * zero bytes and second documents are refused; every scalar is plain text, whatever YAML would take it for.
 *
 * Failure: one line, "NAME:LINE: what: remedy", TL_USAGE. Threads: pure. */
#ifndef TOILE_CONFIG_YAML_H
#define TOILE_CONFIG_YAML_H

#include "config/error.h"

#include <yaml.h>

#include <stddef.h>

struct tl_yaml {
    const char *name; /* of the file, for messages; borrowed, as data and error are */
    const char *data;
    size_t size;
    yaml_parser_t parser;
    yaml_event_t event; /* the current one */
    tl_error *error;
};

bool tl_yaml_begin(struct tl_yaml *yaml, const char *name, const char *data, size_t size, tl_error *error);
void tl_yaml_end(struct tl_yaml *yaml);

bool tl_yaml_next(struct tl_yaml *yaml);

/* Goes through the only document: `read_root` finds its first event current and leaves its last one so. Not
 * called when there is nothing but comments. */
bool tl_yaml_read(struct tl_yaml *yaml, bool (*read_root)(void *context), void *context);

size_t tl_yaml_line(const struct tl_yaml *yaml); /* of the current event */
bool tl_yaml_fail(const struct tl_yaml *yaml, size_t line, const char *what);

/* Of a current scalar. */
const char *tl_yaml_text(const struct tl_yaml *yaml);
/* Nothing stands where a value or a table could: `light:` alone. */
bool tl_yaml_is_empty(const struct tl_yaml *yaml);

/* The text of the value that begins with the current event: a scalar as it is, or a list of up to three
 * scalars as "[a, b, c]" where lists are allowed. `key` is for messages. New string, NULL on failure. */
char *tl_yaml_value(struct tl_yaml *yaml, bool may_be_list, const char *key);

#endif
