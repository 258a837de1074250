/* Materials that have a golden alone: a clear coat, fuzz, knits, open cloth that shows what is behind it, a
 * weave of two yarns. */
#include "app/lab/experiments/rows_internal.h"

static const struct tl_technique coats[] = {
    {.golden = "coat", SET("material.coat=1", "material.coat_glossiness=0.98")},
};

static const struct tl_technique fuzzes[] = {
    {.golden = "fuzz", SET("material.fuzz=1", "material.fuzz_colour=[0.9, 0.6, 0.3]")},
};

static const struct tl_technique open_cloths[] = {
    {.golden = "open_cloth", SET("material.openness=0.4")},
    {.golden = "open_cloth_transmission",
     SET("material.openness=0.2", "material.transmission=[0.3, 0.2, 0.1]")},
};

static const struct tl_technique weaves[] = {
    {.golden = "weave_satin",
     SET("weave.pattern=satin", "weave.texels_per_yarn=16", "weave.warp_pitch_mm=20",
         "weave.weft_pitch_mm=20", "weave.crimp_mm=2", "weave.weft_gloss=-0.6")},
    {.golden = "weave_rib",
     SET("weave.pattern=rib", "weave.texels_per_yarn=16", "weave.wale_mm=14", "weave.course_mm=11",
         "weave.yarn_mm=6", "weave.streaks=0.3")},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_GOLDEN,
     .name = "coat",
     .title = "A clear coat",
     .scene = "gallery",
     .solid = "torus",
     .base = {"light.method=unshadowed"},
     TECHNIQUES(coats)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "fuzz",
     .title = "Short fibres that stand on cloth",
     .scene = "gallery",
     .solid = "torus",
     .base = {"light.method=unshadowed"},
     TECHNIQUES(fuzzes)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "weave",
     .title = "A satin of matt wefts, and a rib knit",
     .scene = "gallery",
     .solid = "torus",
     .base = {LAMPLIT},
     TECHNIQUES(weaves)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "open cloth",
     .title = "Open cloth over a ball",
     .scene = "gallery",
     .solid = "sheet",
     .base = {"scene.avatar=ball", "cloth.edge_m=0.05", "camera.target=[0, 0.27, 0]",
              "camera.distance_m=1.15", "light.method=unshadowed"},
     TECHNIQUES(open_cloths)},
};
const struct tl_experiment_list tl_material_experiments = {experiments, TL_COUNT(experiments)};
