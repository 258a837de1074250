#include "cloth/frames.h"

#include "cloth/topology.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Squared lengths below this have no direction: rounding of float coordinates. */
#define NO_LENGTH_SQUARED 1e-30f

struct tl_frames {
    size_t render_count, normal_count, triangle_count, group_count;
    /* Fixed. A vertex whose two sides are both drawn has two normals; a normal's vertex is `weld`. */
    uint32_t (*render_corners)[3]; /* [triangle_count] render vertices */
    uint32_t (*normal_corners)[3]; /* their normals */
    struct tl_fans normal_fans;    /* triangle corners around each normal */
    struct tl_fans group_fans;     /* triangle corners in each tangent group */
    float (*gradients)[2];         /* tangent direction of a triangle = edge01 * [0] + edge02 * [1] */
    uint32_t *normal_of;           /* [render_count] */
    uint32_t *group_of;            /* [render_count] */
    uint32_t *group_normals;       /* [group_count] */
    float *group_signs;            /* handedness */
    /* Streamed. */
    vec3s *face_normals; /* unit, or zero */
    float (*angles)[3];
    vec3s (*directions)[3]; /* projected tangent of each corner, times its angle */
    vec3s *normals;         /* [normal_count], kept between frames */
    vec3s *group_tangents;  /* [group_count], kept between frames */
};

/* ---- Groups, once ---- */

/* What MikkTSpace welds: one normal, one UV. */
struct mikk_key {
    uint32_t normal, u, v;
    uint32_t render; /* last, so that equal keys are told apart in a fixed order */
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

static uint32_t float_bits(float value)
{
    uint32_t bits;
    value = value == 0 ? 0 : value;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Number of the MikkTSpace vertex of every render vertex. */
static size_t weld_mikk_vertices(const tl_frames *frames, const vec2s *uvs, uint32_t *mikk)
{
    struct mikk_key *keys = TL_NEW_ARRAY(struct mikk_key, frames->render_count);
    for (size_t i = 0; i < frames->render_count; i++)
        keys[i] =
            (struct mikk_key){frames->normal_of[i], float_bits(uvs[i].x), float_bits(uvs[i].y), (uint32_t)i};
    qsort(keys, frames->render_count, sizeof *keys, compare_mikk_keys);
    size_t count = 0;
    for (size_t i = 0; i < frames->render_count; i++) {
        bool same = i > 0 && keys[i].normal == keys[i - 1].normal && keys[i].u == keys[i - 1].u &&
                    keys[i].v == keys[i - 1].v;
        count += !same;
        mikk[keys[i].render] = (uint32_t)count - 1;
    }
    free(keys);
    return count;
}

/* Twice the signed area in UV; 0 for triangles that have no tangent. */
static double uv_area(const tl_mesh *mesh, const uint32_t *corners)
{
    vec2s side = glms_vec2_sub(mesh->uvs[corners[1]], mesh->uvs[corners[0]]);
    vec2s other = glms_vec2_sub(mesh->uvs[corners[2]], mesh->uvs[corners[0]]);
    double area = (double)side.x * (double)other.y - (double)side.y * (double)other.x;
    return isfinite(area) && fabs(area) > 1e-37 ? area : 0;
}

/* Mikkelsen's vOs: sign(area) (t31.v d1 - t21.v d2), here without its length, which projection discards. */
static void find_gradients(tl_frames *frames, const tl_mesh *mesh)
{
    for (size_t t = 0; t < frames->triangle_count; t++) {
        const uint32_t *c = frames->render_corners[t];
        double area = uv_area(mesh, c);
        double side = (double)mesh->uvs[c[1]].y - (double)mesh->uvs[c[0]].y;
        double other = (double)mesh->uvs[c[2]].y - (double)mesh->uvs[c[0]].y;
        double scale = fmax(fabs(side), fabs(other));
        if (area == 0 || !(scale > 0))
            continue;
        frames->gradients[t][0] = (float)(copysign(other, other * area) / scale);
        frames->gradients[t][1] = (float)(copysign(side, -side * area) / scale);
    }
}

struct mikk_edge {
    uint32_t low, high; /* MikkTSpace vertices */
    uint32_t corner;    /* 3 * triangle + corner at which the edge begins */
};

static int compare_mikk_edges(const void *a, const void *b)
{
    const struct mikk_edge *left = a, *right = b;
    if (left->low != right->low)
        return left->low < right->low ? -1 : 1;
    if (left->high != right->high)
        return left->high < right->high ? -1 : 1;
    return (left->corner > right->corner) - (left->corner < right->corner);
}

static bool has_tangent(const tl_frames *frames, size_t triangle)
{
    return frames->gradients[triangle][0] != 0 || frames->gradients[triangle][1] != 0;
}

/* Joins the corners of two triangles at both ends of an edge when it runs opposite ways in them and their UVs
 * have the same handedness. */
static void join_across(const tl_frames *frames, const float *signs, const uint32_t *mikk, uint32_t a,
                        uint32_t b, uint32_t *parents)
{
    uint32_t a_next = a - a % 3 + (a % 3 + 1) % 3, b_next = b - b % 3 + (b % 3 + 1) % 3;
    const uint32_t *vertices = &frames->render_corners[0][0];
    if (mikk[vertices[a]] != mikk[vertices[b_next]] || mikk[vertices[a_next]] != mikk[vertices[b]])
        return;
    if (signs[a / 3] != signs[b / 3])
        return;
    tl_sets_join(parents, a, b_next);
    tl_sets_join(parents, a_next, b);
}

/* Corners of one group share a representative: connected around a MikkTSpace vertex over edges with two
 * triangles of the same UV handedness. Each edge joins the first two triangles that traverse it in opposite
 * ways; others stay apart. */
static void group_corners(const tl_frames *frames, const float *signs, const uint32_t *mikk,
                          uint32_t *parents)
{
    size_t count = 0;
    struct mikk_edge *edges = TL_NEW_ARRAY(struct mikk_edge, 3 * frames->triangle_count);
    for (size_t i = 0; i < 3 * frames->triangle_count; i++) {
        parents[i] = (uint32_t)i;
        if (!has_tangent(frames, i / 3))
            continue;
        uint32_t a = mikk[frames->render_corners[i / 3][i % 3]];
        uint32_t b = mikk[frames->render_corners[i / 3][(i + 1) % 3]];
        edges[count++] = (struct mikk_edge){a < b ? a : b, a < b ? b : a, (uint32_t)i};
    }
    qsort(edges, count, sizeof *edges, compare_mikk_edges);
    bool *taken = TL_NEW_ARRAY(bool, count);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1;
             j < count && edges[j].low == edges[i].low && edges[j].high == edges[i].high && !taken[i]; j++) {
            uint32_t a = edges[i].corner, b = edges[j].corner;
            bool opposite =
                mikk[frames->render_corners[a / 3][a % 3]] != mikk[frames->render_corners[b / 3][b % 3]];
            if (taken[j] || !opposite)
                continue;
            taken[i] = taken[j] = true;
            join_across(frames, signs, mikk, a, b, parents);
        }
    }
    free(taken);
    free(edges);
}

/* A render vertex may be a corner of several groups, as MikkTSpace would split it: it takes the one that most
 * of its own corners are in, the first of equals. */
static void choose_groups(tl_frames *frames, uint32_t *parents)
{
    size_t corner_count = 3 * frames->triangle_count;
    uint32_t *votes = TL_NEW_ARRAY(uint32_t, corner_count); /* of one render vertex at a time, by group */
    const uint32_t *corners = &frames->render_corners[0][0];
    struct tl_fans fans = tl_fans_build(corners, corner_count, frames->render_count);
    memset(frames->group_of, 0xff, frames->render_count * sizeof(uint32_t));
    for (size_t r = 0; r < frames->render_count; r++) {
        uint32_t best = TL_NONE;
        for (uint32_t i = fans.first[r]; i < fans.first[r + 1]; i++) {
            uint32_t group = tl_sets_find(parents, fans.items[i]);
            if (has_tangent(frames, fans.items[i] / 3))
                votes[group]++;
        }
        for (uint32_t i = fans.first[r]; i < fans.first[r + 1]; i++) {
            uint32_t group = tl_sets_find(parents, fans.items[i]);
            if (votes[group] > 0 && (best == TL_NONE || votes[group] > votes[best]))
                best = group;
        }
        for (uint32_t i = fans.first[r]; i < fans.first[r + 1]; i++)
            votes[tl_sets_find(parents, fans.items[i])] = 0;
        frames->group_of[r] = best;
    }
    tl_fans_release(&fans);
    free(votes);
}

/* Numbers the groups, lists their corners, and gives a group of its own to every vertex that is in none. */
static void number_groups(tl_frames *frames, uint32_t *parents, const float *signs)
{
    size_t corner_count = 3 * frames->triangle_count, listed = 0;
    uint32_t *numbers = TL_NEW_ARRAY(uint32_t, corner_count);
    frames->group_normals = TL_NEW_ARRAY(uint32_t, corner_count + frames->render_count);
    frames->group_signs = TL_NEW_ARRAY(float, corner_count + frames->render_count);
    uint32_t *groups = TL_NEW_ARRAY(uint32_t, corner_count);
    for (size_t i = 0; i < corner_count; i++) {
        uint32_t root = tl_sets_find(parents, (uint32_t)i);
        if (root == i) { /* the lowest member comes first */
            numbers[i] = (uint32_t)frames->group_count;
            frames->group_normals[frames->group_count] = frames->normal_corners[i / 3][i % 3];
            frames->group_signs[frames->group_count++] = signs[i / 3];
        }
        groups[listed++] = numbers[root];
    }
    for (size_t r = 0; r < frames->render_count; r++) {
        if (frames->group_of[r] != TL_NONE) {
            frames->group_of[r] = numbers[frames->group_of[r]];
            continue;
        }
        frames->group_of[r] = (uint32_t)frames->group_count;
        frames->group_normals[frames->group_count] = frames->normal_of[r];
        frames->group_signs[frames->group_count++] = 1;
    }
    frames->group_fans = tl_fans_build(groups, listed, frames->group_count);
    frames->group_tangents = TL_NEW_ARRAY(vec3s, frames->group_count);
    free(groups);
    free(numbers);
}

static void build_groups(tl_frames *frames, const tl_mesh *mesh)
{
    uint32_t *mikk = TL_NEW_ARRAY(uint32_t, frames->render_count);
    uint32_t *parents = TL_NEW_ARRAY(uint32_t, 3 * frames->triangle_count);
    float *signs = TL_NEW_ARRAY(float, frames->triangle_count);
    if (mesh->uvs) {
        weld_mikk_vertices(frames, mesh->uvs, mikk);
        find_gradients(frames, mesh);
        /* v runs down in glTF and up in a normal map: the bitangent points to smaller v. */
        for (size_t t = 0; t < frames->triangle_count; t++)
            signs[t] = uv_area(mesh, frames->render_corners[t]) > 0 ? -1 : 1;
    }
    group_corners(frames, signs, mikk, parents);
    choose_groups(frames, parents);
    number_groups(frames, parents, signs);
    free(mikk);
    free(parents);
    free(signs);
}

/* ---- Normals, once ---- */

static vec3s corner_area(const vec3s *positions, const uint32_t *c)
{
    return glms_vec3_cross(glms_vec3_sub(positions[c[1]], positions[c[0]]),
                           glms_vec3_sub(positions[c[2]], positions[c[0]]));
}

/* Vertices drawn only by triangles that turn their back to the first triangle on the same three places (a
 * sheet drawn from both sides) have the opposite normal, numbered from physics_count on. */
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

static void number_normals(tl_frames *frames, const tl_mesh *mesh, const uint32_t *weld)
{
    size_t physics_count = 0;
    for (size_t i = 0; i < frames->render_count; i++)
        physics_count = weld[i] >= physics_count ? weld[i] + (size_t)1 : physics_count;
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, frames->render_count, physics_count);
    bool *back = TL_NEW_ARRAY(bool, frames->render_count);
    find_backs(mesh, &topology, back);
    bool any = false;
    for (size_t i = 0; i < frames->render_count; i++) {
        frames->normal_of[i] = weld[i] + (back[i] ? (uint32_t)physics_count : 0);
        any = any || back[i];
    }
    frames->normal_count = physics_count * (any ? 2 : 1);
    frames->normals = TL_NEW_ARRAY(vec3s, frames->normal_count);
    for (size_t i = 0; i < frames->normal_count; i++)
        frames->normals[i] = (vec3s){{0, 1, 0}};
    free(back);
    tl_topology_release(&topology);
}

/* Triangles whose corners are three different places. */
static void list_triangles(tl_frames *frames, const tl_mesh *mesh)
{
    size_t count = mesh->index_count / 3;
    frames->render_corners = tl_alloc(count, sizeof *frames->render_corners);
    frames->normal_corners = tl_alloc(count, sizeof *frames->normal_corners);
    for (size_t t = 0; t < count; t++) {
        const uint32_t *c = &mesh->indices[3 * t];
        const uint32_t n[3] = {frames->normal_of[c[0]], frames->normal_of[c[1]], frames->normal_of[c[2]]};
        if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0])
            continue;
        memcpy(frames->render_corners[frames->triangle_count], c, sizeof *frames->render_corners);
        memcpy(frames->normal_corners[frames->triangle_count++], n, sizeof n);
    }
}

tl_frames *tl_frames_create(const tl_mesh *mesh, const uint32_t *weld)
{
    tl_frames *frames = TL_NEW(tl_frames);
    frames->render_count = mesh->vertex_count;
    frames->normal_of = TL_NEW_ARRAY(uint32_t, frames->render_count);
    frames->group_of = TL_NEW_ARRAY(uint32_t, frames->render_count);
    number_normals(frames, mesh, weld);
    list_triangles(frames, mesh);
    size_t count = frames->triangle_count;
    frames->normal_fans = tl_fans_build(&frames->normal_corners[0][0], 3 * count, frames->normal_count);
    frames->gradients = tl_alloc(count, sizeof *frames->gradients);
    frames->face_normals = TL_NEW_ARRAY(vec3s, count);
    frames->angles = tl_alloc(count, sizeof *frames->angles);
    frames->directions = tl_alloc(count, sizeof *frames->directions);
    build_groups(frames, mesh);
    return frames;
}

void tl_frames_destroy(tl_frames **frames)
{
    tl_frames *f = *frames;
    if (!f)
        return;
    free(f->render_corners);
    free(f->normal_corners);
    tl_fans_release(&f->normal_fans);
    tl_fans_release(&f->group_fans);
    free(f->gradients);
    free(f->normal_of);
    free(f->group_of);
    free(f->group_normals);
    free(f->group_signs);
    free(f->face_normals);
    free(f->angles);
    free(f->directions);
    free(f->normals);
    free(f->group_tangents);
    free(f);
    *frames = NULL;
}

/* ---- Every frame ---- */

static inline vec3s sub(vec3s a, vec3s b)
{
    return (vec3s){{a.x - b.x, a.y - b.y, a.z - b.z}};
}
static inline float dot(vec3s a, vec3s b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline vec3s muladd(vec3s a, vec3s b, float s)
{
    return (vec3s){{a.x + b.x * s, a.y + b.y * s, a.z + b.z * s}};
}
static inline float inverse_length(float squared)
{
    return squared > NO_LENGTH_SQUARED ? 1 / sqrtf(squared) : 0;
}

/* acos to 7e-5 rad (Abramowitz & Stegun 4.4.45): a weight needs no more. */
static inline float angle_of(float cosine)
{
    float x = fminf(fabsf(cosine), 1);
    float angle = sqrtf(1 - x) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f - 0.0187293f * x)));
    return cosine < 0 ? (float)M_PI - angle : angle;
}

static void stream_faces(tl_frames *frames, const vec3s *positions)
{
    for (size_t t = 0; t < frames->triangle_count; t++) {
        const uint32_t *c = frames->render_corners[t];
        vec3s a = sub(positions[c[1]], positions[c[0]]), b = sub(positions[c[2]], positions[c[1]]);
        vec3s d = sub(positions[c[0]], positions[c[2]]);
        float la = inverse_length(dot(a, a)), lb = inverse_length(dot(b, b)), ld = inverse_length(dot(d, d));
        vec3s area = glms_vec3_cross(a, b);
        float inverse = inverse_length(dot(area, area));
        frames->face_normals[t] = (vec3s){{area.x * inverse, area.y * inverse, area.z * inverse}};
        frames->angles[t][0] = angle_of(-dot(d, a) * (ld * la));
        frames->angles[t][1] = angle_of(-dot(a, b) * (la * lb));
        frames->angles[t][2] = angle_of(-dot(b, d) * (lb * ld));
    }
}

static void gather_normals(tl_frames *frames)
{
    for (size_t v = 0; v < frames->normal_count; v++) {
        vec3s sum = {{0, 0, 0}};
        for (uint32_t i = frames->normal_fans.first[v]; i < frames->normal_fans.first[v + 1]; i++) {
            uint32_t corner = frames->normal_fans.items[i];
            sum = muladd(sum, frames->face_normals[corner / 3], frames->angles[corner / 3][corner % 3]);
        }
        float squared = dot(sum, sum);
        const float opposing = 1e-8f; /* unit normals that cancel to their rounding */
        if (squared > opposing)
            frames->normals[v] = glms_vec3_scale(sum, inverse_length(squared));
    }
}

static inline vec3s project(vec3s v, vec3s normal)
{
    return muladd(v, normal, -dot(v, normal));
}

/* One corner's share: the triangle's tangent in the vertex's plane, weighted by the angle between the two
 * edges in that plane. `next` and `last` lead from the corner to the others. */
static inline vec3s corner_direction(vec3s direction, vec3s next, vec3s last, vec3s normal)
{
    direction = project(direction, normal);
    next = project(next, normal);
    last = project(last, normal);
    float cosine = dot(next, last) * inverse_length(dot(next, next)) * inverse_length(dot(last, last));
    float weight = angle_of(cosine) * inverse_length(dot(direction, direction));
    return (vec3s){{direction.x * weight, direction.y * weight, direction.z * weight}};
}

static void stream_directions(tl_frames *frames, const vec3s *positions)
{
    for (size_t t = 0; t < frames->triangle_count; t++) {
        const uint32_t *c = frames->render_corners[t], *n = frames->normal_corners[t];
        vec3s a = sub(positions[c[1]], positions[c[0]]), b = sub(positions[c[2]], positions[c[1]]);
        vec3s d = sub(positions[c[0]], positions[c[2]]);
        vec3s direction = {{0, 0, 0}};
        direction = muladd(muladd(direction, a, frames->gradients[t][0]), d, -frames->gradients[t][1]);
        vec3s *out = frames->directions[t];
        out[0] = corner_direction(direction, a, glms_vec3_negate(d), frames->normals[n[0]]);
        out[1] = corner_direction(direction, b, glms_vec3_negate(a), frames->normals[n[1]]);
        out[2] = corner_direction(direction, d, glms_vec3_negate(b), frames->normals[n[2]]);
    }
}

/* Any direction orthogonal to a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
 */
static vec3s any_tangent(vec3s n)
{
    float sign = copysignf(1, n.z), a = -1 / (sign + n.z);
    return (vec3s){{1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x}};
}

static void gather_tangents(tl_frames *frames)
{
    for (size_t g = 0; g < frames->group_count; g++) {
        vec3s sum = {{0, 0, 0}}, normal = frames->normals[frames->group_normals[g]];
        for (uint32_t i = frames->group_fans.first[g]; i < frames->group_fans.first[g + 1]; i++) {
            uint32_t corner = frames->group_fans.items[i];
            sum = glms_vec3_add(sum, frames->directions[corner / 3][corner % 3]);
        }
        const float opposing = 1e-8f;
        if (!(dot(sum, sum) > opposing))
            sum = frames->group_tangents[g];
        sum = project(sum, normal);
        float squared = dot(sum, sum);
        frames->group_tangents[g] =
            squared > opposing ? glms_vec3_scale(sum, inverse_length(squared)) : any_tangent(normal);
    }
}

void tl_frames_update(tl_frames *frames, const vec3s *positions, vec3s *normals, vec4s *tangents)
{
    stream_faces(frames, positions);
    gather_normals(frames);
    stream_directions(frames, positions);
    gather_tangents(frames);
    for (size_t r = 0; r < frames->render_count; r++) {
        vec3s tangent = frames->group_tangents[frames->group_of[r]];
        normals[r] = frames->normals[frames->normal_of[r]];
        tangents[r] = (vec4s){{tangent.x, tangent.y, tangent.z, frames->group_signs[frames->group_of[r]]}};
    }
}
