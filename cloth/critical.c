/* How stiff the energy is: the longest stable step of an explicit solver. */
#include "cloth/energy.h"
#include "config/memory.h"

#include <stdlib.h>

/* Adds to each vertex its row of |K| for an energy k/2 |sum rows x|^2. */
static void add_rows(const double *rows, size_t stride, const uint32_t *vertices, size_t count,
                     double stiffness, double *sums)
{
    double total = 0;
    for (size_t i = 0; i < count; i++)
        total += fabs(rows[i * stride]);
    for (size_t i = 0; i < count; i++)
        sums[vertices[i * TL_BATCH]] += stiffness * fabs(rows[i * stride]) * total;
}

static void add_membrane_rows(const struct tl_membrane *m, size_t lane, const struct tl_cloth_fabric *fabric,
                              double *sums)
{
    double area = m->area[lane], shear[3 * TL_BATCH] = {0};
    for (int i = 0; i < 3; i++)
        shear[i * TL_BATCH] = fabs(m->c[i][lane]) + fabs(m->d[i][lane]);
    add_rows(&m->c[0][lane], TL_BATCH, &m->vertices[0][lane], 3, area * fabric->stretch_weft, sums);
    add_rows(&m->d[0][lane], TL_BATCH, &m->vertices[0][lane], 3, area * fabric->stretch_warp, sums);
    add_rows(shear, TL_BATCH, &m->vertices[0][lane], 3, area * fabric->shear, sums);
}

double tl_energy_critical_step(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                               size_t vertex_count, const double *inverse_masses)
{
    double stiffness[3], fastest = 0;
    double *sums = TL_NEW_ARRAY(double, vertex_count + 1);
    tl_bend_stiffness(fabric, stiffness);
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++)
        add_membrane_rows(&energy->membranes[i / TL_BATCH], i % TL_BATCH, fabric, sums);
    for (size_t i = 0; i < energy->bend_count * TL_BATCH; i++) {
        const struct tl_bend *bend = &energy->bends[i / TL_BATCH];
        size_t lane = i % TL_BATCH;
        for (int row = 0; row < 3; row++)
            add_rows(&bend->rows[row][0][lane], TL_BATCH, &bend->vertices[0][lane], TL_BEND_STENCIL,
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
