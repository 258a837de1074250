/* Experiments about the time of a frame: samples of the image, presets and budgets, and each of the
 * governor's levels alone. */
#include "app/lab/experiments/rows_internal.h"

#define SATIN "material.use_file=false", "material.glossiness=0.7"

/* ---- Resolution: samples of the image, against nine times as many ---- */

static const struct tl_technique resolution[] = {
    {.page = "scale 0.35", .group = "scale", SET("image.scale=0.35"), .shown = true},
    {.page = "scale 0.5", .group = "scale", SET("image.scale=0.5"), .quick = true, .shown = true},
    {.page = "scale 0.6", .group = "scale", SET("image.scale=0.6")},
    {.page = "scale 0.7", .group = "scale", SET("image.scale=0.7"), .shown = true},
    {.page = "scale 0.85", .group = "scale", SET("image.scale=0.85")},
    {.page = "scale 1", .group = "scale", .quick = true, .shown = true},
    {.page = "1 sample", .group = "supersample"},
    {.page = "4 samples", .group = "supersample", SET("image.supersample=2"), .quick = true, .shown = true},
    {.page = "9 samples", .group = "supersample", SET("image.supersample=3")},
};

static const struct tl_experiment_appearance cloths[] = {
    {.name = "plain", .title = "plain satin", .assignments = {SATIN}},
    {.name = "woven",
     .title = "woven satin",
     .assignments = {SATIN, "weave.pattern=satin", "weave.warp_pitch_mm=1.5", "weave.weft_pitch_mm=1.5",
                     "weave.crimp_mm=0.2"}},
};

/* A reference whose noise is a FLIP of about 0.01 on satin: one with less noise would take most of the run.
 */
#define QUICK_TRUTH                                                                                          \
    "light.method=reference", "reference.strata=256", "reference.lobe_samples=4", "reference.replicates=2"

/* ---- Overall: presets, and what the governor makes of a budget ---- */

#define BUDGET(ms) .page = #ms " ms", .group = "budget", PRESET("review"), .budget_ms = ms
static const struct tl_technique overall[] = {
    {.page = "paper", .group = "presets", PRESET("paper", NULL), .quick = true, .shown = true, .once = true},
    {.page = "draft", .group = "presets", PRESET("draft"), .quick = true, .shown = true},
    {.page = "review", .group = "presets", PRESET("review"), .quick = true, .shown = true},
    {.page = "unshadowed", .group = "presets", PRESET("review", "light.method=unshadowed"), .shown = true},
    {BUDGET(8), .shown = true},
    {BUDGET(16), .shown = true},
    {BUDGET(25)},
    {BUDGET(33), .quick = true, .shown = true},
    {BUDGET(50), .shown = true},
    {BUDGET(75)},
    {BUDGET(100), .shown = true},
    {BUDGET(150)},
    {BUDGET(200), .shown = true},
};

#define SIZE(width, height) "image.width=" width, "image.height=" height

/* The camera, the mesh and the size of the scene `review`, over the scene `dress`. */
#define CLOSE_UP                                                                                             \
    "scene.fabric=none", "camera.distance_m=1.55", "camera.target=[0, 1.15, 0]", "cloth.edge_m=0.0108",      \
        "image.ground=false", "image.width=512", "image.height=512"

/* Fabrics that people use, at the sizes of windows: the review window's own, and two screens'. */
#define WORN(fabric, words, width, height)                                                                   \
    {                                                                                                        \
        .name = (fabric), .title = (words), .assignments = { "scene.fabric=" fabric, SIZE(width, height) }   \
    }
#define SATIN_900  WORN("satin", "satin and its weave", "900", "800")
#define DENIM_1280 WORN("denim", "denim", "1280", "720")
#define VOILE_1920 WORN("voile", "voile", "1920", "1080")

static const struct tl_experiment_appearance worn[] = {
    SATIN_900,
    DENIM_1280,
    {.name = "plain",
     .title = "plain cloth close up, g = 0.7",
     .assignments = {CLOSE_UP, SATIN, "material.diffuse=[0.5, 0.5, 0.5]",
                     "material.specular=[0.5, 0.5, 0.5]"}},
    VOILE_1920, /* takes longest */
};

/* ---- Levels: time and error of each quality level alone (app/budget/quality.h) ---- */

#define REGIONS(n, renewed)                                                                                  \
    {                                                                                                        \
        .page = n " regions, " renewed " renewed", .group = "regions",                                       \
        SET("light.regions=" n, "light.refresh=" renewed), .once = true                                      \
    }
#define SCALE(value)                                                                                         \
    {                                                                                                        \
        .page = "scale " value, .group = "scale", SET("image.scale=" value)                                  \
    }
static const struct tl_technique levels[] = {
    {.page = "review", .group = "settings", .quick = true, .shown = true},
    REGIONS("192", "96"),
    REGIONS("192", "48"),
    REGIONS("192", "24"),
    REGIONS("192", "12"),
    REGIONS("192", "6"),
    REGIONS("96", "96"),
    REGIONS("96", "48"),
    REGIONS("96", "24"),
    REGIONS("96", "12"),
    REGIONS("96", "6"),
    REGIONS("48", "48"),
    REGIONS("48", "24"),
    REGIONS("48", "12"),
    REGIONS("48", "6"),
    REGIONS("24", "24"),
    REGIONS("24", "12"),
    REGIONS("24", "6"),
    REGIONS("24", "3"),
    {.page = "steps 32", .group = "steps", SET("detail.steps=32")},
    {.page = "steps 16", .group = "steps", SET("detail.steps=16")},
    {.page = "steps 8", .group = "steps", SET("detail.steps=8"), .quick = true, .shown = true},
    SCALE("0.841"),
    SCALE("0.707"),
    SCALE("0.595"),
    SCALE("0.5"),
    SCALE("0.42"),
    SCALE("0.354"),
    SCALE("0.297"),
    SCALE("0.25"),
    SCALE("0.21"),
    SCALE("0.177"),
    SCALE("0.149"),
    SCALE("0.125"),
};

static const struct tl_experiment_appearance samples[] = {
    SATIN_900,
    DENIM_1280,
    VOILE_1920,
    {.name = "one sample",
     .title = "satin and its weave, one sample a pixel",
     .assignments = {"scene.fabric=satin", SIZE("900", "800"), "image.supersample=1"}},
    {.name = "relief",
     .title = "threads of twelve pixels, marched",
     .assignments = {CLOSE_UP, WOVEN("20", "5"), "detail.mode=relief", "detail.steps=64"},
     .reference = {"detail.steps=256", "detail.refine=16"}},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PAGE,
     .name = "resolution",
     .title = "The trade of resolution: error against time",
     .text = FRONT "The reference is ray traced with nine samples a pixel, so that the error includes edges "
                   "and threads.",
     .scene = "review",
     .reference = {.assignments = {TRACED, "image.supersample=3"}},
     APPEARANCES(cloths),
     METHODS(resolution),
     .warm_up = 16,
     .measured = 3},
    {.output = TL_OUTPUT_PAGE,
     .name = "levels",
     .title = "Error and time of each quality level alone",
     .text = FRONT "The levels of each quality control alone, from the preset review; the reference is ray "
                   "traced. The error is FLIP of the displayed picture over the pixels of the garment. The "
                   "squared error that a level adds is the difference between its squared error and that of "
                   "the settings.",
     .scene = "dress",
     .reference = {.assignments = {QUICK_TRUTH}},
     APPEARANCES(samples),
     METHODS(levels),
     .warm_up = 24,
     .measured = 3,
     .by_wall = true,
     .by_flip = true},
    {.output = TL_OUTPUT_PAGE,
     .name = "overall",
     .title = "Error against the time budget of a frame",
     .text = FRONT "The presets, and the quality levels that the governor chooses from the preset review at "
                   "budgets of 8 to 200 ms; the reference is ray traced. The error is FLIP of the displayed "
                   "picture over the pixels of the garment. Times are those of drawing: the motion was "
                   "recorded before.",
     .scene = "dress",
     .reference = {.assignments = {QUICK_TRUTH, "light.lobe=dual"}},
     APPEARANCES(worn),
     METHODS(overall),
     .warm_up = 60,
     .measured = 16,
     .by_wall = true,
     .by_flip = true},
};
const struct tl_experiment_list tl_budget_experiments = {experiments, TL_COUNT(experiments)};
