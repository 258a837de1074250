#include "assets/refine.h"

#include "assets/base/rig.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An edge to be halved, a < b. Its index among all such edges is that of its midpoint, after the old
 * vertices.
 */
struct split_edge {
    uint32_t a, b;
};

struct split_edges {
    size_t count;
    struct split_edge *items; /* sorted, each once */
};

/* One triangle with the midpoints of its sides: middles[i] between corners i and i + 1, or NO_MIDDLE. */
#define NO_MIDDLE UINT32_MAX
struct split_face {
    uint32_t corners[3], middles[3];
};

static float length_of(const tl_mesh *mesh, uint32_t a, uint32_t b)
{
    return glms_vec3_distance(mesh->positions[a], mesh->positions[b]);
}

float tl_mesh_longest_edge(const tl_mesh *mesh)
{
    float longest = 0;
    for (size_t i = 0; i < mesh->index_count; i++)
        longest =
            fmaxf(longest, length_of(mesh, mesh->indices[i], mesh->indices[i % 3 == 2 ? i - 2 : i + 1]));
    return longest;
}

static int compare_edges(const void *first, const void *second)
{
    const struct split_edge *p = first, *q = second;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    return p->b < q->b ? -1 : p->b > q->b;
}

static struct split_edge edge_of(uint32_t a, uint32_t b)
{
    return a < b ? (struct split_edge){a, b} : (struct split_edge){b, a};
}

static struct split_edges find_long_edges(const tl_mesh *mesh, float longest_m)
{
    struct split_edges edges = {.items = TL_NEW_ARRAY(struct split_edge, mesh->index_count)};
    size_t found = 0;
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t a = mesh->indices[i], b = mesh->indices[i % 3 == 2 ? i - 2 : i + 1];
        if (length_of(mesh, a, b) > longest_m)
            edges.items[found++] = edge_of(a, b);
    }
    qsort(edges.items, found, sizeof *edges.items, compare_edges);
    for (size_t i = 0; i < found; i++)
        if (i == 0 || compare_edges(&edges.items[i - 1], &edges.items[i]) != 0)
            edges.items[edges.count++] = edges.items[i];
    return edges;
}

static uint32_t middle_of(const struct split_edges *edges, size_t vertex_count, uint32_t a, uint32_t b)
{
    const struct split_edge sought = edge_of(a, b);
    const struct split_edge *found =
        bsearch(&sought, edges->items, edges->count, sizeof *edges->items, compare_edges);
    return found ? (uint32_t)(vertex_count + (size_t)(found - edges->items)) : NO_MIDDLE;
}

static struct split_face face_at(const tl_mesh *mesh, const struct split_edges *edges, size_t index)
{
    struct split_face face;
    for (size_t i = 0; i < 3; i++) {
        face.corners[i] = mesh->indices[index + i];
        face.middles[i] = middle_of(edges, mesh->vertex_count, mesh->indices[index + i],
                                    mesh->indices[index + (i + 1) % 3]);
    }
    return face;
}

static size_t pieces_of(const struct split_face *face)
{
    size_t pieces = 1;
    for (int i = 0; i < 3; i++)
        pieces += face->middles[i] != NO_MIDDLE;
    return pieces;
}

static uint32_t *put_triangle(uint32_t *out, uint32_t a, uint32_t b, uint32_t c)
{
    out[0] = a;
    out[1] = b;
    out[2] = c;
    return out + 3;
}

/* Rotates a triangle so that, of one or two halved sides, the first is side 0, and of two the second is
 * side 1.
 */
static struct split_face turned(const struct split_face *face)
{
    int first = 0;
    while (face->middles[first] == NO_MIDDLE || face->middles[(first + 2) % 3] != NO_MIDDLE)
        first++;
    struct split_face result;
    for (int i = 0; i < 3; i++) {
        result.corners[i] = face->corners[(first + i) % 3];
        result.middles[i] = face->middles[(first + i) % 3];
    }
    return result;
}

/* `mesh` has the middles' positions. */
static uint32_t *split_face(const tl_mesh *mesh, const struct split_face *face, uint32_t *out)
{
    size_t pieces = pieces_of(face);
    if (pieces == 1)
        return put_triangle(out, face->corners[0], face->corners[1], face->corners[2]);
    if (pieces == 4) {
        for (int i = 0; i < 3; i++)
            out = put_triangle(out, face->middles[(i + 2) % 3], face->corners[i], face->middles[i]);
        return put_triangle(out, face->middles[0], face->middles[1], face->middles[2]);
    }
    const struct split_face at = turned(face);
    uint32_t a = at.corners[0], b = at.corners[1], c = at.corners[2], m = at.middles[0], n = at.middles[1];
    if (pieces == 2) {
        out = put_triangle(out, a, m, c);
        return put_triangle(out, m, b, c);
    }
    out =
        put_triangle(out, m, b, n); /* the quadrilateral a, m, n, c is left: cut along its shorter diagonal */
    if (length_of(mesh, a, n) < length_of(mesh, m, c)) {
        out = put_triangle(out, a, m, n);
        return put_triangle(out, a, n, c);
    }
    out = put_triangle(out, a, m, c);
    return put_triangle(out, m, n, c);
}

/* ---- Attributes of the midpoints ---- */

static vec3s mean3(vec3s a, vec3s b)
{
    return glms_vec3_scale(glms_vec3_add(a, b), 0.5f);
}

/* The unit mean of two normals; the first where they cancel. */
static vec3s mean_direction(vec3s a, vec3s b)
{
    vec3s sum = glms_vec3_add(a, b);
    float length = glms_vec3_norm(sum);
    return length > 1e-6f ? glms_vec3_divs(sum, length) : a;
}

static vec4s mean_tangent(vec4s a, vec4s b)
{
    vec3s along = mean_direction((vec3s){{a.x, a.y, a.z}}, (vec3s){{b.x, b.y, b.z}});
    return (vec4s){{along.x, along.y, along.z, a.w}};
}

/* Grows an array by `more` elements and fills them: that of midpoint i with `mean` of its edge's ends. */
#define ADD_MIDDLES(array, count, edges, mean)                                                               \
    do {                                                                                                     \
        (array) = tl_resize((array), (count) + (edges)->count, sizeof *(array));                             \
        for (size_t i_ = 0; i_ < (edges)->count; i_++)                                                       \
            (array)[(count) + i_] = mean((array)[(edges)->items[i_].a], (array)[(edges)->items[i_].b]);      \
    } while (0)

static vec2s mean2(vec2s a, vec2s b)
{
    return glms_vec2_scale(glms_vec2_add(a, b), 0.5f);
}

/* Pinned where both ends are. A mean of one half would count as pinned at the next halving. */
static float held_by_both(float a, float b)
{
    return fminf(a, b);
}

static void add_middles(tl_model *model, const struct split_edges *edges)
{
    tl_mesh *mesh = &model->mesh;
    size_t count = mesh->vertex_count;
    ADD_MIDDLES(mesh->positions, count, edges, mean3);
    ADD_MIDDLES(mesh->normals, count, edges, mean_direction);
    ADD_MIDDLES(mesh->uvs, count, edges, mean2);
    if (mesh->tangents)
        ADD_MIDDLES(mesh->tangents, count, edges, mean_tangent);
    if (model->pins)
        ADD_MIDDLES(model->pins, count, edges, held_by_both);
    if (model->colours)
        ADD_MIDDLES(model->colours, count, edges, mean3);
    if (model->points) {
        model->points = tl_resize(model->points, count + edges->count, sizeof *model->points);
        for (size_t i = 0; i < edges->count; i++)
            model->points[count + i] = (uint32_t)(model->point_count + i);
    }
    model->point_count += edges->count;
    mesh->vertex_count += edges->count;
}

/* ---- One pass ---- */

static struct split_face *list_faces(const tl_mesh *mesh, const struct split_edges *edges,
                                     size_t *index_count)
{
    struct split_face *faces = TL_NEW_ARRAY(struct split_face, mesh->index_count / 3);
    *index_count = 0;
    for (size_t f = 0; f < mesh->index_count / 3; f++) {
        faces[f] = face_at(mesh, edges, 3 * f);
        *index_count += 3 * pieces_of(&faces[f]);
    }
    return faces;
}

static void split_parts(tl_mesh *mesh, const struct split_face *faces, size_t index_count)
{
    uint32_t *indices = TL_NEW_ARRAY(uint32_t, index_count), *out = indices;
    for (size_t p = 0; p < mesh->part_count; p++) {
        struct tl_mesh_part *part = &mesh->parts[p];
        size_t first = part->first_index / 3, end = first + part->index_count / 3;
        part->first_index = (uint32_t)(out - indices);
        for (size_t f = first; f < end; f++)
            out = split_face(mesh, &faces[f], out);
        part->index_count = (uint32_t)(out - indices) - part->first_index;
    }
    free(mesh->indices);
    mesh->indices = indices;
    mesh->index_count = (size_t)(out - indices);
}

/* Halves every edge that is too long, once. False when the mesh would get too large. */
static bool refine_once(tl_model *model, const struct split_edges *edges)
{
    size_t index_count;
    struct split_face *faces = list_faces(&model->mesh, edges, &index_count);
    bool fits = model->mesh.vertex_count + edges->count <= TL_LIMIT_MESH_VERTICES &&
                index_count <= TL_LIMIT_MESH_INDICES;
    if (fits) {
        add_middles(model, edges);
        split_parts(&model->mesh, faces, index_count);
    }
    free(faces);
    return fits;
}

/* A lower bound of the number of triangles: one with sides of at most l covers at most sqrt(3)/4 l^2. */
static double min_triangles(const tl_mesh *mesh, double longest_m)
{
    double area = 0;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t *v = &mesh->indices[i];
        vec3s side = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
        vec3s other = glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]);
        area += 0.5 * (double)glms_vec3_norm(glms_vec3_cross(side, other));
    }
    return area / (sqrt(3) / 4 * longest_m * longest_m);
}

bool tl_garment_refine(tl_garment *garment, float longest_m, tl_error *error)
{
    tl_model *model = &garment->model;
    struct split_edges edges = find_long_edges(&model->mesh, longest_m);
    if (edges.count > 0)
        rig_destroy(&model->rig);
    bool fits = 3 * min_triangles(&model->mesh, (double)longest_m) <= (double)TL_LIMIT_MESH_INDICES;
    while (fits && edges.count > 0) {
        fits = refine_once(model, &edges);
        free(edges.items);
        edges = find_long_edges(&model->mesh, longest_m);
    }
    free(edges.items);
    if (!fits)
        return tl_fail(error, TL_INPUT,
                       "%s: with edges of at most %g m it would have more than %zu triangles: set "
                       "cloth.longest_edge_m higher, or to 0",
                       model->name, (double)longest_m, TL_LIMIT_MESH_INDICES / 3);
    tl_garment_take_pins(garment);
    return true;
}
