/* A parsed glTF file as plain C, filled by gltf_shim.cpp (tinygltf).
 *
 * The shim copies without checks: every index, offset and count below comes from the file unchecked, and must
 * be checked where it is used (gltf_read_* do that for accessors). -1: absent. Lifetime: pointers are valid
 * as long as the document. */
#ifndef TOILE_ASSETS_GLTF_GLTF_INTERNAL_H
#define TOILE_ASSETS_GLTF_GLTF_INTERNAL_H

#include "assets/base/material.h"
#include "assets/base/rig.h"
#include "config/base/error.h"

#include <stddef.h>
#include <stdint.h>

struct gltf_buffer {
    const uint8_t *data;
    size_t size;
};

/* EXT_meshopt_compression: where a view's bytes are in compressed form, and what they become. */
enum gltf_meshopt_mode {
    GLTF_MESHOPT_NONE, /* not compressed */
    GLTF_MESHOPT_ATTRIBUTES,
    GLTF_MESHOPT_TRIANGLES,
    GLTF_MESHOPT_INDICES,
    GLTF_MESHOPT_OTHER_MODE
};
enum gltf_meshopt_filter {
    GLTF_FILTER_NONE,
    GLTF_FILTER_OCTAHEDRAL,
    GLTF_FILTER_QUATERNION,
    GLTF_FILTER_EXPONENTIAL,
    GLTF_FILTER_OTHER
};
struct gltf_meshopt {
    enum gltf_meshopt_mode mode;
    enum gltf_meshopt_filter filter;
    int buffer;
    size_t offset, size;  /* of the compressed bytes */
    size_t stride, count; /* of the elements */
};

struct gltf_view {
    int buffer;
    size_t offset, size, stride; /* bytes; stride 0: tightly packed */
    struct gltf_meshopt meshopt; /* read by gltf_unpack alone */
};

struct gltf_accessor {
    int view; /* -1: zeros */
    size_t offset, count;
    int component_type; /* GL's: 5120 byte ... 5126 float */
    int components;     /* 1 to 16 */
    bool normalized;
    size_t sparse_count; /* 0: not sparse */
    int sparse_index_view, sparse_index_type, sparse_value_view;
    size_t sparse_index_offset, sparse_value_offset;
};

enum gltf_attribute {
    GLTF_POSITION,
    GLTF_NORMAL,
    GLTF_TANGENT,
    GLTF_UV,
    GLTF_JOINTS,
    GLTF_WEIGHTS,
    GLTF_COLOUR,
    GLTF_PIN, /* "_PIN", in either case: vertices that hold the cloth in place */
    GLTF_ATTRIBUTE_COUNT
};

/* KHR_materials_variants: the material that a primitive has in each of some variants. */
struct gltf_mapping {
    int material;
    size_t first_variant, variant_count; /* in mapped_variants */
};

enum { GLTF_MODE_TRIANGLES = 4, GLTF_MODE_STRIP = 5, GLTF_MODE_FAN = 6 }; /* GL's */

/* KHR_draco_mesh_compression: the view of a primitive's stream, and its attributes' ids in the stream. */
struct gltf_draco {
    int view; /* -1: not compressed */
    int ids[GLTF_ATTRIBUTE_COUNT];
};

struct gltf_target {
    int positions, normals; /* accessors of offsets; -1: none */
};

struct gltf_primitive {
    int attributes[GLTF_ATTRIBUTE_COUNT]; /* accessors */
    int indices, material, mode;
    size_t first_mapping, mapping_count;
    size_t first_target, target_count;
    bool has_second_uvs, has_second_joints;
    struct gltf_draco draco; /* read by gltf_unpack alone */
};

struct gltf_mesh {
    size_t first_primitive, primitive_count;
    const double *weights; /* of its morph targets */
    size_t weight_count;
};

struct gltf_node {
    int mesh, skin;
    const int *children;
    size_t child_count;
    bool has_matrix;
    float matrix[16]; /* column-major */
    float translation[3], rotation[4], scale[3];
    const double *weights; /* in place of its mesh's */
    size_t weight_count;
};

struct gltf_skin {
    const int *joints; /* nodes */
    size_t joint_count;
    int inverse_binds; /* accessor */
};

struct gltf_channel {
    int node;
    enum rig_path path;
    enum rig_interpolation interpolation;
    int times, values; /* accessors */
};

struct gltf_animation {
    const char *name;
    size_t first_channel, channel_count;
};

/* A material's use of a texture. */
struct gltf_texture {
    bool used;
    int image; /* -1 where only an extension names one */
    int uv_set;
    struct tl_uv_transform transform;
    bool clamp_u, clamp_v;
};

enum gltf_alpha { GLTF_OPAQUE, GLTF_MASK, GLTF_BLEND };

/* KHR_materials_*, by their specifications' names; without an extension, its defaults. */
struct gltf_extensions {
    float anisotropy_strength, anisotropy_rotation; /* rotation: rad */
    float clearcoat, clearcoat_roughness;
    float diffuse_transmission, diffuse_transmission_colour[3];
    float ior;
    float sheen_colour[3], sheen_roughness;
    float specular, specular_colour[3];
    float transmission;
    struct gltf_texture anisotropy_map, clearcoat_map, clearcoat_roughness_map, clearcoat_normal_map,
        diffuse_transmission_map, diffuse_transmission_colour_map, sheen_colour_map, sheen_roughness_map,
        specular_map, specular_colour_map, transmission_map;
};

struct gltf_material {
    const char *name;
    float base_colour[4], metallic, roughness, normal_scale, occlusion_strength, alpha_cutoff;
    enum gltf_alpha alpha;
    const char *const *used; /* names of its extensions */
    size_t used_count;
    float emission[3], emissive_strength;
    bool double_sided;
    struct gltf_texture base_colour_map, metallic_roughness_map, normal_map, occlusion_map, emission_map;
    struct gltf_extensions extensions;
};

struct gltf_image {
    const uint8_t *data; /* NULL: in `view`, or could not be read */
    size_t size;
    int view;
    const char *name; /* its uri or name, for messages */
};

typedef struct gltf_document {
    const char *path;  /* for messages; borrowed */
    size_t file_bytes; /* of the document and the files that it names */
    size_t buffer_count, view_count, accessor_count, primitive_count, mesh_count, node_count, skin_count,
        channel_count, animation_count, material_count, image_count, root_count, used_count, variant_count;
    const struct gltf_buffer *buffers;
    const struct gltf_view *views;
    const struct gltf_accessor *accessors;
    const struct gltf_primitive *primitives;
    const struct gltf_target *targets;
    const struct gltf_mesh *meshes;
    const struct gltf_node *nodes;
    const struct gltf_skin *skins;
    const struct gltf_channel *channels;
    const struct gltf_animation *animations;
    const struct gltf_material *materials;
    const struct gltf_image *images;
    const struct gltf_mapping *mappings;
    const int *mapped_variants;
    const char *const *variants; /* names; "": none given */
    bool has_scene;
    const int *roots;        /* nodes of the scene */
    const char *const *used; /* extensions */
    bool has_cameras, has_lights;
    void *owner;                    /* the shim's */
    struct gltf_unpacked *unpacked; /* what gltf_unpack made, or NULL */
} gltf_document;

static inline uint32_t gltf_little_endian(const uint8_t *bytes)
{
    /* A false positive: the analyser assumes that a check failed but the function went on. */
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference)
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* Parses JSON and gathers its buffers and images; `binary` is the GLB's BIN chunk or NULL. Nothing of
 * `json` and `binary` is kept. (gltf_shim.cpp; callers use gltf_open.) */
bool gltf_parse(const char *path, const char *json, size_t json_size, const uint8_t *binary,
                size_t binary_size, gltf_document *out, tl_error *error);
void gltf_parse_release(gltf_document *document);

/* The JSON text of a compressed file as tinygltf takes it, a new string for free(); NULL where nothing is to
 * be changed, and where the text is not sound. */
char *gltf_prepare_json(const char *json, size_t size);

/* Decompresses the streams of EXT_meshopt_compression and KHR_draco_mesh_compression: `document` then has
 * buffers, views and accessors as an uncompressed file has, which gltf_close releases. Broken streams, and
 * streams that would become larger than their bytes can be meant to, are refused. */
bool gltf_unpack(gltf_document *document, tl_error *error);
void gltf_unpack_release(gltf_document *document);

/* Reads a .gltf or .glb file, after checks of its container; gltf_close releases the document. */
bool gltf_open(const char *path, gltf_document *out, tl_error *error);
void gltf_close(gltf_document *document);

/* `size` bytes of a buffer; false (with a message that names `what`) when they are not all there. */
bool gltf_buffer_bytes(const gltf_document *document, int buffer, size_t offset, size_t size,
                       const char *what, const uint8_t **bytes, tl_error *error);

/* Bytes of a view within its buffer; false (with a message that names `what`) when they are not all there. */
bool gltf_view_bytes(const gltf_document *document, int view, const char *what, const uint8_t **bytes,
                     size_t *size, tl_error *error);

/* Values of an accessor of `components` components as floats, normalised where it is so marked; free(*out).
 * Refuses other shapes, more than `limit` elements, and values that are not finite unless `any_value`. */
bool gltf_read_floats(const gltf_document *document, int accessor, const char *what, int components,
                      size_t limit, bool any_value, float **out, size_t *count, tl_error *error);

/* Unsigned integers (indices, joints); free(*out). */
bool gltf_read_integers(const gltf_document *document, int accessor, const char *what, int components,
                        size_t limit, uint32_t **out, size_t *count, tl_error *error);

#endif
