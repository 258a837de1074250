/* The readings of the scene's files: their units and the axis that points up. Owns `reading`.
 *
 * A reading that is in doubt (assets/base/units.h) is asked about, and a garment of another size than its
 * body is shown, until they are accepted. The answers, U and A set the scene's options units and up, which
 * are in no doubt any more when the scene is opened again; the question names them as the command line has
 * them. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_READING_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_READING_H

#include "app/view/panel/panel_shim.h"
#include "config/options.h"

struct tl_review;

/* The reading of the file of a garment or a body; kept: what the user has accepted. */
enum tl_reading_of { TL_READING_NONE, TL_READING_GARMENT, TL_READING_AVATAR, TL_READING_COUNT };
struct tl_review_reading {
    enum tl_reading_of of;     /* whose reading is shown */
    char name[TL_STRING_SIZE]; /* of its file */
    char kept[TL_READING_COUNT][TL_STRING_SIZE];
    char kept_size[512];
    char notice[1024]; /* "": none is shown */
};

/* Whether the model was read from a file whose units are an option: built-in ones and patterns are metric. */
bool tl_review_has_units(const struct tl_review *review, enum tl_reading_of of);

/* After a scene was loaded: what of it is in doubt. */
void tl_review_note_reading(struct tl_review *review);
/* Accepts what is shown; false: nothing is. */
bool tl_review_keep_reading(struct tl_review *review);

/* The answers to what is asked: units and axes with the height that each gives, and to keep it. */
#define TL_REVIEW_CHOICES 9
size_t tl_review_reading_choices(const struct tl_review *review, struct tl_panel_choice *out);
void tl_review_choose_reading(struct tl_review *review, size_t index);

/* Reads the file in the next unit (by 1) or the previous one (by -1); turns it to the other axis. The file is
 * the one that the notice is about, or the garment's, or the body's. */
void tl_review_next_units(struct tl_review *review, int by);
void tl_review_next_up(struct tl_review *review);

#endif
