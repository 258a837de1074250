/* The gallery: every technique and every setting on the same two objects, a solid and a draped sheet, beside
 * its exact evaluation, with its error and its time in the same run.
 *
 * An exhibit is data: assignments over those of its wall. What is exact is the same picture with the wall's
 * `exact` assignments on top. Errors are those of render/metrics/compare.h over covered pixels; times are
 * process CPU time of a whole frame whose camera has moved, the median of a few. */
#ifndef TOILE_APP_LAB_GALLERY_GALLERY_H
#define TOILE_APP_LAB_GALLERY_GALLERY_H

#include "app/cli/arguments.h"

#include <stddef.h>
#include <stdio.h>

#define TL_GALLERY_ASSIGNMENTS 12

struct tl_exhibit {
    const char *id;      /* row of the technique set: "A3" */
    const char *setting; /* "Blinn-Phong, table of 64 x 64, 8 bit" */
    const char *chosen[TL_GALLERY_ASSIGNMENTS];
    const char *exact[4]; /* on top of the wall's, or NULL */
};

struct tl_gallery_wall {
    const char *name;    /* of its files: "a3" */
    const char *heading; /* "A3  Phong, Blinn-Phong and cosine lobe" */
    const char *text;    /* what is seen, and what the papers say of it */
    const char *solid;   /* garment beside the sheet: "sphere" or "torus" */
    const char *base[TL_GALLERY_ASSIGNMENTS];
    const char *exact[TL_GALLERY_ASSIGNMENTS];
    bool by_flip;   /* errors are mean FLIP: a mirror image's are edges, whose squares are the lamp's alone */
    bool one_truth; /* what is exact is the same for all exhibits: their own assignments are no part of it */
    const struct tl_exhibit *exhibits;
    size_t exhibit_count;
    void (*figures)(FILE *out); /* plots and tables below the pictures, or NULL */
};

extern const struct tl_gallery_wall tl_gallery_walls[];
extern const size_t tl_gallery_wall_count;

enum { TL_GALLERY_SOLID, TL_GALLERY_SHEET, TL_GALLERY_OBJECTS };

/* An exhibit, hung. */
struct tl_hung {
    const struct tl_gallery_wall *wall;
    const struct tl_exhibit *exhibit;
    double error[TL_GALLERY_OBJECTS];   /* relative RMSE, or mean FLIP */
    double time_ms[TL_GALLERY_OBJECTS]; /* CPU */
    char *image;                        /* name of its file */
    void *png;                          /* the picture: both objects, what differs below */
    size_t png_size;
};

struct tl_gallery {
    struct tl_hung *items;
    size_t count;
    int side;      /* pixels of each object's picture */
    bool complete; /* not interrupted */
};

/* That there is such a wall; NULL stands for all. */
bool tl_gallery_has(const char *name, tl_error *error);

/* Draws all walls, or the first exhibit of each (`quick`), or only the wall called `only`, which there must
 * be. On Ctrl-C what was drawn stays in `out` and the error is TL_INTERRUPTED. */
bool tl_gallery_draw(bool quick, const char *only, struct tl_gallery *out, tl_error *error);
void tl_gallery_release(struct tl_gallery *gallery);

/* gallery.csv: id,technique,setting,error,error_metric,time_ms,image; the worse error and the longer time of
 * the two objects. And the page. */
void tl_gallery_write_csv(const struct tl_gallery *gallery, FILE *out);
void tl_gallery_write_html(const struct tl_gallery *gallery, FILE *out);

#endif
