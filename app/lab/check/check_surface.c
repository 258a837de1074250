/* Compares geometry with its definitions. Vertices with equal position, normal and UV are merged, as in
 * MikkTSpace. */
#include "app/lab/check/check_measures.h"
#include "config/base/hash.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t count_not_finite(const float *values, size_t count)
{
    size_t bad = 0;
    for (size_t i = 0; i < count; i++)
        bad += isfinite(values[i]) ? 0 : 1;
    return bad;
}

struct array {
    const char *name;
    const float *values;
    size_t width; /* floats a vertex */
};

static void add_not_finite(const struct tl_checked *checked, size_t index, const struct array *array,
                           struct tl_finding *finding)
{
    const tl_surface *surface = &checked->frame->surfaces[index];
    size_t bad = count_not_finite(array->values, surface->vertex_count * array->width);
    if (!tl_finding_add(finding, (double)bad) || bad == 0)
        return;
    size_t vertex = 0;
    while (count_not_finite(array->values + vertex * array->width, array->width) == 0)
        vertex++;
    tl_finding_vertex(finding, checked->frame, index, vertex);
    tl_finding_place(finding, "%s: %s of vertex %zu", surface->name, array->name, vertex);
}

void tl_measure_finite(const struct tl_checked *checked, struct tl_finding *finding)
{
    for (size_t s = 0; s < checked->frame->surface_count; s++) {
        const tl_surface *surface = &checked->frame->surfaces[s];
        const struct array arrays[] = {{"position", surface->positions->raw, 3},
                                       {"normal", surface->normals->raw, 3},
                                       {"tangent", surface->tangents->raw, 4},
                                       {"UV", surface->uvs->raw, 2}};
        for (size_t i = 0; i < TL_COUNT(arrays); i++)
            add_not_finite(checked, s, &arrays[i], finding);
    }
}

/* Adds the largest `deviation` of all vertices. */
static void add_vertices(const struct tl_checked *checked, struct tl_finding *finding,
                         double (*deviation)(const tl_surface *surface, size_t vertex))
{
    for (size_t s = 0; s < checked->frame->surface_count; s++) {
        const tl_surface *surface = &checked->frame->surfaces[s];
        for (size_t v = 0; v < surface->vertex_count; v++)
            if (tl_finding_add(finding, deviation(surface, v)))
                tl_finding_vertex(finding, checked->frame, s, v);
    }
}

struct vector {
    double x, y, z;
};

static struct vector vector_of(vec3s v)
{
    return (struct vector){(double)v.x, (double)v.y, (double)v.z};
}

static double dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct vector add_scaled(struct vector a, double scale, struct vector b)
{
    return (struct vector){a.x + scale * b.x, a.y + scale * b.y, a.z + scale * b.z};
}

static struct vector cross(struct vector a, struct vector b)
{
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double length(struct vector a)
{
    return sqrt(dot(a, a));
}

static struct vector tangent_of(const tl_surface *surface, size_t vertex)
{
    const vec4s *tangent = &surface->tangents[vertex];
    return (struct vector){(double)tangent->x, (double)tangent->y, (double)tangent->z};
}

static double normal_deviation(const tl_surface *surface, size_t vertex)
{
    return fabs(length(vector_of(surface->normals[vertex])) - 1);
}

void tl_measure_normals(const struct tl_checked *checked, struct tl_finding *finding)
{
    add_vertices(checked, finding, normal_deviation);
}

static double tangent_deviation(const tl_surface *surface, size_t vertex)
{
    struct vector tangent = tangent_of(surface, vertex);
    double skew = fabs(dot(tangent, vector_of(surface->normals[vertex])));
    double handed = fabs(fabs((double)surface->tangents[vertex].w) - 1);
    double worst = fabs(length(tangent) - 1) + skew + handed; /* a NaN in any of them shows */
    return worst;
}

void tl_measure_tangents(const struct tl_checked *checked, struct tl_finding *finding)
{
    add_vertices(checked, finding, tangent_deviation);
}

/* Vertices are merged if these are equal: position, normal and UV, as bits. */
struct key {
    uint32_t bits[8];
};

static struct key key_of(const tl_surface *surface, size_t vertex, bool with_uv)
{
    const vec3s place = surface->positions[vertex], normal = surface->normals[vertex];
    const vec2s uv = with_uv ? surface->uvs[vertex] : (vec2s){{0, 0}};
    float values[8] = {place.x, place.y, place.z, normal.x, normal.y, normal.z, uv.x, uv.y};
    struct key key;
    for (size_t i = 0; i < TL_COUNT(values); i++)
        values[i] += 0.0f; /* -0 becomes 0 */
    memcpy(key.bits, values, sizeof key.bits);
    return key;
}

/* group[v]: the first vertex with the same key as v. New array. */
static uint32_t *join_vertices(const tl_surface *surface, bool with_uv)
{
    size_t slots = 16;
    while (slots < 2 * surface->vertex_count)
        slots *= 2;
    uint32_t *table = TL_NEW_ARRAY(uint32_t, slots); /* 1 + vertex */
    uint32_t *group = TL_NEW_ARRAY(uint32_t, surface->vertex_count);
    for (size_t v = 0; v < surface->vertex_count; v++) {
        struct key key = key_of(surface, v, with_uv);
        size_t slot = tl_hash(TL_HASH_START, key.bits, sizeof key.bits) & (slots - 1);
        for (; table[slot]; slot = (slot + 1) & (slots - 1)) {
            struct key other = key_of(surface, table[slot] - 1, with_uv);
            if (memcmp(&other, &key, sizeof key) == 0)
                break;
        }
        if (!table[slot])
            table[slot] = (uint32_t)v + 1;
        group[v] = table[slot] - 1;
    }
    free(table);
    return group;
}

/* Edges of a triangle from its corner `from`, to the two that follow. */
struct face_corner {
    uint32_t vertex;
    struct vector first, second;
    double area;                /* twice */
    struct vector face;         /* unit, where there is an area */
    double u[2], v[2], uv_area; /* along the edges; twice, signed */
};

static struct face_corner corner_of(const tl_surface *surface, size_t triangle, int from)
{
    const uint32_t *indices = &surface->indices[3 * triangle];
    const uint32_t at[3] = {indices[from], indices[(from + 1) % 3], indices[(from + 2) % 3]};
    struct vector origin = vector_of(surface->positions[at[0]]);
    struct face_corner corner = {.vertex = at[0],
                                 .first = add_scaled(vector_of(surface->positions[at[1]]), -1, origin),
                                 .second = add_scaled(vector_of(surface->positions[at[2]]), -1, origin)};
    struct vector normal = cross(corner.first, corner.second);
    corner.area = length(normal);
    if (corner.area > 0)
        corner.face = add_scaled((struct vector){0, 0, 0}, 1 / corner.area, normal);
    for (int i = 0; i < 2; i++) {
        corner.u[i] = (double)surface->uvs[at[i + 1]].x - (double)surface->uvs[at[0]].x;
        corner.v[i] = (double)surface->uvs[at[i + 1]].y - (double)surface->uvs[at[0]].y;
    }
    corner.uv_area = corner.u[0] * corner.v[1] - corner.u[1] * corner.v[0];
    return corner;
}

/* Square metres: the rounding of a garment's coordinates makes smaller areas meaningless, and the side of
 * such a triangle unknown. */
#define NO_AREA 1e-12

/* If the faces about a vertex cancel to less than this fraction of their angles, the side of their mean is
 * unknown, too, and so is the mean of directions in them. */
#define NO_MEAN 1e-2

struct fan {
    struct vector sum;
    double angle; /* of all corners together */
};

static struct fan *gather_fans(const tl_surface *surface, const uint32_t *group)
{
    struct fan *fans = TL_NEW_ARRAY(struct fan, surface->vertex_count);
    for (size_t i = 0; i < surface->index_count; i++) {
        struct face_corner corner = corner_of(surface, i / 3, (int)(i % 3));
        if (!(corner.area > NO_AREA))
            continue;
        double angle = atan2(corner.area, dot(corner.first, corner.second));
        struct fan *fan = &fans[group[corner.vertex]];
        fan->sum = add_scaled(fan->sum, angle, corner.face);
        fan->angle += angle;
    }
    return fans;
}

void tl_measure_sides(const struct tl_checked *checked, struct tl_finding *finding)
{
    for (size_t s = 0; s < checked->frame->surface_count; s++) {
        const tl_surface *surface = &checked->frame->surfaces[s];
        if (surface->has_own_normals)
            continue;
        uint32_t *group = join_vertices(surface, false);
        struct fan *fans = gather_fans(surface, group);
        for (size_t v = 0; v < surface->vertex_count; v++) {
            const struct fan *fan = &fans[group[v]];
            double mean = length(fan->sum);
            if (mean <= NO_MEAN * fan->angle)
                continue;
            double cosine = dot(vector_of(surface->normals[v]), fan->sum) / mean;
            double off = cosine > 1 ? 0 : 1 - cosine; /* a NaN stays one */
            if (tl_finding_add(finding, off))
                tl_finding_vertex(finding, checked->frame, s, v);
        }
        free(fans);
        free(group);
    }
}

/* Result of comparing a vertex's tangent with the faces about it. */
enum { UNDEFINED, DISAGREES, AGREES };

/* MikkTSpace's direction of u in the face, sign(A) (t31 d1 - t21 d2), against the tangent: it is the mean of
 * such directions in the normal's plane, all of one handedness. v runs down, so that w is the opposite of the
 * UVs' own sign. */
static int compare_face(const tl_surface *surface, const struct face_corner *corner, size_t vertex)
{
    const double flat = 1e-37, seen_edge_on = 1e-3;
    if (!(fabs(corner->uv_area) > flat) || !(corner->area > NO_AREA))
        return UNDEFINED;
    struct vector normal = vector_of(surface->normals[vertex]), zero = {0, 0, 0};
    struct vector along =
        add_scaled(add_scaled(zero, corner->v[1], corner->first), -corner->v[0], corner->second);
    double size = length(along), rise = dot(along, normal);
    struct vector level = add_scaled(along, -rise, normal);
    if (!(length(level) > seen_edge_on * size))
        return UNDEFINED;
    double cosine = dot(level, tangent_of(surface, vertex)) * (corner->uv_area > 0 ? 1 : -1);
    bool handed = (surface->tangents[vertex].w > 0) == (corner->uv_area < 0);
    return cosine > -NO_MEAN * length(level) && handed ? AGREES : DISAGREES;
}

/* Corners by the vertex group that they belong to: those of group g are items[first[g]] to items[first[g +
 * 1]]. */
struct corner_lists {
    uint32_t *first, *items;
};

static struct corner_lists list_corners(const tl_surface *surface, const uint32_t *group)
{
    struct corner_lists lists = {TL_NEW_ARRAY(uint32_t, surface->vertex_count + 2),
                                 TL_NEW_ARRAY(uint32_t, surface->index_count)};
    for (size_t i = 0; i < surface->index_count; i++)
        lists.first[group[surface->indices[i]] + 2]++;
    for (size_t v = 0; v < surface->vertex_count; v++)
        lists.first[v + 2] += lists.first[v + 1];
    for (size_t i = 0; i < surface->index_count; i++)
        lists.items[lists.first[group[surface->indices[i]] + 1]++] = (uint32_t)i;
    return lists;
}

static int compare_faces(const tl_surface *surface, const struct corner_lists *lists, uint32_t group,
                         size_t vertex)
{
    int result = UNDEFINED;
    for (uint32_t i = lists->first[group]; i < lists->first[group + 1] && result != AGREES; i++) {
        struct face_corner corner = corner_of(surface, lists->items[i] / 3, (int)(lists->items[i] % 3));
        int one = compare_face(surface, &corner, vertex);
        result = one > result ? one : result;
    }
    return result;
}

void tl_measure_handed(const struct tl_checked *checked, struct tl_finding *finding)
{
    size_t wrong = 0, first_vertex = 0, first_surface = 0;
    for (size_t s = 0; s < checked->frame->surface_count; s++) {
        const tl_surface *surface = &checked->frame->surfaces[s];
        uint32_t *group = join_vertices(surface, true);
        struct corner_lists lists = list_corners(surface, group);
        for (size_t v = 0; v < surface->vertex_count; v++) {
            if (compare_faces(surface, &lists, group[v], v) != DISAGREES)
                continue;
            if (wrong++ > 0)
                continue;
            first_surface = s;
            first_vertex = v;
        }
        free(lists.first);
        free(lists.items);
        free(group);
    }
    tl_finding_add(finding, (double)wrong);
    if (wrong > 0)
        tl_finding_vertex(finding, checked->frame, first_surface, first_vertex);
}
