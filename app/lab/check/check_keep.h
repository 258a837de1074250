/* Writes a frame that broke an invariant to a folder, with everything needed to open and replay it. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_KEEP_H
#define TOILE_APP_LAB_CHECK_CHECK_KEEP_H

#include "app/lab/check/checked.h"
#include "app/lab/check/finding.h"
#include "app/scene/headless.h"

/* What is kept of a frame (check_keep.c), each file that can be written: scene.yaml opens it as it stands;
 * run.yaml holds the settings of the run; what the first names lies beside it. The picture as .exr, and as
 * .png with the place marked. */
bool tl_check_keep(const char *folder, struct tl_headless *headless, const struct tl_checked *checked,
                   const struct tl_finding *broken, tl_error *error);

#endif
