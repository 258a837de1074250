/* The folder of a contact sheet: a PNG a cell, and manifest.json, which knows what each shows. A run that was
 * stopped goes on where it was: what is there and has the wanted hash is kept. Written after every cell,
 * atomically. */
#ifndef TOILE_APP_SHEET_CONTACT_STORE_H
#define TOILE_APP_SHEET_CONTACT_STORE_H

#include "assets/base/image.h"

#define TL_CONTACT_MANIFEST "manifest.json"

typedef struct tl_contact_store tl_contact_store;

/* Makes the folder, or takes up what is in it. Fails on a manifest that is none. */
tl_contact_store *tl_contact_store_open(const char *folder, tl_error *error);
void tl_contact_store_close(tl_contact_store **handle); /* nulls it; null is fine */

/* True when the file of this name is there and shows what the hash stands for. */
bool tl_contact_store_has(const tl_contact_store *store, const char *name, uint64_t hash);
bool tl_contact_store_put(tl_contact_store *store, const char *name, uint64_t hash, const tl_image *picture,
                          tl_error *error);

/* Removes the files that it knows of, and the folder if nothing else is in it. */
void tl_contact_store_remove(tl_contact_store **store);

#endif
