/* Springs that resist sharp folds: those beyond a right angle.
 *
 * The bend of tl_bend is a chord: at an angle t a hinge of stiffness k has the energy k/2 (2 sin(t/2))^2,
 * whose moment falls from a right angle on, so that cloth which is folded flat stays folded. The angle's
 * energy is k/2 t^2 [Grinspun et al. 2003]. What the chord lacks of it at t = pi is put into a spring
 * between the hinge's far corners, which pushes while they are nearer than at a right angle:
 *
 *     E = g k/2 (reach - r)^2,   g = (pi^2 - 4) / (reach - s)^2,   s their distance in the flat fold
 *
 * So the moment does not fall, and the energy is below k/2 t^2 by at most 22 %.
 *
 * Cloth that is made folded keeps its folds: its springs reach no farther than its corners are from each
 * other as it is made. Lifetime: plain struct that owns its arrays. Threads: pure, once it is set. */
#ifndef TOILE_CLOTH_ENERGY_FOLDS_H
#define TOILE_CLOTH_ENERGY_FOLDS_H

#include "cloth/energy/fabric.h"
#include "cloth/mesh/vec3d.h"

#include <stddef.h>
#include <stdint.h>

/* A hinge, as its far corners see it. */
struct tl_fold {
    uint32_t ends[2];
    double reach;                    /* m */
    double spring;                   /* g l / h: per bending stiffness across the hinge, 1/m^2 */
    double across_weft, across_warp; /* squares of the cosines between its normal and the threads */
};

/* The same from one of its ends: what is read of every hinge, and what of those that are folded. */
struct tl_fold_end {
    uint32_t other;
    float reach_squared; /* m^2, rounded up */
};
struct tl_fold_spring {
    double reach;     /* m */
    double stiffness; /* N/m */
    double stable;    /* N/m, of it what is stable as an explicit force of `preview` */
};

struct tl_folds {
    size_t count, vertex_count;
    struct tl_fold *all;
    uint32_t *first; /* [vertex_count + 1]: ends[first[i]] and on are vertex i's, and their springs */
    struct tl_fold_end *ends;
    struct tl_fold_spring *springs;
};

/* Takes the array of folds. */
struct tl_folds tl_folds_build(struct tl_fold *all, size_t count, size_t vertex_count);
void tl_folds_set_fabric(struct tl_folds *folds, const struct tl_cloth_fabric *fabric);

/* Sets the springs' stable parts for substeps of `h` seconds and inverse masses [vertex_count]. */
void tl_folds_set_step(struct tl_folds *folds, const double *inverse_masses, double h);
void tl_folds_release(struct tl_folds *folds);

/* Adds a bound of each row of |K| (N/m) to `sums` [vertex_count]. */
void tl_folds_add_row_sums(const struct tl_folds *folds, double *sums);

/* Corners nearer than this push as from here. */
#define TL_FOLD_NEAREST_M 1e-6

#endif
