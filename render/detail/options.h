/* Options of fabric detail: the appearance of bumps, their shadows, and their minification. */
#ifndef TOILE_RENDER_DETAIL_OPTIONS_H
#define TOILE_RENDER_DETAIL_OPTIONS_H

#include "config/options.h"

/* NORMAL: normals by the square patch. BLINN: Blinn's form, with the derivatives of the surface. OFFSET: as
 * NORMAL, of maps that hold (-h_u, -h_v), whose averages are mean slopes. EYE_SPACE: Blinn's form of these
 * maps, with derivatives of vertices, interpolated. The others read all maps where the height field is
 * visible and bend the normal as NORMAL does. The reference draws OFFSET as NORMAL and EYE_SPACE as BLINN. */
enum tl_detail_mode {
    TL_DETAIL_NORMAL,
    TL_DETAIL_BLINN,
    TL_DETAIL_OFFSET,
    TL_DETAIL_EYE_SPACE,
    TL_DETAIL_PARALLAX,
    TL_DETAIL_PARALLAX_LIMITED,
    TL_DETAIL_RELIEF
};
/* HORIZON: shadows of lamps and of the environment by horizon maps. RELIEF: shadows of lamps by ray marching,
 * those of the environment by horizon maps. */
enum tl_detail_shadow { TL_DETAIL_SHADOW_NONE, TL_DETAIL_SHADOW_HORIZON, TL_DETAIL_SHADOW_RELIEF };
/* Number of horizon azimuths; looked up between the two nearest to the light. */
enum tl_detail_angles { TL_DETAIL_ANGLES_8, TL_DETAIL_ANGLES_16, TL_DETAIL_ANGLES_32 };
/* The variance added to the gloss where normals are averaged: none; one variance, from the length of the mean
 * normal [Toksvig 2005]; variances along u and v and their covariance, projected on
 * the view direction [Olano and Baker 2010]. */
enum tl_detail_minify { TL_DETAIL_MINIFY_NONE, TL_DETAIL_MINIFY_TOKSVIG, TL_DETAIL_MINIFY_LEAN };

struct tl_detail_params { /* table "detail" */
    int mode;             /* enum tl_detail_mode */
    int steps, refine;    /* relief: largest number of cone steps, then bisections */
    int shadow;           /* enum tl_detail_shadow */
    int angles;           /* enum tl_detail_angles */
    float height_scale;
    bool silhouette;               /* relief ends at the border of a map that does not repeat */
    bool curved;                   /* relief follows the curvature of the surface, and shows at its outline */
    int minify;                    /* enum tl_detail_minify */
    const char *normals, *heights; /* files of maps of the garment, or "" */
};
extern const struct tl_option_table tl_detail_options;

#endif
