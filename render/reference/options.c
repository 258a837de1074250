#include "render/affects.h"
#include "render/reference/options.h"

typedef struct tl_reference_params reference_params;
static const char *const terminator_names[] = {"smooth", "geometric", NULL};

static const struct tl_option reference_rows[] = {
    TL_OPTION_INT(reference_params, strata, TL_AFFECTS_REFERENCE, 1, 65536, "",
                  "directions that a replicate takes from the environment; more are truer and slower"),
    TL_OPTION_INT(reference_params, lobe_samples, TL_AFFECTS_REFERENCE, 1, 4096, "",
                  "directions that a replicate takes from the glossy lobe; more help mirrors"),
    TL_OPTION_INT(
        reference_params, replicates, TL_AFFECTS_REFERENCE, 1, 65536, "",
        "independent images whose mean is the answer and whose spread is its error; at least 2 tell it"),
    TL_OPTION_ENUM(reference_params, terminator, TL_AFFECTS_REFERENCE, terminator_names,
                   "horizon of the interpolated normal, rays from the smooth surface; or of the triangle"),
};
const struct tl_option_table tl_reference_options =
    TL_OPTION_TABLE("reference", "the ray-traced truth", reference_rows, reference_params, .strata = 512,
                    .lobe_samples = 8, .replicates = 4, .terminator = TL_TERMINATOR_SMOOTH);
