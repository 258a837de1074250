/* glTF 2.0 files (.gltf, .glb) as models, and surfaces as GLB. */
#ifndef TOILE_ASSETS_GLTF_GLTF_MODEL_H
#define TOILE_ASSETS_GLTF_GLTF_MODEL_H

#include "assets/base/model.h"
#include "assets/base/surface.h"
#include "config/base/error.h"

/* Fills a model of which only the name is set. On failure the caller releases it.
 *
 * Errors: false with one message (TL_INPUT). Lifetime: the file is closed on return. Threads: any. */
bool gltf_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error);

/* Encodes surfaces as one GLB in memory; free(*data). Messages name `path`; nothing is written there. */
bool gltf_write_glb(const char *path, const tl_surface *surfaces, size_t surface_count, char **data,
                    size_t *size, tl_error *error);

#endif
