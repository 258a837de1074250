extern "C" {
#include "assets/base/mesh.h"
#include "assets/gltf/draco_internal.h"
#include "config/base/memory.h"
}

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <cstdlib>
#include <exception>
#include <memory>

namespace
{

/* Entropy coding has no largest number of faces a byte. Measured: 2 to 21 for curved grids of 8,000 to 8
 * million faces with 14 bits a coordinate, 690 for a plane of 8 million. The first million is free, for
 * planes. */
const uint64_t faces_per_byte = 64, faces_always = 1 << 20;
/* Sixteen attributes of four floats. */
const int64_t bytes_per_point = 256;

/* Sizes that both decoders of draco leave to the stream: how many faces and points memory is allocated for,
 * and how large a point is. */
template <class Decoder> class Checked : public Decoder
{
  public:
    explicit Checked(bool counts_points_first, size_t size) : points_first(counts_points_first), bytes(size)
    {
    }

  protected:
    bool DecodeConnectivity() override
    {
        draco::DecoderBuffer peek = *this->buffer();
        uint32_t first = 0, second = 0;
        if (this->bitstream_version() != DRACO_BITSTREAM_VERSION(2, 2) ||
            !draco::DecodeVarint(&first, &peek) || !draco::DecodeVarint(&second, &peek))
            return false;
        uint64_t faces = points_first ? second : first, points = points_first ? first : second;
        return faces <= faces_always + faces_per_byte * bytes && faces <= TL_LIMIT_MESH_INDICES / 3 &&
               points <= 3 * faces && points <= TL_LIMIT_MESH_VERTICES && Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override
    {
        int64_t stride = 0;
        for (int32_t i = 0; i < this->point_cloud()->num_attributes(); i++)
            stride += this->point_cloud()->attribute(i)->byte_stride();
        return stride <= bytes_per_point && this->point_cloud()->num_points() <= TL_LIMIT_MESH_VERTICES &&
               Decoder::DecodeAllAttributes();
    }

  private:
    bool points_first;
    size_t bytes;
};

int type_of(draco::DataType type)
{
    switch (type) {
    case draco::DT_INT8:
        return 5120;
    case draco::DT_UINT8:
        return 5121;
    case draco::DT_INT16:
        return 5122;
    case draco::DT_UINT16:
        return 5123;
    case draco::DT_UINT32:
        return 5125;
    case draco::DT_FLOAT32:
        return 5126;
    default:
        return 0;
    }
}

const char *copy_attribute(const draco::Mesh &mesh, draco_attribute &out)
{
    const draco::PointAttribute *from = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(out.id));
    if (!from)
        return "lacks an attribute";
    out.component_type = type_of(from->data_type());
    out.components = from->num_components();
    size_t size = static_cast<size_t>(from->byte_stride());
    if (out.component_type == 0 || out.components < 1 || out.components > 4 ||
        size != static_cast<size_t>(draco::DataTypeLength(from->data_type()) * out.components))
        return "has an attribute of a type that glTF does not know";
    out.values = static_cast<uint8_t *>(tl_alloc(mesh.num_points(), size));
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
        draco::AttributeValueIndex value = from->mapped_index(p);
        if (value.value() >= from->size())
            return "has a point without a value";
        from->GetValue(value, out.values + p.value() * size);
    }
    return nullptr;
}

const char *copy_mesh(const draco::Mesh &mesh, draco_attribute *attributes, size_t attribute_count,
                      draco_mesh &out)
{
    out.point_count = mesh.num_points();
    out.index_count = 3 * static_cast<size_t>(mesh.num_faces());
    out.indices = static_cast<uint32_t *>(tl_alloc(out.index_count, sizeof *out.indices));
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (size_t corner = 0; corner < 3; corner++)
            out.indices[3 * f.value() + corner] = mesh.face(f)[corner].value();
    for (size_t i = 0; i < attribute_count; i++)
        if (const char *problem = attributes[i].id < 0 ? nullptr : copy_attribute(mesh, attributes[i]))
            return problem;
    return nullptr;
}

std::unique_ptr<draco::MeshDecoder> decoder_of(const draco::DracoHeader &header, size_t size)
{
    if (header.encoder_type != draco::TRIANGULAR_MESH)
        return nullptr;
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
        return std::make_unique<Checked<draco::MeshSequentialDecoder>>(false, size);
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
        return std::make_unique<Checked<draco::MeshEdgebreakerDecoder>>(true, size);
    return nullptr;
}

const char *decode(const uint8_t *bytes, size_t size, draco_attribute *attributes, size_t attribute_count,
                   draco_mesh &out)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(bytes), size);
    draco::DecoderBuffer peek = buffer;
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&peek, &header).ok())
        return "does not begin as one";
    std::unique_ptr<draco::MeshDecoder> decoder = decoder_of(header, size);
    draco::DecoderOptions options;
    draco::Mesh mesh;
    if (!decoder)
        return "holds no triangles";
    if (!decoder->Decode(options, &buffer, &mesh).ok())
        return "cannot be decoded";
    return copy_mesh(mesh, attributes, attribute_count, out);
}

} // namespace

const char *draco_decode(const uint8_t *bytes, size_t size, draco_attribute *attributes,
                         size_t attribute_count, draco_mesh *out)
{
    const char *problem;
    *out = draco_mesh{};
    for (size_t i = 0; i < attribute_count; i++)
        attributes[i].values = nullptr;
    try {
        problem = decode(bytes, size, attributes, attribute_count, *out);
    } catch (const std::exception &) {
        problem = "cannot be decoded";
    }
    if (!problem)
        return nullptr;
    std::free(out->indices);
    for (size_t i = 0; i < attribute_count; i++)
        std::free(attributes[i].values);
    *out = draco_mesh{};
    return problem;
}
