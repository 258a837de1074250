/* Evaluation of the elastic energy and its forces: see pair_forces.h for the passes. */
#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/team.h"
#include "config/base/simd.h"

#include <string.h>

/* A thread or link compressed below this share of its rest length pushes no harder than at it. */
#define MIN_LENGTH 1e-6

/* Pads positions to four numbers, so that one wide load reads a position. */
TL_CLONES static void copy_positions(const vec3d *x, struct tl_range range, double *positions)
{
    for (size_t i = range.from; i < range.to; i++) {
        positions[4 * i] = x[i].x;
        positions[4 * i + 1] = x[i].y;
        positions[4 * i + 2] = x[i].z;
    }
}

void tl_pair_forces_load_positions(const struct tl_pair_forces *pairs, const vec3d *x, struct tl_range range)
{
    copy_positions(x, range, pairs->positions);
}

TL_CLONES static void square_lengths(const vec3d *x, const uint32_t (*edges)[2], struct tl_range range,
                                     double *squared)
{
    for (size_t e = range.from; e < range.to; e++) {
        vec3d offset = vec3d_sub(x[edges[e][1]], x[edges[e][0]]);
        squared[e] = vec3d_dot(offset, offset);
    }
}

/* Area times stiffness. */
struct stretching {
    double weft, warp, shear;
};

/* One batch of triangles. With the metric m = (|F_u|^2, F_u.F_v, |F_v|^2) and the energy per area
 *     e = k_weft/2 (sqrt(m_uu) - 1)^2 + k_warp/2 (sqrt(m_vv) - 1)^2 + k_shear/2 m_uv^2 / (m_uu m_vv):
 * computes 2A de/d(l_k^2) for each edge k, and A e if `energies` is not NULL. Lengths have a lower bound,
 * since the energy has no derivative where a thread is crushed to a point. One division serves both inverse
 * lengths. */
TL_INLINE void differentiate(const struct tl_metric *metric, const struct stretching *k,
                             const double squared[3][TL_BATCH], double *restrict shares, double *energies)
{
    for (int lane = 0; lane < TL_BATCH; lane++) {
        double c0 = metric->c[0][lane], c1 = metric->c[1][lane], c2 = -(c0 + c1);
        double d0 = metric->d[0][lane], d1 = metric->d[1][lane], d2 = -(d0 + d1);
        double l0 = squared[0][lane], l1 = squared[1][lane], l2 = squared[2][lane];
        double uu0 = c1 * c2, uu1 = c2 * c0, uu2 = c0 * c1;
        double vv0 = d1 * d2, vv1 = d2 * d0, vv2 = d0 * d1;
        double uv0 = c1 * d2 + c2 * d1, uv1 = c2 * d0 + c0 * d2, uv2 = c0 * d1 + c1 * d0;
        double uu = -(uu0 * l0 + uu1 * l1 + uu2 * l2);
        double vv = -(vv0 * l0 + vv1 * l1 + vv2 * l2);
        double uv = -0.5 * (uv0 * l0 + uv1 * l1 + uv2 * l2);
        double length_u = sqrt(uu > MIN_LENGTH * MIN_LENGTH ? uu : MIN_LENGTH * MIN_LENGTH);
        double length_v = sqrt(vv > MIN_LENGTH * MIN_LENGTH ? vv : MIN_LENGTH * MIN_LENGTH);
        double both = 1 / (length_u * length_v), inverse_u = both * length_v, inverse_v = both * length_u;
        double cosine = uv * both, slant = k->shear * cosine, by_uv = slant * both; /* de/dm_uv */
        double turn = slant * cosine;
        double by_uu = k->weft * (1 - inverse_u) - turn * (inverse_u * inverse_u); /* 2 de/dm_uu */
        double by_vv = k->warp * (1 - inverse_v) - turn * (inverse_v * inverse_v);
        double area = -metric->area[lane];
        shares[lane] = area * (by_uu * uu0 + by_vv * vv0 + by_uv * uv0);
        shares[TL_BATCH + lane] = area * (by_uu * uu1 + by_vv * vv1 + by_uv * uv1);
        shares[2 * TL_BATCH + lane] = area * (by_uu * uu2 + by_vv * vv2 + by_uv * uv2);
        if (energies) {
            double weft = length_u - 1, warp = length_v - 1;
            energies[lane] = -0.5 * area * (k->weft * weft * weft + k->warp * warp * warp + turn);
        }
    }
}

TL_INLINE void read_squared(const struct tl_pair_forces *pairs, const struct tl_metric *metric,
                            double squared[3][TL_BATCH])
{
    for (int corner = 0; corner < 3; corner++)
        for (int lane = 0; lane < TL_BATCH; lane++)
            squared[corner][lane] = pairs->squared[metric->edges[corner][lane]];
}

TL_INLINE void differentiate_range(const struct tl_pair_forces *pairs, struct stretching k,
                                   struct tl_range range, bool wants_energy)
{
    for (size_t i = range.from; i < range.to; i++) {
        double squared[3][TL_BATCH], energies[TL_BATCH], sum = 0;
        read_squared(pairs, &pairs->metrics[i], squared);
        differentiate(&pairs->metrics[i], &k, (const double(*)[TL_BATCH])squared,
                      &pairs->shares[i * 3 * TL_BATCH], wants_energy ? energies : NULL);
        for (int lane = 0; lane < TL_BATCH && wants_energy; lane++)
            sum += energies[lane];
        if (wants_energy)
            pairs->parts[i] = sum;
    }
}

TL_CLONES static void differentiate_all(const struct tl_pair_forces *pairs, struct stretching k,
                                        struct tl_range range)
{
    differentiate_range(pairs, k, range, false);
}

/* The same, and the triangles' energies. */
TL_CLONES static void measure_all(const struct tl_pair_forces *pairs, struct stretching k,
                                  struct tl_range range)
{
    differentiate_range(pairs, k, range, true);
}

TL_CLONES static void add_shares(const struct tl_pair_forces *pairs, struct tl_range range)
{
    for (size_t e = range.from; e < range.to; e++)
        pairs->edge_strengths[e] =
            pairs->shares[pairs->slots[e][0]] + pairs->shares[pairs->slots[e][1]] + pairs->edge_bending[e];
}

/* Adds the rare contributions to edges: third and further triangles, and links. Returns the links' energy. */
static double add_rare(const struct tl_energy *energy, double stiffness)
{
    const struct tl_pair_forces *pairs = &energy->pairs;
    double sum = 0;
    for (size_t i = 0; i < pairs->excess_count; i++)
        pairs->edge_strengths[pairs->excess[i][0]] += pairs->shares[pairs->excess[i][1]];
    for (size_t i = 0; i < energy->link_count; i++) {
        double rest = energy->links[i].rest, length = sqrt(pairs->squared[pairs->link_edges[i]]);
        double share = length > MIN_LENGTH * rest ? rest / length : 1 / MIN_LENGTH;
        pairs->edge_strengths[pairs->link_edges[i]] += stiffness * (1 - share);
        sum += 0.5 * stiffness * (length - rest) * (length - rest);
    }
    return sum;
}

/* sum += strength (other - at), written as a subtraction of strength (at - other): there the second operand
 * can come straight from memory. */
TL_INLINE void add_pull(const double *at, const double *other, double strength, struct tl_wide_force *sum)
{
    double x = at[0] - other[0], y = at[1] - other[1], z = at[2] - other[2], unused = at[3] - other[3];
    sum->x -= strength * x;
    sum->y -= strength * y;
    sum->z -= strength * z;
    sum->unused -= strength * unused;
}

TL_INLINE void add_others(const struct tl_pair_forces *pairs, size_t vertex, struct tl_wide_force *sum)
{
    const double *at = &pairs->positions[4 * vertex];
    for (uint32_t k = pairs->others_first[vertex]; k < pairs->others_first[vertex + 1]; k++)
        add_pull(at, &pairs->positions[4 * (size_t)pairs->others[k]], pairs->bending[k], sum);
}

/* `strengths` [edge_count]. */
TL_INLINE void add_along(const struct tl_pair_forces *pairs, size_t vertex, const double *strengths,
                         struct tl_wide_force *sum)
{
    const double *at = &pairs->positions[4 * vertex];
    for (uint32_t k = pairs->incident_first[vertex]; k < pairs->incident_first[vertex + 1]; k++) {
        const struct tl_incident_edge *incident = &pairs->incident[k];
        add_pull(at, &pairs->positions[4 * (size_t)incident->other], strengths[incident->edge], sum);
    }
}

/* Returns half of the energy of the vertex's folds. */
TL_INLINE double add_folds(const struct tl_folds *folds, const double *positions, size_t vertex,
                           bool is_explicit, struct tl_wide_force *sum)
{
    const double *at = &positions[4 * vertex];
    double energy = 0;
    for (uint32_t k = folds->first[vertex]; k < folds->first[vertex + 1]; k++) {
        const struct tl_fold_end *end = &folds->ends[k];
        const double *other = &positions[4 * (size_t)end->other];
        double x = at[0] - other[0], y = at[1] - other[1], z = at[2] - other[2];
        double squared = x * x + y * y + z * z;
        if (!(squared < (double)end->reach_squared))
            continue;
        const struct tl_fold_spring *spring = &folds->springs[k];
        double length = fmax(sqrt(squared), TL_FOLD_NEAREST_M), short_by = fmax(spring->reach - length, 0);
        double stiffness = is_explicit ? spring->stable : spring->stiffness;
        double strength = stiffness * short_by / length;
        sum->x += strength * x;
        sum->y += strength * y;
        sum->z += strength * z;
        energy += 0.25 * stiffness * (short_by * short_by);
    }
    return energy;
}

/* The explicit forces, in two independent sums, so that one addition need not wait for the other. */
TL_INLINE struct tl_wide_force add_packs(const struct tl_pair_forces *pairs, size_t vertex)
{
    const double *positions = pairs->positions, *at = &positions[4 * vertex];
    const struct tl_pair_pack *end = &pairs->packs[pairs->packs_first[vertex + 1]];
    struct tl_wide_force even = {0}, odd = {0};
    for (const struct tl_pair_pack *pack = &pairs->packs[pairs->packs_first[vertex]]; pack < end; pack++) {
        add_pull(at, &positions[pack->from[0]], pack->strengths[0], &even);
        add_pull(at, &positions[pack->from[1]], pack->strengths[1], &odd);
        add_pull(at, &positions[pack->from[2]], pack->strengths[2], &even);
        add_pull(at, &positions[pack->from[3]], pack->strengths[3], &odd);
    }
    return (struct tl_wide_force){even.x + odd.x, even.y + odd.y, even.z + odd.z, even.unused + odd.unused};
}

/* `strengths` [edge_count] of all that acts along edges; NULL: the explicit forces. */
TL_INLINE void add_block(const struct tl_energy *energy, struct tl_range block, const double *strengths,
                         vec3d *forces)
{
    const struct tl_pair_forces *pairs = &energy->pairs;
    for (size_t i = block.from; i < block.to; i++) {
        struct tl_wide_force sum = {0};
        if (strengths) {
            add_along(pairs, i, strengths, &sum);
            add_others(pairs, i, &sum);
        } else {
            sum = add_packs(pairs, i);
        }
        (void)add_folds(&energy->folds, pairs->positions, i, !strengths, &sum);
        pairs->sums[i] = sum;
    }
    for (size_t i = block.from; i < block.to; i++)
        forces[i] = (vec3d){pairs->sums[i].x, pairs->sums[i].y, pairs->sums[i].z};
}

static struct tl_range block_from(size_t from, struct tl_range range)
{
    size_t to = from + TL_PAIR_BLOCK;
    return (struct tl_range){from, to < range.to ? to : range.to};
}

/* Each block's particles are advanced as soon as their forces are known, while these are in the cache. */
TL_INLINE void add_range(const struct tl_energy *energy, const double *strengths, struct tl_range range,
                         vec3d *forces, const struct tl_particle_kernel *then)
{
    for (size_t from = range.from; from < range.to; from += TL_PAIR_BLOCK) {
        struct tl_range block = block_from(from, range);
        add_block(energy, block, strengths, forces);
        if (then)
            then->run(then->particles, block, then->params);
    }
}

TL_CLONES static void add_forces(const struct tl_energy *energy, struct tl_range range, vec3d *forces,
                                 const struct tl_particle_kernel *then)
{
    add_range(energy, energy->pairs.edge_strengths, range, forces, then);
}

TL_CLONES static void add_explicit(const struct tl_energy *energy, struct tl_range range, vec3d *forces,
                                   const struct tl_particle_kernel *then)
{
    add_range(energy, NULL, range, forces, then);
}

/* x.Kx/2 of a block of vertices, and its folds. Rows of K sum to 0, so that x may be measured from any
 * origin; one near by keeps the rounding small. */
TL_CLONES static double bending_energy(const struct tl_energy *of, struct tl_range range)
{
    const struct tl_pair_forces *pairs = &of->pairs;
    double energy = 0;
    const double *origin = pairs->positions;
    for (size_t i = range.from; i < range.to; i++) {
        const double *at = &pairs->positions[4 * i];
        struct tl_wide_force sum = {0};
        add_along(pairs, i, pairs->edge_bending, &sum);
        add_others(pairs, i, &sum);
        energy -=
            0.5 * (sum.x * (at[0] - origin[0]) + sum.y * (at[1] - origin[1]) + sum.z * (at[2] - origin[2]));
        energy += add_folds(&of->folds, pairs->positions, i, false, &sum);
    }
    return energy;
}

static void add_energies(const struct tl_energy *energy)
{
    const struct tl_pair_forces *pairs = &energy->pairs;
    struct tl_range mine = tl_team_range(pairs->vertex_count, TL_PAIR_BLOCK);
    for (size_t from = mine.from; from < mine.to; from += TL_PAIR_BLOCK)
        pairs->parts[pairs->metric_count + from / TL_PAIR_BLOCK] =
            bending_energy(energy, block_from(from, mine));
}

/* Work of the passes on the team. */
struct evaluation {
    const struct tl_energy *energy;
    const struct tl_cloth_fabric *fabric;
    const vec3d *x;
    bool wants_energy;
    vec3d *forces;
    const struct tl_particle_kernel *then;
    double links; /* the links' energy; the triangles' (and bending's) energies, if wanted, are in
                     pairs->parts */
};

/* The passes up to those of the triangles. */
static void evaluate_triangles(void *context)
{
    const struct evaluation *to = context;
    const struct tl_pair_forces *pairs = &to->energy->pairs;
    const struct stretching k = {to->fabric->stretch_weft, to->fabric->stretch_warp, to->fabric->shear};
    square_lengths(to->x, (const uint32_t(*)[2])pairs->edges, tl_team_range(pairs->edge_count, TL_BATCH),
                   pairs->squared);
    tl_team_barrier();
    struct tl_range triangles = tl_team_range(pairs->metric_count, 1);
    if (to->wants_energy)
        measure_all(pairs, k, triangles);
    else
        differentiate_all(pairs, k, triangles);
    tl_team_barrier();
}

/* Runs all passes. */
static void evaluate(void *context)
{
    struct evaluation *to = context;
    const struct tl_pair_forces *pairs = &to->energy->pairs;
    tl_pair_forces_load_positions(pairs, to->x, tl_team_range(pairs->vertex_count, TL_PAIR_BLOCK));
    evaluate_triangles(to);
    add_shares(pairs, tl_team_range(pairs->edge_count, TL_BATCH));
    tl_team_barrier();
    if (pairs->excess_count + to->energy->link_count > 0) {
        if (tl_team_thread() == 0)
            to->links = add_rare(to->energy, to->fabric->stretch_warp);
        tl_team_barrier();
    }
    add_forces(to->energy, tl_team_range(pairs->vertex_count, TL_PAIR_BLOCK), to->forces, to->then);
    if (to->wants_energy)
        add_energies(to->energy);
}

void tl_energy_forces(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric, const vec3d *x,
                      vec3d *forces, const struct tl_particle_kernel *then)
{
    struct evaluation to = {.energy = energy, .fabric = fabric, .x = x, .forces = forces, .then = then};
    tl_team_run(energy->pairs.vertex_count, evaluate, &to);
}

void tl_pair_forces_stretch(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                            const vec3d *x)
{
    struct evaluation to = {.energy = energy, .fabric = fabric, .x = x};
    tl_team_run(energy->pairs.vertex_count, evaluate_triangles, &to);
}

static void evaluate_explicit(void *context)
{
    const struct evaluation *to = context;
    const struct tl_pair_forces *pairs = &to->energy->pairs;
    struct tl_range mine = tl_team_range(pairs->vertex_count, TL_PAIR_BLOCK);
    tl_pair_forces_load_positions(pairs, to->x, mine);
    tl_team_barrier();
    add_explicit(to->energy, mine, to->forces, to->then);
}

void tl_energy_explicit_forces(const struct tl_energy *energy, const vec3d *x, vec3d *forces,
                               const struct tl_particle_kernel *then)
{
    struct evaluation to = {.energy = energy, .x = x, .forces = forces, .then = then};
    tl_team_run(energy->pairs.vertex_count, evaluate_explicit, &to);
}

double tl_energy_evaluate(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                          size_t vertex_count, const vec3d *x, vec3d *forces)
{
    const struct tl_pair_forces *pairs = &energy->pairs;
    size_t blocks = (vertex_count + TL_PAIR_BLOCK - 1) / TL_PAIR_BLOCK;
    struct evaluation to = {
        .energy = energy, .fabric = fabric, .x = x, .wants_energy = true, .forces = forces};
    tl_team_run(energy->pairs.vertex_count, evaluate, &to);
    double total = to.links;
    for (size_t i = 0; i < pairs->metric_count + blocks; i++)
        total += pairs->parts[i];
    return total;
}
