/* A garment's construction as seen from its border: profiles over the distance to a seam or a hem,
 * and where the rows of stitches lie. Pure; threads: any. */
#ifndef TOILE_RENDER_CONSTRUCTION_TABLES_H
#define TOILE_RENDER_CONSTRUCTION_TABLES_H

#include "assets/base/material.h"

/* CONSTRUCTION_LAST of construction_terms.glsl. */
#define TL_CONSTRUCTION_ENTRIES 257
enum { TL_CONSTRUCTION_PROFILES = 4 }; /* enum tl_border_kind */

struct tl_construction_tables {
    vec4s sizes; /* metres: width of the hem, period of stitches, amplitude of pucker, radius of the thread */
    vec4s rows;  /* metres from the border: two of a seam's upper side, two of a hem; 0: none */
    /* Values by distance in steps of CONSTRUCTION_STEP: height, integral of its squared slope, integral of
     * the shade (metres), envelope of pucker. */
    vec4s profiles[TL_CONSTRUCTION_PROFILES][TL_CONSTRUCTION_ENTRIES];
};

void tl_construction_tables_make(const struct tl_construction *construction,
                                 struct tl_construction_tables *out);

#endif
