/* The ID buffer by rays, on the graphics card: where its pipeline of triangles is slower than its shaders.
 * The result is that of the raster (raster.h), but for pixels whose middle lies within the raster's grid of
 * an edge.
 *
 * Owns its program; needs the context of its tl_gpu, on whose thread it is used. */
#ifndef TOILE_RENDER_GBUFFER_PRIMARY_H
#define TOILE_RENDER_GBUFFER_PRIMARY_H

#include "render/scene/view.h"
#include "render/trace/tree_buffers.h"

/* All zeros: the program is made when first used. */
struct tl_primary {
    tl_program program;
};

struct tl_primary_request {
    const struct tl_tree_buffers *tree; /* of all that is drawn, fitted to this frame */
    const struct tl_view *view;
    const tl_texture *ids; /* R32UI, of the picture's size: as tl_id_buffer.ids, rows upwards */
};

/* Begins to write the IDs; what reads them comes after a tl_gpu_barrier. Errors: TL_INPUT when the program
 * does not compile. */
bool tl_primary_trace(struct tl_primary *primary, tl_gpu *gpu, const struct tl_primary_request *request,
                      tl_error *error);
/* Compiles the program again. */
bool tl_primary_reload(struct tl_primary *primary, tl_error *error);
void tl_primary_release(struct tl_primary *primary);

#endif
