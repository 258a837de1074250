/* The folder of a contact sheet: a PNG for each cell, and manifest.json with the hash of what each picture
 * shows. It is written after every cell, atomically, so that a run that was stopped continues where it was: a
 * picture whose hash is the wanted one is kept. Threads: one at a time. */
#ifndef TOILE_APP_SHEET_CONTACT_STORE_H
#define TOILE_APP_SHEET_CONTACT_STORE_H

#include "assets/base/image.h"

#define TL_CONTACT_MANIFEST "manifest.json"

typedef struct tl_contact_store tl_contact_store;

/* Opens the folder and reads its manifest; creates the folder where there is none. Shard `shard` of `shards`
 * > 1 has a manifest of its own, manifest.SHARD-SHARDS.json, because several processes write at the same
 * time; with 0 shards the manifests of shards are taken into the one that all have, and removed. Errors:
 * NULL; TL_INPUT for a manifest that is not a sheet's. */
tl_contact_store *tl_contact_store_open(const char *folder, int shard, int shards, tl_error *error);
/* Frees the store and nulls the handle, which may be null; the folder stays. */
void tl_contact_store_close(tl_contact_store **handle);

/* Returns whether the picture exists and was stored with this hash. */
bool tl_contact_store_has(const tl_contact_store *store, const char *name, uint64_t hash);

/* Writes a picture and its hash. Errors: false where a file cannot be written; the manifest then has no entry
 * for it. */
bool tl_contact_store_put(tl_contact_store *store, const char *name, uint64_t hash, const tl_image *picture,
                          tl_error *error);

/* Removes the manifest, the pictures that it lists, and the folder if that leaves it empty; closes the store.
 */
void tl_contact_store_remove(tl_contact_store **store);

#endif
