/* The strain limit of `preview`: one iteration a substep leaves heavy or soft cloth too long; what is
 * stretched beyond a share of its rest length is drawn back to it, edge by edge (Provot 1995, "Deformation
 * constraints in a mass-spring model to describe rigid cloth behavior"). It is not in the energy: the other
 * solvers know none, and a fabric that truly stretches further needs it off.
 *
 * Only edges of triangles that came near the limit in this substep are looked at, and those that were drawn
 * back in the last one: a substep moves cloth by far less than what is left then, and what it moves further
 * is seen in the next; but what stiff neighbours pull too far again and again must be drawn back every time,
 * or it hums. Threads: pure. */
#ifndef TOILE_CLOTH_SOLVERS_STRAIN_LIMIT_H
#define TOILE_CLOTH_SOLVERS_STRAIN_LIMIT_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"
#include "cloth/solvers/xpbd.h"

struct tl_limited_edge {
    uint32_t ends[2];
    double rest;         /* m; HUGE_VAL: too short, or of no triangle; it may be of any length */
    double start_length; /* m, its length at first */
};

struct tl_strain_limits {
    double strain; /* 0: no limit */
    size_t count;
    struct tl_limited_edge *edges; /* [count] as in the topology */
    bool *due, *always;            /* [count] it is looked at: now; in any case */
    bool *corrected;               /* [count] it was drawn back in the last substep */
    bool any_corrected;
    uint32_t (*sides)[3][TL_BATCH]; /* [membrane_count] edges of each batch of membranes */
    struct tl_stretch_watch watch;  /* for tl_xpbd_solve */
    double elapsed_s;
};

/* Every edge longer than `shortest` metres at rest; `x` is where the cloth is. */
struct tl_strain_limits tl_strain_limits_create(const struct tl_topology *topology,
                                                const struct tl_energy *energy, const vec2s (*rest)[3],
                                                double shortest, double strain, const vec3d *x);
/* From here on it is as it was made: what is longer than the limit now is drawn back from there. */
void tl_strain_limits_restart(struct tl_strain_limits *limits, const vec3d *x);
void tl_strain_limits_release(struct tl_strain_limits *limits);

/* After tl_xpbd_solve in a substep of h seconds: draws edges longer than 1 + strain times their rest length
 * back to that, there and back through the list; those that were longer at first, at a limited speed. */
void tl_strain_limits_solve(struct tl_strain_limits *limits, const struct tl_energy *energy, double h,
                            struct tl_particles *particles);

#endif
