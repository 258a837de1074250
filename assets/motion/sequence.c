#include "assets/motion/sequence.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS_MAX 9 /* of a number that an int holds */

/* A pattern in its parts. */
struct pattern {
    char *folder; /* with its last slash; "" for none */
    char *before; /* of the file name */
    char *after;
    int digits; /* number of # */
};

static const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool tl_sequence_is_pattern(const char *name)
{
    return strchr(file_name(name), '#') && !tl_file_exists(name);
}

static char *copy_part(const char *begin, const char *end)
{
    return tl_format("%.*s", (int)(end - begin), begin);
}

static bool split(const char *text, struct pattern *out, tl_error *error)
{
    const char *name = file_name(text), *begin = strchr(name, '#');
    const char *end = begin ? begin + strspn(begin, "#") : name;
    if (!begin || strchr(end, '#') || end - begin > DIGITS_MAX) {
        tl_fail(error, TL_USAGE, "%s: is no sequence: one run of up to %d # stands for the frame's number",
                text, DIGITS_MAX);
        return false;
    }
    *out = (struct pattern){.folder = copy_part(text, name),
                            .before = copy_part(name, begin),
                            .after = tl_copy_string(end),
                            .digits = (int)(end - begin)};
    return true;
}

static void pattern_release(struct pattern *pattern)
{
    free(pattern->folder);
    free(pattern->before);
    free(pattern->after);
}

/* The frame number in a file name, or -1 when the name does not match the pattern. */
static int frame_number(const struct pattern *pattern, const char *name)
{
    size_t before = strlen(pattern->before);
    if (strncmp(name, pattern->before, before) != 0)
        return -1;
    const char *number = name + before;
    size_t digits = strspn(number, "0123456789");
    bool as_wide = digits == (size_t)pattern->digits;
    bool wider = digits > (size_t)pattern->digits && number[0] != '0';
    if (digits > DIGITS_MAX || !(as_wide || wider) || strcmp(number + digits, pattern->after) != 0)
        return -1;
    return (int)strtol(number, NULL, 10);
}

static int compare_numbers(const void *a, const void *b)
{
    int first = *(const int *)a, second = *(const int *)b;
    return (first > second) - (first < second);
}

/* The frame numbers of the matching files, in order; free() them. NULL when the folder cannot be read. */
static int *list_numbers(const struct pattern *pattern, size_t *count)
{
    DIR *folder = opendir(pattern->folder[0] ? pattern->folder : ".");
    if (!folder)
        return NULL;
    size_t capacity = 64;
    int *numbers = TL_NEW_ARRAY(int, capacity);
    const struct dirent *entry;
    *count = 0;
    while ((entry = readdir(folder))) {
        int number = frame_number(pattern, entry->d_name);
        if (number < 0)
            continue;
        if (*count == capacity) {
            capacity *= 2;
            numbers = tl_resize(numbers, capacity, sizeof *numbers);
        }
        numbers[(*count)++] = number;
    }
    closedir(folder);
    qsort(numbers, *count, sizeof *numbers, compare_numbers);
    return numbers;
}

bool tl_sequence_list(const char *text, int **numbers, size_t *count, tl_error *error)
{
    struct pattern pattern;
    *numbers = NULL;
    *count = 0;
    if (!split(text, &pattern, error))
        return false;
    *numbers = list_numbers(&pattern, count);
    if (!*numbers)
        tl_fail(error, TL_INPUT, "%s: its folder cannot be read: %s", text, strerror(errno));
    else if (*count == 0)
        tl_fail(error, TL_INPUT, "%s: no file has such a name: one # stands for each digit", text);
    pattern_release(&pattern);
    if (*count > 0)
        return true;
    free(*numbers);
    *numbers = NULL;
    return false;
}

char *tl_sequence_path(const char *text, int number)
{
    struct pattern pattern = {0};
    if (!split(text, &pattern, NULL))
        return tl_copy_string(text);
    char *path =
        tl_format("%s%s%0*d%s", pattern.folder, pattern.before, pattern.digits, number, pattern.after);
    pattern_release(&pattern);
    return path;
}
