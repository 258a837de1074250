/* A fabric from photographs of a flat swatch under known lamps (assets/swatch/swatch.h): pictures of normals
 * and colours, gloss, and the file of options that names them.
 *
 * Errors: TL_USAGE for arguments and the file of lamps, TL_INPUT, TL_OUTPUT. Threads: the main thread. */
#ifndef TOILE_APP_FABRIC_SWATCH_H
#define TOILE_APP_FABRIC_SWATCH_H

#include "app/cli/arguments.h"
#include "assets/swatch/swatch.h"

/* Takes the positional arguments, one a lamp and in their order, --lights and -o. Prints what the lamps
 * leave. */
bool tl_fabric_swatch(const struct tl_arguments *arguments, tl_error *error);
/* Writes normal.png, colour.png and the file of options into a folder. */
bool tl_fabric_swatch_save(const char *folder, const struct tl_swatch_rig *rig,
                           const struct tl_swatch_maps *swatch, tl_error *error);

#endif
