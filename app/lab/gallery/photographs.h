/* Photographs of an experiment's weave (tl_experiment.photographed): the program draws it from above under
 * known lamps and measures it by photometric stereo, as `toile fabric PICTURES --lights` does. Rows wear what
 * was measured, a folder of pictures that they name as "@photographs-06" (app/lab/experiments/picture.h). */
#ifndef TOILE_APP_LAB_GALLERY_PHOTOGRAPHS_H
#define TOILE_APP_LAB_GALLERY_PHOTOGRAPHS_H

#include "app/lab/gallery/shots.h"

/* The mean angle between measured and true normals, and the root mean square error of the colours relative to
 * theirs. */
struct tl_photographs_error {
    int lamps;
    double normal_deg, albedo;
};
#define TL_PHOTOGRAPHS_RIGS 4 /* of 4, 6, 8 and 12 lamps */

/* Measures the weave under each rig, and writes the folders of those rows. Errors: TL_OUTPUT, and those of
 * drawing. */
bool tl_photographs_make(struct tl_shots *shots, const struct tl_experiment_picture *picture,
                         struct tl_photographs_error out[TL_PHOTOGRAPHS_RIGS], tl_error *error);

#endif
