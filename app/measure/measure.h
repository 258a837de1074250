/* Methods of light measured against the oracle: what bench, trade and stability share.
 *
 * A contender is one choice of light settings with a renderer of its own, so that its history is its own too.
 * Errors are those of render/metrics/compare.h, over covered pixels. Threads: the one that the GL context is
 * current on. */
#ifndef TOILE_APP_MEASURE_MEASURE_H
#define TOILE_APP_MEASURE_MEASURE_H

#include "app/measure/cost.h"
#include "app/measure/motion.h"
#include "app/scene/headless.h"

/* One choice of settings: a preset's light table, then single options. */
#define TL_CHOICE_ASSIGNMENTS 8
struct tl_choice {
    const char *name;
    const char *preset;                             /* NULL: the scene's own light */
    const char *assignments[TL_CHOICE_ASSIGNMENTS]; /* "table.key=value"; NULL ends them */
};

/* The scene's settings with the choice over them. */
bool tl_choice_apply(const struct tl_choice *choice, const struct tl_settings *scene, struct tl_settings *out,
                     tl_error *error);

struct tl_contender {
    const char *name; /* borrowed */
    struct tl_render_settings settings;
    tl_renderer *renderer;
};

/* `scene` gives all that a choice leaves open; the image's size and samples even where a preset has its own.
 */
bool tl_contender_create(struct tl_contender *contender, tl_gpu *gpu, const struct tl_choice *choice,
                         const struct tl_settings *scene, tl_error *error);
void tl_contender_release(struct tl_contender *contender);

/* True when a frame's image depends on the frames before it. */
bool tl_contender_remembers(const struct tl_contender *contender);

/* Draws and tells what it took. */
bool tl_contender_draw(struct tl_contender *contender, const tl_frame *frame, struct tl_taken *taken,
                       tl_error *error);

/* The settings that draw a contender's picture by the oracle. */
struct tl_choice tl_choice_oracle(void);

/* What the oracle says of a frame. */
struct tl_truth {
    tl_image image; /* as tl_renderer_read gives it; no texels: not drawn yet */
    double standard_error;
};
bool tl_truth_draw(struct tl_contender *oracle, const tl_frame *frame, struct tl_truth *out, tl_error *error);
void tl_truth_release(struct tl_truth *truth);

struct tl_measured_error {
    double
        rel_rmse; /* less the oracle's own: sqrt(measured^2 - standard error^2), for they are independent */
    double standard_error; /* the oracle's */
    double flip_mean;      /* with what the oracle's noise adds to it */
    double max_abs;
    double worst_share; /* of the square error: what its worst pixel holds */
    size_t covered;     /* pixels */
};
/* Of an image as tl_renderer_read gives it. */
bool tl_truth_compare(const tl_image *image, const struct tl_truth *truth, struct tl_measured_error *out,
                      tl_error *error);
/* Of the image that the contender drew last. */
bool tl_contender_compare(struct tl_contender *contender, const struct tl_truth *truth,
                          struct tl_measured_error *out, tl_error *error);

#endif
