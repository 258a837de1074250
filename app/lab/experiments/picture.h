/* The pictures of an experiment: one technique under one appearance, on one of two objects. The gallery and
 * the golden tests draw them. */
#ifndef TOILE_APP_LAB_EXPERIMENTS_PICTURE_H
#define TOILE_APP_LAB_EXPERIMENTS_PICTURE_H

#include "app/lab/experiments/experiment.h"

/* A solid, and a sheet draped over a ball. */
enum tl_picture_object { TL_PICTURE_SOLID, TL_PICTURE_SHEET, TL_PICTURE_OBJECTS };

struct tl_experiment_picture {
    const struct tl_experiment *experiment;
    const struct tl_experiment_appearance *appearance; /* NULL: the experiment has none */
    const struct tl_technique *technique;
    const char *folder; /* of the files that rows name; NULL: there are none */
};

/* The file that a row names as "@NAME": one for each experiment and object, in the folder. New string. */
char *tl_picture_file(const struct tl_experiment_picture *picture, enum tl_picture_object object,
                      const char *name);

/* Steps to the experiment's next picture, appearance by appearance; from {experiment} to the first one. False
 * past the last one. */
bool tl_picture_next(struct tl_experiment_picture *picture, enum tl_output output);
size_t tl_picture_count(const struct tl_experiment *experiment, enum tl_output output);

/* "Gouraud, edges of 4 cm": technique and appearance. New string. */
char *tl_picture_name(const struct tl_experiment_picture *picture, enum tl_output output);

/* The settings that draw the picture as a square of `side` pixels; with `reference` those of its exact
 * evaluation. Settings are read from the scene's file for every picture, because a preset or fabric that an
 * assignment names is a layer below the other assignments. "key=@NAME" names a file (tl_picture_file). */
bool tl_picture_settings(const struct tl_experiment_picture *picture, enum tl_picture_object object, int side,
                         bool reference, struct tl_settings *out, tl_error *error);

#endif
