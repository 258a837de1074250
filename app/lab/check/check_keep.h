/* Writes a frame that broke an invariant to a folder, with everything needed to open and replay it. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_KEEP_H
#define TOILE_APP_LAB_CHECK_CHECK_KEEP_H

#include "app/lab/check/checked.h"
#include "app/lab/check/finding.h"
#include "app/scene/headless.h"

/* Writes into `folder`: scene.yaml, which opens the frame as it is, with the files that it names; run.yaml,
 * the settings of the run; the image as .exr, and as .png with the finding marked. Files that cannot be
 * written for this frame are left out. */
bool tl_check_keep(const char *folder, struct tl_headless *headless, const struct tl_checked *checked,
                   const struct tl_finding *broken, tl_error *error);

#endif
