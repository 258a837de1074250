/* Table "maps": classic environment mapping (envmap.h). */
#ifndef TOILE_RENDER_ENVMAP_OPTIONS_H
#define TOILE_RENDER_ENVMAP_OPTIONS_H

#include "config/options.h"

/* Look-up of paraboloids, and the light that is shown (render/envmap/envmap.h). */
enum tl_maps_look_up { TL_LOOK_UP_DIRECT, TL_LOOK_UP_MATRIX };
enum tl_maps_mode {
    TL_MAPS_SURFACE,
    TL_MAPS_MIRROR,
    TL_MAPS_REFRACTION,
    TL_MAPS_DIFFUSE,
    TL_MAPS_GLOSSY,
    TL_MAPS_TRANSMISSION
};
/* OFF: the reflectance of the G-buffer. The others: F from a table over the cosine, Lo = F Lm + Ld, or F Lm +
 * (1 - F) Ld [Heidrich and Seidel 1999, 4.4]. */
enum tl_maps_fresnel { TL_MAPS_FRESNEL_OFF, TL_MAPS_FRESNEL_ADDITIVE, TL_MAPS_FRESNEL_COAT };
/* ONE: everything in one pass. SEVERAL: a pass for every texture [Heidrich and Seidel 1999, 4.2, 4.4]
 * (render/envmap/passes.c). */
enum tl_maps_passes { TL_MAPS_PASSES_ONE, TL_MAPS_PASSES_SEVERAL };
/* Places at which directions of look-ups and Fresnel's cosine are computed: at pixels; or at vertices, from
 * where they are interpolated without renormalisation, as texture coordinates were [Heidrich and Seidel
 * 1999, 4.1]. */
enum tl_maps_vectors { TL_MAPS_VECTORS_PIXEL, TL_MAPS_VECTORS_VERTEX };
struct tl_maps_params {  /* table "maps", of TL_METHOD_MAPS */
    int layout;          /* enum tl_layout (render/env/layout.h) */
    int size;            /* texels, a power of two: side of a cube's face, height of the others */
    int look_up;         /* enum tl_maps_look_up, of paraboloids */
    int mode;            /* enum tl_maps_mode */
    int fresnel;         /* enum tl_maps_fresnel */
    bool minify;         /* mirrors read mip levels */
    int passes;          /* enum tl_maps_passes */
    int pass_target;     /* enum tl_pass_target (render/local/shading.h), of SEVERAL */
    float pass_white;    /* radiance of the largest value of TL_PASS_TARGET_FIXED8 */
    int vectors;         /* enum tl_maps_vectors */
    int light_map;       /* texels, side of the textures that diffuse light is baked into; 0: none */
    int capture_every;   /* frames between captures of the scene; 0: the environment only */
    float capture_at[3]; /* metres, from the centre of the casters */
};
extern const struct tl_option_table tl_maps_options;
#define TL_MAPS_SIZE_MIN 4
#define TL_MAPS_SIZE_MAX 512

#endif
