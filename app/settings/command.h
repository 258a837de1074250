/* Settings from the words of a command: its scene, and its assignments on top.
 *
 * Errors: those of tl_settings_load, and TL_USAGE for more than one scene. Threads: any. */
#ifndef TOILE_APP_SETTINGS_COMMAND_H
#define TOILE_APP_SETTINGS_COMMAND_H

#include "app/cli/arguments.h"
#include "app/settings/settings.h"

/* `needs_garment`: a model in place of a scene is a garment whatever its shape, never a body that is looked
 * at. */
bool tl_settings_of_command(const struct tl_arguments *arguments, bool needs_garment, struct tl_settings *out,
                            tl_error *error);

#endif
