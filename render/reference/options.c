#include "render/reference/options.h"
#include "render/plan/affects.h"

typedef struct tl_reference_params reference_params;
static const char *const terminator_names[] = {"smooth", "geometric", NULL};

static const struct tl_option reference_rows[] = {
    TL_OPTION_INT(reference_params, strata, TL_AFFECTS_REFERENCE, 1, 65536, "",
                  "environment samples per replicate; larger: more exact, slower"),
    TL_OPTION_INT(reference_params, lobe_samples, TL_AFFECTS_REFERENCE, 1, 4096, "",
                  "samples of the glossy lobe per replicate; larger: less noise in mirrors"),
    TL_OPTION_INT(reference_params, bounces, TL_AFFECTS_REFERENCE, 1, 16, "",
                  "how often light is followed from surface to surface where light.bounce is all; larger: "
                  "more exact in white folds, slower"),
    TL_OPTION_INT(reference_params, bounce_samples, TL_AFFECTS_REFERENCE, 1, 4096, "",
                  "paths from each lobe of a point per replicate; larger: less noise in light that bounced"),
    TL_OPTION_INT(reference_params, replicates, TL_AFFECTS_REFERENCE, 1, 65536, "",
                  "independent images, whose mean is the result and whose spread gives its standard error, "
                  "which needs at least 2"),
    TL_OPTION_ENUM(reference_params, terminator, TL_AFFECTS_REFERENCE, terminator_names,
                   "end of light: at the horizon of the interpolated normal, with rays from the smooth "
                   "surface, or at that of the triangle"),
};
const struct tl_option_table tl_reference_options =
    TL_OPTION_TABLE("reference", "the ray-traced reference", reference_rows, reference_params, .strata = 512,
                    .lobe_samples = 8, .bounces = 4, .bounce_samples = 8, .replicates = 4,
                    .terminator = TL_TERMINATOR_SMOOTH);
