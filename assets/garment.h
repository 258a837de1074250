/* Garments by file (here) and by name (assets/cut/garment_cut.h). */
#ifndef TOILE_ASSETS_GARMENT_H
#define TOILE_ASSETS_GARMENT_H

#include "assets/base/garment.h"
#include "assets/cut/garment_cut.h"
#include "config/base/error.h"

/* Loads a glTF or OBJ file as a garment, with the pins that the file names.
 *
 * Errors, Lifetime, Threads: as tl_model_load; *out is released by tl_garment_release. */
bool tl_garment_load(const char *path, tl_garment *out, tl_error *error);

/* Is tl_garment_load with the units given; TL_UNITS_AUTO is tl_garment_load.
 *
 * Errors, Lifetime, Threads: as tl_garment_load. */
bool tl_garment_load_in(const char *path, enum tl_units units, tl_garment *out, tl_error *error);

#endif
