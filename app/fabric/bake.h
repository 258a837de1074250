/* Bakes maps from a height map: heights in metres, normals, moments, gloss, horizons, cones; and a
 * fabric that uses them.
 *
 * Errors: TL_USAGE for arguments, TL_INPUT, TL_OUTPUT. Threads: the main thread. */
#ifndef TOILE_APP_FABRIC_BAKE_H
#define TOILE_APP_FABRIC_BAKE_H

#include "app/cli/arguments.h"

/* Takes the one positional argument and -o, --repeat-mm, --height-mm and --clamp. */
bool tl_fabric_bake(const struct tl_arguments *arguments, tl_error *error);

#endif
