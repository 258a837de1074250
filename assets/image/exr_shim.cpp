extern "C" {
#include "assets/image/exr_shim_internal.h"
}

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

class MemoryStream : public Imf::IStream
{
  public:
    MemoryStream(const char *path, const char *data, size_t size)
        : Imf::IStream(path), data_(data), size_(size)
    {
    }

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

/* The position is counted here: a device such as /dev/null has none. */
class FileStream : public Imf::OStream
{
  public:
    explicit FileStream(FILE *stream) : Imf::OStream("the file"), stream_(stream) {}

    void write(const char bytes[], int count) override
    {
        if (std::fwrite(bytes, 1, static_cast<size_t>(count), stream_) != static_cast<size_t>(count))
            throw std::runtime_error(std::strerror(errno));
        at_ += static_cast<uint64_t>(count);
    }
    uint64_t tellp() override { return at_; }
    void seekp(uint64_t position) override
    {
        if (fseeko(stream_, static_cast<off_t>(position), SEEK_SET) != 0)
            throw std::runtime_error(std::strerror(errno));
        at_ = position;
    }

  private:
    FILE *stream_;
    uint64_t at_ = 0;
};

/* Runs what may throw. The library's messages are one line; a name within them need not be. */
bool guarded(char *complaint, const std::function<void()> &run)
{
    const char *what = "its data are damaged";
    std::string text;
    try {
        run();
        return true;
    } catch (const std::bad_alloc &) {
        what = "it asks for more memory than there is";
    } catch (const std::exception &failure) {
        text = failure.what();
        what = text.c_str();
    } catch (...) {
    }
    std::snprintf(complaint, TL_EXR_COMPLAINT, "%s", what);
    for (char *c = complaint; *c; c++)
        if (static_cast<unsigned char>(*c) < ' ')
            *c = ' ';
    return false;
}

/* For the whole process, once: headers that claim more are refused before anything is allocated. */
void set_limits()
{
    static const bool set = [] {
        Imf::Header::setMaxImageSize(TL_LIMIT_IMAGE_SIDE, TL_LIMIT_IMAGE_SIDE);
        Imf::Header::setMaxTileSize(TL_LIMIT_IMAGE_SIDE, TL_LIMIT_IMAGE_SIDE);
        return true;
    }();
    (void)set;
}

Imf::Slice slice_of(const tl_exr_plane &plane, const Imath::Box2i &window)
{
    return Imf::Slice::Make(Imf::FLOAT, plane.values, window, plane.step * sizeof(float),
                            plane.width * plane.step * sizeof(float), plane.x_sampling, plane.y_sampling);
}

bool is_flat(const Imf::Header &header)
{
    return header.hasType() && (header.type() == Imf::SCANLINEIMAGE || header.type() == Imf::TILEDIMAGE);
}

/* Whether a part has red, green and blue, also as those of a layer, or luminance. */
bool has_colours(const Imf::Header &header)
{
    const Imf::ChannelList &channels = header.channels();
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        const std::string name = c.name();
        const size_t dot = name.rfind('.'), end = dot == std::string::npos ? 0 : dot + 1;
        const std::string layer = name.substr(0, end), own = name.substr(end);
        if ((own == "R" && channels.findChannel(layer + "G") && channels.findChannel(layer + "B")) ||
            name == "Y")
            return true;
    }
    return false;
}

enum tl_exr_envmap envmap_of(const Imf::Header &header)
{
    if (Imf::hasEnvmap(header))
        return Imf::envmap(header) == Imf::ENVMAP_CUBE ? TL_EXR_CUBE : TL_EXR_LATLONG;
    const std::string comments = Imf::hasComments(header) ? Imf::comments(header) : "";
    const auto begins = [&comments](const char *layout) {
        return comments.rfind(std::string(TL_EXR_ENVMAP_COMMENT) + layout, 0) == 0;
    };
    return begins("sphere")            ? TL_EXR_SPHERE
           : begins("dual paraboloid") ? TL_EXR_PARABOLOID
           : begins("octahedral")      ? TL_EXR_OCTAHEDRAL
                                       : TL_EXR_NOT_ENVMAP;
}

} // namespace

struct tl_exr_file {
    MemoryStream stream;
    std::unique_ptr<Imf::MultiPartInputFile> file;
    std::vector<tl_exr_channel> channels;
    int part = -1;
};

namespace
{

void describe(tl_exr_file &file, struct tl_exr_part *out)
{
    const Imf::Header &header = file.file->header(file.part);
    const Imath::Box2i &window = header.dataWindow();
    out->index = file.part;
    out->is_tiled = header.type() == Imf::TILEDIMAGE;
    out->min_x = window.min.x;
    out->min_y = window.min.y;
    out->max_x = window.max.x;
    out->max_y = window.max.y;
    out->envmap = envmap_of(header);
    if (out->is_tiled) {
        out->tile_width = static_cast<int>(header.tileDescription().xSize);
        out->tile_height = static_cast<int>(header.tileDescription().ySize);
    }
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        file.channels.push_back({c.name(), c.channel().xSampling, c.channel().ySampling});
        out->texel_bytes += c.channel().type == Imf::HALF ? 2 : 4;
    }
    out->channel_count = file.channels.size();
    out->channels = file.channels.data();
}

} // namespace

tl_exr_file *tl_exr_shim_open(const char *path, const void *data, size_t size, struct tl_exr_part *part,
                              char *complaint)
{
    std::unique_ptr<tl_exr_file> file;
    *part = {};
    part->index = -1;
    bool opened = guarded(complaint, [&] {
        const int no_threads = 0;
        const bool reconstruct = false; /* a file without its table of chunks is incomplete */
        set_limits();
        file.reset(new tl_exr_file{{path, static_cast<const char *>(data), size}, nullptr, {}});
        file->file.reset(new Imf::MultiPartInputFile(file->stream, no_threads, reconstruct));
        for (int i = 0; i < file->file->parts() && file->part < 0; i++)
            if (is_flat(file->file->header(i)) && has_colours(file->file->header(i)))
                file->part = i;
        for (int i = 0; i < file->file->parts() && file->part < 0; i++)
            if (is_flat(file->file->header(i)))
                file->part = i;
        if (file->part >= 0)
            describe(*file, part);
    });
    return opened ? file.release() : nullptr;
}

void tl_exr_shim_close(tl_exr_file *file)
{
    delete file;
}

bool tl_exr_shim_read(tl_exr_file *file, const struct tl_exr_plane *planes, size_t plane_count,
                      char *complaint)
{
    return guarded(complaint, [&] {
        Imf::InputPart input(*file->file, file->part);
        const Imath::Box2i window = input.header().dataWindow();
        Imf::FrameBuffer frame;
        for (size_t i = 0; i < plane_count; i++)
            frame.insert(planes[i].channel, slice_of(planes[i], window));
        input.setFrameBuffer(frame);
        input.readPixels(window.min.y, window.max.y);
    });
}

bool tl_exr_shim_write(FILE *stream, const struct tl_exr_layer *layers, size_t layer_count,
                       const char *comments, char *complaint)
{
    return guarded(complaint, [&] {
        const int width = layers[0].image->width, height = layers[0].image->height;
        Imf::Header header(width, height); /* ZIP, rows from the top */
        Imf::FrameBuffer frame;
        for (size_t l = 0; l < layer_count; l++) {
            const tl_image *image = layers[l].image;
            const size_t channels = static_cast<size_t>(image->channels), texel = channels * sizeof(float);
            for (size_t c = 0; c < channels; c++) {
                header.channels().insert(layers[l].channel_names[c], Imf::Channel(Imf::FLOAT));
                frame.insert(layers[l].channel_names[c],
                             Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(tl_image_floats(image) + c),
                                        texel, texel * static_cast<size_t>(width)));
            }
        }
        if (comments)
            Imf::addComments(header, comments);
        FileStream out(stream);
        const int no_threads = 0;
        Imf::OutputFile file(out, header, no_threads);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    });
}
