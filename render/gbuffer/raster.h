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
#include "render/scene/view.h"

struct tl_raster_request {
    const tl_surface *const *surfaces; /* all their parts are drawn, both sides, in order; none has holes */
    size_t surface_count;
    mat4s view_projection; /* as GL has it: the frustum is -w .. w */
    int width, height;     /* pixels, at most TL_RASTER_SIDE_MAX each */
    bool is_layered;       /* what lies behind parts of an open material is wanted, too */
};

#define TL_RASTER_SIDE_MAX 16384

/* Destination of the pixels: [height][width] each, rows upwards. */
struct tl_raster_layers {
    uint32_t *nearest;
    /* Outputs of a layered request: layers behind open triangles, layer by layer, and the number of these
     * layers that hold something in each row. Rows of further layers hold 0, before the call and after it. */
    uint32_t *behind[TL_TRANSPARENCY_LAYERS];
    uint8_t *depths; /* [height] */
};

/* Working memory, used again from frame to frame. Threads: one at a time. */
struct tl_raster {
    struct raster_vertex *vertices; /* of all surfaces */
    struct raster_chunk *chunks;
    size_t vertex_capacity, chunk_count, chunk_capacity;
};

/* Writes 0 where nothing is seen; else 1 + the number of the triangle, counted through all surfaces, and
 * TL_SAMPLE_BACK where its back is seen. Of triangles at the same depth the first one counts, and no other is
 * seen behind it. Vertices that are not finite make their triangles disappear. */
void tl_raster_draw(struct tl_raster *raster, const struct tl_raster_request *request,
                    const struct tl_raster_layers *layers);
void tl_raster_release(struct tl_raster *raster);
size_t tl_raster_bytes(const struct tl_raster *raster);

#endif
