/* The subset of YAML that this program accepts: libyaml's events one by one, with the line of each. Anchors,
 * aliases, tags, zero bytes and second documents are refused; every scalar is plain text, whatever type YAML
 * gives it.
 *
 * Failure: one line, "NAME:LINE: what: remedy", TL_USAGE. Threads: pure. */
#ifndef TOILE_CONFIG_YAML_H
#define TOILE_CONFIG_YAML_H

#include "config/base/error.h"

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

/* Starts to read `data`; tl_yaml_end releases the parser, also after a failure. */
bool tl_yaml_begin(struct tl_yaml *yaml, const char *name, const char *data, size_t size, tl_error *error);
void tl_yaml_end(struct tl_yaml *yaml);

/* Moves to the next event. */
bool tl_yaml_next(struct tl_yaml *yaml);

/* Reads the only document: when `read_root` is called the document's first event is current, when it returns
 * the last one must be. It is not called for a file of comments only. */
bool tl_yaml_read(struct tl_yaml *yaml, bool (*read_root)(void *context), void *context);

size_t tl_yaml_line(const struct tl_yaml *yaml); /* of the current event */
/* Fails with "NAME:LINE: what". */
bool tl_yaml_fail(const struct tl_yaml *yaml, size_t line, const char *what);

/* The text of the current event, which must be a scalar. */
const char *tl_yaml_text(const struct tl_yaml *yaml);
/* Whether a key has no value, such as `light:` alone. */
bool tl_yaml_is_empty(const struct tl_yaml *yaml);

/* The text of the value that begins with the current event: a scalar as it is, or a list of up to three
 * scalars as "[a, b, c]" where lists are allowed. `key` is for messages. New string, NULL on failure. */
char *tl_yaml_value(struct tl_yaml *yaml, bool may_be_list, const char *key);

#endif
