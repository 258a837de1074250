/* Seams: pairs of vertices that are drawn together by rigid links of shrinking length and then become one.
 *
 * Pulling before welding lets panels wrap around what is between them, contact keeping them outside; merging
 * at once would put the middle of a 30 cm gap inside the avatar. Gravity waits while seams close. Pairs that
 * something holds apart stay links. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_SEAMS_H
#define TOILE_CLOTH_DRIVE_SEAMS_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"

struct tl_seams {
    size_t pair_count;     /* open pairs */
    struct tl_link *links; /* [pair_count]; rest shrinks to 0 */
    double *gaps;          /* [pair_count] m, at the start */
    double elapsed_s;      /* since sewing began */
};

/* Pairs of different physics vertices, each once. */
struct tl_seams tl_seams_create(const struct tl_seam_pair *pairs, size_t pair_count, const uint32_t *weld,
                                const vec3d *x);
void tl_seams_release(struct tl_seams *seams);

/* Seams are still being drawn together. */
bool tl_seams_are_closing(const struct tl_seams *seams);

/* Time passes: the links shrink. */
void tl_seams_shrink(struct tl_seams *seams, double h);

/* The same, and draws the sides together. */
void tl_seams_solve(struct tl_seams *seams, struct tl_particles *particles, double h);

/* Joins closed pairs: fills `joined` [particles->count] with the new number of each vertex and returns how
 * many there are; the same count as before when nothing closed. Closed pairs are dropped, the rest
 * renumbered. */
size_t tl_seams_close(struct tl_seams *seams, const struct tl_particles *particles, uint32_t *joined);

#endif
