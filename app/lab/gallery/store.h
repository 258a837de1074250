/* What was measured for each picture of a gallery's folder, in gallery.json, so that a run that was stopped
 * continues where it was: a picture that was drawn with the same settings is kept with its figures. It is
 * written after every picture, atomically. Threads: one at a time. */
#ifndef TOILE_APP_LAB_GALLERY_STORE_H
#define TOILE_APP_LAB_GALLERY_STORE_H

#include "app/lab/gallery/gallery.h"

typedef struct tl_gallery_store tl_gallery_store;

/* Reads the folder's gallery.json, if it is there. Errors: NULL; TL_INPUT for a file that is not a
 * gallery's. */
tl_gallery_store *tl_gallery_store_open(const char *folder, tl_error *error);
/* Frees the store and nulls the handle, which may be null; the folder stays. */
void tl_gallery_store_close(tl_gallery_store **handle);

/* Whether the entry's files exist and were drawn with this hash; then gives it their figures. */
bool tl_gallery_store_find(const tl_gallery_store *store, uint64_t hash, struct tl_gallery_entry *entry);

/* Forgets an entry whose files are about to be replaced, so that no hash belongs to another picture. */
bool tl_gallery_store_forget(tl_gallery_store *store, const struct tl_gallery_entry *entry, tl_error *error);
bool tl_gallery_store_put(tl_gallery_store *store, uint64_t hash, const struct tl_gallery_entry *entry,
                          tl_error *error);

#endif
