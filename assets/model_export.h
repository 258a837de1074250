/* tl_model_export_glb's way into tinygltf. Private to assets. */
#ifndef TOILE_ASSETS_MODEL_EXPORT_H
#define TOILE_ASSETS_MODEL_EXPORT_H

#include "assets/base/surface.h"
#include "config/error.h"

/* What an F0 is multiplied by when a GGX lobe of these widths is shown by Ward's (model_extensions.c). */
float model_ward_factor(float width_weft, float width_warp);

/* The surfaces as one GLB in memory; free(*data). Message on failure names `path`. */
bool gltf_write_glb(const char *path, const tl_surface *surfaces, size_t surface_count, char **data,
                    size_t *size, tl_error *error);

#endif
