#include "cloth/energy/energy.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Bounds of a triangle's height over its longest edge. Below `sliver` its plane is rounding noise, so its
 * edges become links. Below `needle` its cotangents are too large to give a meaningful curvature, so it does
 * not bend. */
static const double sliver = 1e-4, needle = 0.02;

/* Bending is an explicit force, not a constraint, if omega h of its fastest wave is at most this. The limit
 * of stability is 2 for bending alone; with membranes and contact, cloth near it trembles for ever: a wool
 * dress of 27,500 vertices at 1.24 was not at rest after 10 s, and as a constraint after 1.8. At 1.05 both
 * come to rest in the same time. */
#define FORCE_LIMIT 1.1

/* ---- Rest shapes ---- */

static vec3d start_of(const tl_garment *garment, uint32_t vertex)
{
    return vec3d_from(garment->model.mesh.positions[vertex]);
}

/* Direction in space in which u increases over a triangle; zero where UVs are missing or degenerate. */
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

void tl_rest_shape(const tl_garment *garment, size_t triangle, vec2s out[3])
{
    const uint32_t *vertices = &garment->model.mesh.indices[3 * triangle];
    if (garment->pattern && !(garment->modelled && garment->modelled[triangle]))
        for (int i = 0; i < 3; i++)
            out[i] = garment->pattern[vertices[i]];
    else
        flatten(garment, vertices, out);
}

vec2s (*tl_rest_shapes(const tl_garment *garment, const struct tl_topology *topology))[3]
{
    vec2s(*rest)[3] = tl_alloc(topology->triangle_count, sizeof *rest);
    for (size_t t = 0; t < topology->triangle_count; t++) {
        tl_rest_shape(garment, topology->source[t], rest[t]);
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

bool tl_rest_is_sliver(const vec2s rest[3])
{
    struct flat flat = read_flat(rest);
    return !(quality(&flat) >= sliver);
}

static double edge_length(const struct flat *flat, int corner)
{
    int i = (corner + 1) % 3, j = (corner + 2) % 3;
    return hypot(flat->x[j] - flat->x[i], flat->y[j] - flat->y[i]);
}

static void set_up_membrane(const uint32_t *vertices, const struct flat *flat, struct tl_membrane *m,
                            size_t lane)
{
    m->area[lane] = 0.5 * fabs(flat->signed_double_area);
    for (int i = 0; i < 3; i++) { /* gradients of the barycentric coordinates */
        int j = (i + 1) % 3, k = (i + 2) % 3;
        m->vertices[i][lane] = vertices[i];
        m->c[i][lane] = (flat->y[j] - flat->y[k]) / flat->signed_double_area;
        m->d[i][lane] = (flat->x[k] - flat->x[j]) / flat->signed_double_area;
    }
}

/* Cotangent of a triangle's angle at `corner`. */
static double cotangent(const struct flat *flat, int corner)
{
    int j = (corner + 1) % 3, k = (corner + 2) % 3;
    double ax = flat->x[j] - flat->x[corner], ay = flat->y[j] - flat->y[corner];
    double bx = flat->x[k] - flat->x[corner], by = flat->y[k] - flat->y[corner];
    return (ax * bx + ay * by) / fabs(flat->signed_double_area);
}

/* One triangle's tl_bend. */
struct stencil {
    uint32_t vertices[TL_BEND_STENCIL];
    double rows[3][TL_BEND_STENCIL];
};

/* Adds a vertex's coefficient to a stencil. A vertex may occur twice (a closed cone of three triangles has
 * one far corner for all its hinges): its coefficients add up. */
static void add_to_stencil(struct stencil *stencil, int *used, uint32_t vertex, double k,
                           const double unit[3])
{
    int slot = 0;
    while (slot < *used && stencil->vertices[slot] != vertex)
        slot++;
    if (slot == *used)
        stencil->vertices[(*used)++] = vertex;
    for (int row = 0; row < 3; row++)
        stencil->rows[row][slot] += k * unit[row];
}

/* The hinge across the edge opposite to a corner, in the numbers of both triangles' corners. */
struct hinge {
    const struct flat *near, *far;
    int start, end, far_corner, far_start, far_end;
    double length, scale; /* of the edge, m; of the far triangle, whose edge may be eased onto it */
};

/* Returns whether there is one between triangles that bend. */
static bool find_hinge(const struct tl_topology *topology, const struct flat *flats, uint32_t triangle,
                       int corner, struct hinge *out)
{
    const uint32_t other = topology->neighbour[triangle][corner];
    if (other == TL_NONE || quality(&flats[triangle]) < needle || quality(&flats[other]) < needle)
        return false;
    const uint32_t *mine = topology->triangles[triangle], *theirs = topology->triangles[other];
    const int start = (corner + 1) % 3, far_corner = (int)tl_topology_far_corner(topology, triangle, other);
    const int far_start =
        theirs[(far_corner + 1) % 3] == mine[start] ? (far_corner + 1) % 3 : (far_corner + 2) % 3;
    *out = (struct hinge){.near = &flats[triangle],
                          .far = &flats[other],
                          .start = start,
                          .end = (corner + 2) % 3,
                          .far_corner = far_corner,
                          .far_start = far_start,
                          .far_end = 3 - far_corner - far_start,
                          .length = edge_length(&flats[triangle], corner)};
    out->scale = out->length / edge_length(out->far, far_corner);
    return true;
}

/* Adds the hinge across the edge opposite to `corner`: n n^T / (A + A') times the hinge's cotangent
 * coefficients. */
static void add_hinge(const struct tl_topology *topology, const struct flat *flats, uint32_t triangle,
                      int corner, struct stencil *stencil, int *used)
{
    struct hinge hinge;
    if (!find_hinge(topology, flats, triangle, corner, &hinge))
        return;
    const struct flat *near = hinge.near, *far = hinge.far;
    const uint32_t *mine = topology->triangles[triangle];
    const uint32_t *theirs = topology->triangles[topology->neighbour[triangle][corner]];
    double dx = near->x[hinge.end] - near->x[hinge.start], dy = near->y[hinge.end] - near->y[hinge.start];
    double nx = dy / hinge.length, ny = -dx / hinge.length;
    double near_start = cotangent(near, hinge.start), near_end = cotangent(near, hinge.end);
    double across_start = cotangent(far, hinge.far_start) * hinge.scale,
           across_end = cotangent(far, hinge.far_end) * hinge.scale;
    double spread = 1 / (0.5 * fabs(near->signed_double_area) + 0.5 * fabs(far->signed_double_area));
    const double unit[3] = {spread * nx * nx, spread * ny * ny, spread * M_SQRT2 * nx * ny};
    add_to_stencil(stencil, used, mine[hinge.start], near_end + across_end, unit);
    add_to_stencil(stencil, used, mine[hinge.end], near_start + across_start, unit);
    add_to_stencil(stencil, used, mine[corner], -near_start - near_end, unit);
    add_to_stencil(stencil, used, theirs[hinge.far_corner], -across_start - across_end, unit);
}

static struct stencil make_stencil(const struct tl_topology *topology, const struct flat *flats,
                                   uint32_t triangle)
{
    struct stencil stencil = {0};
    int used = 3;
    memcpy(stencil.vertices, topology->triangles[triangle], 3 * sizeof(uint32_t));
    for (int corner = 0; corner < 3; corner++)
        add_hinge(topology, flats, triangle, corner, &stencil, &used);
    for (; used < TL_BEND_STENCIL; used++)
        stencil.vertices[used] = stencil.vertices[0];
    return stencil;
}

static void add_links(struct tl_energy *energy, const uint32_t *vertices, const struct flat *flat)
{
    for (int corner = 0; corner < 3; corner++)
        energy->links[energy->link_count++] = (struct tl_link){.a = vertices[(corner + 1) % 3],
                                                               .b = vertices[(corner + 2) % 3],
                                                               .rest = edge_length(flat, corner)};
}

/* Membranes of all triangles but slivers, which are listed in `triangles`. */
static void build_membranes(struct tl_energy *energy, const struct tl_topology *topology,
                            const struct flat *flats, const uint32_t *triangles, size_t count)
{
    uint32_t(*corners)[3] = tl_alloc(count, sizeof *corners);
    for (size_t i = 0; i < count; i++)
        memcpy(corners[i], topology->triangles[triangles[i]], sizeof *corners);
    struct tl_batches batches = tl_batches_build(&corners[0][0], 3, 3, count, topology->vertex_count);
    energy->membrane_count = batches.count;
    energy->membrane_run_count = batches.run_count;
    energy->membrane_run_ends = batches.run_ends;
    batches.run_ends = NULL;
    energy->membranes = TL_NEW_ARRAY(struct tl_membrane, energy->membrane_count);
    energy->previewed = tl_alloc_lines(energy->membrane_count, sizeof *energy->previewed);
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++) {
        struct tl_membrane *m = &energy->membranes[i / TL_BATCH];
        for (int k = 0; k < 3; k++)
            m->vertices[k][i % TL_BATCH] = (uint32_t)topology->vertex_count;
        uint32_t element = batches.elements[i];
        if (element != TL_NONE)
            set_up_membrane(corners[element], &flats[triangles[element]], m, i % TL_BATCH);
    }
    tl_batches_release(&batches);
    free(corners);
}

static void build_bends(struct tl_energy *energy, const struct tl_topology *topology,
                        const struct flat *flats)
{
    size_t count = topology->triangle_count;
    struct stencil *stencils = TL_NEW_ARRAY(struct stencil, count);
    for (size_t t = 0; t < count; t++)
        stencils[t] = make_stencil(topology, flats, (uint32_t)t);
    struct tl_batches batches = tl_batches_build(stencils[0].vertices, sizeof *stencils / sizeof(uint32_t),
                                                 TL_BEND_STENCIL, count, topology->vertex_count);
    energy->bend_count = batches.count;
    energy->bend_run_count = batches.run_count;
    energy->bend_run_ends = batches.run_ends;
    batches.run_ends = NULL;
    energy->bends = TL_NEW_ARRAY(struct tl_bend, energy->bend_count);
    for (size_t i = 0; i < energy->bend_count * TL_BATCH; i++) {
        struct tl_bend *bend = &energy->bends[i / TL_BATCH];
        uint32_t element = batches.elements[i];
        const struct stencil *from = element != TL_NONE ? &stencils[element] : NULL;
        size_t lane = i % TL_BATCH;
        for (int k = 0; k < TL_BEND_STENCIL; k++) {
            bend->vertices[k][lane] = from ? from->vertices[k] : (uint32_t)topology->vertex_count;
            for (int row = 0; row < 3; row++)
                bend->rows[row][k][lane] = from ? from->rows[row][k] : 0;
        }
        bend->area[lane] = from ? 0.5 * fabs(flats[element].signed_double_area) : 0;
    }
    tl_batches_release(&batches);
    free(stencils);
}

/* Returns whether there is a hinge across the edge opposite to `corner`, once for both its sides. */
static bool make_fold(const struct tl_topology *topology, const struct flat *flats, uint32_t triangle,
                      int corner, const vec3d *made, struct tl_fold *out)
{
    const uint32_t other = topology->neighbour[triangle][corner];
    struct hinge hinge;
    if (!find_hinge(topology, flats, triangle, corner, &hinge) || other < triangle)
        return false;
    const struct flat *near = hinge.near, *far = hinge.far;
    const uint32_t *mine = topology->triangles[triangle], *theirs = topology->triangles[other];
    const double length = hinge.length, height = fabs(near->signed_double_area) / length;
    const double far_height = fabs(far->signed_double_area) / length * (hinge.scale * hinge.scale);
    /* Distance of the corners' feet on the edge: a cotangent is a foot's distance from its end over the
     * height. */
    const double along = cotangent(near, hinge.start) * height - cotangent(far, hinge.far_start) * far_height;
    const double normal_u = near->y[hinge.end] - near->y[hinge.start];
    const double normal_v = near->x[hinge.end] - near->x[hinge.start];
    const double reach = sqrt(along * along + height * height + far_height * far_height);
    const double flat = hypot(along, height - far_height), deep = reach - flat;
    *out = (struct tl_fold){.ends = {mine[corner], theirs[hinge.far_corner]},
                            .reach = reach,
                            .spring = (M_PI * M_PI - 4) * 2 * length / ((height + far_height) * deep * deep),
                            .across_weft = normal_u * normal_u / (length * length),
                            .across_warp = normal_v * normal_v / (length * length)};
    if (made)
        out->reach = fmin(reach, vec3d_norm(vec3d_sub(made[out->ends[0]], made[out->ends[1]])));
    return out->ends[0] != out->ends[1];
}

static void build_folds(struct tl_energy *energy, const struct tl_topology *topology,
                        const struct flat *flats, const vec3d *made)
{
    struct tl_fold *folds = TL_NEW_ARRAY(struct tl_fold, 3 * topology->triangle_count);
    size_t count = 0;
    for (uint32_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 0; corner < 3; corner++)
            count += make_fold(topology, flats, t, corner, made, &folds[count]);
    energy->folds = tl_folds_build(folds, count, topology->vertex_count);
}

struct tl_energy tl_energy_build(const struct tl_topology *topology, const vec2s (*rest)[3],
                                 const vec3d *made)
{
    size_t count = topology->triangle_count, membrane_count = 0;
    struct tl_energy energy = {.links = TL_NEW_ARRAY(struct tl_link, 3 * count),
                               .masses = TL_NEW_ARRAY(double, topology->vertex_count)};
    struct flat *flats = TL_NEW_ARRAY(struct flat, count);
    uint32_t *triangles = TL_NEW_ARRAY(uint32_t, count);
    for (size_t t = 0; t < count; t++) {
        flats[t] = read_flat(rest[t]);
        for (int i = 0; i < 3; i++)
            energy.masses[topology->triangles[t][i]] += fabs(flats[t].signed_double_area) / 6;
        if (quality(&flats[t]) < sliver)
            add_links(&energy, topology->triangles[t], &flats[t]);
        else
            triangles[membrane_count++] = (uint32_t)t;
    }
    build_membranes(&energy, topology, flats, triangles, membrane_count);
    build_bends(&energy, topology, flats);
    build_folds(&energy, topology, flats, made);
    energy.pairs = tl_pair_forces_build(topology, &energy);
    free(triangles);
    free(flats);
    return energy;
}

void tl_energy_release(struct tl_energy *energy)
{
    free(energy->membranes);
    free(energy->previewed);
    free(energy->membrane_run_ends);
    free(energy->bend_run_ends);
    free(energy->bends);
    free(energy->links);
    free(energy->masses);
    tl_folds_release(&energy->folds);
    tl_pair_forces_release(&energy->pairs);
    *energy = (struct tl_energy){0};
}

/* ---- Material ---- */

void tl_bend_stiffness(const struct tl_cloth_fabric *fabric, double out[3])
{
    out[0] = fabric->bend_weft;
    out[1] = fabric->bend_warp;
    out[2] = sqrt(fabric->bend_weft * fabric->bend_warp);
}

void tl_energy_set_fabric(struct tl_energy *energy, const struct tl_cloth_fabric *fabric)
{
    double stiffness[3];
    tl_bend_stiffness(fabric, stiffness);
    tl_pair_forces_set(&energy->pairs, energy, stiffness);
    tl_folds_set_fabric(&energy->folds, fabric);
}

/* XPBD's -1 / (w |grad C|^2 + compliance / h^2); 0 where nothing can move or nothing resists. */
static double factor_of(double gradient, double stiffness, double h)
{
    double sum = gradient + 1 / (stiffness * h * h);
    return gradient > 0 && isfinite(sum) ? -1 / sum : 0;
}

static void set_preview(const struct tl_membrane *m, const struct tl_cloth_fabric *fabric, const double *w,
                        double h, struct tl_preview_membrane *out)
{
    memcpy(out->c, &m->c[1], sizeof out->c);
    memcpy(out->d, &m->d[1], sizeof out->d);
    for (int lane = 0; lane < TL_BATCH; lane++) {
        double cc = 0, cd = 0, dd = 0;
        for (int i = 0; i < 3; i++) {
            double mobility = out->w[i][lane] = w[m->vertices[i][lane]];
            out->from[i][lane] = 4 * m->vertices[i][lane];
            double c = m->c[i][lane], d = m->d[i][lane];
            cc += mobility * c * c;
            cd += mobility * c * d;
            dd += mobility * d * d;
        }
        out->cc[lane] = cc;
        out->cd[lane] = cd;
        out->dd[lane] = dd;
        out->weft[lane] = factor_of(cc, fabric->stretch_weft * m->area[lane], h);
        out->warp[lane] = factor_of(dd, fabric->stretch_warp * m->area[lane], h);
        out->shear[lane] = 1 / (fabric->shear * m->area[lane] * h * h);
    }
}

static void set_bend(struct tl_bend *bend, const struct tl_cloth_fabric *fabric, const double *w, double h)
{
    double stiffness[3];
    tl_bend_stiffness(fabric, stiffness);
    for (int i = 0; i < TL_BEND_STENCIL; i++)
        for (int lane = 0; lane < TL_BATCH; lane++)
            bend->w[i][lane] = w[bend->vertices[i][lane]];
    for (int row = 0; row < 3; row++)
        for (int lane = 0; lane < TL_BATCH; lane++) {
            double gradient = 0;
            for (int i = 0; i < TL_BEND_STENCIL; i++)
                gradient += bend->w[i][lane] * bend->rows[row][i][lane] * bend->rows[row][i][lane];
            bend->factors[row][lane] = factor_of(gradient, stiffness[row] * bend->area[lane], h);
        }
}

/* Gershgorin's upper bound of omega^2 of bending: twice the sum of a row's off-diagonal entries, as rows sum
 * to 0. */
static double fastest_bending(const struct tl_pair_forces *pairs, const double *w)
{
    double fastest = 0;
    for (size_t i = 0; i < pairs->vertex_count; i++) {
        double sum = 0;
        for (uint32_t k = pairs->incident_first[i]; k < pairs->incident_first[i + 1]; k++)
            sum += fabs(pairs->edge_bending[pairs->incident[k].edge]);
        for (uint32_t k = pairs->others_first[i]; k < pairs->others_first[i + 1]; k++)
            sum += fabs(pairs->bending[k]);
        fastest = fmax(fastest, 2 * sum * w[i]);
    }
    return fastest;
}

void tl_energy_set_preview(struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                           const double *inverse_masses, double h, bool bends_by_rows)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        set_preview(&energy->membranes[i], fabric, inverse_masses, h, &energy->previewed[i]);
    for (size_t i = 0; i < energy->bend_count; i++)
        set_bend(&energy->bends[i], fabric, inverse_masses, h);
    tl_folds_set_step(&energy->folds, inverse_masses, h);
    energy->bending_is_force =
        !bends_by_rows && h * sqrt(fastest_bending(&energy->pairs, inverse_masses)) <= FORCE_LIMIT;
    for (size_t i = 0; i < energy->link_count; i++)
        energy->links[i].compliance = 1 / (fabric->stretch_warp * h * h);
    tl_pair_forces_set_packs(&energy->pairs, energy->bending_is_force);
}
