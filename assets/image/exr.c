#include "assets/image/exr.h"

#include "assets/image/exr_shim_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* A file in memory. */
struct exr_source {
    const char *path;
    const uint8_t *data;
    size_t size;
};

static bool fail_damaged(const struct exr_source *source, const char *why, tl_error *error)
{
    const char *path = strstr(why, source->path); /* the library names the file too: once is enough */
    if (path)
        why = path + strlen(source->path);
    why += strspn(why, "\"':,. ");
    int length = (int)strlen(why);
    length -= length > 0 && why[length - 1] == '.';
    return tl_fail(error, TL_INPUT, "%s: is not a whole OpenEXR file%s%.*s: fetch or write it again",
                   source->path, length ? ": " : "", length, why);
}

/* ---- The attributes' sizes, before the library reads them ---- */

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* Returns the byte after the NUL that ends the text at `at`; NULL if there is no NUL before `end`. */
static const uint8_t *skip_text(const uint8_t *at, const uint8_t *end)
{
    const uint8_t *nul = memchr(at, 0, (size_t)(end - at));
    return nul ? nul + 1 : NULL;
}

/* Whether a list of channels, a name and 16 bytes each, ends with its empty name at the end of the value. */
static bool is_channel_list(const uint8_t *at, const uint8_t *end)
{
    const ptrdiff_t channel_bytes = 16;
    for (const uint8_t *next; (next = skip_text(at, end)); at = next + channel_bytes) {
        if (next == at + 1)
            return next == end;
        if (end - next < channel_bytes)
            return false;
    }
    return false;
}

/* Whether a list of texts, each after its length, fills the value. */
static bool is_text_list(const uint8_t *at, const uint8_t *end)
{
    while (end - at >= 4) {
        uint64_t length = word_at(at), left = (uint64_t)(end - at) - 4;
        if (length > left)
            return false;
        at += 4 + length;
    }
    return at == end;
}

/* Whether a value has the size that its type prescribes. The library goes by the type and not by the size,
 * and would take the rest of a longer value for the next attribute. Types that it does not know go by the
 * size. */
static bool has_size_of_type(const char *type, const uint8_t *value, uint64_t size)
{
    static const struct {
        const char *type;
        uint64_t size;
    } known[] = {{"box2f", 16},
                 {"box2i", 16},
                 {"chromaticities", 32},
                 {"compression", 1},
                 {"deepImageState", 1},
                 {"double", 8},
                 {"envmap", 1},
                 {"float", 4},
                 {"int", 4},
                 {"keycode", 28},
                 {"lineOrder", 1},
                 {"m33d", 72},
                 {"m33f", 36},
                 {"m44d", 128},
                 {"m44f", 64},
                 {"rational", 8},
                 {"tiledesc", 9},
                 {"timecode", 8},
                 {"v2d", 16},
                 {"v2f", 8},
                 {"v2i", 8},
                 {"v3d", 24},
                 {"v3f", 12},
                 {"v3i", 12}};
    for (size_t i = 0; i < TL_COUNT(known); i++)
        if (strcmp(type, known[i].type) == 0)
            return size == known[i].size;
    if (strcmp(type, "chlist") == 0)
        return is_channel_list(value, value + size);
    if (strcmp(type, "stringvector") == 0)
        return is_text_list(value, value + size);
    if (strcmp(type, "preview") == 0) /* its width, its height and 4 bytes a texel */
        return size >= 8 && (size - 8) % 4 == 0 &&
               (uint64_t)word_at(value) * word_at(value + 4) == (size - 8) / 4;
    return true;
}

/* A header is a list of attributes: a name and a type, which end in NUL, the size of the value, the value. An
 * empty name ends a header, an empty header those of a multi-part file ["OpenEXR File Layout"]. The library
 * allocates what a size claims before it reads the value, so that a file of 475 bytes may ask for 2 GB: here
 * every value is checked to lie within the file, and to be of its type's size. */
static bool check_attributes(const struct exr_source *source, tl_error *error)
{
    const uint32_t magic = 20000630, multi_part_flag = 0x1000;
    const uint8_t *at = source->data + 8, *end = source->data + source->size;
    if (source->size < 8 || word_at(source->data) != magic)
        return true; /* the library finds that it is no OpenEXR file */
    bool is_multi_part = word_at(source->data + 4) & multi_part_flag;
    for (bool header_begins = true;;) {
        const uint8_t *type = skip_text(at, end);
        bool header_ends = type == at + 1;
        if (header_ends && (!is_multi_part || header_begins))
            return true;
        header_begins = header_ends;
        if (header_ends) {
            at = type;
            continue;
        }
        const uint8_t *size = type ? skip_text(type, end) : NULL;
        if (!size || end - size < 4)
            return fail_damaged(source, "the file ends early", error);
        const uint8_t *value = size + 4;
        uint64_t claimed = word_at(size), left = (uint64_t)(end - value);
        if (claimed > left)
            return fail_damaged(source, "an attribute claims more bytes than the file has", error);
        if (!has_size_of_type((const char *)type, value, claimed))
            return fail_damaged(source, "an attribute has not the size of its type", error);
        at = value + claimed;
    }
}

/* ---- The part and its channels ---- */

enum { RED, GREEN, BLUE, ALPHA, LUMINANCE = 0, RED_CHROMA, BLUE_CHROMA };

/* The destination of one channel's values: [height][width], `step` floats apart. */
struct plane {
    const char *channel; /* NULL: the file has none */
    int x_sampling, y_sampling;
    int width, height;
    float *values;
    size_t step;
    float *owned; /* values, when they are not part of the image */
};

struct exr_reader {
    const struct exr_source *source;
    tl_exr_file *file;
    struct tl_exr_part part;
    int width, height;
    const char *wanted; /* the one channel to read; NULL: the colours */
    bool luminance;     /* planes are Y, RY, BY and not R, G, B */
    struct plane planes[4];
};

static bool check_window(struct exr_reader *reader, tl_error *error)
{
    const struct exr_source *source = reader->source;
    const struct tl_exr_part *part = &reader->part;
    int64_t width = (int64_t)part->max_x - part->min_x + 1, height = (int64_t)part->max_y - part->min_y + 1;
    if (!tl_image_size_check(source->path, width, height, error))
        return false;
    reader->width = (int)width;
    reader->height = (int)height;
    return true;
}

/* The image, planes of as many floats where the channels are not colours of full size, and the chunks that
 * the library decodes at a time: all channels of up to 256 rows, or of a tile, in three buffers (packed,
 * unpacked, and as the codec has them). */
static bool check_cost(const struct exr_reader *reader, tl_error *error)
{
    const uint64_t rows = 256, buffers = 3, channels = 4;
    const struct tl_exr_part *part = &reader->part;
    uint64_t width = (uint64_t)reader->width, height = (uint64_t)reader->height;
    uint64_t chunk = part->is_tiled ? (uint64_t)part->tile_width * (uint64_t)part->tile_height
                                    : width * (height < rows ? height : rows);
    return tl_memory_request_for_file(reader->source->path, reader->source->size,
                                      width * height * channels * sizeof(float) *
                                              (reader->luminance ? 2 : 1) +
                                          buffers * chunk * part->texel_bytes, /* below 2^30 x 2^32 */
                                      error);
}

static const struct tl_exr_channel *find_channel(const struct tl_exr_part *part, const char *name)
{
    for (size_t i = 0; i < part->channel_count; i++)
        if (strcmp(part->channels[i].name, name) == 0)
            return &part->channels[i];
    return NULL;
}

static bool set_plane(struct exr_reader *reader, int slot, const struct tl_exr_channel *channel,
                      tl_error *error)
{
    if (!channel)
        return true;
    const struct tl_exr_part *part = &reader->part;
    int xs = channel->x_sampling, ys = channel->y_sampling;
    if (xs < 1 || ys < 1 || part->min_x % xs || part->min_y % ys || reader->width % xs ||
        reader->height % ys || (part->is_tiled && (xs > 1 || ys > 1)))
        return tl_fail(
            error, TL_INPUT,
            "%s: channel %s is sampled every %d x %d texels, which does not fit its window: write it "
            "again",
            reader->source->path, channel->name, xs, ys);
    reader->planes[slot] = (struct plane){.channel = channel->name,
                                          .x_sampling = xs,
                                          .y_sampling = ys,
                                          .width = reader->width / xs,
                                          .height = reader->height / ys};
    return true;
}

/* Sets the planes to the colours of the first layer that has red, green and blue, as in "beauty.R"; *found:
 * there is one. */
static bool choose_layer(struct exr_reader *reader, bool *found, tl_error *error)
{
    static const char *const colours[4] = {"R", "G", "B", "A"};
    const struct tl_exr_part *part = &reader->part;
    *found = false;
    for (size_t c = 0; c < part->channel_count && !*found; c++) {
        const char *name = part->channels[c].name, *dot = strrchr(name, '.');
        if (!dot || strcmp(dot + 1, "R") != 0)
            continue;
        const struct tl_exr_channel *channels[4];
        for (int i = 0; i < 4; i++) {
            char *whole = tl_format("%.*s%s", (int)(dot + 1 - name), name, colours[i]);
            channels[i] = find_channel(part, whole);
            free(whole);
        }
        *found = channels[GREEN] && channels[BLUE];
        for (int i = 0; *found && i < 4; i++)
            if (!set_plane(reader, i, channels[i], error))
                return false;
    }
    return true;
}

static bool choose_channels(struct exr_reader *reader, tl_error *error)
{
    static const char *const colours[4] = {"R", "G", "B", "A"}, *const luminances[4] = {"Y", "RY", "BY", "A"};
    const struct tl_exr_part *part = &reader->part;
    if (part->channel_count < 1)
        return fail_damaged(reader->source, "it has no channels", error);
    if (reader->wanted)
        return set_plane(reader, 0, find_channel(part, reader->wanted), error);
    bool colour = find_channel(part, "R") || find_channel(part, "G") || find_channel(part, "B");
    reader->luminance = !colour && find_channel(part, "Y");
    if (!colour && !reader->luminance) {
        bool found;
        if (!choose_layer(reader, &found, error))
            return false;
        if (found)
            return true;
        if (part->channel_count > 1)
            return tl_fail(
                error, TL_INPUT,
                "%s: has channels %s, %s ... but neither R, G, B nor Y: rename its colour channels",
                reader->source->path, part->channels[0].name, part->channels[1].name);
        reader->luminance = true;
        return set_plane(reader, LUMINANCE, &part->channels[0], error);
    }
    for (int i = 0; i < 4; i++)
        if (!set_plane(reader, i, find_channel(part, reader->luminance ? luminances[i] : colours[i]), error))
            return false;
    return true;
}

/* ---- The pixels ---- */

/* Full-size colour goes straight into the image; what must be computed with goes to a plane of its own. */
static void place_planes(struct exr_reader *reader, tl_image *image)
{
    for (int i = 0; i < 4; i++) {
        struct plane *plane = &reader->planes[i];
        if (!plane->channel)
            continue;
        bool direct = plane->x_sampling == 1 && plane->y_sampling == 1 && (!reader->luminance || i == ALPHA);
        plane->step = direct ? (size_t)image->channels : 1;
        if (!direct)
            plane->owned = TL_NEW_ARRAY(float, (size_t)plane->width *(size_t)plane->height);
        plane->values = direct ? tl_image_floats(image) + i : plane->owned;
    }
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
static void colour_from_luminance(const struct exr_reader *reader, int x, int y, float *texel)
{
    const float red_weight = 0.2126f, green_weight = 0.7152f, blue_weight = 0.0722f;
    float luminance = plane_at(&reader->planes[LUMINANCE], x, y);
    if (!reader->planes[RED_CHROMA].channel || !reader->planes[BLUE_CHROMA].channel) {
        texel[RED] = texel[GREEN] = texel[BLUE] = luminance;
        return;
    }
    texel[RED] = (plane_at(&reader->planes[RED_CHROMA], x, y) + 1) * luminance;
    texel[BLUE] = (plane_at(&reader->planes[BLUE_CHROMA], x, y) + 1) * luminance;
    texel[GREEN] = (luminance - red_weight * texel[RED] - blue_weight * texel[BLUE]) / green_weight;
}

/* Fills from the planes what was not decoded straight into the image. */
static void combine_planes(const struct exr_reader *reader, tl_image *image)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            float *texel = tl_image_floats(image) +
                           ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
            if (reader->luminance)
                colour_from_luminance(reader, x, y, texel);
            for (int i = reader->luminance ? ALPHA : RED; i < image->channels; i++)
                if (reader->planes[i].owned)
                    texel[i] = plane_at(&reader->planes[i], x, y);
        }
}

static bool read_pixels(struct exr_reader *reader, tl_error *error)
{
    struct tl_exr_plane planes[4];
    size_t count = 0;
    char complaint[TL_EXR_COMPLAINT];
    for (int i = 0; i < 4; i++) {
        const struct plane *plane = &reader->planes[i];
        if (plane->channel)
            planes[count++] = (struct tl_exr_plane){.channel = plane->channel,
                                                    .x_sampling = plane->x_sampling,
                                                    .y_sampling = plane->y_sampling,
                                                    .values = plane->values,
                                                    .step = plane->step,
                                                    .width = (size_t)plane->width};
    }
    return tl_exr_shim_read(reader->file, planes, count, complaint) ||
           fail_damaged(reader->source, complaint, error);
}

static bool load_part(struct exr_reader *reader, tl_image *out, tl_error *error)
{
    if (reader->part.index < 0)
        return tl_fail(error, TL_INPUT, "%s: holds deep data only: flatten it first", reader->source->path);
    if (!check_window(reader, error) || !choose_channels(reader, error) || !check_cost(reader, error))
        return false;
    if (reader->wanted && !reader->planes[0].channel)
        return true;
    int channels = reader->wanted ? 1 : reader->planes[ALPHA].channel ? 4 : 3;
    tl_image image = tl_image_create(reader->width, reader->height, channels, TL_IMAGE_F32);
    place_planes(reader, &image);
    bool read = read_pixels(reader, error);
    if (read)
        combine_planes(reader, &image);
    for (int i = 0; i < 4; i++)
        free(reader->planes[i].owned);
    if (read)
        *out = image;
    else
        tl_image_release(&image);
    return read;
}

static bool load_source(const struct exr_source *source, const char *wanted, tl_image *out,
                        enum tl_exr_envmap *envmap, tl_error *error)
{
    struct exr_reader reader = {.source = source, .wanted = wanted};
    char complaint[TL_EXR_COMPLAINT];
    if (!check_attributes(source, error))
        return false;
    reader.file = tl_exr_shim_open(source->path, source->data, source->size, &reader.part, complaint);
    if (!reader.file)
        return fail_damaged(source, complaint, error);
    bool loaded = load_part(&reader, out, error);
    if (loaded)
        *envmap = reader.part.envmap;
    tl_exr_shim_close(reader.file);
    return loaded;
}

static bool load(const char *path, const char *wanted, tl_image *out, enum tl_exr_envmap *envmap,
                 tl_error *error)
{
    *out = (tl_image){0};
    *envmap = TL_EXR_NOT_ENVMAP;
    char *data;
    size_t size;
    if (!tl_file_read(path, &data, &size, error))
        return false;
    const struct exr_source source = {.path = path, .data = (const uint8_t *)data, .size = size};
    bool loaded = load_source(&source, wanted, out, envmap, error);
    free(data);
    return loaded;
}

bool tl_exr_load(const char *path, tl_image *out, enum tl_exr_envmap *envmap, tl_error *error)
{
    return load(path, NULL, out, envmap, error);
}

bool tl_exr_load_channel(const char *path, const char *channel, tl_image *out, tl_error *error)
{
    enum tl_exr_envmap envmap;
    return load(path, channel, out, &envmap, error);
}

/* ---- Writing ---- */

bool tl_exr_save(const char *path, const struct tl_exr_layer *layers, size_t layer_count, tl_error *error)
{
    return tl_exr_save_commented(path, layers, layer_count, NULL, error);
}

bool tl_exr_save_commented(const char *path, const struct tl_exr_layer *layers, size_t layer_count,
                           const char *comments, tl_error *error)
{
    struct tl_writer writer;
    char complaint[TL_EXR_COMPLAINT];
    if (!tl_writer_begin(&writer, path, error))
        return false;
    if (tl_exr_shim_write(writer.stream, layers, layer_count, comments, complaint))
        return tl_writer_commit(&writer, error);
    tl_writer_abandon(&writer);
    return tl_fail(error, TL_OUTPUT,
                   "%s: could not be written whole: %s: free some space or choose another place", path,
                   complaint);
}
