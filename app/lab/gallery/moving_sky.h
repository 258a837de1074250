/* The environment of an experiment whose light moves (tl_experiment.moving_sky): a sequence of files that its
 * rows name as "@sky.####.exr" (app/lab/experiments/picture.h), one for each frame of a strip. */
#ifndef TOILE_APP_LAB_GALLERY_MOVING_SKY_H
#define TOILE_APP_LAB_GALLERY_MOVING_SKY_H

#include "app/lab/experiments/picture.h"

/* Writes the sequence into the picture's folder: a sky over dark ground, whose warm light passes by 35
 * degrees a frame. Errors: TL_OUTPUT. */
bool tl_moving_sky_make(const struct tl_experiment_picture *picture, tl_error *error);

#endif
