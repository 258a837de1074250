#include "assets/image/image_file.h"

#include "assets/image/tiff_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <stb_image.h>
#include <stb_image_write.h>
#include <zlib.h>

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* stb_image fills in what a truncated or damaged file lacks, without an error, so files are checked for
 * completeness here. */

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* CRC-32 of PNG (ISO 3309), as in the PNG specification, annex D. */
static uint32_t crc_of(const uint8_t *bytes, size_t size)
{
    uint32_t table[256];
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t c = i;
        for (int bit = 0; bit < 8; bit++)
            c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
        table[i] = c;
    }
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++)
        crc = table[(crc ^ bytes[i]) & 0xff] ^ (crc >> 8);
    return ~crc;
}

static const uint8_t png_signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

/* Whether every chunk up to IEND is there with the right checksum. */
static bool png_is_whole(const uint8_t *bytes, size_t size)
{
    for (size_t at = sizeof png_signature; at + 12 <= size;) {
        size_t length = big_endian(bytes + at);
        if (length > size - at - 12)
            return false;
        const uint8_t *type = bytes + at + 4;
        if (crc_of(type, length + 4) != big_endian(type + 4 + length))
            return false;
        if (memcmp(type, "IEND", 4) == 0)
            return true;
        at += 12 + length;
    }
    return false;
}

/* Whether the image data after the headers reach an end marker. (A header may hold a thumbnail with its own.)
 */
static bool jpeg_is_whole(const uint8_t *bytes, size_t size)
{
    size_t at = 2;
    while (at + 4 <= size && bytes[at] == 0xff && bytes[at + 1] != 0xda) {
        bool padding = bytes[at + 1] == 0xff;
        at += padding ? 1 : 2 + ((size_t)bytes[at + 2] << 8 | bytes[at + 3]);
    }
    static const uint8_t end[2] = {0xff, 0xd9};
    return at < size && memmem(bytes + at, size - at, end, sizeof end);
}

/* The bytes of an image before they are compressed [PNG specification, 7.2]: a row has one byte besides its
 * texels. Of an interlaced image each of the seven passes has rows of its own, which end at whole bytes. */
static uint64_t png_raw_bytes(const uint8_t *bytes)
{
    static const uint64_t samples_of[8] = {1, 0, 3, 1, 2, 0, 4, 0}; /* by colour type */
    uint64_t width = big_endian(bytes + 16), height = big_endian(bytes + 20), passes = 7;
    bool interlaced = bytes[28] != 0;
    uint64_t row = (width * bytes[24] * samples_of[bytes[25] & 7] + 7) / 8 + 1;
    return row * height + (interlaced ? 2 * passes * height : 0);
}

/* Whether the image data are sound and inflate to no more than an image of their size has: the decoder would
 * inflate them whole, whatever they become. */
static bool png_inflates_well(const uint8_t *bytes, size_t size)
{
    const uint64_t expected = png_raw_bytes(bytes);
    uint8_t window[1 << 16];
    uint64_t inflated = 0;
    z_stream stream = {0};
    bool good = inflateInit(&stream) == Z_OK;
    int state = Z_OK;
    for (size_t at = sizeof png_signature; good && state == Z_OK && at + 12 <= size;) {
        size_t length = big_endian(bytes + at);
        if (memcmp(bytes + at + 4, "IDAT", 4) == 0) {
            stream.next_in = (uint8_t *)(uintptr_t)(bytes + at + 8); /* zlib does not write there */
            stream.avail_in = (uInt)length;
            do {
                stream.next_out = window;
                stream.avail_out = sizeof window;
                state = inflate(&stream, Z_NO_FLUSH);
                inflated += sizeof window - stream.avail_out;
            } while (state == Z_OK && stream.avail_out == 0 && inflated <= expected);
            good = inflated <= expected;
            state = state == Z_BUF_ERROR ? Z_OK : state; /* needs the next chunk */
        }
        at += 12 + length;
    }
    inflateEnd(&stream);
    return good && (state == Z_OK || state == Z_STREAM_END);
}

/* Bytes that stb_image has at one time while it decodes. PNG: what the data inflate to, and the image; of 16
 * bits an image of each depth. JPEG: a plane for each component and the image; of a progressive one also the
 * coefficients of 16 bits. Components may be sampled as finely as 4 x 4 blocks to a unit, hence whole units
 * of 32 texels. */
static uint64_t png_bytes(const uint8_t *bytes, uint64_t width, uint64_t height, int channels)
{
    uint64_t depth_bytes = bytes[24] == 16 ? 2 : 1;
    return 2 * depth_bytes * width * height * (uint64_t)channels;
}

static uint64_t jpeg_bytes(bool progressive, uint64_t width, uint64_t height, int channels)
{
    const uint64_t unit = 32;
    uint64_t texels = ((width + unit - 1) / unit * unit) * ((height + unit - 1) / unit * unit);
    return texels * (uint64_t)channels * (progressive ? 4 : 2);
}

/* Scans of a progressive JPEG: each goes over the whole image, however few bytes it has. Encoders write about
 * ten. */
#define SCANS_MAX 100

struct jpeg_facts {
    bool progressive;
    int scans;
};

/* Markers do not occur within coded data: there a 0xff is followed by 0 [ITU T.81, B.1.1.2]. */
static struct jpeg_facts jpeg_facts_of(const uint8_t *bytes, size_t size)
{
    struct jpeg_facts facts = {0};
    for (const uint8_t *at = bytes; (at = memchr(at, 0xff, size - (size_t)(at - bytes))) != NULL; at++) {
        if (at + 1 == bytes + size)
            break;
        facts.progressive |= at[1] == 0xc2;
        facts.scans += at[1] == 0xda;
    }
    return facts;
}

/* Deflate compresses at most 1032:1 and a byte may hold 8 texels. JPEG is below that. */
#define TEXELS_PER_BYTE ((uint64_t)1032 * 8)

static bool check_cost(const char *name, const uint8_t *bytes, size_t size, bool png, uint64_t width,
                       uint64_t height, int channels, tl_error *error)
{
    struct jpeg_facts jpeg = png ? (struct jpeg_facts){0} : jpeg_facts_of(bytes, size);
    uint64_t needed = png ? png_bytes(bytes, width, height, channels)
                          : jpeg_bytes(jpeg.progressive, width, height, channels);
    if (!tl_memory_request_for_file(name, size, needed, error))
        return false;
    if (jpeg.scans > SCANS_MAX)
        return tl_fail(error, TL_INPUT, "%s: the JPEG has %d scans, at most %d are read: write it again",
                       name, jpeg.scans, SCANS_MAX);
    return !png || png_inflates_well(bytes, size) ||
           tl_fail(error, TL_INPUT,
                   "%s: its data are damaged, or more than those of %llu x %llu texels: write it again", name,
                   (unsigned long long)width, (unsigned long long)height);
}

static bool check_before_decoding(const char *name, const uint8_t *bytes, size_t size, tl_error *error)
{
    bool png = size >= sizeof png_signature && memcmp(bytes, png_signature, sizeof png_signature) == 0;
    bool jpeg = size >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
    if (!png && !jpeg)
        return tl_fail(error, TL_INPUT, "%s: is neither PNG, JPEG nor TIFF: convert it to PNG", name);
    if (size > INT_MAX)
        return tl_fail(error, TL_INPUT, "%s: the image file is larger than 2 GiB: make it smaller", name);
    int width, height, channels;
    if (!stbi_info_from_memory(bytes, (int)size, &width, &height, &channels))
        return tl_fail(error, TL_INPUT, "%s: the image's header is damaged (%s): fetch or write it again",
                       name, stbi_failure_reason());
    if (!tl_image_size_check(name, width, height, error))
        return false;
    if ((uint64_t)width * (uint64_t)height > (uint64_t)size * TEXELS_PER_BYTE)
        return tl_fail(error, TL_INPUT,
                       "%s: claims %d x %d texels but has only %zu bytes: fetch or write it again", name,
                       width, height, size);
    if (png ? !png_is_whole(bytes, size) : !jpeg_is_whole(bytes, size))
        return tl_fail(error, TL_INPUT, "%s: the image is cut short or damaged: fetch or write it again",
                       name);
    return check_cost(name, bytes, size, png, (uint64_t)width, (uint64_t)height, channels, error);
}

bool tl_image_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error)
{
    *out = (tl_image){0};
    if (tl_tiff_is(data, size))
        return tl_tiff_decode(name, data, size, out, error);
    if (!check_before_decoding(name, data, size, error))
        return false;
    int width, height, channels;
    uint8_t *texels = stbi_load_from_memory(data, (int)size, &width, &height, &channels, 0);
    if (!texels)
        return tl_fail(error, TL_INPUT, "%s: the image cannot be decoded (%s): fetch or write it again", name,
                       stbi_failure_reason());
    *out = (tl_image){
        .width = width, .height = height, .channels = channels, .type = TL_IMAGE_U8, .texels = texels};
    return true;
}

bool tl_image_load(const char *path, tl_image *out, tl_error *error)
{
    *out = (tl_image){0};
    char *data;
    size_t size;
    if (!tl_file_read(path, &data, &size, error))
        return false;
    bool decoded = tl_image_decode(path, data, size, out, error);
    free(data);
    return decoded;
}

/* The image of 16 bits, made of one of 8 bits, and the one channel as floats. */
static uint64_t values_bytes(const uint8_t *bytes, size_t size)
{
    int width, height, channels;
    if (!stbi_info_from_memory(bytes, (int)size, &width, &height, &channels))
        return 0;
    return (uint64_t)width * (uint64_t)height * (uint64_t)(3 * channels + 4);
}

bool tl_image_decode_values(const char *name, const void *data, size_t size, tl_image *out, tl_error *error)
{
    int width, height, channels;
    *out = (tl_image){0};
    if (tl_tiff_is(data, size))
        return tl_tiff_decode_values(name, data, size, out, error);
    if (!check_before_decoding(name, data, size, error) ||
        !tl_memory_request_for_file(name, size, values_bytes(data, size), error))
        return false;
    uint16_t *texels = stbi_load_16_from_memory(data, (int)size, &width, &height, &channels, 0);
    if (!texels)
        return tl_fail(error, TL_INPUT, "%s: the image cannot be decoded (%s): fetch or write it again", name,
                       stbi_failure_reason());
    *out = tl_image_create(width, height, 1, TL_IMAGE_F32);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        tl_image_floats(out)[i] = (float)texels[i * (size_t)channels] / 65535;
    stbi_image_free(texels);
    return true;
}

bool tl_image_load_values(const char *path, tl_image *out, tl_error *error)
{
    *out = (tl_image){0};
    char *data;
    size_t size;
    if (!tl_file_read(path, &data, &size, error))
        return false;
    bool decoded = tl_image_decode_values(path, data, size, out, error);
    free(data);
    return decoded;
}

static void write_bytes(void *stream, void *data, int size)
{
    fwrite(data, 1, (size_t)size, stream);
}

bool tl_image_encode_png(const char *name, const tl_image *image, void **data, size_t *size, tl_error *error)
{
    if (image->type != TL_IMAGE_U8 || !image->texels)
        return tl_fail(error, TL_OUTPUT, "%s: only 8-bit images become PNG: use .exr", name);
    char *bytes = NULL;
    FILE *stream = open_memstream(&bytes, size);
    bool encoded =
        stream && stbi_write_png_to_func(write_bytes, stream, image->width, image->height, image->channels,
                                         image->texels, image->width * image->channels);
    if (stream)
        encoded = fclose(stream) == 0 && encoded;
    if (!encoded) {
        free(bytes);
        return tl_fail(error, TL_OUTPUT, "%s: the image is too large for PNG: make it smaller", name);
    }
    *data = bytes;
    return true;
}

bool tl_image_save_png(const char *path, const tl_image *image, tl_error *error)
{
    struct tl_writer writer;
    void *data = NULL;
    size_t size = 0;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    if (!tl_image_encode_png(path, image, &data, &size, error)) {
        tl_writer_abandon(&writer);
        return false;
    }
    fwrite(data, 1, size, writer.stream); /* the stream remembers a failure until the commit */
    free(data);
    return tl_writer_commit(&writer, error);
}
