/* Rasterises surfaces on the CPU with the arithmetic of software GL: the same pixels are covered, at the same
 * depths, as by llvmpipe of Mesa 22.3 on a CPU with fused multiplication and addition. Later versions cut
 * edges at the frustum and interpolate depths with other roundings; fill rule and grid are theirs, too.
 *
 * Vertices are transformed once, triangles are clipped, rounded to a grid of 1/256 pixel and sorted into
 * bands of rows, and each band is filled by one thread in the order in which the triangles are drawn. Results
 * are the same with any number of threads. */
#ifndef TOILE_RENDER_GBUFFER_RASTER_H
#define TOILE_RENDER_GBUFFER_RASTER_H

#include "assets/base/surface.h"

struct tl_raster_request {
    const tl_surface *const *surfaces; /* all their parts are drawn, both sides, in order; none has holes */
    size_t surface_count;
    mat4s view_projection; /* as GL has it: the frustum is -w .. w */
    int width, height;     /* pixels, at most TL_RASTER_SIDE_MAX each */
};

#define TL_RASTER_SIDE_MAX 16384

/* Working memory, used again from frame to frame. Threads: one at a time. */
struct tl_raster {
    struct raster_vertex *vertices; /* of all surfaces */
    struct raster_chunk *chunks;
    size_t vertex_capacity, chunk_count, chunk_capacity;
};

/* Writes `ids` [height][width], rows upwards: 0 where nothing is seen; else 1 + the number of the nearest
 * triangle, counted through all surfaces, and TL_SAMPLE_BACK where its back is seen. Of triangles at the same
 * depth the first one counts. Vertices that are not finite make their triangles disappear. */
void tl_raster_draw(struct tl_raster *raster, const struct tl_raster_request *request, uint32_t *ids);
void tl_raster_release(struct tl_raster *raster);
size_t tl_raster_bytes(const struct tl_raster *raster);

#endif
