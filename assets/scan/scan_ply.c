/* PLY, Greg Turk's polygon file format: text, little-endian and big-endian. */
#include "assets/scan/scan_internal.h"

#include "config/base/memory.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIMIT_ELEMENTS   16
#define LIMIT_PROPERTIES 64

enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT,
    PLY_DOUBLE
};
static const size_t type_sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

/* The destination of a property. */
enum ply_slot {
    SLOT_X,
    SLOT_Y,
    SLOT_Z,
    SLOT_NX,
    SLOT_NY,
    SLOT_NZ,
    SLOT_U,
    SLOT_V,
    SLOT_RED,
    SLOT_GREEN,
    SLOT_BLUE,
    SLOT_COUNT,
    SLOT_CORNERS, /* a list of vertices */
    SLOT_NONE
};

struct ply_property {
    enum ply_type count_type; /* of a list; else PLY_NONE */
    enum ply_type type;
    enum ply_slot slot;
};

struct ply_element {
    bool is_vertex, is_face;
    size_t count, property_count;
    struct ply_property properties[LIMIT_PROPERTIES];
};

enum ply_format { PLY_TEXT, PLY_LITTLE, PLY_BIG };

struct ply_reader {
    struct tl_text *text;
    const uint8_t *at, *end; /* of binary content */
    enum ply_format format;
    size_t element_count;
    struct ply_element elements[LIMIT_ELEMENTS];
    struct scan_soup *soup;
    tl_error *error;
};

/* ---- The header ---- */

static bool fail_header(const struct ply_reader *reader, const char *what)
{
    return tl_fail(reader->error, TL_INPUT, "%s: line %zu: %s: export the file again", reader->text->path,
                   reader->text->line, what);
}

static enum ply_type type_of(const char *word)
{
    static const char *const names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
    for (size_t i = 0; word && i < TL_COUNT(names); i++)
        if (strcmp(word, names[i][0]) == 0 || strcmp(word, names[i][1]) == 0)
            return (enum ply_type)(PLY_INT8 + i);
    return PLY_NONE;
}

static enum ply_slot slot_of(const struct ply_element *element, const char *name, bool is_list)
{
    static const struct {
        const char *name;
        enum ply_slot slot;
    } known[] = {{"x", SLOT_X},
                 {"y", SLOT_Y},
                 {"z", SLOT_Z},
                 {"nx", SLOT_NX},
                 {"ny", SLOT_NY},
                 {"nz", SLOT_NZ},
                 {"u", SLOT_U},
                 {"v", SLOT_V},
                 {"s", SLOT_U},
                 {"t", SLOT_V},
                 {"texture_u", SLOT_U},
                 {"texture_v", SLOT_V},
                 {"red", SLOT_RED},
                 {"green", SLOT_GREEN},
                 {"blue", SLOT_BLUE},
                 {"diffuse_red", SLOT_RED},
                 {"diffuse_green", SLOT_GREEN},
                 {"diffuse_blue", SLOT_BLUE}};
    if (element->is_face && is_list &&
        (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        return SLOT_CORNERS;
    for (size_t i = 0; element->is_vertex && !is_list && i < TL_COUNT(known); i++)
        if (strcmp(name, known[i].name) == 0)
            return known[i].slot;
    return SLOT_NONE;
}

static bool read_property(struct ply_reader *reader)
{
    if (reader->element_count == 0)
        return fail_header(reader, "a property before any element");
    struct ply_element *element = &reader->elements[reader->element_count - 1];
    if (element->property_count == LIMIT_PROPERTIES)
        return fail_header(reader, "more than 64 properties");
    struct ply_property *property = &element->properties[element->property_count++];
    const char *word = tl_text_word(reader->text);
    if (word && strcmp(word, "list") == 0) {
        property->count_type = type_of(tl_text_word(reader->text));
        if (property->count_type == PLY_NONE || property->count_type >= PLY_FLOAT)
            return fail_header(reader, "a list whose count is no whole number");
        word = tl_text_word(reader->text);
    }
    property->type = type_of(word);
    const char *name = tl_text_word(reader->text);
    if (property->type == PLY_NONE || !name)
        return fail_header(reader, "a property of unknown type");
    property->slot = slot_of(element, name, property->count_type != PLY_NONE);
    struct scan_soup *soup = reader->soup;
    soup->has_normals |= property->slot == SLOT_NX;
    soup->has_uvs |= property->slot == SLOT_U;
    soup->has_colours |= property->slot == SLOT_RED;
    soup->has_face_uvs |= element->is_face && strcmp(name, "texcoord") == 0;
    soup->has_face_colours |= element->is_face && strcmp(name, "red") == 0;
    return true;
}

static bool read_element(struct ply_reader *reader)
{
    if (reader->element_count == LIMIT_ELEMENTS)
        return fail_header(reader, "more than 16 elements");
    struct ply_element *element = &reader->elements[reader->element_count++];
    const char *name = tl_text_word(reader->text), *count = tl_text_word(reader->text);
    char *end = NULL;
    errno = 0;
    unsigned long long value = count && count[0] >= '0' && count[0] <= '9' ? strtoull(count, &end, 10) : 0;
    if (!end || *end || errno)
        return fail_header(reader, "an element without its count");
    element->count = (size_t)value;
    element->is_vertex = strcmp(name, "vertex") == 0;
    element->is_face = strcmp(name, "face") == 0;
    return true;
}

static bool read_format(struct ply_reader *reader)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const char *name = tl_text_word(reader->text);
    for (size_t i = 0; name && i < TL_COUNT(names); i++)
        if (strcmp(name, names[i]) == 0) {
            reader->format = (enum ply_format)i;
            return true;
        }
    return fail_header(reader, "a format that is not known");
}

static bool read_header(struct ply_reader *reader)
{
    const char *word = tl_text_line(reader->text);
    if (!word || strcmp(word, "ply") != 0)
        return tl_fail(reader->error, TL_INPUT, "%s: is no PLY file: export it again", reader->text->path);
    bool good = true;
    while (good && (word = tl_text_line(reader->text)) && strcmp(word, "end_header") != 0) {
        if (strcmp(word, "format") == 0)
            good = read_format(reader);
        else if (strcmp(word, "element") == 0)
            good = read_element(reader);
        else if (strcmp(word, "property") == 0)
            good = read_property(reader);
        else if (strcmp(word, "comment") != 0 && strcmp(word, "obj_info") != 0)
            good = fail_header(reader, "a header's line that is not known");
    }
    if (good && !word)
        return tl_fail(reader->error, TL_INPUT, "%s: ends within its header: it is cut short, fetch it again",
                       reader->text->path);
    reader->at = (const uint8_t *)reader->text->next;
    reader->end = (const uint8_t *)reader->text->end;
    return good;
}

/* ---- Values ---- */

/* Decodes a number of `size` bytes at `at`. */
static double decode(const uint8_t *at, enum ply_type type, bool is_big)
{
    size_t size = type_sizes[type];
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits |= (uint64_t)at[is_big ? size - 1 - i : i] << 8 * i;
    uint32_t word = (uint32_t)bits;
    float single;
    double value;
    switch (type) {
    case PLY_INT8:
        return (int8_t)bits;
    case PLY_INT16:
        return (int16_t)bits;
    case PLY_INT32:
        return (int32_t)bits;
    case PLY_FLOAT:
        memcpy(&single, &word, sizeof single);
        return (double)single;
    case PLY_DOUBLE:
        memcpy(&value, &bits, sizeof value);
        return value;
    default:
        return (double)bits;
    }
}

static bool read_value(struct ply_reader *reader, enum ply_type type, double *out)
{
    if (reader->format == PLY_TEXT) {
        char *word = tl_text_word(reader->text), *end = word;
        *out = word ? strtod_l(word, &end, reader->text->plain) : 0;
        return (word && end != word && !*end) || fail_header(reader, "a number is expected");
    }
    size_t size = type_sizes[type];
    if ((size_t)(reader->end - reader->at) < size)
        return tl_fail(reader->error, TL_INPUT,
                       "%s: ends before its last element: it is cut short, fetch it again",
                       reader->text->path);
    *out = decode(reader->at, type, reader->format == PLY_BIG);
    reader->at += size;
    return true;
}

/* Numbers that are not whole or beyond 32 bits become one that no vertex has. */
static uint32_t vertex_of(double value)
{
    return value >= 0 && value < UINT32_MAX && value == floor(value) ? (uint32_t)value : UINT32_MAX;
}

static bool read_list(struct ply_reader *reader, const struct ply_property *property)
{
    double count = 0, value = 0;
    if (!read_value(reader, property->count_type, &count))
        return false;
    for (double i = 0; i < count; i++)
        if (!read_value(reader, property->type, &value) ||
            (property->slot == SLOT_CORNERS &&
             !scan_add_corner(reader->text->path, reader->soup, vertex_of(value), reader->error)))
            return false;
    return property->slot != SLOT_CORNERS || scan_end_face(reader->text->path, reader->soup, reader->error);
}

static float colour_of(double value, enum ply_type type)
{
    double largest = type == PLY_UINT8 ? 255 : type == PLY_UINT16 ? 65535 : 1;
    return (float)fmin(fmax(value / largest, 0), 1);
}

static bool read_one(struct ply_reader *reader, const struct ply_element *element)
{
    double values[SLOT_COUNT] = {0}, value;
    enum ply_type red = PLY_NONE;
    for (size_t p = 0; p < element->property_count; p++) {
        const struct ply_property *property = &element->properties[p];
        if (property->count_type != PLY_NONE) {
            if (!read_list(reader, property))
                return false;
            continue;
        }
        if (!read_value(reader, property->type, &value))
            return false;
        if (property->slot < SLOT_COUNT)
            values[property->slot] = value;
        if (property->slot == SLOT_RED)
            red = property->type;
    }
    if (!element->is_vertex)
        return true;
    struct scan_vertex vertex;
    for (int c = 0; c < 3; c++) {
        vertex.position.raw[c] = (float)values[SLOT_X + c];
        vertex.normal.raw[c] = (float)values[SLOT_NX + c];
        vertex.colour.raw[c] = colour_of(values[SLOT_RED + c], red);
    }
    vertex.uv = (vec2s){{(float)values[SLOT_U], (float)values[SLOT_V]}};
    return scan_add_vertex(reader->text->path, reader->soup, &vertex, reader->error);
}

/* The least that an element takes: a digit and a blank for each number of a text, a list's count of others.
 */
static size_t smallest(const struct ply_reader *reader, const struct ply_element *element)
{
    size_t size = 0;
    for (size_t p = 0; p < element->property_count; p++) {
        const struct ply_property *property = &element->properties[p];
        size += reader->format == PLY_TEXT
                    ? 2
                    : type_sizes[property->count_type ? property->count_type : property->type];
    }
    return size;
}

bool scan_read_ply(struct tl_text *text, struct scan_soup *soup, tl_error *error)
{
    struct ply_reader reader = {.text = text, .soup = soup, .error = error};
    if (!read_header(&reader))
        return false;
    for (size_t e = 0; e < reader.element_count; e++) {
        const struct ply_element *element = &reader.elements[e];
        size_t left = reader.format == PLY_TEXT ? (size_t)(text->end - text->next) + 1
                                                : (size_t)(reader.end - reader.at);
        size_t minimum = smallest(&reader, element);
        if (element->count > 0 && (minimum == 0 || element->count > left / minimum))
            return tl_fail(
                error, TL_INPUT,
                "%s: claims %zu elements but has %zu bytes for them: it is cut short, fetch it again",
                text->path, element->count, left);
        for (size_t i = 0; i < element->count; i++) {
            if (reader.format == PLY_TEXT && !tl_text_next(text))
                return tl_fail(error, TL_INPUT,
                               "%s: ends before its last element: it is cut short, fetch it again",
                               text->path);
            if (!read_one(&reader, element))
                return false;
        }
    }
    return true;
}
