/* The other axes of the trade, and the chart over all of them. */
#include "app/lab/trade/trade.h"
#include "config/memory.h"

#define FRONT                                                                                                \
    "Down and left is better. Every mark is one choice of settings that drew the same moving cloth; the "    \
    "dashed line joins those that nothing else beats in both. "

/* ---- Resolution: samples of the image, against nine times as many ---- */

static const struct tl_trade_look resolution_looks[] = {
    {"plain", "plain satin", {"material.use_file=false", "material.glossiness=0.7"}, {NULL}, false},
    {"woven",
     "woven satin",
     {"material.use_file=false", "material.glossiness=0.7", "weave.pattern=satin", "weave.warp_pitch_mm=1.5",
      "weave.weft_pitch_mm=1.5", "weave.crimp_mm=0.2"},
     {NULL},
     false},
};

static const struct tl_entrant resolution_entrants[] = {
    {"scale", {"scale 0.35", NULL, {"image.scale=0.35"}}, false, true, 0},
    {"scale", {"scale 0.5", NULL, {"image.scale=0.5"}}, true, true, 0},
    {"scale", {"scale 0.6", NULL, {"image.scale=0.6"}}, false, false, 0},
    {"scale", {"scale 0.7", NULL, {"image.scale=0.7"}}, false, true, 0},
    {"scale", {"scale 0.85", NULL, {"image.scale=0.85"}}, false, false, 0},
    {"scale", {"scale 1", NULL, {NULL}}, true, true, 0},
    {"supersample", {"1 sample", NULL, {NULL}}, false, false, 0},
    {"supersample", {"4 samples", NULL, {"image.supersample=2"}}, true, true, 0},
    {"supersample", {"9 samples", NULL, {"image.supersample=3"}}, false, false, 0},
};

const struct tl_trade_axis tl_trade_resolution = {
    .name = "resolution",
    .title = "The trade of resolution: error against time",
    .text = FRONT "The truth is ray traced with nine samples a pixel, so that edges and threads count.",
    .scene = "review",
    .truth = {.name = "reference",
              .assignments = {"light.method=reference", "light.lobe=dual", "image.supersample=3"}},
    .looks = resolution_looks,
    .look_count = TL_COUNT(resolution_looks),
    .entrants = resolution_entrants,
    .entrant_count = TL_COUNT(resolution_entrants),
    .warm = 16,
    .measured = 3,
};

/* ---- Detail: one lamp on bumps that can be seen, and on bumps that cannot ---- */

#define LAMPLIT                                                                                              \
    "scene.environment=none", "light.method=unshadowed", "lamp.kind=directional", "lamp.pitch_deg=25",       \
        "material.use_file=false"
#define WOVEN(pitch, crimp)                                                                                  \
    "weave.pattern=plain", "weave.warp_pitch_mm=" pitch, "weave.weft_pitch_mm=" pitch, "weave.crimp_mm=" crimp

static const struct tl_trade_look detail_looks[] = {
    {"coarse",
     "threads of twelve pixels",
     {WOVEN("20", "5")},
     {"detail.mode=relief", "detail.steps=256", "detail.refine=16", "detail.shadow=relief"},
     false},
    {"fine",
     "threads finer than a pixel",
     {WOVEN("0.8", "0.2"), "material.glossiness=0.8"},
     {"detail.minify=none", "image.supersample=8"},
     false},
};

static const struct tl_entrant detail_entrants[] = {
    {"mode", {"normal", NULL, {NULL}}, true, true, 0},
    {"mode", {"Blinn", NULL, {"detail.mode=blinn"}}, false, false, 0},
    {"mode", {"parallax", NULL, {"detail.mode=parallax"}}, false, false, 0},
    {"mode", {"parallax, limited", NULL, {"detail.mode=parallax_limited"}}, false, true, 0},
    {"mode", {"relief", NULL, {"detail.mode=relief"}}, true, true, 0},
    {"shadow", {"normal, horizon", NULL, {"detail.shadow=horizon"}}, false, true, 0},
    {"shadow",
     {"limited, horizon", NULL, {"detail.mode=parallax_limited", "detail.shadow=horizon"}},
     false,
     false,
     0},
    {"shadow", {"relief, horizon", NULL, {"detail.mode=relief", "detail.shadow=horizon"}}, false, false, 0},
#define RELIEF(n)                                                                                            \
    {                                                                                                        \
        "steps",                                                                                             \
            {"relief " n ", shadow",                                                                         \
             NULL,                                                                                           \
             {"detail.mode=relief", "detail.shadow=relief", "detail.steps=" n}},                             \
            false, false, 0                                                                                  \
    }
    RELIEF("4"),
    RELIEF("8"),
    RELIEF("16"),
    RELIEF("32"),
    RELIEF("64"),
    RELIEF("128"),
    {"minify", {"no minification", NULL, {"detail.minify=none"}}, true, true, 0},
    {"minify", {"Toksvig", NULL, {"detail.minify=toksvig"}}, false, false, 0},
    {"minify", {"LEAN", NULL, {"detail.minify=lean"}}, false, true, 0},
};

const struct tl_trade_axis tl_trade_detail = {
    .name = "detail",
    .title = "The trade of fabric detail: error against time",
    .text = FRONT "One lamp. Of threads that can be seen the truth is a march of 256 steps with its own "
                  "shadows; of those that cannot, 64 samples a pixel.",
    .scene = "review",
    .base = {LAMPLIT},
    .truth = {.name = "finest"},
    .looks = detail_looks,
    .look_count = TL_COUNT(detail_looks),
    .entrants = detail_entrants,
    .entrant_count = TL_COUNT(detail_entrants),
    .warm = 1,
    .measured = 9,
};

/* ---- Shading: one lamp, how a reflectance model is evaluated ---- */

static const struct tl_trade_look shading_looks[] = {
    {"Phong", "Phong", {"material.glossiness=0.9", "material.specular=[0.15, 0.15, 0.15]"}, {NULL}, false},
    {"Torrance-Sparrow",
     "Torrance-Sparrow",
     {"material.model=torrance_sparrow", "material.width_weft=0.25", "material.fresnel=dielectric"},
     {NULL},
     false},
    {"Ward",
     "Ward",
     {"material.model=ward", "material.width_weft=0.4", "material.width_warp=0.1",
      "material.specular=[0.15, 0.15, 0.15]"},
     {NULL},
     false},
};

#define BY_TABLE "shading.reflectance=table"
#define TABLE(size, precision)                                                                               \
    {                                                                                                        \
        "tables",                                                                                            \
            {"table " size ", " precision,                                                                   \
             NULL,                                                                                           \
             {BY_TABLE, "shading.table_size=" size, "shading.table_precision=" precision}},                  \
            false, false, 0                                                                                  \
    }
static const struct tl_entrant shading_entrants[] = {
    {"frequency", {"Phong shading", NULL, {NULL}}, true, true, 0},
    {"frequency", {"fast Phong", NULL, {"shading.frequency=fast_phong"}}, false, false, 0},
    {"frequency", {"Gouraud", NULL, {"shading.frequency=gouraud"}}, true, true, 0},
    {"coordinates", {"cosines at vertices", NULL, {"shading.coordinates=vertex", BY_TABLE}}, false, true, 0},
    {"coordinates", {"cosines by matrix", NULL, {"shading.coordinates=matrix", BY_TABLE}}, false, false, 0},
    TABLE("32", "fixed8"),
    TABLE("32", "float"),
    TABLE("128", "fixed8"),
    TABLE("128", "fixed16"),
    TABLE("512", "float"),
    {"normalisation", {"not normalised", NULL, {"shading.normalisation=none"}}, false, false, 0},
    {"normalisation", {"8-bit cube", NULL, {"shading.normalisation=cube8"}}, true, true, 0},
    {"normalisation", {"16-bit cube", NULL, {"shading.normalisation=cube16"}}, false, false, 0},
    {"normalisation", {"Newton step", NULL, {"shading.normalisation=newton"}}, false, false, 0},
    {"power", {"power by squaring, 8 bit", NULL, {"shading.power=fixed8"}}, false, false, 0},
    {"power", {"power by table", NULL, {"shading.power=table"}}, false, false, 0},
    {"space", {"tangent space", NULL, {"shading.space=tangent"}}, false, false, 0},
};

const struct tl_trade_axis tl_trade_shading = {
    .name = "shading",
    .title = "The trade of shading under a lamp: error against time",
    .text = FRONT "The truth is the formula itself, at every pixel, with vectors made unit.",
    .scene = "review",
    .base = {LAMPLIT},
    .truth = {.name = "formula"},
    .looks = shading_looks,
    .look_count = TL_COUNT(shading_looks),
    .entrants = shading_entrants,
    .entrant_count = TL_COUNT(shading_entrants),
    .warm = 1,
    .measured = 9,
};

/* ---- Overall: presets, and what the planner makes of a budget ---- */

static const struct tl_trade_look overall_looks[] = {
    {"studio",
     "g = 0.7 in the studio",
     {"material.use_file=false", "material.diffuse=[0.5, 0.5, 0.5]", "material.specular=[0.5, 0.5, 0.5]",
      "material.glossiness=0.7"},
     {NULL},
     false},
};

static const struct tl_entrant overall_entrants[] = {
    {"presets", {"paper", "paper", {"light.lobe=dual"}}, true, true, 0},
    {"presets", {"draft", "draft", {NULL}}, true, true, 0},
    {"presets", {"review", "review", {NULL}}, true, true, 0},
    {"presets", {"final", "final", {NULL}}, false, true, 0},
    {"presets", {"unshadowed", "review", {"light.method=unshadowed"}}, false, true, 0},
    {"budget", {"8 ms", "review", {NULL}}, false, true, 8},
    {"budget", {"16 ms", "review", {NULL}}, false, true, 16},
    {"budget", {"25 ms", "review", {NULL}}, false, false, 25},
    {"budget", {"33 ms", "review", {NULL}}, true, true, 33},
    {"budget", {"50 ms", "review", {NULL}}, false, true, 50},
    {"budget", {"75 ms", "review", {NULL}}, false, false, 75},
    {"budget", {"100 ms", "review", {NULL}}, false, true, 100},
    {"budget", {"150 ms", "review", {NULL}}, false, false, 150},
    {"budget", {"200 ms", "review", {NULL}}, false, true, 200},
};

const struct tl_trade_axis tl_trade_overall = {
    .name = "overall",
    .title = "What a frame's time buys",
    .text =
        FRONT "The presets, and the planner from the preset review downwards at budgets of 8 to 200 ms; the "
              "truth is ray traced. Time is that of drawing: the motion was recorded before.",
    .scene = "review",
    .truth = {.name = "reference", .assignments = {"light.method=reference", "light.lobe=dual"}},
    .looks = overall_looks,
    .look_count = TL_COUNT(overall_looks),
    .entrants = overall_entrants,
    .entrant_count = TL_COUNT(overall_entrants),
    .warm = 60,
    .measured = 16,
    .by_wall = true,
    .by_flip = true,
};

/* ---- Levels: what each of the planner's knobs costs and errs by itself (app/budget/governor.c) ---- */

static const struct tl_trade_look level_looks[] = {
    {"one sample", "plain satin", {NULL}, {NULL}, false},
    {"four samples", "plain satin, four samples a pixel", {"image.supersample=2"}, {NULL}, false},
    {"relief",
     "threads of twelve pixels, marched",
     {WOVEN("20", "5"), "detail.mode=relief", "detail.steps=64"},
     {"detail.steps=256", "detail.refine=16"},
     false},
};

#define LIGHT(regions, refresh)                                                                              \
    {                                                                                                        \
        "regions",                                                                                           \
            {regions " regions, " refresh " renewed",                                                        \
             NULL,                                                                                           \
             {"light.regions=" regions, "light.refresh=" refresh}},                                          \
            false, false, 0                                                                                  \
    }
#define SCALE(value)                                                                                         \
    {                                                                                                        \
        "scale", {"scale " value, NULL, {"image.scale=" value}}, false, false, 0                             \
    }
static const struct tl_entrant level_entrants[] = {
    {"settings", {"review", NULL, {NULL}}, true, true, 0},
    LIGHT("192", "96"),
    LIGHT("192", "48"),
    LIGHT("192", "24"),
    LIGHT("192", "12"),
    LIGHT("192", "6"),
    LIGHT("96", "96"),
    LIGHT("96", "48"),
    LIGHT("96", "24"),
    LIGHT("96", "12"),
    LIGHT("96", "6"),
    LIGHT("48", "48"),
    LIGHT("48", "24"),
    LIGHT("48", "12"),
    LIGHT("48", "6"),
    LIGHT("24", "24"),
    LIGHT("24", "12"),
    LIGHT("24", "6"),
    LIGHT("24", "3"),
    {"steps", {"steps 32", NULL, {"detail.steps=32"}}, false, false, 0},
    {"steps", {"steps 16", NULL, {"detail.steps=16"}}, false, false, 0},
    {"steps", {"steps 8", NULL, {"detail.steps=8"}}, true, true, 0},
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

const struct tl_trade_axis tl_trade_levels = {
    .name = "levels",
    .title = "What each level of the planner costs and errs by itself",
    .text = FRONT "What the planner can turn (but the cloth, whose motion is recorded), from the preset "
                  "review; the truth is ray traced. What a level adds is what its error's square has over "
                  "that of the settings.",
    .scene = "review",
    .truth = {.name = "reference", .assignments = {"light.method=reference"}},
    .looks = level_looks,
    .look_count = TL_COUNT(level_looks),
    .entrants = level_entrants,
    .entrant_count = TL_COUNT(level_entrants),
    .warm = 24,
    .measured = 9,
    .by_wall = true,
    .by_flip = true,
};
