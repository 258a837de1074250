/* Row sums of the stiffness, and the longest stable step of an explicit solver, by Gershgorin's theorem. */
#include "cloth/energy/energy.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Adds to each vertex the row sum of |K| for an energy k/2 |sum_i rows_i x_i|^2, whose K_ij = k rows_i
 * rows_j. */
static void add_rows(const double *rows, size_t stride, const uint32_t *vertices, size_t count,
                     double stiffness, double *sums)
{
    double total = 0;
    for (size_t i = 0; i < count; i++)
        total += fabs(rows[i * stride]);
    for (size_t i = 0; i < count; i++)
        sums[vertices[i * TL_BATCH]] += stiffness * fabs(rows[i * stride]) * total;
}

/* 1 / |F_u| or 1 / |F_v|: a compressed thread rotates further for the same displacement, which makes shear
 * stiffer. */
static double shortness(const double gradients[3][TL_BATCH], const uint32_t vertices[3][TL_BATCH],
                        size_t lane, const vec3d *x)
{
    const double minimum = 1e-9;
    vec3d column = {0};
    for (int i = 0; i < 3; i++)
        column = vec3d_muladd(column, x[vertices[i][lane]], gradients[i][lane]);
    return 1 / fmax(vec3d_norm(column), minimum);
}

/* The Hessian of k/2 (|F_u| - 1)^2 has the eigenvalues k along F_u and k (1 - 1/|F_u|) across it. */
static double stretch_stiffness(double k, double shortness)
{
    return k * fmax(1, shortness - 1);
}

static void add_membrane_rows(const struct tl_membrane *m, size_t lane, const struct tl_cloth_fabric *fabric,
                              const vec3d *x, double *sums)
{
    double area = m->area[lane], shear[3 * TL_BATCH] = {0};
    double u = x ? shortness(m->c, m->vertices, lane, x) : 1,
           v = x ? shortness(m->d, m->vertices, lane, x) : 1;
    for (size_t i = 0; i < 3; i++)
        shear[i * TL_BATCH] = u * fabs(m->c[i][lane]) + v * fabs(m->d[i][lane]);
    add_rows(&m->c[0][lane], TL_BATCH, &m->vertices[0][lane], 3,
             area * stretch_stiffness(fabric->stretch_weft, u), sums);
    add_rows(&m->d[0][lane], TL_BATCH, &m->vertices[0][lane], 3,
             area * stretch_stiffness(fabric->stretch_warp, v), sums);
    add_rows(shear, TL_BATCH, &m->vertices[0][lane], 3, area * fabric->shear, sums);
}

void tl_energy_row_sums(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                        size_t vertex_count, const vec3d *x, double *sums)
{
    double stiffness[3];
    memset(sums, 0, (vertex_count + 1) * sizeof *sums);
    tl_bend_stiffness(fabric, stiffness);
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++)
        if (energy->membranes[i / TL_BATCH].area[i % TL_BATCH] > 0)
            add_membrane_rows(&energy->membranes[i / TL_BATCH], i % TL_BATCH, fabric, x, sums);
    for (size_t i = 0; i < energy->bend_count * TL_BATCH; i++) {
        const struct tl_bend *bend = &energy->bends[i / TL_BATCH];
        size_t lane = i % TL_BATCH;
        for (int row = 0; row < 3; row++)
            add_rows(&bend->rows[row][0][lane], TL_BATCH, &bend->vertices[0][lane], TL_BEND_STENCIL,
                     stiffness[row] * bend->area[lane], sums);
    }
    tl_folds_add_row_sums(&energy->folds, sums);
    for (size_t i = 0; i < energy->link_count; i++) {
        sums[energy->links[i].a] += 2 * fabric->stretch_warp;
        sums[energy->links[i].b] += 2 * fabric->stretch_warp;
    }
}

double tl_energy_critical_step(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                               size_t vertex_count, const double *inverse_masses, const vec3d *x)
{
    double fastest = 0;
    double *sums = TL_NEW_ARRAY(double, vertex_count + 1);
    tl_energy_row_sums(energy, fabric, vertex_count, x, sums);
    for (size_t i = 0; i < vertex_count; i++)
        fastest = fmax(fastest, inverse_masses[i] * sums[i]);
    free(sums);
    return 2 / sqrt(fastest);
}
