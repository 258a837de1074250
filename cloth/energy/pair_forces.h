/* The elastic forces as sums of central forces between pairs of vertices, which is fast, and exact in
 * momentum.
 *
 * A membrane's energy depends on |F_u|^2, F_u.F_v and |F_v|^2 only, and these are linear in the squared
 * lengths of the triangle's edges: F_u = sum c_i x_i with sum c_i = 0 gives |F_u|^2 = -sum_{i<j} c_i c_j |x_i
 * - x_j|^2. So its forces are 2 dE/d(l^2) (x_j - x_i) along each edge. Bending is x.Kx/2 with a constant K
 * whose rows sum to 0: its forces are -K_ij (x_j - x_i) over the pairs that share a stencil. Both act along
 * the line between two vertices, with one strength for both ends, so that linear and angular momentum are
 * conserved except for the rounding of sums.
 *
 * Passes: squared lengths by edge, derivatives by triangle, their sums by edge, forces by vertex. Each entry
 * is written by one thread and summed in a fixed order, so that results do not depend on the number of
 * threads. Lifetime: plain struct that owns its arrays. Threads: it has scratch space, so one call at a time.
 */
#ifndef TOILE_CLOTH_ENERGY_PAIR_FORCES_H
#define TOILE_CLOTH_ENERGY_PAIR_FORCES_H

#include "cloth/mesh/team.h"
#include "cloth/mesh/topology.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/memory.h"

#include <stddef.h>
#include <stdint.h>

struct tl_energy;
struct tl_cloth_fabric;

/* Triangles as functions of their edges' squared lengths; edge i faces corner i. Empty lanes have area 0. */
struct tl_metric {
    _Alignas(
        TL_CACHE_LINE) double c[2][TL_BATCH]; /* 1/m, the third is minus their sum: see struct tl_membrane */
    double d[2][TL_BATCH];
    double area[TL_BATCH];
    uint32_t edges[3][TL_BATCH];
};

/* Four numbers, so that a wide register adds them at once; the last is 0. */
struct tl_wide_force {
    double x, y, z, unused;
};

/* An edge as seen from one of its ends. */
struct tl_incident_edge {
    uint32_t other, edge;
};

/* Explicit forces on one vertex, as many as are in flight at once. A row that does not fill its last pack
 * ends with pairs of strength 0 with itself. */
#define TL_PAIR_PACK 4
struct tl_pair_pack {
    double strengths[TL_PAIR_PACK]; /* N/m */
    uint32_t from[TL_PAIR_PACK];    /* the other end's first number in `places` */
};

struct tl_pair_forces {
    size_t vertex_count, edge_count, metric_count, excess_count;
    uint32_t (*edges)[2]; /* as in the topology */
    struct tl_metric *metrics;
    uint32_t (*slots)[2]; /* [edge_count] the two entries of `shares` that an edge's strength is the sum of */
    uint32_t (*excess)[2]; /* [excess_count] edge, entry: third and further triangles at an edge */
    uint32_t *link_edges;  /* [link_count] */
    double *edge_bending;  /* [edge_count] -K_ij of its ends, N/m */
    double *prestress;     /* [edge_count] N/m, see tl_energy_set_prestress */

    /* Rows by vertex i: incident[incident_first[i]] and on are its edges, others[others_first[i]] and on the
     * pairs that only bending connects. */
    uint32_t *incident_first, *others_first; /* [vertex_count + 1] */
    struct tl_incident_edge *incident;
    uint32_t *others; /* the vertex at the other end */
    double *bending;  /* [entries of others] -K_ij, N/m */

    /* The explicit forces of `preview`, along edges or not: packs[packs_first[i]] and on. */
    uint32_t *packs_first; /* [vertex_count + 1] */
    struct tl_pair_pack *packs;

    /* Scratch. */
    double *positions; /* [vertex_count + 1][4] m, the last one for the empty lanes of batches */
    double *squared;   /* [edge_count] m^2 */
    double *shares;    /* [metric_count][3][TL_BATCH] N/m, then a 0 for edges with fewer than two triangles */
    double *edge_strengths;     /* [edge_count] N/m, with bending */
    struct tl_wide_force *sums; /* [vertex_count] N */
    double *parts;              /* [metric_count + blocks of vertices] J */
};

/* Builds the pair forces of the membranes, bends and links in `energy`. */
struct tl_pair_forces tl_pair_forces_build(const struct tl_topology *topology,
                                           const struct tl_energy *energy);
void tl_pair_forces_release(struct tl_pair_forces *pairs);

/* Sets the bending stiffness of L_uu, L_vv and sqrt(2) L_uv, N m. tl_pair_forces_set_packs must follow. */
void tl_pair_forces_set(struct tl_pair_forces *pairs, const struct tl_energy *energy,
                        const double stiffness[3]);

/* Sets the explicit forces: prestress, and bending if `bends`. */
void tl_pair_forces_set_packs(struct tl_pair_forces *pairs, bool bends);

/* Writes the strengths (N/m) with which the membranes at positions `x` [vertex_count] pull on their edges to
 * `shares`. */
void tl_pair_forces_stretch(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                            const vec3d *x);

/* Copies a range of the positions into the padded scratch array. */
void tl_pair_forces_load_positions(const struct tl_pair_forces *pairs, const vec3d *x, struct tl_range range);

/* Vertices whose energies are added up before those of all blocks are. */
#define TL_PAIR_BLOCK 64

#endif
