#include "cloth/implicit_factor.h"

#include "config/memory.h"
#include "config/simd.h"

#include <suitesparse/cholmod.h>

#include <stdlib.h>
#include <string.h>

/* Pivots below this share of the largest entry are rounding. */
#define LEAST_PIVOT 1e-14
/* Of more vertices the factor costs more than it saves, or does not fit into memory: the diagonal alone. */
#define MOST_VERTICES 300000

/* Neighbouring columns of L with the same rows below them: these are read, and their unknowns too, once for
 * all of them. */
#define WIDEST 4
struct panel {
    uint32_t column, width; /* of the first; 1, 2 or 4 */
    uint32_t row_count;     /* below */
    size_t rows;            /* where they begin in the factor's rows */
    size_t values;          /* where these begin: 1 / D, L between the columns, L below row by row */
};

/* x, y, z of an unknown, so that a wide register takes it at once. */
struct unknown {
    double x, y, z, unused;
};

struct tl_factor {
    size_t count, panel_count;
    struct panel *panels;
    uint32_t *rows;
    double *values;
    uint32_t *order;      /* [count] the vertex of each unknown */
    struct unknown *work; /* [count] in the factor's order */
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

/* L D L^T with D on L's diagonal; NULL: it does not fit into memory. */
static cholmod_factor *factorise(cholmod_sparse *matrix, double largest, cholmod_common *common)
{
    common->dbound = LEAST_PIVOT * largest;
    cholmod_factor *factor = matrix ? cholmod_analyze(matrix, common) : NULL;
    bool good = factor && cholmod_factorize(matrix, factor, common);
    cholmod_free_sparse(&matrix, common);
    if (!good)
        cholmod_free_factor(&factor, common);
    return factor;
}

/* ---- Panels ---- */

/* Whether the column after `column` has the same rows but for its own. */
static bool goes_on(const cholmod_factor *from, size_t column)
{
    const int *first = from->p, *used = from->nz, *rows = from->i;
    size_t next = column + 1;
    return next < from->n && used[column] == used[next] + 1 &&
           memcmp(rows + first[column] + 1, rows + first[next], (size_t)used[next] * sizeof *rows) == 0;
}

static uint32_t panel_width(const cholmod_factor *from, size_t column)
{
    uint32_t width = 1;
    while (width < WIDEST && goes_on(from, column + width - 1))
        width++;
    return width == 3 ? 2 : width;
}

static void fill_panel(tl_factor *factor, const cholmod_factor *from, const struct panel *panel)
{
    const int *first = from->p, *rows = from->i;
    const double *values = from->x;
    double *to = factor->values + panel->values;
    for (uint32_t k = 0; k < panel->width; k++)
        *to++ = 1 / values[first[panel->column + k]];
    for (uint32_t k = 0; k < panel->width; k++)
        for (uint32_t i = k + 1; i < panel->width; i++)
            *to++ = values[first[panel->column + k] + (int)(i - k)];
    for (uint32_t e = 0; e < panel->row_count; e++) {
        factor->rows[panel->rows + e] = (uint32_t)rows[first[panel->column] + (int)(panel->width + e)];
        for (uint32_t k = 0; k < panel->width; k++)
            *to++ = values[first[panel->column + k] + (int)(panel->width - k + e)];
    }
}

static void make_panels(tl_factor *factor, const cholmod_factor *from)
{
    const int *used = from->nz, *order = from->Perm;
    size_t row_count = 0, value_count = 0;
    factor->count = from->n;
    factor->panels = TL_NEW_ARRAY(struct panel, factor->count);
    for (size_t j = 0; j < factor->count;) {
        struct panel panel = {(uint32_t)j, panel_width(from, j), 0, row_count, value_count};
        panel.row_count = (uint32_t)used[j] - panel.width;
        row_count += panel.row_count;
        value_count += (size_t)panel.width * (panel.width + 1) / 2 + (size_t)panel.row_count * panel.width;
        factor->panels[factor->panel_count++] = panel;
        j += panel.width;
    }
    factor->rows = TL_NEW_ARRAY(uint32_t, row_count);
    factor->values = TL_NEW_ARRAY(double, value_count);
    factor->order = TL_NEW_ARRAY(uint32_t, factor->count);
    factor->work = TL_NEW_ARRAY(struct unknown, factor->count);
    for (size_t j = 0; j < factor->count; j++)
        factor->order[j] = (uint32_t)order[j];
    for (size_t i = 0; i < factor->panel_count; i++)
        fill_panel(factor, from, &factor->panels[i]);
}

tl_factor *tl_factor_create(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                            const struct tl_springs *springs, const struct tl_stiffness *stiffness,
                            const double *inverse_masses, double h)
{
    cholmod_common common;
    cholmod_factor *whole = NULL;
    cholmod_start(&common);
    common.print = 0;                       /* stdout is for results */
    common.supernodal = CHOLMOD_SIMPLICIAL; /* no BLAS: its sums may depend on the threads */
    for (int diagonal = stiffness->vertex_count > MOST_VERTICES; !whole && diagonal < 2; diagonal++) {
        struct sum sum = {.inverse_masses = inverse_masses, .diagonal = diagonal};
        cholmod_sparse *matrix = sum_up(energy, fabric, springs, stiffness, h, &sum, &common);
        whole = factorise(matrix, sum.largest, &common);
    }
    if (!whole)
        abort(); /* out of memory for the diagonal, as in tl_alloc */
    tl_factor *factor = TL_NEW(tl_factor);
    make_panels(factor, whole);
    cholmod_free_factor(&whole, &common);
    cholmod_finish(&common);
    return factor;
}

void tl_factor_destroy(tl_factor **factor)
{
    if (!*factor)
        return;
    free((*factor)->panels);
    free((*factor)->rows);
    free((*factor)->values);
    free((*factor)->order);
    free((*factor)->work);
    free(*factor);
    *factor = NULL;
}

/* ---- Solving ---- */

/* a - b s */
TL_INLINE struct unknown less(struct unknown a, struct unknown b, double s)
{
    return (struct unknown){a.x - b.x * s, a.y - b.y * s, a.z - b.z * s, a.unused - b.unused * s};
}

/* L y = r, for the unknowns of a panel and what they add to those below. */
TL_INLINE void go_down(const tl_factor *factor, const struct panel *panel, uint32_t width, struct unknown *y)
{
    const double *values = factor->values + panel->values + width;
    const uint32_t *rows = factor->rows + panel->rows;
    struct unknown known[WIDEST];
    for (uint32_t k = 0; k < width; k++)
        known[k] = y[panel->column + k];
    for (uint32_t k = 0; k < width; k++)
        for (uint32_t i = k + 1; i < width; i++)
            known[i] = less(known[i], known[k], *values++);
    for (uint32_t k = 0; k < width; k++)
        y[panel->column + k] = known[k];
    for (uint32_t e = 0; e < panel->row_count; e++, values += width) {
        struct unknown sum = y[rows[e]];
        for (uint32_t k = 0; k < width; k++)
            sum = less(sum, known[k], values[k]);
        y[rows[e]] = sum;
    }
}

/* D L^T z = y. */
TL_INLINE void go_up(const tl_factor *factor, const struct panel *panel, uint32_t width, struct unknown *y)
{
    const double *values = factor->values + panel->values, *inner = values + width;
    const double *below = inner + width * (width - 1) / 2;
    const uint32_t *rows = factor->rows + panel->rows;
    struct unknown sums[WIDEST];
    for (uint32_t k = 0; k < width; k++) {
        struct unknown own = y[panel->column + k];
        sums[k] = (struct unknown){own.x * values[k], own.y * values[k], own.z * values[k], 0};
    }
    for (uint32_t e = 0; e < panel->row_count; e++, below += width) {
        struct unknown known = y[rows[e]];
        for (uint32_t k = 0; k < width; k++)
            sums[k] = less(sums[k], known, below[k]);
    }
    for (uint32_t k = width; k-- > 0;) {
        const double *column = inner + k * width - k * (k + 1) / 2; /* of L between the columns */
        for (uint32_t i = k + 1; i < width; i++)
            sums[k] = less(sums[k], sums[i], column[i - k - 1]);
        y[panel->column + k] = sums[k];
    }
}

TL_CLONES static void solve_down(const tl_factor *factor, struct unknown *y)
{
    for (const struct panel *panel = factor->panels; panel < factor->panels + factor->panel_count; panel++)
        if (panel->width == 4)
            go_down(factor, panel, 4, y);
        else if (panel->width == 2)
            go_down(factor, panel, 2, y);
        else
            go_down(factor, panel, 1, y);
}

TL_CLONES static void solve_up(const tl_factor *factor, struct unknown *y)
{
    for (const struct panel *panel = factor->panels + factor->panel_count; panel-- > factor->panels;)
        if (panel->width == 4)
            go_up(factor, panel, 4, y);
        else if (panel->width == 2)
            go_up(factor, panel, 2, y);
        else
            go_up(factor, panel, 1, y);
}

/* The three right-hand sides at once: L is read once for all. */
void tl_factor_solve(tl_factor *factor, const vec3d *r, vec3d *z)
{
    struct unknown *y = factor->work;
    for (size_t j = 0; j < factor->count; j++) {
        vec3d own = r[factor->order[j]];
        y[j] = (struct unknown){own.x, own.y, own.z, 0};
    }
    solve_down(factor, y);
    solve_up(factor, y);
    for (size_t j = 0; j < factor->count; j++)
        z[factor->order[j]] = (vec3d){y[j].x, y[j].y, y[j].z};
}
