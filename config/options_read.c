/* One value from its text. */
#include "config/base/file.h"
#include "config/base/intern.h"
#include "config/base/memory.h"
#include "config/base/words.h"
#include "config/colour/lab.h"
#include "config/colour/names.h"
#include "config/colour/srgb.h"
#include "config/options_value.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The same with the nearest of the row's choices. */
static char *refuse(const struct tl_option *row, const char *text, const char *fault)
{
    const char *near = NULL;
    if (row->choices)
        near = tl_nearest_word(text, row->choices, tl_count_words(row->choices));
    return tl_option_refuse(row, text, fault, near);
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
    if (!tl_option_parse_number(text, value))
        return refuse(row, whole, "is not a number");
    double minimum = row->minimum, maximum = row->maximum;
    if (tl_option_is_single(row)) {
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

static char *read_triple(const struct tl_option *row, const char *text, float field[3])
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

/* ---- Colours ---- */

static bool is_lab(const char *text)
{
    return strncasecmp(text, "lab", 3) == 0 && (text[3] == '(' || text[3] == ' ');
}

/* "lab(L, a, b)" or "Lab L a b": false when these are not three numbers. */
static bool parse_lab(const char *text, double of[3])
{
    const char *between = " ,", *stop = "";
    text += 3;
    text += strspn(text, " ");
    if (*text == '(') {
        text++;
        stop = ")";
    }
    for (int i = 0; i < 3; i++) {
        text += strspn(text, i > 0 ? between : " ");
        size_t length = strcspn(text, " ,)");
        char *item = tl_format("%.*s", (int)length, text);
        bool is_number = tl_option_parse_number(item, &of[i]);
        free(item);
        if (!is_number)
            return false;
        text += length;
    }
    text += strspn(text, " ");
    return strcmp(text, stop) == 0;
}

#define LAB_AB_MAX 128

static char *read_lab(const struct tl_option *row, const char *text, float rgb[3])
{
    double of[3];
    if (!parse_lab(text, of))
        return tl_option_refuse(row, text, "is not lab(L, a, b)", NULL);
    bool is_within = of[0] >= 0 && of[0] <= 100;
    for (int i = 1; i < 3; i++)
        is_within = is_within && of[i] >= -LAB_AB_MAX && of[i] <= LAB_AB_MAX;
    if (!is_within)
        return tl_option_refuse(row, text,
                                "is out of range: L is from 0 to 100, a and b are from -128 to 128", NULL);
    tl_lab_to_rgb((struct tl_lab){of[0], of[1], of[2]}, rgb);
    return NULL;
}

/* "#a1b2c3", or "#abc" for "#aabbcc". */
static char *read_hex(const struct tl_option *row, const char *text, float rgb[3])
{
    const char *digits = text + 1;
    size_t length = strlen(digits);
    if ((length != 3 && length != 6) || digits[strspn(digits, "0123456789abcdefABCDEF")] != '\0')
        return tl_option_refuse(row, text, "does not have three or six hexadecimal digits", NULL);
    uint32_t value = (uint32_t)strtoul(digits, NULL, 16);
    if (length == 3)
        value = 0x11 * ((value & 0xF00) << 8 | (value & 0xF0) << 4 | (value & 0xF));
    tl_srgb_decode(value, rgb);
    return NULL;
}

/* Letter case, blanks and hyphens do not matter: "Dark olive-green". */
static char *read_name(const struct tl_option *row, const char *text, float rgb[3])
{
    char *name = tl_copy_string(text), *end = name;
    for (const char *at = text; *at; at++)
        if (*at != ' ' && *at != '-')
            *end++ = (char)tolower((unsigned char)*at);
    *end = '\0';
    uint32_t value;
    char *reason = NULL;
    if (tl_colour_find(name, &value))
        tl_srgb_decode(value, rgb);
    else
        reason = tl_option_refuse(row, text, "is no name of a colour",
                                  tl_nearest_word(name, tl_colour_names, tl_count_words(tl_colour_names)));
    free(name);
    return reason;
}

static char *read_colour(const struct tl_option *row, const char *text, float field[3])
{
    float rgb[3] = {0};
    char *reason;
    if (text[0] == '\0')
        return tl_option_refuse(row, text, "is no colour (in a file, # begins a comment unless it is quoted)",
                                NULL);
    if (text[0] == '#')
        reason = read_hex(row, text, rgb);
    else if (is_lab(text))
        reason = read_lab(row, text, rgb);
    else if (isalpha((unsigned char)text[0]))
        reason = read_name(row, text, rgb);
    else
        return read_triple(row, text, field);
    for (int c = 0; !reason && c < 3; c++)
        if ((double)rgb[c] < row->minimum || (double)rgb[c] > row->maximum)
            reason = tl_option_refuse(row, text, "is out of range", NULL);
    if (!reason)
        memcpy(field, rgb, sizeof rgb);
    return reason;
}

/* ---- Names and text ---- */

static char *read_enum(const struct tl_option *row, const char *text, int *field)
{
    for (int i = 0; row->choices[i]; i++)
        if (strcmp(text, row->choices[i]) == 0) {
            *field = i;
            return NULL;
        }
    return refuse(row, text, "is not one of its values");
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

static char *read_text(const struct tl_option *row, const char *text, const char **field)
{
    if (!is_printable(text))
        return refuse(row, text, "is not printable UTF-8");
    if (strlen(text) >= TL_STRING_SIZE)
        return tl_format("%zu bytes are too many: expected %d at most", strlen(text), TL_STRING_SIZE - 1);
    *field = tl_intern(text);
    return NULL;
}

static bool is_choice(const char *const *choices, const char *text)
{
    for (size_t i = 0; choices[i]; i++)
        if (strcmp(text, choices[i]) == 0)
            return true;
    return false;
}

static char *read_path(const struct tl_option *row, const char *text, const char *base_file,
                       const char **field)
{
    bool name = row->choices && !tl_option_is_file_name(text);
    const bool is_stdin = strcmp(text, "-") == 0; /* readers of files refuse it when they open it */
    if (name && !is_stdin && !is_choice(row->choices, text))
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
        return read_colour(row, text, field);
    case TL_VECTOR:
        return read_triple(row, text, field);
    case TL_STRING:
        return read_text(row, text, field);
    case TL_PATH:
        break;
    }
    return read_path(row, text, base_file, field);
}

char *tl_option_remark(const struct tl_option *row, const char *text)
{
    const double seen = 1; /* CIEDE2000: the smallest difference that is seen side by side */
    double of[3];
    float rgb[3];
    if (row->type != TL_COLOUR || !is_lab(text) || !parse_lab(text, of))
        return NULL;
    const struct tl_lab requested = {of[0], of[1], of[2]};
    tl_lab_to_rgb(requested, rgb);
    const struct tl_lab shown = tl_lab_of(rgb);
    const double difference = tl_lab_difference(requested, shown);
    if (difference < seen)
        return NULL;
    return tl_format("%s is more saturated than a screen shows (Rec. 709): it is drawn as lab(%.1f, %.1f, "
                     "%.1f), %s, a difference of %.1f (CIEDE2000)",
                     tl_excerpt_of(text).text, shown.l, shown.a, shown.b, tl_hex_of(rgb).text, difference);
}
