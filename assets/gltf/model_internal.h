/* The steps of gltf_load_model: the rig (rig_read.c), primitives (model_primitive.c), materials
 * (model_materials.c, model_texture.c, model_extensions.c), variants (model_variants.c). */
#ifndef TOILE_ASSETS_GLTF_MODEL_INTERNAL_H
#define TOILE_ASSETS_GLTF_MODEL_INTERNAL_H

#include "assets/base/model_build.h"
#include "assets/base/rig.h"
#include "assets/gltf/gltf_internal.h"

/* The nodes of a document, their order, and its clips; gltf_load_model adds slots and vertices. */
bool rig_read(const gltf_document *document, tl_rig *rig, tl_error *error);

/* The accessors of one primitive as plain arrays; NULL where the file has none. A zeroed one is empty. */
struct gltf_vertices {
    float *positions, *normals, *uvs, *weights, *colours, *pins;
    int colour_components;
    uint32_t *joints, *indices;
    size_t vertex_count, index_count;
};

/* joint_count: of the primitive's skin; 0: its joints and weights are not read. */
bool gltf_primitive_read_vertices(const gltf_document *document, const struct gltf_primitive *from,
                                  size_t joint_count, struct gltf_vertices *to, tl_error *error);
/* As a list of triangles; needs to->vertex_count. */
bool gltf_primitive_read_indices(const gltf_document *document, const struct gltf_primitive *from,
                                 struct gltf_vertices *to, tl_error *error);
void gltf_vertices_release(struct gltf_vertices *vertices);

/* What a decoded picture is used for decides how its texels are read. */
enum texture_use { TEXTURE_COLOUR, TEXTURE_DATA, TEXTURE_GLOSS, TEXTURE_COLOUR_MEAN, TEXTURE_DATA_MEAN };

/* Pictures a material may name: each is decoded once for each use. */
#define MAPS_MAX 16

struct texture_loaded {
    int source; /* glTF image */
    enum texture_use use;
    float roughness;       /* TEXTURE_GLOSS: factor */
    float glossiest;       /* TEXTURE_GLOSS: glossiness where the map is 1 */
    float metallic_mean;   /* TEXTURE_GLOSS: of the blue channel */
    bool metallic_varies;  /* TEXTURE_GLOSS */
    float roughness_mean;  /* TEXTURE_GLOSS: of the green channel */
    bool roughness_varies; /* TEXTURE_GLOSS */
    bool has_means;        /* TEXTURE_COLOUR_MEAN, TEXTURE_DATA_MEAN */
    float means[4];        /* ... by channel, linear */
    bool varies[4];
    const tl_image *image; /* NULL: could not be read, or not kept */
};

struct texture_reader {
    const gltf_document *document;
    tl_model *model;
    struct texture_loaded *loaded;
    size_t loaded_count;
    uint64_t texel_count; /* decoded so far */
};

/* Points `map` at the texture's picture, decoded for that use; `roughness`: the factor of a gloss map. Never
 * NULL; without a picture its `image` is NULL. Lives as long as the reader. */
const struct texture_loaded *texture_read_map(struct texture_reader *reader,
                                              const struct gltf_texture *texture, enum texture_use use,
                                              float roughness, struct tl_map *map);

/* materials, images: one tl_material for each of the file's and a default one after them. An image that is
 * missing or cannot be decoded is noted, and its map left out. */
void model_read_materials(const gltf_document *document, tl_model *model);

/* variants, once the mesh has its parts; sources [mesh.part_count]: the primitive that each part is of. */
bool model_read_variants(const gltf_document *document, const struct gltf_primitive *const *sources,
                         tl_model *model, tl_error *error);

/* A material while it is read. `base`, `metallic` and `roughness` are the means over the surface. */
struct material_build {
    struct texture_reader *textures;
    tl_model *model;
    const struct gltf_material *from;
    float base[3]; /* without its map, linear */
    float metallic, roughness;
    bool roughness_varies;
    tl_material *to;
};
/* F0 of what is no metal [KHR_materials_ior, KHR_materials_specular]. (model_extensions.c) */
vec3s model_dielectric_f0(const struct material_build *build);
/* The other extensions, once `to` is as glTF without them has it. (model_extensions.c) */
void model_apply_extensions(const struct material_build *build);

/* What an F0 is multiplied by when a GGX lobe of these widths is shown by Ward's (model_extensions.c). */
float model_ward_factor(float width_weft, float width_warp);

/* Mean over a texture, by channel; 1 where there is none. `which` of "rgba" are meant, or "colour": red,
 * green and blue, taken from sRGB to linear. Where one of them varies, that is told of `what`. */
struct model_mean {
    float r, g, b, a;
};
struct model_mean model_map_mean(const struct material_build *build, const struct gltf_texture *texture,
                                 const char *which, const char *what);
/* A colour map that multiplies. */
void model_colour_map(const struct material_build *build, const struct gltf_texture *texture,
                      struct tl_map *out);

#endif
