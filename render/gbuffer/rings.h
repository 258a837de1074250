/* The vertices around each vertex at which light is computed, to take means over: of the scene's surfaces in
 * order, numbered through. A vertex without light of its own (tl_light_mesh) has none.
 *
 * Errors: none. Lifetime: a plain struct that starts as {0} and owns its arrays. Threads: made by one, read
 * by any. */
#ifndef TOILE_RENDER_GBUFFER_RINGS_H
#define TOILE_RENDER_GBUFFER_RINGS_H

#include "render/gbuffer/samples.h"

struct tl_vertex_rings {
    size_t vertex_count;
    size_t *first;        /* [vertex_count + 1]: index into `neighbours` */
    uint32_t *counts;     /* [vertex_count] */
    uint32_t *neighbours; /* corners of a vertex's triangles, or those that a vertex takes its light from with
                             it */
};

/* The result is the caller's: tl_vertex_rings_release. */
struct tl_vertex_rings tl_vertex_rings_make(const struct tl_triangle_ranges *ranges);
void tl_vertex_rings_release(struct tl_vertex_rings *rings);
size_t tl_vertex_rings_bytes(const struct tl_vertex_rings *rings);

#endif
