/* The fine mesh of a cloth that is moved by its cage.
 *
 * 1. Each vertex moves from where it was at the start by the blended rigid motions of the cage's vertices
 *    around it (skin.h); a vertex's motion is the best fit to those of its neighbours. Wrinkles finer
 *    than the cage move along, and sides of the cage's triangles do not show.
 * 2. What comes nearer to the body than a third of the cage's height above it is lifted to that.
 * 3. Where triangles cross (patches.h), as at folds that are sharper than the cage's triangles, they
 *    approach the flat triangles of the cage, which do not cross, until they do not either; from then on they
 *    return over some frames.
 * 4. Triangles that span a sharp side of the cage do not lie on it and may cross even then, mostly near a
 *    corner at which several sides are folded. Their vertices go to corners of the cage, so that they become
 *    triangles, sides or corners of it (simplicial.h). What crosses at the rim of those follows them;
 *    when all has, the mesh is the cage, which does not cross itself, but for what simplicial.h could not
 * map. In a gusty wind of 4 m/s or under the hand up to 160 of 121,000 vertices are in corners, in the worst
 * frame.
 *
 * Metres. Errors: none. Threads: one call at a time; parallel inside, with the same results at any number of
 * threads. */
#ifndef TOILE_CLOTH_CAGE_FOLLOWER_H
#define TOILE_CLOTH_CAGE_FOLLOWER_H

#include "assets/halfmesh/halfmesh.h"
#include "cloth/cage/clearance.h"
#include "cloth/mesh/particles.h"
#include "cloth/mesh/rigid.h"
#include "cloth/mesh/topology.h"

typedef struct tl_follower tl_follower;

/* Shares of a place that are not negative: where a border was straightened it lies beside the cage. */
void tl_cage_point_shares(const struct tl_cage_point *point, double out[3]);

/* The motion of the neighbourhood of a cage's vertex between two arrays of its vertices' places. `fans`:
 * corners of its triangles around each. */
struct tl_rigid tl_cage_motion(const struct tl_cage *cage, const struct tl_fans *fans, size_t vertex,
                               const vec3d *before, const vec3d *now);

/* `cage`, of the mesh with `topology`, and that are borrowed until tl_follower_destroy. */
tl_follower *tl_follower_create(const struct tl_cage *cage, const struct tl_topology *topology);
void tl_follower_destroy(tl_follower **follower);

/* Takes where the cage's vertices are, and the mesh's. */
void tl_follower_start(tl_follower *follower, const vec3d *places, const vec3d *x);

/* The cage as it has moved. Borrowed. */
struct tl_follower_cage {
    const vec3d *places;                   /* [cage's vertex_count] */
    const struct tl_clearance *clearances; /* the same */
    const tl_collider *collider;           /* NULL: none */
    bool self_contact;                     /* it does not cross itself */
};

/* Moves the mesh's free particles. */
void tl_follower_move(tl_follower *follower, const struct tl_follower_cage *cage,
                      struct tl_particles *particles);

#endif
