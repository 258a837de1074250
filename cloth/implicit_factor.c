#include "cloth/implicit_factor.h"

#include "config/memory.h"

#include <suitesparse/cholmod.h>

#include <stdlib.h>

/* Pivots below this share of the largest entry are rounding. */
#define LEAST_PIVOT 1e-14
/* Of more vertices the factor costs more than it saves, or does not fit into memory: the diagonal alone. */
#define MOST_VERTICES 300000

struct tl_factor {
    cholmod_common common;
    cholmod_factor *factor; /* L D L^T, D on L's diagonal */
    vec3d *work;            /* [vertex_count] in the factor's order */
};

/* The matrix as it is summed up: entries may repeat. */
struct sum {
    cholmod_triplet *entries;
    const double *inverse_masses;
    double largest;
    bool diagonal; /* leave out the rest */
};

static void add_entry(struct sum *sum, uint32_t row, uint32_t column, double value)
{
    cholmod_triplet *entries = sum->entries;
    bool free_ends = sum->inverse_masses[row] > 0 && sum->inverse_masses[column] > 0;
    if (column > row || (sum->diagonal && column != row) || !free_ends || !(fabs(value) > 0))
        return;
    ((int *)entries->i)[entries->nnz] = (int)row;
    ((int *)entries->j)[entries->nnz] = (int)column;
    ((double *)entries->x)[entries->nnz++] = value;
    sum->largest = fmax(sum->largest, value);
}

static void add_membranes(struct sum *sum, const struct tl_energy *energy,
                          const struct tl_cloth_fabric *fabric)
{
    double weft = fabric->stretch_weft + fabric->shear, warp = fabric->stretch_warp + fabric->shear;
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++) {
        const struct tl_membrane *m = &energy->membranes[i / TL_BATCH];
        size_t lane = i % TL_BATCH;
        for (int a = 0; a < 3 && m->area[lane] > 0; a++)
            for (int b = 0; b < 3; b++)
                add_entry(sum, m->vertices[a][lane], m->vertices[b][lane],
                          m->area[lane] *
                              (weft * m->c[a][lane] * m->c[b][lane] + warp * m->d[a][lane] * m->d[b][lane]));
    }
}

static void add_rows(struct sum *sum, const struct tl_stiffness *stiffness)
{
    for (size_t v = 0; v < stiffness->vertex_count; v++)
        for (uint32_t e = stiffness->bends.first[v]; e < stiffness->bends.first[v + 1]; e++)
            add_entry(sum, (uint32_t)v, stiffness->bends.columns[e], stiffness->bend_values[e]);
}

static void add_links(struct sum *sum, const struct tl_link *links, size_t count, double stiffness)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t a = links[i].a, b = links[i].b;
        add_entry(sum, a, a, stiffness);
        add_entry(sum, b, b, stiffness);
        add_entry(sum, a > b ? a : b, a > b ? b : a, -stiffness);
    }
}

static void add_masses(struct sum *sum, size_t vertex_count, double h)
{
    cholmod_triplet *entries = sum->entries;
    for (size_t v = 0; v < vertex_count; v++) {
        double w = sum->inverse_masses[v];
        ((int *)entries->i)[entries->nnz] = ((int *)entries->j)[entries->nnz] = (int)v;
        ((double *)entries->x)[entries->nnz++] = w > 0 ? 1 / (w * h * h) : 1;
    }
}

static cholmod_sparse *sum_up(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                              const struct tl_springs *springs, const struct tl_stiffness *stiffness,
                              double h, struct sum *sum, cholmod_common *common)
{
    const int lower = -1; /* CHOLMOD's word for it */
    size_t count = stiffness->vertex_count;
    size_t most = (size_t)9 * TL_BATCH * energy->membrane_count + stiffness->bends.first[count] +
                  3 * (energy->link_count + springs->count) + count;
    sum->entries = cholmod_allocate_triplet(count, count, most, lower, CHOLMOD_REAL, common);
    if (!sum->entries)
        return NULL;
    add_membranes(sum, energy, fabric);
    add_rows(sum, stiffness);
    add_links(sum, energy->links, energy->link_count, fabric->stretch_warp);
    add_links(sum, springs->links, springs->count, springs->stiffness);
    add_masses(sum, count, h);
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(sum->entries, 0, common);
    cholmod_free_triplet(&sum->entries, common);
    return matrix;
}

/* Whether it fits into memory. */
static bool factorise(tl_factor *factor, cholmod_sparse *matrix, double largest)
{
    cholmod_common *common = &factor->common;
    common->dbound = LEAST_PIVOT * largest;
    factor->factor = matrix ? cholmod_analyze(matrix, common) : NULL;
    bool good = factor->factor && cholmod_factorize(matrix, factor->factor, common);
    cholmod_free_sparse(&matrix, common);
    if (!good)
        cholmod_free_factor(&factor->factor, common);
    return good;
}

tl_factor *tl_factor_create(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                            const struct tl_springs *springs, const struct tl_stiffness *stiffness,
                            const double *inverse_masses, double h)
{
    tl_factor *factor = TL_NEW(tl_factor);
    cholmod_common *common = &factor->common;
    bool good = false;
    cholmod_start(common);
    common->print = 0;                       /* stdout is for results */
    common->supernodal = CHOLMOD_SIMPLICIAL; /* no BLAS: its sums may depend on the threads */
    for (int diagonal = stiffness->vertex_count > MOST_VERTICES; !good && diagonal < 2; diagonal++) {
        struct sum sum = {.inverse_masses = inverse_masses, .diagonal = diagonal};
        cholmod_sparse *matrix = sum_up(energy, fabric, springs, stiffness, h, &sum, common);
        good = factorise(factor, matrix, sum.largest);
    }
    if (!good)
        abort(); /* out of memory for the diagonal, as in tl_alloc */
    factor->work = TL_NEW_ARRAY(vec3d, stiffness->vertex_count);
    return factor;
}

void tl_factor_destroy(tl_factor **factor)
{
    if (!*factor)
        return;
    cholmod_free_factor(&(*factor)->factor, &(*factor)->common);
    cholmod_finish(&(*factor)->common);
    free((*factor)->work);
    free(*factor);
    *factor = NULL;
}

/* The three right-hand sides at once: L is read once for all. */
void tl_factor_solve(tl_factor *factor, const vec3d *r, vec3d *z)
{
    const int *order = factor->factor->Perm, *first = factor->factor->p, *used = factor->factor->nz;
    const int *rows = factor->factor->i;
    const double *values = factor->factor->x;
    size_t count = factor->factor->n;
    vec3d *y = factor->work;
    for (size_t j = 0; j < count; j++)
        y[j] = r[order[j]];
    for (size_t j = 0; j < count; j++) {
        vec3d known = y[j];
        for (int e = first[j] + 1; e < first[j] + used[j]; e++)
            y[rows[e]] = vec3d_muladd(y[rows[e]], known, -values[e]);
    }
    for (size_t j = count; j-- > 0;) {
        vec3d sum = vec3d_scale(y[j], 1 / values[first[j]]);
        for (int e = first[j] + 1; e < first[j] + used[j]; e++)
            sum = vec3d_muladd(sum, y[rows[e]], -values[e]);
        y[j] = sum;
    }
    for (size_t j = 0; j < count; j++)
        z[order[j]] = y[j];
}
