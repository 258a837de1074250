/* TIFF images: what libtiff writes is read back, in every kind that U3M's specification names; damaged files
 * are refused. */
#include "assets/image/image_file.h"
#include "assets/image/tiff_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>
#include <tiffio.h>

#define WIDTH     7
#define HEIGHT    5
#define FILE_NAME "test_tiff.scratch.tif"

struct kind {
    uint16_t bits, per_texel, compression, format, planes;
    bool tiled;
};

/* A ramp that differs in every channel and texel, in [0, 1]. */
static double ramp(int x, int y, int c)
{
    return (x + 3 * y + 11 * c) / 60.0;
}

static void put(uint8_t *to, const struct kind *kind, double value)
{
    uint16_t whole = (uint16_t)lrint(65535 * value);
    float real = (float)value;
    if (kind->bits == 8)
        *to = (uint8_t)lrint(255 * value);
    else if (kind->bits == 16)
        memcpy(to, &whole, 2);
    else
        memcpy(to, &real, 4);
}

static void write_tiff(const struct kind *kind)
{
    TIFF *tiff = TIFFOpen(FILE_NAME, "w");
    assert_non_null(tiff);
    uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, WIDTH);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, HEIGHT);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind->bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind->per_texel);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind->compression);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, kind->format);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, kind->planes);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind->per_texel < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    if (kind->per_texel == 4)
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &alpha);
    if (kind->tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
    }
    size_t size = kind->bits / 8u, side = kind->tiled ? 16 : WIDTH;
    int planes = kind->planes == PLANARCONFIG_SEPARATE ? kind->per_texel : 1, per = kind->per_texel / planes;
    uint8_t *rows = TL_NEW_ARRAY(uint8_t, side * 16 * (size_t)per * size);
    for (int p = 0; p < planes; p++) {
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                for (int c = 0; c < per; c++)
                    put(rows + ((size_t)y * side + (size_t)x) * (size_t)per * size + (size_t)c * size, kind,
                        ramp(x, y, p + c));
        if (kind->tiled)
            TIFFWriteTile(tiff, rows, 0, 0, 0, (uint16_t)p);
        for (int y = 0; !kind->tiled && y < HEIGHT; y++)
            TIFFWriteScanline(tiff, rows + (size_t)y * side * (size_t)per * size, (uint32_t)y, (uint16_t)p);
    }
    free(rows);
    TIFFClose(tiff);
}

static const struct kind kinds[] = {
    {8, 3, COMPRESSION_NONE, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
    {8, 1, COMPRESSION_LZW, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
    {8, 4, COMPRESSION_PACKBITS, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
    {16, 3, COMPRESSION_LZW, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
    {16, 4, COMPRESSION_NONE, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
    {16, 1, COMPRESSION_ADOBE_DEFLATE, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
    {16, 3, COMPRESSION_NONE, SAMPLEFORMAT_UINT, PLANARCONFIG_SEPARATE, false},
    {8, 3, COMPRESSION_LZW, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, true},
};

static void every_kind_is_read_back(void **state)
{
    (void)state;
    for (size_t k = 0; k < TL_COUNT(kinds); k++) {
        tl_image image;
        tl_error error;
        write_tiff(&kinds[k]);
        assert_ok(tl_image_load(FILE_NAME, &image, &error), error);
        assert_true(image.width == WIDTH && image.height == HEIGHT);
        assert_int_equal(image.channels, kinds[k].per_texel == 4 ? 4 : 3);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                for (int c = 0; c < image.channels; c++) {
                    int from = kinds[k].per_texel == 1 ? 0 : c;
                    double alpha = image.channels == 4 ? fmax(ramp(x, y, 3), 1.0 / 255) : 1;
                    /* 8 bits, divided by the alpha with which the library had multiplied them */
                    assert_near(tl_image_bytes(&image)[(y * WIDTH + x) * image.channels + c],
                                255 * ramp(x, y, from), c == 3 ? 1 : 1.01 / alpha);
                }
        tl_image_release(&image);
    }
}

/* 16 bits and floats, which 8 bits would lose. */
static void values_keep_their_precision(void **state)
{
    (void)state;
    const struct kind exact[] = {{16, 1, COMPRESSION_LZW, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
                                 {16, 3, COMPRESSION_NONE, SAMPLEFORMAT_UINT, PLANARCONFIG_CONTIG, false},
                                 {16, 3, COMPRESSION_NONE, SAMPLEFORMAT_UINT, PLANARCONFIG_SEPARATE, false},
                                 {32, 1, COMPRESSION_NONE, SAMPLEFORMAT_IEEEFP, PLANARCONFIG_CONTIG, false}};
    for (size_t k = 0; k < TL_COUNT(exact); k++) {
        tl_image image;
        tl_error error;
        write_tiff(&exact[k]);
        assert_ok(tl_image_load_values(FILE_NAME, &image, &error), error);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                assert_near(tl_image_floats(&image)[y * WIDTH + x], ramp(x, y, 0), 0.51 / 65535);
        tl_image_release(&image);
    }
}

/* A file cut anywhere, or with a byte changed, is read or refused; nothing else happens. A header that claims
 * more texels than the bytes can hold is refused. */
static void damaged_files_are_refused(void **state)
{
    (void)state;
    char *data;
    size_t size, refused = 0;
    tl_error error;
    tl_image image;
    write_tiff(&kinds[1]);
    assert_ok(tl_file_read(FILE_NAME, &data, &size, &error), error);
    for (size_t cut = 4; cut < size; cut++)
        if (tl_image_decode("cut", data, cut, &image, &error))
            tl_image_release(&image);
        else
            refused += error.code == TL_INPUT;
    assert_true(refused > size / 2);
    for (size_t at = 4; at < size; at++)
        for (int bit = 0; bit < 8; bit += 3) {
            data[at] = (char)(data[at] ^ (1 << bit));
            if (tl_image_decode("changed", data, size, &image, &error))
                tl_image_release(&image);
            else
                assert_int_equal(error.code, TL_INPUT);
            data[at] = (char)(data[at] ^ (1 << bit));
        }
    free(data);
    TIFF *tiff = TIFFOpen(FILE_NAME, "r+");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 30000);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 8000);
    TIFFRewriteDirectory(tiff);
    TIFFClose(tiff);
    assert_false(tl_image_load(FILE_NAME, &image, &error));
    assert_non_null(strstr(error.message, "needs 1.8 GiB"));
    remove(FILE_NAME);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_read_back),
        cmocka_unit_test(values_keep_their_precision),
        cmocka_unit_test(damaged_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
