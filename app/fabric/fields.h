/* The fields of a fabric's file and what becomes of each, as text and as JSON. Errors: none. Threads: any. */
#ifndef TOILE_APP_FABRIC_FIELDS_H
#define TOILE_APP_FABRIC_FIELDS_H

#include "app/cli/json.h"
#include "assets/fabric/fabric_file.h"

/* Prints a line for each on stdout, and their number. */
void tl_fabric_fields_print(const tl_fabric_file *file);

/* A new list of {name, value, used, use}. */
cJSON *tl_fabric_fields_json(const tl_fabric_file *file);

/* The first field that sets an option, "fabric.shear"; NULL: none does. Borrowed. */
const struct tl_fabric_field *tl_fabric_field_of(const tl_fabric_file *file, const char *option);

/* The fields that are not used, each with its reason, as one text; "" where all are. Free it. */
char *tl_fabric_fields_unused(const tl_fabric_file *file);

#endif
