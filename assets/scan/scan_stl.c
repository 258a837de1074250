/* STL, as 3D Systems published it: triangles without shared corners. */
#include "assets/scan/scan_internal.h"

#include <string.h>

#define HEADER_BYTES   84 /* 80 of text, then the count of triangles */
#define TRIANGLE_BYTES 50 /* normal and three corners, 12 floats; 2 bytes for the writer's own use */

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool add_corner(const char *path, struct scan_soup *soup, const struct scan_vertex *vertex,
                       tl_error *error)
{
    return scan_add_corner(path, soup, (uint32_t)soup->vertex_count, error) &&
           scan_add_vertex(path, soup, vertex, error) &&
           (soup->vertex_count % 3 != 0 || scan_end_face(path, soup, error));
}

static bool read_binary(const char *path, const uint8_t *bytes, size_t count, struct scan_soup *soup,
                        tl_error *error)
{
    for (size_t i = 0; i < 3 * count; i++) {
        const uint8_t *at = bytes + HEADER_BYTES + i / 3 * TRIANGLE_BYTES + 12 + i % 3 * 12;
        struct scan_vertex vertex = {0};
        for (size_t c = 0; c < 3; c++) {
            uint32_t bits = word_at(at + 4 * c);
            memcpy(&vertex.position.raw[c], &bits, sizeof bits);
        }
        if (!add_corner(path, soup, &vertex, error))
            return false;
    }
    return true;
}

static bool read_text(struct tl_text *text, struct scan_soup *soup, tl_error *error)
{
    size_t corners = 0;
    for (const char *word; (word = tl_text_line(text));) {
        struct scan_vertex vertex = {0};
        if (strcmp(word, "vertex") == 0) {
            if (!tl_text_numbers(text, "vertex", 3, vertex.position.raw, error) ||
                !add_corner(text->path, soup, &vertex, error))
                return false;
            corners++;
        } else if (strcmp(word, "endloop") == 0) {
            if (corners != 3)
                return tl_fail(error, TL_INPUT,
                               "%s: line %zu: a facet of %zu vertices: it has 3: export the file again",
                               text->path, text->line, corners);
            corners = 0;
        } else if (strcmp(word, "facet") != 0 && strcmp(word, "outer") != 0 &&
                   strcmp(word, "endfacet") != 0 && strcmp(word, "solid") != 0 &&
                   strcmp(word, "endsolid") != 0) {
            return tl_fail(error, TL_INPUT,
                           "%s: line %zu: \"%.40s\" is no word of STL: export the file again", text->path,
                           text->line, word);
        }
    }
    return corners == 0 ||
           tl_fail(error, TL_INPUT, "%s: ends within a facet: it is cut short, fetch it again", text->path);
}

/* Binary files, too, may begin with "solid"; their length decides. */
bool scan_read_stl(struct tl_text *text, struct scan_soup *soup, tl_error *error)
{
    const uint8_t *bytes = (const uint8_t *)text->data;
    size_t size = (size_t)(text->end - text->data);
    size_t count = size >= HEADER_BYTES ? word_at(bytes + 80) : 0, room = 0;
    if (size >= HEADER_BYTES)
        room = (size - HEADER_BYTES) / TRIANGLE_BYTES;
    bool fills = size >= HEADER_BYTES && size == HEADER_BYTES + count * TRIANGLE_BYTES;
    if (!fills && size >= 5 && memcmp(bytes, "solid", 5) == 0)
        return read_text(text, soup, error);
    if (size < HEADER_BYTES || count > room)
        return tl_fail(error, TL_INPUT,
                       "%s: claims %zu triangles but has room for %zu: it is cut short, fetch it again",
                       text->path, count, room);
    return read_binary(text->path, bytes, count, soup, error);
}
