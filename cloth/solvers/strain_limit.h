/* The strain limit of `preview`: edges longer than 1 + strain times their rest length are shortened to that,
 * edge by edge [Provot 1995], because one XPBD iteration a substep leaves heavy or soft cloth too long. The
 * limit is not part of the energy: the other solvers do not have it, and a fabric that really stretches
 * further needs it off.
 *
 * Only two kinds of edges are tested, those of triangles that came near the limit in this substep and those
 * that were corrected in the last one. The first suffice because a substep moves cloth by far less than the
 * remaining margin. The second are needed because an edge that stiff neighbours overstretch again and again
 * must be corrected in every substep, or it oscillates. Lifetime: plain struct that owns its arrays. Threads:
 * pure. */
#ifndef TOILE_CLOTH_SOLVERS_STRAIN_LIMIT_H
#define TOILE_CLOTH_SOLVERS_STRAIN_LIMIT_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"
#include "cloth/solvers/xpbd.h"

struct tl_limited_edge {
    uint32_t ends[2];
    double rest;         /* m; HUGE_VAL: unlimited, as it is too short or has no triangle */
    double start_length; /* m, its length at the start */
};

struct tl_strain_limits {
    double strain; /* 0: no limit */
    size_t count;
    struct tl_limited_edge *edges; /* [count] as in the topology */
    bool *due, *always;            /* [count] to be tested: in this sweep; in every substep */
    bool *corrected;               /* [count] corrected in the last substep */
    bool any_corrected;
    uint32_t (*sides)[3][TL_BATCH]; /* [membrane_count] edges of each batch of membranes */
    struct tl_stretch_watch watch;  /* for tl_xpbd_solve */
    double elapsed_s;
};

/* Limits every edge longer than `shortest` metres at rest, for cloth that is at positions `x`. */
struct tl_strain_limits tl_strain_limits_create(const struct tl_topology *topology,
                                                const struct tl_energy *energy, const vec2s (*rest)[3],
                                                double shortest, double strain, const vec3d *x);
/* Restarts at positions `x`: edges that exceed the limit there are shortened at a limited speed, as after
 * creation. */
void tl_strain_limits_restart(struct tl_strain_limits *limits, const vec3d *x);
void tl_strain_limits_release(struct tl_strain_limits *limits);

/* After tl_xpbd_solve in a substep of h seconds: shortens edges that are too long, in a sweep forwards
 * through the list and one backwards; edges that were too long at the start, at a limited speed. */
void tl_strain_limits_solve(struct tl_strain_limits *limits, const struct tl_energy *energy, double h,
                            struct tl_particles *particles);

#endif
