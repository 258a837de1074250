/* Edits of the settings by names and files that stand for many options; undo. Owns `edit`. Whatever fails is
 * reported, and `wanted` goes back to `good`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_EDIT_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_EDIT_H

#include "app/view/memory/recent.h"
#include "app/view/window/file_chooser.h"
#include <stdbool.h>
#include <stddef.h>

struct tl_review;

struct tl_review_answer {
    const char *label, *help;
    void (*use)(struct tl_review *review, const char *path); /* NULL: the file is not used */
};

struct tl_review_edit {
    tl_file_chooser *chooser; /* NULL: no dialog is open */
    char *dropped;            /* the file that the panel asks about, or NULL */
    char **waiting;           /* those that it asks about next */
    size_t waiting_count;
    size_t offered; /* recent garments that are offered to be opened again, one answer each; 0: none */
    struct tl_review_answer answers[TL_RECENT_MAX];
    char **environments; /* those that E cycles through */
    size_t environment_count;
};

/* Sets one option as if it had been typed. False when the text is refused, which is reported. */
bool tl_review_set(struct tl_review *review, const char *key, const char *text);
/* After wanted.scene's fabric, preset, garment or colourway were edited: applies what these names
 * stand for. */
void tl_review_apply_names(struct tl_review *review);
void tl_review_use_fabric(struct tl_review *review, const char *name);
void tl_review_use_scene(struct tl_review *review, const char *path); /* a YAML file: replaces all options */

/* Changes to the next (by 1) or previous (by -1) one, cyclically. */
void tl_review_next_fabric(struct tl_review *review, int by);
void tl_review_next_colourway(struct tl_review *review, int by);
void tl_review_next_view(struct tl_review *review, int by); /* image.view */

/* A file was dropped on the window: uses it at once, asks what it is to be used as, or refuses it. */
void tl_review_open_dropped(struct tl_review *review, const char *path);
/* Takes over the file that was chosen in the dialog, as if it had been dropped; called every frame. */
void tl_review_take_chosen(struct tl_review *review);
/* The possible uses of the dropped file that the open question is about, or the recent files to open again;
 * NULL and 0 without a question. Borrowed until the question ends. */
#define TL_REVIEW_ANSWERS_MAX 10
const struct tl_review_answer *tl_review_answers(const struct tl_review *review, size_t *count);
/* Answers the open question by an index of the answers; the next file in the queue is asked about. */
void tl_review_answer(struct tl_review *review, size_t index);
/* Drops the open question and its file; false: none was open. */
bool tl_review_cancel_question(struct tl_review *review);
/* Asks which of the recent garments to open again. */
void tl_review_offer_recent(struct tl_review *review);

/* The environments that E cycles through: adds one, and goes to the next. */
void tl_review_add_environment(struct tl_review *review, const char *name);
void tl_review_next_environment(struct tl_review *review);

/* Notes the present settings for undo once a gesture has ended; called every frame. */
void tl_review_note_edit(struct tl_review *review);
/* Notes an edit that has not been noted because its gesture has just ended, or because it is still loading:
 * before something else takes its place. */
void tl_review_note_wanted(struct tl_review *review);
void tl_review_undo(struct tl_review *review, bool redo);

#endif
