/* The weave's table, for as long as the settings are tested without it. */
#include "app/settings.h"

static const char *const patterns[] = {"none", "plain", "twill", "satin", NULL};

static const struct tl_option weave_rows[] = {
    TL_OPTION_ENUM(struct tl_weave_params, pattern, patterns, "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, warp_pitch_mm, 0.01, 100, "mm", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, weft_pitch_mm, 0.01, 100, "mm", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, crimp_mm, 0, 100, "mm", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, warp_gloss, -1, 1, "", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, weft_gloss, -1, 1, "", "-"),
    TL_OPTION_COLOUR(struct tl_weave_params, warp_tint, 0, 1, "-"),
    TL_OPTION_COLOUR(struct tl_weave_params, weft_tint, 0, 1, "-"),
};
const struct tl_option_table tl_weave_options =
    TL_OPTION_TABLE("weave", "-", weave_rows, struct tl_weave_params, .pattern = TL_WEAVE_PLAIN,
                    .warp_pitch_mm = 1, .weft_pitch_mm = 1);
