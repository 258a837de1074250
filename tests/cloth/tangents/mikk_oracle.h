/* MikkTSpace from its description ([Mikkelsen 2008] and the comments of its reference code), as a reference
 * for tests: slow and simple, in double, per corner and triangle. It shares no code and no order of summation
 * with cloth/tangents.
 *
 * Corners with equal position, given normal and UV are one vertex. Triangles with two corners at one position
 * are left out. An edge connects the first two triangles that run along it in opposite directions. A group
 * spreads around its vertex over such edges while the UV handedness is the same. A triangle without UV area
 * takes the handedness of the first group that reaches it, and contributes nothing. A group's tangent is the
 * sum, over its corners, of the triangle's unit dP/du in the plane of the normal, times the angle between the
 * corner's edges in that plane. */
#ifndef TOILE_TESTS_CLOTH_TANGENTS_MIKK_ORACLE_H
#define TOILE_TESTS_CLOTH_TANGENTS_MIKK_ORACLE_H

#include "assets/base/mesh.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/memory.h"

#include <float.h>
#include <stdbool.h>
#include <stdlib.h>

#define ORACLE_NONE SIZE_MAX

struct oracle {
    const tl_mesh *mesh;
    const vec3s *positions, *normals; /* normals: as given; only their equality counts */
    const uint32_t *weld;
    size_t *first_at, *next_at; /* corners at each place, in rising order: the first, and after each one */
    size_t *partner;            /* corner at which the same edge begins in the other triangle */
    size_t *group;              /* a corner's group is named by its first corner */
    int *hand;                  /* of each triangle: 1 where UV area is positive, -1, or 0 */
};

static inline uint32_t oracle_vertex(const struct oracle *o, size_t corner)
{
    return o->mesh->indices[corner];
}

static inline size_t oracle_turn(size_t corner, size_t by)
{
    return corner - corner % 3 + (corner + by) % 3;
}

static inline vec3d oracle_place(const struct oracle *o, size_t corner)
{
    return vec3d_from(o->positions[oracle_vertex(o, corner)]);
}

static inline double oracle_angle(vec3d a, vec3d b)
{
    return atan2(vec3d_norm(vec3d_cross(a, b)), vec3d_dot(a, b));
}

static inline double oracle_uv_area(const struct oracle *o, size_t triangle)
{
    vec2s a = o->mesh->uvs[o->mesh->indices[3 * triangle]];
    vec2s b = o->mesh->uvs[o->mesh->indices[3 * triangle + 1]];
    vec2s c = o->mesh->uvs[o->mesh->indices[3 * triangle + 2]];
    return ((double)b.x - (double)a.x) * ((double)c.y - (double)a.y) -
           ((double)b.y - (double)a.y) * ((double)c.x - (double)a.x);
}

static inline bool oracle_collapsed(const struct oracle *o, size_t triangle)
{
    uint32_t a = o->weld[o->mesh->indices[3 * triangle]], b = o->weld[o->mesh->indices[3 * triangle + 1]];
    uint32_t c = o->weld[o->mesh->indices[3 * triangle + 2]];
    return a == b || b == c || c == a;
}

static inline bool oracle_same_normal(const struct oracle *o, size_t a, size_t b)
{
    uint32_t va = oracle_vertex(o, a), vb = oracle_vertex(o, b);
    vec3s na = o->normals[va], nb = o->normals[vb];
    return o->weld[va] == o->weld[vb] && na.x == nb.x && na.y == nb.y && na.z == nb.z;
}

static inline bool oracle_same_vertex(const struct oracle *o, size_t a, size_t b)
{
    vec2s ua = o->mesh->uvs[oracle_vertex(o, a)], ub = o->mesh->uvs[oracle_vertex(o, b)];
    return oracle_same_normal(o, a, b) && ua.x == ub.x && ua.y == ub.y;
}

static inline void oracle_list_corners(struct oracle *o)
{
    for (size_t i = 0; i < o->mesh->vertex_count; i++)
        o->first_at[i] = ORACLE_NONE;
    for (size_t c = o->mesh->index_count; c-- > 0;) {
        if (oracle_collapsed(o, c / 3))
            continue;
        o->next_at[c] = o->first_at[o->weld[oracle_vertex(o, c)]];
        o->first_at[o->weld[oracle_vertex(o, c)]] = c;
    }
}

static inline void oracle_pair_edges(struct oracle *o)
{
    for (size_t c = 0; c < o->mesh->index_count; c++)
        o->partner[c] = ORACLE_NONE;
    for (size_t c = 0; c < o->mesh->index_count; c++) {
        size_t end = oracle_turn(c, 1);
        if (oracle_collapsed(o, c / 3) || o->partner[c] != ORACLE_NONE)
            continue;
        for (size_t d = o->first_at[o->weld[oracle_vertex(o, end)]]; d != ORACLE_NONE; d = o->next_at[d]) {
            if (d < c || o->partner[d] != ORACLE_NONE || !oracle_same_vertex(o, d, end) ||
                !oracle_same_vertex(o, oracle_turn(d, 1), c))
                continue;
            o->partner[c] = d;
            o->partner[d] = c;
            break;
        }
    }
}

static inline bool oracle_grouped(const struct oracle *o, size_t corner)
{
    return o->group[corner] != ORACLE_NONE;
}

/* Adds a corner to a group, then the adjacent corners at the same vertex. */
static inline void oracle_spread(struct oracle *o, size_t corner, size_t group, int hand)
{
    size_t t = 3 * (corner / 3);
    if (oracle_grouped(o, corner))
        return;
    bool flat = !(fabs(oracle_uv_area(o, corner / 3)) > (double)FLT_MIN);
    if (flat && !oracle_grouped(o, t) && !oracle_grouped(o, t + 1) && !oracle_grouped(o, t + 2))
        o->hand[corner / 3] = hand;
    if (o->hand[corner / 3] != hand)
        return;
    o->group[corner] = group;
    size_t ahead = o->partner[corner], behind = o->partner[oracle_turn(corner, 2)];
    if (ahead != ORACLE_NONE)
        oracle_spread(o, oracle_turn(ahead, 1), group, hand);
    if (behind != ORACLE_NONE)
        oracle_spread(o, behind, group, hand);
}

/* Keeps pointers to its arguments; oracle_release frees only its own lists. */
static inline struct oracle oracle_make(const tl_mesh *mesh, const vec3s *positions, const vec3s *normals,
                                        const uint32_t *weld)
{
    struct oracle o = {.mesh = mesh, .positions = positions, .normals = normals, .weld = weld};
    o.first_at = TL_NEW_ARRAY(size_t, mesh->vertex_count);
    o.next_at = TL_NEW_ARRAY(size_t, mesh->index_count);
    o.partner = TL_NEW_ARRAY(size_t, mesh->index_count);
    o.group = TL_NEW_ARRAY(size_t, mesh->index_count);
    o.hand = TL_NEW_ARRAY(int, mesh->index_count / 3);
    oracle_list_corners(&o);
    oracle_pair_edges(&o);
    for (size_t c = 0; c < mesh->index_count; c++)
        o.group[c] = ORACLE_NONE;
    for (size_t t = 0; t < mesh->index_count / 3; t++)
        if (fabs(oracle_uv_area(&o, t)) > (double)FLT_MIN)
            o.hand[t] = oracle_uv_area(&o, t) > 0 ? 1 : -1;
    for (size_t c = 0; c < mesh->index_count; c++)
        if (!oracle_collapsed(&o, c / 3) && fabs(oracle_uv_area(&o, c / 3)) > (double)FLT_MIN)
            oracle_spread(&o, c, c, o.hand[c / 3]);
    return o;
}

static inline void oracle_release(struct oracle *o)
{
    free(o->first_at);
    free(o->next_at);
    free(o->partner);
    free(o->group);
    free(o->hand);
}

/* Angle-weighted normal over all corners with the same position and given normal. Not unit: its length
 * measures how well the triangles agree. */
static inline vec3d oracle_normal_sum(const struct oracle *o, size_t corner)
{
    vec3d sum = {0};
    for (size_t c = o->first_at[o->weld[oracle_vertex(o, corner)]]; c != ORACLE_NONE; c = o->next_at[c]) {
        if (!oracle_same_normal(o, c, corner))
            continue;
        vec3d next = vec3d_sub(oracle_place(o, oracle_turn(c, 1)), oracle_place(o, c));
        vec3d last = vec3d_sub(oracle_place(o, oracle_turn(c, 2)), oracle_place(o, c));
        vec3d face = vec3d_unit_or(vec3d_cross(next, last), (vec3d){0});
        sum = vec3d_muladd(sum, face, oracle_angle(next, last));
    }
    return sum;
}

static inline vec3d oracle_across(vec3d a, vec3d normal)
{
    return vec3d_muladd(a, normal, -vec3d_dot(a, normal));
}

/* dP/du of the linear map from UV to space. */
static inline vec3d oracle_face_tangent(const struct oracle *o, size_t triangle)
{
    const uint32_t *v = &o->mesh->indices[3 * triangle];
    vec3d d1 = vec3d_sub(vec3d_from(o->positions[v[1]]), vec3d_from(o->positions[v[0]]));
    vec3d d2 = vec3d_sub(vec3d_from(o->positions[v[2]]), vec3d_from(o->positions[v[0]]));
    double t21 = (double)o->mesh->uvs[v[1]].y - (double)o->mesh->uvs[v[0]].y;
    double t31 = (double)o->mesh->uvs[v[2]].y - (double)o->mesh->uvs[v[0]].y;
    return vec3d_scale(vec3d_sub(vec3d_scale(d1, t31), vec3d_scale(d2, t21)),
                       1 / oracle_uv_area(o, triangle));
}

/* The tangent of the corner's group, with the normal of oracle_normal_sum; not unit, as above. */
static inline vec3d oracle_tangent_sum(const struct oracle *o, size_t corner)
{
    vec3d normal = vec3d_unit_or(oracle_normal_sum(o, corner), (vec3d){0}), sum = {0};
    for (size_t c = o->first_at[o->weld[oracle_vertex(o, corner)]]; c != ORACLE_NONE; c = o->next_at[c]) {
        if (o->group[c] != o->group[corner] || !(fabs(oracle_uv_area(o, c / 3)) > (double)FLT_MIN))
            continue;
        vec3d next = vec3d_sub(oracle_place(o, oracle_turn(c, 1)), oracle_place(o, c));
        vec3d last = vec3d_sub(oracle_place(o, oracle_turn(c, 2)), oracle_place(o, c));
        vec3d t = vec3d_unit_or(oracle_across(oracle_face_tangent(o, c / 3), normal), (vec3d){0});
        sum = vec3d_muladd(sum, t, oracle_angle(oracle_across(next, normal), oracle_across(last, normal)));
    }
    return sum;
}

#endif
