#include "cloth/energy/pulls.h"

#include "cloth/energy/energy.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* ---- Triangles ---- */

struct placed {
    uint32_t edges[3], lane; /* its membrane's: batch * TL_BATCH + lane */
};

static uint32_t lowest_edge(const struct placed *placed)
{
    const uint32_t *e = placed->edges;
    uint32_t low = e[0] < e[1] ? e[0] : e[1];
    return low < e[2] ? low : e[2];
}

static int compare_placed(const void *a, const void *b)
{
    uint32_t left = lowest_edge(a), right = lowest_edge(b);
    if (left == right) {
        left = ((const struct placed *)a)->lane;
        right = ((const struct placed *)b)->lane;
    }
    return left < right ? -1 : left > right;
}

static void place_metric(const struct tl_energy *energy, const struct placed *placed,
                         struct tl_metric *metric, size_t lane)
{
    const struct tl_membrane *from = &energy->membranes[placed->lane / TL_BATCH];
    for (int i = 0; i < 3; i++)
        metric->edges[i][lane] = placed->edges[i];
    for (int i = 0; i < 2; i++) {
        metric->c[i][lane] = from->c[i][placed->lane % TL_BATCH];
        metric->d[i][lane] = from->d[i][placed->lane % TL_BATCH];
    }
    metric->area[lane] = from->area[placed->lane % TL_BATCH];
}

/* In the order of their edges, so that neighbours in memory are neighbours in the cloth. */
static void build_metrics(struct tl_pulls *pulls, const struct tl_topology *topology,
                          const struct tl_energy *energy)
{
    struct placed *placed = TL_NEW_ARRAY(struct placed, energy->membrane_count * TL_BATCH);
    size_t count = 0;
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++) {
        const struct tl_membrane *m = &energy->membranes[i / TL_BATCH];
        if (!(m->area[i % TL_BATCH] > 0))
            continue;
        placed[count].lane = (uint32_t)i;
        for (int k = 0; k < 3; k++)
            placed[count].edges[k] = tl_topology_edge(topology, m->vertices[(k + 1) % 3][i % TL_BATCH],
                                                      m->vertices[(k + 2) % 3][i % TL_BATCH]);
        count++;
    }
    qsort(placed, count, sizeof *placed, compare_placed);
    pulls->metric_count = (count + TL_BATCH - 1) / TL_BATCH;
    pulls->metrics = tl_alloc_lines(pulls->metric_count, sizeof *pulls->metrics);
    for (size_t i = 0; i < count; i++)
        place_metric(energy, &placed[i], &pulls->metrics[i / TL_BATCH], i % TL_BATCH);
    free(placed);
}

/* Which triangles pull along each edge. */
static void build_slots(struct tl_pulls *pulls)
{
    uint32_t nothing = (uint32_t)(pulls->metric_count * 3 * TL_BATCH);
    pulls->slots = tl_alloc(pulls->edge_count, sizeof *pulls->slots);
    pulls->excess = tl_alloc(nothing, sizeof *pulls->excess);
    for (size_t e = 0; e < pulls->edge_count; e++)
        pulls->slots[e][0] = pulls->slots[e][1] = nothing;
    for (uint32_t entry = 0; entry < nothing; entry++) {
        const struct tl_metric *metric = &pulls->metrics[entry / (3 * TL_BATCH)];
        uint32_t corner = entry / TL_BATCH % 3, lane = entry % TL_BATCH;
        if (!(metric->area[lane] > 0))
            continue;
        uint32_t edge = metric->edges[corner][lane];
        if (pulls->slots[edge][0] == nothing) {
            pulls->slots[edge][0] = entry;
        } else if (pulls->slots[edge][1] == nothing) {
            pulls->slots[edge][1] = entry;
        } else {
            uint32_t *excess = pulls->excess[pulls->excess_count++];
            excess[0] = edge;
            excess[1] = entry;
        }
    }
}

/* ---- Rows ---- */

/* Corners of the bends' stencils, without those that stand in for missing ones, around each vertex. */
struct stencils {
    uint32_t *corners; /* [bend_count * TL_BATCH][TL_BEND_STENCIL]; vertex_count where there is none */
    struct tl_fans fans;
};

static struct stencils list_stencils(const struct tl_energy *energy, size_t vertex_count)
{
    size_t count = energy->bend_count * TL_BATCH * TL_BEND_STENCIL;
    struct stencils stencils = {.corners = TL_NEW_ARRAY(uint32_t, count)};
    for (size_t i = 0; i < count; i++) {
        size_t lane = i / TL_BEND_STENCIL % TL_BATCH, corner = i % TL_BEND_STENCIL;
        const struct tl_bend *bend = &energy->bends[i / TL_BEND_STENCIL / TL_BATCH];
        bool acts = false;
        for (int row = 0; row < 3; row++)
            acts |= bend->rows[row][corner][lane] != 0;
        stencils.corners[i] = acts ? bend->vertices[corner][lane] : (uint32_t)vertex_count;
    }
    stencils.fans = tl_fans_build(stencils.corners, count, vertex_count + 1);
    return stencils;
}

static void release_stencils(struct stencils *stencils)
{
    free(stencils->corners);
    tl_fans_release(&stencils->fans);
}

/* Pairs of bending alone are found twice: first counted, then written. */
struct finder {
    struct tl_pulls *pulls;
    const struct stencils *stencils;
    uint32_t *seen; /* [vertex_count] last vertex in whose row it was, plus 1 */
    uint32_t count;
    bool write;
};

static void build_along(struct tl_pulls *pulls)
{
    struct tl_fans ends = tl_fans_build(pulls->edges[0], 2 * pulls->edge_count, pulls->vertex_count);
    pulls->along = TL_NEW_ARRAY(struct tl_along, 2 * pulls->edge_count);
    for (size_t k = 0; k < 2 * pulls->edge_count; k++) {
        uint32_t end = ends.items[k];
        pulls->along[k].other = pulls->edges[end / 2][1 - end % 2];
        pulls->along[k].edge = end / 2;
    }
    pulls->along_first = ends.first;
    free(ends.items);
}

static void find_other(struct finder *finder, uint32_t vertex, uint32_t other)
{
    if (other == finder->pulls->vertex_count || finder->seen[other] == vertex + 1)
        return;
    finder->seen[other] = vertex + 1;
    if (finder->write)
        finder->pulls->others[finder->count] = other;
    finder->count++;
}

static void find_others(struct finder *finder, uint32_t vertex)
{
    const struct tl_pulls *pulls = finder->pulls;
    const struct tl_fans *fans = &finder->stencils->fans;
    finder->seen[vertex] = vertex + 1;
    for (uint32_t k = pulls->along_first[vertex]; k < pulls->along_first[vertex + 1]; k++)
        finder->seen[pulls->along[k].other] = vertex + 1;
    for (uint32_t k = fans->first[vertex]; k < fans->first[vertex + 1]; k++) {
        const uint32_t *corners =
            &finder->stencils->corners[(size_t)(fans->items[k] / TL_BEND_STENCIL) * TL_BEND_STENCIL];
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            find_other(finder, vertex, corners[i]);
    }
}

static void build_others(struct tl_pulls *pulls, const struct stencils *stencils)
{
    pulls->others_first = TL_NEW_ARRAY(uint32_t, pulls->vertex_count + 1);
    for (int pass = 0; pass < 2; pass++) {
        struct finder finder = {pulls, stencils, TL_NEW_ARRAY(uint32_t, pulls->vertex_count), 0, pass == 1};
        for (uint32_t i = 0; i < pulls->vertex_count; i++) {
            find_others(&finder, i);
            pulls->others_first[i + 1] = finder.count;
        }
        free(finder.seen);
        if (pass == 0)
            pulls->others = TL_NEW_ARRAY(uint32_t, finder.count);
    }
    pulls->bending = TL_NEW_ARRAY(double, pulls->others_first[pulls->vertex_count]);
}

/* A vertex's others along edges, then those of bending alone. */
static uint32_t other_end(const struct tl_pulls *pulls, uint32_t vertex, uint32_t k)
{
    uint32_t along = pulls->along_first[vertex + 1] - pulls->along_first[vertex];
    return k < along ? pulls->along[pulls->along_first[vertex] + k].other
                     : pulls->others[pulls->others_first[vertex] + k - along];
}

static double other_bending(const struct tl_pulls *pulls, uint32_t vertex, uint32_t k)
{
    uint32_t along = pulls->along_first[vertex + 1] - pulls->along_first[vertex];
    return k < along ? pulls->edge_bending[pulls->along[pulls->along_first[vertex] + k].edge]
                     : pulls->bending[pulls->others_first[vertex] + k - along];
}

static uint32_t count_pulls(const struct tl_pulls *pulls, uint32_t vertex)
{
    return pulls->along_first[vertex + 1] - pulls->along_first[vertex] + pulls->others_first[vertex + 1] -
           pulls->others_first[vertex];
}

static void build_fours(struct tl_pulls *pulls)
{
    pulls->fours_first = TL_NEW_ARRAY(uint32_t, pulls->vertex_count + 1);
    for (uint32_t i = 0; i < pulls->vertex_count; i++)
        pulls->fours_first[i + 1] =
            pulls->fours_first[i] + (count_pulls(pulls, i) + TL_PULLS_FOUR - 1) / TL_PULLS_FOUR;
    pulls->fours = TL_NEW_ARRAY(struct tl_four_pulls, pulls->fours_first[pulls->vertex_count]);
}

static void set_fours(struct tl_pulls *pulls)
{
    for (uint32_t i = 0; i < pulls->vertex_count; i++) {
        uint32_t count = count_pulls(pulls, i), first = pulls->fours_first[i];
        uint32_t end = (pulls->fours_first[i + 1] - first) * TL_PULLS_FOUR;
        for (uint32_t k = 0; k < end; k++) {
            struct tl_four_pulls *four = &pulls->fours[first + k / TL_PULLS_FOUR];
            four->from[k % TL_PULLS_FOUR] = 4 * (k < count ? other_end(pulls, i, k) : i);
            four->bending[k % TL_PULLS_FOUR] = k < count ? other_bending(pulls, i, k) : 0;
        }
    }
}

/* Where a row keeps each vertex's number; an edge's is kept by its lower end, and NULL for the other. */
static void list_entries(struct tl_pulls *pulls, uint32_t vertex, double **entries)
{
    for (uint32_t k = pulls->along_first[vertex]; k < pulls->along_first[vertex + 1]; k++) {
        const struct tl_along *along = &pulls->along[k];
        entries[along->other] = vertex < along->other ? &pulls->edge_bending[along->edge] : NULL;
    }
    for (uint32_t k = pulls->others_first[vertex]; k < pulls->others_first[vertex + 1]; k++)
        entries[pulls->others[k]] = &pulls->bending[k];
}

/* Adds -A k_r R_ri R_rj over the stencils around vertex i. From either end of a pair the same products come
 * in the same order, so the matrix is symmetric to the last bit. */
static void add_row(const struct tl_pulls *pulls, const struct tl_energy *energy,
                    const struct stencils *stencils, const double stiffness[3], uint32_t vertex,
                    double *const *entries)
{
    const struct tl_fans *fans = &stencils->fans;
    for (uint32_t f = fans->first[vertex]; f < fans->first[vertex + 1]; f++) {
        size_t corner = fans->items[f] % TL_BEND_STENCIL, element = fans->items[f] / TL_BEND_STENCIL;
        const struct tl_bend *bend = &energy->bends[element / TL_BATCH];
        size_t lane = element % TL_BATCH;
        for (size_t i = 0; i < TL_BEND_STENCIL; i++) {
            uint32_t other = stencils->corners[element * TL_BEND_STENCIL + i];
            if (other == pulls->vertex_count || other == vertex || !entries[other])
                continue;
            for (int row = 0; row < 3; row++)
                *entries[other] -= stiffness[row] * bend->area[lane] *
                                   (bend->rows[row][corner][lane] * bend->rows[row][i][lane]);
        }
    }
}

void tl_pulls_set(struct tl_pulls *pulls, const struct tl_energy *energy, const double stiffness[3])
{
    struct stencils stencils = list_stencils(energy, pulls->vertex_count);
    double **entries = TL_NEW_ARRAY(double *, pulls->vertex_count);
    memset(pulls->edge_bending, 0, pulls->edge_count * sizeof *pulls->edge_bending);
    memset(pulls->bending, 0, pulls->others_first[pulls->vertex_count] * sizeof *pulls->bending);
    for (uint32_t i = 0; i < pulls->vertex_count; i++) {
        list_entries(pulls, i, entries);
        add_row(pulls, energy, &stencils, stiffness, i, entries);
    }
    free(entries);
    release_stencils(&stencils);
    set_fours(pulls);
}

/* ---- The whole ---- */

struct tl_pulls tl_pulls_build(const struct tl_topology *topology, const struct tl_energy *energy)
{
    struct tl_pulls pulls = {.vertex_count = topology->vertex_count, .edge_count = topology->edge_count};
    pulls.edges = tl_alloc(pulls.edge_count, sizeof *pulls.edges);
    memcpy(pulls.edges, topology->edges, pulls.edge_count * sizeof *pulls.edges);
    build_metrics(&pulls, topology, energy);
    build_slots(&pulls);
    pulls.link_edges = TL_NEW_ARRAY(uint32_t, energy->link_count);
    for (size_t i = 0; i < energy->link_count; i++)
        pulls.link_edges[i] = tl_topology_edge(topology, energy->links[i].a, energy->links[i].b);
    struct stencils stencils = list_stencils(energy, pulls.vertex_count);
    build_along(&pulls);
    build_others(&pulls, &stencils);
    build_fours(&pulls);
    release_stencils(&stencils);

    size_t blocks = (pulls.vertex_count + TL_PULLS_BLOCK - 1) / TL_PULLS_BLOCK;
    pulls.edge_bending = TL_NEW_ARRAY(double, pulls.edge_count);
    pulls.places = tl_alloc_lines(4 * (pulls.vertex_count + 1), sizeof *pulls.places);
    pulls.squared = TL_NEW_ARRAY(double, pulls.edge_count);
    pulls.shares = TL_NEW_ARRAY(double, pulls.metric_count * 3 * TL_BATCH + 1);
    pulls.along_edges = TL_NEW_ARRAY(double, pulls.edge_count);
    pulls.sums = tl_alloc_lines(pulls.vertex_count, sizeof *pulls.sums);
    pulls.parts = TL_NEW_ARRAY(double, pulls.metric_count + blocks);
    return pulls;
}

void tl_pulls_release(struct tl_pulls *pulls)
{
    free(pulls->edges);
    free(pulls->metrics);
    free(pulls->slots);
    free(pulls->excess);
    free(pulls->link_edges);
    free(pulls->edge_bending);
    free(pulls->along_first);
    free(pulls->others_first);
    free(pulls->along);
    free(pulls->others);
    free(pulls->bending);
    free(pulls->fours_first);
    free(pulls->fours);
    free(pulls->places);
    free(pulls->squared);
    free(pulls->shares);
    free(pulls->along_edges);
    free(pulls->sums);
    free(pulls->parts);
    *pulls = (struct tl_pulls){0};
}
