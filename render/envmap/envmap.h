/* Classic environment mapping: the environment's light through lobes, poured into textures in one of the
 * layouts (env/layout.h), and a pass that looks it up for every sample of the G-buffer [Heidrich and Seidel
 * 1999, section 4]. Light is unshadowed:
 *
 *     SURFACE       kd E(n, 1) + F ks E(r, s)
 *     MIRROR        L(r)
 *     REFRACTION    L(t), t by Snell's law from the material's index; a back refracts out of the material,
 *                   and where that reflects totally t is r
 *     DIFFUSE       kd E(n, 1)
 *     GLOSSY        F ks E(r, s)                                                                      (eq. 9)
 *     TRANSMISSION  kd E(-v, s): the lobe straight through a thin sheet, dyed by it                    (4.5)
 *
 * With `fresnel` a mirror's light Lm lies over what is under it, Ld: of SURFACE and GLOSSY Lm = E(r, s), of
 * MIRROR, REFRACTION and TRANSMISSION L(r), L(r) and E(r, s); under it lies the diffuse light, or what is
 * refracted or transmitted. DIFFUSE shows Ld's part alone, GLOSSY Lm's.
 *
 *     ADDITIVE      F Lm + Ld
 *     COAT          F Lm + (1 - F) Ld
 *
 * F is the material's own (render/brdf), by a table over n . v, where maps that vary it do not count.
 *
 * L and E are what is in the map: L of its resolution. World space; needs the context of its tl_gpu. */
#ifndef TOILE_RENDER_ENVMAP_ENVMAP_H
#define TOILE_RENDER_ENVMAP_ENVMAP_H

#include "render/envmap/options.h"
#include "render/envmap/prefiltered_map.h"
#include "render/gbuffer/gbuffer.h"
#include "render/gbuffer/samples.h"
#include "render/scene/view.h"

/* Software drivers take both ways of every branch: what does not change within a picture is #defined. */
struct tl_envmap_variant {
    char *defines;
    tl_program program;
};

struct tl_envmap {
    struct tl_envmap_variant *variants; /* programs that were asked for so far */
    size_t variant_count;
    enum tl_layout layout; /* of what is in the texture */
    struct tl_mip_levels levels;
    tl_texture maps;                  /* layers by slot; faces and discs are layers too */
    int slots[TL_EXPONENT_COUNT + 1]; /* by exponent; -1: not there */
    mat3s turn;                       /* world -> picture */
    unsigned parts_buffer;            /* GL name: what the pass must know of the surfaces' parts */
    size_t parts_bytes;
    int part_count;
    bool has_ground, has_layers; /* what the parts are */
    tl_texture fresnel;          /* F over the cosine, a row for each part */
};

void tl_envmap_release(struct tl_envmap *envmap);
bool tl_envmap_reload(struct tl_envmap *envmap, tl_error *error);
size_t tl_envmap_bytes(const struct tl_envmap *envmap);
/* Of the textures that these settings will ask for. */
uint64_t tl_envmap_bytes_needed(const struct tl_maps_params *params, uint32_t exponents);

/* Pours all lobes that are made. `into_world`: directions of the lobes' frame -> world. `view`: a sphere map
 * is laid out about it, so that its centre shows what lies behind the eye and its singular rim what the view
 * looks at. */
void tl_envmap_fill(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_maps_params *params,
                    const struct tl_lobes *lobes, const mat3s *into_world, const struct tl_view *view);

/* Tells the parts' materials. The ground, which comes last, is always lit as SURFACE. */
void tl_envmap_set_parts(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_triangle_ranges *ranges,
                         bool has_ground);

struct tl_envmap_request {
    const tl_texture *triangles;       /* of the G-buffer */
    const tl_texture *exponent_levels; /* of tl_lighting */
    vec3s eye;
    const struct tl_maps_params *params;
};
/* Draws over the whole target that is bound, with the G-buffer in the first units (tl_lighting_begin). */
bool tl_envmap_draw(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_envmap_request *request,
                    tl_error *error);

#endif
