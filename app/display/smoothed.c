#include "app/display/smoothed.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Normals that differ by more than half a right angle are those of a hard edge. */
#define HARD_COSINE 0.707f

/* The side of a triangle that faces a corner, by its vertices. */
struct drawn_side {
    uint32_t key[2];  /* what sides are sorted by, the lower one first */
    uint32_t ends[2]; /* vertices of the garment, in the order of `key` */
    uint32_t triangle, corner;
};

static int compare_sides(const void *a, const void *b)
{
    const struct drawn_side *left = a, *right = b;
    for (int i = 0; i < 2; i++)
        if (left->key[i] != right->key[i])
            return left->key[i] < right->key[i] ? -1 : 1;
    if (left->triangle != right->triangle)
        return left->triangle < right->triangle ? -1 : 1;
    return left->corner < right->corner ? -1 : left->corner > right->corner;
}

static bool is_same_edge(const struct drawn_side *a, const struct drawn_side *b)
{
    return a->key[0] == b->key[0] && a->key[1] == b->key[1];
}

/* All sides, by welded vertices or, with `weld` NULL, by the garment's. The caller frees them. */
static struct drawn_side *sort_sides(const tl_mesh *mesh, const uint32_t *weld)
{
    struct drawn_side *sides = TL_NEW_ARRAY(struct drawn_side, mesh->index_count);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t first = i - i % 3, corner = i % 3;
        uint32_t a = mesh->indices[first + (corner + 1) % 3], b = mesh->indices[first + (corner + 2) % 3];
        uint32_t at = weld ? weld[a] : a, to = weld ? weld[b] : b;
        bool turned = to < at;
        sides[i] = (struct drawn_side){
            {turned ? to : at, turned ? at : to}, {turned ? b : a, turned ? a : b}, first / 3, corner};
    }
    qsort(sides, mesh->index_count, sizeof *sides, compare_sides);
    return sides;
}

static bool is_split(const tl_garment *garment, const struct drawn_side *a, const struct drawn_side *b)
{
    const vec3s *normals = garment->model.mesh.normals;
    bool parts = true, turns = true; /* at both ends */
    for (int k = 0; k < 2; k++) {
        parts = parts && a->ends[k] != b->ends[k];
        turns = turns && glms_vec3_dot(normals[a->ends[k]], normals[b->ends[k]]) < HARD_COSINE;
    }
    return parts && (garment->pattern || turns);
}

static bool (*find_creases(const tl_garment *garment, const uint32_t *weld))[3]
{
    const tl_mesh *mesh = &garment->model.mesh;
    bool(*creases)[3] = tl_alloc(mesh->index_count / 3, sizeof *creases);
    struct drawn_side *sides = sort_sides(mesh, weld);
    for (size_t i = 0; i + 1 < mesh->index_count; i++)
        if (is_same_edge(&sides[i], &sides[i + 1]) && is_split(garment, &sides[i], &sides[i + 1]))
            creases[sides[i].triangle][sides[i].corner] = true;
    free(sides);
    return creases;
}

/* Makes the vertices on the garment's edges, each once, and the triangles in the order of the weights' own.
 */
static void split_mesh(const tl_mesh *mesh, const uint32_t *weld, struct tl_smoothed *out)
{
    struct drawn_side *sides = sort_sides(mesh, NULL);
    uint32_t(*edge_of)[3] = tl_alloc(mesh->index_count / 3, sizeof *edge_of);
    tl_mesh *fine = &out->model.mesh;
    size_t count = mesh->vertex_count, room = mesh->vertex_count + mesh->index_count;
    out->weld = TL_NEW_ARRAY(uint32_t, room);
    out->ends = tl_alloc(mesh->index_count, sizeof *out->ends);
    memcpy(out->weld, weld, count * sizeof *weld);
    for (size_t i = 0; i < mesh->index_count; i++) {
        const struct drawn_side *side = &sides[i];
        if (i == 0 || !is_same_edge(side, &sides[i - 1])) {
            memcpy(out->ends[count - mesh->vertex_count], side->ends, sizeof side->ends);
            out->weld[count++] = out->weights.triangles[4 * side->triangle + 3][side->corner];
        }
        edge_of[side->triangle][side->corner] = (uint32_t)(count - 1);
    }
    fine->vertex_count = count;
    fine->index_count = 4 * mesh->index_count;
    fine->indices = TL_NEW_ARRAY(uint32_t, fine->index_count);
    for (size_t t = 0; t < mesh->index_count / 3; t++)
        for (size_t k = 0; k < 4; k++)
            for (size_t c = 0; c < 3; c++)
                fine->indices[3 * (4 * t + k) + c] =
                    k < 3 && c == 0 ? mesh->indices[3 * t + k] : edge_of[t][k == 3 ? c : (k + 3 - c) % 3];
    free(edge_of);
    free(sides);
}

/* Four triangles lie in their parent, and so have its borders. */
static tl_borders split_borders(const tl_borders *borders)
{
    size_t near_count = borders->triangle_count > 0 ? borders->firsts[borders->triangle_count] : 0, at = 0;
    tl_borders fine = *borders;
    fine.triangle_count = 4 * borders->triangle_count;
    fine.borders = TL_NEW_ARRAY(struct tl_border, borders->border_count);
    fine.firsts = TL_NEW_ARRAY(uint32_t, fine.triangle_count + 1);
    fine.near = TL_NEW_ARRAY(uint32_t, 4 * near_count);
    if (borders->border_count > 0)
        memcpy(fine.borders, borders->borders, borders->border_count * sizeof *fine.borders);
    for (size_t t = 0; t < fine.triangle_count; t++) {
        for (uint32_t i = borders->firsts[t / 4]; i < borders->firsts[t / 4 + 1]; i++)
            fine.near[at++] = borders->near[i];
        fine.firsts[t + 1] = (uint32_t)at;
    }
    return fine;
}

/* Light is computed at the garment's own vertices. */
static void make_light_mesh(struct tl_smoothed *out)
{
    const tl_mesh *fine = &out->model.mesh;
    out->light_mesh = tl_light_mesh_make(fine->vertex_count);
    for (size_t i = 0; i < fine->vertex_count; i++) {
        const uint32_t own[2] = {(uint32_t)i, (uint32_t)i};
        const uint32_t *ends = i < out->source_count ? own : out->ends[i - out->source_count];
        uint32_t *from = out->light_mesh.from[i];
        float *shares = out->light_mesh.shares[i];
        from[0] = ends[0], from[1] = from[2] = ends[1];
        shares[0] = shares[1] = 0.5f;
    }
    tl_light_mesh_number(&out->light_mesh, fine->indices, fine->index_count);
}

static void take_uvs(const tl_mesh *mesh, struct tl_smoothed *out)
{
    tl_mesh *fine = &out->model.mesh;
    fine->uvs = TL_NEW_ARRAY(vec2s, fine->vertex_count);
    memcpy(fine->uvs, mesh->uvs, mesh->vertex_count * sizeof *mesh->uvs);
    for (size_t i = mesh->vertex_count; i < fine->vertex_count; i++) {
        const uint32_t *ends = out->ends[i - mesh->vertex_count];
        fine->uvs[i] = glms_vec2_scale(glms_vec2_add(mesh->uvs[ends[0]], mesh->uvs[ends[1]]), 0.5f);
    }
}

/* The smooth surface is inside of what bulges: it would sink into a body that the cloth lies on, and through
 * cloth that lies on it. */
static void stay_clear(struct tl_smoothed *smoothed)
{
    const vec3s *coarse = smoothed->coarse;
    size_t source_count = smoothed->weights.source_count;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < smoothed->weights.vertex_count; i++) {
        uint32_t own[2] = {(uint32_t)i, (uint32_t)i};
        const uint32_t *ends = i < source_count ? own : smoothed->weights.ends[i - source_count];
        vec3s flat = glms_vec3_lerp(coarse[ends[0]], coarse[ends[1]], 0.5f);
        vec3s moved = glms_vec3_sub(smoothed->fine[i], flat);
        float share = 1;
        for (int k = 0; k < 2; k++)
            share = fminf(share,
                          tl_clearance_share(&smoothed->clearances[ends[k]], coarse[ends[k]], flat, moved));
        smoothed->fine[i] = glms_vec3_add(flat, glms_vec3_scale(moved, share));
    }
}

/* Smooths the garment's positions at its welded vertices. */
static void smooth(struct tl_smoothed *smoothed, const vec3s *positions)
{
    for (size_t i = 0; i < smoothed->weights.source_count; i++)
        smoothed->coarse[i] = positions[smoothed->of_weld[i]];
    tl_smooth_apply(&smoothed->weights, smoothed->coarse, smoothed->fine);
}

static void give_positions(const struct tl_smoothed *smoothed, vec3s *out)
{
    for (size_t i = 0; i < smoothed->model.mesh.vertex_count; i++)
        out[i] = smoothed->fine[smoothed->weld[i]];
}

static void follow(struct tl_smoothed *smoothed, const struct tl_smoothed_cloth *worn, const vec3s *positions)
{
    smooth(smoothed, positions);
    tl_cloth_clearances(worn->cloth, worn->collider, smoothed->clearances);
    stay_clear(smoothed);
    give_positions(smoothed, smoothed->moving.positions);
    tl_moving_update(&smoothed->moving);
}

void tl_smoothed_make(const tl_garment *garment, const struct tl_smoothed_cloth *worn,
                      const tl_borders *borders, struct tl_smoothed *out)
{
    const tl_mesh *mesh = &garment->model.mesh;
    const uint32_t *weld = tl_cloth_weld(worn->cloth);
    size_t triangle_count = mesh->index_count / 3, welded = 0;
    *out = (struct tl_smoothed){.source_count = mesh->vertex_count};
    if (triangle_count > TL_SMOOTHED_TRIANGLES)
        return;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        welded = weld[i] >= welded ? weld[i] + (size_t)1 : welded;
    uint32_t(*triangles)[3] = tl_alloc(triangle_count, sizeof *triangles);
    for (size_t i = 0; i < mesh->index_count; i++)
        triangles[i / 3][i % 3] = weld[mesh->indices[i]];
    bool(*creases)[3] = find_creases(garment, weld);
    out->weights = tl_smooth_make(&(struct tl_smooth_source){
        welded, triangle_count, (const uint32_t(*)[3])triangles, (const bool(*)[3])creases});
    free(triangles);
    free(creases);
    out->of_weld = TL_NEW_ARRAY(uint32_t, welded);
    for (size_t i = mesh->vertex_count; i-- > 0;) /* the first vertex at each place */
        out->of_weld[weld[i]] = (uint32_t)i;
    out->coarse = TL_NEW_ARRAY(vec3s, welded);
    out->clearances = TL_NEW_ARRAY(struct tl_clearance, welded);
    out->fine = TL_NEW_ARRAY(vec3s, out->weights.vertex_count);
    split_mesh(mesh, weld, out);
    make_light_mesh(out);
    take_uvs(mesh, out);
    out->model.mesh.positions = TL_NEW_ARRAY(vec3s, out->model.mesh.vertex_count);
    smooth(out, mesh->positions);
    give_positions(out, out->model.mesh.positions);
    out->parts = TL_NEW_ARRAY(struct tl_mesh_part, mesh->part_count);
    tl_moving_create(&out->moving, &out->model, out->weld);
    out->moving.borders = split_borders(borders);
}

void tl_smoothed_release(struct tl_smoothed *smoothed)
{
    tl_moving_release(&smoothed->moving);
    tl_mesh_release(&smoothed->model.mesh);
    tl_smooth_release(&smoothed->weights);
    free(smoothed->of_weld);
    free(smoothed->weld);
    free(smoothed->ends);
    tl_light_mesh_release(&smoothed->light_mesh);
    free(smoothed->coarse);
    free(smoothed->clearances);
    free(smoothed->fine);
    free(smoothed->strains);
    free(smoothed->crossed);
    free(smoothed->parts);
    *smoothed = (struct tl_smoothed){0};
}

bool tl_smoothed_fits(const struct tl_smoothed *smoothed, const tl_cloth *cloth)
{
    const size_t bytes = smoothed->source_count * sizeof *smoothed->weld;
    return smoothed->source_count > 0 &&
           (!smoothed->weld || memcmp(smoothed->weld, tl_cloth_weld(cloth), bytes) == 0);
}

/* A new vertex has the mean of the strains of its edge's ends, a triangle what its parent has. */
static void take_values(struct tl_smoothed *smoothed, const tl_surface *garment, tl_surface *out)
{
    size_t count = smoothed->model.mesh.vertex_count, triangles = smoothed->model.mesh.index_count / 3;
    if (garment->strains && !smoothed->strains)
        smoothed->strains = TL_NEW_ARRAY(vec3s, count);
    if (garment->crossed && !smoothed->crossed)
        smoothed->crossed = TL_NEW_ARRAY(bool, triangles);
    for (size_t i = 0; garment->strains && i < count; i++) {
        const uint32_t *ends = i < smoothed->source_count ? NULL : smoothed->ends[i - smoothed->source_count];
        smoothed->strains[i] =
            ends ? glms_vec3_lerp(garment->strains[ends[0]], garment->strains[ends[1]], 0.5f)
                 : garment->strains[i];
    }
    for (size_t t = 0; garment->crossed && t < triangles; t++)
        smoothed->crossed[t] = garment->crossed[t / 4];
    out->strains = garment->strains ? smoothed->strains : NULL;
    out->crossed = garment->crossed ? smoothed->crossed : NULL;
}

tl_surface tl_smoothed_surface(struct tl_smoothed *smoothed, const struct tl_smoothed_cloth *worn,
                               const tl_surface *garment)
{
    if (smoothed->model.mesh.vertex_count == 0)
        return *garment;
    if (smoothed->revision != garment->motion_revision)
        follow(smoothed, worn, garment->positions);
    smoothed->revision = garment->motion_revision;
    tl_surface out = *garment;
    take_values(smoothed, garment, &out);
    for (size_t i = 0; i < garment->part_count; i++) {
        smoothed->parts[i] = garment->parts[i];
        smoothed->parts[i].first_index *= 4;
        smoothed->parts[i].index_count *= 4;
    }
    out.vertex_count = smoothed->model.mesh.vertex_count;
    out.light_mesh = &smoothed->light_mesh;
    out.positions = smoothed->moving.positions;
    out.normals = smoothed->moving.normals;
    out.tangents = smoothed->moving.tangents;
    out.has_own_normals = false;
    out.uvs = smoothed->model.mesh.uvs;
    out.index_count = smoothed->model.mesh.index_count;
    out.indices = smoothed->model.mesh.indices;
    out.parts = smoothed->parts;
    out.borders = garment->borders ? &smoothed->moving.borders : NULL;
    return out;
}
