#include "assets/environment/environment_sequence.h"

#include "assets/motion/sequence.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

bool tl_environment_is_sequence(const char *name)
{
    return tl_film_is(name) || tl_sequence_is_pattern(name);
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

static bool open_film(const char *path, tl_environment_sequence *out, tl_error *error)
{
    tl_film *film = tl_film_open(path, error);
    if (film)
        *out = (tl_environment_sequence){
            .pattern = tl_copy_string(path), .film = film, .count = tl_film_frame_count(film)};
    return film != NULL;
}

bool tl_environment_sequence_open(const char *pattern, tl_environment_sequence *out, tl_error *error)
{
    if (tl_film_is(pattern))
        return open_film(pattern, out, error);
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
    tl_film_close(&sequence->film);
    free(sequence->pattern);
    *sequence = (tl_environment_sequence){0};
}

int tl_environment_sequence_at(const tl_environment_sequence *sequence, double seconds, double rate)
{
    const double rounding = 1e-6; /* of a quotient that should be whole */
    if (sequence->count == 0)
        return 0;
    if (sequence->film && (rate < 0 || tl_film_is_live(sequence->pattern)))
        return tl_film_frame_at(sequence->film, seconds);
    return (int)fmod(floor(seconds * (rate < 0 ? 30 : rate) + rounding), sequence->count);
}

bool tl_environment_sequence_load(const tl_environment_sequence *sequence, int index, tl_environment *out,
                                  tl_error *error)
{
    tl_image frame;
    if (sequence->film)
        return tl_film_read(sequence->film, index, &frame, error) &&
               tl_environment_take(sequence->pattern, &frame, out, error);
    char *path = tl_sequence_path(sequence->pattern, sequence->first + index);
    bool loaded = tl_environment_load(path, out, error);
    free(path);
    return loaded;
}
