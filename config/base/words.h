/* Lists of words, for messages. Threads: pure. */
#ifndef TOILE_CONFIG_BASE_WORDS_H
#define TOILE_CONFIG_BASE_WORDS_H

#include <stddef.h>

/* Number of words before the NULL that ends the list. */
size_t tl_count_words(const char *const *words);

/* "a, b or c", with the links ", " and " or ": new string, empty for no words. */
char *tl_join_words(const char *const *words, size_t count, const char *link, const char *last_link);

/* The word of `words` nearest to `word` (optimal string alignment distance), or NULL when none is near enough
 * to be a likely slip: distance at most a third of the longer word, at least 1. */
const char *tl_nearest_word(const char *word, const char *const *words, size_t count);

#endif
