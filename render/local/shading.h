/* How surfaces are shaded under lamps: table "shading". Its defaults are the exact way; every other setting
 * is one of the ways in which hardware without shaders, or with little precision, came near to it [Heidrich
 * and Seidel 1999, section 3; Per-pixel lighting on the GeForce3, sections 4 and 5]. */
#ifndef TOILE_RENDER_LOCAL_SHADING_H
#define TOILE_RENDER_LOCAL_SHADING_H

#include "config/options.h"
#include "render/brdf/normalise.h"
#include "render/brdf/power.h"

#include <stdbool.h>

/* Where the reflectance model is evaluated: at vertices, or at pixels with vectors as interpolation leaves
 * them, or made unit again. */
enum tl_frequency { TL_FREQUENCY_GOURAUD, TL_FREQUENCY_FAST_PHONG, TL_FREQUENCY_PHONG };
/* Where the cosines come from that it is evaluated with: from the normal through one matrix, light and viewer
 * being the same for all [000, eq. 2 and 3]; computed at vertices and interpolated; from vectors at pixels.
 */
enum tl_coordinates { TL_COORDINATES_MATRIX, TL_COORDINATES_VERTEX, TL_COORDINATES_PIXEL };
enum tl_reflectance_by { TL_REFLECTANCE_DIRECT, TL_REFLECTANCE_TABLE };
enum tl_pass_target { TL_PASS_TARGET_FIXED8, TL_PASS_TARGET_FLOAT };
enum tl_space { TL_SPACE_WORLD, TL_SPACE_TANGENT };
enum tl_self_shadow { TL_SELF_SHADOW_STEP, TL_SELF_SHADOW_RAMP };

struct tl_shading_params {
    int frequency;             /* enum tl_frequency */
    int coordinates;           /* enum tl_coordinates */
    int reflectance;           /* enum tl_reflectance_by */
    int table_size;            /* texels, side */
    int table_precision;       /* enum tl_precision (render/brdf/tables.h) */
    int table_range;           /* enum tl_table_range (...): what becomes of the singular factor */
    int max_textures_per_pass; /* tables; a model that has more takes several passes */
    int pass_target;           /* enum tl_pass_target: what several passes multiply in */
    int normalisation;         /* enum tl_normalisation, of PHONG: how interpolated vectors become unit */
    int power;                 /* enum tl_power, of DIRECT with a model of a power */
    int space;                 /* enum tl_space, of vectors at pixels */
    int self_shadow;           /* enum tl_self_shadow */
};
extern const struct tl_option_table tl_shading_options;

#endif
