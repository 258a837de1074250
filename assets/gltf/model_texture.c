#include "assets/gltf/model_internal.h"
#include "assets/image/image_file.h"
#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool decode(struct texture_reader *reader, int source, tl_image *out)
{
    const gltf_document *document = reader->document;
    tl_error error;
    if (source < 0 || (size_t)source >= document->image_count) {
        model_unread(reader->model, "", true, "texture without a picture that can be read");
        return false;
    }
    const struct gltf_image *image = &document->images[source];
    const uint8_t *bytes = image->data;
    size_t size = image->size;
    char name[160];
    const char *file = image->name ? image->name : "";
    snprintf(name, sizeof name, "image %d %s", source, file);
    bool has_bytes =
        bytes || (image->view >= 0 && gltf_view_bytes(document, image->view, name, &bytes, &size, &error));
    if (has_bytes && tl_image_decode(name, bytes, size, out, &error))
        return true;
    bool is_absent = !has_bytes && image->view < 0;
    if (is_absent)
        tl_fail(&error, TL_INPUT, "%s: no such file, or outside the folder of the model (--allow-outside)",
                name);
    model_unread(reader->model, file, is_absent, error.message);
    return false;
}

/* A channel varies when its values differ by more than this, of 255. */
#define VARIES 25

/* glTF packs roughness in green and metalness in blue. A gloss map holds g of each texel over the largest g:
 * otherwise 255 would stand for everything above 0.998, where s = 1 / (1 - g) runs from 500 to infinity. Of
 * metalness the mean is kept, which is exact for cloth (0) and plain metal (1); model_metal.c has the rest.
 */
static void unpack_roughness(const tl_image *packed, struct texture_loaded *to, tl_image *gloss)
{
    *gloss = tl_image_create(packed->width, packed->height, 1, TL_IMAGE_U8);
    gloss->linear = true;
    size_t texels = (size_t)packed->width * (size_t)packed->height, channels = (size_t)packed->channels;
    const uint8_t *from = tl_image_bytes(packed);
    uint64_t sum = 0, green_sum = 0;
    uint8_t lowest = 255, highest = 0, smoothest = 255, roughest = 0;
    for (size_t i = 0; i < texels; i++) {
        uint8_t green = from[i * channels + (channels > 2 ? 1 : 0)];
        uint8_t blue = channels > 2 ? from[i * channels + 2] : 0;
        tl_image_bytes(gloss)[i] = green;
        smoothest = green < smoothest ? green : smoothest;
        roughest = green > roughest ? green : roughest;
        green_sum += green;
        sum += blue;
        lowest = blue < lowest ? blue : lowest;
        highest = blue > highest ? blue : highest;
    }
    to->glossiest = tl_glossiness_from_roughness(to->roughness * (float)smoothest / 255);
    uint8_t table[256] = {0};
    for (int i = smoothest; i < 256 && to->glossiest > 0; i++) {
        float glossiness = tl_glossiness_from_roughness(to->roughness * (float)i / 255);
        table[i] = (uint8_t)lrintf(255 * glossiness / to->glossiest);
    }
    for (size_t i = 0; i < texels; i++)
        tl_image_bytes(gloss)[i] = table[tl_image_bytes(gloss)[i]];
    to->metallic_mean = (float)((double)sum / (255.0 * (double)texels));
    to->metallic_varies = highest - lowest > VARIES;
    to->roughness_mean = (float)((double)green_sum / (255.0 * (double)texels));
    to->roughness_varies = roughest - smoothest > VARIES;
}

/* The mean of each channel. An image of one or two channels is grey, and alpha. */
static void take_means(const tl_image *image, bool is_colour, struct texture_loaded *to)
{
    size_t texels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    const uint8_t *from = tl_image_bytes(image);
    to->has_means = true;
    for (size_t c = 0; c < 4; c++) {
        size_t channel = channels > 2 ? c : c == 3 ? 1 : 0;
        to->means[c] = 1;
        if (channel >= channels)
            continue;
        size_t counts[256] = {0};
        for (size_t i = 0; i < texels; i++)
            counts[from[i * channels + channel]]++;
        double sum = 0;
        int lowest = 255, highest = 0;
        for (int level = 0; level < 256; level++) {
            float value = (float)level / 255;
            sum += (double)counts[level] * (double)(is_colour && c < 3 ? tl_srgb_to_linear(value) : value);
            if (counts[level] == 0)
                continue;
            lowest = level < lowest ? level : lowest;
            highest = level;
        }
        to->means[c] = (float)(sum / (double)texels);
        to->varies[c] = highest - lowest > VARIES;
    }
}

/* Facts of a colour's alpha that blending needs. */
static void take_alpha(const tl_image *image, struct texture_loaded *to)
{
    size_t texels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    size_t counts[256] = {0}, kept = 0;
    double sum = 0;
    int highest = 255, lowest = 255;
    if (channels != 2 && channels != 4)
        return;
    for (size_t i = 0; i < texels; i++)
        counts[tl_image_bytes(image)[i * channels + channels - 1]]++;
    while (highest > 0 && counts[highest] == 0)
        highest--;
    for (int level = (highest + 1) / 2; level <= highest; level++) {
        sum += (double)counts[level] * level;
        kept += counts[level];
        lowest = counts[level] > 0 && level < lowest ? level : lowest;
    }
    to->has_alpha = counts[255] < texels;
    to->alpha_highest = (float)highest / 255;
    to->alpha_mean = (float)(sum / (255 * (double)kept));
    to->alpha_varies = highest - lowest > VARIES;
}

static void take_metal(const tl_image *packed, tl_image *metal)
{
    *metal = tl_image_create(packed->width, packed->height, 1, TL_IMAGE_U8);
    metal->linear = true;
    size_t texels = (size_t)packed->width * (size_t)packed->height, channels = (size_t)packed->channels;
    for (size_t i = 0; i < texels; i++)
        tl_image_bytes(metal)[i] = channels > 2 ? tl_image_bytes(packed)[i * channels + 2] : 0;
}

static const struct texture_loaded *load_image(struct texture_reader *reader, int source,
                                               enum texture_use use, float roughness)
{
    for (size_t i = 0; i < reader->loaded_count; i++) {
        const struct texture_loaded *known = &reader->loaded[i];
        if (known->source == source && known->use == use &&
            (use != TEXTURE_GLOSS || known->roughness == roughness))
            return known;
    }
    struct texture_loaded *fresh = &reader->loaded[reader->loaded_count++];
    *fresh = (struct texture_loaded){.source = source, .use = use, .roughness = roughness};
    tl_image decoded;
    if (reader->is_full || !decode(reader, source, &decoded))
        return fresh;
    /* A few bytes may decode to a huge plain image, and many materials may use it: the sum is limited. */
    const uint64_t copies = 2; /* the decoder's, and a map made of it */
    tl_error error;
    reader->decoded_bytes +=
        copies * (uint64_t)decoded.width * (uint64_t)decoded.height * (uint64_t)decoded.channels;
    if (!tl_memory_request_for_file(reader->document->path, reader->document->file_bytes,
                                    reader->decoded_bytes, &error)) {
        model_unread(reader->model, "", false, error.message);
        reader->is_full = true;
        tl_image_release(&decoded);
        return fresh;
    }
    if (use == TEXTURE_COLOUR_MEAN || use == TEXTURE_DATA_MEAN) {
        take_means(&decoded, use == TEXTURE_COLOUR_MEAN, fresh);
        tl_image_release(&decoded);
        return fresh;
    }
    tl_image *kept = &reader->model->images[reader->model->image_count++];
    if (use == TEXTURE_GLOSS) {
        unpack_roughness(&decoded, fresh, kept);
        tl_image_release(&decoded);
    } else if (use == TEXTURE_METAL) {
        take_metal(&decoded, kept);
        tl_image_release(&decoded);
    } else {
        take_alpha(&decoded, fresh);
        *kept = decoded;
        kept->linear = use == TEXTURE_DATA;
    }
    fresh->image = kept;
    return fresh;
}

const struct texture_loaded *texture_read_map(struct texture_reader *reader,
                                              const struct gltf_texture *texture, enum texture_use use,
                                              float roughness, struct tl_map *map)
{
    static const struct texture_loaded none = {0};
    if (!texture->used)
        return &none;
    if (texture->uv_set != 0) {
        model_ignore(reader->model, "maps on TEXCOORD_%d", texture->uv_set);
        return &none;
    }
    const struct texture_loaded *loaded = load_image(reader, texture->image, use, roughness);
    map->image = loaded->image;
    map->transform = texture->transform;
    map->clamp_u = texture->clamp_u;
    map->clamp_v = texture->clamp_v;
    return loaded;
}

struct model_mean model_map_mean(const struct material_build *build, const struct gltf_texture *texture,
                                 const char *which, const char *what)
{
    struct tl_map map;
    bool is_colour = strcmp(which, "colour") == 0;
    const struct texture_loaded *loaded = texture_read_map(
        build->textures, texture, is_colour ? TEXTURE_COLOUR_MEAN : TEXTURE_DATA_MEAN, 0, &map);
    for (int c = 0; c < 4; c++)
        if (strchr(is_colour ? "rgb" : which, "rgba"[c]) && loaded->varies[c])
            model_approximate_extension(build, "%s varies over a texture: its mean is used", what);
    if (!loaded->has_means)
        return (struct model_mean){1, 1, 1, 1};
    return (struct model_mean){loaded->means[0], loaded->means[1], loaded->means[2], loaded->means[3]};
}

void model_colour_map(const struct material_build *build, const struct gltf_texture *texture,
                      struct tl_map *out)
{
    texture_read_map(build->textures, texture, TEXTURE_COLOUR, 0, out);
}
