/* The garments of an experiment whose maps are baked (tl_experiment.baked): files that its rows name as
 * "@coarse.obj", "@fine.obj", "@normals.png" and "@heights.exr" (app/lab/experiments/picture.h). */
#ifndef TOILE_APP_LAB_GALLERY_BAKED_H
#define TOILE_APP_LAB_GALLERY_BAKED_H

#include "app/lab/experiments/picture.h"

/* Writes both objects' meshes into the picture's folder and bakes their maps, as `toile bake` does. Errors:
 * TL_OUTPUT; TL_INPUT as of app/textures/baked_maps.h. */
bool tl_baked_make(const struct tl_experiment_picture *picture, tl_error *error);

#endif
