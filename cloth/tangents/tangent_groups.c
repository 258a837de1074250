#include "cloth/tangents/tangent_groups.h"

#include "cloth/mesh/topology.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Twins ---- */

/* The edge's vertices in increasing order, so that both directions sort next to each other. */
struct ordered_edge {
    uint32_t low, high;
    uint32_t falls; /* 1 where it runs from the higher vertex to the lower */
    uint32_t corner;
};

static int compare_half_edges(const void *a, const void *b)
{
    const struct ordered_edge *left = a, *right = b;
    if (left->low != right->low)
        return left->low < right->low ? -1 : 1;
    if (left->high != right->high)
        return left->high < right->high ? -1 : 1;
    if (left->falls != right->falls)
        return left->falls < right->falls ? -1 : 1;
    return (left->corner > right->corner) - (left->corner < right->corner);
}

static struct ordered_edge *sort_half_edges(const uint32_t *vertices, size_t corner_count)
{
    struct ordered_edge *edges = TL_NEW_ARRAY(struct ordered_edge, corner_count);
    for (size_t i = 0; i < corner_count; i++) {
        uint32_t a = vertices[i], b = vertices[tl_corner_turn((uint32_t)i, 1)];
        edges[i] = (struct ordered_edge){a < b ? a : b, a < b ? b : a, a > b, (uint32_t)i};
    }
    qsort(edges, corner_count, sizeof *edges, compare_half_edges);
    return edges;
}

uint32_t *tl_twins_build(const uint32_t *vertices, size_t corner_count)
{
    /* Each run of equal edges holds the rising half edges first, then the falling ones from `falling` on;
     * both are ordered by corner, so that the pairing does not depend on qsort. */
    struct ordered_edge *edges = sort_half_edges(vertices, corner_count);
    uint32_t *twins = TL_NEW_ARRAY(uint32_t, corner_count);
    memset(twins, 0xff, corner_count * sizeof *twins);
    for (size_t first = 0, end; first < corner_count; first = end) {
        size_t falling = first;
        for (end = first;
             end < corner_count && edges[end].low == edges[first].low && edges[end].high == edges[first].high;
             end++)
            falling += !edges[end].falls;
        for (size_t rise = first, fall = falling; rise < falling && fall < end; rise++, fall++) {
            twins[edges[rise].corner] = edges[fall].corner;
            twins[edges[fall].corner] = edges[rise].corner;
        }
    }
    free(edges);
    return twins;
}

uint32_t tl_twins_after(const uint32_t *twins, uint32_t corner)
{
    return twins[tl_corner_turn(corner, 2)];
}

uint32_t tl_twins_before(const uint32_t *twins, uint32_t corner)
{
    return twins[corner] == TL_NONE ? TL_NONE : tl_corner_turn(twins[corner], 1);
}

/* ---- Normals ---- */

/* Twice the triangle's area times its normal. */
static vec3s corner_area(const vec3s *positions, const uint32_t *c)
{
    return glms_vec3_cross(glms_vec3_sub(positions[c[1]], positions[c[0]]),
                           glms_vec3_sub(positions[c[2]], positions[c[0]]));
}

/* Marks the render vertices of back faces. A sheet may be modelled from both sides: two triangles on the same
 * three welded vertices, with opposite windings and render vertices of their own. The topology keeps the
 * first of such triangles. A vertex is a back if only the other triangles use it and one of them faces
 * against the sum of the kept ones' normals. Without this the normals of both sides would cancel. */
static void find_backs(const tl_mesh *mesh, const struct tl_topology *topology, bool *back)
{
    vec3s *sums = TL_NEW_ARRAY(vec3s, topology->vertex_count);
    bool *front = TL_NEW_ARRAY(bool, mesh->vertex_count);
    bool *first = TL_NEW_ARRAY(bool, mesh->index_count / 3);
    for (size_t i = 0; i < topology->triangle_count; i++) {
        const uint32_t *c = &mesh->indices[3 * (size_t)topology->source[i]];
        vec3s area = corner_area(mesh->positions, c);
        first[topology->source[i]] = true;
        for (int k = 0; k < 3; k++) {
            sums[topology->weld[c[k]]] = glms_vec3_add(sums[topology->weld[c[k]]], area);
            front[c[k]] = true;
        }
    }
    for (size_t t = 0; t < mesh->index_count / 3; t++) {
        const uint32_t *c = &mesh->indices[3 * t];
        vec3s area = corner_area(mesh->positions, c);
        for (int k = 0; k < 3 && !first[t]; k++)
            if (!front[c[k]] && glms_vec3_dot(area, sums[topology->weld[c[k]]]) < 0)
                back[c[k]] = true;
    }
    free(sums);
    free(front);
    free(first);
}

/* Numbers the normals in the order of their first render vertex: one for each welded vertex, and a second one
 * for its back if it has one. */
static void number_normals(struct tl_tangent_groups *groups, const tl_mesh *mesh, const uint32_t *weld)
{
    size_t welded = 0;
    for (size_t i = 0; i < groups->render_count; i++)
        welded = weld[i] >= welded ? weld[i] + (size_t)1 : welded;
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, groups->render_count, welded);
    bool *back = TL_NEW_ARRAY(bool, groups->render_count);
    find_backs(mesh, &topology, back);
    uint32_t *numbers = TL_NEW_ARRAY(uint32_t, 2 * welded); /* plus one */
    for (size_t i = 0; i < groups->render_count; i++) {
        uint32_t *number = &numbers[weld[i] + (back[i] ? welded : 0)];
        if (*number == 0)
            *number = (uint32_t)++groups->normal_count;
        groups->normal_of[i] = *number - 1;
    }
    free(numbers);
    free(back);
    tl_topology_release(&topology);
}

/* Lists the corners of triangles with three different normals; the others have two corners at one point and
 * no area. */
static void list_corners(struct tl_tangent_groups *groups, const tl_mesh *mesh)
{
    groups->vertices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    groups->normals = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    for (size_t t = 0; t < mesh->index_count / 3; t++) {
        const uint32_t *c = &mesh->indices[3 * t];
        const uint32_t n[3] = {groups->normal_of[c[0]], groups->normal_of[c[1]], groups->normal_of[c[2]]};
        if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0])
            continue;
        memcpy(groups->vertices + groups->corner_count, c, sizeof n);
        memcpy(groups->normals + groups->corner_count, n, sizeof n);
        groups->corner_count += 3;
    }
}

/* ---- Tangents ---- */

/* MikkTSpace welds corners of equal position, normal and UV. The index of the normal implies the position. */
struct mikk_key {
    uint32_t normal, u, v;
    uint32_t render; /* last, so that the order of equal keys is fixed */
};

static int compare_mikk_keys(const void *a, const void *b)
{
    const struct mikk_key *left = a, *right = b;
    if (left->normal != right->normal)
        return left->normal < right->normal ? -1 : 1;
    if (left->u != right->u)
        return left->u < right->u ? -1 : 1;
    if (left->v != right->v)
        return left->v < right->v ? -1 : 1;
    return (left->render > right->render) - (left->render < right->render);
}

/* The bits, with -0 as +0: equal values have equal keys. NaN equals itself here. */
static uint32_t float_bits(float value)
{
    uint32_t bits;
    value = value == 0 ? 0 : value;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Returns the index of MikkTSpace's welded vertex for every corner. The caller frees it. */
static uint32_t *weld_corners(const struct tl_tangent_groups *groups, const vec2s *uvs)
{
    struct mikk_key *keys = TL_NEW_ARRAY(struct mikk_key, groups->render_count);
    for (size_t i = 0; i < groups->render_count; i++)
        keys[i] =
            (struct mikk_key){groups->normal_of[i], float_bits(uvs[i].x), float_bits(uvs[i].y), (uint32_t)i};
    qsort(keys, groups->render_count, sizeof *keys, compare_mikk_keys);
    uint32_t *numbers = TL_NEW_ARRAY(uint32_t, groups->render_count), count = 0;
    for (size_t i = 0; i < groups->render_count; i++) {
        bool same = i > 0 && keys[i].normal == keys[i - 1].normal && keys[i].u == keys[i - 1].u &&
                    keys[i].v == keys[i - 1].v;
        count += !same;
        numbers[keys[i].render] = count - 1;
    }
    uint32_t *welded = TL_NEW_ARRAY(uint32_t, groups->corner_count);
    for (size_t i = 0; i < groups->corner_count; i++)
        welded[i] = numbers[groups->vertices[i]];
    free(numbers);
    free(keys);
    return welded;
}

/* Twice the signed area in UV; 0 if it is not finite or too small to define a tangent. */
static double uv_area(const vec2s *uvs, const uint32_t *corners)
{
    vec2s a = uvs[corners[0]], b = uvs[corners[1]], c = uvs[corners[2]];
    double area = ((double)b.x - (double)a.x) * ((double)c.y - (double)a.y) -
                  ((double)b.y - (double)a.y) * ((double)c.x - (double)a.x);
    return isfinite(area) && fabs(area) > 1e-37 ? area : 0;
}

/* Mikkelsen's vOs = sign(area) (t31.v d1 - t21.v d2), where d1, d2 are the edges in space and t21, t31 in UV.
 * Its length is not needed, because the tangent is projected and normalised later; dividing by the larger
 * coefficient keeps tiny UVs from underflowing in float. */
static void find_gradients(struct tl_tangent_groups *groups, const vec2s *uvs)
{
    groups->gradients = tl_alloc(groups->corner_count / 3, sizeof *groups->gradients);
    for (size_t t = 0; t < groups->corner_count / 3; t++) {
        const uint32_t *c = &groups->vertices[3 * t];
        double area = uv_area(uvs, c);
        double side = (double)uvs[c[1]].y - (double)uvs[c[0]].y;
        double other = (double)uvs[c[2]].y - (double)uvs[c[0]].y;
        double scale = fmax(fabs(side), fabs(other));
        if (area == 0 || !(scale > 0))
            continue;
        groups->gradients[t][0] = copysign(other, other * area) / scale;
        groups->gradients[t][1] = copysign(side, -side * area) / scale;
    }
}

static bool has_tangent(const struct tl_tangent_groups *groups, size_t triangle)
{
    return groups->gradients[triangle][0] != 0 || groups->gradients[triangle][1] != 0;
}

/* Adds a corner to a group, unless it is in a group or its triangle has the opposite handedness. A triangle
 * without UV area takes the handedness of the first group that reaches it, as MikkTSpace does. Returns
 * whether the corner was added. */
static bool join_group(struct tl_tangent_groups *groups, float *signs, uint32_t corner, uint32_t group)
{
    float *sign = &signs[corner / 3];
    if (groups->groups[corner] != TL_NONE || (*sign != 0 && *sign != groups->group_signs[group]))
        return false;
    *sign = groups->group_signs[group];
    groups->groups[corner] = group;
    return true;
}

/* Forms MikkTSpace's groups: corners around one of its vertices, connected over edges between triangles of
 * equal UV handedness. `signs` [triangle]: handedness, 0 without UV area. Each group grows from its first
 * corner in both directions until a border, another group or the other handedness. */
static void group_corners(struct tl_tangent_groups *groups, float *signs, const uint32_t *twins)
{
    memset(groups->groups, 0xff, groups->corner_count * sizeof *groups->groups);
    for (uint32_t c = 0; c < groups->corner_count; c++) {
        if (groups->groups[c] != TL_NONE || !has_tangent(groups, c / 3))
            continue;
        uint32_t group = (uint32_t)groups->group_count++;
        groups->group_signs[group] = signs[c / 3];
        groups->groups[c] = group;
        for (uint32_t i = tl_twins_before(twins, c); i != TL_NONE && join_group(groups, signs, i, group);)
            i = tl_twins_before(twins, i);
        for (uint32_t i = tl_twins_after(twins, c); i != TL_NONE && join_group(groups, signs, i, group);)
            i = tl_twins_after(twins, i);
    }
}

/* Chooses one group for each render vertex. MikkTSpace would split a vertex whose corners are in several
 * groups; the mesh keeps its vertices, so the vertex takes the group of most of its corners, the first one if
 * several are equal. */
static void choose_groups(struct tl_tangent_groups *groups)
{
    uint32_t *votes = TL_NEW_ARRAY(uint32_t, groups->group_count); /* of one render vertex at a time */
    struct tl_fans fans = tl_fans_build(groups->vertices, groups->corner_count, groups->render_count);
    for (size_t r = 0; r < groups->render_count; r++) {
        uint32_t best = TL_NONE;
        for (uint32_t i = fans.first[r]; i < fans.first[r + 1]; i++)
            if (groups->groups[fans.items[i]] != TL_NONE)
                votes[groups->groups[fans.items[i]]]++;
        for (uint32_t i = fans.first[r]; i < fans.first[r + 1]; i++) {
            uint32_t group = groups->groups[fans.items[i]];
            if (group != TL_NONE && (best == TL_NONE || votes[group] > votes[best]))
                best = group;
        }
        for (uint32_t i = fans.first[r]; i < fans.first[r + 1]; i++)
            if (groups->groups[fans.items[i]] != TL_NONE)
                votes[groups->groups[fans.items[i]]] = 0;
        groups->group_of[r] = best;
    }
    tl_fans_release(&fans);
    free(votes);
}

static void build_groups(struct tl_tangent_groups *groups, const vec2s *uvs)
{
    uint32_t *welded = weld_corners(groups, uvs);
    uint32_t *twins = tl_twins_build(welded, groups->corner_count);
    float *signs = TL_NEW_ARRAY(float, groups->corner_count / 3);
    find_gradients(groups, uvs);
    /* v points down in glTF and up in a normal map, so the bitangent points to smaller v. */
    for (size_t t = 0; t < groups->corner_count / 3; t++)
        if (has_tangent(groups, t))
            signs[t] = uv_area(uvs, &groups->vertices[3 * t]) > 0 ? -1 : 1;
    group_corners(groups, signs, twins);
    choose_groups(groups);
    free(welded);
    free(twins);
    free(signs);
}

struct tl_tangent_groups tl_tangent_groups_build(const tl_mesh *mesh, const uint32_t *weld)
{
    struct tl_tangent_groups groups = {.render_count = mesh->vertex_count};
    groups.normal_of = TL_NEW_ARRAY(uint32_t, groups.render_count);
    groups.group_of = TL_NEW_ARRAY(uint32_t, groups.render_count);
    number_normals(&groups, mesh, weld);
    list_corners(&groups, mesh);
    groups.groups = TL_NEW_ARRAY(uint32_t, groups.corner_count);
    groups.group_signs = TL_NEW_ARRAY(float, groups.corner_count);
    vec2s *none = mesh->uvs ? NULL : TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    build_groups(&groups, mesh->uvs ? mesh->uvs : none);
    free(none);
    return groups;
}

void tl_tangent_groups_release(struct tl_tangent_groups *groups)
{
    free(groups->vertices);
    free(groups->normals);
    free(groups->normal_of);
    free(groups->gradients);
    free(groups->groups);
    free(groups->group_signs);
    free(groups->group_of);
    *groups = (struct tl_tangent_groups){0};
}
