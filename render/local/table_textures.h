/* The tables of render/brdf as textures: factors of gloss, powers, unit vectors. Each is made when a surface
 * first needs it and destroyed after a frame in which none did. Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_LOCAL_TABLE_TEXTURES_H
#define TOILE_RENDER_LOCAL_TABLE_TEXTURES_H

#include "render/brdf/brdf.h"
#include "render/brdf/tables/measured.h"
#include "render/gpu/gpu.h"
#include "render/local/shading.h"

#define TL_GLOSS_TABLES_MAX 4 /* TL_BRDF_TABLES_MAX */

struct tl_gloss_table {
    tl_texture texture;
    float scale;   /* factor on the texels, which are in [0, 1] */
    float axes[4]; /* scale and bias of x, of y */
    int x, y;      /* enum tl_table_input */
    bool angles;   /* axes are acos of the inputs */
};

/* The tables of a material with constant gloss, or of a measured one. */
struct tl_gloss_tables {
    struct tl_brdf brdf; /* the key, with the next four lines */
    int reflectance, size, precision, range;
    bool folded;            /* ambient, diffuse and gloss in one table */
    vec3s ambient, diffuse; /* ... of these colours, times the irradiance; else 0 */
    uint64_t measured;      /* its hash; 0: not measured, else the rest of the key is 0 */
    bool used;              /* in this frame */
    int count;
    struct tl_gloss_table tables[TL_GLOSS_TABLES_MAX];
    bool times_cos_a;
};

struct tl_power_texture {
    float exponent; /* the key */
    bool used;
    tl_texture texture; /* R8, TL_POWER_TABLE_SIZE values over a cosine from 0 to 1 */
};

struct tl_table_textures {
    size_t gloss_count, power_count;
    struct tl_gloss_tables *gloss;
    struct tl_power_texture *powers;
    tl_texture cubes[2]; /* unit vectors in 8 and 16 bits */
    bool cubes_used[2];
};

/* Frees and zeroes. */
void tl_table_textures_release(struct tl_table_textures *textures);
/* Size of all textures. */
size_t tl_table_textures_bytes(const struct tl_table_textures *textures);
/* Enclose a frame: textures that were not requested between these calls are destroyed. */
void tl_table_textures_begin(struct tl_table_textures *textures);
void tl_table_textures_end(struct tl_table_textures *textures);

/* Why one table cannot hold all light of a material, which changes from texel to texel or has a part that
 * depends on more than two cosines; NULL: it can. */
const char *tl_table_terms_refusal(const tl_material *material);
/* The even light that a lamp of irradiance 1 stands for, reflected. */
vec3s tl_table_ambient(const tl_material *material, const struct tl_shading_params *params);
/* The tables of a material, factors of the formula or factored numerically; the pointer is valid until the
 * next call of a function of this header. */
const struct tl_gloss_tables *tl_table_textures_gloss(struct tl_table_textures *textures, tl_gpu *gpu,
                                                      const tl_material *material,
                                                      const struct tl_shading_params *params);
/* The same of a material that was measured. */
const struct tl_gloss_tables *tl_table_textures_measured(struct tl_table_textures *textures, tl_gpu *gpu,
                                                         const struct tl_measured *measured);
/* The table of an exponent; valid as above. */
const tl_texture *tl_table_textures_power(struct tl_table_textures *textures, tl_gpu *gpu, float exponent);
/* The normalisation cube map for CUBE8 or CUBE16; valid as above. */
const tl_texture *tl_table_textures_cube(struct tl_table_textures *textures, tl_gpu *gpu, int normalisation);

#endif
