/* Draped garments as model files. */
#ifndef TOILE_ASSETS_MODEL_EXPORT_H
#define TOILE_ASSETS_MODEL_EXPORT_H

#include "assets/base/model.h"
#include "assets/base/surface.h"
#include "config/base/error.h"

/* Writes surfaces as one GLB: positions, normals, tangents, UVs, materials with colours and PNG maps.
 *
 * Errors: false with one message (TL_OUTPUT); an older file at `path` is then untouched.
 * Lifetime: nothing is kept. Threads: several, to different paths. */
bool tl_model_export_glb(const char *path, const tl_surface *surfaces, size_t surface_count, tl_error *error);

/* Writes a surface of `model` as OBJ: its file's points in its file's units, UVs, normals, groups.
 *
 * Errors, Lifetime, Threads: as tl_model_export_glb. */
bool tl_model_export_obj(const char *path, const tl_model *model, const tl_surface *surface, tl_error *error);

#endif
