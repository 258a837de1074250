/* The commands that read files, write files or print a table, without a window. Each reports its failure
 * through `error` and returns false (app/cli/command.h). */
#ifndef TOILE_APP_BATCH_COMMANDS_H
#define TOILE_APP_BATCH_COMMANDS_H

#include "app/cli/arguments.h"

/* Renders frames as EXR or PNG files. */
bool tl_command_render(const struct tl_arguments *arguments, tl_error *error);
/* Prints which jobs a frame runs, why, and what they cost in time and memory. */
bool tl_command_plan(const struct tl_arguments *arguments, tl_error *error);
/* Lists the results that are kept, or removes them. */
bool tl_command_cache(const struct tl_arguments *arguments, tl_error *error);
/* Prints how far two images differ. */
bool tl_command_compare(const struct tl_arguments *arguments, tl_error *error);
/* Writes a frame as GLB or OBJ, or the garment's motion as PC2 or MDD. */
bool tl_command_export(const struct tl_arguments *arguments, tl_error *error);
/* Converts an environment map to another layout, or captures one from a scene. */
bool tl_command_env(const struct tl_arguments *arguments, tl_error *error);
/* Prints strains and areas of a garment's panels, its openings and girths; writes them as CSV. */
bool tl_command_measure(const struct tl_arguments *arguments, tl_error *error);
/* Writes normals or heights of a finer mesh as a map of a coarser one. */
bool tl_command_bake(const struct tl_arguments *arguments, tl_error *error);
/* Prints what a file holds, or what is built in. */
bool tl_command_info(const struct tl_arguments *arguments, tl_error *error);

#endif
