#include "assets/obj/wavefront_internal.h"
#include "config/base/text.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LIMIT_FACE_CORNERS 1024 /* ear clipping takes their square */
#define LIMIT_MATERIALS    1024
#define LIMIT_LIBRARIES    16
#define LIMIT_STITCHES     ((size_t)1 << 20)
#define LIMIT_IGNORED      16 /* keywords listed; a file that is no OBJ has thousands */

/* The state of reading. */
struct obj_reader {
    struct tl_text text;
    struct wave_object *object;
    size_t position_capacity, uv_capacity, normal_capacity, corner_capacity, face_capacity, stitch_capacity;
    uint32_t group, material; /* of the next face */
    tl_error *error;
};

static bool fail_limit(const struct obj_reader *reader, const char *what, size_t limit)
{
    return tl_fail(reader->error, TL_INPUT, "%s: line %zu: more than %zu %s: simplify it", reader->text.path,
                   reader->text.line, limit, what);
}

/* Makes room for one more element. The file's length bounds the total. */
static void *grow(void *array, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    *capacity = 2 * *capacity + 256;
    return tl_resize(array, *capacity, size);
}

static bool read_uv(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    if (object->uv_count == TL_LIMIT_MESH_VERTICES)
        return fail_limit(reader, "texture coordinates", TL_LIMIT_MESH_VERTICES);
    object->uvs = grow(object->uvs, object->uv_count, &reader->uv_capacity, sizeof(vec2s));
    return tl_text_numbers(&reader->text, "texture coordinate", 2, object->uvs[object->uv_count++].raw,
                           reader->error);
}

/* Exporters write nan for the normal of a triangle without area; such a normal is computed instead. */
static bool read_normal(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    if (object->normal_count == TL_LIMIT_MESH_VERTICES)
        return fail_limit(reader, "normals", TL_LIMIT_MESH_VERTICES);
    object->normals = grow(object->normals, object->normal_count, &reader->normal_capacity, sizeof(vec3s));
    vec3s *normal = &object->normals[object->normal_count++];
    if (strstr(reader->text.word, "nan")) {
        *normal = (vec3s){{0, 0, 0}};
        return true;
    }
    return tl_text_numbers(&reader->text, "normal", 3, normal->raw, reader->error);
}

/* Reads one index of v/vt/vn at *at: from 1, or backwards from -1. A positive index may refer to a later
 * line, so indices are checked at the end of the file. */
static bool read_index(char **at, size_t count, uint32_t *out)
{
    char *end;
    errno = 0;
    long value = strtol(*at, &end, 10);
    if (end == *at || errno || value == 0 || value > (long)TL_LIMIT_MESH_VERTICES || value < -(long)count)
        return false;
    *out = value > 0 ? (uint32_t)value - 1 : (uint32_t)((long)count + value);
    *at = end;
    return true;
}

/* v, v/vt, v//vn or v/vt/vn, the whole word. */
static bool read_corner(const struct wave_object *object, char *word, struct wave_corner *out)
{
    *out = (struct wave_corner){WAVE_NONE, WAVE_NONE, WAVE_NONE};
    if (!read_index(&word, object->position_count, &out->position))
        return false;
    if (*word == '\0')
        return true;
    if (*word++ != '/')
        return false;
    if (*word != '/' && !read_index(&word, object->uv_count, &out->uv))
        return false;
    if (*word == '\0')
        return true;
    return *word++ == '/' && read_index(&word, object->normal_count, &out->normal) && *word == '\0';
}

static bool read_face(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    size_t first = object->corner_count;
    for (char *word; (word = tl_text_word(&reader->text)) && word[0] != '#';) {
        if (object->corner_count == TL_LIMIT_MESH_INDICES)
            return fail_limit(reader, "corners of faces", TL_LIMIT_MESH_INDICES);
        if (object->corner_count - first == LIMIT_FACE_CORNERS)
            return fail_limit(reader, "corners in one face", LIMIT_FACE_CORNERS);
        object->corners =
            grow(object->corners, object->corner_count, &reader->corner_capacity, sizeof *object->corners);
        if (!read_corner(object, word, &object->corners[object->corner_count++]))
            return tl_fail(reader->error, TL_INPUT,
                           "%s: line %zu: face: \"%.40s\" is no index that exists: export the file again",
                           reader->text.path, reader->text.line, word);
    }
    if (object->corner_count - first < 3)
        return tl_fail(reader->error, TL_INPUT,
                       "%s: line %zu: face of %zu corners: it takes 3: export the file again",
                       reader->text.path, reader->text.line, object->corner_count - first);
    object->triangle_count += object->corner_count - first - 2;
    if (object->triangle_count > TL_LIMIT_MESH_INDICES / 3)
        return fail_limit(reader, "triangles", TL_LIMIT_MESH_INDICES / 3);
    object->faces = grow(object->faces, object->face_count, &reader->face_capacity, sizeof *object->faces);
    object->faces[object->face_count++] =
        (struct wave_face){(uint32_t)object->corner_count, reader->group, reader->material};
    return true;
}

/* The index of a name in a list of strings; a new name is added. `limit` when the list is full. */
static size_t find_or_add(char ***strings, size_t *count, size_t limit, const char *name)
{
    for (size_t i = 0; i < *count; i++)
        if (strcmp((*strings)[i], name) == 0)
            return i;
    if (*count == limit)
        return limit;
    *strings = tl_resize(*strings, *count + 1, sizeof **strings);
    (*strings)[*count] = tl_copy_string(name);
    return (*count)++;
}

/* Codim-IPC's lines: a vertex, the two ends of an edge, all from 0, and where on that edge. */
static bool read_stitch(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    uint32_t points[3];
    if (object->stitch_count == LIMIT_STITCHES)
        return fail_limit(reader, "stitches", LIMIT_STITCHES);
    for (int i = 0; i < 3; i++) {
        const char *word = tl_text_word(&reader->text);
        char *end = NULL;
        errno = 0;
        unsigned long value = word && word[0] >= '0' && word[0] <= '9' ? strtoul(word, &end, 10) : 0;
        if (!end || *end || errno || value >= TL_LIMIT_MESH_VERTICES)
            return tl_fail(reader->error, TL_INPUT,
                           "%s: line %zu: stitch: \"%.40s\" is no vertex: expected a vertex and the two ends "
                           "of an edge, counted from 0, and where on the edge, 0 to 1",
                           reader->text.path, reader->text.line, word ? word : "");
        points[i] = (uint32_t)value;
    }
    float at;
    if (!tl_text_numbers(&reader->text, "place on a stitch's edge", 1, &at, reader->error))
        return false;
    object->stitches =
        grow(object->stitches, object->stitch_count, &reader->stitch_capacity, sizeof *object->stitches);
    object->stitches[object->stitch_count++] = (struct tl_stitch){points[0], {points[1], points[2]}, at};
    return true;
}

static bool use_material(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    size_t index = find_or_add(&object->materials, &object->material_count, LIMIT_MATERIALS,
                               tl_text_rest(&reader->text));
    reader->material = (uint32_t)index;
    return index < LIMIT_MATERIALS || fail_limit(reader, "materials", LIMIT_MATERIALS);
}

static void begin_group(struct obj_reader *reader)
{
    const struct wave_object *object = reader->object;
    if (object->face_count > 0 && object->faces[object->face_count - 1].group == reader->group)
        reader->group++;
}

static void add_library(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    const char *name = tl_text_rest(&reader->text);
    if (name[0])
        find_or_add(&object->libraries, &object->library_count, LIMIT_LIBRARIES, name);
}

static void ignore(struct obj_reader *reader, const char *what)
{
    struct wave_object *object = reader->object;
    find_or_add(&object->ignored, &object->ignored_count, LIMIT_IGNORED, what);
}

static void ignore_keyword(struct obj_reader *reader, const char *keyword)
{
    char note[64];
    snprintf(note, sizeof note, "\"%.24s\" lines", keyword);
    ignore(reader, note);
}

static bool read_position(struct obj_reader *reader)
{
    struct wave_object *object = reader->object;
    if (object->position_count == TL_LIMIT_MESH_VERTICES)
        return fail_limit(reader, "vertices", TL_LIMIT_MESH_VERTICES);
    object->positions =
        grow(object->positions, object->position_count, &reader->position_capacity, sizeof(vec3s));
    if (!tl_text_numbers(&reader->text, "vertex", 3, object->positions[object->position_count++].raw,
                         reader->error))
        return false;
    const char *more = tl_text_word(&reader->text);
    if (more && more[0] != '#')
        ignore(reader, "vertex colours or weights");
    return true;
}

static bool read_line(struct obj_reader *reader, const char *keyword)
{
    if (strcmp(keyword, "v") == 0)
        return read_position(reader);
    if (strcmp(keyword, "vt") == 0)
        return read_uv(reader);
    if (strcmp(keyword, "vn") == 0)
        return read_normal(reader);
    if (strcmp(keyword, "f") == 0)
        return read_face(reader);
    if (strcmp(keyword, "stitch") == 0)
        return read_stitch(reader);
    if (strcmp(keyword, "usemtl") == 0)
        return use_material(reader);
    if (strcmp(keyword, "g") == 0 || strcmp(keyword, "o") == 0)
        begin_group(reader);
    else if (strcmp(keyword, "mtllib") == 0)
        add_library(reader);
    else if (strcmp(keyword, "s") != 0) /* smoothing groups: cloth is smooth everywhere */
        ignore_keyword(reader, keyword);
    return true;
}

static bool check_corners(const struct obj_reader *reader)
{
    const struct wave_object *object = reader->object;
    for (size_t face = 0, i = 0; face < object->face_count; face++)
        for (; i < object->faces[face].corner_end; i++) {
            const struct wave_corner *corner = &object->corners[i];
            if (corner->position >= object->position_count ||
                (corner->uv != WAVE_NONE && corner->uv >= object->uv_count) ||
                (corner->normal != WAVE_NONE && corner->normal >= object->normal_count))
                return tl_fail(reader->error, TL_INPUT,
                               "%s: face %zu has an index out of range: there are %zu vertices, %zu texture "
                               "coordinates, %zu normals: export the file again",
                               reader->text.path, face + 1, object->position_count, object->uv_count,
                               object->normal_count);
        }
    return true;
}

static bool check_stitches(const struct obj_reader *reader)
{
    const struct wave_object *object = reader->object;
    for (size_t i = 0; i < object->stitch_count; i++) {
        const struct tl_stitch *stitch = &object->stitches[i];
        if (stitch->point >= object->position_count || stitch->edge[0] >= object->position_count ||
            stitch->edge[1] >= object->position_count)
            return tl_fail(reader->error, TL_INPUT,
                           "%s: stitch %zu has a vertex out of range: there are %zu, counted from 0: export "
                           "the file again",
                           reader->text.path, i + 1, object->position_count);
    }
    return true;
}

bool wave_read(const char *path, struct wave_object *out, tl_error *error)
{
    *out = (struct wave_object){0};
    struct obj_reader reader = {.object = out, .error = error};
    if (!tl_text_open(path, &reader.text, error))
        return false;
    find_or_add(&out->materials, &out->material_count, LIMIT_MATERIALS, "");
    bool good = true;
    for (const char *keyword; good && (keyword = tl_text_line(&reader.text));)
        good = read_line(&reader, keyword);
    good = good && check_corners(&reader) && check_stitches(&reader);
    tl_text_close(&reader.text);
    if (!good)
        wave_release(out);
    return good;
}

static void release_strings(char **strings, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free(strings[i]);
    free(strings);
}

void wave_release(struct wave_object *object)
{
    release_strings(object->materials, object->material_count);
    release_strings(object->libraries, object->library_count);
    release_strings(object->ignored, object->ignored_count);
    free(object->positions);
    free(object->uvs);
    free(object->normals);
    free(object->corners);
    free(object->faces);
    free(object->stitches);
    *object = (struct wave_object){0};
}
