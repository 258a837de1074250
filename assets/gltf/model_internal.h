/* The steps of gltf_load_model: the rig (rig_read.c), morph targets (model_morphs.c), primitives
 * (model_primitive.c), materials (model_materials.c, model_texture.c, model_extensions.c), variants
 * (model_variants.c). */
#ifndef TOILE_ASSETS_GLTF_MODEL_INTERNAL_H
#define TOILE_ASSETS_GLTF_MODEL_INTERNAL_H

#include "assets/base/model_build.h"
#include "assets/base/rig.h"
#include "assets/gltf/gltf_internal.h"

/* Reads the nodes of a document, their order, and its clips; gltf_load_model adds slots and vertices. On
 * failure the caller destroys the rig. */
bool rig_read(const gltf_document *document, tl_rig *rig, tl_error *error);

/* Numbers the morph targets of all nodes and reads their weights at rest; rig_read calls it. (model_morphs.c)
 */
bool rig_read_weights(const gltf_document *document, tl_rig *rig, tl_error *error);

/* Memory that the targets of a document have taken so far. */
struct morph_reading {
    size_t read, kept; /* offsets */
    size_t capacity;   /* of rig->morphs */
};
/* Adds the targets of a primitive whose vertices, as `node` draws them, begin at `first_vertex` of the rig;
 * `normals` [rig's vertices] become those of the weights at rest. (model_morphs.c) */
bool rig_read_morphs(const gltf_document *document, const struct gltf_primitive *from, int node,
                     size_t first_vertex, size_t vertex_count, struct morph_reading *reading, tl_rig *rig,
                     vec3s *normals, tl_error *error);

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
/* Converts to a list of triangles; needs to->vertex_count. */
bool gltf_primitive_read_indices(const gltf_document *document, const struct gltf_primitive *from,
                                 struct gltf_vertices *to, tl_error *error);
void gltf_vertices_release(struct gltf_vertices *vertices);

/* The use of a decoded image decides how its texels are interpreted. */
enum texture_use {
    TEXTURE_COLOUR,
    TEXTURE_DATA,
    TEXTURE_GLOSS,
    TEXTURE_METAL, /* the blue channel alone */
    TEXTURE_COLOUR_MEAN,
    TEXTURE_DATA_MEAN
};

/* Maps that one material may name; an image is decoded once for each use. */
#define MAPS_MAX 20

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
    bool has_alpha;        /* TEXTURE_COLOUR: it is not 1 everywhere */
    float alpha_highest;   /* ... */
    float alpha_mean;      /* ... of the texels that have at least half of the highest */
    bool alpha_varies;     /* ... among these */
    const tl_image *image; /* NULL: could not be read, or not kept */
};

struct texture_reader {
    const gltf_document *document;
    tl_model *model;
    struct texture_loaded *loaded;
    size_t loaded_count;
    uint64_t decoded_bytes; /* of all maps so far */
    bool is_full;           /* they are more than the file may take: no more are decoded */
};

/* Points `map` to the texture's image, decoded for that use; `roughness`: the factor of a gloss map. Returns
 * facts about the image, valid as long as the reader, never NULL; `image` is NULL when there is none. */
const struct texture_loaded *texture_read_map(struct texture_reader *reader,
                                              const struct gltf_texture *texture, enum texture_use use,
                                              float roughness, struct tl_map *map);

/* Fills the model's materials and images: one tl_material for each of the file's, then a default one. An
 * image that is missing or cannot be decoded is noted, and its map left out. Fails when there are more
 * materials than a file of its size may have. */
bool model_read_materials(const gltf_document *document, tl_model *model, tl_error *error);

/* Fills the model's variants; its mesh must have its parts. sources [mesh.part_count]: each part's primitive.
 */
bool model_read_variants(const gltf_document *document, const struct gltf_primitive *const *sources,
                         tl_model *model, tl_error *error);

/* The extensions of a material that are shown differently, while it is read. */
#define EXTENSIONS_MAX 16
struct extension_notes {
    size_t count;
    char names[EXTENSIONS_MAX][48];
};

/* A material while it is read. `base`, `metallic` and `roughness` are the means over the surface. */
struct material_build {
    struct texture_reader *textures;
    tl_model *model;
    const struct gltf_material *from;
    float base[3]; /* without its map, linear */
    float metallic, roughness;
    bool roughness_varies;
    tl_material *to;
    struct extension_notes *notes;
};
/* Notes that an extension is shown differently, for the model and for the material: "NAME: how". */
void model_approximate_extension(const struct material_build *build, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Adds what becomes of each extension that the file's material names. (model_extension_notes.c) */
void model_list_extensions(const struct material_build *build, size_t material);
/* F0 of the dielectric part [KHR_materials_ior, KHR_materials_specular]. (model_extensions.c) */
vec3s model_dielectric_f0(const struct material_build *build);
/* Applies the other extensions to `to`, which must be complete without them. (model_extensions.c) */
void model_apply_extensions(const struct material_build *build);

/* Makes maps of kd = base (1 - m) and F0 = f0 (1 - m) + base m where metalness m, `factor` times its texture,
 * varies; both are exact to their 8 bits. False, and nothing is changed, where the base colour's texture lies
 * otherwise on the surface, or reflection has a map already. (model_metal.c) */
bool model_bake_metal(const struct material_build *build, float factor, vec3s f0);

/* Factor on F0 when a GGX lobe of these widths is approximated by Ward's (model_extensions.c). */
float model_ward_factor(float width_weft, float width_warp);

/* Fuzz (tl_fuzz) for KHR_materials_sheen of a roughness in [0, 1]: `amount` multiplies the sheen's colour.
 * And the sheen's roughness, from 0.2, for fuzz of a roughness. */
struct model_fuzz {
    float amount, roughness;
};
struct model_fuzz model_fuzz_of_sheen(float roughness);
float model_sheen_of_fuzz(float roughness);

/* Mean of a texture by channel; 1 without a texture. `which`: the channels in use, of "rgba", or "colour" for
 * red, green and blue, converted from sRGB to linear. If one of them varies, an approximation of `what` is
 * noted. */
struct model_mean {
    float r, g, b, a;
};
struct model_mean model_map_mean(const struct material_build *build, const struct gltf_texture *texture,
                                 const char *which, const char *what);
/* Points `out` to a texture that multiplies a colour. */
void model_colour_map(const struct material_build *build, const struct gltf_texture *texture,
                      struct tl_map *out);

#endif
