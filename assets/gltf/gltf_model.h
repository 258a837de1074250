/* glTF 2.0 files (.gltf, .glb) as models, and surfaces as GLB. */
#ifndef TOILE_ASSETS_GLTF_GLTF_MODEL_H
#define TOILE_ASSETS_GLTF_GLTF_MODEL_H

#include "assets/base/model.h"
#include "assets/base/surface.h"
#include "config/error.h"

/* Fills a model that has its name only; on failure the caller releases it. */
bool gltf_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error);

/* The surfaces as one GLB in memory; free(*data). Message on failure names `path`. */
bool gltf_write_glb(const char *path, const tl_surface *surfaces, size_t surface_count, char **data,
                    size_t *size, tl_error *error);

#endif
