#include "app/view/memory/history.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct tl_history {
    struct tl_settings states[TL_HISTORY_EDITS + 1]; /* a ring */
    size_t first, count, present;                    /* counted from `first` */
};

static struct tl_settings *state_at(tl_history *history, size_t index)
{
    return &history->states[(history->first + index) % TL_COUNT(history->states)];
}

void tl_history_restore(const struct tl_settings *edit, struct tl_settings *settings)
{
    struct tl_settings restored = *edit;
    restored.camera = settings->camera;
    restored.image.width = settings->image.width;
    restored.image.height = settings->image.height;
    *settings = restored;
}

static bool is_same(const struct tl_settings *a, const struct tl_settings *b)
{
    struct tl_settings there = *b;
    tl_history_restore(a, &there);
    return tl_settings_equal(&there, b);
}

tl_history *tl_history_create(const struct tl_settings *first)
{
    tl_history *history = TL_NEW(tl_history);
    history->states[0] = *first;
    history->count = 1;
    return history;
}

void tl_history_destroy(tl_history **handle)
{
    free(*handle);
    *handle = NULL;
}

bool tl_history_note(tl_history *history, const struct tl_settings *settings)
{
    if (is_same(state_at(history, history->present), settings))
        return false;
    history->count = history->present + 1;
    if (history->count == TL_COUNT(history->states)) {
        history->first = (history->first + 1) % TL_COUNT(history->states);
        history->count--;
    }
    *state_at(history, history->count) = *settings;
    history->present = history->count++;
    return true;
}

const struct tl_settings *tl_history_undo(tl_history *history)
{
    return history->present > 0 ? state_at(history, --history->present) : NULL;
}

const struct tl_settings *tl_history_redo(tl_history *history)
{
    return history->present + 1 < history->count ? state_at(history, ++history->present) : NULL;
}

static char *describe_row(const struct tl_binding *from, const struct tl_binding *to,
                          const struct tl_option *row)
{
    char *before = tl_options_get_text(from, row), *after = tl_options_get_text(to, row);
    bool differs = strcmp(before, after) != 0;
    char *text = differs ? tl_format("%s.%s %s -> %s", from->table->name, row->name, before, after) : NULL;
    free(before);
    free(after);
    return text;
}

char *tl_history_describe(const struct tl_settings *from, const struct tl_settings *to)
{
    struct tl_settings old = *to;
    tl_history_restore(from, &old);
    struct tl_binding old_bindings[TL_SETTINGS_TABLES], new_bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&old, old_bindings);
    tl_settings_bind_const(to, new_bindings);
    char *first = NULL;
    size_t count = 0;
    for (size_t i = 0; i < TL_SETTINGS_TABLES; i++)
        for (size_t j = 0; j < old_bindings[i].table->row_count; j++) {
            char *text = describe_row(&old_bindings[i], &new_bindings[i], &old_bindings[i].table->rows[j]);
            count += text != NULL;
            if (!first)
                first = text;
            else
                free(text);
        }
    if (count <= 1)
        return first ? first : tl_copy_string("nothing");
    char *all = tl_format("%s and %zu more", first, count - 1);
    free(first);
    return all;
}
