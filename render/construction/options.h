/* Table "construction": how the garment is sewn. */
#ifndef TOILE_RENDER_CONSTRUCTION_OPTIONS_H
#define TOILE_RENDER_CONSTRUCTION_OPTIONS_H

#include "assets/base/material.h"
#include "config/options.h"

/* Garments that show seams and hems: those whose pieces have one scale, all, or none. */
enum tl_construction_show { TL_CONSTRUCTION_AUTO, TL_CONSTRUCTION_ALWAYS, TL_CONSTRUCTION_NEVER };

struct tl_construction_params { /* table "construction": from the fabric or by hand */
    int show;                   /* enum tl_construction_show */
    int seam, hem;              /* enum tl_seam, enum tl_hem */
    float hem_mm, thickness_mm, stitch_mm, thread_mm, pucker_mm;
    float thread[3];
};
extern const struct tl_option_table tl_construction_options;

struct tl_construction tl_construction_of(const struct tl_construction_params *params);

#endif
