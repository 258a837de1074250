#include "config/options_value.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/base/words.h"

#include <errno.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Numbers are read and written in the C locale, whatever the program's locale is: 0.5 is never 0,5. */
static double parse_number(const char *text, char **end)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    double value = strtod_l(text, end, plain);
    freelocale(plain);
    return value;
}

static char *format_number(const char *format, int precision, double value)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    locale_t before = uselocale(plain);
    char text[64];
    snprintf(text, sizeof text, format, precision, value);
    uselocale(before);
    freelocale(plain);
    return tl_copy_string(text);
}

/* The shortest decimal that reads back to the same value: 0.05, not 0.0500000007; 100, not 1e+02. */
static char *shortest_number(double value, bool single)
{
    int maximum = single ? 9 : 17; /* digits that always suffice for IEEE 754 */
    int precision = 1;
    for (double power = 10; precision < 7 && fabs(value) >= power; power *= 10)
        precision++; /* %g turns to exponents when the digits before the point outnumber the precision */
    for (;; precision++) {
        char *text = format_number("%.*g", precision, value);
        double back = parse_number(text, NULL);
        if (precision >= maximum || (single ? (float)back == (float)value : back == value))
            return text;
        free(text);
    }
}

struct tl_excerpt tl_excerpt_of(const char *text)
{
    struct tl_excerpt excerpt;
    size_t length = strlen(text), room = sizeof excerpt.text - sizeof "...";
    bool cut = length > room;
    if (cut)
        for (length = room; length > 0 && ((unsigned char)text[length] & 0xC0) == 0x80;)
            length--; /* back to the border of a character */
    snprintf(excerpt.text, sizeof excerpt.text, "%.*s%s", (int)length, text, cut ? "..." : "");
    return excerpt;
}

bool tl_option_is_file_name(const char *text)
{
    return strpbrk(text, "./") != NULL;
}

bool tl_option_is_single(const struct tl_option *row)
{
    return row->type == TL_FLOAT || row->type == TL_COLOUR || row->type == TL_VECTOR;
}

static char *describe_range(const char *what, const struct tl_option *row)
{
    char *low = shortest_number(row->minimum, tl_option_is_single(row));
    char *high = shortest_number(row->maximum, tl_option_is_single(row));
    char *text = tl_format("%s from %s to %s%s%s", what, low, high, row->unit[0] ? " " : "", row->unit);
    free(low);
    free(high);
    return text;
}

static char *describe_colour(const struct tl_option *row)
{
    char *numbers = describe_range("[r, g, b], each", row);
    char *text = tl_format("%s, \"#rrggbb\", lab(L, a, b) or a CSS name", numbers);
    free(numbers);
    return text;
}

char *tl_option_expectation(const struct tl_option *row)
{
    switch (row->type) {
    case TL_BOOL:
        return tl_copy_string("true or false");
    case TL_INT:
        return describe_range("a whole number", row);
    case TL_FLOAT:
    case TL_DOUBLE:
        return describe_range("a number", row);
    case TL_ENUM:
        return tl_join_words(row->choices, tl_count_words(row->choices), ", ", " or ");
    case TL_COLOUR:
        return describe_colour(row);
    case TL_VECTOR:
        return describe_range("[x, y, z], each", row);
    case TL_STRING:
        return tl_copy_string("text");
    case TL_PATH:
        break;
    }
    if (!row->choices)
        return tl_copy_string("a file name");
    char *names = tl_join_words(row->choices, tl_count_words(row->choices), ", ", ", ");
    char *text = tl_format("%s or a file name with its extension", names);
    free(names);
    return text;
}

char *tl_option_refuse(const struct tl_option *row, const char *text, const char *fault, const char *near)
{
    char *expected = tl_option_expectation(row);
    char *reason =
        tl_format("%s %s: expected %s%s%s%s", text[0] ? tl_excerpt_of(text).text : "an empty value", fault,
                  expected, near ? ": did you mean " : "", near ? near : "", near ? "?" : "");
    free(expected);
    return reason;
}

bool tl_option_parse_number(const char *text, double *value)
{
    bool plain =
        text[strspn(text, "+-.eE0123456789")] == '\0'; /* keeps out nan, inf, hexadecimals and blanks */
    char *end = NULL;
    *value = plain ? parse_number(text, &end) : 0;
    return plain && end != text && *end == '\0';
}

static char *write_triple(const float *field)
{
    char *items[3];
    for (int i = 0; i < 3; i++)
        items[i] = shortest_number((double)field[i], true);
    char *text = tl_format("[%s, %s, %s]", items[0], items[1], items[2]);
    for (int i = 0; i < 3; i++)
        free(items[i]);
    return text;
}

char *tl_option_write(const struct tl_option *row, const void *field)
{
    switch (row->type) {
    case TL_BOOL:
        return tl_copy_string(*(const bool *)field ? "true" : "false");
    case TL_INT:
        return tl_format("%d", *(const int *)field);
    case TL_FLOAT:
        return shortest_number((double)*(const float *)field, true);
    case TL_DOUBLE:
        return shortest_number(*(const double *)field, false);
    case TL_ENUM:
        return tl_copy_string(row->choices[*(const int *)field]);
    case TL_COLOUR:
    case TL_VECTOR:
        return write_triple(field);
    case TL_STRING:
    case TL_PATH:
        break;
    }
    return tl_copy_string(tl_option_text(field));
}

size_t tl_option_size(const struct tl_option *row)
{
    switch (row->type) {
    case TL_BOOL:
        return sizeof(bool);
    case TL_INT:
    case TL_ENUM:
        return sizeof(int);
    case TL_FLOAT:
        return sizeof(float);
    case TL_DOUBLE:
        return sizeof(double);
    case TL_COLOUR:
    case TL_VECTOR:
        return 3 * sizeof(float);
    case TL_STRING:
    case TL_PATH:
        break;
    }
    return sizeof(const char *);
}

static bool is_same_triple(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

bool tl_option_equal(const struct tl_option *row, const void *a, const void *b)
{
    switch (row->type) {
    case TL_BOOL:
        return *(const bool *)a == *(const bool *)b;
    case TL_INT:
    case TL_ENUM:
        return *(const int *)a == *(const int *)b;
    case TL_FLOAT:
        return *(const float *)a == *(const float *)b;
    case TL_DOUBLE:
        return *(const double *)a == *(const double *)b;
    case TL_COLOUR:
    case TL_VECTOR:
        return is_same_triple(a, b);
    case TL_STRING:
    case TL_PATH:
        break;
    }
    return strcmp(tl_option_text(a), tl_option_text(b)) == 0;
}
