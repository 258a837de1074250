/* OFF, Geomview's object file format: [ST][C][N]OFF in text. */
#include "assets/scan/scan_internal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct off_reader {
    struct tl_text *text;
    struct scan_soup *soup;
    tl_error *error;
};

static bool fail_here(const struct off_reader *reader, const char *what)
{
    return tl_fail(reader->error, TL_INPUT, "%s: line %zu: %s: export the file again", reader->text->path,
                   reader->text->line, what);
}

/* The line's next word; NULL at its end and before a comment. */
static char *next_word(const struct off_reader *reader)
{
    char *word = tl_text_word(reader->text);
    return word && word[0] != '#' ? word : NULL;
}

/* Reads a whole number from a word, which may be NULL. */
static bool read_count(const char *word, size_t *out)
{
    char *end;
    *out = 0;
    if (!word || word[0] < '0' || word[0] > '9')
        return false;
    errno = 0;
    *out = strtoull(word, &end, 10);
    return errno == 0 && *end == '\0';
}

/* Reads the first word; counts may follow it on its line. */
static bool read_header(struct off_reader *reader, size_t *vertices, size_t *faces)
{
    const char *word = tl_text_line(reader->text);
    if (word && strncmp(word, "ST", 2) == 0)
        reader->soup->has_uvs = true, word += 2;
    if (word && *word == 'C')
        reader->soup->has_colours = true, word++;
    if (word && *word == 'N')
        reader->soup->has_normals = true, word++;
    if (!word || strcmp(word, "OFF") != 0)
        return tl_fail(reader->error, TL_INPUT, "%s: is no OFF file of three dimensions: export it again",
                       reader->text->path);
    word = next_word(reader);
    if (word && strcmp(word, "BINARY") == 0)
        return tl_fail(reader->error, TL_INPUT, "%s: is binary OFF: export it as text", reader->text->path);
    if (!word)
        word = tl_text_line(reader->text);
    return (read_count(word, vertices) && read_count(tl_text_word(reader->text), faces)) ||
           fail_here(reader, "counts of vertices and faces are expected");
}

/* Colours are whole numbers up to 255, or numbers with a point up to 1; a fourth is transparency, which not
 * every writer has at a line's end. */
static bool read_colour(struct off_reader *reader, vec3s *out)
{
    float scale = 1;
    for (int c = 0; c < (reader->soup->has_uvs ? 4 : 3); c++) {
        char *word = tl_text_word(reader->text), *end = word;
        float value = word ? strtof_l(word, &end, reader->text->plain) : 0;
        if (!word || end == word || *end || !(value >= 0 && value <= 255))
            return fail_here(reader, "a vertex lacks its colour");
        if (!strchr(word, '.'))
            scale = 1.0f / 255;
        if (c < 3)
            out->raw[c] = value;
    }
    *out = glms_vec3_scale(*out, scale);
    return true;
}

/* x y z, then what the header states: a normal, a colour, a texture coordinate. */
static bool read_vertex(struct off_reader *reader)
{
    struct tl_text *text = reader->text;
    struct scan_soup *soup = reader->soup;
    struct scan_vertex vertex = {0};
    return tl_text_numbers(text, "vertex", 3, vertex.position.raw, reader->error) &&
           (!soup->has_normals || tl_text_numbers(text, "normal", 3, vertex.normal.raw, reader->error)) &&
           (!soup->has_colours || read_colour(reader, &vertex.colour)) &&
           (!soup->has_uvs || tl_text_numbers(text, "texture coordinate", 2, vertex.uv.raw, reader->error)) &&
           scan_add_vertex(text->path, soup, &vertex, reader->error);
}

static bool read_face(struct off_reader *reader)
{
    size_t corners, vertex;
    if (!read_count(tl_text_word(reader->text), &corners))
        return fail_here(reader, "a face begins with its count of corners");
    for (size_t i = 0; i < corners; i++)
        if (!read_count(tl_text_word(reader->text), &vertex) || vertex > UINT32_MAX)
            return fail_here(reader, "a face lacks a corner, or has one that is no number");
        else if (!scan_add_corner(reader->text->path, reader->soup, (uint32_t)vertex, reader->error))
            return false;
    reader->soup->has_face_colours |= next_word(reader) != NULL;
    return scan_end_face(reader->text->path, reader->soup, reader->error);
}

bool scan_read_off(struct tl_text *text, struct scan_soup *soup, tl_error *error)
{
    struct off_reader reader = {.text = text, .soup = soup, .error = error};
    size_t vertices = 0, faces = 0;
    if (!read_header(&reader, &vertices, &faces))
        return false;
    for (size_t i = 0; i < vertices || i - vertices < faces; i++) {
        if (!tl_text_next(text))
            return tl_fail(
                error, TL_INPUT,
                "%s: claims %zu vertices and %zu faces but ends after %zu lines of them: it is cut short, "
                "fetch it again",
                text->path, vertices, faces, i);
        if (!(i < vertices ? read_vertex(&reader) : read_face(&reader)))
            return false;
    }
    return true;
}
