/* Shared by the files of the families: their lists, and short forms for rows. Included by them and by the
 * table. */
#ifndef TOILE_APP_LAB_EXPERIMENTS_ROWS_INTERNAL_H
#define TOILE_APP_LAB_EXPERIMENTS_ROWS_INTERNAL_H

#include "app/lab/experiments/experiment.h"
#include "config/base/memory.h"

/* One family's experiments, in order. */
struct tl_experiment_list {
    const struct tl_experiment *items;
    size_t count;
};
extern const struct tl_experiment_list tl_shading_experiments, tl_maps_experiments, tl_detail_experiments,
    tl_light_experiments, tl_glossy_experiments, tl_cloth_experiments, tl_material_experiments,
    tl_budget_experiments;

/* Hems change gloss from pixel to pixel, which tables leave out, as A1 shows, and integrals, which take one
 * glossiness for all of a surface. */
#define UNSEWN "construction.show=never"

/* A technique's settings: assignments over the experiment's, or over a preset's. */
#define SET(...)          .setup = {.assignments = {__VA_ARGS__}}
#define PRESET(name, ...) .setup = {.preset = name, .assignments = {__VA_ARGS__}}

#define METHODS(list)      .techniques = (list), .technique_count = TL_COUNT(list)
#define APPEARANCES(array) .appearances = (array), .appearance_count = (int)TL_COUNT(array)

/* One directional lamp in the dark. */
#define LAMPLIT "scene.environment=none", "light.method=unshadowed", "lamp.kind=directional"
#define WOVEN(pitch_mm, crimp_mm)                                                                            \
    "weave.pattern=plain", "weave.warp_pitch_mm=" pitch_mm, "weave.weft_pitch_mm=" pitch_mm,                 \
        "weave.crimp_mm=" crimp_mm

/* The ray-traced reference, for two lobes. */
#define TRACED "light.method=reference", "light.lobe=dual"
/* Of pictures with four samples a pixel: as many rays a pixel in all as one sample with 256 strata. */
#define FEW_SAMPLES "reference.strata=64", "reference.lobe_samples=2", "reference.replicates=2"

/* Begins the text of every page. */
#define FRONT                                                                                                \
    "Down and left is better. Every mark is one choice of settings that drew the same moving cloth; the "    \
    "dashed line joins those that nothing else beats in both. "

#endif
