/* Settings measured against the ray-traced reference: shared by bench, trade, stability and flights.
 *
 * Errors are those of render/metrics/compare.h, over covered pixels. Threads: the one that the GL context is
 * current on. */
#ifndef TOILE_APP_MEASURE_MEASURE_H
#define TOILE_APP_MEASURE_MEASURE_H

#include "app/measure/cost.h"
#include "app/measure/motion.h"
#include "app/scene/headless.h"
#include "render/metrics/compare.h"

/* Settings over those of a scene: a preset's (but its image table), then single options. */
#define TL_SETUP_ASSIGNMENTS 12
struct tl_setup {
    const char *preset;                            /* NULL: the scene's own */
    const char *assignments[TL_SETUP_ASSIGNMENTS]; /* "table.key=value"; NULL ends them */
};

/* The settings of the ray-traced reference. */
extern const struct tl_setup tl_setup_reference;

/* `out`: the settings of `scene` with `setup` over them. Errors: TL_USAGE names the assignment. */
bool tl_setup_apply(const struct tl_setup *setup, const struct tl_settings *scene, struct tl_settings *out,
                    tl_error *error);

/* A setup with a renderer of its own, so that the renderer's history is its own too. */
struct tl_variant_run {
    struct tl_render_settings settings;
    tl_renderer *renderer;
};

/* `scene` gives all settings that the setup leaves open, and the image's size and samples even where a preset
 * has its own. On failure release what was made. */
bool tl_variant_run_create(struct tl_variant_run *run, tl_gpu *gpu, const struct tl_setup *setup,
                           const struct tl_settings *scene, tl_error *error);
void tl_variant_run_release(struct tl_variant_run *run);

/* True when a frame's image depends on the frames drawn before it. */
bool tl_variant_run_has_history(const struct tl_variant_run *run);

/* Draws a frame; `taken` is the time of it. */
bool tl_variant_run_draw(struct tl_variant_run *run, const tl_frame *frame, struct tl_taken *taken,
                         tl_error *error);

/* The reference image of one frame. */
struct tl_reference_frame {
    tl_image image; /* as tl_renderer_read gives it; no texels: not drawn yet */
    double standard_error;
    /* Only of a frame with tl_frame.aovs, else without texels: what the garment's error is measured by. */
    tl_image shown;   /* as tl_renderer_show_image gives it */
    tl_image garment; /* as tl_renderer_read_garment gives it */
};
bool tl_reference_frame_draw(struct tl_variant_run *reference, const tl_frame *frame,
                             struct tl_reference_frame *out, tl_error *error);
void tl_reference_frame_release(struct tl_reference_frame *reference);

struct tl_measured_error {
    double rel_rmse;       /* without the reference's own noise, which is independent of it:
                              sqrt(measured^2 - standard error^2) */
    double standard_error; /* of the reference */
    double flip_mean;      /* the reference's noise is part of it */
    double max_abs;
    double worst_share; /* of the square error: the share of its worst pixel */
    size_t covered;     /* pixels */
    /* The error as shown, over the pixels where the reference shows the garment; the reference's noise is
     * part of it. Without pixels, and NaN, when it shows none of it or was drawn without tl_frame.aovs. */
    struct tl_object_error garment;
};
/* Compares an image as tl_renderer_read returns it, and for the garment's error the picture as
 * tl_renderer_show_image returns it. `shown` may be NULL when the reference was drawn without tl_frame.aovs.
 */
bool tl_reference_frame_compare(const tl_image *image, const tl_image *shown,
                                const struct tl_reference_frame *reference, struct tl_measured_error *out,
                                tl_error *error);
/* Compares the image that the run drew last. */
bool tl_variant_run_compare(struct tl_variant_run *run, const struct tl_reference_frame *reference,
                            struct tl_measured_error *out, tl_error *error);

#endif
