#include "assets/image/exr_shim_internal.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace
{

class MemoryStream : public Imf::IStream
{
  public:
    MemoryStream(const char *data, size_t size) : Imf::IStream("memory"), data_(data), size_(size) {}

    bool read(char out[], int count) override
    {
        size_t wanted = static_cast<size_t>(count);
        if (count < 0 || at_ > size_ || wanted > size_ - at_)
            throw std::runtime_error("the file ends early");
        std::memcpy(out, data_ + at_, wanted);
        at_ += wanted;
        return at_ < size_;
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override { at_ = position; }

  private:
    const char *data_;
    size_t size_;
    uint64_t at_ = 0;
};

Imf::Slice slice_of(const tl_exr_plane &plane, const Imath::Box2i &window)
{
    return Imf::Slice::Make(Imf::FLOAT, plane.values, window, plane.step * sizeof(float),
                            plane.width * plane.step * sizeof(float), plane.x_sampling, plane.y_sampling);
}

} // namespace

bool tl_exr_shim_read(const void *data, size_t size, int part, const struct tl_exr_plane *planes,
                      size_t plane_count, char *complaint, size_t complaint_size)
{
    try {
        MemoryStream stream(static_cast<const char *>(data), size);
        Imf::MultiPartInputFile file(stream, 0, false);
        Imf::InputPart input(file, part);
        const Imath::Box2i window = input.header().dataWindow();
        Imf::FrameBuffer frame;
        for (size_t i = 0; i < plane_count; i++)
            frame.insert(planes[i].channel, slice_of(planes[i], window));
        input.setFrameBuffer(frame);
        input.readPixels(window.min.y, window.max.y);
        return true;
    } catch (const std::exception &failure) {
        std::snprintf(complaint, complaint_size, "%s", failure.what());
    } catch (...) {
        std::snprintf(complaint, complaint_size, "its data are damaged");
    }
    return false;
}
