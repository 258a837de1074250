/* The cloth's elastic energy, the same for every solver: membrane and bending of triangles, and links.
 *
 * Membrane, per triangle, with the deformation gradient F = [F_u F_v] from the flat rest shape of area A:
 *     E = A/2 [ k_weft (|F_u| - 1)^2 + k_warp (|F_v| - 1)^2 + k_shear c^2 ],  c = F_u.F_v / (|F_u| |F_v|)
 * so that a strip's tension per width is k times its strain, for any triangulation.
 *
 * Bending, per triangle with its up to three neighbours. A hinge's bend is the vector h = sum K_i x_i, K the
 * cotangents of the flat hinge (Bergou et al. 2006, "A Quadratic Bending Model for Inextensible Surfaces");
 * |h| is the fold angle times the edge length. Spread over the hinge's two triangles in proportion to their
 * heights, the hinges give the triangle's curvature tensor (the mid-edge operator of Grinspun et al. 2006,
 * "Computing discrete shape operators on general meshes"):
 *     L = sum over edges h / (A + A') n n^T,     n the edge's unit normal in the rest plane
 *     E = A/2 [ B_weft L_uu^2 + B_warp L_vv^2 + 2 sqrt(B_weft B_warp) L_uv^2 ]
 * A sum of squared hinge angles with weights l^2/A alone overstates B by up to 3 on a grid (its bending all
 * falls on one of three edge directions); this tensor is exact for any quadratic surface over a regular grid.
 * Each component is linear in the positions, so it is an exact constraint with constant gradients. Rest is
 * flat: cloth has no memory of the folds in its file.
 *
 * Rest shapes: x along weft, y along warp, metres. Threads: pure. */
#ifndef TOILE_CLOTH_ENERGY_ENERGY_H
#define TOILE_CLOTH_ENERGY_ENERGY_H

#include "assets/garment.h"
#include "cloth/energy/fabric.h"
#include "cloth/energy/pair_forces.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"
#include "cloth/mesh/vec3d.h"
#include "config/memory.h"

/* Triangles are kept in batches that share no vertex, lane by lane. An empty lane has the vertex one past the
 * last, which is held, and zeros. */

/* Membranes. F_u = sum c_i x_i, F_v = sum d_i x_i. */
struct tl_membrane {
    uint32_t vertices[3][TL_BATCH];
    double c[3][TL_BATCH], d[3][TL_BATCH]; /* 1/m */
    double area[TL_BATCH];                 /* m^2, at rest */
};

/* The same batches as `preview` solves them: all that it reads in a substep, as it waits for memory. */
struct tl_preview_membrane {
    _Alignas(
        TL_CACHE_LINE) double c[2][TL_BATCH]; /* of the last two vertices; the first's is minus their sum */
    double d[2][TL_BATCH];
    double w[3][TL_BATCH];                           /* 1/kg, of the vertices */
    double cc[TL_BATCH], cd[TL_BATCH], dd[TL_BATCH]; /* sums of w c_i c_i, ...: fixed while masses are */
    double weft[TL_BATCH], warp[TL_BATCH];           /* -1 / (w |grad|^2 + 1 / (k A h^2)) */
    double shear[TL_BATCH];                          /* 1 / (k A h^2) */
    uint32_t from[3][TL_BATCH];                      /* the vertices' first numbers in the pulls' `places` */
};

/* Curvatures: L_uu, L_vv, sqrt(2) L_uv = sum of rows over the stencil's vertices. */
#define TL_BEND_STENCIL 6
struct tl_bend {
    uint32_t vertices[TL_BEND_STENCIL][TL_BATCH]; /* own three, then across each edge; a missing one repeats
                                                     the first with rows of 0 */
    double rows[3][TL_BEND_STENCIL][TL_BATCH];    /* 1/m^2 */
    double w[TL_BEND_STENCIL][TL_BATCH];          /* 1/kg */
    double factors[3][TL_BATCH];                  /* -1 / (sum w row^2 + 1 / (B A h^2)) */
    double area[TL_BATCH];
};

/* A spring: keeps slivers, which have no usable plane, in shape; closes seams. */
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
    struct tl_pair_forces pairs;
    bool bending_is_force; /* preview's substep is short enough for bending as an explicit force: xpbd.h */
};

/* `rest` gives every physics triangle's flat rest shape. */
struct tl_energy tl_energy_build(const struct tl_topology *topology, const vec2s (*rest)[3]);
void tl_energy_release(struct tl_energy *energy);

/* Takes over the fabric. Before forces are asked for. */
void tl_energy_set_fabric(struct tl_energy *energy, const struct tl_cloth_fabric *fabric);

/* Sets what `preview` needs: material, substep `h` seconds and inverse masses [vertex_count + 1]. */
void tl_energy_set_preview(struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                           const double *inverse_masses, double h);

/* The elastic energy (J) at positions `x` [vertex_count]; writes its forces -dE/dx (N) to `forces`
 * [vertex_count]. A link's energy is k/2 (length - rest)^2 with the warp's stretch stiffness. The fabric is
 * the one that was set. Threads: one call at a time for one energy. */
double tl_energy_evaluate(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                          size_t vertex_count, const vec3d *x, vec3d *forces);

/* The forces alone, the same to the last bit, sooner. `then`, if not NULL, moves the particles on, a block at
 * a time, with their forces in `forces`; it may move `x`. */
void tl_energy_forces(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric, const vec3d *x,
                      vec3d *forces, const struct tl_particle_kernel *then);

/* The same of bending alone. */
void tl_energy_bending_forces(const struct tl_energy *energy, const vec3d *x, vec3d *forces,
                              const struct tl_particle_kernel *then);

/* Stiffness against L_uu, L_vv and sqrt(2) L_uv, N m. */
void tl_bend_stiffness(const struct tl_cloth_fabric *fabric, double out[3]);

/* The longest step (s) at which explicit integration is stable, from below: 2 / omega_max, omega_max^2 by
 * Gershgorin's bound on the rows of M^-1 K. Infinite when nothing resists.
 *
 * K here is more than the Hessian at rest: a stretch counts in all three directions, as k (1 - 1/|F|) across
 * the thread is below k however far it is stretched, so that stretch, bending and links are bounded in any
 * state. Shear is bounded while neither thread is shorter than at rest; it grows as 1/|F|^2 when they are
 * crushed, which `x` [vertex_count + 1] tells; NULL: at rest. At rest the true limit lies 1.25 (a plate)
 * to 1.74 (isotropic cloth) times higher, as measured. */
double tl_energy_critical_step(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                               size_t vertex_count, const double *inverse_masses, const vec3d *x);

/* Flat rest shape of a garment's own triangle: from its pattern, else from the start shape turned so that x
 * follows the UVs' u direction (an arbitrary one where UVs are degenerate). */
void tl_rest_shape(const tl_garment *garment, size_t triangle, vec2s out[3]);
/* Whether it is so thin that it has no membrane. */
bool tl_rest_is_sliver(const vec2s rest[3]);
/* ... of all physics triangles. New array. */
vec2s (*tl_rest_shapes(const tl_garment *garment, const struct tl_topology *topology))[3];

#endif
