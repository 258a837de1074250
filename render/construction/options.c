#include "render/construction/options.h"

static const char *const show_names[] = {"auto", "always", "never", NULL};
static const char *const seam_names[] = {"none",     "plain", "topstitched", "flat_felled",
                                         "overlock", "bound", NULL};
static const char *const hem_names[] = {"none", "plain", "topstitched", "twice", "bound", NULL};

#define AFFECTS (TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE | TL_AFFECTS_AT_ONCE)
/* Plies lie on each other at that distance. */
#define THICKNESS_AFFECTS (TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE | TL_AFFECTS_CLOTH | TL_AFFECTS_DRAPE)

typedef struct tl_construction_params construction_params;
static const struct tl_option rows[] = {
    TL_OPTION_ENUM(
        construction_params, show, AFFECTS, show_names,
        "seams, hems and stitches along the borders of pieces (UV islands); auto: where the UV map "
        "has one scale, as patterns have"),
    TL_OPTION_ENUM(construction_params, seam, AFFECTS, seam_names, "how pieces are joined"),
    TL_OPTION_ENUM(construction_params, hem, AFFECTS, hem_names,
                   "how free edges are finished; twice: two rows, as by a twin needle; bound: in tape"),
    TL_OPTION_FLOAT(construction_params, hem_mm, AFFECTS, 4, 28, "mm",
                    "width of hems; curved edges, as at a neck, have narrower ones"),
    TL_OPTION_FLOAT(
        construction_params, thickness_mm, THICKNESS_AFFECTS, 0.02, 5, "mm",
        "thickness of the cloth; larger: allowances and folds stand out more, plies lie farther apart"),
    TL_OPTION_FLOAT(construction_params, stitch_mm, AFFECTS, 0.5, 10, "mm",
                    "length of a stitch of visible rows"),
    TL_OPTION_FLOAT(construction_params, thread_mm, AFFECTS, 0.05, 2, "mm", "diameter of their thread"),
    TL_OPTION_COLOUR(construction_params, thread, AFFECTS, 0, 1, "colour of their thread"),
    TL_OPTION_FLOAT(construction_params, pucker_mm, AFFECTS, 0, 3, "mm",
                    "height of the waves beside seams; larger: sewn with more tension"),
};
const struct tl_option_table tl_construction_options = TL_OPTION_TABLE(
    "construction", "how the garment is sewn: seams, hems and stitches", rows, construction_params,
    .seam = TL_SEAM_PLAIN, .hem = TL_HEM_PLAIN, .hem_mm = 20, .thickness_mm = 0.25f, .stitch_mm = 2.8f,
    .thread_mm = 0.4f, .thread = {0.5f, 0.5f, 0.5f}, .pucker_mm = 0.25f);

struct tl_construction tl_construction_of(const struct tl_construction_params *params)
{
    const float mm = 0.001f;
    return (struct tl_construction){.seam = params->seam,
                                    .hem = params->hem,
                                    .hem_m = mm * params->hem_mm,
                                    .thickness_m = mm * params->thickness_mm,
                                    .stitch_m = mm * params->stitch_mm,
                                    .thread_m = mm * params->thread_mm,
                                    .pucker_m = mm * params->pucker_mm,
                                    .thread = {{params->thread[0], params->thread[1], params->thread[2]}}};
}
