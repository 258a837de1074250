#include "config/options.h"

#include "config/base/hash.h"
#include "config/base/intern.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/base/words.h"
#include "config/options_value.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static bool is_text(const struct tl_option *row)
{
    return row->type == TL_STRING || row->type == TL_PATH;
}

/* Defaults that leave a text out mean "". */
void tl_options_reset(const struct tl_binding *bindings, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct tl_option_table *table = bindings[i].table;
        memcpy(bindings[i].params, table->defaults, table->params_size);
        for (size_t r = 0; r < table->row_count; r++)
            if (is_text(&table->rows[r]))
                tl_options_copy(&table->rows[r], table->defaults, bindings[i].params);
    }
}

const struct tl_binding *tl_options_find_table(const struct tl_binding *bindings, size_t count,
                                               const char *name, size_t length)
{
    for (size_t i = 0; i < count; i++)
        if (strlen(bindings[i].table->name) == length && memcmp(bindings[i].table->name, name, length) == 0)
            return &bindings[i];
    return NULL;
}

const struct tl_option *tl_options_find_row(const struct tl_option_table *table, const char *name)
{
    for (size_t i = 0; i < table->row_count; i++)
        if (strcmp(table->rows[i].name, name) == 0)
            return &table->rows[i];
    return NULL;
}

bool tl_options_fail_table(const struct tl_binding *bindings, size_t count, const char *name,
                           const char *where, tl_error *error)
{
    const char **names = TL_NEW_ARRAY(const char *, count);
    for (size_t i = 0; i < count; i++)
        names[i] = bindings[i].table->name;
    const char *near = tl_nearest_word(name, names, count);
    if (near)
        tl_fail(error, TL_USAGE, "%s: %s: no such table: did you mean %s?", where, tl_excerpt_of(name).text,
                near);
    else {
        char *list = tl_join_words(names, count, ", ", ", ");
        tl_fail(error, TL_USAGE, "%s: %s: no such table: expected one of %s", where, tl_excerpt_of(name).text,
                list);
        free(list);
    }
    free(names);
    return false;
}

/* A row that has this name in whatever table: people remember names better than tables. */
static const struct tl_binding *find_row_anywhere(const struct tl_binding *bindings, size_t count,
                                                  const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (tl_options_find_row(bindings[i].table, name))
            return &bindings[i];
    return NULL;
}

static bool fail_row(const struct tl_binding *bindings, size_t count, const struct tl_option_table *table,
                     const char *name, const char *where, tl_error *error)
{
    const char **names = TL_NEW_ARRAY(const char *, table->row_count);
    for (size_t i = 0; i < table->row_count; i++)
        names[i] = table->rows[i].name;
    const char *near = tl_nearest_word(name, names, table->row_count);
    const struct tl_binding *elsewhere = find_row_anywhere(bindings, count, name);
    const char *near_table = near || !elsewhere ? table->name : elsewhere->table->name;
    struct tl_excerpt shown = tl_excerpt_of(name);
    if (near || elsewhere)
        tl_fail(error, TL_USAGE, "%s: %s.%s: no such option: did you mean %s.%s?", where, table->name,
                shown.text, near_table, near ? near : name);
    else {
        char *list = tl_join_words(names, table->row_count, ", ", ", ");
        tl_fail(error, TL_USAGE, "%s: %s.%s: no such option: %s has %s", where, table->name, shown.text,
                table->name, list);
        free(list);
    }
    free(names);
    return false;
}

/* A key without a dot. */
static bool fail_key(const struct tl_binding *bindings, size_t count, const char *key, const char *where,
                     tl_error *error)
{
    const struct tl_binding *binding = find_row_anywhere(bindings, count, key);
    if (binding)
        return tl_fail(error, TL_USAGE, "%s: %s: lacks its table: did you mean %s.%s?", where, key,
                       binding->table->name, key);
    return tl_fail(error, TL_USAGE, "%s: %s: lacks its table: expected table.option, as in %s.%s", where,
                   tl_excerpt_of(key).text, bindings[0].table->name, bindings[0].table->rows[0].name);
}

#define WARNED_MAX 64 /* lines; those beyond are written each time */

/* Whether a line was not noted before: settings are read again whenever a layer of them changes. */
static bool note_line(const char *line)
{
    static pthread_mutex_t guard = PTHREAD_MUTEX_INITIALIZER;
    static uint64_t noted[WARNED_MAX];
    static size_t count;
    const uint64_t hash = tl_hash(TL_HASH_START, line, strlen(line));
    bool is_new = true;
    pthread_mutex_lock(&guard);
    for (size_t i = 0; i < count; i++)
        is_new = is_new && noted[i] != hash;
    if (is_new && count < WARNED_MAX)
        noted[count++] = hash;
    pthread_mutex_unlock(&guard);
    return is_new;
}

static void warn_of_remark(const struct tl_option *row, const char *text, const char *where, const char *key)
{
    char *remark = tl_option_remark(row, text);
    char *line = tl_format("%s: %s: %s", where, key, remark ? remark : "");
    if (remark && note_line(line))
        tl_warn("%s", line);
    free(line);
    free(remark);
}

bool tl_options_set(const struct tl_binding *bindings, size_t count, const char *key, const char *text,
                    const char *where, const char *base_file, tl_error *error)
{
    const char *dot = strchr(key, '.');
    if (!dot)
        return fail_key(bindings, count, key, where, error);
    const struct tl_binding *binding = tl_options_find_table(bindings, count, key, (size_t)(dot - key));
    if (!binding) {
        char *table = tl_format("%.*s", (int)(dot - key), key);
        tl_options_fail_table(bindings, count, table, where, error);
        free(table);
        return false;
    }
    const struct tl_option *row = tl_options_find_row(binding->table, dot + 1);
    if (!row)
        return fail_row(bindings, count, binding->table, dot + 1, where, error);
    char *reason = tl_option_read(row, text, base_file, (char *)binding->params + row->offset);
    if (!reason) {
        warn_of_remark(row, text, where, key);
        return true;
    }
    tl_fail(error, TL_USAGE, "%s: %s: %s", where, key, reason);
    free(reason);
    return false;
}

bool tl_options_set_assignment(const struct tl_binding *bindings, size_t count, const char *assignment,
                               tl_error *error)
{
    const char *equals = strchr(assignment, '=');
    if (!equals)
        return tl_fail(error, TL_USAGE, "--set: %s: has no value: expected table.option=value",
                       tl_excerpt_of(assignment).text);
    char *key = tl_format("%.*s", (int)(equals - assignment), assignment);
    bool set = tl_options_set(bindings, count, key, equals + 1, "--set", NULL, error);
    free(key);
    return set;
}

char *tl_options_get_text(const struct tl_binding *binding, const struct tl_option *row)
{
    return tl_option_write(row, (const char *)binding->params + row->offset);
}

void tl_options_copy(const struct tl_option *row, const void *from, void *to)
{
    const char *value = (const char *)from + row->offset;
    const char *text = is_text(row) ? tl_option_text(value) : NULL;
    memcpy((char *)to + row->offset, text ? (const void *)&text : value, tl_option_size(row));
}

static void make_absolute(const char **path)
{
    char *folder = realpath(".", NULL), *whole = folder ? tl_format("%s/%s", folder, *path) : NULL;
    if (whole && strlen(whole) < TL_STRING_SIZE)
        *path = tl_intern(whole);
    free(whole);
    free(folder);
}

void tl_options_make_paths_absolute(const struct tl_binding *bindings, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < bindings[i].table->row_count; r++) {
            const struct tl_option *row = &bindings[i].table->rows[r];
            void *field = (char *)bindings[i].params + row->offset;
            const char *path = row->type == TL_PATH ? tl_option_text(field) : "";
            if (tl_option_is_file_name(path) && path[0] != '/')
                make_absolute(field);
        }
}

bool tl_options_equal(const struct tl_option_table *table, const void *a, const void *b)
{
    for (size_t i = 0; i < table->row_count; i++) {
        const struct tl_option *row = &table->rows[i];
        if (!tl_option_equal(row, (const char *)a + row->offset, (const char *)b + row->offset))
            return false;
    }
    return true;
}

bool tl_option_passes(const struct tl_option *row, struct tl_option_filter filter)
{
    return (row->affects & filter.any_of) && !(row->affects & filter.none_of);
}

bool tl_options_differ(const struct tl_binding *a, const struct tl_binding *b, size_t count,
                       struct tl_option_filter filter)
{
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < a[i].table->row_count; r++) {
            const struct tl_option *row = &a[i].table->rows[r];
            if (tl_option_passes(row, filter) &&
                !tl_option_equal(row, (const char *)a[i].params + row->offset,
                                 (const char *)b[i].params + row->offset))
                return true;
        }
    return false;
}

uint64_t tl_options_changes(const struct tl_binding *a, const struct tl_binding *b, size_t count)
{
    uint64_t changes = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < a[i].table->row_count; r++) {
            const struct tl_option *row = &a[i].table->rows[r];
            if (!tl_option_equal(row, (const char *)a[i].params + row->offset,
                                 (const char *)b[i].params + row->offset))
                changes |= row->affects;
        }
    return changes;
}

void tl_options_take(const struct tl_binding *from, const struct tl_binding *to, size_t count,
                     struct tl_option_filter filter)
{
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < from[i].table->row_count; r++)
            if (tl_option_passes(&from[i].table->rows[r], filter))
                tl_options_copy(&from[i].table->rows[r], from[i].params, to[i].params);
}

/* A name and a value end with a NUL or have a fixed size, so that no two lists of values make the same bytes.
 */
uint64_t tl_options_hash(const struct tl_binding *bindings, size_t count, struct tl_option_filter filter,
                         uint64_t hash)
{
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < bindings[i].table->row_count; r++) {
            const struct tl_option *row = &bindings[i].table->rows[r];
            const char *field = (const char *)bindings[i].params + row->offset;
            if (!tl_option_passes(row, filter))
                continue;
            hash = tl_hash(hash, row->name, strlen(row->name) + 1);
            hash = is_text(row) ? tl_hash(hash, tl_option_text(field), strlen(tl_option_text(field)) + 1)
                                : tl_hash(hash, field, tl_option_size(row));
        }
    return hash;
}
