/* One substep of XPBD (Macklin, Mueller, Chentanez 2016; one iteration per substep, Macklin et al. 2019,
 * "Small Steps in Physics Simulation"): predict, solve each constraint once in a fixed order, take the
 * velocity from the motion. With a fresh multiplier each substep a single spring is exactly implicit Euler.
 *
 * Double throughout: in float gravity vanishes for h <= 7e-5 s at 1.5 m. Serial Gauss-Seidel over batches
 * whose elements share no vertex: the result depends neither on the number of threads nor on how wide the
 * processor is. Threads: pure. */
#ifndef TOILE_CLOTH_XPBD_H
#define TOILE_CLOTH_XPBD_H

#include "cloth/energy.h"
#include "cloth/vec3d.h"

struct tl_particles {
    size_t count;    /* the arrays have one more, held, for the empty lanes of batches */
    vec3d *x;        /* m */
    vec3d *previous; /* m, at the start of the substep */
    vec3d *v;        /* m/s */
    double *w;       /* 1/kg; 0: held */
};
struct tl_particles tl_particles_create(size_t count);
void tl_particles_release(struct tl_particles *particles);

/* v <- (v + h g) exp(-drag h), previous <- x, x <- x + h v. */
void tl_xpbd_predict(struct tl_particles *particles, double gravity, double drag, double h);

/* Every membrane, bend and link once. */
void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles);
void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles);

/* v <- (x - previous) / h. */
void tl_xpbd_finish(struct tl_particles *particles, double h);

/* Denormals cost up to 150 times a normal operation and mean nothing here: flushed to zero while the solver
 * runs. Returns the state to restore. */
unsigned tl_denormals_off(void);
void tl_denormals_restore(unsigned state);

#endif
