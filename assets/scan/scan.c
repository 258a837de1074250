/* Converts polygons as read to a model. */
#include "assets/scan/scan.h"

#include "assets/base/model_build.h"
#include "assets/obj/polygon.h"
#include "assets/scan/scan_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool scan_is_file(const char *path)
{
    return tl_path_has_extension(path, "ply") || tl_path_has_extension(path, "stl") ||
           tl_path_has_extension(path, "off");
}

/* ---- Places ---- */

static uint32_t hash_of(vec3s position)
{
    uint32_t bits[3], hash = 0x9e3779b1u;
    memcpy(bits, position.raw, sizeof bits);
    for (int c = 0; c < 3; c++)
        hash = (hash ^ hash >> 15 ^ bits[c]) * 0x85ebca77u;
    return hash ^ hash >> 13;
}

/* Numbers the places of vertices in the order of the first vertex there: bitwise equal, -0 as 0. Returns how
 * many there are. */
static size_t weld(struct scan_vertex *vertices, size_t count, uint32_t *places)
{
    size_t slots = 16, found = 0;
    while (slots < 2 * count)
        slots *= 2;
    uint32_t *table = TL_NEW_ARRAY(uint32_t, slots); /* vertex + 1; 0: empty */
    for (size_t i = 0; i < count; i++) {
        vec3s *position = &vertices[i].position;
        *position = glms_vec3_adds(*position, 0);
        size_t slot = hash_of(*position) & (slots - 1);
        while (table[slot] && memcmp(&vertices[table[slot] - 1].position, position, sizeof *position) != 0)
            slot = (slot + 1) & (slots - 1);
        places[i] = table[slot] ? places[table[slot] - 1] : (uint32_t)found++;
        if (!table[slot])
            table[slot] = (uint32_t)i + 1;
    }
    free(table);
    return found;
}

/* STL repeats a vertex in each of its triangles: one of each place stays. */
static void share_vertices(struct scan_soup *soup)
{
    uint32_t *places = tl_alloc(soup->vertex_count, sizeof *places);
    size_t count = weld(soup->vertices, soup->vertex_count, places);
    for (size_t i = 0; i < soup->corner_count; i++)
        soup->corners[i] = places[soup->corners[i]];
    for (size_t i = 0; i < soup->vertex_count; i++)
        soup->vertices[places[i]] = soup->vertices[i]; /* places[i] <= i, and equal */
    soup->vertex_count = count;
    free(places);
}

/* ---- The mesh ---- */

static bool check_corners(const char *path, const struct scan_soup *soup, tl_error *error)
{
    for (size_t i = 0; i < soup->corner_count; i++)
        if (soup->corners[i] >= soup->vertex_count)
            return tl_fail(
                error, TL_INPUT,
                "%s: a face names a vertex that does not exist: there are %zu: export the file again", path,
                soup->vertex_count);
    return soup->face_count > 0 ||
           tl_fail(error, TL_INPUT, "%s: holds no triangles: a cloud of points has to be meshed first", path);
}

/* Cuts the faces into triangles of three different vertices; returns how many were left out. */
static size_t cut_faces(const struct scan_soup *soup, tl_mesh *mesh)
{
    mesh->indices = tl_alloc(3 * soup->corner_count, sizeof *mesh->indices);
    uint32_t triangles[3 * SCAN_FACE_CORNERS], scratch[SCAN_FACE_CORNERS];
    vec3s outline[SCAN_FACE_CORNERS];
    size_t left_out = 0;
    for (size_t f = 0, first = 0; f < soup->face_count; first = soup->face_ends[f++]) {
        const uint32_t *corners = &soup->corners[first];
        size_t count = soup->face_ends[f] - first;
        for (size_t i = 0; i < count; i++)
            outline[i] = soup->vertices[corners[i]].position;
        tl_polygon_cut(outline, count, triangles, scratch);
        for (size_t t = 0; t < count - 2; t++) {
            uint32_t *out = &mesh->indices[mesh->index_count];
            for (size_t c = 0; c < 3; c++)
                out[c] = corners[triangles[3 * t + c]];
            bool is_triangle = out[0] != out[1] && out[1] != out[2] && out[2] != out[0];
            mesh->index_count += is_triangle ? 3 : 0;
            left_out += !is_triangle;
        }
    }
    return left_out;
}

/* Takes the vertices that triangles use, in their order. */
static void take_vertices(const struct scan_soup *soup, tl_model *model)
{
    tl_mesh *mesh = &model->mesh;
    uint32_t *numbers = tl_alloc(soup->vertex_count, sizeof *numbers);
    for (size_t i = 0; i < mesh->index_count; i++)
        numbers[mesh->indices[i]] = 1;
    for (size_t i = 0; i < soup->vertex_count; i++)
        numbers[i] = numbers[i] ? (uint32_t)mesh->vertex_count++ : UINT32_MAX;
    for (size_t i = 0; i < mesh->index_count; i++)
        mesh->indices[i] = numbers[mesh->indices[i]];
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    model->points = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    model->point_count = soup->vertex_count;
    if (soup->has_colours)
        model->colours = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    for (size_t i = 0; i < soup->vertex_count; i++) {
        const struct scan_vertex *from = &soup->vertices[i];
        uint32_t to = numbers[i];
        if (to == UINT32_MAX)
            continue;
        float length = glms_vec3_norm(from->normal);
        mesh->positions[to] = from->position;
        model->points[to] = (uint32_t)i;
        if (soup->has_normals && isfinite(length) && length > 0)
            mesh->normals[to] = glms_vec3_divs(from->normal, length);
        if (soup->has_uvs && isfinite(from->uv.x + from->uv.y))
            mesh->uvs[to] = (vec2s){{from->uv.x, 1 - from->uv.y}};
        if (soup->has_colours)
            model->colours[to] = from->colour;
    }
    free(numbers);
}

static void note(const struct scan_soup *soup, size_t left_out, tl_model *model)
{
    if (soup->has_colours)
        model_ignore(model, "vertex colours");
    if (soup->has_face_colours)
        model_ignore(model, "colours of faces");
    if (soup->has_face_uvs)
        model_ignore(model, "texture coordinates of faces");
    if (left_out > 0)
        model_defect(model, "%zu triangles with two equal corners, left out", left_out);
    if (soup->vertex_count > model->mesh.vertex_count)
        model_defect(model, "%zu vertices without triangles, left out",
                     soup->vertex_count - model->mesh.vertex_count);
}

static bool make_model(const char *path, enum tl_units wanted, const struct scan_soup *soup, tl_model *out,
                       tl_error *error)
{
    tl_mesh *mesh = &out->mesh;
    if (!check_corners(path, soup, error))
        return false;
    size_t left_out = cut_faces(soup, mesh);
    if (mesh->index_count == 0)
        return tl_fail(error, TL_INPUT, "%s: all its triangles are points or lines: export it again", path);
    take_vertices(soup, out);
    note(soup, left_out, out);
    mesh->parts = TL_NEW(struct tl_mesh_part);
    mesh->parts[0].index_count = (uint32_t)mesh->index_count;
    mesh->part_count = 1;
    out->materials = TL_NEW(tl_material);
    out->materials[0] = tl_material_default("default");
    out->material_count = 1;
    if (!model_take_units(path, wanted, false, out, error))
        return false;
    model_smooth_normals(mesh);
    tl_mesh_measure_uvs(mesh);
    struct scan_vertex *places = tl_alloc(mesh->vertex_count, sizeof *places);
    uint32_t *welded = tl_alloc(mesh->vertex_count, sizeof *welded);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        places[i].position = mesh->positions[i];
    weld(places, mesh->vertex_count, welded);
    scan_inspect(out, welded);
    free(places);
    free(welded);
    return true;
}

bool scan_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error)
{
    struct tl_text text;
    struct scan_soup soup = {0};
    if (!tl_text_open(path, &text, error))
        return false;
    bool is_stl = tl_path_has_extension(path, "stl");
    bool good = is_stl                               ? scan_read_stl(&text, &soup, error)
                : tl_path_has_extension(path, "ply") ? scan_read_ply(&text, &soup, error)
                                                     : scan_read_off(&text, &soup, error);
    tl_text_close(&text);
    if (good && is_stl)
        share_vertices(&soup);
    good = good && make_model(path, wanted, &soup, out, error);
    scan_soup_release(&soup);
    return good;
}
