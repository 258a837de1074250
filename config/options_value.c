#include "config/options_value.h"

#include "config/file.h"
#include "config/memory.h"
#include "config/words.h"

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
    int most = single ? 9 : 17; /* digits that always suffice for IEEE 754 */
    int precision = 1;
    for (double power = 10; precision < 7 && fabs(value) >= power; power *= 10)
        precision++; /* %g turns to exponents when the digits before the point outnumber the precision */
    for (;; precision++) {
        char *text = format_number("%.*g", precision, value);
        double back = parse_number(text, NULL);
        if (precision >= most || (single ? (float)back == (float)value : back == value))
            return text;
        free(text);
    }
}

/* Length in bytes of the UTF-8 character at `text` and its code point; 0 when it is malformed. */
static size_t decode(const unsigned char *text, uint32_t *code)
{
    static const uint32_t smallest[5] = {0, 0, 0x80, 0x800,
                                         0x10000}; /* by length: overlong forms are refused */
    size_t length = text[0] < 0x80 ? 1 : text[0] < 0xC0 ? 0 : text[0] < 0xE0 ? 2 : text[0] < 0xF0 ? 3 : 4;
    if (length == 0 || text[0] > 0xF4)
        return 0;
    *code = length == 1 ? text[0] : text[0] & (0x7Fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xC0) != 0x80)
            return 0;
        *code = *code << 6 | (text[i] & 0x3Fu);
    }
    bool surrogate = *code >= 0xD800 && *code <= 0xDFFF;
    return *code < smallest[length] || *code > 0x10FFFF || surrogate ? 0 : length;
}

/* Whether YAML can hold the text between quotes without an escape. Line breaks and the byte order mark need
 * one here, too. */
static bool is_printable(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    while (*c) {
        uint32_t code = 0;
        size_t length = decode(c, &code);
        bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
        bool special = code == 0x2028 || code == 0x2029 || code == 0xFEFF || code == 0xFFFE || code == 0xFFFF;
        if (length == 0 || control || special)
            return false;
        c += length;
    }
    return true;
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

static bool is_single(const struct tl_option *row)
{
    return row->type == TL_FLOAT || row->type == TL_COLOUR || row->type == TL_VECTOR;
}

static char *describe_range(const char *what, const struct tl_option *row)
{
    char *low = shortest_number(row->minimum, is_single(row));
    char *high = shortest_number(row->maximum, is_single(row));
    char *text = tl_format("%s from %s to %s%s%s", what, low, high, row->unit[0] ? " " : "", row->unit);
    free(low);
    free(high);
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
        return describe_range("[r, g, b], each", row);
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

/* Reason for a refusal: the text, what is wrong with it, what was expected. New string. */
static char *refuse(const struct tl_option *row, const char *text, const char *fault)
{
    char *expected = tl_option_expectation(row);
    const char *near = NULL;
    if (row->choices)
        near = tl_nearest_word(text, row->choices, tl_count_words(row->choices));
    char *reason =
        tl_format("%s %s: expected %s%s%s%s", text[0] ? tl_excerpt_of(text).text : "an empty value", fault,
                  expected, near ? ": did you mean " : "", near ? near : "", near ? "?" : "");
    free(expected);
    return reason;
}

static char *read_bool(const struct tl_option *row, const char *text, bool *field)
{
    static const char *const words[] = {"false", "true", "no", "yes", "off", "on"};
    for (size_t i = 0; i < TL_COUNT(words); i++)
        if (strcmp(text, words[i]) == 0) {
            *field = i % 2 == 1;
            return NULL;
        }
    return refuse(row, text, "is neither");
}

static char *read_int(const struct tl_option *row, const char *text, int *field)
{
    char *end = NULL;
    long long value =
        strtoll(text, &end, 10); /* beyond its range it gives the nearest end: out of ours too */
    bool plain = text[strspn(text, "+-0123456789")] == '\0';
    if (!plain || end == text || *end != '\0')
        return refuse(row, text, "is not a whole number");
    if ((double)value < row->minimum || (double)value > row->maximum || value < INT_MIN || value > INT_MAX)
        return refuse(row, text, "is out of range");
    *field = (int)value;
    return NULL;
}

/* One number of the row's range; `whole` is the text that a message shows. Single precision is compared in
 * single precision: a limit of 0.001f lies above 0.001, yet 0.001 must be within it. */
static char *read_number(const struct tl_option *row, const char *text, const char *whole, double *value)
{
    bool plain =
        text[strspn(text, "+-.eE0123456789")] == '\0'; /* keeps out nan, inf, hexadecimals and blanks */
    char *end = NULL;
    *value = plain ? parse_number(text, &end) : 0;
    if (!plain || end == text || *end != '\0')
        return refuse(row, whole, "is not a number");
    double minimum = row->minimum, maximum = row->maximum;
    if (is_single(row)) {
        *value = (double)(float)*value;
        minimum = (double)(float)minimum;
        maximum = (double)(float)maximum;
    }
    if (!isfinite(*value) || *value < minimum || *value > maximum)
        return refuse(row, whole, "is out of range");
    return NULL;
}

static char *read_scalar(const struct tl_option *row, const char *text, void *field)
{
    double value = 0;
    char *reason = read_number(row, text, text, &value);
    if (reason)
        return reason;
    if (row->type == TL_FLOAT)
        *(float *)field = (float)value;
    else
        *(double *)field = value;
    return NULL;
}

/* "[r, g, b]", the brackets left out or not. */
static char *read_triple(const struct tl_option *row, const char *text, float *field)
{
    size_t length = strlen(text);
    bool brackets = length >= 2 && text[0] == '[' && text[length - 1] == ']';
    char *copy = tl_copy_string(text + brackets);
    copy[length - 2 * (size_t)brackets] = '\0';
    float values[3];
    char *reason = NULL, *rest = copy;
    size_t count = 0;
    for (char *item; !reason && (item = strsep(&rest, ",")) != NULL; count++) {
        item += strspn(item, " ");
        item[strcspn(item, " ")] = '\0';
        double value = 0;
        reason = count < 3 ? read_number(row, item, text, &value)
                           : refuse(row, text, "has more than three numbers");
        if (!reason)
            values[count] = (float)value;
    }
    free(copy);
    if (!reason && count < 3)
        reason = refuse(row, text, "has fewer than three numbers");
    if (!reason)
        memcpy(field, values, sizeof values);
    return reason;
}

static char *read_enum(const struct tl_option *row, const char *text, int *field)
{
    for (int i = 0; row->choices[i]; i++)
        if (strcmp(text, row->choices[i]) == 0) {
            *field = i;
            return NULL;
        }
    return refuse(row, text, "is not one of its values");
}

static char *read_text(const struct tl_option *row, const char *text, char field[TL_STRING_SIZE])
{
    if (!is_printable(text))
        return refuse(row, text, "is not printable UTF-8");
    if (strlen(text) >= TL_STRING_SIZE)
        return tl_format("%zu bytes are too many: expected %d at most", strlen(text), TL_STRING_SIZE - 1);
    strncpy(field, text, TL_STRING_SIZE); /* clears the rest: equal values are equal bytes */
    return NULL;
}

static bool is_choice(const char *const *choices, const char *text)
{
    for (size_t i = 0; choices[i]; i++)
        if (strcmp(text, choices[i]) == 0)
            return true;
    return false;
}

static char *read_path(const struct tl_option *row, const char *text, const char *base_file, char *field)
{
    bool name = row->choices && !tl_option_is_file_name(text);
    if (name && !is_choice(row->choices, text))
        return refuse(row, text, "is no name known here");
    if (name || text[0] == '\0')
        return read_text(row, text, field);
    char *path = tl_path_relative_to(base_file, text);
    char *reason = read_text(row, path, field);
    free(path);
    return reason;
}

char *tl_option_read(const struct tl_option *row, const char *text, const char *base_file, void *field)
{
    switch (row->type) {
    case TL_BOOL:
        return read_bool(row, text, field);
    case TL_INT:
        return read_int(row, text, field);
    case TL_FLOAT:
    case TL_DOUBLE:
        return read_scalar(row, text, field);
    case TL_ENUM:
        return read_enum(row, text, field);
    case TL_COLOUR:
    case TL_VECTOR:
        return read_triple(row, text, field);
    case TL_STRING:
        return read_text(row, text, field);
    case TL_PATH:
        break;
    }
    return read_path(row, text, base_file, field);
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
    return tl_copy_string(field);
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
    return TL_STRING_SIZE;
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
    return strcmp(a, b) == 0;
}
