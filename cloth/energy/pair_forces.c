#include "cloth/energy/pair_forces.h"

#include "cloth/energy/energy.h"
#include "config/base/memory.h"

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

/* Sorted by their lowest edge, so that neighbours in memory are neighbours in the cloth. */
static void build_metrics(struct tl_pair_forces *pairs, const struct tl_topology *topology,
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
    pairs->metric_count = (count + TL_BATCH - 1) / TL_BATCH;
    pairs->metrics = tl_alloc_lines(pairs->metric_count, sizeof *pairs->metrics);
    for (size_t i = 0; i < count; i++)
        place_metric(energy, &placed[i], &pairs->metrics[i / TL_BATCH], i % TL_BATCH);
    free(placed);
}

/* Finds the triangles that contribute to each edge. */
static void build_slots(struct tl_pair_forces *pairs)
{
    uint32_t nothing = (uint32_t)(pairs->metric_count * 3 * TL_BATCH);
    pairs->slots = tl_alloc(pairs->edge_count, sizeof *pairs->slots);
    pairs->excess = tl_alloc(nothing, sizeof *pairs->excess);
    for (size_t e = 0; e < pairs->edge_count; e++)
        pairs->slots[e][0] = pairs->slots[e][1] = nothing;
    for (uint32_t entry = 0; entry < nothing; entry++) {
        const struct tl_metric *metric = &pairs->metrics[entry / (3 * TL_BATCH)];
        uint32_t corner = entry / TL_BATCH % 3, lane = entry % TL_BATCH;
        if (!(metric->area[lane] > 0))
            continue;
        uint32_t edge = metric->edges[corner][lane];
        if (pairs->slots[edge][0] == nothing) {
            pairs->slots[edge][0] = entry;
        } else if (pairs->slots[edge][1] == nothing) {
            pairs->slots[edge][1] = entry;
        } else {
            uint32_t *excess = pairs->excess[pairs->excess_count++];
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

/* Pairs that only bending connects are found in two passes: the first counts, the second writes. */
struct finder {
    struct tl_pair_forces *pairs;
    const struct stencils *stencils;
    uint32_t *seen; /* [vertex_count] last vertex in whose row it was, plus 1 */
    uint32_t count;
    bool write;
};

static void build_along(struct tl_pair_forces *pairs)
{
    struct tl_fans ends = tl_fans_build(pairs->edges[0], 2 * pairs->edge_count, pairs->vertex_count);
    pairs->incident = TL_NEW_ARRAY(struct tl_incident_edge, 2 * pairs->edge_count);
    for (size_t k = 0; k < 2 * pairs->edge_count; k++) {
        uint32_t end = ends.items[k];
        pairs->incident[k].other = pairs->edges[end / 2][1 - end % 2];
        pairs->incident[k].edge = end / 2;
    }
    pairs->incident_first = ends.first;
    free(ends.items);
}

static void find_other(struct finder *finder, uint32_t vertex, uint32_t other)
{
    if (other == finder->pairs->vertex_count || finder->seen[other] == vertex + 1)
        return;
    finder->seen[other] = vertex + 1;
    if (finder->write)
        finder->pairs->others[finder->count] = other;
    finder->count++;
}

static void find_others(struct finder *finder, uint32_t vertex)
{
    const struct tl_pair_forces *pairs = finder->pairs;
    const struct tl_fans *fans = &finder->stencils->fans;
    finder->seen[vertex] = vertex + 1;
    for (uint32_t k = pairs->incident_first[vertex]; k < pairs->incident_first[vertex + 1]; k++)
        finder->seen[pairs->incident[k].other] = vertex + 1;
    for (uint32_t k = fans->first[vertex]; k < fans->first[vertex + 1]; k++) {
        const uint32_t *corners =
            &finder->stencils->corners[(size_t)(fans->items[k] / TL_BEND_STENCIL) * TL_BEND_STENCIL];
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            find_other(finder, vertex, corners[i]);
    }
}

static void build_others(struct tl_pair_forces *pairs, const struct stencils *stencils)
{
    pairs->others_first = TL_NEW_ARRAY(uint32_t, pairs->vertex_count + 1);
    for (int pass = 0; pass < 2; pass++) {
        struct finder finder = {pairs, stencils, TL_NEW_ARRAY(uint32_t, pairs->vertex_count), 0, pass == 1};
        for (uint32_t i = 0; i < pairs->vertex_count; i++) {
            find_others(&finder, i);
            pairs->others_first[i + 1] = finder.count;
        }
        free(finder.seen);
        if (pass == 0)
            pairs->others = TL_NEW_ARRAY(uint32_t, finder.count);
    }
    pairs->bending = TL_NEW_ARRAY(double, pairs->others_first[pairs->vertex_count]);
}

/* A vertex's others along edges, then those of bending alone. */
static uint32_t other_end(const struct tl_pair_forces *pairs, uint32_t vertex, uint32_t k)
{
    uint32_t incident = pairs->incident_first[vertex + 1] - pairs->incident_first[vertex];
    return k < incident ? pairs->incident[pairs->incident_first[vertex] + k].other
                        : pairs->others[pairs->others_first[vertex] + k - incident];
}

static double other_strength(const struct tl_pair_forces *pairs, uint32_t vertex, uint32_t k, bool bends)
{
    const uint32_t incident = pairs->incident_first[vertex + 1] - pairs->incident_first[vertex];
    if (k >= incident)
        return bends ? pairs->bending[pairs->others_first[vertex] + k - incident] : 0;
    const uint32_t edge = pairs->incident[pairs->incident_first[vertex] + k].edge;
    return pairs->prestress[edge] + (bends ? pairs->edge_bending[edge] : 0);
}

static uint32_t count_pairs(const struct tl_pair_forces *pairs, uint32_t vertex)
{
    return pairs->incident_first[vertex + 1] - pairs->incident_first[vertex] +
           pairs->others_first[vertex + 1] - pairs->others_first[vertex];
}

static void build_packs(struct tl_pair_forces *pairs)
{
    pairs->packs_first = TL_NEW_ARRAY(uint32_t, pairs->vertex_count + 1);
    for (uint32_t i = 0; i < pairs->vertex_count; i++)
        pairs->packs_first[i + 1] =
            pairs->packs_first[i] + (count_pairs(pairs, i) + TL_PAIR_PACK - 1) / TL_PAIR_PACK;
    pairs->packs = TL_NEW_ARRAY(struct tl_pair_pack, pairs->packs_first[pairs->vertex_count]);
}

void tl_pair_forces_set_packs(struct tl_pair_forces *pairs, bool bends)
{
    for (uint32_t i = 0; i < pairs->vertex_count; i++) {
        uint32_t count = count_pairs(pairs, i), first = pairs->packs_first[i];
        uint32_t end = (pairs->packs_first[i + 1] - first) * TL_PAIR_PACK;
        for (uint32_t k = 0; k < end; k++) {
            struct tl_pair_pack *pack = &pairs->packs[first + k / TL_PAIR_PACK];
            pack->from[k % TL_PAIR_PACK] = 4 * (k < count ? other_end(pairs, i, k) : i);
            pack->strengths[k % TL_PAIR_PACK] = k < count ? other_strength(pairs, i, k, bends) : 0;
        }
    }
}

/* Fills `entries` [vertex] with the address of the coefficient of each pair (vertex, other). The lower end of
 * an edge writes the coefficient; for the higher end the entry is NULL. */
static void list_entries(struct tl_pair_forces *pairs, uint32_t vertex, double **entries)
{
    for (uint32_t k = pairs->incident_first[vertex]; k < pairs->incident_first[vertex + 1]; k++) {
        const struct tl_incident_edge *incident = &pairs->incident[k];
        entries[incident->other] = vertex < incident->other ? &pairs->edge_bending[incident->edge] : NULL;
    }
    for (uint32_t k = pairs->others_first[vertex]; k < pairs->others_first[vertex + 1]; k++)
        entries[pairs->others[k]] = &pairs->bending[k];
}

/* Adds -A k_r R_ri R_rj over the stencils around vertex i. From either end of a pair the same products come
 * in the same order, so the matrix is symmetric to the last bit. */
static void add_row(const struct tl_pair_forces *pairs, const struct tl_energy *energy,
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
            if (other == pairs->vertex_count || other == vertex || !entries[other])
                continue;
            for (int row = 0; row < 3; row++)
                *entries[other] -= stiffness[row] * bend->area[lane] *
                                   (bend->rows[row][corner][lane] * bend->rows[row][i][lane]);
        }
    }
}

void tl_pair_forces_set(struct tl_pair_forces *pairs, const struct tl_energy *energy,
                        const double stiffness[3])
{
    struct stencils stencils = list_stencils(energy, pairs->vertex_count);
    double **entries = TL_NEW_ARRAY(double *, pairs->vertex_count);
    memset(pairs->edge_bending, 0, pairs->edge_count * sizeof *pairs->edge_bending);
    memset(pairs->bending, 0, pairs->others_first[pairs->vertex_count] * sizeof *pairs->bending);
    for (uint32_t i = 0; i < pairs->vertex_count; i++) {
        list_entries(pairs, i, entries);
        add_row(pairs, energy, &stencils, stiffness, i, entries);
    }
    free(entries);
    release_stencils(&stencils);
}

/* ---- The whole ---- */

struct tl_pair_forces tl_pair_forces_build(const struct tl_topology *topology, const struct tl_energy *energy)
{
    struct tl_pair_forces pairs = {.vertex_count = topology->vertex_count,
                                   .edge_count = topology->edge_count};
    pairs.edges = tl_alloc(pairs.edge_count, sizeof *pairs.edges);
    memcpy(pairs.edges, topology->edges, pairs.edge_count * sizeof *pairs.edges);
    build_metrics(&pairs, topology, energy);
    build_slots(&pairs);
    pairs.link_edges = TL_NEW_ARRAY(uint32_t, energy->link_count);
    for (size_t i = 0; i < energy->link_count; i++)
        pairs.link_edges[i] = tl_topology_edge(topology, energy->links[i].a, energy->links[i].b);
    struct stencils stencils = list_stencils(energy, pairs.vertex_count);
    build_along(&pairs);
    build_others(&pairs, &stencils);
    build_packs(&pairs);
    release_stencils(&stencils);

    size_t blocks = (pairs.vertex_count + TL_PAIR_BLOCK - 1) / TL_PAIR_BLOCK;
    pairs.edge_bending = TL_NEW_ARRAY(double, pairs.edge_count);
    pairs.prestress = TL_NEW_ARRAY(double, pairs.edge_count);
    pairs.positions = tl_alloc_lines(4 * (pairs.vertex_count + 1), sizeof *pairs.positions);
    pairs.squared = TL_NEW_ARRAY(double, pairs.edge_count);
    pairs.shares = TL_NEW_ARRAY(double, pairs.metric_count * 3 * TL_BATCH + 1);
    pairs.edge_strengths = TL_NEW_ARRAY(double, pairs.edge_count);
    pairs.sums = tl_alloc_lines(pairs.vertex_count, sizeof *pairs.sums);
    pairs.parts = TL_NEW_ARRAY(double, pairs.metric_count + blocks);
    return pairs;
}

void tl_pair_forces_release(struct tl_pair_forces *pairs)
{
    free(pairs->edges);
    free(pairs->metrics);
    free(pairs->slots);
    free(pairs->excess);
    free(pairs->link_edges);
    free(pairs->edge_bending);
    free(pairs->prestress);
    free(pairs->incident_first);
    free(pairs->others_first);
    free(pairs->incident);
    free(pairs->others);
    free(pairs->bending);
    free(pairs->packs_first);
    free(pairs->packs);
    free(pairs->positions);
    free(pairs->squared);
    free(pairs->shares);
    free(pairs->edge_strengths);
    free(pairs->sums);
    free(pairs->parts);
    *pairs = (struct tl_pair_forces){0};
}
