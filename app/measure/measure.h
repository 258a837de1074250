/* Methods of light measured against the oracle: what bench, trade and stability share.
 *
 * A variant is one choice of light settings with a renderer of its own, so that its history is its own too.
 * Errors are those of render/metrics/compare.h, over covered pixels. Threads: the one that the GL context is
 * current on. */
#ifndef TOILE_APP_MEASURE_MEASURE_H
#define TOILE_APP_MEASURE_MEASURE_H

#include "app/measure/cost.h"
#include "app/measure/motion.h"
#include "app/scene/headless.h"

/* One choice of settings: a preset's light table, then single options. */
#define TL_SETUP_ASSIGNMENTS 8
struct tl_setup {
    const char *name;
    const char *preset;                            /* NULL: the scene's own light */
    const char *assignments[TL_SETUP_ASSIGNMENTS]; /* "table.key=value"; NULL ends them */
};

/* The scene's settings with the choice over them. */
bool tl_setup_apply(const struct tl_setup *choice, const struct tl_settings *scene, struct tl_settings *out,
                    tl_error *error);

struct tl_variant_run {
    const char *name; /* borrowed */
    struct tl_render_settings settings;
    tl_renderer *renderer;
};

/* `scene` gives all that a choice leaves open; the image's size and samples even where a preset has its own.
 */
bool tl_variant_run_create(struct tl_variant_run *variant, tl_gpu *gpu, const struct tl_setup *choice,
                           const struct tl_settings *scene, tl_error *error);
void tl_variant_run_release(struct tl_variant_run *variant);

/* True when a frame's image depends on the frames before it. */
bool tl_variant_run_has_history(const struct tl_variant_run *variant);

/* Draws and tells what it took. */
bool tl_variant_run_draw(struct tl_variant_run *variant, const tl_frame *frame, struct tl_taken *taken,
                         tl_error *error);

/* The settings that draw a variant's picture by the oracle. */
struct tl_setup tl_reference_settings(void);

/* What the oracle says of a frame. */
struct tl_reference_frame {
    tl_image image; /* as tl_renderer_read gives it; no texels: not drawn yet */
    double standard_error;
};
bool tl_reference_frame_draw(struct tl_variant_run *oracle, const tl_frame *frame,
                             struct tl_reference_frame *out, tl_error *error);
void tl_reference_frame_release(struct tl_reference_frame *truth);

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
bool tl_reference_frame_compare(const tl_image *image, const struct tl_reference_frame *truth,
                                struct tl_measured_error *out, tl_error *error);
/* Of the image that the variant drew last. */
bool tl_variant_run_compare(struct tl_variant_run *variant, const struct tl_reference_frame *truth,
                            struct tl_measured_error *out, tl_error *error);

#endif
