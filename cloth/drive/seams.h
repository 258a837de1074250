/* Seams: pairs of vertices that are pulled together at a bounded speed, and then welded.
 *
 * A pull shortens a seam's thread by a bounded speed from its present length: a thread that is held loses
 * nothing and stores nothing. (A link that shrinks on a clock asks for all that it missed at once, and
 * tears.) Drawing before welding lets panels wrap around the body while contact keeps them outside; welding
 * at once would put the middle of a 30 cm gap inside the avatar. Seams close gently at first, when the
 * cloth's strain limit is stronger than they are, and firmly at last. There is no gravity meanwhile. Pairs
 * that are still apart then remain links. Lifetime: plain struct that owns its arrays. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_SEAMS_H
#define TOILE_CLOTH_DRIVE_SEAMS_H

#include "cloth/contact/collider.h"
#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"

/* Two vertices whose straight thread passes through the body, and the point in the air over which they come
 * together. */
struct tl_seam_way {
    uint32_t a, b;
    vec3d over; /* m */
};

struct tl_seams {
    size_t pair_count;       /* open pairs */
    struct tl_link *links;   /* [pair_count]; rest is set by every substep */
    double elapsed_s;        /* since the seams began to close */
    double firm_s, welded_s; /* of that time, when they became firm (0: not yet), and when pairs were last
                                welded */
    size_t way_count;
    struct tl_seam_way *ways; /* while they are needed */
    double next_close_s;      /* when closed pairs are welded next */
};

/* Keeps each pair of different physics vertices once. */
struct tl_seams tl_seams_create(const struct tl_seam_pair *pairs, size_t pair_count, const uint32_t *weld);
void tl_seams_release(struct tl_seams *seams);

/* Finds the way of every pair whose thread passes through the collider: from the middle of the thread in the
 * direction in which both panels end there (a sleeve's upper edge points up, its lower edge down), as far as
 * it takes to see both ends. x [topology->vertex_count]. */
void tl_seams_find_ways(struct tl_seams *seams, const struct tl_topology *topology, const vec3d *x,
                        const tl_collider *collider);

/* Whether seams are still within the time that they have to close. */
bool tl_seams_are_closing(const struct tl_seams *seams);
/* Whether they are stronger than the cloth's strain limit: once gentle ones close no further. */
bool tl_seams_are_firm(const struct tl_seams *seams);
/* Whether firm ones close no further either: something holds the rest apart. */
bool tl_seams_are_stuck(const struct tl_seams *seams);
/* 1/s, of the cloth while they close: panels that coast pass their seam, and each other. */
double tl_seams_drag(const struct tl_seams *seams);

/* Advances time by h seconds: sets the links' lengths from their lengths at the substep's start, and solves
 * the links and the ways. */
void tl_seams_solve(struct tl_seams *seams, struct tl_particles *particles, double h);

/* Welds closed pairs: fills `joined` [particles->count] with the new number of each vertex and returns the
 * new number of vertices, which is the old one if nothing closed. Welded pairs are removed, the others
 * renumbered. */
size_t tl_seams_close(struct tl_seams *seams, const struct tl_particles *particles, uint32_t *joined);

#endif
