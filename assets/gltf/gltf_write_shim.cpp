extern "C" {
#include "assets/gltf/gltf_model.h"
#include "assets/gltf/model_internal.h"
#include "assets/image/image_file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
}

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace
{

const float AS_IT_IS = -1;

/* The file under construction. Every array is appended to its one buffer. */
struct Writer {
    tinygltf::Model model;
    std::map<std::pair<const tl_image *, float>, int>
        textures; /* written so far: image, and glossiness or AS_IT_IS */
};

int add_view(Writer &writer, const void *bytes, size_t size, int target)
{
    std::vector<unsigned char> &data = writer.model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4); /* accessors start at multiples of their component's size */
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    view.target = target;
    const unsigned char *first = static_cast<const unsigned char *>(bytes);
    data.insert(data.end(), first, first + size);
    writer.model.bufferViews.push_back(view);
    return static_cast<int>(writer.model.bufferViews.size() - 1);
}

int add_accessor(Writer &writer, int view, size_t offset, size_t count, int component, int type)
{
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.componentType = component;
    accessor.count = count;
    accessor.type = type;
    writer.model.accessors.push_back(accessor);
    return static_cast<int>(writer.model.accessors.size() - 1);
}

int add_floats(Writer &writer, const float *values, size_t count, int components, int type)
{
    size_t bytes = count * static_cast<size_t>(components) * sizeof(float);
    int view = add_view(writer, values, bytes, TINYGLTF_TARGET_ARRAY_BUFFER);
    return add_accessor(writer, view, 0, count, TINYGLTF_COMPONENT_TYPE_FLOAT, type);
}

/* Positions must state their bounds [glTF 2.0, 3.6.2.5]. */
int add_positions(Writer &writer, const tl_surface &surface)
{
    int index = add_floats(writer, surface.positions[0].raw, surface.vertex_count, 3, TINYGLTF_TYPE_VEC3);
    tl_box box = tl_box_of(surface.positions, surface.vertex_count);
    tinygltf::Accessor &accessor = writer.model.accessors[static_cast<size_t>(index)];
    for (int i = 0; i < 3; i++) {
        accessor.minValues.push_back(static_cast<double>(box.lower.raw[i]));
        accessor.maxValues.push_back(static_cast<double>(box.upper.raw[i]));
    }
    return index;
}

/* Images are stored as PNG in the buffer. */
int add_texture(Writer &writer, const tl_image *image, const char *path, tl_error *error)
{
    void *png;
    size_t size;
    if (!tl_image_encode_png(path, image, &png, &size, error))
        throw std::runtime_error("a map could not be encoded");
    tinygltf::Image picture;
    picture.mimeType = "image/png";
    picture.bufferView = add_view(writer, png, size, 0);
    std::free(png);
    writer.model.images.push_back(picture);
    tinygltf::Texture texture;
    texture.source = static_cast<int>(writer.model.images.size() - 1);
    writer.model.textures.push_back(texture);
    return static_cast<int>(writer.model.textures.size() - 1);
}

/* The inverse of tl_glossiness_from_roughness where it has one: alpha^2 = 2 / (4 s + 2), roughness =
 * alpha^0.5. */
double roughness_of(float glossiness)
{
    double exponent = 1 / std::fmax(1 - static_cast<double>(glossiness), 1e-6);
    return std::pow(2 / (4 * exponent + 2), 0.25);
}

/* glTF's packed texture for a gloss map: roughness in green, metalness in blue (all ones: the factor
 * decides). */
int add_roughness_texture(Writer &writer, const tl_image *gloss, float glossiness, const char *path,
                          tl_error *error)
{
    size_t texels = static_cast<size_t>(gloss->width) * static_cast<size_t>(gloss->height);
    size_t channels = static_cast<size_t>(gloss->channels);
    std::vector<unsigned char> packed(3 * texels, 255);
    for (size_t i = 0; i < texels; i++) {
        float value = glossiness * static_cast<float>(tl_image_bytes(gloss)[i * channels]) / 255;
        packed[3 * i + 1] = static_cast<unsigned char>(std::lround(255 * roughness_of(value)));
    }
    tl_image image = *gloss;
    image.channels = 3;
    image.texels = packed.data();
    return add_texture(writer, &image, path, error);
}

/* The index of a map's texture; a glossiness other than AS_IT_IS marks a gloss map. */
int find_texture(Writer &writer, const tl_image *image, float glossiness, const char *path, tl_error *error)
{
    auto key = std::make_pair(image, glossiness);
    auto known = writer.textures.find(key);
    if (known != writer.textures.end())
        return known->second;
    int index = glossiness == AS_IT_IS ? add_texture(writer, image, path, error)
                                       : add_roughness_texture(writer, image, glossiness, path, error);
    writer.textures[key] = index;
    return index;
}

tinygltf::Value pair_of(const float values[2])
{
    tinygltf::Value::Array array;
    for (int i = 0; i < 2; i++)
        array.emplace_back(static_cast<double>(values[i]));
    return tinygltf::Value(array);
}

bool is_identity(const tl_uv_transform &t)
{
    return t.offset[0] == 0 && t.offset[1] == 0 && t.scale[0] == 1 && t.scale[1] == 1 && t.rotation == 0;
}

void use_extension(Writer &writer, const char *name)
{
    std::vector<std::string> &used = writer.model.extensionsUsed;
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.push_back(name);
}

tinygltf::Value transform_of(Writer &writer, const tl_uv_transform &t)
{
    tinygltf::Value::Object transform;
    transform["offset"] = pair_of(t.offset);
    transform["scale"] = pair_of(t.scale);
    transform["rotation"] = tinygltf::Value(static_cast<double>(t.rotation));
    use_extension(writer, "KHR_texture_transform");
    return tinygltf::Value(transform);
}

template <typename Info>
void add_map(Writer &writer, const tl_map &map, float glossiness, Info &to, const char *path, tl_error *error)
{
    if (!map.image)
        return;
    to.index = find_texture(writer, map.image, glossiness, path, error);
    if (!is_identity(map.transform))
        to.extensions["KHR_texture_transform"] = transform_of(writer, map.transform);
}

/* ---- Extensions: the inverse of model_extensions.c, where it has one ---- */

tinygltf::Value number(double value)
{
    return tinygltf::Value(value);
}

tinygltf::Value colour(const vec3s &value, double divisor)
{
    tinygltf::Value::Array array;
    for (float channel : value.raw)
        array.emplace_back(static_cast<double>(channel) / divisor);
    return tinygltf::Value(array);
}

void extend(Writer &writer, tinygltf::Material &to, const char *name, const tinygltf::Value::Object &members)
{
    to.extensions[name] = tinygltf::Value(members);
    use_extension(writer, name);
}

bool is_stretched(const tl_material &from)
{
    return from.gloss.model == TL_REFLECT_WARD && from.gloss.width_weft > 0 && from.gloss.width_warp > 0 &&
           from.gloss.width_weft != from.gloss.width_warp;
}

/* Ward's wide axis is the direction that GGX is stretched along. */
void add_anisotropy(Writer &writer, const tl_material &from, tinygltf::Material &to)
{
    double weft = static_cast<double>(from.gloss.width_weft),
           warp = static_cast<double>(from.gloss.width_warp);
    double wide = std::fmax(weft, warp), alpha = std::fmin(weft, warp);
    double turned = static_cast<double>(from.gloss.rotation) + (warp > weft ? M_PI / 2 : 0);
    to.pbrMetallicRoughness.roughnessFactor = std::sqrt(alpha);
    extend(writer, to, "KHR_materials_anisotropy",
           {{"anisotropyStrength", number(std::sqrt((wide - alpha) / (1 - alpha)))},
            {"anisotropyRotation", number(turned)}});
}

/* F0 of a dielectric, as an index of refraction and a specular colour. */
void add_reflectance(Writer &writer, const tl_material &from, const vec3s &f0, tinygltf::Material &to,
                     const char *path, tl_error *error)
{
    double index = from.gloss.index > 1 ? static_cast<double>(from.gloss.index) : 1.5;
    double root = (index - 1) / (index + 1), plain = root * root;
    bool tinted = false;
    for (float channel : f0.raw)
        tinted = tinted || std::fabs(static_cast<double>(channel) / plain - 1) > 1e-4;
    if (std::fabs(index - 1.5) > 1e-5)
        extend(writer, to, "KHR_materials_ior", {{"ior", number(index)}});
    if (!tinted && !from.specular_map.image)
        return;
    tinygltf::Value::Object members = {{"specularColorFactor", colour(f0, plain)}};
    if (from.specular_map.image) {
        tinygltf::Value::Object map = {
            {"index", tinygltf::Value(find_texture(writer, from.specular_map.image, AS_IT_IS, path, error))}};
        if (!is_identity(from.specular_map.transform))
            map["extensions"] = tinygltf::Value(tinygltf::Value::Object{
                {"KHR_texture_transform", transform_of(writer, from.specular_map.transform)}});
        members["specularColorTexture"] = tinygltf::Value(map);
    }
    extend(writer, to, "KHR_materials_specular", members);
}

void add_coat(Writer &writer, const tl_material &from, tinygltf::Material &to)
{
    if (from.coat > 0)
        extend(writer, to, "KHR_materials_clearcoat",
               {{"clearcoatFactor", number(static_cast<double>(from.coat))},
                {"clearcoatRoughnessFactor", number(roughness_of(from.coat_glossiness))}});
}

/* Fuzz as the sheen that it is read back from. */
void add_sheen(Writer &writer, const tl_material &from, tinygltf::Material &to)
{
    if (!tl_material_has_fuzz(&from))
        return;
    float roughness = model_sheen_of_fuzz(from.fuzz.roughness);
    double amount = static_cast<double>(model_fuzz_of_sheen(roughness).amount);
    double maximum = static_cast<double>(glms_vec3_max(from.fuzz.colour));
    extend(writer, to, "KHR_materials_sheen",
           {{"sheenColorFactor", colour(from.fuzz.colour, std::fmax(amount, maximum))},
            {"sheenRoughnessFactor", number(static_cast<double>(roughness))}});
}

/* Diffuse transmission: its share, and the base colour for the remaining, reflected light. */
double add_transmission(Writer &writer, const tl_material &from, tinygltf::Material &to)
{
    double share = std::fmin(static_cast<double>(glms_vec3_max(from.transmission)), 0.99);
    if (share > 0)
        extend(writer, to, "KHR_materials_diffuse_transmission",
               {{"diffuseTransmissionFactor", number(share)},
                {"diffuseTransmissionColorFactor", colour(from.transmission, share)}});
    return share;
}

void warn_of_losses(const tl_material &from, bool metal, const char *path)
{
    std::string left;
    const std::pair<bool, const char *> parts[] = {
        {from.gloss.model != TL_REFLECT_PHONG && !is_stretched(from) && !tl_gloss_has_tails(&from.gloss),
         "its reflectance model"},
        {from.thread_count > 0, "the bands of light from inside its threads"},
        {from.openness > 0 && from.alpha_cutoff > 0, "its openness beside its mask"},
        {metal && glms_vec3_max(from.transmission) > 0, "transmission of a metal"},
        {from.weave != nullptr, "its weave"},
        {from.height_map.image != nullptr, "its heights"}};
    for (const auto &part : parts)
        if (part.first)
            left += std::string(left.empty() ? "" : ", ") + part.second;
    if (!left.empty())
        tl_info("%s: %s: glTF cannot represent %s", path, from.name, left.c_str());
}

/* Openness is what blending reads as (model_materials.c); a surface with a mask keeps that. */
void add_alpha(const tl_material &from, tinygltf::Material &to)
{
    if (from.alpha_cutoff > 0) {
        to.alphaMode = "MASK";
        to.alphaCutoff = static_cast<double>(from.alpha_cutoff);
    } else if (from.openness > 0) {
        to.alphaMode = "BLEND";
        to.pbrMetallicRoughness.baseColorFactor[3] = 1 - static_cast<double>(from.openness);
    }
}

/* glTF's factors end at 1; more is strength. */
void add_emission(Writer &writer, const tl_material &from, tinygltf::Material &to, const char *path,
                  tl_error *error)
{
    if (!tl_material_emits(&from))
        return;
    double strength = std::fmax(static_cast<double>(glms_vec3_max(from.emission)), 1);
    to.emissiveFactor.clear();
    for (float channel : from.emission.raw)
        to.emissiveFactor.push_back(static_cast<double>(channel) / strength);
    if (strength > 1)
        extend(writer, to, "KHR_materials_emissive_strength", {{"emissiveStrength", number(strength)}});
    add_map(writer, from.emission_map, AS_IT_IS, to.emissiveTexture, path, error);
}

/* glTF has one base colour for both lobes: the diffuse one, or for a metal the specular one. */
int add_material(Writer &writer, const tl_material &from, const char *path, tl_error *error)
{
    tinygltf::Material to;
    to.name = from.name;
    const vec3s diffuse = tl_material_colour(&from);
    bool metal = glms_vec3_max(diffuse) < 0.5f * glms_vec3_max(from.specular);
    vec3s f0 = from.specular;
    if (is_stretched(from))
        f0 = glms_vec3_divs(f0, model_ward_factor(from.gloss.width_weft, from.gloss.width_warp));
    double scattered_back = metal ? 1 : 1 - add_transmission(writer, from, to);
    const vec3s &base = metal ? f0 : diffuse;
    to.pbrMetallicRoughness.baseColorFactor.clear();
    for (float channel : base.raw)
        to.pbrMetallicRoughness.baseColorFactor.push_back(
            std::fmin(static_cast<double>(channel) / scattered_back, 1));
    to.pbrMetallicRoughness.baseColorFactor.push_back(1);
    to.pbrMetallicRoughness.metallicFactor = metal ? 1 : 0;
    const bool is_wide = tl_gloss_has_tails(&from.gloss) && from.gloss.width_weft > 0;
    to.pbrMetallicRoughness.roughnessFactor = from.gloss_map.image ? 1
                                              : is_wide
                                                  ? std::sqrt(static_cast<double>(from.gloss.width_weft))
                                                  : roughness_of(from.glossiness);
    to.normalTexture.scale = static_cast<double>(from.normal_scale);
    to.occlusionTexture.strength = static_cast<double>(from.occlusion_strength);
    to.doubleSided = from.double_sided;
    add_alpha(from, to);
    add_emission(writer, from, to, path, error);
    tinygltf::PbrMetallicRoughness &pbr = to.pbrMetallicRoughness;
    add_map(writer, from.diffuse_map, AS_IT_IS, pbr.baseColorTexture, path, error);
    if (is_stretched(from))
        add_anisotropy(writer, from, to);
    else
        add_map(writer, from.gloss_map, from.glossiness, pbr.metallicRoughnessTexture, path, error);
    if (!metal)
        add_reflectance(writer, from, f0, to, path, error);
    add_coat(writer, from, to);
    add_sheen(writer, from, to);
    warn_of_losses(from, metal, path);
    add_map(writer, from.normal_map, AS_IT_IS, to.normalTexture, path, error);
    add_map(writer, from.occlusion_map, AS_IT_IS, to.occlusionTexture, path, error);
    writer.model.materials.push_back(to);
    return static_cast<int>(writer.model.materials.size() - 1);
}

void add_surface(Writer &writer, const tl_surface &surface, const char *path, tl_error *error)
{
    size_t count = surface.vertex_count;
    std::map<std::string, int> attributes;
    attributes["POSITION"] = add_positions(writer, surface);
    attributes["NORMAL"] = add_floats(writer, surface.normals[0].raw, count, 3, TINYGLTF_TYPE_VEC3);
    if (surface.tangents)
        attributes["TANGENT"] = add_floats(writer, surface.tangents[0].raw, count, 4, TINYGLTF_TYPE_VEC4);
    attributes["TEXCOORD_0"] = add_floats(writer, surface.uvs[0].raw, count, 2, TINYGLTF_TYPE_VEC2);
    int indices = add_view(writer, surface.indices, surface.index_count * sizeof(uint32_t),
                           TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    std::map<int, int> materials;
    tinygltf::Mesh mesh;
    mesh.name = surface.name;
    for (size_t i = 0; i < surface.part_count; i++) {
        const tl_mesh_part &part = surface.parts[i];
        if (part.index_count == 0)
            continue; /* glTF has no empty accessors */
        if (materials.find(part.material) == materials.end())
            materials[part.material] = add_material(writer, surface.materials[part.material], path, error);
        tinygltf::Primitive primitive;
        primitive.attributes = attributes;
        primitive.material = materials[part.material];
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.indices =
            add_accessor(writer, indices, part.first_index * sizeof(uint32_t), part.index_count,
                         TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
        mesh.primitives.push_back(primitive);
    }
    writer.model.meshes.push_back(mesh);
    tinygltf::Node node;
    node.name = surface.name;
    node.mesh = static_cast<int>(writer.model.meshes.size() - 1);
    writer.model.nodes.push_back(node);
    writer.model.scenes[0].nodes.push_back(static_cast<int>(writer.model.nodes.size() - 1));
}

} // namespace

bool gltf_write_glb(const char *path, const tl_surface *surfaces, size_t surface_count, char **data,
                    size_t *size, tl_error *error)
{
    try {
        Writer writer;
        writer.model.asset.version = "2.0";
        writer.model.asset.generator = "toile";
        writer.model.buffers.resize(1);
        writer.model.scenes.resize(1);
        writer.model.defaultScene = 0;
        for (size_t i = 0; i < surface_count; i++)
            if (surfaces[i].index_count > 0)
                add_surface(writer, surfaces[i], path, error);
        std::ostringstream stream;
        tinygltf::TinyGLTF format;
        if (!format.WriteGltfSceneToStream(&writer.model, stream, false, true))
            return tl_fail(error, TL_OUTPUT, "%s: the model could not be written as GLB: make it smaller",
                           path);
        const std::string bytes = stream.str();
        *size = bytes.size();
        *data = static_cast<char *>(tl_alloc(bytes.size(), 1));
        std::memcpy(*data, bytes.data(), bytes.size());
        return true;
    } catch (const std::exception &failure) {
        return tl_fail(error, TL_OUTPUT, "%s: the model could not be written as GLB: %s", path,
                       failure.what());
    }
}
