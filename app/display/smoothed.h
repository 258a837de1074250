/* A garment as it is drawn where it is drawn smoothly: each triangle as four on Loop's surface
 * (assets/topology/smooth.h). The cloth, its contacts and its measures keep the mesh as it is. Creases are
 * the seams of a garment whose pattern is known, and the hard edges of its file, where normals differ.
 * Metres. Threads: the session's. */
#ifndef TOILE_APP_DISPLAY_SMOOTHED_H
#define TOILE_APP_DISPLAY_SMOOTHED_H

#include "app/display/moving.h"
#include "assets/topology/smooth.h"
#include "cloth/cage/clearance.h"

struct tl_smoothed {
    tl_model model; /* its mesh: the file's vertices first, then one on each edge */
    struct tl_moving moving;
    struct tl_smooth weights;        /* of welded vertices */
    uint32_t *of_weld;               /* [weights.source_count] a vertex of the garment at each */
    uint32_t *weld;                  /* [model.mesh.vertex_count] */
    uint32_t (*ends)[2];             /* vertices of the garment: those of each new vertex's edge */
    struct tl_light_mesh light_mesh; /* the garment's vertices, and means of two on its edges */
    size_t source_count;             /* the garment's vertices */
    vec3s *coarse, *fine;            /* welded positions */
    struct tl_clearance *clearances; /* [weights.source_count] */
    vec3s *strains;                  /* of all vertices */
    bool *crossed;                   /* of all triangles */
    struct tl_mesh_part *parts;      /* as many as the mesh has */
    uint64_t revision;               /* of the motion that it shows */
};

/* The cloth's mesh is fine enough from here on. */
#define TL_SMOOTHED_TRIANGLES 40000

/* The garment's cloth, and what it lies on. Borrowed. */
struct tl_smoothed_cloth {
    const tl_cloth *cloth;
    const tl_collider *collider;
};

/* Leaves `out` empty, its model without a mesh, for a garment of more than TL_SMOOTHED_TRIANGLES. */
void tl_smoothed_make(const tl_garment *garment, const struct tl_smoothed_cloth *worn,
                      const tl_borders *borders, struct tl_smoothed *out);
void tl_smoothed_release(struct tl_smoothed *smoothed); /* frees and zeroes */

/* False after seams have closed, or before it was made: it must be made again, and has the same vertices. */
bool tl_smoothed_fits(const struct tl_smoothed *smoothed, const tl_cloth *cloth);

/* The surface that shows `garment`, the garment's own, whose arrays it borrows where they stay. */
tl_surface tl_smoothed_surface(struct tl_smoothed *smoothed, const struct tl_smoothed_cloth *worn,
                               const tl_surface *garment);

#endif
