/* Simplification of heavy bodies. A scan of 760,000 triangles looks like one of 80,000 and takes many times
 * as long to draw, because light is computed at each vertex.
 *
 * Vertices are removed, none is moved (assets/halfmesh/decimate.h): those that stay keep their normals, UVs,
 * skin weights and morph offsets. Seams of UVs, sides between parts and borders stay within the same
 * distance. Vertices of one place that differ in their normals only become one: a body's normals are
 * recomputed from its places. Distances are those of the rest pose; where a skin bends or stretches the body
 * they grow with it. Metres. */
#ifndef TOILE_ASSETS_TOPOLOGY_SIMPLIFY_H
#define TOILE_ASSETS_TOPOLOGY_SIMPLIFY_H

#include "assets/base/model.h"

/* Bodies of more triangles are simplified, to this many where the distance allows it. */
#define TL_SIMPLIFY_ABOVE  ((size_t)100000)
#define TL_SIMPLIFY_TARGET ((size_t)64000)
/* No vertex of the body is farther from the simplified one. Scanners measure to about as much, and cloth is
 * as thick. */
#define TL_SIMPLIFY_DISTANCE_M 3e-4
/* A removed vertex keeps its place in a texture within this, measured on the surface: a pixel of 4096 that go
 * around a body is as large. */
#define TL_SIMPLIFY_UV_M 5e-4

struct tl_simplified {
    size_t before, after; /* triangles; equal: the model is as it was */
    double distance_m;    /* no vertex of the model was farther from the new triangles */
};

/* Simplifies a model of more than TL_SIMPLIFY_ABOVE triangles, and leaves it as it is when a quarter of its
 * triangles cannot be spared: loose triangles, or UVs that are all split. `weld` [mesh.vertex_count] numbers
 * places, below vertex_count, equal for vertices at one place. Points keep their numbers in the file. Shows
 * progress: 760,000 triangles take three seconds of one core. An interrupt ends it early.
 *
 * Errors: none; where the memory is not allowed the model stays as it is, with a line in the log. Lifetime:
 * the model stays the caller's; its arrays are replaced. Threads: one per model. */
struct tl_simplified tl_simplify_model(tl_model *model, const uint32_t *weld);

/* "body.ply: 760000 triangles drawn as 64000, within 0.21 mm"; NULL when it is as it was. New string. */
char *tl_simplified_describe(const char *name, const struct tl_simplified *simplified);

#endif
