#include "assets/image/tiff_internal.h"

#include "config/base/memory.h"

#include <tiffio.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* libtiff reads through these functions, so that a file in an archive needs no copy on the disk. */
struct memory {
    const uint8_t *data;
    size_t size, at;
    char message[256]; /* libtiff's first one, "" before */
};

static tmsize_t read_memory(thandle_t handle, void *out, tmsize_t wanted)
{
    struct memory *memory = handle;
    size_t left = memory->size - memory->at, count = (size_t)wanted < left ? (size_t)wanted : left;
    memcpy(out, memory->data + memory->at, count);
    memory->at += count;
    return (tmsize_t)count;
}

static tmsize_t refuse_write(thandle_t handle, void *data, tmsize_t size)
{
    (void)handle, (void)data, (void)size;
    return -1;
}

static toff_t seek_memory(thandle_t handle, toff_t offset, int whence)
{
    struct memory *memory = handle;
    toff_t base = whence == SEEK_CUR ? memory->at : whence == SEEK_END ? memory->size : 0;
    toff_t wanted = base + offset;
    memory->at = wanted < memory->size ? (size_t)wanted : memory->size;
    return memory->at;
}

static int close_memory(thandle_t handle)
{
    (void)handle;
    return 0;
}

static toff_t size_of_memory(thandle_t handle)
{
    return ((struct memory *)handle)->size;
}

/* Keeps the library's first message for the error's line, in place of the library's own output. */
static int take_message(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments)
{
    struct memory *memory = user;
    (void)tiff, (void)module;
    if (memory->message[0] == '\0')
        vsnprintf(memory->message, sizeof memory->message, format, arguments);
    return 1;
}

static int drop_message(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments)
{
    (void)tiff, (void)user, (void)module, (void)format, (void)arguments;
    return 1;
}

static TIFF *open_memory(struct memory *memory)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, 1 << 27); /* of rows, tiles and tags */
    TIFFOpenOptionsSetErrorHandlerExtR(options, take_message, memory);
    TIFFOpenOptionsSetWarningHandlerExtR(options, drop_message, NULL);
    TIFF *tiff = TIFFClientOpenExt("image", "rm", memory, read_memory, refuse_write, seek_memory,
                                   close_memory, size_of_memory, NULL, NULL, options);
    TIFFOpenOptionsFree(options);
    return tiff;
}

bool tl_tiff_is(const void *data, size_t size)
{
    return size >= 4 && (memcmp(data, "II*", 4) == 0 || memcmp(data, "MM\0*", 4) == 0);
}

static bool fail_damaged(const char *name, const struct memory *memory, tl_error *error)
{
    return tl_fail(error, TL_INPUT,
                   "%s: the TIFF image is damaged or of a kind that is not read (%s): write it as PNG", name,
                   memory->message[0] ? memory->message : "no reason is given");
}

/* Bytes a texel: the library's form, the image that is made of it, and rows or tiles as the file has them,
 * which are limited by themselves. */
#define BYTES_PER_TEXEL 8

static bool check_size(const char *name, TIFF *tiff, size_t size, uint32_t *width, uint32_t *height,
                       tl_error *error)
{
    *width = *height = 0;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, height);
    return tl_image_size_check(name, *width, *height, error) &&
           tl_memory_request_for_file(name, size, (uint64_t)*width * *height * BYTES_PER_TEXEL, error);
}

static TIFF *open_checked(const char *name, struct memory *memory, uint32_t *width, uint32_t *height,
                          tl_error *error)
{
    TIFF *tiff = open_memory(memory);
    if (!tiff) {
        fail_damaged(name, memory, error);
        return NULL;
    }
    if (check_size(name, tiff, memory->size, width, height, error))
        return tiff;
    TIFFClose(tiff);
    return NULL;
}

/* Reads texels in the library's form, four bytes each with alpha multiplied into the colour. */
static bool read_colours(const char *name, TIFF *tiff, const struct memory *memory, tl_image *out,
                         tl_error *error)
{
    uint32_t width = (uint32_t)out->width, height = (uint32_t)out->height;
    uint32_t *raster = TL_NEW_ARRAY(uint32_t, (size_t)width * height);
    bool read = TIFFReadRGBAImageOriented(tiff, width, height, raster, ORIENTATION_TOPLEFT, 1);
    uint8_t *to = tl_image_bytes(out);
    for (size_t i = 0; read && i < (size_t)width * height; i++, to += out->channels) {
        uint32_t texel = raster[i], alpha = TIFFGetA(texel);
        const uint32_t colour[3] = {TIFFGetR(texel), TIFFGetG(texel), TIFFGetB(texel)};
        for (int c = 0; c < 3; c++) {
            uint32_t whole =
                alpha == 0 || out->channels == 3 ? colour[c] : (colour[c] * 255 + alpha / 2) / alpha;
            to[c] = (uint8_t)(whole < 255 ? whole : 255);
        }
        if (out->channels == 4)
            to[3] = (uint8_t)alpha;
    }
    free(raster);
    return read || fail_damaged(name, memory, error);
}

static bool has_alpha(TIFF *tiff)
{
    uint16_t count = 0, *kinds = NULL;
    return TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds) && count > 0;
}

bool tl_tiff_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error)
{
    struct memory memory = {.data = data, .size = size};
    uint32_t width, height;
    *out = (tl_image){0};
    TIFF *tiff = open_checked(name, &memory, &width, &height, error);
    if (!tiff)
        return false;
    *out = tl_image_create((int)width, (int)height, has_alpha(tiff) ? 4 : 3, TL_IMAGE_U8);
    bool read = read_colours(name, tiff, &memory, out, error);
    TIFFClose(tiff);
    if (!read)
        tl_image_release(out);
    return read;
}

/* The content of a row of the file. */
struct samples {
    uint16_t bits, format, per_texel, planes;
};

static struct samples samples_of(TIFF *tiff)
{
    struct samples samples = {1, SAMPLEFORMAT_UINT, 1, PLANARCONFIG_CONTIG};
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &samples.bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &samples.format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples.per_texel);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &samples.planes);
    return samples;
}

static bool has_plain_rows(TIFF *tiff, const struct samples *samples)
{
    uint16_t photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    bool whole = samples->format == SAMPLEFORMAT_UINT && samples->bits == 16;
    bool is_float = samples->format == SAMPLEFORMAT_IEEEFP && samples->bits == 32;
    return (whole || is_float) && !TIFFIsTiled(tiff) &&
           (photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_RGB);
}

static float sample_of(const uint8_t *row, size_t texel, const struct samples *samples)
{
    size_t step = samples->planes == PLANARCONFIG_CONTIG ? samples->per_texel : 1;
    float value;
    uint16_t whole;
    if (samples->bits == 32) {
        memcpy(&value, row + 4 * texel * step, sizeof value);
        return value;
    }
    memcpy(&whole, row + 2 * texel * step, sizeof whole);
    return (float)whole / 65535;
}

/* Rows of 16 bits and floats, whose precision the library's own form would lose. */
static bool read_rows(const char *name, TIFF *tiff, const struct memory *memory,
                      const struct samples *samples, tl_image *out, tl_error *error)
{
    size_t step = samples->planes == PLANARCONFIG_CONTIG ? samples->per_texel : 1;
    size_t bytes = (size_t)TIFFScanlineSize(tiff), needed = (size_t)out->width * step * samples->bits / 8;
    uint8_t *row = bytes >= needed ? TL_NEW_ARRAY(uint8_t, bytes) : NULL;
    bool read = row != NULL, finite = true;
    for (int y = 0; read && y < out->height; y++) {
        read = TIFFReadScanline(tiff, row, (uint32_t)y, 0) == 1;
        float *to = tl_image_floats(out) + (size_t)y * (size_t)out->width;
        for (int x = 0; read && x < out->width; x++) {
            to[x] = sample_of(row, (size_t)x, samples);
            finite = finite && isfinite(to[x]);
        }
    }
    free(row);
    if (!read)
        return fail_damaged(name, memory, error);
    return finite ||
           tl_fail(error, TL_INPUT,
                   "%s: holds a value that is not finite: correct it in the program that made it", name);
}

bool tl_tiff_decode_values(const char *name, const void *data, size_t size, tl_image *out, tl_error *error)
{
    struct memory memory = {.data = data, .size = size};
    uint32_t width, height;
    *out = (tl_image){0};
    TIFF *tiff = open_checked(name, &memory, &width, &height, error);
    if (!tiff)
        return false;
    *out = tl_image_create((int)width, (int)height, 1, TL_IMAGE_F32);
    const struct samples samples = samples_of(tiff);
    bool plain = has_plain_rows(tiff, &samples);
    bool read = plain && read_rows(name, tiff, &memory, &samples, out, error);
    tl_image colours = tl_image_create(plain ? 1 : out->width, plain ? 1 : out->height, 3, TL_IMAGE_U8);
    if (!plain)
        read = read_colours(name, tiff, &memory, &colours, error);
    for (size_t i = 0; !plain && read && i < (size_t)width * height; i++)
        tl_image_floats(out)[i] = (float)tl_image_bytes(&colours)[3 * i] / 255;
    tl_image_release(&colours);
    TIFFClose(tiff);
    if (!read)
        tl_image_release(out);
    return read;
}
