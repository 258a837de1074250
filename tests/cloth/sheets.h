/* Sheets of cloth for tests: a grid of columns x rows quads in a pattern of width x height metres, placed by
 * a function, cut along one diagonal. */
#ifndef TOILE_TESTS_CLOTH_SHEETS_H
#define TOILE_TESTS_CLOTH_SHEETS_H

#include "assets/sewing/panel.h"
#include "cloth/cloth.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct sheet_shape {
    int columns, rows;    /* quads */
    double width, height; /* m, along weft (x of the pattern) and warp (y) */
};

static inline uint32_t sheet_vertex(const struct sheet_shape *shape, int column, int row)
{
    return (uint32_t)(row * (shape->columns + 1) + column);
}

/* Lies in the plane z = 0 as in its pattern; `place` moves it. Free with tl_garment_free_sheet. */
static inline tl_garment sheet_make(const struct sheet_shape *shape, vec3s (*place)(double u, double v))
{
    tl_garment garment = {0};
    tl_mesh *mesh = &garment.model.mesh;
    mesh->vertex_count = (size_t)(shape->columns + 1) * (size_t)(shape->rows + 1);
    mesh->index_count = 6 * (size_t)shape->columns * (size_t)shape->rows;
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    garment.pattern = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    for (int row = 0; row <= shape->rows; row++)
        for (int column = 0; column <= shape->columns; column++) {
            double u = shape->width * column / shape->columns, v = shape->height * row / shape->rows;
            uint32_t i = sheet_vertex(shape, column, row);
            garment.pattern[i] = (vec2s){{(float)u, (float)v}};
            mesh->uvs[i] = (vec2s){{(float)u, (float)-v}};
            mesh->positions[i] = place ? place(u, v) : (vec3s){{(float)u, (float)v, 0}};
        }
    uint32_t *index = mesh->indices;
    for (int row = 0; row < shape->rows; row++)
        for (int column = 0; column < shape->columns; column++) {
            uint32_t a = sheet_vertex(shape, column, row), b = a + 1;
            uint32_t d = sheet_vertex(shape, column, row + 1), c = d + 1;
            const uint32_t corners[6] = {a, b, c, a, c, d};
            memcpy(index, corners, sizeof corners);
            index += 6;
        }
    return garment;
}

/* Adds a panel's points and triangles, flat in the plane z = 0; points at one place weld. */
static inline void sheet_add(tl_garment *garment, const tl_panel_mesh *panel)
{
    tl_mesh *mesh = &garment->model.mesh;
    size_t first = mesh->vertex_count, count = first + panel->point_count;
    mesh->positions = tl_resize(mesh->positions, count, sizeof *mesh->positions);
    mesh->normals = tl_resize(mesh->normals, count, sizeof *mesh->normals);
    mesh->uvs = tl_resize(mesh->uvs, count, sizeof *mesh->uvs);
    mesh->indices =
        tl_resize(mesh->indices, mesh->index_count + 3 * panel->triangle_count, sizeof *mesh->indices);
    garment->pattern = tl_resize(garment->pattern, count, sizeof *garment->pattern);
    for (size_t i = 0; i < panel->point_count; i++) {
        float u = (float)panel->points[i].x, v = (float)panel->points[i].y;
        garment->pattern[first + i] = (vec2s){{u, v}};
        mesh->uvs[first + i] = (vec2s){{u, -v}};
        mesh->positions[first + i] = (vec3s){{u, v, 0}};
        mesh->normals[first + i] = (vec3s){{0, 0, 1}};
    }
    for (size_t i = 0; i < 3 * panel->triangle_count; i++)
        mesh->indices[mesh->index_count++] = (uint32_t)first + panel->triangles[i / 3][i % 3];
    mesh->vertex_count = count;
}

static inline void sheet_free(tl_garment *garment)
{
    tl_mesh_release(&garment->model.mesh);
    free(garment->pattern);
    free(garment->seams);
    free(garment->pins);
    *garment = (tl_garment){0};
}

static inline void sheet_pin(tl_garment *garment, uint32_t vertex)
{
    garment->pins = tl_resize(garment->pins, garment->pin_count + 1, sizeof *garment->pins);
    garment->pins[garment->pin_count++] = vertex;
}

static inline void sheet_seam(tl_garment *garment, uint32_t a, uint32_t b)
{
    garment->seams = tl_resize(garment->seams, garment->seam_count + 1, sizeof *garment->seams);
    garment->seams[garment->seam_count++] = (struct tl_seam_pair){a, b};
}

static inline struct tl_cloth_fabric fabric_defaults(void)
{
    return *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults;
}

static inline struct tl_cloth_params params_defaults(void)
{
    return *(const struct tl_cloth_params *)tl_cloth_options.defaults;
}

#endif
