/* The slices of regions (slices.h) on the GPU, for slices.glsl.
 *
 * One array texture: a layer a region, which holds the maps of all exponents that were made beside each
 * other. RGB9_E5; all values are stored times one power of two, so that a sun stays in range. */
#ifndef TOILE_RENDER_PEM_SLICE_MAPS_H
#define TOILE_RENDER_PEM_SLICE_MAPS_H

#include "render/gpu/gpu.h"
#include "render/pem/slices.h"

struct tl_slice_maps {
    tl_texture texture; /* GL_TEXTURE_2D_ARRAY */
    unsigned frames;    /* GL name of a buffer: places of the maps, frames of the regions */
};

/* Replaces what was there. */
void tl_slice_maps_upload(struct tl_slice_maps *maps, tl_gpu *gpu, const struct tl_slices *slices);
/* At the units and bindings that slices.glsl names. */
void tl_slice_maps_bind(const struct tl_slice_maps *maps);
void tl_slice_maps_release(struct tl_slice_maps *maps);
size_t tl_slice_maps_bytes(const struct tl_slice_maps *maps); /* of the texture */

#endif
