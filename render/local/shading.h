/* Shading of surfaces by lamps: table "shading". The defaults shade exactly. Every other setting is an
 * approximation that hardware without shaders, or with little precision, used [Heidrich and Seidel 1999, 3;
 * Schroecker 2002, 4 and 5]. */
#ifndef TOILE_RENDER_LOCAL_SHADING_H
#define TOILE_RENDER_LOCAL_SHADING_H

#include "config/options.h"
#include "render/brdf/normalise.h"
#include "render/brdf/power.h"

#include <stdbool.h>

/* The place of evaluation of the reflectance model: at vertices; at pixels with interpolated vectors as they
 * are; at pixels with renormalised vectors. */
enum tl_frequency { TL_FREQUENCY_GOURAUD, TL_FREQUENCY_FAST_PHONG, TL_FREQUENCY_PHONG };
/* The origin of the cosines: from the normal by one matrix, with constant light and view directions [Heidrich
 * and Seidel 1999, eq. 2 and 3]; computed at vertices and interpolated; from vectors at pixels. */
enum tl_coordinates { TL_COORDINATES_MATRIX, TL_COORDINATES_VERTEX, TL_COORDINATES_PIXEL };
enum tl_reflectance_by { TL_REFLECTANCE_DIRECT, TL_REFLECTANCE_TABLE, TL_REFLECTANCE_FACTORED };
/* The terms that a table of one material holds: its gloss; or its ambient and diffuse light as well, where
 * one table can (tl_table_terms_refusal). */
enum tl_table_terms { TL_TERMS_GLOSS, TL_TERMS_ALL };
enum tl_pass_target { TL_PASS_TARGET_FIXED8, TL_PASS_TARGET_FLOAT };
extern const char *const tl_pass_target_names[]; /* ends with NULL */
/* The space in which bumps are lit: at pixels in world space, or by vectors taken into tangent space at
 * vertices; or at the texels of a texture over the UVs of each part with bumps, which is then mapped to it
 * (render/local/lit_texture.h); or at pixels with normals from a texture over these UVs that holds them in
 * object space (render/local/object_map.h). */
enum tl_space { TL_SPACE_WORLD, TL_SPACE_TANGENT, TL_SPACE_TEXTURE, TL_SPACE_OBJECT };
enum tl_self_shadow { TL_SELF_SHADOW_STEP, TL_SELF_SHADOW_RAMP };

struct tl_shading_params {
    int frequency;             /* enum tl_frequency */
    int coordinates;           /* enum tl_coordinates */
    int reflectance;           /* enum tl_reflectance_by */
    int table_terms;           /* enum tl_table_terms, for TABLE */
    int table_size;            /* texels, side */
    int table_precision;       /* enum tl_precision (render/brdf/tables/tables.h) */
    int table_range;           /* enum tl_table_range: treatment of the singular factor */
    int max_textures_per_pass; /* tables; a model with more takes several passes */
    int pass_target;           /* enum tl_pass_target: precision of the product of several passes */
    int normalisation;         /* enum tl_normalisation, for PHONG: renormalisation of interpolated vectors */
    int power;                 /* enum tl_power, for DIRECT with a model that is a power */
    int space;                 /* enum tl_space, for vectors at pixels */
    int texture_size;          /* texels, side; of TEXTURE and OBJECT, whose precision is pass_target */
    float ambient;   /* share of a lamp's irradiance that arrives evenly from all directions; [0, 1] */
    int self_shadow; /* enum tl_self_shadow */
};
extern const struct tl_option_table tl_shading_options;

#endif
