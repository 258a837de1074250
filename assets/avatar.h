/* Avatars by file (here) and the built-in dress form (assets/body/form.h). */
#ifndef TOILE_ASSETS_AVATAR_H
#define TOILE_ASSETS_AVATAR_H

#include "assets/base/avatar.h"
#include "assets/body/form.h"
#include "config/base/error.h"

/* Loads a glTF or OBJ file as an avatar.
 *
 * Errors, Lifetime, Threads: as tl_model_load; *out is released by tl_avatar_release. */
bool tl_avatar_load(const char *path, tl_avatar *out, tl_error *error);

/* Is tl_avatar_load with the units given; TL_UNITS_AUTO is tl_avatar_load.
 *
 * Errors, Lifetime, Threads: as tl_avatar_load. */
bool tl_avatar_load_in(const char *path, enum tl_units units, tl_avatar *out, tl_error *error);

#endif
