#include "cloth/solvers/implicit/factor.h"

#include "config/memory.h"
#include "config/simd.h"

#include <suitesparse/cholmod.h>

#include <stdlib.h>
#include <string.h>

/* Pivots below this share of the largest entry are rounding. */
#define MIN_PIVOT 1e-14
/* Of more vertices the factor costs more than it saves, or does not fit into memory: the diagonal alone. */
#define MAX_VERTICES 300000

/* Neighbouring columns of L with the same rows below them: these are read, and their unknowns too, once for
 * all of them. Rows are the panel's part's own, then the top's, which are counted from its first. */
#define MAX_PANEL_WIDTH 4
struct panel {
    uint32_t column, width; /* of the first; 1, 2 or 4 */
    uint32_t own_count, top_count;
    size_t rows;   /* where they begin in the factor's rows */
    size_t values; /* where these begin: 1 / D, L between the columns, L below row by row */
};

/* x, y, z of an unknown, so that a wide register takes it at once. */
struct unknown {
    double x, y, z, unused;
};

/* The panels of a part of the elimination tree need nothing of other parts; what they have in common, its
 * top, comes last. The parts do not depend on the number of threads, and what they add to the top is summed
 * in their order. */
#define PARTS 8
struct tl_factor {
    size_t count, top_first; /* unknowns */
    size_t ends[PARTS + 1];  /* the panel after each part's last, and the top's */
    struct panel *panels;
    uint32_t *rows;
    double *values;
    uint32_t *order;      /* [count] the vertex of each unknown */
    struct unknown *work; /* [count] in the factor's order */
    struct unknown *tops; /* [PARTS][count - top_first] what parts add to the top */
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
    size_t capacity = (size_t)9 * TL_BATCH * energy->membrane_count + stiffness->bends.first[count] +
                      3 * (energy->link_count + springs->count) + count;
    sum->entries = cholmod_allocate_triplet(count, count, capacity, lower, CHOLMOD_REAL, common);
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
    common->dbound = MIN_PIVOT * largest;
    cholmod_factor *factor = matrix ? cholmod_analyze(matrix, common) : NULL;
    bool good = factor && cholmod_factorize(matrix, factor, common);
    cholmod_free_sparse(&matrix, common);
    if (!good)
        cholmod_free_factor(&factor, common);
    return factor;
}

/* ---- Panels ---- */

/* The factor as it is taken over. */
struct layout {
    const cholmod_factor *from;
    size_t panel_count;
    uint32_t *columns, *widths; /* [panel_count] in the order of `from` */
    size_t *parts;              /* [panel_count] PARTS: the top */
    uint32_t *places;           /* [count] each column's in the new order */
    uint32_t *panel_of;         /* [count] */
};

static uint32_t rows_below(const struct layout *layout, size_t panel)
{
    const int *used = layout->from->nz;
    return (uint32_t)used[layout->columns[panel]] - layout->widths[panel];
}

/* The rows below a panel. */
static const int *rows_of(const struct layout *layout, size_t panel)
{
    const int *first = layout->from->p, *rows = layout->from->i;
    return rows + first[layout->columns[panel]] + layout->widths[panel];
}

/* Whether the column after `column` has the same rows but for its own. */
static bool continues_panel(const cholmod_factor *from, size_t column)
{
    const int *first = from->p, *used = from->nz, *rows = from->i;
    size_t next = column + 1;
    return next < from->n && used[column] == used[next] + 1 &&
           memcmp(rows + first[column] + 1, rows + first[next], (size_t)used[next] * sizeof *rows) == 0;
}

static void find_panels(struct layout *layout)
{
    size_t count = layout->from->n;
    for (size_t column = 0; column < count;) {
        uint32_t width = 1;
        while (width < MAX_PANEL_WIDTH && continues_panel(layout->from, column + width - 1))
            width++;
        width = width == 3 ? 2 : width;
        for (uint32_t k = 0; k < width; k++)
            layout->panel_of[column + k] = (uint32_t)layout->panel_count;
        layout->columns[layout->panel_count] = (uint32_t)column;
        layout->widths[layout->panel_count++] = width;
        column += width;
    }
}

/* Branches of the tree with no more than their share of the work are dealt out in their order. */
static void find_parts(struct layout *layout)
{
    size_t *work = TL_NEW_ARRAY(size_t, layout->panel_count), all = 0, dealt = 0;
    for (size_t p = 0; p < layout->panel_count; p++) { /* children come before their parent */
        size_t own = (size_t)layout->widths[p] * (layout->widths[p] + rows_below(layout, p));
        work[p] += own;
        all += own;
        if (rows_below(layout, p) > 0)
            work[layout->panel_of[rows_of(layout, p)[0]]] += work[p];
    }
    for (size_t p = layout->panel_count; p-- > 0;) { /* parents before their children */
        size_t parent = rows_below(layout, p) > 0 ? layout->panel_of[rows_of(layout, p)[0]] : SIZE_MAX;
        if (work[p] > all / PARTS) {
            layout->parts[p] = PARTS;
        } else if (parent == SIZE_MAX || layout->parts[parent] == PARTS) {
            layout->parts[p] = dealt * PARTS / (all + 1);
            dealt += work[p];
        } else {
            layout->parts[p] = layout->parts[parent];
        }
    }
    free(work);
}

static void fill_panel(tl_factor *factor, const struct layout *layout, size_t p, struct panel *panel)
{
    const int *first = layout->from->p, *rows = rows_of(layout, p);
    const double *values = layout->from->x;
    uint32_t column = layout->columns[p], row_count = rows_below(layout, p);
    double *to = factor->values + panel->values;
    for (uint32_t k = 0; k < panel->width; k++)
        *to++ = 1 / values[first[column + k]];
    for (uint32_t k = 0; k < panel->width; k++)
        for (uint32_t i = k + 1; i < panel->width; i++)
            *to++ = values[first[column + k] + (int)(i - k)];
    for (uint32_t e = 0; e < row_count; e++) {
        uint32_t place = layout->places[rows[e]];
        bool own = place < factor->top_first;
        factor->rows[panel->rows + e] = own ? place : place - (uint32_t)factor->top_first;
        panel->own_count += own;
        panel->top_count += !own;
        for (uint32_t k = 0; k < panel->width; k++)
            *to++ = values[first[column + k] + (int)(panel->width - k + e)];
    }
}

/* The columns' new order: part by part, the top last, each as before. */
static void place_columns(tl_factor *factor, struct layout *layout)
{
    const int *order = layout->from->Perm;
    uint32_t place = 0;
    for (size_t part = 0; part <= PARTS; part++) {
        if (part == PARTS)
            factor->top_first = place;
        for (size_t p = 0; p < layout->panel_count; p++)
            for (uint32_t k = 0; layout->parts[p] == part && k < layout->widths[p]; k++) {
                factor->order[place] = (uint32_t)order[layout->columns[p] + k];
                layout->places[layout->columns[p] + k] = place++;
            }
    }
}

static void fill_panels(tl_factor *factor, const struct layout *layout)
{
    size_t made = 0, row_count = 0, value_count = 0;
    for (size_t part = 0; part <= PARTS; part++) {
        for (size_t p = 0; p < layout->panel_count; p++) {
            if (layout->parts[p] != part)
                continue;
            struct panel *panel = &factor->panels[made++];
            *panel = (struct panel){.column = layout->places[layout->columns[p]],
                                    .width = layout->widths[p],
                                    .rows = row_count,
                                    .values = value_count};
            fill_panel(factor, layout, p, panel);
            row_count += rows_below(layout, p);
            value_count +=
                (size_t)panel->width * (panel->width + 1) / 2 + (size_t)rows_below(layout, p) * panel->width;
        }
        factor->ends[part] = made;
    }
}

static tl_factor *copy_factor(const cholmod_factor *from)
{
    size_t count = from->n, entry_count = 0;
    const int *used = from->nz;
    for (size_t j = 0; j < count; j++)
        entry_count += (size_t)used[j];
    struct layout layout = {.from = from,
                            .columns = TL_NEW_ARRAY(uint32_t, count),
                            .widths = TL_NEW_ARRAY(uint32_t, count),
                            .parts = TL_NEW_ARRAY(size_t, count),
                            .places = TL_NEW_ARRAY(uint32_t, count),
                            .panel_of = TL_NEW_ARRAY(uint32_t, count)};
    find_panels(&layout);
    find_parts(&layout);
    tl_factor *factor = TL_NEW(tl_factor);
    factor->count = count;
    factor->panels = TL_NEW_ARRAY(struct panel, layout.panel_count);
    factor->rows = TL_NEW_ARRAY(uint32_t, entry_count);
    factor->values = TL_NEW_ARRAY(double, entry_count);
    factor->order = TL_NEW_ARRAY(uint32_t, count);
    factor->work = TL_NEW_ARRAY(struct unknown, count);
    place_columns(factor, &layout);
    fill_panels(factor, &layout);
    factor->tops = TL_NEW_ARRAY(struct unknown, PARTS * (count - factor->top_first));
    free(layout.columns);
    free(layout.widths);
    free(layout.parts);
    free(layout.places);
    free(layout.panel_of);
    return factor;
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
    for (int diagonal = stiffness->vertex_count > MAX_VERTICES; !whole && diagonal < 2; diagonal++) {
        struct sum sum = {.inverse_masses = inverse_masses, .diagonal = diagonal};
        cholmod_sparse *matrix = sum_up(energy, fabric, springs, stiffness, h, &sum, &common);
        whole = factorise(matrix, sum.largest, &common);
    }
    if (!whole)
        abort(); /* out of memory for the diagonal, as in tl_alloc */
    tl_factor *factor = copy_factor(whole);
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
    free((*factor)->tops);
    free(*factor);
    *factor = NULL;
}

/* ---- Solving ---- */

#define CACHE_LINE        64
#define PREFETCH_DISTANCE 4 /* panels */

/* a - b s */
TL_INLINE struct unknown subtract_scaled(struct unknown a, struct unknown b, double s)
{
    return (struct unknown){a.x - b.x * s, a.y - b.y * s, a.z - b.z * s, a.unused - b.unused * s};
}

TL_INLINE void subtract_products(const uint32_t *rows, uint32_t count, const double *values, uint32_t width,
                                 const struct unknown *known, struct unknown *to)
{
    for (uint32_t e = 0; e < count; e++, values += width) {
        struct unknown sum = to[rows[e]];
        for (uint32_t k = 0; k < width; k++)
            sum = subtract_scaled(sum, known[k], values[k]);
        to[rows[e]] = sum;
    }
}

/* L y = r, for the unknowns of a panel and what they add to those below. */
TL_INLINE void solve_panel_forward(const tl_factor *factor, const struct panel *panel, uint32_t width,
                                   struct unknown *y, struct unknown *top)
{
    const double *values = factor->values + panel->values + width;
    const uint32_t *rows = factor->rows + panel->rows;
    struct unknown known[MAX_PANEL_WIDTH];
    for (uint32_t k = 0; k < width; k++)
        known[k] = y[panel->column + k];
    for (uint32_t k = 0; k < width; k++)
        for (uint32_t i = k + 1; i < width; i++)
            known[i] = subtract_scaled(known[i], known[k], *values++);
    for (uint32_t k = 0; k < width; k++)
        y[panel->column + k] = known[k];
    subtract_products(rows, panel->own_count, values, width, known, y);
    subtract_products(rows + panel->own_count, panel->top_count, values + (size_t)width * panel->own_count,
                      width, known, top);
}

TL_INLINE void gather(const uint32_t *rows, uint32_t count, const double *values, uint32_t width,
                      const struct unknown *from, struct unknown *sums)
{
    for (uint32_t e = 0; e < count; e++, values += width) {
        struct unknown known = from[rows[e]];
        for (uint32_t k = 0; k < width; k++)
            sums[k] = subtract_scaled(sums[k], known, values[k]);
    }
}

/* D L^T z = y. */
TL_INLINE void solve_panel_backward(const tl_factor *factor, const struct panel *panel, uint32_t width,
                                    struct unknown *y)
{
    const double *values = factor->values + panel->values, *inner = values + width;
    const double *below = inner + (size_t)width * (width - 1) / 2;
    const uint32_t *rows = factor->rows + panel->rows;
    struct unknown sums[MAX_PANEL_WIDTH];
    for (uint32_t k = 0; k < width; k++) {
        struct unknown own = y[panel->column + k];
        sums[k] = (struct unknown){own.x * values[k], own.y * values[k], own.z * values[k], 0};
    }
    gather(rows, panel->own_count, below, width, y, sums);
    gather(rows + panel->own_count, panel->top_count, below + (size_t)width * panel->own_count, width,
           y + factor->top_first, sums);
    for (uint32_t k = width; k-- > 0;) {
        const double *column =
            inner + (size_t)k * width - (size_t)k * (k + 1) / 2; /* of L between the columns */
        for (uint32_t i = k + 1; i < width; i++)
            sums[k] = subtract_scaled(sums[k], sums[i], column[i - k - 1]);
        y[panel->column + k] = sums[k];
    }
}

/* `top`: where what is taken from the top's unknowns goes. */
TL_CLONES static void solve_part_forward(const tl_factor *factor, size_t part, struct unknown *y,
                                         struct unknown *top)
{
    for (size_t p = part > 0 ? factor->ends[part - 1] : 0; p < factor->ends[part]; p++) {
        const struct panel *panel = &factor->panels[p];
        if (panel->width == 4)
            solve_panel_forward(factor, panel, 4, y, top);
        else if (panel->width == 2)
            solve_panel_forward(factor, panel, 2, y, top);
        else
            solve_panel_forward(factor, panel, 1, y, top);
    }
}

/* Panels are read last first, which no cache foresees. */
TL_INLINE void prefetch_panel(const tl_factor *factor, const struct panel *panel)
{
    const char *values = (const char *)(factor->values + panel->values);
    const char *rows = (const char *)(factor->rows + panel->rows);
    uint32_t row_count = panel->own_count + panel->top_count;
    size_t bytes = (size_t)row_count * panel->width * sizeof(double);
    for (size_t line = 0; line < bytes; line += CACHE_LINE)
        __builtin_prefetch(values + line);
    for (size_t line = 0; line < row_count * sizeof(uint32_t); line += CACHE_LINE)
        __builtin_prefetch(rows + line);
}

TL_CLONES static void solve_part_backward(const tl_factor *factor, size_t part, struct unknown *y)
{
    size_t first = part > 0 ? factor->ends[part - 1] : 0;
    for (size_t p = factor->ends[part]; p-- > first;) {
        const struct panel *panel = &factor->panels[p];
        if (p >= first + PREFETCH_DISTANCE)
            prefetch_panel(factor, panel - PREFETCH_DISTANCE);
        if (panel->width == 4)
            solve_panel_backward(factor, panel, 4, y);
        else if (panel->width == 2)
            solve_panel_backward(factor, panel, 2, y);
        else
            solve_panel_backward(factor, panel, 1, y);
    }
}

static void solve_top(const tl_factor *factor)
{
    struct unknown *y = factor->work, *top = y + factor->top_first;
    size_t top_count = factor->count - factor->top_first;
    for (size_t part = 0; part < PARTS; part++)
        for (size_t i = 0; i < top_count; i++)
            top[i] = subtract_scaled(top[i], factor->tops[part * top_count + i], -1);
    solve_part_forward(factor, PARTS, y, top);
    solve_part_backward(factor, PARTS, y);
}

/* The three right-hand sides at once: L is read once for all. */
void tl_factor_solve(tl_factor *factor, const vec3d *r, vec3d *z)
{
    struct unknown *y = factor->work;
    size_t top_count = factor->count - factor->top_first;
#pragma omp parallel if (factor->count > TL_PARALLEL_ROWS)
    {
        unsigned denormals = tl_denormals_off();
#pragma omp for schedule(static)
        for (size_t j = 0; j < factor->count; j++) {
            vec3d own = r[factor->order[j]];
            y[j] = (struct unknown){own.x, own.y, own.z, 0};
        }
#pragma omp for schedule(dynamic)
        for (size_t part = 0; part < PARTS; part++) {
            struct unknown *top = factor->tops + part * top_count;
            memset(top, 0, top_count * sizeof *top);
            solve_part_forward(factor, part, y, top);
        }
#pragma omp single
        solve_top(factor);
#pragma omp for schedule(dynamic)
        for (size_t part = 0; part < PARTS; part++)
            solve_part_backward(factor, part, y);
#pragma omp for schedule(static)
        for (size_t j = 0; j < factor->count; j++)
            z[factor->order[j]] = (vec3d){y[j].x, y[j].y, y[j].z};
        tl_denormals_restore(denormals);
    }
}
