/* Peaks: skin that comes through cloth between the cloth's vertices.
 *
 * Contact keeps vertices and samples of the cloth outside the avatar, and a vertex of the avatar where it is
 * pointed, as at a nipple or an elbow, still pierces a triangle whose corners are all outside. SI, world.
 * Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_PEAKS_H
#define TOILE_CLOTH_CONTACT_PEAKS_H

#include "cloth/contact/collider.h"
#include "cloth/contact/sample.h"

struct tl_peak {
    struct tl_contact_sample at; /* the point of the cloth that is nearest to the vertex of the skin */
    double beyond_m;             /* m from the cloth to the skin, outwards; less than 0 below it */
};

/* The skin by cells of a grid. Create with tl_skin_grid_create, end with tl_skin_grid_release. */
struct tl_skin_grid {
    size_t count;
    struct tl_skin_vertex *vertices; /* [count] */
    size_t mask;                     /* buckets of the grid - 1 */
    uint32_t *first;                 /* [buckets + 2] */
    uint32_t *items;                 /* [count] rising within a bucket */
};
/* Takes vertices that are more pointed than `point` (collider.h); -1: all. */
struct tl_skin_grid tl_skin_grid_create(const tl_collider *collider, double phase, double point);
void tl_skin_grid_release(struct tl_skin_grid *skin);

/* Finds where vertices of the skin are beyond the cloth at `x`, or below it by less than `below_m`; returns
 * how many, in an order that depends on both meshes only. Triangles none of whose corners is `near`
 * [topology->vertex_count] are left out; NULL: none is. Skin farther than 6 mm beyond is that of another part
 * of the body. The caller frees `out`. */
size_t tl_peaks_find(const struct tl_skin_grid *skin, const struct tl_topology *topology, const vec3d *x,
                     const bool *near, double below_m, struct tl_peak **out);

#endif
