#include "assets/image/radiance.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct rgbe_reader {
    const uint8_t *at, *end;
};

struct rgbe_header {
    int width, height;
    bool bottom_up, right_to_left;
    double exposure;
};

bool tl_radiance_begins(const void *data, size_t size)
{
    return size >= 2 && memcmp(data, "#?", 2) == 0;
}

/* Copies the next line without its end. False at the end of the file, or when it is too long for a header. */
static bool next_line(struct rgbe_reader *reader, char *line, size_t size)
{
    const uint8_t *newline = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
    if (!newline || (size_t)(newline - reader->at) >= size)
        return false;
    size_t length = (size_t)(newline - reader->at);
    memcpy(line, reader->at, length);
    line[length] = '\0';
    reader->at = newline + 1;
    return true;
}

static bool read_resolution(const char *name, const char *line, struct rgbe_header *header, tl_error *error)
{
    char vertical, horizontal;
    if (sscanf(line, "%cY %d %cX %d", &vertical, &header->height, &horizontal, &header->width) != 4 ||
        !strchr("+-", vertical) || !strchr("+-", horizontal))
        return tl_fail(error, TL_INPUT,
                       "%s: its size is given as \"%.40s\", not as \"-Y height +X width\": save it "
                       "again without rotation",
                       name, line);
    header->bottom_up = vertical == '+';
    header->right_to_left = horizontal == '-';
    return tl_image_size_check(name, header->width, header->height, error);
}

static bool read_header(const char *name, struct rgbe_reader *reader, struct rgbe_header *header,
                        tl_error *error)
{
    char line[2048];
    *header = (struct rgbe_header){.exposure = 1};
    while (next_line(reader, line, sizeof line) && line[0] != '\0') {
        double exposure;
        if (strncmp(line, "FORMAT=", 7) == 0 && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
            return tl_fail(error, TL_INPUT, "%s: its FORMAT is %.40s: only 32-bit_rle_rgbe is read", name,
                           line + 7);
        if (sscanf(line, "EXPOSURE=%lf", &exposure) == 1 && exposure > 0 && isfinite(exposure))
            header->exposure *= exposure;
    }
    if (!next_line(reader, line, sizeof line))
        return tl_fail(error, TL_INPUT,
                       "%s: the header of this Radiance picture is cut short: fetch it again", name);
    return read_resolution(name, line, header, error);
}

/* One of the four components of a row: runs (count - 128 times one byte) and literal stretches. */
static bool read_component(struct rgbe_reader *reader, uint8_t *row, int width)
{
    for (int x = 0; x < width;) {
        if (reader->end - reader->at < 2)
            return false;
        int count = *reader->at++;
        bool run = count > 128;
        count -= run ? 128 : 0;
        if (count == 0 || count > width - x || (!run && reader->end - reader->at < count))
            return false;
        for (int i = 0; i < count; i++, x++)
            row[4 * (size_t)x] = run ? *reader->at : reader->at[i];
        reader->at += run ? 1 : count;
    }
    return true;
}

/* Texel by texel; a texel (1, 1, 1, n) repeats the one before it, with 8 more bits of n for each that
 * follows.
 */
static bool read_flat_row(struct rgbe_reader *reader, uint8_t *row, int width)
{
    int shift = 0;
    for (int x = 0; x < width;) {
        if (reader->end - reader->at < 4)
            return false;
        const uint8_t *texel = reader->at;
        reader->at += 4;
        if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
            int64_t count = shift < 24 ? (int64_t)texel[3] << shift : INT64_MAX;
            if (x == 0 || count > width - x)
                return false;
            for (int64_t i = 0; i < count; i++, x++)
                memcpy(row + 4 * (size_t)x, row + 4 * ((size_t)x - 1), 4);
            shift += 8;
        } else {
            memcpy(row + 4 * (size_t)x++, texel, 4);
            shift = 0;
        }
    }
    return true;
}

static bool read_row(struct rgbe_reader *reader, uint8_t *row, int width)
{
    const uint8_t *at = reader->at;
    bool encoded = width >= 8 && width < 32768 && reader->end - at >= 4 && at[0] == 2 && at[1] == 2 &&
                   (at[2] << 8 | at[3]) == width;
    if (!encoded)
        return read_flat_row(reader, row, width);
    reader->at += 4;
    for (int component = 0; component < 4; component++)
        if (!read_component(reader, row + component, width))
            return false;
    return true;
}

static void decode_row(const struct rgbe_header *header, const uint8_t *row, float *out)
{
    for (int x = 0; x < header->width; x++) {
        const uint8_t *rgbe = row + 4 * (size_t)(header->right_to_left ? header->width - 1 - x : x);
        double scale = rgbe[3] ? ldexp(1, rgbe[3] - (128 + 8)) / header->exposure : 0;
        for (int c = 0; c < 3; c++)
            out[3 * x + c] = (float)(rgbe[c] * scale);
    }
}

bool tl_radiance_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error)
{
    *out = (tl_image){0};
    struct rgbe_reader reader = {data, (const uint8_t *)data + size};
    struct rgbe_header header;
    if (!read_header(name, &reader, &header, error))
        return false;
    if (!tl_memory_request_for_file(
            name, size, (uint64_t)header.width * (uint64_t)header.height * 3 * sizeof(float), error))
        return false;
    tl_image image = tl_image_create(header.width, header.height, 3, TL_IMAGE_F32);
    uint8_t *row = TL_NEW_ARRAY(uint8_t, 4 * (size_t)header.width);
    int read = 0;
    for (; read < header.height && read_row(&reader, row, header.width); read++) {
        int y = header.bottom_up ? header.height - 1 - read : read;
        decode_row(&header, row, tl_image_floats(&image) + 3 * (size_t)y * (size_t)header.width);
    }
    free(row);
    if (read < header.height) {
        tl_image_release(&image);
        return tl_fail(error, TL_INPUT, "%s: is damaged or cut short in row %d of %d: fetch it again", name,
                       read, header.height);
    }
    *out = image;
    return true;
}
