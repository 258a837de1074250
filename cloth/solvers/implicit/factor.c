#include "cloth/solvers/implicit/factor.h"

#include "cloth/mesh/denormals.h"
#include "cloth/solvers/implicit/factor_shim.h"
#include "config/base/memory.h"
#include "config/base/simd.h"

#include <stdlib.h>
#include <string.h>

/* Pivots below this share of the largest matrix entry are rounding errors. */
#define MIN_PIVOT 1e-14
/* With more vertices the factor costs more than it saves, or does not fit into memory: only the diagonal is
 * used. */
#define MAX_VERTICES 300000

/* A panel: neighbouring columns of L with the same rows below them (a small supernode). The row indices and
 * the unknowns of those rows are read once for all its columns. Rows of the panel's own part come first, then
 * those of the top, which are counted from the top's first. */
#define MAX_PANEL_WIDTH 4
struct panel {
    uint32_t column, width; /* of the first; 1, 2 or 4 */
    uint32_t own_count, top_count;
    size_t rows;   /* where they begin in the factor's rows */
    size_t values; /* where its values begin: 1 / D, L between its columns, L below row by row */
};

/* x, y, z of an unknown, padded to a wide register. */
struct unknown {
    double x, y, z, unused;
};

/* The elimination tree is cut into PARTS groups of branches and the common top. Panels of one part depend on
 * no other part, so parts are solved in parallel; their contributions to the top are summed in the order of
 * the parts. The number of parts is fixed, so that sums do not depend on the number of threads. */
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

/* The matrix as the sum of its terms: several may be of one entry. */
struct sum {
    struct tl_triplet *terms;
    size_t count;
    const double *inverse_masses;
    double largest;
    bool diagonal; /* leave out all other entries */
};

static void add_entry(struct sum *sum, uint32_t row, uint32_t column, double value)
{
    bool free_ends = sum->inverse_masses[row] > 0 && sum->inverse_masses[column] > 0;
    if (column > row || (sum->diagonal && column != row) || !free_ends || !(fabs(value) > 0))
        return;
    sum->terms[sum->count++] = (struct tl_triplet){(int)row, (int)column, value};
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

/* A held particle has a row of its own with 1 on the diagonal: its residual is filtered out anyway. */
static void add_masses(struct sum *sum, size_t vertex_count, double h)
{
    for (size_t v = 0; v < vertex_count; v++) {
        double w = sum->inverse_masses[v];
        sum->terms[sum->count++] = (struct tl_triplet){(int)v, (int)v, w > 0 ? 1 / (w * h * h) : 1};
    }
}

static void add_terms(struct sum *sum, const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                      const struct tl_springs *springs, const struct tl_stiffness *stiffness, double h)
{
    size_t count = stiffness->vertex_count;
    size_t capacity = (size_t)9 * TL_BATCH * energy->membrane_count + stiffness->bends.first[count] +
                      3 * (energy->link_count + springs->count) + count;
    sum->terms = TL_NEW_ARRAY(struct tl_triplet, capacity);
    add_membranes(sum, energy, fabric);
    add_rows(sum, stiffness);
    add_links(sum, energy->links, energy->link_count, fabric->stretch_warp);
    add_links(sum, springs->links, springs->count, springs->stiffness);
    add_masses(sum, count, h);
}

/* ---- Panels ---- */

/* Divides the columns of Eigen's factor into panels and parts. */
struct layout {
    const struct tl_sparse_factor *from;
    size_t panel_count;
    uint32_t *columns, *widths; /* [panel_count] in the order of `from` */
    size_t *parts;              /* [panel_count] PARTS: the top */
    uint32_t *places;           /* [count] each column's in the new order */
    uint32_t *panel_of;         /* [count] */
};

static uint32_t column_size(const struct tl_sparse_factor *from, size_t column)
{
    return (uint32_t)(from->first[column + 1] - from->first[column]);
}

/* The number of rows of a panel below its own columns. */
static uint32_t rows_below(const struct layout *layout, size_t panel)
{
    return column_size(layout->from, layout->columns[panel]) - (layout->widths[panel] - 1);
}

/* Those rows, rising. */
static const int *rows_of(const struct layout *layout, size_t panel)
{
    return layout->from->rows + layout->from->first[layout->columns[panel]] + (layout->widths[panel] - 1);
}

/* Whether the column after `column` has the same rows but for its own. */
static bool continues_panel(const struct tl_sparse_factor *from, size_t column)
{
    size_t next = column + 1;
    if (next >= from->count || column_size(from, column) != column_size(from, next) + 1)
        return false;
    const int *rows = from->rows + from->first[column];
    return rows[0] == (int)next &&
           memcmp(rows + 1, from->rows + from->first[next], column_size(from, next) * sizeof *rows) == 0;
}

static void find_panels(struct layout *layout)
{
    size_t count = layout->from->count;
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

/* Deals branches whose work is at most 1 / PARTS of all to the parts, in order; nodes with more work are the
 * top. */
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
    const int *first = layout->from->first, *rows = rows_of(layout, p);
    const double *values = layout->from->values;
    uint32_t column = layout->columns[p], row_count = rows_below(layout, p);
    double *to = factor->values + panel->values;
    for (uint32_t k = 0; k < panel->width; k++)
        *to++ = 1 / layout->from->pivots[column + k];
    for (uint32_t k = 0; k < panel->width; k++)
        for (uint32_t i = k + 1; i < panel->width; i++)
            *to++ = values[first[column + k] + (int)(i - k - 1)];
    for (uint32_t e = 0; e < row_count; e++) {
        uint32_t place = layout->places[rows[e]];
        bool own = place < factor->top_first;
        factor->rows[panel->rows + e] = own ? place : place - (uint32_t)factor->top_first;
        panel->own_count += own;
        panel->top_count += !own;
        for (uint32_t k = 0; k < panel->width; k++)
            *to++ = values[first[column + k] + (int)(panel->width - k - 1 + e)];
    }
}

/* The columns' new order: part by part, the top last, each as before. */
static void place_columns(tl_factor *factor, struct layout *layout)
{
    const int *order = layout->from->order;
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

static tl_factor *copy_factor(const struct tl_sparse_factor *from)
{
    size_t count = from->count, entry_count = (size_t)from->first[count];
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
    factor->values = TL_NEW_ARRAY(double, entry_count + count); /* and D */
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
    size_t count = stiffness->vertex_count;
    struct tl_sparse_factor whole = {0};
    bool made = false;
    for (int diagonal = count > MAX_VERTICES; !made && diagonal < 2; diagonal++) {
        struct sum sum = {.inverse_masses = inverse_masses, .diagonal = diagonal};
        add_terms(&sum, energy, fabric, springs, stiffness, h);
        made = tl_sparse_factor_create(count, sum.terms, sum.count, MIN_PIVOT * sum.largest, &whole);
        free(sum.terms);
    }
    if (!made)
        abort(); /* out of memory for the diagonal, as in tl_alloc */
    tl_factor *factor = copy_factor(&whole);
    tl_sparse_factor_release(&whole);
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

/* Forward substitution L y = r for a panel: solves its unknowns and subtracts them from the rows below. */
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

/* Back substitution D L^T z = y for a panel. */
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

/* `top` collects what the part subtracts from the top's unknowns. */
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

/* Back substitution reads panels last first, which hardware prefetchers do not predict. */
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

/* Solves for x, y and z together, so that L, the bulk of the memory traffic, is read once for all three. */
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
