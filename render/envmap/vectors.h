/* Directions of look-ups in environment maps, computed at the vertices of surfaces and interpolated without
 * renormalisation (TL_MAPS_VECTORS_VERTEX). A draw of the surfaces over the depth of the G-buffer keeps them
 * for every sample, so that the passes of the light read them as they read the G-buffer. World space; needs
 * the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_ENVMAP_VECTORS_H
#define TOILE_RENDER_ENVMAP_VECTORS_H

#include "render/envmap/options.h"
#include "render/gbuffer/gbuffer.h"

struct tl_vertex_vectors {
    tl_program program; /* made when first used */
    tl_target target;   /* RGBA32F: the reflected view vector and n . v; the direction of the light below */
};

/* Frees and zeroes. */
void tl_vertex_vectors_release(struct tl_vertex_vectors *vectors);
bool tl_vertex_vectors_reload(struct tl_vertex_vectors *vectors, tl_error *error);
/* Draws the surfaces that the G-buffer shows; the ground, if it is the last of them, as TL_MAPS_SURFACE.
 * False when the shader cannot be compiled. */
bool tl_vertex_vectors_draw(struct tl_vertex_vectors *vectors, tl_gpu *gpu, const tl_target *gbuffer,
                            const struct tl_view *view, const tl_surfaces *surfaces, size_t surface_count,
                            bool has_ground, const struct tl_maps_params *params, tl_error *error);

#endif
