#include "assets/fabric/fabric_maps.h"

#include "assets/base/material.h"
#include "assets/fabric/fabric_internal.h"
#include "assets/image/image_file.h"
#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TL_LIMIT_PICTURE_BYTES ((size_t)512 << 20)

/* ---- Decoding ---- */

/* The texels as the file has them, bytes that are not yet linear; heights as floats, in full precision. */
static bool decode(const tl_fabric_file *file, const char *name, bool is_height, tl_image *out,
                   tl_error *error)
{
    char *data;
    size_t size;
    if (!tl_store_read(&file->store, name, TL_LIMIT_PICTURE_BYTES, &data, &size, error))
        return false;
    char *place = tl_store_place(&file->store, name);
    bool decoded = is_height ? tl_image_decode_values(place, data, size, out, error)
                             : tl_image_decode(place, data, size, out, error);
    free(place);
    free(data);
    return decoded;
}

/* ---- Texels as numbers ---- */

/* Writes what a texel means into `to`; the picture's own layout stays behind it. */
typedef void read_texel(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                        float *to);

static const uint8_t *bytes_at(const tl_image *image, size_t texel)
{
    return tl_image_bytes(image) + texel * (size_t)image->channels;
}

/* Byte of a channel; of a grey picture its only one. */
static uint8_t byte_of(const tl_image *image, size_t texel, int channel)
{
    return bytes_at(image, texel)[image->channels < 3 ? 0 : channel];
}

static size_t texel_count(const tl_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

bool tl_fabric_maps_are_white(const tl_fabric_file *file, const char *name, int channel)
{
    tl_image image;
    tl_error error;
    if (!decode(file, name, false, &image, &error))
        return false;
    bool is_white = true;
    for (size_t i = 0; is_white && i < texel_count(&image); i++)
        is_white = byte_of(&image, i, channel) == 255;
    tl_image_release(&image);
    return is_white;
}

static float blend(float texel, float factor, int mode)
{
    switch (mode) {
    case TL_PICTURE_ADD:
        return texel + factor;
    case TL_PICTURE_SUBTRACT:
        return texel - factor;
    case TL_PICTURE_DIVIDE:
        return factor == 0 ? 1 : texel / factor;
    case TL_PICTURE_MAX:
        return fmaxf(texel, factor);
    case TL_PICTURE_MIN:
        return fminf(texel, factor);
    case TL_PICTURE_OVERLAY:
        return texel < 0.5f ? 2 * texel * factor : 1 - 2 * (1 - texel) * (1 - factor);
    default:
        return texel * factor;
    }
}

/* Linear red, green and blue. */
static void read_colour(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                        float *to)
{
    for (int c = 0; c < 3; c++) {
        float linear = tl_srgb_to_linear((float)byte_of(image, texel, c) / 255);
        to[c] = fminf(fmaxf(blend(linear, picture->factor[c], picture->mode), 0), 1);
    }
}

static void read_alpha(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                       float *to)
{
    (void)picture;
    int alpha = image->channels == 4 ? 3 : image->channels == 2 ? 1 : -1;
    *to = alpha < 0 ? 1 : (float)bytes_at(image, texel)[alpha] / 255;
}

static void read_number(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                        float *to)
{
    float sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (float)byte_of(image, texel, picture->channel < 0 ? c : picture->channel);
    float value = sum / (3 * 255);
    value = picture->offset + picture->factor[0] * (picture->is_inverted ? 1 - value : value);
    *to = fminf(fmaxf(value, 0), 1);
}

static void read_glossiness(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                            float *to)
{
    read_number(picture, image, texel, to);
    *to = tl_glossiness_from_roughness(*to);
}

static void read_normal(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                        float *to)
{
    for (int c = 0; c < 3; c++)
        to[c] = (float)byte_of(image, texel, c) / 127.5f - 1;
    to[0] *= picture->factor[0];
    to[1] *= picture->is_y_down ? -picture->factor[0] : picture->factor[0];
    float length = sqrtf(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    for (int c = 0; c < 3; c++)
        to[c] = length > 0 ? to[c] / length : (float)(c == 2);
}

static void read_height(const struct tl_fabric_picture *picture, const tl_image *image, size_t texel,
                        float *to)
{
    *to = picture->offset + picture->factor[0] * tl_image_floats(image)[texel];
}

static const struct {
    read_texel *read;
    int channels;
} kinds[TL_PICTURE_USES] = {
    [TL_PICTURE_COLOUR] = {read_colour, 3},        [TL_PICTURE_NORMAL] = {read_normal, 3},
    [TL_PICTURE_ROUGHNESS] = {read_glossiness, 1}, [TL_PICTURE_METALNESS] = {read_number, 1},
    [TL_PICTURE_SPECULAR] = {read_number, 1},      [TL_PICTURE_OPACITY] = {read_number, 1},
    [TL_PICTURE_OCCLUSION] = {read_number, 1},     [TL_PICTURE_HEIGHT] = {read_height, 1}};

/* ---- Sizes ---- */

/* The part of a row or column of `from` texels that texel `i` of `to` covers. */
struct coverage {
    int first, last;
    float first_weight, last_weight; /* of the texels at the ends */
};

static struct coverage span_of(int i, int to, int from)
{
    double step = (double)from / to, begin = i * step, end = begin + step;
    struct coverage span = {.first = (int)begin, .last = (int)ceil(end) - 1};
    if (span.last >= from)
        span.last = from - 1;
    span.first_weight = (float)(fmin(end, span.first + 1) - begin);
    span.last_weight = span.last > span.first ? (float)(end - span.last) : span.first_weight;
    return span;
}

static float weight_in(const struct coverage *span, int i)
{
    return i == span->first ? span->first_weight : i == span->last ? span->last_weight : 1;
}

/* Averages what the texels mean over the texels of another size. */
static tl_image resized(const struct tl_fabric_picture *picture, const tl_image *image, read_texel *read,
                        int channels, int width, int height)
{
    tl_image out = tl_image_create(width, height, channels, TL_IMAGE_F32);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++) {
        const struct coverage rows = span_of(y, height, image->height);
        for (int x = 0; x < width; x++) {
            const struct coverage columns = span_of(x, width, image->width);
            float sum[3] = {0}, total = 0, texel[3] = {0};
            for (int v = rows.first; v <= rows.last; v++)
                for (int u = columns.first; u <= columns.last; u++) {
                    float weight = weight_in(&rows, v) * weight_in(&columns, u);
                    read(picture, image, (size_t)v * (size_t)image->width + (size_t)u, texel);
                    total += weight;
                    for (int c = 0; c < channels; c++)
                        sum[c] += weight * texel[c];
                }
            float *to = tl_image_floats(&out) + ((size_t)y * (size_t)width + (size_t)x) * (size_t)channels;
            for (int c = 0; c < channels; c++)
                to[c] = sum[c] / total;
        }
    }
    return out;
}

/* ---- All pictures ---- */

struct loading {
    const tl_fabric_file *file;
    tl_image raw[TL_PICTURE_USES];   /* as decoded */
    tl_image plane[TL_PICTURE_USES]; /* what it means, at the common size */
    tl_image alpha;                  /* of the colour picture */
    int width, height;
};

static bool decode_all(struct loading *loading, tl_error *error)
{
    for (int use = 0; use < TL_PICTURE_USES; use++) {
        const char *name = loading->file->pictures[use].file;
        if (!name)
            continue;
        if (!decode(loading->file, name, use == TL_PICTURE_HEIGHT, &loading->raw[use], error))
            return false;
        loading->width = loading->raw[use].width > loading->width ? loading->raw[use].width : loading->width;
        loading->height =
            loading->raw[use].height > loading->height ? loading->raw[use].height : loading->height;
    }
    return true;
}

static void limit_size(struct loading *loading)
{
    loading->width = loading->width < TL_LIMIT_FABRIC_SIDE ? loading->width : TL_LIMIT_FABRIC_SIDE;
    loading->height = loading->height < TL_LIMIT_FABRIC_SIDE ? loading->height : TL_LIMIT_FABRIC_SIDE;
}

static void read_planes(struct loading *loading)
{
    const tl_image *colour = &loading->raw[TL_PICTURE_COLOUR];
    if (colour->texels && colour->channels % 2 == 0)
        loading->alpha = resized(&loading->file->pictures[TL_PICTURE_COLOUR], colour, read_alpha, 1,
                                 loading->width, loading->height);
    for (int use = 0; use < TL_PICTURE_USES; use++) {
        tl_image *raw = &loading->raw[use];
        if (raw->texels)
            loading->plane[use] = resized(&loading->file->pictures[use], raw, kinds[use].read,
                                          kinds[use].channels, loading->width, loading->height);
        tl_image_release(raw);
    }
}

static void release_loading(struct loading *loading)
{
    for (int use = 0; use < TL_PICTURE_USES; use++) {
        tl_image_release(&loading->raw[use]);
        tl_image_release(&loading->plane[use]);
    }
    tl_image_release(&loading->alpha);
}

/* ---- Maps ---- */

static float value_or(const tl_image *plane, size_t texel, float otherwise)
{
    return plane->texels ? tl_image_floats(plane)[texel] : otherwise;
}

/* Diffuse albedo: what is no metal, where it is not hidden. */
static tl_image colour_of(const struct loading *loading)
{
    tl_image out = tl_image_create(loading->width, loading->height, 3, TL_IMAGE_F32);
    const tl_image *colour = &loading->plane[TL_PICTURE_COLOUR];
    for (size_t i = 0; i < texel_count(&out); i++) {
        float share = (1 - value_or(&loading->plane[TL_PICTURE_METALNESS], i, 0)) *
                      value_or(&loading->plane[TL_PICTURE_OCCLUSION], i, 1);
        for (size_t c = 0; c < 3; c++)
            tl_image_floats(&out)[3 * i + c] =
                share * (colour->texels ? tl_image_floats(colour)[3 * i + c] : 1);
    }
    return out;
}

static uint8_t byte_from(float value)
{
    return (uint8_t)lrintf(255 * fminf(fmaxf(value, 0), 1));
}

static tl_image specular_of(const struct loading *loading)
{
    const struct tl_fabric_surface *surface = &loading->file->surface;
    const tl_image *colour = &loading->plane[TL_PICTURE_COLOUR],
                   *metal = &loading->plane[TL_PICTURE_METALNESS],
                   *specular = &loading->plane[TL_PICTURE_SPECULAR];
    if (!metal->texels && !specular->texels)
        return (tl_image){0};
    tl_image out = tl_image_create(loading->width, loading->height, 3, TL_IMAGE_U8);
    for (size_t i = 0; i < texel_count(&out); i++) {
        float share = value_or(metal, i, surface->metalness);
        float plain = surface->specular * value_or(specular, i, 1);
        for (size_t c = 0; c < 3; c++) {
            float own = surface->colour[c] * (colour->texels ? tl_image_floats(colour)[3 * i + c] : 1);
            tl_image_bytes(&out)[3 * i + c] =
                byte_from(tl_srgb_from_linear((1 - share) * plain + share * own));
        }
    }
    return out;
}

static tl_image opacity_of(const struct loading *loading)
{
    const tl_image *own = &loading->plane[TL_PICTURE_OPACITY], *alpha = own->texels ? own : &loading->alpha;
    float minimum = 1;
    for (size_t i = 0; alpha->texels && i < texel_count(alpha); i++)
        minimum = fminf(minimum, tl_image_floats(alpha)[i]);
    if (minimum > 254.5f / 255) /* covers all */
        return (tl_image){0};
    tl_image out = tl_image_create(loading->width, loading->height, 4, TL_IMAGE_U8);
    memset(out.texels, 255, 4 * texel_count(&out));
    for (size_t i = 0; i < texel_count(&out); i++)
        tl_image_bytes(&out)[4 * i + 3] = byte_from(tl_image_floats(alpha)[i]);
    return out;
}

static float mean_of(const tl_image *plane, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < texel_count(plane); i++)
        sum += (double)tl_image_floats(plane)[i * (size_t)plane->channels + (size_t)channel];
    return (float)(sum / (double)texel_count(plane));
}

static void range_of(const tl_image *plane, float *low, float *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < texel_count(plane); i++) {
        *low = fminf(*low, tl_image_floats(plane)[i]);
        *high = fmaxf(*high, tl_image_floats(plane)[i]);
    }
}

static tl_image gloss_of(const struct loading *loading)
{
    tl_image out = tl_image_create(loading->width, loading->height, 1, TL_IMAGE_F32);
    const tl_image *own = &loading->plane[TL_PICTURE_ROUGHNESS];
    float mean = own->texels ? mean_of(own, 0) : 0;
    for (size_t i = 0; own->texels && i < texel_count(&out); i++)
        tl_image_floats(&out)[i] = tl_image_floats(own)[i] - mean;
    return out;
}

/* Slopes of a repeat add up to none. A picture whose normals lean in the mean has lost its middle grey, so
 * that its cloth would face elsewhere: the mean slope is taken out of it. Returns the angle in degrees, or 0
 * for what a picture that is not quite periodic may have. */
static float level(tl_image *normals)
{
    const float steepest = 0.05f, max_deg = 15;
    double sums[2] = {0};
    size_t count = texel_count(normals);
    for (size_t i = 0; i < count; i++) {
        const float *n = tl_image_floats(normals) + 3 * i;
        for (int k = 0; k < 2; k++)
            sums[k] += (double)(n[k] / fmaxf(n[2], steepest));
    }
    const float mean[2] = {(float)(sums[0] / (double)count), (float)(sums[1] / (double)count)};
    float lean_deg = atanf(hypotf(mean[0], mean[1])) * 57.29578f;
    if (!(lean_deg > max_deg))
        return 0;
    for (size_t i = 0; i < count; i++) {
        float *n = tl_image_floats(normals) + 3 * i;
        for (int k = 0; k < 2; k++)
            n[k] -= mean[k] * fmaxf(n[2], steepest);
    }
    return lean_deg;
}

static tl_image encoded_normals(tl_image *own, float *lean_deg)
{
    *lean_deg = own->texels ? level(own) : 0;
    if (!own->texels)
        return (tl_image){0};
    tl_image out = tl_image_create(own->width, own->height, 3, TL_IMAGE_U8);
    out.linear = true;
    for (size_t i = 0; i < texel_count(own); i++) {
        const float *n = tl_image_floats(own) + 3 * i;
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (size_t c = 0; c < 3; c++)
            tl_image_bytes(&out)[3 * i + c] = byte_from(length > 0 ? 0.5f + 0.5f * n[c] / length
                                                        : c == 2   ? 1
                                                                   : 0.5f);
    }
    return out;
}

static tl_image heights_of(const struct loading *loading)
{
    const tl_image *own = &loading->plane[TL_PICTURE_HEIGHT];
    float low, high;
    if (!own->texels)
        return (tl_image){0};
    range_of(own, &low, &high);
    tl_image out = tl_image_create(own->width, own->height, 1, TL_IMAGE_F32);
    for (size_t i = 0; i < texel_count(own); i++)
        tl_image_floats(&out)[i] = high > low ? (tl_image_floats(own)[i] - low) / (high - low) : 0;
    return out;
}

/* Appends the mirror image in one direction. `turned`: the channel of normals that changes its sign, or -1.
 */
static void mirror(tl_image *image, bool along_u, int turned)
{
    if (!image->texels)
        return;
    size_t size = (image->type == TL_IMAGE_U8 ? 1 : sizeof(float)) * (size_t)image->channels;
    tl_image out = tl_image_create(image->width * (along_u ? 2 : 1), image->height * (along_u ? 1 : 2),
                                   image->channels, image->type);
    out.linear = image->linear;
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++) {
            bool flipped = x >= image->width || y >= image->height;
            int u = x < image->width ? x : 2 * image->width - 1 - x,
                v = y < image->height ? y : 2 * image->height - 1 - y;
            char *to = (char *)out.texels + ((size_t)y * (size_t)out.width + (size_t)x) * size;
            memcpy(to, (char *)image->texels + ((size_t)v * (size_t)image->width + (size_t)u) * size, size);
            if (flipped && turned >= 0)
                to[turned] = (char)(255 - (uint8_t)to[turned]);
        }
    tl_image_release(image);
    *image = out;
}

static void mirror_all(struct tl_fabric_maps *maps, bool along_u)
{
    tl_image *plain[] = {&maps->colour, &maps->gloss, &maps->height_map, &maps->opacity, &maps->specular};
    for (size_t i = 0; i < TL_COUNT(plain); i++)
        mirror(plain[i], along_u, -1);
    mirror(&maps->normal, along_u, along_u ? 0 : 1);
    maps->width *= along_u ? 2 : 1;
    maps->height *= along_u ? 1 : 2;
}

void tl_fabric_maps_mirror(struct tl_fabric_maps *maps, bool along_u, bool along_v)
{
    if (along_u)
        mirror_all(maps, true);
    if (along_v)
        mirror_all(maps, false);
}

bool tl_fabric_maps_load(const tl_fabric_file *file, struct tl_fabric_maps *out, tl_error *error)
{
    struct loading loading = {.file = file};
    *out = (struct tl_fabric_maps){0};
    bool decoded = decode_all(&loading, error);
    if (decoded && loading.width > 0) {
        limit_size(&loading);
        read_planes(&loading);
        float lean_deg;
        tl_image normal = encoded_normals(&loading.plane[TL_PICTURE_NORMAL], &lean_deg);
        *out = (struct tl_fabric_maps){.width = loading.width,
                                       .height = loading.height,
                                       .colour = colour_of(&loading),
                                       .gloss = gloss_of(&loading),
                                       .normal = normal,
                                       .lean_deg = lean_deg,
                                       .height_map = heights_of(&loading),
                                       .opacity = opacity_of(&loading),
                                       .specular = specular_of(&loading)};
    }
    release_loading(&loading);
    return decoded;
}

void tl_fabric_maps_release(struct tl_fabric_maps *maps)
{
    tl_image *images[] = {&maps->colour,     &maps->gloss,   &maps->normal,
                          &maps->height_map, &maps->opacity, &maps->specular};
    for (size_t i = 0; i < TL_COUNT(images); i++)
        tl_image_release(images[i]);
    *maps = (struct tl_fabric_maps){0};
}

/* ---- Means ---- */

/* Reads a picture at its own size. An empty plane where there is none. */
static bool read_plane(const tl_fabric_file *file, const struct tl_fabric_picture *picture, read_texel *read,
                       int channels, tl_image *out, tl_error *error)
{
    tl_image raw;
    *out = (tl_image){0};
    if (!picture->file)
        return true;
    if (!decode(file, picture->file, read == read_height, &raw, error))
        return false;
    *out = resized(picture, &raw, read, channels, raw.width, raw.height);
    tl_image_release(&raw);
    return true;
}

bool tl_fabric_maps_means(const tl_fabric_file *file, struct tl_fabric_means *out, tl_error *error)
{
    tl_image gloss, back = {0}, heights = {0};
    *out = (struct tl_fabric_means){.glossiness = tl_glossiness_from_roughness(file->surface.roughness)};
    bool read = read_plane(file, &file->pictures[TL_PICTURE_ROUGHNESS], read_glossiness, 1, &gloss, error) &&
                read_plane(file, &file->back_picture, read_colour, 3, &back, error) &&
                read_plane(file, &file->pictures[TL_PICTURE_HEIGHT], read_height, 1, &heights, error);
    if (read && gloss.texels)
        out->glossiness = mean_of(&gloss, 0);
    for (int c = 0; read && c < 3; c++)
        out->back[c] = file->back[c] * (back.texels ? mean_of(&back, c) : 1);
    if (read && heights.texels) {
        float low, high;
        range_of(&heights, &low, &high);
        out->depth_mm = high - low;
    }
    tl_image_release(&gloss);
    tl_image_release(&back);
    tl_image_release(&heights);
    return read;
}

/* ---- One picture ---- */

bool tl_fabric_maps_bake(const tl_fabric_file *file, enum tl_picture_use use, tl_image *out, tl_error *error)
{
    tl_image plane;
    read_texel *read =
        use == TL_PICTURE_ROUGHNESS ? read_number : kinds[use].read; /* not yet as glossiness */
    *out = (tl_image){0};
    if (!read_plane(file, &file->pictures[use], read, kinds[use].channels, &plane, error))
        return false;
    if (use == TL_PICTURE_NORMAL) {
        float lean_deg;
        *out = encoded_normals(&plane, &lean_deg);
    } else if (plane.texels) {
        *out = tl_image_create(plane.width, plane.height, plane.channels, TL_IMAGE_U8);
        for (size_t i = 0; i < texel_count(&plane) * (size_t)plane.channels; i++) {
            float value = tl_image_floats(&plane)[i];
            tl_image_bytes(out)[i] = byte_from(use == TL_PICTURE_COLOUR ? tl_srgb_from_linear(value) : value);
        }
    }
    tl_image_release(&plane);
    return true;
}
