/* Decimation of a triangle mesh that is drawn: by half-edge collapses of OpenMesh, the cheapest first, each
 * within a stated distance.
 *
 * A collapse moves a vertex onto a neighbour, so that what is left is a subset of the vertices, with their
 * attributes. Lines collapse along themselves only: borders, sides at which vertices of one place differ (a
 * seam of UVs or normals), sides between parts. Ends and crossings of lines stay. Costs are quadrics [Garland
 * and Heckbert 1997] with a term of the new edges' lengths, which decides where the surface is flat. Each
 * removed vertex is followed on the face that it is nearest to; a collapse is refused if one would then be
 * farther from the surface, or from its own UV, than allowed. Any list of triangles is accepted: a face that
 * OpenMesh refuses, because it makes an edge or a vertex that is not manifold, gets vertices of its own
 * there, and its corners stay.
 *
 * Metres. Lifetime: plain structs that own their arrays. Threads: pure; one core. */
#ifndef TOILE_ASSETS_HALFMESH_DECIMATE_H
#define TOILE_ASSETS_HALFMESH_DECIMATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* All borrowed. */
struct tl_decimate_source {
    size_t vertex_count, triangle_count;
    const float (*positions)[3];    /* [vertex_count] finite */
    const float (*uvs)[2];          /* [vertex_count] */
    const uint32_t *weld;           /* [vertex_count] the place of each, below vertex_count */
    const uint32_t (*triangles)[3]; /* vertices; those with two corners at one place are left out */
    const uint32_t *parts;          /* [triangle_count] */
    const float *uv_metres;         /* [part] metres per UV unit; 0: its UVs do not count */
    size_t triangle_target;         /* collapses end here, or where no further one is allowed */
    double distance_max_m, uv_max_m;
    /* Called several times a second, or NULL; false ends the collapses. */
    bool (*progress)(void *user, double share);
    void *user;
};

struct tl_decimated {
    size_t triangle_count;
    uint32_t (*triangles)[3]; /* vertices of the source */
    uint32_t *sources;        /* [triangle_count] the triangle of the source that each was, rising */
    double distance_m;        /* no vertex of the source is farther from the triangles */
};

/* False when it does not fit into memory; `out` is then empty. */
bool tl_decimate(const struct tl_decimate_source *source, struct tl_decimated *out);
void tl_decimated_release(struct tl_decimated *decimated);

#ifdef __cplusplus
}
#endif

#endif
