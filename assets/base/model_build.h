/* For the readers of model files (assets/gltf, assets/obj): notes on what a file holds and a model cannot,
 * and the steps that every format needs once its mesh is read. */
#ifndef TOILE_ASSETS_BASE_MODEL_BUILD_H
#define TOILE_ASSETS_BASE_MODEL_BUILD_H

#include "assets/base/model.h"
#include "config/error.h"

/* Notes once that something of the file has no effect. */
void model_ignore(tl_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ... or another effect than the file says. */
void model_approximate(tl_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Decides on the file's units and brings mesh.positions into metres; refuses what is not finite or far away.
 */
bool model_take_units(const char *path, enum tl_units wanted, bool is_metric, tl_model *model,
                      tl_error *error);

/* For vertices without a normal (zero): area-weighted over the triangles of all vertices at the same place,
 * because a garment is smooth across its UV seams. */
void model_smooth_normals(tl_mesh *mesh);

#endif
