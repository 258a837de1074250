/* What a surface does with light: two cosine lobes (the light model of the PEM method) and the maps that vary
 * them.
 *
 *     c = light arriving * [ diffuse * K_1(n) + F * specular * K_s(r) ],   s = 1 / (1 - glossiness)
 *
 * Immutable. Maps belong to the owner of the material (tl_model, tl_weave). */
#ifndef TOILE_ASSETS_MATERIAL_H
#define TOILE_ASSETS_MATERIAL_H

#include "assets/image.h"

#include <cglm/struct.h>

/* KHR_texture_transform: uv' = offset + R(rotation) * (scale * uv). Identity: scale 1, the rest 0. */
struct tl_uv_transform {
    float offset[2];
    float scale[2];
    float rotation; /* radians, counter-clockwise */
};

/* As the rows of a 2x3 matrix: u' = rows[0] u + rows[1] v + rows[2], v' = rows[3] u + rows[4] v + rows[5]. */
void tl_uv_transform_rows(const struct tl_uv_transform *transform, float rows[6]);
/* ... and applied. */
vec2s tl_uv_transformed(const struct tl_uv_transform *transform, vec2s uv);

struct tl_map {
    const tl_image *image; /* NULL: none */
    struct tl_uv_transform transform;
    bool clamp_u, clamp_v; /* else repeat */
};

/* A woven fabric's repeat, in metres: tiles over the surface in metric UV (see tl_mesh_part.uv_metres). Made
 * by assets/weave.h. All maps have the same size and are periodic. */
typedef struct tl_weave {
    float size_m[2]; /* metres per repeat along u (weft direction) and v (warp direction) */
    tl_image normal; /* U8 x3, linear: tangent space, +Y up (0.5 + 0.5 n) */
    tl_image height; /* F32 x1, metres */
    tl_image gloss;  /* F32 x1: what is added to the material's glossiness; mean about 0 */
    tl_image tint;   /* F32 x3: factor on the diffuse colour (yarn colours) */
} tl_weave;

typedef struct tl_material {
    char name[64];
    vec3s diffuse;            /* linear albedo at g-independent K_1; [0, 1] */
    vec3s specular;           /* F0: reflectance at normal incidence; [0, 1] */
    float glossiness;         /* g in [0, 1] */
    float normal_scale;       /* factor on the normal map's x and y */
    float occlusion_strength; /* [0, 1] */
    float alpha_cutoff;       /* alpha test; 0: opaque */
    bool double_sided;
    struct tl_map diffuse_map;   /* sRGB colour, alpha in the fourth channel */
    struct tl_map normal_map;    /* linear */
    struct tl_map gloss_map;     /* U8 x1, linear: multiplies glossiness */
    struct tl_map specular_map;  /* U8 x3, sRGB: multiplies specular */
    struct tl_map occlusion_map; /* U8, linear, red */
    const tl_weave *weave;       /* detail, or NULL */
} tl_material;

/* Matt mid-grey, no maps. */
tl_material tl_material_default(const char *name);

/* Glossiness of the cosine lobe about the mirror direction that is nearest to a GGX lobe of glTF roughness r:
 * alpha = r^2, Blinn-Phong exponent 2/alpha^2 - 2 (Walter 2007's match to Beckmann), Phong exponent a quarter
 * of that, at least 1. r = 0 gives 1. */
float tl_glossiness_from_roughness(float roughness);

#endif
