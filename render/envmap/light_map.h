/* Light maps: diffuse light with shadows, baked into a texture over the UVs of each surface, for scenes in
 * which neither the light nor the surfaces move. Environment maps then read it in place of their own diffuse
 * light, which knows no shadows. It is gathered by the reference renderer's sampler from the environment, at
 * the smooth normals, without bumps and without light that bounces, for both sides of every surface. Whatever
 * moves has the maps baked again. A surface whose triangles overlap in UV has no place of its own for each of
 * its points there, and is baked at its vertices.
 *
 * World space; needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_ENVMAP_LIGHT_MAP_H
#define TOILE_RENDER_ENVMAP_LIGHT_MAP_H

#include "render/reference/request.h"
#include "render/scene/view.h"
#include "render/surfaces/surfaces.h"

/* A texel of the front and one of the back, RGBA32F. */
#define TL_LIGHT_MAP_TEXEL_BYTES 32

/* The place of a surface's light. */
struct tl_light_map_place {
    int layer;                         /* of its front, the back follows; -1: at vertices */
    vec2s low, extent;                 /* of its UVs, which fill the layer */
    size_t first_vertex, vertex_count; /* of its front in the buffer; those of the back follow */
};

struct tl_light_map {
    struct tl_light_map_place *places; /* by surface, the ground's last */
    size_t place_count;
    tl_texture texture; /* RGBA32F, two layers a surface with UVs of its own */
    unsigned buffer;    /* GL name: light at vertices, vec4 */
    size_t buffer_bytes;
    tl_program program; /* made when first used */
    tl_target target;   /* RGBA32F: the light of every sample */
};

/* Frees and zeroes. */
void tl_light_map_release(struct tl_light_map *map);
bool tl_light_map_reload(struct tl_light_map *map, tl_error *error);
size_t tl_light_map_bytes(const struct tl_light_map *map);

/* Bakes the frame of the request, whose view is not used, with this many texels a side and as many directions
 * as its strata; prints what was baked. Errors: TL_DEVICE if the BVH cannot be built, TL_INTERRUPTED. */
bool tl_light_map_bake(struct tl_light_map *map, tl_gpu *gpu, const struct tl_reference_request *request,
                       int side, tl_error *error);
/* Draws the light of the samples of a G-buffer into the target. */
bool tl_light_map_draw(struct tl_light_map *map, tl_gpu *gpu, const tl_target *gbuffer,
                       const struct tl_view *view, const tl_surfaces *surfaces, size_t surface_count,
                       tl_error *error);

#endif
