#include "app/view/memory/recent.h"

#include "app/view/memory/state.h"
#include "config/base/file.h"
#include "config/base/intern.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define ROW(number, index)                                                                                   \
    {                                                                                                        \
        "garment_" number, TL_STRING, offsetof(struct tl_recent, garments[index]), TL_AFFECTS_NOTHING, 0, 0, \
            NULL, "", "a file that was opened"                                                               \
    }

static const struct tl_option rows[TL_RECENT_MAX] = {ROW("1", 0), ROW("2", 1), ROW("3", 2), ROW("4", 3),
                                                     ROW("5", 4), ROW("6", 5), ROW("7", 6), ROW("8", 7),
                                                     ROW("9", 8), ROW("10", 9)};
static const struct tl_option_table table =
    TL_OPTION_TABLE("recent", "garments, the latest first", rows, struct tl_recent, .garments = {NULL});

void tl_recent_add(struct tl_recent *recent, const char *path)
{
    size_t at = 0; /* where it was, or the place of the oldest */
    if (strlen(path) >= TL_STRING_SIZE)
        return;
    while (at < TL_RECENT_MAX - 1 && strcmp(tl_option_text(&recent->garments[at]), path) != 0)
        at++;
    memmove(recent->garments + 1, recent->garments, at * sizeof *recent->garments);
    recent->garments[0] = tl_intern(path);
}

size_t tl_recent_count(const struct tl_recent *recent)
{
    size_t count = 0;
    while (count < TL_RECENT_MAX && tl_text_is_given(recent->garments[count]))
        count++;
    return count;
}

bool tl_recent_load(const char *file, struct tl_recent *out, tl_error *error)
{
    const struct tl_binding binding = {&table, out};
    tl_options_reset(&binding, 1);
    if (!tl_file_exists(file) || tl_options_read_yaml_file(&binding, 1, file, error))
        return true;
    tl_options_reset(&binding, 1);
    return false;
}

bool tl_recent_save(const char *file, const struct tl_recent *recent, tl_error *error)
{
    struct tl_recent copy = *recent; /* bindings can be written through */
    const struct tl_binding binding = {&table, &copy};
    return tl_state_write(file, &binding, 1, error);
}
