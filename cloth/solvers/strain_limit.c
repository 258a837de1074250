#include "cloth/solvers/strain_limit.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Edges that exceed the limit at the start are shortened at this speed, in rest lengths per second. At once,
 * the correction would become a velocity that grows as the substep shrinks. */
#define CORRECTION_SPEED 1.0

/* A triangle is near the limit if some direction in it is strained by this share of the limit. */
#define NEAR 0.75

/* Flags that are tested together. */
#define WORD 8
_Static_assert(WORD == TL_BATCH && sizeof(bool) == 1, "eight flags are read as 64 bits");

void tl_strain_limits_restart(struct tl_strain_limits *limits, const vec3d *x)
{
    limits->elapsed_s = 0;
    limits->any_corrected = false;
    memset(limits->corrected, 0, limits->count * sizeof(bool));
    for (size_t e = 0; e < limits->count; e++)
        limits->edges[e].start_length =
            vec3d_distance(x[limits->edges[e].ends[0]], x[limits->edges[e].ends[1]]);
}

static void list_edges(struct tl_strain_limits *limits, const struct tl_topology *topology,
                       const vec2s (*rest)[3], double shortest)
{
    for (size_t e = 0; e < topology->edge_count; e++)
        limits->edges[e] = (struct tl_limited_edge){.ends = {topology->edges[e][0], topology->edges[e][1]},
                                                    .rest = HUGE_VAL};
    for (size_t t = topology->triangle_count;
         t-- > 0;) /* backwards, so that the first triangle of an edge decides */
        for (int corner = 0; corner < 3; corner++) {
            int a = (corner + 1) % 3, b = (corner + 2) % 3;
            const uint32_t *vertices = topology->triangles[t];
            double length = (double)glms_vec2_distance(rest[t][a], rest[t][b]);
            limits->edges[tl_topology_edge(topology, vertices[a], vertices[b])].rest =
                length > shortest ? length : HUGE_VAL;
        }
}

/* Empty lanes keep edge 0; they are never marked. */
static void list_sides(struct tl_strain_limits *limits, const struct tl_topology *topology,
                       const struct tl_energy *energy)
{
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++) {
        const struct tl_membrane *m = &energy->membranes[i / TL_BATCH];
        size_t lane = i % TL_BATCH;
        for (int k = 0; k < 3 && m->area[lane] > 0; k++)
            limits->sides[i / TL_BATCH][k][lane] =
                tl_topology_edge(topology, m->vertices[(k + 1) % 3][lane], m->vertices[(k + 2) % 3][lane]);
    }
}

struct tl_strain_limits tl_strain_limits_create(const struct tl_topology *topology,
                                                const struct tl_energy *energy, const vec2s (*rest)[3],
                                                double shortest, double strain, const vec3d *x)
{
    size_t count = topology->edge_count, words = (count + WORD - 1) / WORD;
    struct tl_strain_limits limits = {
        .strain = strain,
        .count = count,
        .edges = TL_NEW_ARRAY(struct tl_limited_edge, count),
        .due = TL_NEW_ARRAY(bool, words *WORD),
        .always = TL_NEW_ARRAY(bool, words *WORD),
        .corrected = TL_NEW_ARRAY(bool, words *WORD),
        .sides = tl_alloc(energy->membrane_count, sizeof *limits.sides),
        .watch = {.max = (1 + NEAR * strain) * (1 + NEAR * strain),
                  .seen = tl_alloc(energy->membrane_count, sizeof *limits.watch.seen)}};
    list_edges(&limits, topology, rest, shortest);
    tl_strain_limits_restart(&limits, x);
    list_sides(&limits, topology, energy);
    for (size_t i = 0; i < energy->link_count; i++) /* slivers have no membrane that could mark them */
        limits.always[energy->pairs.link_edges[i]] = true;
    return limits;
}

void tl_strain_limits_release(struct tl_strain_limits *limits)
{
    free(limits->edges);
    free(limits->due);
    free(limits->always);
    free(limits->corrected);
    free(limits->sides);
    free(limits->watch.seen);
    *limits = (struct tl_strain_limits){0};
}

/* Whether no flag of a word is set, the usual case. */
static bool none(const bool flags[WORD])
{
    uint64_t bits;
    memcpy(&bits, flags, sizeof bits);
    return bits == 0;
}

static void mark_corrected(struct tl_strain_limits *limits)
{
    for (size_t first = 0; first < limits->count; first += WORD) {
        if (none(&limits->corrected[first]))
            continue;
        for (size_t e = first; e < first + WORD; e++)
            limits->due[e] = limits->due[e] || limits->corrected[e];
        memset(&limits->corrected[first], 0, WORD * sizeof(bool));
    }
}

/* Marks the edges to be tested; returns whether there are any. */
static bool mark(struct tl_strain_limits *limits, const struct tl_energy *energy)
{
    bool any = energy->link_count > 0 || limits->any_corrected;
    memcpy(limits->due, limits->always, limits->count * sizeof(bool));
    if (limits->any_corrected)
        mark_corrected(limits);
    for (size_t i = 0; i < energy->membrane_count; i++) {
        const bool *seen = limits->watch.seen[i];
        if (none(seen))
            continue;
        any = true;
        for (int lane = 0; lane < TL_BATCH; lane++)
            for (int k = 0; k < 3 && seen[lane]; k++)
                limits->due[limits->sides[i][k][lane]] = true;
    }
    return any;
}

/* Marks all edges at a vertex. */
static void mark_vertex(struct tl_strain_limits *limits, const struct tl_pair_forces *pairs, uint32_t vertex)
{
    for (uint32_t k = pairs->incident_first[vertex]; k < pairs->incident_first[vertex + 1]; k++)
        limits->due[pairs->incident[k].edge] = true;
}

TL_INLINE bool is_long(const struct tl_strain_limits *limits, const struct tl_limited_edge *edge,
                       const vec3d *x)
{
    vec3d offset = vec3d_sub(x[edge->ends[1]], x[edge->ends[0]]);
    double max = (1 + limits->strain) * edge->rest;
    return vec3d_dot(offset, offset) > max * max;
}

/* Shortens one edge that is too long; returns whether it moved. Its neighbours may become longer by it, so
 * they are marked too. */
static bool correct_edge(struct tl_strain_limits *limits, const struct tl_pair_forces *pairs,
                         const struct tl_limited_edge *edge, struct tl_particles *particles)
{
    uint32_t a = edge->ends[0], b = edge->ends[1];
    vec3d offset = vec3d_sub(particles->x[b], particles->x[a]);
    double squared = vec3d_dot(offset, offset), sum = particles->w[a] + particles->w[b];
    double max = fmax((1 + limits->strain) * edge->rest,
                      edge->start_length - CORRECTION_SPEED * edge->rest * limits->elapsed_s);
    if (!(squared > max * max) || !(sum > 0))
        return false;
    vec3d push = vec3d_scale(offset, (1 - max / sqrt(squared)) / sum);
    particles->x[a] = vec3d_muladd(particles->x[a], push, particles->w[a]);
    particles->x[b] = vec3d_muladd(particles->x[b], push, -particles->w[b]);
    mark_vertex(limits, pairs, a);
    mark_vertex(limits, pairs, b);
    limits->corrected[edge - limits->edges] = true;
    return true;
}

/* One sweep through the list; returns whether anything moved. A tested edge is tested again only if an end of
 * it moves. */
static bool sweep(struct tl_strain_limits *limits, const struct tl_pair_forces *pairs, bool back,
                  struct tl_particles *particles)
{
    bool any = false;
    size_t words = (limits->count + WORD - 1) / WORD;
    for (size_t i = 0; i < words; i++) {
        size_t first = WORD * (back ? words - 1 - i : i);
        if (none(&limits->due[first]))
            continue;
        for (size_t k = 0; k < WORD; k++) {
            size_t e = first + (back ? WORD - 1 - k : k);
            if (!limits->due[e])
                continue;
            limits->due[e] = false;
            if (is_long(limits, &limits->edges[e], particles->x))
                any = correct_edge(limits, pairs, &limits->edges[e], particles) || any;
        }
    }
    return any;
}

void tl_strain_limits_solve(struct tl_strain_limits *limits, const struct tl_energy *energy, double h,
                            struct tl_particles *particles)
{
    limits->elapsed_s += h;
    limits->any_corrected = mark(limits, energy) && sweep(limits, &energy->pairs, false, particles);
    if (limits->any_corrected)
        (void)sweep(limits, &energy->pairs, true, particles);
}
