/* The table of experiments: what bench, trade, gallery, stability and the golden tests measure and draw.
 *
 * An experiment shows techniques in a scene, under one or more appearances, against a reference: the exact
 * evaluation. A technique is a set of option values. It is registered by one row of its family's list
 * (shading.c, maps.c, detail.c, light.c), which names it in every output that takes it:
 *
 *   table     `toile bench`: the times of all techniques in one run, printed or as JSON
 *   page      `toile trade`: error against time in recorded motion, as HTML and CSV
 *   pictures  `toile gallery`: each technique beside its reference, as PNG, HTML and CSV
 *   bounds    `toile stability`: each technique in extreme scenes, passed or failed
 *   golden    tests/app/lab/test_golden.c: each technique against the image that it drew when it was accepted
 *
 * Everything is const data with static lifetime; functions are pure unless stated otherwise. */
#ifndef TOILE_APP_LAB_EXPERIMENTS_EXPERIMENT_H
#define TOILE_APP_LAB_EXPERIMENTS_EXPERIMENT_H

#include "app/measure/measure.h"

enum tl_output {
    TL_OUTPUT_TABLE,
    TL_OUTPUT_PAGE,
    TL_OUTPUT_PICTURES,
    TL_OUTPUT_BOUNDS,
    TL_OUTPUT_GOLDEN,
    TL_OUTPUTS
};

#define TL_EXPERIMENT_ASSIGNMENTS 16
#define TL_EXPERIMENT_APPEARANCES 5
#define TL_EXPERIMENT_IDS         2

/* One way of doing something: a row of a family's list. */
struct tl_technique {
    union { /* its name in each output; NULL: the output leaves it out */
        const char *names[TL_OUTPUTS];
        struct {
            const char *table, *page, *picture, *bound, *golden; /* golden: its file's name */
        };
    };
    const char *group; /* page: its curve and its table */
    const char *id;    /* pictures: its row of the technique set, "A3" */
    struct tl_setup setup;
    double budget_ms; /* page: the governor chooses the levels for this budget; 0: as set up */
    bool quick;       /* page: part of a quick run */
    bool shown;       /* page: its picture is shown beside the reference */
    bool once;        /* pictures, page: under the first appearance only */
};

/* An appearance of the garment and its light. */
struct tl_experiment_appearance {
    const char *name, *title;
    const char *assignments[TL_EXPERIMENT_ASSIGNMENTS]; /* over the experiment's; NULL ends them */
    const char *reference[6];                           /* over the reference's */
    bool uniform_sky;                                   /* environment: radiance 1 in every direction */
};

struct tl_experiment {
    const char *name, *title, *text; /* "a3"; heading; what is seen, and what the papers say of it */
    const char *scene;               /* built-in */
    const char *solid;               /* pictures: garment of the first object, "sphere" or "torus" */
    const char *solid_only[6];       /* ... over all other settings of that object */
    const char *base[TL_EXPERIMENT_ASSIGNMENTS];        /* over the scene's settings */
    struct tl_setup reference;                          /* the exact evaluation */
    const struct tl_experiment_appearance *appearances; /* NULL: one, as `base` has it */
    const struct tl_technique *techniques; /* the family's list; used are those that `output` takes ... */
    size_t technique_count;
    const char *ids[TL_EXPERIMENT_IDS]; /* ... pictures: and that have one of these ids */
    enum tl_output output;              /* its writer; the golden test draws some of the pictures, too */
    int appearance_count, quick_appearance;
    int warm_up, measured; /* page: frames before the first measured one, and those measured */
    bool rests;            /* page: the last frame is drawn until it rests, too */
    bool by_wall;          /* page: plots show wall time; else CPU time of all threads */
    bool by_flip; /* pictures: errors are mean FLIP, for images of edges; page: FLIP of the garment, as
                     shown; else relative RMSE */
    bool reference_alone; /* the reference leaves out the technique's settings, so that all share one */
};

/* The next technique of the experiment that `output` takes; `after` NULL: the first. NULL past the last one.
 */
const struct tl_technique *tl_experiment_next(const struct tl_experiment *experiment, enum tl_output output,
                                              const struct tl_technique *after);
size_t tl_experiment_count(const struct tl_experiment *experiment, enum tl_output output);

/* The names of an option's choices, NULL-terminated: of "model" in tl_material_options those of all
 * reflectance models. The option must exist. */
const char *const *tl_experiment_choices(const struct tl_option_table *table, const char *option);

#endif
