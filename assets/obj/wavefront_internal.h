/* The materials of MTL files. */
#ifndef TOILE_ASSETS_OBJ_WAVEFRONT_INTERNAL_H
#define TOILE_ASSETS_OBJ_WAVEFRONT_INTERNAL_H

#include "assets/obj/wavefront.h"

/* Fills the model's materials and images from the MTL files that `object` names. A file or an image that
 * cannot be read is noted as ignored. (wavefront_materials.c) */
void wave_read_materials(const char *path, const struct wave_object *object, tl_model *model);

#endif
