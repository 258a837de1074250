extern "C" {
#include "assets/gltf/gltf_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"
}

#include <tiny_gltf.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

/* The document's arrays, and the tinygltf model whose bytes and strings they point to. */
struct Owner {
    tinygltf::Model model;
    std::vector<gltf_buffer> buffers;
    std::vector<gltf_view> views;
    std::vector<gltf_accessor> accessors;
    std::vector<gltf_primitive> primitives;
    std::vector<gltf_target> targets;
    std::vector<gltf_mesh> meshes;
    std::vector<gltf_node> nodes;
    std::vector<gltf_skin> skins;
    std::vector<gltf_channel> channels;
    std::vector<gltf_animation> animations;
    std::vector<gltf_material> materials;
    std::vector<gltf_image> images;
    std::vector<gltf_mapping> mappings;
    std::vector<int> mapped_variants;
    std::vector<std::string> variant_names;
    std::vector<const char *> used, variants, material_extensions;
};

/* tinygltf's own callbacks are not used: its path expansion hands names from the file to a shell
 * (wordexp), and its reader opens devices and folders. */

bool file_exists(const std::string &path, void *)
{
    return tl_file_exists(path.c_str());
}

std::string keep_path(const std::string &path, void *)
{
    return path;
}

/* The files that a document names. It may name one file many times, and tinygltf reads it each time. */
struct Named {
    const char *path;      /* the document's */
    size_t bytes;          /* of the document and of the files, each once */
    size_t repeated_bytes; /* of the files that were read again */
    std::set<std::string> paths;
};

bool read_file(std::vector<unsigned char> *out, std::string *message, const std::string &path, void *user)
{
    Named *named = static_cast<Named *>(user);
    char *data;
    size_t size;
    tl_error error;
    if (!tl_path_is_inside(named->path, path.c_str(), &error)) {
        if (message)
            *message = error.message;
        return false;
    }
    (named->paths.insert(path).second ? named->bytes : named->repeated_bytes) += tl_file_size(path.c_str());
    if (!tl_memory_request_for_file(named->path, named->bytes, named->repeated_bytes, &error) ||
        !tl_file_read(path.c_str(), &data, &size, &error)) {
        if (message)
            *message = error.message;
        return false;
    }
    out->assign(data, data + size);
    std::free(data);
    return true;
}

/* Keeps an image file's bytes for tl_image_decode. Those in a buffer view stay there: tinygltf has not
 * checked that the view's bytes exist. */
bool keep_image(tinygltf::Image *image, int, std::string *, std::string *, int, int,
                const unsigned char *bytes, int size, void *)
{
    image->as_is = true;
    if (image->bufferView < 0)
        image->image.assign(bytes, bytes + size);
    return true;
}

void append(std::vector<char> &out, const void *bytes, size_t size)
{
    const char *first = static_cast<const char *>(bytes);
    out.insert(out.end(), first, first + size);
}

void append_word(std::vector<char> &out, size_t word)
{
    const unsigned char bytes[4] = {static_cast<unsigned char>(word), static_cast<unsigned char>(word >> 8),
                                    static_cast<unsigned char>(word >> 16),
                                    static_cast<unsigned char>(word >> 24)};
    append(out, bytes, sizeof bytes);
}

/* Assembles a GLB of the two chunks: both kinds of file then take one path, with lengths that are right. */
std::vector<char> make_glb(const char *json, size_t json_size, const uint8_t *binary, size_t binary_size)
{
    size_t json_padded = (json_size + 3) / 4 * 4, binary_padded = (binary_size + 3) / 4 * 4;
    std::vector<char> glb;
    glb.reserve(28 + json_padded + binary_padded);
    append(glb, "glTF", 4);
    append_word(glb, 2);
    append_word(glb, 20 + json_padded + (binary_size ? 8 + binary_padded : 0));
    append_word(glb, json_padded);
    append(glb, "JSON", 4);
    append(glb, json, json_size);
    glb.resize(20 + json_padded, ' ');
    if (binary_size) {
        append_word(glb, binary_padded);
        append(glb, "BIN\0", 4);
        append(glb, binary, binary_size);
        glb.resize(28 + json_padded + binary_padded, '\0');
    }
    return glb;
}

std::string folder_of(const std::string &path)
{
    size_t slash = path.rfind('/');
    return slash == std::string::npos ? "." : path.substr(0, slash ? slash : 1);
}

int member_of(const std::map<std::string, int> &accessors, const char *name)
{
    auto found = accessors.find(name);
    return found == accessors.end() ? -1 : found->second;
}

/* A member of an extension, which is raw JSON; null where there is none. */
const tinygltf::Value &member(const tinygltf::Value &object, const char *name)
{
    static const tinygltf::Value none;
    return object.IsObject() && object.Has(name) ? object.Get(name) : none;
}

int index_of(const tinygltf::Value &value)
{
    return value.IsInt() ? value.GetNumberAsInt() : -1;
}

size_t offset_of(int value)
{
    return value < 0 ? SIZE_MAX : static_cast<size_t>(value); /* refused by the bounds check */
}

void copy_draco(const tinygltf::Primitive &from, gltf_draco &to, const char *const names[])
{
    auto found = from.extensions.find("KHR_draco_mesh_compression");
    to.view = found == from.extensions.end() ? -1 : index_of(member(found->second, "bufferView"));
    for (int i = 0; i < GLTF_ATTRIBUTE_COUNT; i++)
        to.ids[i] = to.view < 0 ? -1 : index_of(member(member(found->second, "attributes"), names[i]));
    if (to.view >= 0 && to.ids[GLTF_PIN] < 0)
        to.ids[GLTF_PIN] = index_of(member(member(found->second, "attributes"), "_pin"));
}

gltf_meshopt copy_meshopt(const tinygltf::BufferView &from)
{
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    gltf_meshopt to = {};
    auto found = from.extensions.find("EXT_meshopt_compression");
    if (found == from.extensions.end())
        found = from.extensions.find("KHR_meshopt_compression");
    if (found == from.extensions.end())
        return to;
    const tinygltf::Value &packed = found->second, &mode = member(packed, "mode"),
                          &filter = member(packed, "filter");
    to.mode = GLTF_MESHOPT_OTHER_MODE;
    for (int i = 0; i < 3; i++)
        if (mode.IsString() && mode.Get<std::string>() == modes[i])
            to.mode = static_cast<gltf_meshopt_mode>(GLTF_MESHOPT_ATTRIBUTES + i);
    to.filter = filter.IsString() ? GLTF_FILTER_OTHER : GLTF_FILTER_NONE;
    for (int i = 0; i < 4; i++)
        if (filter.IsString() && filter.Get<std::string>() == filters[i])
            to.filter = static_cast<gltf_meshopt_filter>(i);
    to.buffer = index_of(member(packed, "buffer"));
    to.offset = packed.Has("byteOffset") ? offset_of(index_of(packed.Get("byteOffset"))) : 0;
    to.size = offset_of(index_of(member(packed, "byteLength")));
    to.stride = offset_of(index_of(member(packed, "byteStride")));
    to.count = offset_of(index_of(member(packed, "count")));
    return to;
}

gltf_primitive copy_primitive(const tinygltf::Primitive &from)
{
    static const char *const names[GLTF_ATTRIBUTE_COUNT] = {"POSITION", "NORMAL",    "TANGENT", "TEXCOORD_0",
                                                            "JOINTS_0", "WEIGHTS_0", "COLOR_0", "_PIN"};
    gltf_primitive to = {};
    for (int i = 0; i < GLTF_ATTRIBUTE_COUNT; i++)
        to.attributes[i] = member_of(from.attributes, names[i]);
    if (to.attributes[GLTF_PIN] < 0)
        to.attributes[GLTF_PIN] = member_of(from.attributes, "_pin");
    to.indices = from.indices;
    to.material = from.material;
    to.mode = from.mode;
    to.has_second_uvs = member_of(from.attributes, "TEXCOORD_1") >= 0;
    to.has_second_joints = member_of(from.attributes, "JOINTS_1") >= 0;
    copy_draco(from, to.draco, names);
    return to;
}

void copy_floats(float *to, size_t count, const std::vector<double> &from)
{
    for (size_t i = 0; i < count && from.size() == count; i++)
        to[i] = static_cast<float>(from[i]);
}

gltf_node copy_node(const tinygltf::Node &from)
{
    gltf_node to = {};
    to.mesh = from.mesh;
    to.skin = from.skin;
    to.children = from.children.data();
    to.child_count = from.children.size();
    to.has_matrix = from.matrix.size() == 16;
    to.rotation[3] = to.scale[0] = to.scale[1] = to.scale[2] = 1;
    copy_floats(to.matrix, 16, from.matrix);
    copy_floats(to.translation, 3, from.translation);
    copy_floats(to.rotation, 4, from.rotation);
    copy_floats(to.scale, 3, from.scale);
    to.weights = from.weights.data();
    to.weight_count = from.weights.size();
    return to;
}

gltf_accessor copy_accessor(const tinygltf::Accessor &from)
{
    gltf_accessor to = {};
    to.view = from.bufferView;
    to.offset = from.byteOffset;
    to.count = from.count;
    to.component_type = from.componentType;
    to.components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type));
    to.normalized = from.normalized;
    if (from.sparse.isSparse) {
        to.sparse_count = offset_of(from.sparse.count);
        to.sparse_index_view = from.sparse.indices.bufferView;
        to.sparse_index_type = from.sparse.indices.componentType;
        to.sparse_index_offset = offset_of(from.sparse.indices.byteOffset);
        to.sparse_value_view = from.sparse.values.bufferView;
        to.sparse_value_offset = offset_of(from.sparse.values.byteOffset);
    }
    return to;
}

gltf_channel copy_channel(const tinygltf::AnimationChannel &from, const tinygltf::Animation &animation)
{
    gltf_channel to = {};
    to.node = from.target_node;
    to.path = from.target_path == "translation" ? RIG_TRANSLATION
              : from.target_path == "rotation"  ? RIG_ROTATION
              : from.target_path == "scale"     ? RIG_SCALE
              : from.target_path == "weights"   ? RIG_WEIGHTS
                                                : RIG_OTHER_PATH;
    to.times = to.values = -1;
    if (from.sampler >= 0 && static_cast<size_t>(from.sampler) < animation.samplers.size()) {
        const tinygltf::AnimationSampler &sampler = animation.samplers[static_cast<size_t>(from.sampler)];
        to.times = sampler.input;
        to.values = sampler.output;
        to.interpolation = sampler.interpolation == "STEP"          ? RIG_STEP
                           : sampler.interpolation == "CUBICSPLINE" ? RIG_CUBIC_SPLINE
                                                                    : RIG_LINEAR;
    }
    return to;
}

float number_of(const tinygltf::Value &value, float otherwise)
{
    double number = value.IsNumber() ? value.GetNumberAsDouble() : static_cast<double>(otherwise);
    return std::isfinite(number) ? static_cast<float>(number) : otherwise;
}

void copy_pair(float to[2], const tinygltf::Value &from)
{
    if (from.IsArray() && from.ArrayLen() == 2)
        for (int i = 0; i < 2; i++)
            to[i] = number_of(from.Get(i), to[i]);
}

/* `Info` is one of tinygltf's three similar types of texture reference. */
template <typename Info> gltf_texture copy_texture(const tinygltf::Model &model, const Info &from)
{
    gltf_texture to = {};
    to.transform.scale[0] = to.transform.scale[1] = 1;
    to.image = -1;
    to.uv_set = from.texCoord;
    to.used = from.index >= 0 && static_cast<size_t>(from.index) < model.textures.size();
    if (!to.used)
        return to;
    const tinygltf::Texture &texture = model.textures[static_cast<size_t>(from.index)];
    to.image = texture.source;
    if (texture.sampler >= 0 && static_cast<size_t>(texture.sampler) < model.samplers.size()) {
        const tinygltf::Sampler &sampler = model.samplers[static_cast<size_t>(texture.sampler)];
        to.clamp_u = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        to.clamp_v = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    }
    auto found = from.extensions.find("KHR_texture_transform");
    if (found != from.extensions.end() && found->second.IsObject()) {
        const tinygltf::Value &transform = found->second;
        copy_pair(to.transform.offset, transform.Get("offset"));
        copy_pair(to.transform.scale, transform.Get("scale"));
        to.transform.rotation = number_of(transform.Get("rotation"), 0);
        if (transform.Get("texCoord").IsInt())
            to.uv_set = transform.Get("texCoord").GetNumberAsInt();
    }
    return to;
}

void copy_colour(float to[3], const tinygltf::Value &from)
{
    if (from.IsArray() && from.ArrayLen() == 3)
        for (int i = 0; i < 3; i++)
            to[i] = number_of(from.Get(i), to[i]);
}

gltf_texture copy_member_texture(const tinygltf::Model &model, const tinygltf::Value &object,
                                 const char *name)
{
    const tinygltf::Value &from = member(object, name);
    tinygltf::TextureInfo info;
    info.index = member(from, "index").IsInt() ? member(from, "index").GetNumberAsInt() : -1;
    info.texCoord = member(from, "texCoord").IsInt() ? member(from, "texCoord").GetNumberAsInt() : 0;
    const tinygltf::Value &transform = member(member(from, "extensions"), "KHR_texture_transform");
    if (transform.IsObject())
        info.extensions["KHR_texture_transform"] = transform;
    return copy_texture(model, info);
}

const tinygltf::Value &extension_of(const tinygltf::Material &material, const char *name)
{
    static const tinygltf::Value none;
    auto found = material.extensions.find(name);
    return found != material.extensions.end() ? found->second : none;
}

gltf_extensions copy_extensions(const tinygltf::Model &model, const tinygltf::Material &from)
{
    gltf_extensions to = {};
    const tinygltf::Value &anisotropy = extension_of(from, "KHR_materials_anisotropy");
    to.anisotropy_strength = number_of(member(anisotropy, "anisotropyStrength"), 0);
    to.anisotropy_rotation = number_of(member(anisotropy, "anisotropyRotation"), 0);
    to.anisotropy_map = copy_member_texture(model, anisotropy, "anisotropyTexture");
    const tinygltf::Value &coat = extension_of(from, "KHR_materials_clearcoat");
    to.clearcoat = number_of(member(coat, "clearcoatFactor"), 0);
    to.clearcoat_roughness = number_of(member(coat, "clearcoatRoughnessFactor"), 0);
    to.clearcoat_map = copy_member_texture(model, coat, "clearcoatTexture");
    to.clearcoat_roughness_map = copy_member_texture(model, coat, "clearcoatRoughnessTexture");
    to.clearcoat_normal_map = copy_member_texture(model, coat, "clearcoatNormalTexture");
    const tinygltf::Value &diffuse = extension_of(from, "KHR_materials_diffuse_transmission");
    to.diffuse_transmission = number_of(member(diffuse, "diffuseTransmissionFactor"), 0);
    to.diffuse_transmission_map = copy_member_texture(model, diffuse, "diffuseTransmissionTexture");
    to.diffuse_transmission_colour_map =
        copy_member_texture(model, diffuse, "diffuseTransmissionColorTexture");
    to.ior = number_of(member(extension_of(from, "KHR_materials_ior"), "ior"), 1.5F);
    const tinygltf::Value &sheen = extension_of(from, "KHR_materials_sheen");
    copy_colour(to.sheen_colour, member(sheen, "sheenColorFactor"));
    to.sheen_roughness = number_of(member(sheen, "sheenRoughnessFactor"), 0);
    to.sheen_colour_map = copy_member_texture(model, sheen, "sheenColorTexture");
    to.sheen_roughness_map = copy_member_texture(model, sheen, "sheenRoughnessTexture");
    const tinygltf::Value &specular = extension_of(from, "KHR_materials_specular");
    to.specular = number_of(member(specular, "specularFactor"), 1);
    to.specular_map = copy_member_texture(model, specular, "specularTexture");
    to.specular_colour_map = copy_member_texture(model, specular, "specularColorTexture");
    const tinygltf::Value &transmission = extension_of(from, "KHR_materials_transmission");
    to.transmission = number_of(member(transmission, "transmissionFactor"), 0);
    to.transmission_map = copy_member_texture(model, transmission, "transmissionTexture");
    for (int i = 0; i < 3; i++)
        to.specular_colour[i] = to.diffuse_transmission_colour[i] = 1;
    copy_colour(to.specular_colour, member(specular, "specularColorFactor"));
    copy_colour(to.diffuse_transmission_colour, member(diffuse, "diffuseTransmissionColorFactor"));
    return to;
}

gltf_material copy_material(const tinygltf::Model &model, const tinygltf::Material &from)
{
    const tinygltf::PbrMetallicRoughness &pbr = from.pbrMetallicRoughness;
    gltf_material to = {};
    to.name = from.name.c_str();
    for (float &channel : to.base_colour)
        channel = 1;
    copy_floats(to.base_colour, 4, pbr.baseColorFactor);
    to.metallic = static_cast<float>(pbr.metallicFactor);
    to.roughness = static_cast<float>(pbr.roughnessFactor);
    to.normal_scale = static_cast<float>(from.normalTexture.scale);
    to.occlusion_strength = static_cast<float>(from.occlusionTexture.strength);
    to.alpha_cutoff = static_cast<float>(from.alphaCutoff);
    to.alpha = from.alphaMode == "MASK" ? GLTF_MASK : from.alphaMode == "BLEND" ? GLTF_BLEND : GLTF_OPAQUE;
    to.double_sided = from.doubleSided;
    copy_floats(to.emission, 3, from.emissiveFactor);
    to.emissive_strength =
        number_of(member(extension_of(from, "KHR_materials_emissive_strength"), "emissiveStrength"), 1);
    to.base_colour_map = copy_texture(model, pbr.baseColorTexture);
    to.metallic_roughness_map = copy_texture(model, pbr.metallicRoughnessTexture);
    to.normal_map = copy_texture(model, from.normalTexture);
    to.emission_map = copy_texture(model, from.emissiveTexture);
    to.occlusion_map = copy_texture(model, from.occlusionTexture);
    to.extensions = copy_extensions(model, from);
    return to;
}

gltf_image copy_image(const tinygltf::Image &from)
{
    gltf_image to = {};
    to.data = from.image.empty() ? nullptr : from.image.data();
    to.size = from.image.size();
    to.view = from.bufferView;
    to.name = !from.uri.empty() ? from.uri.c_str() : from.name.c_str();
    return to;
}

void copy_mappings(Owner &owner, const tinygltf::Primitive &from, gltf_primitive &to)
{
    auto found = from.extensions.find("KHR_materials_variants");
    if (found == from.extensions.end())
        return;
    const tinygltf::Value &mappings = member(found->second, "mappings");
    to.first_mapping = owner.mappings.size();
    to.mapping_count = mappings.IsArray() ? mappings.ArrayLen() : 0;
    for (size_t i = 0; i < to.mapping_count; i++) {
        const tinygltf::Value &mapping = mappings.Get(static_cast<int>(i)),
                              &variants = member(mapping, "variants");
        size_t count = variants.IsArray() ? variants.ArrayLen() : 0;
        owner.mappings.push_back(
            {index_of(member(mapping, "material")), owner.mapped_variants.size(), count});
        for (size_t k = 0; k < count; k++)
            owner.mapped_variants.push_back(index_of(variants.Get(static_cast<int>(k))));
    }
}

void copy_variants(Owner &owner)
{
    auto found = owner.model.extensions.find("KHR_materials_variants");
    if (found == owner.model.extensions.end())
        return;
    const tinygltf::Value &variants = member(found->second, "variants");
    for (size_t i = 0; variants.IsArray() && i < variants.ArrayLen(); i++) {
        const tinygltf::Value &name = member(variants.Get(static_cast<int>(i)), "name");
        owner.variant_names.push_back(name.IsString() ? name.Get<std::string>() : "");
    }
    for (const std::string &name : owner.variant_names)
        owner.variants.push_back(name.c_str());
}

void copy_geometry(Owner &owner)
{
    const tinygltf::Model &model = owner.model;
    for (const tinygltf::Buffer &buffer : model.buffers)
        owner.buffers.push_back({buffer.data.data(), buffer.data.size()});
    for (const tinygltf::BufferView &view : model.bufferViews)
        owner.views.push_back(
            {view.buffer, view.byteOffset, view.byteLength, view.byteStride, copy_meshopt(view)});
    for (const tinygltf::Accessor &accessor : model.accessors)
        owner.accessors.push_back(copy_accessor(accessor));
    for (const tinygltf::Mesh &mesh : model.meshes) {
        owner.meshes.push_back(
            {owner.primitives.size(), mesh.primitives.size(), mesh.weights.data(), mesh.weights.size()});
        for (const tinygltf::Primitive &primitive : mesh.primitives) {
            owner.primitives.push_back(copy_primitive(primitive));
            copy_mappings(owner, primitive, owner.primitives.back());
            owner.primitives.back().first_target = owner.targets.size();
            owner.primitives.back().target_count = primitive.targets.size();
            for (const std::map<std::string, int> &target : primitive.targets)
                owner.targets.push_back({member_of(target, "POSITION"), member_of(target, "NORMAL")});
        }
    }
    for (const tinygltf::Node &node : model.nodes)
        owner.nodes.push_back(copy_node(node));
    for (const tinygltf::Skin &skin : model.skins)
        owner.skins.push_back({skin.joints.data(), skin.joints.size(), skin.inverseBindMatrices});
    for (const tinygltf::Animation &animation : model.animations) {
        owner.animations.push_back(
            {animation.name.c_str(), owner.channels.size(), animation.channels.size()});
        for (const tinygltf::AnimationChannel &channel : animation.channels)
            owner.channels.push_back(copy_channel(channel, animation));
    }
}

void copy_all_materials(Owner &owner)
{
    const tinygltf::Model &model = owner.model;
    size_t extensions = 0;
    for (const tinygltf::Material &material : model.materials)
        extensions += material.extensions.size();
    owner.material_extensions.reserve(extensions); /* not moved: materials point into it */
    for (const tinygltf::Material &material : model.materials) {
        owner.materials.push_back(copy_material(model, material));
        gltf_material &to = owner.materials.back();
        to.used = owner.material_extensions.data() + owner.material_extensions.size();
        to.used_count = material.extensions.size();
        for (const auto &extension : material.extensions)
            owner.material_extensions.push_back(extension.first.c_str());
    }
    for (const tinygltf::Image &image : model.images)
        owner.images.push_back(copy_image(image));
    copy_variants(owner);
    for (const std::string &name : model.extensionsUsed)
        owner.used.push_back(name.c_str());
}

void point_to(const Owner &owner, gltf_document &out)
{
    out.buffers = owner.buffers.data(), out.buffer_count = owner.buffers.size();
    out.views = owner.views.data(), out.view_count = owner.views.size();
    out.accessors = owner.accessors.data(), out.accessor_count = owner.accessors.size();
    out.primitives = owner.primitives.data(), out.primitive_count = owner.primitives.size();
    out.targets = owner.targets.data();
    out.meshes = owner.meshes.data(), out.mesh_count = owner.meshes.size();
    out.nodes = owner.nodes.data(), out.node_count = owner.nodes.size();
    out.skins = owner.skins.data(), out.skin_count = owner.skins.size();
    out.channels = owner.channels.data(), out.channel_count = owner.channels.size();
    out.animations = owner.animations.data(), out.animation_count = owner.animations.size();
    out.materials = owner.materials.data(), out.material_count = owner.materials.size();
    out.images = owner.images.data(), out.image_count = owner.images.size();
    out.mappings = owner.mappings.data();
    out.mapped_variants = owner.mapped_variants.data();
    out.variants = owner.variants.data(), out.variant_count = owner.variants.size();
    out.used = owner.used.data(), out.used_count = owner.used.size();
    const tinygltf::Model &model = owner.model;
    size_t scene = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
    out.has_scene = scene < model.scenes.size();
    if (out.has_scene)
        out.roots = model.scenes[scene].nodes.data(), out.root_count = model.scenes[scene].nodes.size();
    out.has_cameras = !model.cameras.empty();
    out.has_lights = !model.lights.empty();
}

/* Fails with the first line of tinygltf's message. */
bool fail_parsing(const char *path, const std::string &complaint, tl_error *error)
{
    std::string first = complaint.substr(0, complaint.find('\n'));
    return tl_fail(error, TL_INPUT, "%s: is not sound glTF 2.0: %.300s: export the file again", path,
                   first.empty() ? "it cannot be parsed" : first.c_str());
}

} // namespace

bool gltf_parse(const char *path, const char *json, size_t json_size, const uint8_t *binary,
                size_t binary_size, gltf_document *out, tl_error *error)
{
    *out = gltf_document{};
    Owner *owner = nullptr;
    try {
        if (json_size + binary_size > UINT32_MAX - 64)
            return tl_fail(error, TL_INPUT, "%s: is larger than a GLB can be: keep its buffers apart", path);
        owner = new Owner;
        tinygltf::TinyGLTF parser;
        parser.SetImageLoader(keep_image, nullptr);
        Named named = {path, json_size + binary_size, 0, {}};
        parser.SetFsCallbacks({file_exists, keep_path, read_file, nullptr, &named});
        std::string complaint, warning;
        std::vector<char> glb = make_glb(json, json_size, binary, binary_size);
        if (parser.LoadBinaryFromMemory(&owner->model, &complaint, &warning,
                                        reinterpret_cast<const unsigned char *>(glb.data()),
                                        static_cast<unsigned int>(glb.size()), folder_of(path))) {
            if (owner->model.asset.version.rfind("2.", 0) != 0)
                throw std::runtime_error("asset.version is not 2");
            copy_geometry(*owner);
            copy_all_materials(*owner);
            point_to(*owner, *out);
            out->path = path;
            out->file_bytes = named.bytes;
            out->owner = owner;
            return true;
        }
        fail_parsing(path, complaint, error);
    } catch (const std::exception &failure) {
        fail_parsing(path, failure.what(), error);
    } catch (...) {
        fail_parsing(path, "", error);
    }
    delete owner;
    return false;
}

void gltf_parse_release(gltf_document *document)
{
    delete static_cast<Owner *>(document->owner);
    *document = gltf_document{};
}
