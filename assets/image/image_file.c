#include "assets/image/image_file.h"

#include "assets/image/tiff_internal.h"
#include "config/file.h"
#include "config/memory.h"

#include <stb_image.h>
#include <stb_image_write.h>

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

/* Deflate compresses at most 1032:1 and a byte may hold 8 texels. JPEG is below that. */
#define TEXELS_PER_BYTE ((uint64_t)1032 * 8)

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
    return true;
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

bool tl_image_decode_values(const char *name, const void *data, size_t size, tl_image *out, tl_error *error)
{
    int width, height, channels;
    *out = (tl_image){0};
    if (tl_tiff_is(data, size))
        return tl_tiff_decode_values(name, data, size, out, error);
    if (!check_before_decoding(name, data, size, error))
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
