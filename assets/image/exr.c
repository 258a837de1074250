#include "assets/image/exr.h"

#include "assets/image/exr_shim_internal.h"
#include "config/file.h"
#include "config/memory.h"

#include <openexr.h>

#include <stdlib.h>
#include <string.h>

/* A file in memory, and what the library said first when something was wrong. */
struct stream {
    const char *path;
    const uint8_t *data;
    size_t size;
    char complaint[256];
};

static void note_complaint(exr_const_context_t file, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (file && exr_get_user_data(file, &user) == EXR_ERR_SUCCESS && user) {
        struct stream *stream = user;
        if (!stream->complaint[0])
            snprintf(stream->complaint, sizeof stream->complaint, "%s", message);
    }
}

static int64_t stream_size(exr_const_context_t file, void *user)
{
    (void)file;
    return (int64_t)((struct stream *)user)->size;
}

static int64_t stream_read(exr_const_context_t file, void *user, void *buffer, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t complain)
{
    (void)file, (void)complain;
    const struct stream *stream = user;
    if (offset >= stream->size)
        return 0;
    uint64_t left = stream->size - offset;
    uint64_t count = size < left ? size : left;
    memcpy(buffer, stream->data + offset, count);
    return (int64_t)count;
}

static bool fail_damaged(const struct stream *stream, tl_error *error)
{
    const char *colon = strstr(stream->complaint, stream->path);
    const char *why = colon ? colon + strlen(stream->path) : stream->complaint;
    why += strspn(why, "': ");
    return tl_fail(error, TL_INPUT, "%s: is not a whole OpenEXR file%s%s: fetch or write it again",
                   stream->path, why[0] ? ": " : "", why);
}

enum { RED, GREEN, BLUE, ALPHA, LUMINANCE = 0, RED_CHROMA, BLUE_CHROMA };

/* Where the values of one channel go: [height][width] of them, `step` floats apart. */
struct plane {
    const char *channel; /* NULL: the file has none */
    int x_sampling, y_sampling;
    int width, height;
    float *values;
    size_t step;
    float *owned; /* values, when they are not part of the image */
};

struct part {
    struct stream *stream;
    exr_context_t file;
    int index;
    exr_storage_t storage;
    exr_compression_t compression;
    int min_x, min_y, width, height;
    bool luminance; /* planes are Y, RY, BY and not R, G, B */
    struct plane planes[4];
};

static bool find_flat_part(struct part *part, tl_error *error)
{
    int count = 0;
    exr_get_count(part->file, &count);
    for (part->index = 0; part->index < count; part->index++) {
        if (exr_get_storage(part->file, part->index, &part->storage) != EXR_ERR_SUCCESS)
            return fail_damaged(part->stream, error);
        if (part->storage == EXR_STORAGE_SCANLINE || part->storage == EXR_STORAGE_TILED)
            return true;
    }
    return tl_fail(error, TL_INPUT, "%s: holds deep data only: flatten it first", part->stream->path);
}

static bool read_window(struct part *part, tl_error *error)
{
    exr_attr_box2i_t window;
    if (exr_get_data_window(part->file, part->index, &window) != EXR_ERR_SUCCESS ||
        exr_get_compression(part->file, part->index, &part->compression) != EXR_ERR_SUCCESS)
        return fail_damaged(part->stream, error);
    int64_t width = (int64_t)window.max.x - window.min.x + 1,
            height = (int64_t)window.max.y - window.min.y + 1;
    if (!tl_image_size_check(part->stream->path, width, height, error))
        return false;
    /* The tightest codecs shrink a texel of three floats to about a hundredth of a byte. Small images are let
     * through: what they cost is bearable. */
    const uint64_t bearable_texels = 1 << 22, texels_per_byte = 128;
    uint64_t texels = (uint64_t)width * (uint64_t)height;
    if (texels > bearable_texels && texels / texels_per_byte > part->stream->size)
        return tl_fail(error, TL_INPUT,
                       "%s: claims %lld x %lld texels but has only %zu bytes: fetch or write it again",
                       part->stream->path, (long long)width, (long long)height, part->stream->size);
    part->min_x = window.min.x;
    part->min_y = window.min.y;
    part->width = (int)width;
    part->height = (int)height;
    return true;
}

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; i++)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return &list->entries[i];
    return NULL;
}

static bool set_plane(struct part *part, int slot, const exr_attr_chlist_entry_t *channel, tl_error *error)
{
    if (!channel)
        return true;
    int xs = channel->x_sampling, ys = channel->y_sampling;
    bool tiled = part->storage == EXR_STORAGE_TILED;
    if (xs < 1 || ys < 1 || part->min_x % xs || part->min_y % ys || part->width % xs || part->height % ys ||
        (tiled && (xs > 1 || ys > 1)))
        return tl_fail(
            error, TL_INPUT,
            "%s: channel %s is sampled every %d x %d texels, which does not fit its window: write it "
            "again",
            part->stream->path, channel->name.str, xs, ys);
    part->planes[slot] = (struct plane){.channel = channel->name.str,
                                        .x_sampling = xs,
                                        .y_sampling = ys,
                                        .width = part->width / xs,
                                        .height = part->height / ys};
    return true;
}

static bool choose_channels(struct part *part, tl_error *error)
{
    static const char *const colours[4] = {"R", "G", "B", "A"}, *const luminances[4] = {"Y", "RY", "BY", "A"};
    const exr_attr_chlist_t *list;
    if (exr_get_channels(part->file, part->index, &list) != EXR_ERR_SUCCESS || list->num_channels < 1)
        return fail_damaged(part->stream, error);
    bool colour = find_channel(list, "R") || find_channel(list, "G") || find_channel(list, "B");
    part->luminance = !colour && find_channel(list, "Y");
    if (!colour && !part->luminance) {
        if (list->num_channels > 1)
            return tl_fail(
                error, TL_INPUT,
                "%s: has channels %s, %s ... but neither R, G, B nor Y: rename its colour channels",
                part->stream->path, list->entries[0].name.str, list->entries[1].name.str);
        part->luminance = true;
        return set_plane(part, LUMINANCE, &list->entries[0], error);
    }
    for (int i = 0; i < 4; i++)
        if (!set_plane(part, i, find_channel(list, part->luminance ? luminances[i] : colours[i]), error))
            return false;
    return true;
}

/* Full-size colour goes straight into the image; what must be computed with goes to a plane of its own. */
static void place_planes(struct part *part, tl_image *image)
{
    for (int i = 0; i < 4; i++) {
        struct plane *plane = &part->planes[i];
        if (!plane->channel)
            continue;
        bool direct = plane->x_sampling == 1 && plane->y_sampling == 1 && (!part->luminance || i == ALPHA);
        plane->step = direct ? (size_t)image->channels : 1;
        if (!direct)
            plane->owned = TL_NEW_ARRAY(float, (size_t)plane->width *(size_t)plane->height);
        plane->values = direct ? tl_image_floats(image) + i : plane->owned;
    }
}

static float half_at(const uint8_t *bytes)
{
    uint32_t half = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
    uint32_t sign = (half & 0x8000) << 16, exponent = half >> 10 & 31, mantissa = half & 0x3ff;
    if (exponent == 0)
        return (sign ? -1.0f : 1.0f) * (float)mantissa * 0x1p-24f;
    uint32_t bits = sign | (exponent == 31 ? 255u : exponent + 127 - 15) << 23 | mantissa << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float value_at(const uint8_t *bytes, uint16_t type)
{
    if (type == EXR_PIXEL_HALF)
        return half_at(bytes);
    uint32_t bits =
        (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return type == EXR_PIXEL_UINT ? (float)bits : value;
}

static const struct plane *plane_of(const struct part *part, const char *channel)
{
    for (int i = 0; i < 4; i++)
        if (part->planes[i].channel && strcmp(part->planes[i].channel, channel) == 0)
            return &part->planes[i];
    return NULL;
}

/* Copies one row of one channel to its plane, at column `x` and row `y` of the window. */
static bool store_row(const struct plane *plane, const exr_coding_channel_info_t *channel, const uint8_t *row,
                      int x, int y)
{
    int left = x / plane->x_sampling, top = y / plane->y_sampling;
    if (channel->width > plane->width - left || top >= plane->height)
        return false;
    float *values = plane->values + ((size_t)top * (size_t)plane->width + (size_t)left) * plane->step;
    for (int i = 0; i < channel->width; i++)
        values[(size_t)i * plane->step] =
            value_at(row + (size_t)i * (size_t)channel->bytes_per_element, channel->data_type);
    return true;
}

/* A decoded chunk holds, row by row, those samples of each channel that the row has. The library's own
 * unpacking is not used: in 3.1.5 it mixes up interleaved channels and overruns subsampled ones. */
static bool unpack_chunk(const struct part *part, const exr_decode_pipeline_t *decoder, int x, int y)
{
    const uint8_t *at = decoder->unpacked_buffer ? decoder->unpacked_buffer : decoder->packed_buffer;
    uint64_t left = decoder->unpacked_buffer ? decoder->chunk.unpacked_size : decoder->chunk.packed_size;
    if (!at || decoder->chunk.height > part->height - y)
        return false;
    for (int line = y; line < y + decoder->chunk.height; line++)
        for (int c = 0; c < decoder->channel_count; c++) {
            const exr_coding_channel_info_t *channel = &decoder->channels[c];
            if (channel->y_samples < 1 || (part->min_y + line) % channel->y_samples != 0)
                continue;
            uint64_t size = (uint64_t)channel->width * (uint64_t)channel->bytes_per_element;
            const struct plane *plane = plane_of(part, channel->channel_name);
            if (channel->width < 0 || size > left || (plane && !store_row(plane, channel, at, x, line)))
                return false;
            at += size;
            left -= size;
        }
    return true;
}

/* Reads one chunk whose corner within the window is (x, y). */
static bool decode_chunk(struct part *part, const exr_chunk_info_t *chunk, int x, int y)
{
    if (chunk->packed_size > part->stream->size)
        return false;
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    bool decoded = exr_decoding_initialize(part->file, part->index, chunk, &decoder) == EXR_ERR_SUCCESS &&
                   exr_decoding_choose_default_routines(part->file, part->index, &decoder) == EXR_ERR_SUCCESS;
    decoder.unpack_and_convert_fn = NULL;
    decoded = decoded && exr_decoding_run(part->file, part->index, &decoder) == EXR_ERR_SUCCESS &&
              unpack_chunk(part, &decoder, x, y);
    exr_decoding_destroy(part->file, &decoder);
    return decoded;
}

static bool read_scan_lines(struct part *part)
{
    int32_t lines = 0;
    if (exr_get_scanlines_per_chunk(part->file, part->index, &lines) != EXR_ERR_SUCCESS || lines < 1)
        return false;
    for (int y = 0; y < part->height; y += lines) {
        exr_chunk_info_t chunk;
        if (exr_read_scanline_chunk_info(part->file, part->index, part->min_y + y, &chunk) !=
                EXR_ERR_SUCCESS ||
            chunk.start_y != part->min_y + y || !decode_chunk(part, &chunk, 0, y))
            return false;
    }
    return true;
}

static bool read_tiles(struct part *part)
{
    int32_t tile_width = 0, tile_height = 0;
    if (exr_get_tile_sizes(part->file, part->index, 0, 0, &tile_width, &tile_height) != EXR_ERR_SUCCESS ||
        tile_width < 1 || tile_height < 1)
        return false;
    for (int y = 0; y < part->height; y += tile_height)
        for (int x = 0; x < part->width; x += tile_width) {
            exr_chunk_info_t chunk;
            if (exr_read_tile_chunk_info(part->file, part->index, x / tile_width, y / tile_height, 0, 0,
                                         &chunk) != EXR_ERR_SUCCESS ||
                !decode_chunk(part, &chunk, x, y))
                return false;
        }
    return true;
}

static bool read_with_shim(struct part *part)
{
    struct tl_exr_plane planes[4];
    size_t count = 0;
    for (int i = 0; i < 4; i++) {
        const struct plane *plane = &part->planes[i];
        if (plane->channel)
            planes[count++] = (struct tl_exr_plane){.channel = plane->channel,
                                                    .x_sampling = plane->x_sampling,
                                                    .y_sampling = plane->y_sampling,
                                                    .values = plane->values,
                                                    .step = plane->step,
                                                    .width = (size_t)plane->width};
    }
    return tl_exr_shim_read(part->stream->data, part->stream->size, part->index, planes, count,
                            part->stream->complaint, sizeof part->stream->complaint);
}

/* The value at a texel of the image, linear between the samples, which lie on every x_sampling-th column and
 * y_sampling-th row. */
static float plane_at(const struct plane *plane, int x, int y)
{
    int left = x / plane->x_sampling, top = y / plane->y_sampling;
    int right = left + 1 < plane->width ? left + 1 : left, bottom = top + 1 < plane->height ? top + 1 : top;
    float u = (float)(x % plane->x_sampling) / (float)plane->x_sampling;
    float v = (float)(y % plane->y_sampling) / (float)plane->y_sampling;
    const float *upper = plane->values + (size_t)top * (size_t)plane->width * plane->step;
    const float *lower = plane->values + (size_t)bottom * (size_t)plane->width * plane->step;
    /* A sample of weight 0 is not touched, so that its NaN or infinity stays where it is. */
    float above = upper[(size_t)left * plane->step], below = lower[(size_t)left * plane->step];
    if (u > 0) {
        above += u * (upper[(size_t)right * plane->step] - above);
        below += u * (lower[(size_t)right * plane->step] - below);
    }
    return v > 0 ? above + v * (below - above) : above;
}

/* RY = (R - Y) / Y and BY = (B - Y) / Y, with Y the luminance of Rec. 709 (OpenEXR's "Technical
 * Introduction", luminance/chroma images). */
static void colour_from_luminance(const struct part *part, int x, int y, float *texel)
{
    const float red_weight = 0.2126f, green_weight = 0.7152f, blue_weight = 0.0722f;
    float luminance = plane_at(&part->planes[LUMINANCE], x, y);
    if (!part->planes[RED_CHROMA].channel || !part->planes[BLUE_CHROMA].channel) {
        texel[RED] = texel[GREEN] = texel[BLUE] = luminance;
        return;
    }
    texel[RED] = (plane_at(&part->planes[RED_CHROMA], x, y) + 1) * luminance;
    texel[BLUE] = (plane_at(&part->planes[BLUE_CHROMA], x, y) + 1) * luminance;
    texel[GREEN] = (luminance - red_weight * texel[RED] - blue_weight * texel[BLUE]) / green_weight;
}

/* Fills from the planes what was not decoded straight into the image. */
static void combine_planes(const struct part *part, tl_image *image)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            float *texel = tl_image_floats(image) +
                           ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
            if (part->luminance)
                colour_from_luminance(part, x, y, texel);
            for (int i = part->luminance ? ALPHA : RED; i < image->channels; i++)
                if (part->planes[i].owned)
                    texel[i] = plane_at(&part->planes[i], x, y);
        }
}

/* OpenEXRCore 3.1 has no DWA decoder, and its B44 decoder is wrong where a side is not a multiple of four. */
static bool needs_shim(exr_compression_t compression)
{
    return compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB ||
           compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
}

static bool read_pixels(struct part *part)
{
    if (needs_shim(part->compression))
        return read_with_shim(part);
    return part->storage == EXR_STORAGE_TILED ? read_tiles(part) : read_scan_lines(part);
}

static enum tl_exr_envmap read_envmap(const struct part *part)
{
    exr_envmap_t kind;
    if (exr_attr_get_envmap(part->file, part->index, "envmap", &kind) != EXR_ERR_SUCCESS)
        return TL_EXR_NOT_ENVMAP;
    return kind == EXR_ENVMAP_CUBE ? TL_EXR_CUBE : TL_EXR_LATLONG;
}

static bool load_part(struct part *part, tl_image *out, tl_error *error)
{
    if (!find_flat_part(part, error) || !read_window(part, error) || !choose_channels(part, error))
        return false;
    tl_image image =
        tl_image_create(part->width, part->height, part->planes[ALPHA].channel ? 4 : 3, TL_IMAGE_F32);
    place_planes(part, &image);
    bool read = read_pixels(part);
    if (read)
        combine_planes(part, &image);
    for (int i = 0; i < 4; i++)
        free(part->planes[i].owned);
    if (!read) {
        tl_image_release(&image);
        return fail_damaged(part->stream, error);
    }
    *out = image;
    return true;
}

bool tl_exr_load(const char *path, tl_image *out, enum tl_exr_envmap *envmap, tl_error *error)
{
    *out = (tl_image){0};
    *envmap = TL_EXR_NOT_ENVMAP;
    char *data;
    size_t size;
    if (!tl_file_read(path, &data, &size, error))
        return false;
    struct stream stream = {.path = path, .data = (const uint8_t *)data, .size = size};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = note_complaint;
    setup.user_data = &stream;
    setup.read_fn = stream_read;
    setup.size_fn = stream_size;
    setup.max_image_width = setup.max_image_height = TL_LIMIT_IMAGE_SIDE;
    setup.max_tile_width = setup.max_tile_height = TL_LIMIT_IMAGE_SIDE;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    struct part part = {.stream = &stream};
    bool loaded = exr_start_read(&part.file, path, &setup) == EXR_ERR_SUCCESS;
    if (!loaded)
        fail_damaged(&stream, error);
    else {
        loaded = load_part(&part, out, error);
        if (loaded)
            *envmap = read_envmap(&part);
    }
    exr_finish(&part.file);
    free(data);
    return loaded;
}
