/* The elastic energy of the cloth, the same for every solver: membrane and bending of triangles, and links.
 *
 * Membrane, per triangle, with the deformation gradient F = [F_u F_v] from the flat rest shape of area A:
 *     E = A/2 [ k_weft (|F_u| - 1)^2 + k_warp (|F_v| - 1)^2 + k_shear c^2 ],  c = F_u.F_v / (|F_u| |F_v|)
 * so that the tension of a strip per width is k times its strain, in any triangulation.
 *
 * Bending, per triangle with its up to three neighbours. A hinge's bend is the vector h = sum K_i x_i, K the
 * cotangents of the flat hinge [Bergou et al. 2006];
 * |h| is the fold angle times the edge length. Spread over the hinge's two triangles in proportion to their
 * heights, the hinges give the triangle's curvature tensor (the mid-edge operator of [Grinspun et al. 2006]):
 *     L = sum over edges h / (A + A') n n^T,     n the edge's unit normal in the rest plane
 *     E = A/2 [ B_weft L_uu^2 + B_warp L_vv^2 + 2 sqrt(B_weft B_warp) L_uv^2 ]
 * A sum of squared hinge angles weighted by l^2/A would overstate B by up to 3 on a grid, where all bending
 * falls on one of three edge directions; the tensor is exact for any quadratic surface over a regular grid.
 * Each component is linear in the positions, and so a constraint with constant gradients. The rest state is
 * flat. Sharp folds have springs besides (folds.h).
 *
 * Rest shapes: x along the weft, y along the warp, metres. Lifetime: plain structs that own their arrays.
 * Threads: pure, except where a function states otherwise. */
#ifndef TOILE_CLOTH_ENERGY_ENERGY_H
#define TOILE_CLOTH_ENERGY_ENERGY_H

#include "assets/garment.h"
#include "cloth/energy/fabric.h"
#include "cloth/energy/folds.h"
#include "cloth/energy/pair_forces.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/memory.h"

/* Triangles are stored in batches (mesh/topology.h), one per lane. An empty lane holds zeros and the vertex
 * one past the last, which is held. */

/* Membranes. F_u = sum c_i x_i, F_v = sum d_i x_i. */
struct tl_membrane {
    uint32_t vertices[3][TL_BATCH];
    double c[3][TL_BATCH], d[3][TL_BATCH]; /* 1/m */
    double area[TL_BATCH];                 /* m^2, at rest */
};

/* The same batches for `preview`, which is bound by memory: exactly what it reads in a substep. */
struct tl_preview_membrane {
    _Alignas(TL_CACHE_LINE) double c[2][TL_BATCH]; /* of the last two vertices; that of the first is minus
                                                      their sum */
    double d[2][TL_BATCH];
    double w[3][TL_BATCH];                           /* 1/kg, of the vertices */
    double cc[TL_BATCH], cd[TL_BATCH], dd[TL_BATCH]; /* sums of w c_i c_i, w c_i d_i, w d_i d_i */
    double weft[TL_BATCH], warp[TL_BATCH];           /* -1 / (w |grad|^2 + 1 / (k A h^2)) */
    double shear[TL_BATCH];                          /* 1 / (k A h^2) */
    double rest_strain[3][TL_BATCH]; /* of weft, warp and shear, at which their rows exert nothing */
    uint32_t from[3][TL_BATCH];      /* offsets of the vertices in the pairs' `positions` */
};

/* Curvatures: L_uu, L_vv, sqrt(2) L_uv = sum of rows over the stencil's vertices. */
#define TL_BEND_STENCIL 6
struct tl_bend {
    uint32_t vertices[TL_BEND_STENCIL][TL_BATCH]; /* its own three, then the far corner of each hinge; a
                                                     missing one repeats the first, with rows of 0 */
    double rows[3][TL_BEND_STENCIL][TL_BATCH];    /* 1/m^2 */
    double w[TL_BEND_STENCIL][TL_BATCH];          /* 1/kg */
    double factors[3][TL_BATCH];                  /* -1 / (sum w row^2 + 1 / (B A h^2)) */
    double area[TL_BATCH];
};

/* A spring between two vertices. The edges of slivers, whose plane is rounding noise, are links; seams are
 * too. */
struct tl_link {
    uint32_t a, b;
    double rest;       /* m */
    double compliance; /* 1 / (k h^2); 0: rigid */
};

struct tl_energy {
    size_t membrane_count, bend_count, link_count; /* batches, batches, links */
    size_t membrane_run_count, *membrane_run_ends; /* see struct tl_batches */
    size_t bend_run_count, *bend_run_ends;
    struct tl_membrane *membranes;
    struct tl_preview_membrane *previewed; /* [membrane_count] */
    struct tl_bend *bends;
    struct tl_link *links;
    double *masses; /* [vertex_count] kg per areal density: a third of the area around */
    struct tl_folds folds;
    struct tl_pair_forces pairs;
    bool bending_is_force; /* preview: its substep is short enough for bending as an explicit force, see
                              xpbd.h */
    bool is_prestressed;
};

/* Builds the energy of a mesh whose triangles have the flat `rest` shapes. `made` [vertex_count] is how it is
 * folded when nothing acts; NULL: it is not. */
struct tl_energy tl_energy_build(const struct tl_topology *topology, const vec2s (*rest)[3],
                                 const vec3d *made);
void tl_energy_release(struct tl_energy *energy);

/* Sets the fabric; must precede evaluation of energy and forces, and tl_energy_set_preview must follow. */
void tl_energy_set_fabric(struct tl_energy *energy, const struct tl_cloth_fabric *fabric);

/* Sets the coefficients of `preview` for a fabric, a substep of `h` seconds and inverse masses [vertex_count
 * + 1]. Prestress stays. `bends_by_rows`: bending must not be an explicit force. */
void tl_energy_set_preview(struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                           const double *inverse_masses, double h, bool bends_by_rows);

/* Splits the tension that membranes have at positions `x` [vertex_count] from the rest. `preview` exerts it
 * as an explicit force, by constant force densities along edges [Schek 1974], which turn with the cloth; the
 * rows are solved for strains from `x` on. So cloth that is in balance at `x` stays there: rows start from no
 * tension in each substep, and alone they reach too little of it. Where the densities would be unstable in
 * substeps of `h` seconds, a share of them is split off. Both stay until they are set again or cleared. */
void tl_energy_set_prestress(struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                             const double *inverse_masses, double h, const vec3d *x);
void tl_energy_clear_prestress(struct tl_energy *energy);

/* Returns the elastic energy (J) at positions `x` [vertex_count] and writes its forces -dE/dx (N) to `forces`
 * [vertex_count]. A link's energy is k/2 (length - rest)^2 with the stretch stiffness of the warp. `fabric`
 * must be the one that was set last. Threads: parallel inside; one call at a time for one energy, as it has
 * scratch space. */
double tl_energy_evaluate(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                          size_t vertex_count, const vec3d *x, vec3d *forces);

/* The same forces to the last bit, without the energy, which saves time. If `then` is not NULL it is run on
 * each block of particles as soon as their forces are in `forces`, while these are in the cache; it may
 * change `x`. */
void tl_energy_forces(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric, const vec3d *x,
                      vec3d *forces, const struct tl_particle_kernel *then);

/* The same with the explicit forces of `preview`: prestress, folds, and bending where it is a force. */
void tl_energy_explicit_forces(const struct tl_energy *energy, const vec3d *x, vec3d *forces,
                               const struct tl_particle_kernel *then);
static inline bool tl_energy_has_explicit_forces(const struct tl_energy *energy)
{
    return energy->bending_is_force || energy->is_prestressed || energy->folds.count > 0;
}

/* Bending stiffness of the components L_uu, L_vv and sqrt(2) L_uv, N m. */
void tl_bend_stiffness(const struct tl_cloth_fabric *fabric, double out[3]);

/* Writes the sums of |K| (N/m) over each vertex's row to `sums` [vertex_count + 1], in three dimensions: no
 * eigenvalue of K exceeds the largest (Gershgorin's theorem).
 *
 * K is an upper bound of the Hessian, not the Hessian at rest: stretch stiffness counts in all three
 * directions, since k (1 - 1/|F|) across the thread stays below k however far it is stretched, so that
 * stretch, bending and links are bounded in any state. Shear is bounded while neither thread is shorter than
 * at rest, and grows as 1/|F|^2 when they are crushed: the state `x` [vertex_count + 1] is used for it, or
 * the rest state if NULL. */
void tl_energy_row_sums(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                        size_t vertex_count, const vec3d *x, double *sums);

/* A lower bound of the longest step (s) at which explicit integration is stable, 2 / omega_max, with
 * omega_max^2 the largest row sum of M^-1 K (tl_energy_row_sums). Infinite when nothing resists. At rest the
 * true limit was measured to be 1.25 (a plate) to 1.74 times (isotropic cloth) as long. */
double tl_energy_critical_step(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                               size_t vertex_count, const double *inverse_masses, const vec3d *x);

/* Flat rest shape of a triangle of the garment's mesh: from the garment's pattern, else its start shape,
 * rotated so that x follows the direction of increasing u (an arbitrary direction where UVs are degenerate).
 */
void tl_rest_shape(const tl_garment *garment, size_t triangle, vec2s out[3]);
/* Whether a triangle of this rest shape is too thin to have a membrane. */
bool tl_rest_is_sliver(const vec2s rest[3]);
/* Rest shapes of all physics triangles, as a new array that the caller frees. */
vec2s (*tl_rest_shapes(const tl_garment *garment, const struct tl_topology *topology))[3];

#endif
