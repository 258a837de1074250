/* Sentences about measured figures. They are made from the figures alone, so that they cannot contradict
 * them. New strings, owned by the caller. Pure. */
#ifndef TOILE_APP_LAB_GALLERY_WORDS_H
#define TOILE_APP_LAB_GALLERY_WORDS_H

#include "app/lab/gallery/gallery.h"

/* Errors in the unit of their experiment: "3.2 %", "FLIP 0.012". */
char *tl_words_error(const struct tl_experiment *experiment, double error);

/* The head above an experiment's exact pictures: "exact: ray traced". */
char *tl_words_head(const struct tl_experiment *experiment);

/* The entries [first, end) of one section, from the smallest error to the largest, on one object and under
 * one appearance: "On the torus, far lamp: pixel 0.1 %, vertex 3.2 %, matrix 5.1 %. pixel is nearest." NULL
 * where there are less than two to compare. */
char *tl_words_order(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                     enum tl_picture_object object, const struct tl_experiment_appearance *appearance);

/* Whether the figures agree with a claim, wherever both its techniques were drawn. NULL where they were not.
 */
char *tl_words_claim(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                     const struct tl_experiment_claim *claim);

/* What moves in an entry's strip, and how much its frames change. */
char *tl_words_motion(const struct tl_gallery_entry *entry);

#endif
