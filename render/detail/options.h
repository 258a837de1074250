/* Options of fabric detail: how bumps are seen, what shadows they cast, what becomes of them far away. */
#ifndef TOILE_RENDER_DETAIL_OPTIONS_H
#define TOILE_RENDER_DETAIL_OPTIONS_H

#include "config/options.h"

/* NORMAL: normals in a square patch. BLINN: his form, with the surface's own derivatives. The others read all
 * maps where the height field is seen, and bend the normal as NORMAL does. */
enum tl_detail_mode {
    TL_DETAIL_NORMAL,
    TL_DETAIL_BLINN,
    TL_DETAIL_PARALLAX,
    TL_DETAIL_PARALLAX_LIMITED,
    TL_DETAIL_RELIEF
};
/* HORIZON: of lamps and of the environment, by maps of horizons. RELIEF: lamps by a march, the environment by
 * horizons.
 */
enum tl_detail_shadow { TL_DETAIL_SHADOW_NONE, TL_DETAIL_SHADOW_HORIZON, TL_DETAIL_SHADOW_RELIEF };
/* Of horizons: looked up between the two that are nearest to the light. */
enum tl_detail_angles { TL_DETAIL_ANGLES_8, TL_DETAIL_ANGLES_16, TL_DETAIL_ANGLES_32 };
/* What is added to the gloss's width where normals are averaged: nothing; one variance, from how short their
 * mean is [Toksvig 2005]; variances along u and v, seen along the view [Olano and Baker 2010]. */
enum tl_detail_minify { TL_DETAIL_MINIFY_NONE, TL_DETAIL_MINIFY_TOKSVIG, TL_DETAIL_MINIFY_LEAN };

struct tl_detail_params { /* table "detail" */
    int mode;             /* enum tl_detail_mode */
    int steps, refine;    /* of relief: equal steps, then halvings */
    int shadow;           /* enum tl_detail_shadow */
    int angles;           /* enum tl_detail_angles */
    float height_scale;
    bool silhouette; /* relief ends where a map that does not repeat does */
    int minify;      /* enum tl_detail_minify */
};
extern const struct tl_option_table tl_detail_options;

#endif
