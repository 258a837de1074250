/* The tensions that `preview` exerts whatever its rows do: see energy.h. */
#include "cloth/energy/energy.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The explicit force of a tension is stable while h^2 w times twice the sum of a vertex's strengths, a bound
 * of the square of its phase a step, is at most this. Triangles at a vertex where more is needed hold a share
 * of their tension, and their rows solve the rest. */
#define STABLE_PHASE_SQUARED 4

/* A thread that is crushed to a point has no direction. */
#define NO_LENGTH 1e-12

static void measure(const struct tl_membrane *m, size_t lane, const vec3d *x, double strains[3])
{
    vec3d u = {0}, v = {0};
    for (int i = 0; i < 3; i++) {
        u = vec3d_muladd(u, x[m->vertices[i][lane]], m->c[i][lane]);
        v = vec3d_muladd(v, x[m->vertices[i][lane]], m->d[i][lane]);
    }
    const double length_u = fmax(vec3d_norm(u), NO_LENGTH), length_v = fmax(vec3d_norm(v), NO_LENGTH);
    strains[0] = length_u - 1;
    strains[1] = length_v - 1;
    strains[2] = vec3d_dot(u, v) / (length_u * length_v);
}

/* The share of its tension that each vertex [vertex_count] allows. */
static double *find_shares(const struct tl_pair_forces *pairs, const double *inverse_masses, double h)
{
    double *shares = TL_NEW_ARRAY(double, pairs->vertex_count);
    for (size_t e = 0; e < pairs->edge_count; e++)
        for (int end = 0; end < 2; end++)
            shares[pairs->edges[e][end]] += 2 * fabs(pairs->prestress[e]);
    for (size_t i = 0; i < pairs->vertex_count; i++) {
        const double needed = h * h * inverse_masses[i] * shares[i];
        shares[i] = needed > STABLE_PHASE_SQUARED ? STABLE_PHASE_SQUARED / needed : 1;
    }
    return shares;
}

static double lowest_of(const double *shares, uint32_t a, uint32_t b, uint32_t c)
{
    return fmin(shares[a], fmin(shares[b], shares[c]));
}

/* Sums by edge what the triangles have put into `shares`. */
static void sum_by_edge(struct tl_pair_forces *pairs)
{
    for (size_t e = 0; e < pairs->edge_count; e++)
        pairs->prestress[e] = pairs->shares[pairs->slots[e][0]] + pairs->shares[pairs->slots[e][1]];
    for (size_t i = 0; i < pairs->excess_count; i++)
        pairs->prestress[pairs->excess[i][0]] += pairs->shares[pairs->excess[i][1]];
}

static void scale_triangles(struct tl_pair_forces *pairs, const double *shares)
{
    for (size_t i = 0; i < pairs->metric_count; i++)
        for (int lane = 0; lane < TL_BATCH; lane++) {
            const struct tl_metric *metric = &pairs->metrics[i];
            if (!(metric->area[lane] > 0))
                continue;
            const uint32_t *first = pairs->edges[metric->edges[0][lane]];
            const uint32_t *second = pairs->edges[metric->edges[1][lane]];
            const bool shared = second[0] == first[0] || second[0] == first[1];
            const double share = lowest_of(shares, first[0], first[1], second[shared ? 1 : 0]);
            for (int corner = 0; corner < 3; corner++)
                pairs->shares[(i * 3 + (size_t)corner) * TL_BATCH + (size_t)lane] *= share;
        }
}

void tl_energy_set_prestress(struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                             const double *inverse_masses, double h, const vec3d *x)
{
    struct tl_pair_forces *pairs = &energy->pairs;
    tl_pair_forces_stretch(energy, fabric, x);
    sum_by_edge(pairs);
    double *shares = find_shares(pairs, inverse_masses, h);
    scale_triangles(pairs, shares);
    sum_by_edge(pairs);
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++) {
        const struct tl_membrane *m = &energy->membranes[i / TL_BATCH];
        const size_t lane = i % TL_BATCH;
        double strains[3] = {0}, share = 0;
        if (m->area[lane] > 0) {
            measure(m, lane, x, strains);
            share = lowest_of(shares, m->vertices[0][lane], m->vertices[1][lane], m->vertices[2][lane]);
        }
        for (int row = 0; row < 3; row++)
            energy->previewed[i / TL_BATCH].rest_strain[row][lane] = share * strains[row];
    }
    free(shares);
    energy->is_prestressed = true;
    tl_pair_forces_set_packs(pairs, energy->bending_is_force);
}

void tl_energy_clear_prestress(struct tl_energy *energy)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        memset(energy->previewed[i].rest_strain, 0, sizeof energy->previewed[i].rest_strain);
    memset(energy->pairs.prestress, 0, energy->pairs.edge_count * sizeof *energy->pairs.prestress);
    energy->is_prestressed = false;
    tl_pair_forces_set_packs(&energy->pairs, energy->bending_is_force);
}
