/* Sizes of the built-in cuts: what a maker changes of a draft. Table "cut". Metres. */
#ifndef TOILE_ASSETS_CUT_OPTIONS_H
#define TOILE_ASSETS_CUT_OPTIONS_H

#include "config/options.h"

struct tl_cut_params {
    float ease_m;   /* more around bust, waist and hip; half of it around arms and legs */
    float longer_m; /* the hem is lower by this length of cloth */
    float sleeve_m; /* sleeves are longer by this */
};
extern const struct tl_option_table tl_cut_options;

#endif
