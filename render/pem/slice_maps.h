/* The slices of regions (slices.h) on the GPU, for slices.glsl.
 *
 * One array texture: one layer per region, in which the maps of all exponents are packed. RGB9_E5; all values
 * are stored multiplied by one power of two, so that a sun stays in range. Needs the GL context of its
 * tl_gpu. */
#ifndef TOILE_RENDER_PEM_SLICE_MAPS_H
#define TOILE_RENDER_PEM_SLICE_MAPS_H

#include "render/gpu/gpu.h"
#include "render/pem/slices.h"

struct tl_slice_maps {
    tl_texture texture; /* GL_TEXTURE_2D_ARRAY */
    unsigned frames;    /* GL name of a buffer: positions of the maps, frames of the regions */
};

/* Uploads the slices; replaces the previous ones. */
void tl_slice_maps_upload(struct tl_slice_maps *maps, tl_gpu *gpu, const struct tl_slices *slices);
/* Binds texture and buffer to the units and bindings of slices.glsl. */
void tl_slice_maps_bind(const struct tl_slice_maps *maps);
void tl_slice_maps_release(struct tl_slice_maps *maps);
size_t tl_slice_maps_bytes(const struct tl_slice_maps *maps); /* of the texture */

#endif
