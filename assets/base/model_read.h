/* The parts of tl_model_load: geometry (model.c, model_mesh.c) and materials (model_materials.c). Private to
 * assets. */
#ifndef TOILE_ASSETS_BASE_MODEL_READ_H
#define TOILE_ASSETS_BASE_MODEL_READ_H

#include "assets/gltf/gltf.h"
#include "assets/model.h"

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

/* materials, images: one tl_material for each of the file's and a default one after them. An image that is
 * missing or cannot be decoded is noted, and its map left out. */
void model_read_materials(const gltf_document *document, tl_model *model);

/* variants, once the mesh has its parts; sources [mesh.part_count]: the primitive that each part is of. */
bool model_read_variants(const gltf_document *document, const struct gltf_primitive *const *sources,
                         tl_model *model, tl_error *error);
void model_release_variants(tl_model *model);

/* A material while it is read. `base`, `metallic` and `roughness` are the means over the surface. */
struct model_reader;
struct model_look {
    struct model_reader *reader;
    tl_model *model;
    const struct gltf_material *from;
    float base[3]; /* without its map, linear */
    float metallic, roughness;
    bool roughness_varies;
    tl_material *to;
};
/* F0 of what is no metal [KHR_materials_ior, KHR_materials_specular]. (model_extensions.c) */
vec3s model_dielectric_f0(const struct model_look *look);
/* The other extensions, once `to` is as glTF without them has it. (model_extensions.c) */
void model_apply_extensions(const struct model_look *look);

/* Mean over a texture, by channel; 1 where there is none. `which` of "rgba" are meant, or "colour": red,
 * green and blue, taken from sRGB to linear. Where one of them varies, that is told of `what`. */
struct model_mean {
    float r, g, b, a;
};
struct model_mean model_map_mean(const struct model_look *look, const struct gltf_texture *texture,
                                 const char *which, const char *what);
/* A colour map that multiplies. */
void model_colour_map(const struct model_look *look, const struct gltf_texture *texture, struct tl_map *out);

#endif
