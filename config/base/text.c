#include "config/base/text.h"

#include "config/base/file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool tl_text_open(const char *path, struct tl_text *out, tl_error *error)
{
    size_t size;
    *out = (struct tl_text){.path = path};
    if (!tl_file_read(path, &out->data, &size, error))
        return false;
    out->next = out->data;
    out->end = out->data + size;
    out->plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return true;
}

void tl_text_close(struct tl_text *text)
{
    if (text->plain)
        freelocale(text->plain);
    free(text->data);
    *text = (struct tl_text){0};
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0';
}

/* Ends the line at `next` with a NUL and moves beyond it. */
static void cut_line(struct tl_text *text)
{
    char *c = text->next;
    text->word = c;
    text->line++;
    for (; c < text->end && *c != '\n' && *c != '\r'; c++) {
        if (*c == '\0')
            *c = ' ';
        bool joins = *c == '\\' && c + 1 < text->end && (c[1] == '\n' || c[1] == '\r');
        if (!joins)
            continue;
        bool two = c[1] == '\r' && c + 2 < text->end && c[2] == '\n';
        memset(c, ' ', two ? 3 : 2);
        text->line++;
    }
    text->next = c;
    if (c < text->end) {
        text->next += c[0] == '\r' && c + 1 < text->end && c[1] == '\n' ? 2 : 1;
        *c = '\0'; /* at the end of the data there is a NUL already */
    }
}

bool tl_text_next(struct tl_text *text)
{
    while (text->next < text->end) {
        cut_line(text);
        while (*text->word && is_blank(*text->word))
            text->word++;
        if (*text->word && *text->word != '#')
            return true;
    }
    return false;
}

char *tl_text_line(struct tl_text *text)
{
    return tl_text_next(text) ? tl_text_word(text) : NULL;
}

char *tl_text_word(struct tl_text *text)
{
    char *word = text->word;
    while (*word && is_blank(*word))
        word++;
    if (*word == '\0')
        return NULL;
    char *end = word;
    while (!is_blank(*end))
        end++;
    text->word = *end ? end + 1 : end;
    *end = '\0';
    return word;
}

char *tl_text_rest(struct tl_text *text)
{
    char *rest = text->word;
    while (*rest && is_blank(*rest))
        rest++;
    size_t length = strlen(rest);
    while (length > 0 && is_blank(rest[length - 1]))
        rest[--length] = '\0';
    text->word = rest + length;
    return rest;
}

bool tl_text_numbers(struct tl_text *text, const char *what, int count, float *out, tl_error *error)
{
    for (int i = 0; i < count; i++) {
        char *word = tl_text_word(text), *end = word;
        if (!word)
            return tl_fail(error, TL_INPUT, "%s: line %zu: %s of %d numbers, not %d: export the file again",
                           text->path, text->line, what, i, count);
        out[i] = strtof_l(word, &end, text->plain);
        if (end == word || *end || !isfinite(out[i]))
            return tl_fail(error, TL_INPUT, "%s: line %zu: %s: \"%.40s\" is no number: export the file again",
                           text->path, text->line, what, word);
    }
    return true;
}
