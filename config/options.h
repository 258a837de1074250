/* Option tables: the one place where a parameter's name, type, range, unit and help stand.
 *
 * A technique declares a params struct, its defaults and one const tl_option_table. A tl_binding joins a
 * table to a value of its struct. From a list of bindings come the scene file's keys, --set, --help, the
 * reference page and the panel; nothing else knows any option by name.
 *
 *     struct tl_shadow_params { int map_size; float softness_m; };
 *     #define TL_SHADOW_DEFAULTS .map_size = 256, .softness_m = 0.05f
 *     static const struct tl_option rows[] = {
 *         TL_OPTION_INT(struct tl_shadow_params, map_size, AFFECTS, 1, 4096, "texels", "side of a map"),
 *         TL_OPTION_FLOAT(struct tl_shadow_params, softness_m, AFFECTS, 0, 10, "m", "..."),
 *     };
 *     const struct tl_option_table tl_shadow_options =
 *         TL_OPTION_TABLE("shadow", "...", rows, struct tl_shadow_params, TL_SHADOW_DEFAULTS);
 *
 * The third argument of a row is its column `affects` (below): what must be done again when the
 * option changes. A row without it does not compile.
 *
 * Field types by option type: TL_BOOL bool; TL_INT int; TL_FLOAT float; TL_DOUBLE double; TL_ENUM int (index
 * into `choices`); TL_COLOUR float[3] (linear Rec. 709); TL_VECTOR float[3] (written [x, y, z]); TL_STRING
 * and TL_PATH const char *, an interned text (config/base/intern.h) or a literal, so that params are copied
 * by assignment; NULL, in a struct that was never reset, stands for "". A relative TL_PATH is taken from the
 * folder of the file that names it. A TL_PATH with `choices` holds either one of these names, kept as it is,
 * or a file name; tl_option_is_file_name distinguishes them.
 *
 * NaN and infinities are refused everywhere; so is text that is not printable UTF-8, so that every value can
 * be written into YAML and JSON and read back.
 *
 * Errors: functions that can fail set TL_USAGE for a wrong key or value, and return false. Lifetime: tables
 * are static; bindings and params belong to the caller and are not kept; new strings are freed by the caller.
 * Threads: all functions are pure but for the files that they name: any thread, one at a time for each value
 * that is written to. */
#ifndef TOILE_CONFIG_OPTIONS_H
#define TOILE_CONFIG_OPTIONS_H

#include "config/base/error.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define TL_STRING_SIZE 1024 /* bytes of the longest text, with its NUL */

/* ---- The column `affects`: what must be done again when an option changes ---- */

/* Each row names all of its consequences, and nothing else lists options by name for this purpose: a new
 * option is one row. This file reads the column as a mask of bits only. The bits below are those of the
 * program as a whole: they stand here because rows on every floor name them, and app/ acts upon them. The
 * bits from TL_AFFECTS_RENDER on are the renderer's own (render/plan/affects.h). */
#define TL_AFFECTS_BIT(i) ((uint64_t)1 << (i))

/* Nothing is kept that depends on the option: it is read each time that it is used. Every row has at least
 * one bit, so a row that has no other consequence states this. */
#define TL_AFFECTS_NOTHING TL_AFFECTS_BIT(0)
/* Avatar and garment are loaded and the cloth is draped again. */
#define TL_AFFECTS_SCENE TL_AFFECTS_BIT(1)
/* The state in which the cloth settles: drapes that differ in it are not the same drape. */
#define TL_AFFECTS_DRAPE TL_AFFECTS_BIT(2)
/* Set in the cloth that is there, which moves on from its present state. */
#define TL_AFFECTS_CLOTH TL_AFFECTS_BIT(3)
/* The environment is read again. */
#define TL_AFFECTS_ENVIRONMENT TL_AFFECTS_BIT(4)
/* The materials and weaves of garment and avatar are made again. */
#define TL_AFFECTS_MATERIALS TL_AFFECTS_BIT(5)
/* A part of an appearance: what may differ between two appearances of one scene that are compared. */
#define TL_AFFECTS_APPEARANCE TL_AFFECTS_BIT(6)
/* Belongs to the garment: it has no meaning for another one. */
#define TL_AFFECTS_GARMENT TL_AFFECTS_BIT(7)
/* A change costs no more than a frame, so it is shown while a slider is being dragged; other changes wait
 * until the slider is released. */
#define TL_AFFECTS_AT_ONCE TL_AFFECTS_BIT(8)
/* The amount of work in a frame: times of recorded flights that differ in it cannot be compared. */
#define TL_AFFECTS_WORK TL_AFFECTS_BIT(9)

#define TL_AFFECTS_RENDER 16 /* the first bit of render/plan/affects.h */

/* ---- Tables ---- */

enum tl_option_type {
    TL_BOOL,
    TL_INT,
    TL_FLOAT,
    TL_DOUBLE,
    TL_ENUM,
    TL_COLOUR,
    TL_VECTOR,
    TL_STRING,
    TL_PATH
};

struct tl_option {
    const char *name; /* key inside its table: map_size */
    enum tl_option_type type;
    size_t offset;           /* of the field in the params struct */
    uint64_t affects;        /* what must be done again when it changes; never 0 */
    double minimum, maximum; /* inclusive; for TL_COLOUR and TL_VECTOR of each component; unused for text */
    const char *const
        *choices;     /* TL_ENUM: names, NULL-terminated; TL_PATH: NULL or names that are not files */
    const char *unit; /* "m", "texels", "" for none */
    const char *help; /* one line: what a larger value does */
};

struct tl_option_table {
    const char *name; /* first part of table.key */
    const char *help; /* one line */
    const struct tl_option *rows;
    size_t row_count;
    size_t params_size;   /* bytes of the params struct */
    const void *defaults; /* one value of it */
};

struct tl_binding {
    const struct tl_option_table *table;
    void *params;
};

/* The offset of a text; a field of another type does not compile. */
#define TL_OPTION_TEXT_OFFSET(s, field) _Generic(((s *)NULL)->field, const char * : offsetof(s, field))

/* clang-format off: it takes the braces of an initialiser for a block. */
#define TL_OPTION_BOOL(s, field, bits, text)                                                                 \
    {                                                                                                        \
#field, TL_BOOL, offsetof(s, field), bits, 0, 1, NULL, "", text                                      \
    }
#define TL_OPTION_INT(s, field, bits, lo, hi, u, text)                                                       \
    {                                                                                                        \
#field, TL_INT, offsetof(s, field), bits, lo, hi, NULL, u, text                                      \
    }
#define TL_OPTION_FLOAT(s, field, bits, lo, hi, u, text)                                                     \
    {                                                                                                        \
#field, TL_FLOAT, offsetof(s, field), bits, lo, hi, NULL, u, text                                    \
    }
#define TL_OPTION_DOUBLE(s, field, bits, lo, hi, u, text)                                                    \
    {                                                                                                        \
#field, TL_DOUBLE, offsetof(s, field), bits, lo, hi, NULL, u, text                                   \
    }
#define TL_OPTION_ENUM(s, field, bits, names, text)                                                          \
    {                                                                                                        \
#field, TL_ENUM, offsetof(s, field), bits, 0, 0, names, "", text                                     \
    }
#define TL_OPTION_COLOUR(s, field, bits, lo, hi, text)                                                       \
    {                                                                                                        \
#field, TL_COLOUR, offsetof(s, field), bits, lo, hi, NULL, "linear", text                            \
    }
#define TL_OPTION_VECTOR(s, field, bits, lo, hi, u, text)                                                    \
    {                                                                                                        \
#field, TL_VECTOR, offsetof(s, field), bits, lo, hi, NULL, u, text                                   \
    }
#define TL_OPTION_STRING(s, field, bits, text)                                                               \
    {                                                                                                        \
#field, TL_STRING, TL_OPTION_TEXT_OFFSET(s, field), bits, 0, 0, NULL, "", text                       \
    }
#define TL_OPTION_PATH(s, field, bits, text)                                                                 \
    {                                                                                                        \
#field, TL_PATH, TL_OPTION_TEXT_OFFSET(s, field), bits, 0, 0, NULL, "", text                         \
    }
#define TL_OPTION_NAME_OR_PATH(s, field, bits, names, text)                                                  \
    {                                                                                                        \
#field, TL_PATH, TL_OPTION_TEXT_OFFSET(s, field), bits, 0, 0, names, "", text                        \
    }
#define TL_OPTION_TABLE(label, text, row_array, s, ...)                                                      \
    {                                                                                                        \
        .name = (label), .help = (text), .rows = (row_array),                                                \
        .row_count = sizeof(row_array) / sizeof((row_array)[0]), .params_size = sizeof(s),                   \
        .defaults = &(const s)                                                                               \
        {                                                                                                    \
            __VA_ARGS__                                                                                      \
        }                                                                                                    \
    }
/* clang-format on */

/* Copies every table's defaults into its params. Errors: none. Lifetime: copies. Threads: pure. */
void tl_options_reset(const struct tl_binding *bindings, size_t count);

/* Sets one option from text. `key` is "table.name"; `where` ("scene.yaml:12" or "--set") begins the message
 * of a failure, which names the key, what was expected and, for an unknown key, the nearest known one.
 * `base_file` is the file that relative paths are taken from, or NULL for the working directory.
 * Errors: TL_USAGE; nothing is changed. Lifetime: the value is copied. Threads: pure. */
bool tl_options_set(const struct tl_binding *bindings, size_t count, const char *key, const char *text,
                    const char *where, const char *base_file, tl_error *error);

/* The warning about a text that tl_options_set takes: that a colour is drawn as another, and how
 * much these differ. tl_options_set warns of it. Errors: none. Lifetime: a new string, which the caller
 * frees; NULL for nothing. Threads: pure. */
char *tl_option_remark(const struct tl_option *row, const char *text);

/* Sets an option from "table.name=value", as --set takes it. Errors: TL_USAGE; nothing is changed. Lifetime:
 * the value is copied. Threads: pure. */
bool tl_options_set_assignment(const struct tl_binding *bindings, size_t count, const char *assignment,
                               tl_error *error);

#define TL_LIMIT_YAML_BYTES ((size_t)1 << 20)

/* Reads a YAML document: a mapping of table names to mappings of option names to scalars (or [r, g, b]).
 * `name` is the file's name for messages and the base of relative paths. Documents over TL_LIMIT_YAML_BYTES,
 * several documents, keys given twice, anchors, aliases, tags and nested structures are refused.
 * Errors: TL_USAGE; some options may have been set already, so callers discard the settings. Lifetime: `data`
 * is not kept. Threads: pure. */
bool tl_options_read_yaml(const struct tl_binding *bindings, size_t count, const char *name, const char *data,
                          size_t size, tl_error *error);

/* The same from a file. Errors: also TL_INPUT, when the file cannot be read. Lifetime: keeps nothing.
 * Threads: reads the file, else pure. */
bool tl_options_read_yaml_file(const struct tl_binding *bindings, size_t count, const char *path,
                               tl_error *error);

/* The position of a value in a section of records; parts that have not been read yet are NULL. */
struct tl_record_place {
    const char *file;
    size_t line;
    const char *record, *part, *key;
};

/* A section next to the tables, whose names are the document's own: RECORD: {PART: {key: value}}. The reader
 * calls `take` for every record and every part as it begins, then for each of its values, as text, in the
 * document's order; when it returns false, reading fails with its error. Lifetime: `place` and `text` are
 * valid during the call. Threads: the reader's. */
struct tl_record_section {
    const char *name;
    bool (*take)(void *context, const struct tl_record_place *place, const char *text, tl_error *error);
    void *context;
};

/* The same as tl_options_read_yaml and _file, of a document that may have this section (NULL: it may not).
 * Errors: the same, and those of the section's `take`. Lifetime: keeps nothing. Threads: the same. */
bool tl_options_read_yaml_with(const struct tl_binding *bindings, size_t count,
                               const struct tl_record_section *section, const char *name, const char *data,
                               size_t size, tl_error *error);

bool tl_options_read_yaml_file_with(const struct tl_binding *bindings, size_t count,
                                    const struct tl_record_section *section, const char *path,
                                    tl_error *error);

/* One of the tables as a list: TABLE: [{option: value}, ...]. For every item the reader sets its binding to
 * the defaults, reads the item and calls `take`, whose messages name `path` and `line`. */
struct tl_option_list {
    const struct tl_option_table *table; /* of one of the bindings */
    bool (*take)(void *context, const char *path, size_t line, tl_error *error);
    void *context;
};

/* The same as tl_options_read_yaml_file, of a document with such a list. Errors: the same, and those of
 * `take`. Lifetime: keeps nothing. Threads: the same. */
bool tl_options_read_yaml_list(const struct tl_binding *bindings, size_t count,
                               const struct tl_option_list *list, const char *path, tl_error *error);

/* The text of a TL_STRING or TL_PATH field; "" where the field is NULL. Errors: none. Lifetime: of the text.
 * Threads: pure. */
static inline const char *tl_option_text(const void *field)
{
    const char *text = *(const char *const *)field;
    return text ? text : "";
}

/* Whether a text field, which may be NULL, holds a text. Errors: none. Lifetime: keeps nothing. Threads:
 * pure. */
static inline bool tl_text_is_given(const char *text)
{
    return text && text[0] != '\0';
}

/* True when two fields of the row's type hold the same value. Errors: none. Lifetime: keeps nothing. Threads:
 * pure. */
bool tl_option_equal(const struct tl_option *row, const void *a, const void *b);

/* Chooses rows by what they affect: those that have a bit of `any_of` and no bit of `none_of`. True when the
 * row passes. Errors: none. Lifetime: keeps nothing. Threads: pure. */
struct tl_option_filter {
    uint64_t any_of, none_of;
};
bool tl_option_passes(const struct tl_option *row, struct tl_option_filter filter);

/* The rows that pass a filter, over lists of bindings to the same tables in the same order. `differ` is true
 * when a value differs, `changes` is what all rows affect whose values differ; `take` copies the values of
 * `from` into `to`; `hash` continues `hash` (config/base/hash.h) over names and values. Errors: none.
 * Lifetime: keeps nothing. Threads: pure. */
bool tl_options_differ(const struct tl_binding *a, const struct tl_binding *b, size_t count,
                       struct tl_option_filter filter);
uint64_t tl_options_changes(const struct tl_binding *a, const struct tl_binding *b, size_t count);
void tl_options_take(const struct tl_binding *from, const struct tl_binding *to, size_t count,
                     struct tl_option_filter filter);
uint64_t tl_options_hash(const struct tl_binding *bindings, size_t count, struct tl_option_filter filter,
                         uint64_t hash);

/* Copies one option from a params struct to another of the same table. Errors: none. Lifetime: copies.
 * Threads: pure. */
void tl_options_copy(const struct tl_option *row, const void *from, void *to);

/* True when the text of a TL_PATH with choices is a file's name: it has a dot or a slash in it. Errors: none.
 * Lifetime: keeps nothing. Threads: pure. */
bool tl_option_is_file_name(const char *text);

/* Makes every TL_PATH absolute, so that it means the same file wherever it is read next. Errors: none; a path
 * that would be too long stays as it is. Lifetime: interns texts. Threads: reads the working directory. */
void tl_options_make_paths_absolute(const struct tl_binding *bindings, size_t count);

/* The option's value as the text that tl_options_set takes back. Errors: none. Lifetime: a new string, which
 * the caller frees. Threads: pure. */
char *tl_options_get_text(const struct tl_binding *binding, const struct tl_option *row);

/* True when two values of the table's params struct agree in every option. Errors: none. Lifetime: keeps
 * nothing. Threads: pure. */
bool tl_options_equal(const struct tl_option_table *table, const void *a, const void *b);

/* Prints all options as help text (one line each), as a Markdown reference page, or as a YAML document that
 * tl_options_read_yaml reads back to the same values (relative paths are printed as they stand, so the
 * document must be read from the same working directory, under a name without a folder; a TL_PATH with
 * choices that is empty was left out, and is again).
 * Errors: none here; the caller checks `out` (ferror). Lifetime: keeps nothing. Threads: one at a time for
 * `out`. */
void tl_options_print_help(const struct tl_binding *bindings, size_t count, FILE *out);
void tl_options_print_reference(const struct tl_binding *bindings, size_t count, FILE *out);
void tl_options_print_yaml(const struct tl_binding *bindings, size_t count, FILE *out);

#endif
