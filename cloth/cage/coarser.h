/* A coarser cloth of the same garment, on which settling begins: long waves, which a fine mesh takes
 * thousands of substeps to pass on, travel far over few triangles. The cage (assets/halfmesh) has the rest
 * lengths, the grain, the pins and the weight of the cloth; its vertices are some of the cloth's.
 *
 * Carrying: every vertex has a place on the cage and an offset from it, both taken where the coarser cloth
 * was made. Where the cage has moved to, the offset is turned as the cage's corners have turned around that
 * place (the best rotation of each corner's neighbours), so that folds finer than the cage are carried along
 * and not sheared. Where the cage has folded in another way, neighbours turn so differently that offsets
 * increase the strain: they are left out if that leaves less strain or fewer crossings (a skirt of 16,000
 * vertices: 2.3 instead of 5.5 %, 0 instead of 106). A smooth surface through the cage's corners (Phong
 * tessellation) in place of its triangles was tried: where folds are sharp it bulges, which doubled the
 * strain after carrying and made crossings.
 *
 * Metres. Threads: one at a time per cloth; carrying uses all. */
#ifndef TOILE_CLOTH_CAGE_COARSER_H
#define TOILE_CLOTH_CAGE_COARSER_H

#include "cloth/state.h"

typedef struct tl_coarser tl_coarser;

/* Makes a coarser cloth of about `vertex_target` vertices at the cloth's present positions, at rest, with all
 * its params. NULL when it cannot be made much coarser, or has seams that are open. */
tl_coarser *tl_coarser_create(const tl_cloth *cloth, size_t vertex_target);
void tl_coarser_destroy(tl_coarser **handle);

/* The coarser cloth, to be settled. Lifetime: until tl_coarser_destroy. */
tl_cloth *tl_coarser_cloth(tl_coarser *coarser);

/* Moves the free vertices of the cloth that the coarser one was made of to where that has come to; they are
 * at rest then. Forgets contacts. */
void tl_coarser_carry(const tl_coarser *coarser, tl_cloth *cloth);

/* ---- In motion (caged.c) ---- */

/* Takes the positions, velocities, pins, fabric and params of the cloth that it was made of, and is
 * near to balance there (cage_rest.h). tl_coarser_bind must follow. */
void tl_coarser_restart(tl_coarser *coarser, const tl_cloth *cloth);

/* The cloth follows from where the two are now. */
void tl_coarser_bind(tl_coarser *coarser, const tl_cloth *cloth);

/* Moves the free particles of the cloth that it was made of with the coarser cloth (follower.h). */
void tl_coarser_follow(tl_coarser *coarser, const tl_collider *collider, const tl_cloth *cloth,
                       struct tl_particles *particles);

/* The corners of the triangle on which a particle lies, as particles of the cloth that it was made of, and
 * their shares, which are not negative; of one without a place, three times itself. */
void tl_coarser_place(const tl_coarser *coarser, uint32_t particle, uint32_t corners[3], float shares[3]);

/* The render vertex of the coarser cloth that has the largest share in a particle; TL_NONE: it has no place.
 */
uint32_t tl_coarser_vertex_near(const tl_coarser *coarser, uint32_t particle);

#endif
