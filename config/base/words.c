#include "config/base/words.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

size_t tl_count_words(const char *const *words)
{
    size_t count = 0;
    while (words[count])
        count++;
    return count;
}

char *tl_join_words(const char *const *words, size_t count, const char *link, const char *last_link)
{
    char *list = tl_copy_string(count ? words[0] : "");
    for (size_t i = 1; i < count; i++) {
        char *longer = tl_format("%s%s%s", list, i + 1 < count ? link : last_link, words[i]);
        free(list);
        list = longer;
    }
    return list;
}

static size_t min_size(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours, no part edited
 * twice (the restricted form of [Damerau 1964]). Three rows of the table suffice, because a swap
 * looks two rows back. */
static size_t alignment_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t width = b_length + 1;
    size_t *rows = TL_NEW_ARRAY(size_t, 3 * width);
    size_t *before = rows, *above = rows + width, *current = rows + 2 * width;
    for (size_t j = 0; j < width; j++)
        above[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        current[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t substitution = above[j - 1] + (a[i - 1] != b[j - 1]);
            current[j] = min_size(substitution, 1 + min_size(above[j], current[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                current[j] = min_size(current[j], before[j - 2] + 1);
        }
        size_t *oldest = before;
        before = above;
        above = current;
        current = oldest;
    }
    size_t distance = above[b_length];
    free(rows);
    return distance;
}

const char *tl_nearest_word(const char *word, const char *const *words, size_t count)
{
    size_t length = strlen(word);
    const char *nearest = NULL;
    size_t nearest_distance = 0;
    for (size_t i = 0; i < count; i++) {
        size_t other = strlen(words[i]);
        size_t longer = length > other ? length : other, shorter = min_size(length, other);
        size_t allowed = longer < 6 ? 1 : longer / 3;
        if (longer - shorter > allowed)
            continue; /* also keeps an absurdly long word from costing anything */
        size_t distance = alignment_distance(word, length, words[i], other);
        if (distance <= allowed && (!nearest || distance < nearest_distance)) {
            nearest = words[i];
            nearest_distance = distance;
        }
    }
    return nearest;
}
