/* Seams: pairs of vertices that are pulled together by rigid links of decreasing length and then welded.
 *
 * Pulling before welding lets panels wrap around the body while contact keeps them outside; welding at once
 * would put the middle of a 30 cm gap inside the avatar. There is no gravity while seams close. Pairs that
 * something holds apart remain links. Lifetime: plain struct that owns its arrays. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_SEAMS_H
#define TOILE_CLOTH_DRIVE_SEAMS_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"

struct tl_seams {
    size_t pair_count;     /* open pairs */
    struct tl_link *links; /* [pair_count]; rest shrinks to 0 */
    double *gaps;          /* [pair_count] m, at the start */
    double elapsed_s;      /* since the seams began to close */
};

/* Keeps each pair of different physics vertices once; gaps are measured at positions `x`. */
struct tl_seams tl_seams_create(const struct tl_seam_pair *pairs, size_t pair_count, const uint32_t *weld,
                                const vec3d *x);
void tl_seams_release(struct tl_seams *seams);

/* Whether seams are still within the time that they have to close. */
bool tl_seams_are_closing(const struct tl_seams *seams);

/* Advances time by h seconds: the links get shorter. */
void tl_seams_shrink(struct tl_seams *seams, double h);

/* The same, and solves the links. */
void tl_seams_solve(struct tl_seams *seams, struct tl_particles *particles, double h);

/* Welds closed pairs: fills `joined` [particles->count] with the new number of each vertex and returns the
 * new number of vertices, which is the old one if nothing closed. Welded pairs are removed, the others
 * renumbered. */
size_t tl_seams_close(struct tl_seams *seams, const struct tl_particles *particles, uint32_t *joined);

#endif
