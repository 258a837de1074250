/* For the readers of model files (assets/gltf, assets/obj): notes on features that a model cannot represent,
 * and the steps that every format needs once its mesh is read. */
#ifndef TOILE_ASSETS_BASE_MODEL_BUILD_H
#define TOILE_ASSETS_BASE_MODEL_BUILD_H

#include "assets/base/model.h"
#include "config/base/error.h"

/* Notes a feature of the file that has no effect; each text once. */
void model_ignore(tl_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Notes a file that the model's names and that was not read, and why; each reason once, also as ignored. */
void model_unread(tl_model *model, const char *file, bool is_absent, const char *reason);

/* Notes a feature that is shown differently from what the file specifies; each text once. */
void model_approximate(tl_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Notes what is wrong with the mesh itself, or may be; each text once. */
void model_defect(tl_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Decides the file's units and converts mesh.positions to metres. Refuses positions that are not finite or
 * more than 100 km away. */
bool model_take_units(const char *path, enum tl_units wanted, bool is_metric, tl_model *model,
                      tl_error *error);

/* Computes the normals of vertices that have none (zero): area-weighted over the triangles of all vertices at
 * the same position, because a garment is smooth across its UV seams. */
void model_smooth_normals(tl_mesh *mesh);

#endif
