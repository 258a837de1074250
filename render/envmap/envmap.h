/* Classic environment mapping: the environment convolved with lobes, resampled to textures in one of the
 * layouts (env/layout.h), and a pass that looks it up for every sample of the G-buffer [Heidrich and Seidel
 * 1999, 4]. Light is unshadowed:
 *
 *     SURFACE       kd E(n, 1) + F ks E(r, s)
 *     MIRROR        L(r)
 *     REFRACTION    L(t), t by Snell's law from the material's index; a back face refracts out of the
 * material, and in case of total reflection t is r DIFFUSE       kd E(n, 1) GLOSSY        F ks E(r, s) (eq.
 * 9) TRANSMISSION  kd E(-v, s): the lobe straight through a thin sheet, coloured by it                (4.5)
 *
 * With `fresnel` a mirror's light Lm is combined with the light Ld below it. Lm is E(r, s) for SURFACE and
 * GLOSSY, L(r) for MIRROR and REFRACTION, and E(r, s) for TRANSMISSION. Ld is the diffuse, the refracted or
 * the transmitted light. DIFFUSE shows Ld only, GLOSSY Lm only.
 *
 *     ADDITIVE      F Lm + Ld
 *     COAT          F Lm + (1 - F) Ld
 *
 * F is that of the material (render/brdf), from a table over n . v, which ignores maps.
 *
 * The terms are drawn in one pass or in several (passes.c), with directions from pixels or from vertices
 * (vectors.h). Light maps (light_map.h) take the place of E(n, 1).
 *
 * L and E are the contents of the map; the sharpness of L is limited by its resolution. World space; needs
 * the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_ENVMAP_ENVMAP_H
#define TOILE_RENDER_ENVMAP_ENVMAP_H

#include "render/envmap/options.h"
#include "render/envmap/prefiltered_map.h"
#include "render/envmap/vectors.h"
#include "render/gbuffer/gbuffer.h"
#include "render/gbuffer/samples.h"
#include "render/light/light_buffer.h"
#include "render/scene/view.h"

/* A program variant. Software drivers execute both sides of every branch, so options that are constant over
 * an image are #defined. */
struct tl_envmap_variant {
    char *defines;
    tl_program program;
};

struct tl_envmap {
    struct tl_envmap_variant *variants; /* programs compiled so far */
    size_t variant_count;
    enum tl_layout layout; /* layout of the texture */
    struct tl_mip_levels levels;
    tl_texture maps;                  /* layers by slot; faces and discs are layers, too */
    int slots[TL_EXPONENT_COUNT + 1]; /* by exponent; -1: does not exist */
    mat3s turn;                       /* world to picture */
    unsigned parts_buffer;            /* GL name: the parts of the surfaces, for the pass */
    size_t parts_bytes;
    int part_count;
    bool has_ground, has_layers; /* properties of the parts */
    tl_texture fresnel;          /* F over the cosine, one row per part */
    bool has_colours;            /* ... that differs between the colours */
    tl_target passed; /* several passes: their sum, and a share in alpha; shares the G-buffer's depth */
    struct tl_vertex_vectors vectors; /* of TL_MAPS_VECTORS_VERTEX */
};

/* Frees and zeroes. */
void tl_envmap_release(struct tl_envmap *envmap);
/* Recompiles the shaders from their files; keeps the old ones and returns false on an error. */
bool tl_envmap_reload(struct tl_envmap *envmap, tl_error *error);
/* Size of textures and buffers. */
size_t tl_envmap_bytes(const struct tl_envmap *envmap);
/* Size of the textures that these settings will need. */
uint64_t tl_envmap_bytes_needed(const struct tl_maps_params *params, uint32_t exponents);

/* Fills the textures from all existing lobes. `into_world` transforms directions from the frame of the lobes
 * to world axes. A sphere map is laid out about `view`: its centre shows the direction behind the eye, and
 * its singular rim the view direction. */
void tl_envmap_fill(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_maps_params *params,
                    const struct tl_lobes *lobes, const mat3s *into_world, const struct tl_view *view);

/* Sets the parts and their materials. The ground, which comes last, is always lit as SURFACE. */
void tl_envmap_set_parts(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_triangle_ranges *ranges,
                         bool has_ground);

struct tl_envmap_request {
    const tl_target *gbuffer;
    const tl_texture *exponent_levels; /* of tl_lighting */
    const struct tl_view *view;
    const tl_surfaces *surfaces; /* that the G-buffer shows; the ground, if set, is the last one */
    size_t surface_count;
    const tl_texture
        *baked; /* diffuse light of every sample in place of the map's (light_map.h); NULL: none */
    const struct tl_maps_params *params;
};
/* Draws the light of all samples over a light buffer. False when a shader cannot be compiled. */
bool tl_envmap_draw(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_envmap_request *request,
                    struct tl_light_buffer *light, tl_error *error);

#endif
