/* The gallery: every technique on the same two objects, a solid and a draped sheet, beside its exact
 * evaluation, with its error and its time in the same run.
 *
 * A section is an experiment whose output is pictures (app/lab/experiments/). Errors are those of
 * render/metrics/compare.h over covered pixels; times are process CPU time of a whole frame whose camera has
 * moved, the median of a few. */
#ifndef TOILE_APP_LAB_GALLERY_GALLERY_H
#define TOILE_APP_LAB_GALLERY_GALLERY_H

#include "app/lab/experiments/picture.h"

#include <stddef.h>
#include <stdio.h>

/* One picture, drawn. */
struct tl_gallery_entry {
    struct tl_experiment_picture picture;
    char *setting;                      /* the picture's name */
    double error[TL_PICTURE_OBJECTS];   /* relative RMSE, or mean FLIP */
    double time_ms[TL_PICTURE_OBJECTS]; /* CPU */
    char *image;                        /* name of its file */
    void *png;                          /* both objects, and below each its difference from the reference */
    size_t png_size;
};

struct tl_gallery {
    struct tl_gallery_entry *entries;
    size_t count;
    int side;      /* pixels of each object's picture */
    bool complete; /* not interrupted */
};

/* Whether there is such a section; NULL stands for all. Errors: TL_USAGE names a similar one. */
bool tl_gallery_has(const char *name, tl_error *error);

/* Draws all sections, or the first picture of each (`quick`), or only the section called `only`, which must
 * exist. On Ctrl-C the error is TL_INTERRUPTED and `out` holds what was drawn until then. Release `out` in
 * any case. */
bool tl_gallery_draw(bool quick, const char *only, struct tl_gallery *out, tl_error *error);
void tl_gallery_release(struct tl_gallery *gallery);

/* gallery.csv: id,technique,setting,error,error_metric,time_ms,image; the larger error and the longer time of
 * the two objects. */
void tl_gallery_write_csv(const struct tl_gallery *gallery, FILE *out);
/* The page. */
void tl_gallery_write_html(const struct tl_gallery *gallery, FILE *out);

#endif
