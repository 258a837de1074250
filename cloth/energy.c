#include "cloth/energy.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Height over the longest edge. Below `sliver` a triangle's plane is rounding noise: its edges become links.
 * Below `needle` its cotangents are too large to say anything of curvature: it does not bend. */
static const double sliver = 1e-4, needle = 0.02;

/* ---- Rest shapes ---- */

static vec3d start_of(const tl_garment *garment, uint32_t vertex)
{
    return vec3d_from(garment->model.mesh.positions[vertex]);
}

/* Direction in space in which u grows over a triangle; zero where UVs do not tell. */
static vec3d weft_direction(const tl_garment *garment, const uint32_t *vertices)
{
    const tl_mesh *mesh = &garment->model.mesh;
    if (!mesh->uvs)
        return (vec3d){0};
    vec3d origin = start_of(garment, vertices[0]);
    vec3d side = vec3d_sub(start_of(garment, vertices[1]), origin);
    vec3d other = vec3d_sub(start_of(garment, vertices[2]), origin);
    vec2s uv = mesh->uvs[vertices[0]];
    double side_u = (double)mesh->uvs[vertices[1]].x - (double)uv.x;
    double side_v = (double)mesh->uvs[vertices[1]].y - (double)uv.y;
    double other_u = (double)mesh->uvs[vertices[2]].x - (double)uv.x;
    double other_v = (double)mesh->uvs[vertices[2]].y - (double)uv.y;
    double area = side_u * other_v - other_u * side_v;
    if (!isfinite(area) || fabs(area) < 1e-14)
        return (vec3d){0};
    vec3d direction = vec3d_muladd(vec3d_scale(side, other_v), other, -side_v);
    return vec3d_scale(direction, area < 0 ? -1 : 1);
}

static void flatten(const tl_garment *garment, const uint32_t *vertices, vec2s out[3])
{
    vec3d origin = start_of(garment, vertices[0]);
    vec3d side = vec3d_sub(start_of(garment, vertices[1]), origin);
    vec3d other = vec3d_sub(start_of(garment, vertices[2]), origin);
    vec3d normal = vec3d_unit_or(vec3d_cross(side, other), (vec3d){0});
    vec3d weft = weft_direction(garment, vertices);
    weft = vec3d_muladd(weft, normal, -vec3d_dot(weft, normal));
    weft = vec3d_unit_or(weft, vec3d_unit_or(side, (vec3d){1, 0, 0}));
    vec3d warp = vec3d_cross(normal, weft);
    for (int i = 0; i < 3; i++) {
        vec3d from = vec3d_sub(start_of(garment, vertices[i]), origin);
        out[i] = (vec2s){{(float)vec3d_dot(from, weft), (float)vec3d_dot(from, warp)}};
    }
}

vec2s (*tl_rest_shapes(const tl_garment *garment, const struct tl_topology *topology))[3]
{
    vec2s(*rest)[3] = tl_alloc(topology->triangle_count, sizeof *rest);
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *vertices = &garment->model.mesh.indices[3 * (size_t)topology->source[t]];
        if (garment->pattern)
            for (int i = 0; i < 3; i++)
                rest[t][i] = garment->pattern[vertices[i]];
        else
            flatten(garment, vertices, rest[t]);
    }
    return rest;
}

/* ---- Building ---- */

struct flat {
    double x[3], y[3];
    double signed_double_area, longest;
};

static struct flat read_flat(const vec2s rest[3])
{
    struct flat flat = {0};
    for (int i = 0; i < 3; i++) {
        flat.x[i] = (double)rest[i].x;
        flat.y[i] = (double)rest[i].y;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        flat.longest = fmax(flat.longest, hypot(flat.x[j] - flat.x[i], flat.y[j] - flat.y[i]));
    }
    flat.signed_double_area =
        (flat.x[1] - flat.x[0]) * (flat.y[2] - flat.y[0]) - (flat.x[2] - flat.x[0]) * (flat.y[1] - flat.y[0]);
    return flat;
}

/* Height over longest edge. */
static double quality(const struct flat *flat)
{
    return flat->longest > 0 ? fabs(flat->signed_double_area) / (flat->longest * flat->longest) : 0;
}

static double edge_length(const struct flat *flat, int corner)
{
    int i = (corner + 1) % 3, j = (corner + 2) % 3;
    return hypot(flat->x[j] - flat->x[i], flat->y[j] - flat->y[i]);
}

static struct tl_membrane make_membrane(const uint32_t *vertices, const struct flat *flat)
{
    struct tl_membrane m = {.area = 0.5 * fabs(flat->signed_double_area)};
    memcpy(m.vertices, vertices, sizeof m.vertices);
    for (int i = 0; i < 3; i++) { /* gradients of the barycentric coordinates */
        int j = (i + 1) % 3, k = (i + 2) % 3;
        m.c[i] = (flat->y[j] - flat->y[k]) / flat->signed_double_area;
        m.d[i] = (flat->x[k] - flat->x[j]) / flat->signed_double_area;
    }
    return m;
}

/* Cotangent of a triangle's angle at `corner`. */
static double cotangent(const struct flat *flat, int corner)
{
    int j = (corner + 1) % 3, k = (corner + 2) % 3;
    double ax = flat->x[j] - flat->x[corner], ay = flat->y[j] - flat->y[corner];
    double bx = flat->x[k] - flat->x[corner], by = flat->y[k] - flat->y[corner];
    return (ax * bx + ay * by) / fabs(flat->signed_double_area);
}

/* Adds a vertex's coefficient to a stencil, merging vertices that are met twice (a closed cone of three
 * triangles has one far corner for all its hinges). */
static void add_to_stencil(struct tl_bend *bend, int *used, uint32_t vertex, double k, const double unit[3])
{
    int slot = 0;
    while (slot < *used && bend->vertices[slot] != vertex)
        slot++;
    if (slot == *used)
        bend->vertices[(*used)++] = vertex;
    for (int row = 0; row < 3; row++)
        bend->rows[row][slot] += k * unit[row];
}

/* Adds the hinge across the edge that faces `corner`. */
static void add_hinge(const struct tl_topology *topology, const struct flat *flats, uint32_t triangle,
                      int corner, struct tl_bend *bend, int *used)
{
    uint32_t other = topology->neighbour[triangle][corner];
    if (other == TL_NONE || quality(&flats[other]) < needle)
        return;
    const struct flat *near = &flats[triangle], *far = &flats[other];
    int far_corner = (int)tl_topology_far_corner(topology, triangle, other);
    const uint32_t *mine = topology->triangles[triangle], *theirs = topology->triangles[other];
    int start = (corner + 1) % 3, end = (corner + 2) % 3;
    int far_start = theirs[(far_corner + 1) % 3] == mine[start] ? (far_corner + 1) % 3 : (far_corner + 2) % 3;
    int far_end = 3 - far_corner - far_start;

    double dx = near->x[end] - near->x[start], dy = near->y[end] - near->y[start];
    double length = hypot(dx, dy), nx = dy / length, ny = -dx / length;
    /* Pattern pieces that are eased together have edges of different length: each side measures its own. */
    double near_start = cotangent(near, start), near_end = cotangent(near, end);
    double scale = length / edge_length(far, far_corner);
    double across_start = cotangent(far, far_start) * scale, across_end = cotangent(far, far_end) * scale;
    double spread = 1 / (0.5 * fabs(near->signed_double_area) + 0.5 * fabs(far->signed_double_area));
    const double unit[3] = {spread * nx * nx, spread * ny * ny, spread * M_SQRT2 * nx * ny};
    add_to_stencil(bend, used, mine[start], near_end + across_end, unit);
    add_to_stencil(bend, used, mine[end], near_start + across_start, unit);
    add_to_stencil(bend, used, mine[corner], -near_start - near_end, unit);
    add_to_stencil(bend, used, theirs[far_corner], -across_start - across_end, unit);
}

static bool make_bend(const struct tl_topology *topology, const struct flat *flats, uint32_t triangle,
                      struct tl_bend *bend)
{
    *bend = (struct tl_bend){.area = 0.5 * fabs(flats[triangle].signed_double_area)};
    int used = 3;
    memcpy(bend->vertices, topology->triangles[triangle], 3 * sizeof(uint32_t));
    for (int corner = 0; corner < 3; corner++)
        add_hinge(topology, flats, triangle, corner, bend, &used);
    for (; used < TL_BEND_STENCIL; used++)
        bend->vertices[used] = bend->vertices[0];
    double size = 0;
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            size += fabs(bend->rows[row][i]);
    return size > 0;
}

static void add_links(struct tl_energy *energy, const uint32_t *vertices, const struct flat *flat)
{
    for (int corner = 0; corner < 3; corner++)
        energy->links[energy->link_count++] = (struct tl_link){.a = vertices[(corner + 1) % 3],
                                                               .b = vertices[(corner + 2) % 3],
                                                               .rest = edge_length(flat, corner)};
}

/* Elements that follow each other share no vertex, so that the processor works on several at once. */
static void *sorted_by_colour(void *elements, size_t size, size_t per_element, size_t count,
                              size_t vertex_count)
{
    uint32_t *order = TL_NEW_ARRAY(uint32_t, count);
    char *sorted = tl_alloc(count, size);
    tl_order_by_colour(elements, size / sizeof(uint32_t), per_element, count, vertex_count, order);
    for (size_t i = 0; i < count; i++)
        memcpy(sorted + i * size, (const char *)elements + order[i] * size, size);
    free(order);
    free(elements);
    return sorted;
}

struct tl_energy tl_energy_build(const struct tl_topology *topology, const vec2s (*rest)[3])
{
    size_t count = topology->triangle_count;
    struct tl_energy energy = {.membranes = TL_NEW_ARRAY(struct tl_membrane, count),
                               .bends = TL_NEW_ARRAY(struct tl_bend, count),
                               .masses = TL_NEW_ARRAY(double, topology->vertex_count)};
    struct flat *flats = TL_NEW_ARRAY(struct flat, count);
    size_t slivers = 0;
    for (size_t t = 0; t < count; t++) {
        flats[t] = read_flat(rest[t]);
        slivers += quality(&flats[t]) < sliver;
        for (int i = 0; i < 3; i++)
            energy.masses[topology->triangles[t][i]] += fabs(flats[t].signed_double_area) / 6;
    }
    energy.links = TL_NEW_ARRAY(struct tl_link, 3 * slivers);
    for (size_t t = 0; t < count; t++) {
        if (quality(&flats[t]) < sliver)
            add_links(&energy, topology->triangles[t], &flats[t]);
        else
            energy.membranes[energy.membrane_count++] = make_membrane(topology->triangles[t], &flats[t]);
        if (quality(&flats[t]) >= needle)
            energy.bend_count += make_bend(topology, flats, (uint32_t)t, &energy.bends[energy.bend_count]);
    }
    free(flats);
    energy.membranes = sorted_by_colour(energy.membranes, sizeof *energy.membranes, 3, energy.membrane_count,
                                        topology->vertex_count);
    energy.bends = sorted_by_colour(energy.bends, sizeof *energy.bends, TL_BEND_STENCIL, energy.bend_count,
                                    topology->vertex_count);
    return energy;
}

void tl_energy_release(struct tl_energy *energy)
{
    free(energy->membranes);
    free(energy->bends);
    free(energy->links);
    free(energy->masses);
    *energy = (struct tl_energy){0};
}

/* ---- Material ---- */

/* -1 / (gradient + 1/(stiffness h^2)), 0 where nothing can move or resist. */
static double factor_of(double gradient, double stiffness, double h)
{
    double sum = gradient + 1 / (stiffness * h * h);
    return gradient > 0 && isfinite(sum) ? -1 / sum : 0;
}

static void set_membrane(struct tl_membrane *m, const struct tl_cloth_fabric *fabric, const double *w,
                         double h)
{
    m->cc = m->cd = m->dd = 0;
    for (int i = 0; i < 3; i++) {
        m->cc += w[m->vertices[i]] * m->c[i] * m->c[i];
        m->cd += w[m->vertices[i]] * m->c[i] * m->d[i];
        m->dd += w[m->vertices[i]] * m->d[i] * m->d[i];
    }
    m->weft = factor_of(m->cc, fabric->stretch_weft * m->area, h);
    m->warp = factor_of(m->dd, fabric->stretch_warp * m->area, h);
    m->shear = 1 / (fabric->shear * m->area * h * h);
}

static void set_bend(struct tl_bend *bend, const struct tl_cloth_fabric *fabric, const double *w, double h)
{
    const double stiffness[3] = {fabric->bend_weft, fabric->bend_warp,
                                 sqrt(fabric->bend_weft * fabric->bend_warp)};
    for (int row = 0; row < 3; row++) {
        double gradient = 0;
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            gradient += w[bend->vertices[i]] * bend->rows[row][i] * bend->rows[row][i];
        bend->factors[row] = factor_of(gradient, stiffness[row] * bend->area, h);
    }
}

void tl_energy_set(struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                   const double *inverse_masses, double h)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        set_membrane(&energy->membranes[i], fabric, inverse_masses, h);
    for (size_t i = 0; i < energy->bend_count; i++)
        set_bend(&energy->bends[i], fabric, inverse_masses, h);
    for (size_t i = 0; i < energy->link_count; i++)
        energy->links[i].compliance = 1 / (fabric->stretch_warp * h * h);
}
