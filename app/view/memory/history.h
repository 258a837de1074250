/* Settings as they were, edit by edit: undo and redo. The camera and the image's size are no edits: where
 * one stands to look stays as it is. Pure. Ownership: what is handed out is borrowed until the next call. */
#ifndef TOILE_APP_VIEW_MEMORY_HISTORY_H
#define TOILE_APP_VIEW_MEMORY_HISTORY_H

#include "app/scene/settings.h"

#define TL_HISTORY_EDITS 64 /* that are remembered; older ones are forgotten */

typedef struct tl_history tl_history;

tl_history *tl_history_create(const struct tl_settings *first);
void tl_history_destroy(tl_history **handle); /* nulls it; null is fine */

/* Makes `settings` the present, after which nothing can be redone; does nothing, and returns false, where
 * they are the present already. */
bool tl_history_note(tl_history *history, const struct tl_settings *settings);

/* The edit before, or after, the present becomes the present; NULL when there is none. */
const struct tl_settings *tl_history_undo(tl_history *history);
const struct tl_settings *tl_history_redo(tl_history *history);

/* Takes over what an edit can have changed: all but the camera and the image's size. */
void tl_history_restore(const struct tl_settings *edit, struct tl_settings *settings);

/* What differs, for people: "material.glossiness 0.3 -> 0.6", and how many options more. New string. */
char *tl_history_describe(const struct tl_settings *from, const struct tl_settings *to);

#endif
