/* The holes that alpha cuts into surfaces (trace/cutout.h), as words that kernels read (trace/holes.glsl): 0:
 * there are none; else how many triangles, and of each its record, 0: it is whole. A record is its image, its
 * cutoff, and the place of each corner in texels; an image its width, its height, the sides at which it ends,
 * and its alpha in bytes. Pure; threads: any. */
#ifndef TOILE_RENDER_TRACE_HOLES_H
#define TOILE_RENDER_TRACE_HOLES_H

#include "assets/base/surface.h"

/* The words for surfaces whose triangles are numbered one surface after the other. They are the caller's;
 * *count: how many. */
uint32_t *tl_holes_make(const tl_surface *const *surfaces, size_t surface_count, size_t *count);

#endif
