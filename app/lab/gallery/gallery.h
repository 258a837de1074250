/* The gallery: every technique on the same two objects, a solid and a draped sheet, beside its exact picture,
 * with its error and its time in the same run.
 *
 * A section is an experiment whose output is pictures (app/lab/experiments/). Errors are those of
 * render/metrics/compare.h over covered pixels; times are process CPU time of a whole frame whose camera has
 * moved, the median of a few. */
#ifndef TOILE_APP_LAB_GALLERY_GALLERY_H
#define TOILE_APP_LAB_GALLERY_GALLERY_H

#include "app/lab/experiments/picture.h"
#include "app/lab/gallery/panels.h"
#include "app/lab/gallery/photographs.h"

#include <cjson/cJSON.h>

#include <stddef.h>
#include <stdio.h>

/* The measured figures of one picture. */
struct tl_gallery_figures {
    double error[TL_PICTURE_OBJECTS];   /* relative RMSE, or mean FLIP */
    double time_ms[TL_PICTURE_OBJECTS]; /* CPU */
    /* Of the strip: how much a pixel changes from a frame to the next, in levels of 255, mean over pixels and
     * frames; of the technique and of the exact picture. 0 where there is no strip. */
    double change, exact_change;
    double difference_end; /* linear radiance at the upper end of the difference's scale; 0: all equal */
};

/* One picture: its file, its strip's, and what was measured. */
struct tl_gallery_entry {
    struct tl_experiment_picture picture;
    char *setting; /* the picture's name */
    char *image;   /* name of its file */
    char *strip;   /* name of the file with its frames in motion; NULL: nothing moves */
    struct tl_gallery_figures figures;
    bool kept; /* an earlier run drew it with the same settings */
};

struct tl_gallery {
    struct tl_gallery_entry *entries;
    size_t count;
    bool complete;                                                /* not interrupted */
    struct tl_photographs_error photographs[TL_PHOTOGRAPHS_RIGS]; /* of the section that is photographed */
};

/* The error of a technique whose measured error contains the noise of a ray-traced picture, both relative.
 * The two are independent, so that variances add. Less than a quarter of the noise is not resolved, and
 * counts as that. What errs more never gets the smaller figure. Pure. */
double tl_gallery_error_less_noise(double rel_rmse, double noise);

/* The error of a picture of an experiment by its metric: relative RMSE less the noise of a traced exact
 * picture, or mean FLIP. */
bool tl_gallery_measure_error(const struct tl_experiment *experiment, const struct tl_gallery_shot *tested,
                              const struct tl_gallery_shot *exact, double *error_of, tl_error *error);

/* The head above an experiment's exact pictures: "exact: ray traced". New string. */
char *tl_gallery_exact_head(const struct tl_experiment *experiment);

/* Whether there is such a section; NULL stands for all. Errors: TL_USAGE names a similar one. */
bool tl_gallery_has(const char *name, tl_error *error);

/* Draws all sections, or the first picture of each (`quick`), or only the section called `only`, which must
 * exist, and writes each picture into `folder` as soon as it is drawn. A picture that an earlier run wrote
 * there with the same settings is kept. On Ctrl-C the error is TL_INTERRUPTED and `out` holds what was drawn
 * until then. Release `out` in any case. */
bool tl_gallery_draw(const char *folder, bool quick, const char *only, struct tl_gallery *out,
                     tl_error *error);
void tl_gallery_release(struct tl_gallery *gallery);

/* gallery.csv: id,technique,setting,error,error_metric,time_ms,image; the larger error and the longer time of
 * the two objects. */
void tl_gallery_write_csv(const struct tl_gallery *gallery, FILE *out);
/* The data of gallery.html; new object. */
cJSON *tl_gallery_data(const struct tl_gallery *gallery);

#endif
