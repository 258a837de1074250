/* Undo and redo: the settings after each edit. Changes of the camera and of the image's size are no edits and
 * stay as they are. Pure. Lifetime: settings that are returned are borrowed until the next call. Threads: one
 * at a time. */
#ifndef TOILE_APP_VIEW_MEMORY_HISTORY_H
#define TOILE_APP_VIEW_MEMORY_HISTORY_H

#include "app/settings/settings.h"

#define TL_HISTORY_EDITS 64 /* the oldest is dropped when there are more */

typedef struct tl_history tl_history;

tl_history *tl_history_create(const struct tl_settings *first);
void tl_history_destroy(tl_history **handle); /* nulls it; null is fine */

/* Adds an edit after the present one and drops those that could be redone. False when `settings` equal the
 * present ones: then nothing changes. */
bool tl_history_note(tl_history *history, const struct tl_settings *settings);

/* Makes the previous, or the next, edit the present one and returns its settings; NULL when there is none. */
const struct tl_settings *tl_history_undo(tl_history *history);
const struct tl_settings *tl_history_redo(tl_history *history);

/* Copies all but the camera and the image's size from an edit to `settings`. */
void tl_history_restore(const struct tl_settings *edit, struct tl_settings *settings);

/* The difference as text: "material.glossiness 0.3 -> 0.6 and 2 more"; "nothing". New string. */
char *tl_history_describe(const struct tl_settings *from, const struct tl_settings *to);

#endif
