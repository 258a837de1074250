#include "assets/topology/pieces_internal.h"

#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* The place of every vertex, with seams closed. */
static uint32_t *close_seams(const tl_mesh *mesh, const uint32_t *weld, const struct tl_seam_pair *seams,
                             size_t seam_count)
{
    uint32_t *parents = tl_sets_create(mesh->vertex_count);
    uint32_t *places = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    for (size_t i = 0; i < seam_count; i++)
        tl_sets_join(parents, weld[seams[i].a], weld[seams[i].b]);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        places[i] = tl_sets_find(parents, weld[i]);
    free(parents);
    return places;
}

static uint32_t corner_of(const tl_mesh *mesh, uint32_t side, uint32_t end)
{
    return mesh->indices[side - side % 3 + (side % 3 + end) % 3];
}

static bool same_uv(const tl_mesh *mesh, uint32_t a, uint32_t b)
{
    return a == b || (mesh->uvs[a].x == mesh->uvs[b].x && mesh->uvs[a].y == mesh->uvs[b].y);
}

/* Sides by the lower place of their ends: those of place p are items[firsts[p]] to items[firsts[p + 1] - 1].
 */
struct buckets {
    uint32_t *firsts, *items;
};

static uint32_t low_place(const tl_mesh *mesh, const uint32_t *places, uint32_t side)
{
    uint32_t a = places[corner_of(mesh, side, 0)], b = places[corner_of(mesh, side, 1)];
    return a < b ? a : b;
}

static struct buckets sort_sides(const tl_mesh *mesh, const uint32_t *places)
{
    struct buckets sorted = {TL_NEW_ARRAY(uint32_t, mesh->vertex_count + 2),
                             TL_NEW_ARRAY(uint32_t, mesh->index_count)};
    for (uint32_t side = 0; side < mesh->index_count; side++)
        sorted.firsts[low_place(mesh, places, side) + 2]++;
    for (size_t p = 2; p < mesh->vertex_count + 2; p++)
        sorted.firsts[p] += sorted.firsts[p - 1];
    for (uint32_t side = 0; side < mesh->index_count; side++)
        sorted.items[sorted.firsts[low_place(mesh, places, side) + 1]++] = side;
    return sorted;
}

enum relation { SEPARATE, SEWN, JOINED };

/* The relation of two sides that begin in one bucket: JOINED within one piece. */
static enum relation relation_of(const tl_mesh *mesh, const uint32_t *places, uint32_t s, uint32_t t)
{
    uint32_t a = corner_of(mesh, s, 0), b = corner_of(mesh, s, 1);
    uint32_t c = corner_of(mesh, t, 0), d = corner_of(mesh, t, 1);
    bool same = places[a] == places[c] && places[b] == places[d];
    bool opposite = places[a] == places[d] && places[b] == places[c];
    if (!same && !opposite)
        return SEPARATE;
    return opposite && same_uv(mesh, a, d) && same_uv(mesh, b, c) ? JOINED : SEWN;
}

static void pair_sides(const tl_mesh *mesh, struct tl_pieces *pieces)
{
    struct buckets sorted = sort_sides(mesh, pieces->places);
    for (size_t p = 0; p < mesh->vertex_count; p++)
        for (uint32_t i = sorted.firsts[p]; i < sorted.firsts[p + 1]; i++)
            for (uint32_t k = i + 1; k < sorted.firsts[p + 1]; k++) {
                uint32_t s = sorted.items[i], t = sorted.items[k];
                enum relation relation = relation_of(mesh, pieces->places, s, t);
                if (relation == JOINED && pieces->across[s] == TL_NO_BORDER &&
                    pieces->across[t] == TL_NO_BORDER) {
                    pieces->across[s] = t;
                    pieces->across[t] = s;
                } else if (relation != SEPARATE) {
                    pieces->partners[s] = pieces->partners[s] == TL_NO_BORDER ? t : pieces->partners[s];
                    pieces->partners[t] = pieces->partners[t] == TL_NO_BORDER ? s : pieces->partners[t];
                }
            }
    free(sorted.firsts);
    free(sorted.items);
}

static void number_pieces(struct tl_pieces *pieces)
{
    uint32_t *parents = tl_sets_create(pieces->triangle_count);
    for (size_t side = 0; side < 3 * pieces->triangle_count; side++)
        if (pieces->across[side] != TL_NO_BORDER)
            tl_sets_join(parents, (uint32_t)(side / 3), pieces->across[side] / 3);
    for (uint32_t t = 0; t < pieces->triangle_count; t++) /* a root is the first triangle of its piece */
        pieces->pieces[t] =
            parents[t] == t ? (uint32_t)pieces->piece_count++ : pieces->pieces[tl_sets_find(parents, t)];
    free(parents);
}

static double area_in_space(const tl_mesh *mesh, const vec2s *pattern, const uint32_t *v)
{
    if (pattern) {
        vec2s a = glms_vec2_sub(pattern[v[1]], pattern[v[0]]),
              b = glms_vec2_sub(pattern[v[2]], pattern[v[0]]);
        return 0.5 * fabs((double)(a.x * b.y - a.y * b.x));
    }
    vec3s a = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
    vec3s b = glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]);
    return 0.5 * (double)glms_vec3_norm(glms_vec3_cross(a, b));
}

static void measure(const tl_mesh *mesh, const vec2s *pattern, struct tl_pieces *pieces)
{
    const double degenerate = 1e-14; /* less than a millionth of a texel of an 8k map */
    double *uv_areas = TL_NEW_ARRAY(double, pieces->piece_count);
    pieces->areas = TL_NEW_ARRAY(double, pieces->piece_count);
    pieces->metres = TL_NEW_ARRAY(float, pieces->piece_count);
    for (size_t t = 0; t < pieces->triangle_count; t++) {
        const uint32_t *v = &mesh->indices[3 * t];
        vec2s a = glms_vec2_sub(mesh->uvs[v[1]], mesh->uvs[v[0]]);
        vec2s b = glms_vec2_sub(mesh->uvs[v[2]], mesh->uvs[v[0]]);
        pieces->areas[pieces->pieces[t]] += area_in_space(mesh, pattern, v);
        uv_areas[pieces->pieces[t]] += 0.5 * fabs((double)(a.x * b.y - a.y * b.x));
    }
    for (size_t i = 0; i < pieces->piece_count; i++)
        if (uv_areas[i] > degenerate && pieces->areas[i] >= TL_BORDER_MIN_PIECE_M2)
            pieces->metres[i] = (float)sqrt(pieces->areas[i] / uv_areas[i]);
    free(uv_areas);
}

struct tl_pieces tl_pieces_find(const tl_mesh *mesh, const vec2s *pattern, const uint32_t *weld,
                                const struct tl_seam_pair *seams, size_t seam_count)
{
    size_t triangles = mesh->index_count / 3;
    struct tl_pieces pieces = {.triangle_count = triangles,
                               .places = close_seams(mesh, weld, seams, seam_count),
                               .across = TL_NEW_ARRAY(uint32_t, 3 * triangles),
                               .partners = TL_NEW_ARRAY(uint32_t, 3 * triangles),
                               .pieces = TL_NEW_ARRAY(uint32_t, triangles)};
    for (size_t i = 0; i < 3 * triangles; i++)
        pieces.across[i] = pieces.partners[i] = TL_NO_BORDER;
    pair_sides(mesh, &pieces);
    number_pieces(&pieces);
    measure(mesh, pattern, &pieces);
    return pieces;
}

void tl_pieces_release(struct tl_pieces *pieces)
{
    free(pieces->places);
    free(pieces->across);
    free(pieces->partners);
    free(pieces->pieces);
    free(pieces->metres);
    free(pieces->areas);
    *pieces = (struct tl_pieces){0};
}

/* Turns about the end of `side` through the triangles of its piece. */
uint32_t tl_pieces_next(const struct tl_pieces *pieces, uint32_t side)
{
    uint32_t next = side - side % 3 + (side % 3 + 1) % 3;
    for (size_t turns = 0; turns < pieces->triangle_count && pieces->across[next] != TL_NO_BORDER; turns++) {
        uint32_t other = pieces->across[next];
        next = other - other % 3 + (other % 3 + 1) % 3;
    }
    return next;
}
