extern "C" {
#include "tests/assets/gltf/packed_shim.h"
}

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <cstdlib>
#include <cstring>

namespace
{

template <typename T>
void add(draco::Mesh &mesh, draco::GeometryAttribute::Type kind, draco::DataType type, int components,
         const T *values)
{
    if (!values)
        return;
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, static_cast<int8_t>(components), type, false,
                   static_cast<int64_t>(sizeof(T)) * components, 0);
    int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (uint32_t i = 0; i < mesh.num_points(); i++)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              values + i * static_cast<size_t>(components));
}

} // namespace

uint8_t *draco_encode(const draco_source *source, bool sequential, size_t *size)
{
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(source->vertex_count));
    mesh.SetNumFaces(source->index_count / 3);
    for (uint32_t f = 0; f < mesh.num_faces(); f++) {
        draco::Mesh::Face face;
        for (size_t c = 0; c < 3; c++)
            face[c] = draco::PointIndex(source->indices[3 * f + c]);
        mesh.SetFace(draco::FaceIndex(f), face);
    }
    add(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, source->positions);
    add(mesh, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, source->normals);
    add(mesh, draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2, source->uvs);
    add(mesh, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 4, source->weights);
    add(mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 4, source->joints);
    add(mesh, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 100, source->hundreds);
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                         : draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(3, 3);
    const int bits[] = {14, 10, 12, 12};
    for (int i = 0; i < 4 && i < mesh.num_attributes(); i++)
        encoder.SetAttributeQuantization(i, bits[i]);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok())
        return nullptr;
    *size = buffer.size();
    uint8_t *bytes = static_cast<uint8_t *>(std::malloc(*size));
    if (bytes)
        std::memcpy(bytes, buffer.data(), *size);
    return bytes;
}
