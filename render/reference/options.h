/* Table "reference": the ray-traced reference (reference.h). */
#ifndef TOILE_RENDER_REFERENCE_OPTIONS_H
#define TOILE_RENDER_REFERENCE_OPTIONS_H

#include "config/options.h"

/* The horizon above which light counts: the interpolated normal's, with rays from the smooth surface; or the
 * triangle's own. */
enum tl_terminator { TL_TERMINATOR_SMOOTH, TL_TERMINATOR_GEOMETRIC };

struct tl_reference_params { /* table "reference" */
    int strata;              /* directions a replicate takes from the environment */
    int lobe_samples;        /* ... from the glossy lobe */
    int bounces;             /* for light that bounces as often as it likes */
    int bounce_samples;      /* paths a replicate sends from each lobe */
    int replicates;
    int terminator; /* enum tl_terminator */
};
extern const struct tl_option_table tl_reference_options;

#endif
