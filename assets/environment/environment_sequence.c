#include "assets/environment/environment_sequence.h"

#include "assets/motion/sequence.h"
#include "config/base/memory.h"

#include <stdlib.h>

bool tl_environment_is_sequence(const char *name)
{
    return tl_sequence_is_pattern(name);
}

static bool check_numbers(const char *pattern, const int *numbers, size_t count, tl_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (numbers[i] != numbers[0] + (int)i) {
            char *path = tl_sequence_path(pattern, numbers[0] + (int)i);
            tl_fail(error, TL_INPUT, "%s: is missing between frames %d and %d: write it again", path,
                    numbers[0], numbers[count - 1]);
            free(path);
            return false;
        }
    }
    return true;
}

bool tl_environment_sequence_open(const char *pattern, tl_environment_sequence *out, tl_error *error)
{
    int *numbers;
    size_t count;
    if (!tl_sequence_list(pattern, &numbers, &count, error))
        return false;
    bool opened = check_numbers(pattern, numbers, count, error);
    if (opened)
        *out = (tl_environment_sequence){
            .pattern = tl_copy_string(pattern), .first = numbers[0], .count = (int)count};
    free(numbers);
    return opened;
}

void tl_environment_sequence_release(tl_environment_sequence *sequence)
{
    free(sequence->pattern);
    *sequence = (tl_environment_sequence){0};
}

bool tl_environment_sequence_load(const tl_environment_sequence *sequence, int index, tl_environment *out,
                                  tl_error *error)
{
    char *path = tl_sequence_path(sequence->pattern, sequence->first + index);
    bool loaded = tl_environment_load(path, out, error);
    free(path);
    return loaded;
}
