/* The parts of tl_model_load: geometry (model.c, model_mesh.c) and materials (model_materials.c). Private to
 * assets. */
#ifndef TOILE_ASSETS_MODEL_READ_H
#define TOILE_ASSETS_MODEL_READ_H

#include "assets/gltf.h"
#include "assets/model.h"

/* Notes once that something of the file has no effect. */
void model_ignore(tl_model *model, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Decides on the file's units and brings mesh.positions into metres; refuses what is not finite or far away.
 */
bool model_take_units(const char *path, enum tl_units wanted, bool is_metric, tl_model *model,
                      tl_error *error);

/* For vertices without a normal (zero): area-weighted over the triangles of all vertices at the same place,
 * because a garment is smooth across its UV seams. */
void model_smooth_normals(tl_mesh *mesh);

/* materials, images: one tl_material for each of the file's and a default one after them. An image that is
 * missing or cannot be decoded is noted, and its map left out. */
void model_read_materials(const gltf_document *document, tl_model *model);

#endif
