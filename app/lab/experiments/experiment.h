/* The table of experiments: what bench, trade, gallery, stability and the golden tests measure and draw.
 *
 * An experiment shows techniques in a scene, under one or more appearances, against a reference: the exact
 * evaluation. A technique is a set of option values. It is registered by one row of its family's list
 * (shading.c, maps.c, detail.c, light.c), which names it in every output that takes it:
 *
 *   page      `toile trade`: error against time in recorded motion, as a report and CSV; `toile bench`:
 * printed pictures  `toile gallery`: each technique beside its reference, as PNG, HTML and CSV bounds `toile
 * stability`: each technique in extreme scenes, passed or failed golden    tests/app/lab/test_golden.c: each
 * technique against the image that it drew when it was accepted
 *
 * Everything is const data with static lifetime; functions are pure unless stated otherwise. */
#ifndef TOILE_APP_LAB_EXPERIMENTS_EXPERIMENT_H
#define TOILE_APP_LAB_EXPERIMENTS_EXPERIMENT_H

#include "app/measure/measure.h"

enum tl_output { TL_OUTPUT_PAGE, TL_OUTPUT_PICTURES, TL_OUTPUT_BOUNDS, TL_OUTPUT_GOLDEN, TL_OUTPUTS };

#define TL_EXPERIMENT_ASSIGNMENTS 16
#define TL_EXPERIMENT_APPEARANCES 5
#define TL_EXPERIMENT_IDS         2
#define TL_EXPERIMENT_CLAIMS      3

/* One way of doing something: a row of a family's list. */
struct tl_technique {
    union { /* its name in each output; NULL: the output leaves it out */
        const char *names[TL_OUTPUTS];
        struct {
            const char *page, *picture, *bound, *golden; /* golden: its file's name */
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

/* pictures: what the exact picture of a section is. */
enum tl_exact {
    TL_EXACT_DRAWN,    /* drawn with the settings of the experiment's reference */
    TL_EXACT_INTEGRAL, /* the environment summed over all directions for every sample, without a map
                          (app/lab/gallery/integral.h): of light.method maps */
    TL_EXACT_NONE      /* there is none: the reference is another way of doing the same */
};

/* pictures: what moves from frame to frame in the strip below a picture. */
enum tl_picture_motion {
    TL_MOTION_NONE,
    TL_MOTION_CAMERA, /* turns by motion_step degrees a frame */
    TL_MOTION_LAMP,   /* the same */
    TL_MOTION_SKY,    /* the environment's sequence plays; motion_step frames from one picture to the next */
    TL_MOTION_CLOTH   /* the sheet falls; motion_step frames from one picture to the next */
};

/* pictures: a paper expects that one technique is nearer to the exact picture than another. The page compares
 * the measured errors and reports whether they agree; test `claims` knows where. */
struct tl_experiment_claim {
    const char *nearer, *farther; /* names of techniques in pictures */
    const char *source;           /* "[Schroecker 2002, figure 9]" */
    /* where on the solid it is not: "torus (edges of 4 cm)"; NULL: nowhere */
    const char *but;
};

struct tl_experiment {
    const char *name, *title; /* "a3"; heading */
    const char *text;         /* what is seen; results are measured and never part of it */
    /* pictures: of the techniques, "[Knuth et al. 2014, 5 and figure 6]"; NULL: this program */
    const char *source;
    const char *scene;         /* built-in */
    const char *solid;         /* pictures: garment of the first object, "sphere" or "torus" */
    const char *solid_only[6]; /* ... over all other settings of that object */
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
    bool by_flip;        /* pictures: errors are mean FLIP, for images of edges; page: FLIP of the garment, as
                            shown; else relative RMSE */
    enum tl_exact exact; /* pictures: what the reference's picture is ... */
    const char *exact_text;        /* ... in words: "the formula"; of TL_EXACT_NONE the reason */
    int side, supersample;         /* pictures: pixels of one, samples a pixel side; 0: 512, 2 */
    enum tl_picture_motion motion; /* pictures */
    float motion_step;
    struct tl_experiment_claim claims[TL_EXPERIMENT_CLAIMS]; /* pictures: {0} ends them */
    bool baked; /* pictures: its objects are coarse meshes and maps that were baked of finer ones, files of
                   which rows name "@coarse.obj", "@fine.obj", "@normals.png" and "@heights.exr" */
    bool photographed;    /* pictures: the exact weave is photographed from above and measured; rows wear the
                             pictures in "@photographs-06" of six lamps */
    bool sampled;         /* pictures: "@samples.txt" has samples of the exact picture's model */
    bool moving_sky;      /* pictures: its environment is a sequence of files, "@sky.####.exr" */
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
