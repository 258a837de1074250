/* State that is kept between runs (app/view/memory/state.h), and files that are reloaded when they have been
 * edited. Owns `keep`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_KEEP_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_KEEP_H

#include "app/view/memory/history.h"
#include "app/view/memory/journal.h"
#include "app/view/memory/recent.h"
#include "app/view/memory/saved_views.h"
#include "app/view/window/file_watch.h"

struct tl_review;

struct tl_review_keep {
    const struct tl_arguments *arguments; /* borrowed */
    const char *output_folder;            /* for screenshots and camera paths; borrowed */
    char *state_folder;                   /* NULL: no state is kept between runs */
    bool keeps_settings;                  /* the settings are a part of that state */
    tl_history *history;
    tl_journal *journal;     /* NULL: no state is kept */
    struct tl_recent recent; /* the garments that were opened last */
    char *views_file;        /* of the present scene; NULL as above */
    struct tl_saved_views views;
    char *scene_file; /* YAML file that the settings came from, or NULL */
    struct tl_file_watch watch;
    double watched_s;
};

/* Restores the window's options and, when the command line names neither a scene nor an option, the settings.
 * True when `wanted` was replaced. A file that cannot be read is reported as a warning. */
bool tl_review_restore_state(struct tl_review *review);
/* Takes over a review that did not close, of the same command line, if there is one: `wanted`, history and
 * journal are then those that it left. Returns the number of its steps; -1: there is none. */
int tl_review_recover(struct tl_review *review);
/* The first image is shown: the journal goes on, or begins. */
void tl_review_begin_journal(struct tl_review *review);

/* Saves them; a failure is a warning. */
void tl_review_save_state(struct tl_review *review);

/* Puts the garment that was loaded, or the model that was opened alone, among the recent files, when it is a
 * file. A failure is a warning. */
void tl_review_keep_recent(struct tl_review *review);

void tl_review_save_view(struct tl_review *review, int index);
/* After another scene was loaded: loads its saved views. */
void tl_review_load_views(struct tl_review *review);

/* Reloads the scene, fabric and preset files that have been edited; checks twice a second. */
void tl_review_reload_edited(struct tl_review *review);

#endif
