/* A frame as a file. Threads: the renderer's. */
#ifndef TOILE_APP_BATCH_FRAME_SAVE_FRAME_H
#define TOILE_APP_BATCH_FRAME_SAVE_FRAME_H

#include "app/scene/headless.h"

/* Writes the frame that was drawn last: to an .exr file linear radiance and coverage, with the AOVs that the
 * renderer was asked for as further layers; to any other the picture as displayed, as PNG, with its legend.
 * Errors: TL_OUTPUT; the file is then as it was. */
bool tl_save_frame(struct tl_headless *headless, const char *path, tl_error *error);

#endif
