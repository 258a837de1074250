#include "assets/sewing/layout.h"

#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A row ends where it would be wider than a square table by this. */
#define TABLE_ASPECT 1.25f

struct table_piece {
    uint32_t root; /* its set */
    vec2s lower, upper, at;
    double area; /* m^2, negative where it is mirrored */
};

struct cutting_table {
    const tl_garment *garment;
    uint32_t *sets;   /* [vertex] */
    uint32_t *number; /* [vertex] of its piece, at the roots of sets */
    size_t count;
    struct table_piece *pieces;
};

struct place {
    float key[5];
    uint32_t vertex;
};

static int compare_places(const void *a, const void *b)
{
    const struct place *left = a, *right = b;
    for (int k = 0; k < 5; k++)
        if (left->key[k] != right->key[k])
            return left->key[k] < right->key[k] ? -1 : 1;
    return (left->vertex > right->vertex) - (left->vertex < right->vertex);
}

/* Vertices that differ in their normals alone are one. */
static void join_places(const tl_garment *garment, uint32_t *sets)
{
    const tl_mesh *mesh = &garment->model.mesh;
    struct place *places = TL_NEW_ARRAY(struct place, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const vec3s x = mesh->positions[i];
        const vec2s flat = garment->pattern[i];
        places[i] = (struct place){{x.x, x.y, x.z, flat.x, flat.y}, i};
    }
    qsort(places, mesh->vertex_count, sizeof *places, compare_places);
    for (size_t i = 1; i < mesh->vertex_count; i++) {
        struct place same = places[i];
        same.vertex = places[i - 1].vertex;
        if (compare_places(&places[i - 1], &same) == 0)
            tl_sets_join(sets, places[i - 1].vertex, places[i].vertex);
    }
    free(places);
}

static struct table_piece *piece_of(struct cutting_table *layout, uint32_t vertex)
{
    return &layout->pieces[layout->number[tl_sets_find(layout->sets, vertex)]];
}

static void find_pieces(struct cutting_table *layout)
{
    const tl_mesh *mesh = &layout->garment->model.mesh;
    join_places(layout->garment, layout->sets);
    for (size_t i = 0; i < mesh->index_count; i++)
        tl_sets_join(layout->sets, mesh->indices[i - i % 3], mesh->indices[i]);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        layout->number[i] = UINT32_MAX;
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t root = tl_sets_find(layout->sets, mesh->indices[i]);
        if (layout->number[root] != UINT32_MAX)
            continue;
        layout->number[root] = (uint32_t)layout->count;
        layout->pieces = tl_resize(layout->pieces, layout->count + 1, sizeof *layout->pieces);
        layout->pieces[layout->count++] = (struct table_piece){
            .root = root, .lower = {{INFINITY, INFINITY}}, .upper = {{-INFINITY, -INFINITY}}};
    }
}

static void measure_pieces(struct cutting_table *layout)
{
    const tl_mesh *mesh = &layout->garment->model.mesh;
    const vec2s *flat = layout->garment->pattern;
    for (size_t i = 0; i < mesh->index_count; i++) {
        struct table_piece *piece = piece_of(layout, mesh->indices[i]);
        piece->lower = glms_vec2_minv(piece->lower, flat[mesh->indices[i]]);
        piece->upper = glms_vec2_maxv(piece->upper, flat[mesh->indices[i]]);
    }
    for (size_t t = 0; t < mesh->index_count; t += 3) {
        const uint32_t *corner = &mesh->indices[t];
        vec2s side = glms_vec2_sub(flat[corner[1]], flat[corner[0]]);
        vec2s other = glms_vec2_sub(flat[corner[2]], flat[corner[0]]);
        piece_of(layout, corner[0])->area += (double)glms_vec2_cross(side, other) / 2;
    }
}

static vec2s size_of(const struct table_piece *piece)
{
    return glms_vec2_sub(piece->upper, piece->lower);
}

static int compare_pieces(const void *a, const void *b)
{
    const struct table_piece *left = a, *right = b;
    float tall = size_of(left).y, other = size_of(right).y;
    if (tall != other)
        return tall > other ? -1 : 1;
    return (left->root > right->root) - (left->root < right->root);
}

/* In rows from the top downwards. */
static vec2s place_pieces(struct cutting_table *layout)
{
    float area = 0, widest = 0;
    for (size_t i = 0; i < layout->count; i++) {
        vec2s size = size_of(&layout->pieces[i]);
        area += (size.x + TL_LAYOUT_GAP_M) * (size.y + TL_LAYOUT_GAP_M);
        widest = fmaxf(widest, size.x);
    }
    float maximum = fmaxf(widest, TABLE_ASPECT * sqrtf(area)), left = 0, top = 0, row = 0;
    vec2s table = {{0, 0}};
    for (size_t i = 0; i < layout->count; i++) {
        struct table_piece *piece = &layout->pieces[i];
        vec2s size = size_of(piece);
        if (left > 0 && left + size.x > maximum) {
            top += row + TL_LAYOUT_GAP_M;
            left = row = 0;
        }
        row = fmaxf(row, size.y);
        piece->at = (vec2s){{left, -(top + size.y)}};
        left += size.x + TL_LAYOUT_GAP_M;
        table.x = fmaxf(table.x, left - TL_LAYOUT_GAP_M);
        table.y = fmaxf(table.y, top + size.y);
    }
    for (size_t i = 0; i < layout->count; i++)
        layout->pieces[i].at.y += table.y;
    return table;
}

bool tl_layout_make(const tl_garment *garment, vec2s *out, vec2s *size)
{
    const tl_mesh *mesh = &garment->model.mesh;
    struct cutting_table layout = {.garment = garment};
    if (!garment->pattern || mesh->index_count == 0)
        return false;
    layout.sets = tl_sets_create(mesh->vertex_count);
    layout.number = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    find_pieces(&layout);
    measure_pieces(&layout);
    qsort(layout.pieces, layout.count, sizeof *layout.pieces, compare_pieces);
    for (size_t i = 0; i < layout.count; i++)
        layout.number[layout.pieces[i].root] = (uint32_t)i;
    *size = place_pieces(&layout);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        out[i] = (vec2s){{0, 0}};
        if (layout.number[tl_sets_find(layout.sets, i)] == UINT32_MAX)
            continue;
        const struct table_piece *piece = piece_of(&layout, i);
        vec2s at = glms_vec2_sub(garment->pattern[i], piece->lower);
        if (piece->area < 0)
            at.x = size_of(piece).x - at.x;
        out[i] = glms_vec2_add(piece->at, at);
    }
    free(layout.pieces);
    free(layout.number);
    free(layout.sets);
    return true;
}
