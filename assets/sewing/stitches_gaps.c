/* Points that are left over between two stitches, and the edges that are divided for them. */
#include "assets/sewing/stitches_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* Cosine of the angle by which a border turns at a corner: what lies around one is no part of a seam. */
#define CORNER 0.7f

/* An edge that is divided at `count` places, for the points of a row. */
struct divided_edge {
    uint32_t corner; /* where in the indices it begins */
    uint32_t count;
    uint32_t points[STITCHES_MAX_LEFT_OVER]; /* in the edge's direction */
    float at[STITCHES_MAX_LEFT_OVER];        /* shares of the edge, from its corner */
};

struct gaps {
    const struct stitches *stitches;
    const tl_model *model;
    uint32_t *division; /* [triangle] one past its index in `items`; 0: none */
    size_t count, added;
    struct divided_edge *items;
};

/* Points left over between two that are sewn, in the border's direction. */
struct left_over {
    uint32_t from, to, count, points[STITCHES_MAX_LEFT_OVER];
    float lengths[STITCHES_MAX_LEFT_OVER + 1]; /* from `from` to each, and to `to` */
};

static vec3s place_of(const struct gaps *gaps, uint32_t point)
{
    return gaps->model->mesh.positions[gaps->stitches->first[point]];
}

static bool is_corner(const struct gaps *gaps, uint32_t point)
{
    const struct stitches_border *border = &gaps->stitches->borders[point];
    if (border->next == STITCHES_NONE || border->previous == STITCHES_NONE)
        return true;
    vec3s at = place_of(gaps, point);
    vec3s to = glms_vec3_normalize(glms_vec3_sub(place_of(gaps, border->next), at));
    vec3s from = glms_vec3_normalize(glms_vec3_sub(at, place_of(gaps, border->previous)));
    return glms_vec3_dot(to, from) < CORNER;
}

/* The row that begins after a sewn point; false when nothing is left over there. */
static bool find_row(const struct gaps *gaps, uint32_t from, struct left_over *row)
{
    const struct stitches *stitches = gaps->stitches;
    float length = 0;
    uint32_t last = from, point = stitches->borders[from].next;
    *row = (struct left_over){.from = from};
    for (; point != STITCHES_NONE && point != from; last = point, point = stitches->borders[point].next) {
        length += glms_vec3_distance(place_of(gaps, last), place_of(gaps, point));
        row->lengths[row->count] = length;
        row->to = point;
        if (stitches->lists[point] != STITCHES_NONE)
            return row->count > 0;
        if (row->count == STITCHES_MAX_LEFT_OVER || is_corner(gaps, point))
            return false;
        row->points[row->count++] = point;
    }
    return false;
}

/* Divides the border's side that begins at point `a`, of which the row is the other side. */
static bool divide(struct gaps *gaps, uint32_t a, uint32_t b, const struct left_over *row, bool reversed)
{
    const struct stitches_border *border = &gaps->stitches->borders[a];
    const float length = row->lengths[row->count];
    if (border->next != b || gaps->division[border->corner / 3])
        return false;
    struct divided_edge edge = {.corner = border->corner, .count = row->count};
    for (uint32_t i = 0; i < row->count; i++) {
        uint32_t from = reversed ? row->count - 1 - i : i;
        float share = length > 0 ? row->lengths[from] / length : 0.5f;
        edge.points[i] = row->points[from];
        edge.at[i] = reversed ? 1 - share : share;
    }
    gaps->items = tl_resize(gaps->items, gaps->count + 1, sizeof *gaps->items);
    gaps->items[gaps->count++] = edge;
    gaps->division[border->corner / 3] = (uint32_t)gaps->count;
    gaps->added += row->count;
    return true;
}

/* Panels that are seen from the same side run against each other along a seam; those that are turned over run
 * alike. */
static void close_row(struct gaps *gaps, const struct left_over *row)
{
    const struct stitches *stitches = gaps->stitches;
    for (uint32_t i = stitches->lists[row->from]; i != STITCHES_NONE; i = stitches->partners[i].next)
        for (uint32_t j = stitches->lists[row->to]; j != STITCHES_NONE; j = stitches->partners[j].next) {
            uint32_t from = stitches->partners[i].point, to = stitches->partners[j].point;
            if (divide(gaps, to, from, row, true) || divide(gaps, from, to, row, false))
                return;
        }
}

/* ---- The mesh ---- */

static void add_vertex(tl_model *model, uint32_t a, uint32_t b, float at)
{
    tl_mesh *mesh = &model->mesh;
    size_t v = mesh->vertex_count++;
    mesh->positions[v] = glms_vec3_lerp(mesh->positions[a], mesh->positions[b], at);
    mesh->normals[v] = glms_vec3_normalize(glms_vec3_lerp(mesh->normals[a], mesh->normals[b], at));
    mesh->uvs[v] = glms_vec2_lerp(mesh->uvs[a], mesh->uvs[b], at);
    if (model->points)
        model->points[v] = (uint32_t)model->point_count++;
}

/* A fan of count + 1 triangles about the corner opposite to the divided edge. Adds the vertices and their
 * seams. */
static uint32_t *split(const struct stitches *stitches, const struct divided_edge *edge,
                       const uint32_t *triangle, tl_garment *garment, uint32_t *out)
{
    uint32_t side = edge->corner % 3, a = triangle[side], b = triangle[(side + 1) % 3];
    uint32_t apex = triangle[(side + 2) % 3], last = a;
    for (uint32_t i = 0; i <= edge->count; i++) {
        uint32_t next = b;
        if (i < edge->count) {
            next = (uint32_t)garment->model.mesh.vertex_count;
            add_vertex(&garment->model, a, b, edge->at[i]);
            garment->seams[garment->seam_count++] =
                (struct tl_seam_pair){next, stitches->first[edge->points[i]]};
        }
        *out++ = last;
        *out++ = next;
        *out++ = apex;
        last = next;
    }
    return out;
}

static void reserve(tl_model *model, size_t added)
{
    tl_mesh *mesh = &model->mesh;
    size_t count = mesh->vertex_count + added;
    mesh->positions = tl_resize(mesh->positions, count, sizeof *mesh->positions);
    mesh->normals = tl_resize(mesh->normals, count, sizeof *mesh->normals);
    mesh->uvs = tl_resize(mesh->uvs, count, sizeof *mesh->uvs);
    if (model->points)
        model->points = tl_resize(model->points, count, sizeof *model->points);
}

static void split_all(const struct gaps *gaps, tl_garment *garment)
{
    tl_mesh *mesh = &garment->model.mesh;
    reserve(&garment->model, gaps->added);
    uint32_t *indices = TL_NEW_ARRAY(uint32_t, mesh->index_count + 3 * gaps->added), *out = indices;
    for (size_t p = 0; p < mesh->part_count; p++) {
        struct tl_mesh_part *part = &mesh->parts[p];
        size_t first = part->first_index / 3, end = first + part->index_count / 3;
        part->first_index = (uint32_t)(out - indices);
        for (size_t t = first; t < end; t++) {
            const uint32_t *triangle = &mesh->indices[3 * t];
            if (gaps->division[t])
                out = split(gaps->stitches, &gaps->items[gaps->division[t] - 1], triangle, garment, out);
            else
                for (int k = 0; k < 3; k++)
                    *out++ = triangle[k];
        }
        part->index_count = (uint32_t)(out - indices) - part->first_index;
    }
    free(mesh->indices);
    mesh->indices = indices;
    mesh->index_count = (size_t)(out - indices);
}

size_t stitches_fill_gaps(const struct stitches *stitches, tl_garment *garment)
{
    struct gaps gaps = {.stitches = stitches, .model = &garment->model};
    gaps.division = TL_NEW_ARRAY(uint32_t, garment->model.mesh.index_count / 3);
    struct left_over row;
    for (uint32_t point = 0; point < stitches->point_count; point++)
        if (stitches->lists[point] != STITCHES_NONE && find_row(&gaps, point, &row))
            close_row(&gaps, &row);
    if (gaps.added > 0)
        split_all(&gaps, garment);
    free(gaps.division);
    free(gaps.items);
    return gaps.added;
}
