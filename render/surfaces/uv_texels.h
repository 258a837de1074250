/* Texels over the UVs of a surface, for textures that hold something of each of its points: light maps,
 * normal maps that are lit. Pure; threads: any. */
#ifndef TOILE_RENDER_SURFACES_UV_TEXELS_H
#define TOILE_RENDER_SURFACES_UV_TEXELS_H

#include "assets/base/surface.h"

/* The box of a surface's UVs; an extent is never 0. */
void tl_uv_texels_box(const tl_surface *surface, vec2s *low, vec2s *extent);
/* The triangle that covers the middle of each of side x side texels, plus 1; 0: none. NULL when triangles
 * overlap: then some texel would stand for several points. Freed by the caller. */
uint32_t *tl_uv_texels_triangles(const tl_surface *surface, int side);
/* The barycentric coordinates of a texel's middle in a triangle. */
vec3s tl_uv_texels_weights(const tl_surface *surface, uint32_t triangle, vec2s low, vec2s extent, int side,
                           int texel);
/* Whether every point of the surface has a place of its own in UV, as far as texels of 1 / side resolve. */
bool tl_uv_texels_fit(const tl_surface *surface, int side);

#endif
