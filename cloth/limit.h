/* The strain limit of `preview`: one iteration a substep leaves heavy or soft cloth too long; what is
 * stretched beyond a share of its rest length is drawn back to it, edge by edge (Provot 1995, "Deformation
 * constraints in a mass-spring model to describe rigid cloth behavior"). It is not in the energy: the other
 * solvers know none, and a fabric that truly stretches further needs it off. Threads: pure. */
#ifndef TOILE_CLOTH_LIMIT_H
#define TOILE_CLOTH_LIMIT_H

#include "cloth/particles.h"
#include "cloth/topology.h"

#include <cglm/struct.h>

struct tl_limited_edge {
    uint32_t ends[2];
    double rest;    /* m */
    double allowed; /* m, on its way from where it began to 0 */
};

struct tl_limits {
    size_t count;
    struct tl_limited_edge *edges;
};

/* Every edge longer than `shortest` metres at rest; `x` is where the cloth is. */
struct tl_limits tl_limits_create(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                                  const vec3d *x);
void tl_limits_release(struct tl_limits *limits);

/* After a substep of h seconds: draws edges longer than 1 + strain times their rest length back to that,
 * there and back through the list; those that were longer at first, at a limited speed. */
void tl_limits_solve(struct tl_limits *limits, double strain, double h, struct tl_particles *particles);

#endif
