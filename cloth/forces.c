/* The energy as a number, its forces and how stiff it is. */
#include "cloth/energy.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Shorter than this a vector has no direction to push along. */
#define NO_LENGTH 1e-12

struct tension {
    vec3d u, v; /* dE/dF_u, dE/dF_v per stiffness and area */
    double energy;
};

/* Adds E = k/2 (|f| - 1)^2 of a column of F. */
static void add_stretch(vec3d f, double stiffness, vec3d *gradient, double *energy)
{
    double length = vec3d_norm(f);
    *energy += 0.5 * stiffness * (length - 1) * (length - 1);
    if (length > NO_LENGTH)
        *gradient = vec3d_muladd(*gradient, f, stiffness * (1 - 1 / length));
}

static void add_shear(vec3d u, vec3d v, double stiffness, struct tension *tension)
{
    double uu = vec3d_dot(u, u), vv = vec3d_dot(v, v);
    if (!(uu > NO_LENGTH * NO_LENGTH && vv > NO_LENGTH * NO_LENGTH))
        return;
    double both = 1 / sqrt(uu * vv), cosine = vec3d_dot(u, v) * both;
    vec3d along_u = vec3d_muladd(vec3d_scale(v, both), u, -cosine / uu);
    vec3d along_v = vec3d_muladd(vec3d_scale(u, both), v, -cosine / vv);
    tension->u = vec3d_muladd(tension->u, along_u, stiffness * cosine);
    tension->v = vec3d_muladd(tension->v, along_v, stiffness * cosine);
    tension->energy += 0.5 * stiffness * cosine * cosine;
}

static double add_membrane(const struct tl_membrane *m, size_t lane, const struct tl_cloth_fabric *fabric,
                           const vec3d *x, vec3d *forces)
{
    vec3d u = {0}, v = {0};
    struct tension tension = {0};
    for (int i = 0; i < 3; i++) {
        u = vec3d_muladd(u, x[m->vertices[i][lane]], m->c[i][lane]);
        v = vec3d_muladd(v, x[m->vertices[i][lane]], m->d[i][lane]);
    }
    add_stretch(u, fabric->stretch_weft, &tension.u, &tension.energy);
    add_stretch(v, fabric->stretch_warp, &tension.v, &tension.energy);
    add_shear(u, v, fabric->shear, &tension);
    double area = m->area[lane];
    for (int i = 0; i < 3; i++) {
        vec3d *force = &forces[m->vertices[i][lane]];
        *force = vec3d_muladd(*force, tension.u, -area * m->c[i][lane]);
        *force = vec3d_muladd(*force, tension.v, -area * m->d[i][lane]);
    }
    return area * tension.energy;
}

static double add_bend(const struct tl_bend *bend, size_t lane, const double stiffness[3], const vec3d *x,
                       vec3d *forces)
{
    double energy = 0;
    for (int row = 0; row < 3; row++) {
        vec3d curvature = {0};
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            curvature = vec3d_muladd(curvature, x[bend->vertices[i][lane]], bend->rows[row][i][lane]);
        double k = stiffness[row] * bend->area[lane];
        energy += 0.5 * k * vec3d_dot(curvature, curvature);
        for (int i = 0; i < TL_BEND_STENCIL; i++) {
            vec3d *force = &forces[bend->vertices[i][lane]];
            *force = vec3d_muladd(*force, curvature, -k * bend->rows[row][i][lane]);
        }
    }
    return energy;
}

double tl_energy_link(const struct tl_link *link, double stiffness, const vec3d *x, vec3d *forces)
{
    vec3d apart = vec3d_sub(x[link->b], x[link->a]);
    double length = vec3d_norm(apart), stretch = length - link->rest;
    if (length > NO_LENGTH) {
        vec3d pull = vec3d_scale(apart, stiffness * stretch / length);
        forces[link->a] = vec3d_add(forces[link->a], pull);
        forces[link->b] = vec3d_sub(forces[link->b], pull);
    }
    return 0.5 * stiffness * stretch * stretch;
}

static void bend_stiffness(const struct tl_cloth_fabric *fabric, double out[3])
{
    out[0] = fabric->bend_weft;
    out[1] = fabric->bend_warp;
    out[2] = sqrt(fabric->bend_weft * fabric->bend_warp);
}

double tl_energy_forces(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                        size_t vertex_count, const vec3d *x, vec3d *forces)
{
    double stiffness[3], total = 0;
    bend_stiffness(fabric, stiffness);
    memset(forces, 0, vertex_count * sizeof *forces);
    for (size_t i = 0; i < energy->membrane_count * TL_LANES; i++)
        if (energy->membranes[i / TL_LANES].area[i % TL_LANES] > 0)
            total += add_membrane(&energy->membranes[i / TL_LANES], i % TL_LANES, fabric, x, forces);
    for (size_t i = 0; i < energy->bend_count * TL_LANES; i++)
        if (energy->bends[i / TL_LANES].area[i % TL_LANES] > 0)
            total += add_bend(&energy->bends[i / TL_LANES], i % TL_LANES, stiffness, x, forces);
    for (size_t i = 0; i < energy->link_count; i++)
        total += tl_energy_link(&energy->links[i], fabric->stretch_warp, x, forces);
    return total;
}

/* ---- Stiffness ---- */

/* Adds to each vertex its row of |K| for an energy k/2 |sum rows x|^2. */
static void add_rows(const double *rows, size_t stride, const uint32_t *vertices, size_t count,
                     double stiffness, double *sums)
{
    double total = 0;
    for (size_t i = 0; i < count; i++)
        total += fabs(rows[i * stride]);
    for (size_t i = 0; i < count; i++)
        sums[vertices[i * TL_LANES]] += stiffness * fabs(rows[i * stride]) * total;
}

static void add_membrane_rows(const struct tl_membrane *m, size_t lane, const struct tl_cloth_fabric *fabric,
                              double *sums)
{
    double area = m->area[lane], shear[3 * TL_LANES] = {0};
    for (int i = 0; i < 3; i++)
        shear[i * TL_LANES] = fabs(m->c[i][lane]) + fabs(m->d[i][lane]);
    add_rows(&m->c[0][lane], TL_LANES, &m->vertices[0][lane], 3, area * fabric->stretch_weft, sums);
    add_rows(&m->d[0][lane], TL_LANES, &m->vertices[0][lane], 3, area * fabric->stretch_warp, sums);
    add_rows(shear, TL_LANES, &m->vertices[0][lane], 3, area * fabric->shear, sums);
}

double tl_energy_critical_step(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                               size_t vertex_count, const double *inverse_masses)
{
    double stiffness[3], fastest = 0;
    double *sums = TL_NEW_ARRAY(double, vertex_count + 1);
    bend_stiffness(fabric, stiffness);
    for (size_t i = 0; i < energy->membrane_count * TL_LANES; i++)
        add_membrane_rows(&energy->membranes[i / TL_LANES], i % TL_LANES, fabric, sums);
    for (size_t i = 0; i < energy->bend_count * TL_LANES; i++) {
        const struct tl_bend *bend = &energy->bends[i / TL_LANES];
        size_t lane = i % TL_LANES;
        for (int row = 0; row < 3; row++)
            add_rows(&bend->rows[row][0][lane], TL_LANES, &bend->vertices[0][lane], TL_BEND_STENCIL,
                     stiffness[row] * bend->area[lane], sums);
    }
    for (size_t i = 0; i < energy->link_count; i++) {
        sums[energy->links[i].a] += 2 * fabric->stretch_warp;
        sums[energy->links[i].b] += 2 * fabric->stretch_warp;
    }
    for (size_t i = 0; i < vertex_count; i++)
        fastest = fmax(fastest, inverse_masses[i] * sums[i]);
    free(sums);
    return 2 / sqrt(fastest);
}
