/* Shared by the readers of the room. */
#ifndef TOILE_ASSETS_FABRIC_FABRIC_INTERNAL_H
#define TOILE_ASSETS_FABRIC_FABRIC_INTERNAL_H

#include "assets/fabric/fabric_file.h"

#include <cjson/cJSON.h>

#define TL_LIMIT_FABRIC_JSON ((size_t)64 << 20) /* measurements of long samples have megabytes */

/* Adds a row; `value` and `use` become the row's. */
void tl_fabric_add_field(tl_fabric_file *file, const char *name, char *value, bool is_used, char *use);

/* Notes a file that is named but is not there. */
void tl_fabric_add_missing(tl_fabric_file *file, const char *name);

/* The fabric's name, cut between letters where it is too long. */
void tl_fabric_set_name(tl_fabric_file *file, const char *name);

/* A picture that changes nothing of what it holds. Takes `name`, a new string or NULL. */
struct tl_fabric_picture tl_picture_plain(char *name);

/* Parses JSON out of a store. NULL with an error that names the place of a fault. cJSON_Delete. */
cJSON *tl_fabric_parse_json(const tl_store *store, const char *name, tl_error *error);

/* Reads the store's U3M file. */
bool tl_u3m_read(tl_fabric_file *file, const char *name, tl_error *error);

/* Reads raw measurements of the FAB tester; the names of its fields begin with `prefix`. What the file's own
 * weight and thickness state is kept where `physics` has them already. */
bool tl_fab_read(tl_fabric_file *file, const char *name, const char *prefix, tl_error *error);

/* Whether a channel of a picture is 255 everywhere. False for a picture that cannot be read: who loads the
 * maps says why. */
bool tl_fabric_maps_are_white(const tl_fabric_file *file, const char *name, int channel);

/* Finds texture maps among the store's files by their names. */
bool tl_map_names_read(tl_fabric_file *file, tl_error *error);

#endif
