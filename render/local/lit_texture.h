/* A normal map lit in texture space [Heidrich and Seidel 1999, 5.1]: the normals of all texels over
 * the UVs of a part are multiplied by one matrix, which yields their cosines with light, viewer and halfway
 * vector, and tables of these cosines give the light. What is lit is a texture that is then mapped to the
 * part as any other, so that its mip levels average light and not normals. The texels' normals are in world
 * space, so that the matrix is one for all of a curved part; a normal map in tangent space comes there by the
 * frame at each texel.
 *
 * A texel holds f_r cos over `scale`, cos a, and whether it is of the part; sums over these are divided by
 * the last, so that texels beyond the edge of the UVs have no weight. Front and back have a layer each. One
 * part and lamp at a time. Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_LOCAL_LIT_TEXTURE_H
#define TOILE_RENDER_LOCAL_LIT_TEXTURE_H

#include "assets/base/surface.h"
#include "render/gpu/gpu.h"
#include "render/local/shading.h"

/* The place of a part's texels. */
struct tl_lit_chart {
    size_t surface, part; /* with the next two lines the key */
    uint64_t revision;
    int side;
    bool fits;         /* no two points of the part have one place in UV */
    vec2s low, extent; /* the box of its UVs, which the texture covers */
};

struct tl_lit_texture {
    size_t chart_count;
    struct tl_lit_chart *charts;
    unsigned framebuffer; /* GL name */
    tl_texture light, cover;
};

/* Frees and zeroes. */
void tl_lit_texture_release(struct tl_lit_texture *lit);
/* Size of the textures. */
size_t tl_lit_texture_bytes(const struct tl_lit_texture *lit);

/* The chart of a part, valid until the next call; NULL where UVs overlap. */
const struct tl_lit_chart *tl_lit_texture_chart(struct tl_lit_texture *lit, const tl_surface *surface,
                                                size_t index, size_t part, int side);
/* Begins drawing texels of one of `layers` layers, 0 the front, 1 the back, which are cleared. `target`: enum
 * tl_pass_target. */
void tl_lit_texture_begin(struct tl_lit_texture *lit, tl_gpu *gpu, int target, int side, int layers,
                          int layer);
/* Averages the mip levels of what was drawn. */
void tl_lit_texture_end(const struct tl_lit_texture *lit);

#endif
