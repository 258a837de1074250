#include "assets/base/model_read.h"
#include "config/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a decoded picture is used for decides how its texels are read. */
enum use { COLOUR, DATA, GLOSS, COLOUR_MEAN, DATA_MEAN };

/* Pictures a material may name: each is decoded once for each use. */
#define MAPS_MAX 16

struct loaded {
    int source; /* glTF image */
    enum use use;
    float roughness;       /* GLOSS: factor */
    float glossiest;       /* GLOSS: glossiness where the map is 1 */
    float metallic_mean;   /* GLOSS: of the blue channel */
    bool metallic_varies;  /* GLOSS */
    float roughness_mean;  /* GLOSS: of the green channel */
    bool roughness_varies; /* GLOSS */
    bool has_means;        /* COLOUR_MEAN, DATA_MEAN */
    float means[4];        /* ... by channel, linear */
    bool varies[4];
    const tl_image *image; /* NULL: could not be read, or not kept */
};

struct model_reader {
    const gltf_document *document;
    tl_model *model;
    struct loaded *loaded;
    size_t loaded_count;
    uint64_t texel_count; /* decoded so far */
};

static bool decode(struct model_reader *reader, int source, tl_image *out)
{
    const gltf_document *document = reader->document;
    tl_error error;
    if (source < 0 || (size_t)source >= document->image_count) {
        model_ignore(reader->model, "texture without a picture that can be read");
        return false;
    }
    const struct gltf_image *image = &document->images[source];
    const uint8_t *bytes = image->data;
    size_t size = image->size;
    char name[160];
    snprintf(name, sizeof name, "image %d %s", source, image->name ? image->name : "");
    if (!bytes && image->view >= 0 && !gltf_view_bytes(document, image->view, name, &bytes, &size, &error)) {
        model_ignore(reader->model, "%s", error.message);
        return false;
    }
    if (!bytes) {
        model_ignore(reader->model, "%s: no such file", name);
        return false;
    }
    if (!tl_image_decode(name, bytes, size, out, &error)) {
        model_ignore(reader->model, "%s", error.message);
        return false;
    }
    return true;
}

/* Of 255: what differs by less counts as the same. */
#define VARIES 25

/* glTF packs roughness in green and metalness in blue. A gloss map holds g of each texel over the largest g:
 * 255 must not stand for everything above 0.998, where s = 1 / (1 - g) runs from 500 to infinity. Metalness
 * becomes its mean, which is exact for cloth (0) and plain metal (1). */
static void unpack_roughness(const tl_image *packed, struct loaded *to, tl_image *gloss)
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

/* One or two channels are grey, and alpha. */
static void take_means(const tl_image *image, bool is_colour, struct loaded *to)
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

static const struct loaded *load_image(struct model_reader *reader, int source, enum use use, float roughness)
{
    for (size_t i = 0; i < reader->loaded_count; i++) {
        const struct loaded *known = &reader->loaded[i];
        if (known->source == source && known->use == use && (use != GLOSS || known->roughness == roughness))
            return known;
    }
    struct loaded *fresh = &reader->loaded[reader->loaded_count++];
    *fresh = (struct loaded){.source = source, .use = use, .roughness = roughness};
    tl_image decoded;
    if (!decode(reader, source, &decoded))
        return fresh;
    /* A few bytes of file may be a huge plain picture, and many materials may ask for it again. */
    reader->texel_count += (uint64_t)decoded.width * (uint64_t)decoded.height;
    if (reader->texel_count > TL_LIMIT_IMAGE_TEXELS) {
        model_ignore(reader->model, "maps beyond %zu texels in all", TL_LIMIT_IMAGE_TEXELS);
        tl_image_release(&decoded);
        return fresh;
    }
    if (use == COLOUR_MEAN || use == DATA_MEAN) {
        take_means(&decoded, use == COLOUR_MEAN, fresh);
        tl_image_release(&decoded);
        return fresh;
    }
    tl_image *kept = &reader->model->images[reader->model->image_count++];
    if (use == GLOSS) {
        unpack_roughness(&decoded, fresh, kept);
        tl_image_release(&decoded);
    } else {
        *kept = decoded;
        kept->linear = use == DATA;
    }
    fresh->image = kept;
    return fresh;
}

static const struct loaded *read_map(struct model_reader *reader, const struct gltf_texture *texture,
                                     enum use use, float roughness, struct tl_map *map)
{
    static const struct loaded none = {0};
    if (!texture->used)
        return &none;
    if (texture->uv_set != 0) {
        model_ignore(reader->model, "maps on TEXCOORD_%d", texture->uv_set);
        return &none;
    }
    const struct loaded *loaded = load_image(reader, texture->image, use, roughness);
    map->image = loaded->image;
    map->transform = texture->transform;
    map->clamp_u = texture->clamp_u;
    map->clamp_v = texture->clamp_v;
    return loaded;
}

struct model_mean model_map_mean(const struct model_look *look, const struct gltf_texture *texture,
                                 const char *which, const char *what)
{
    struct tl_map map;
    bool is_colour = strcmp(which, "colour") == 0;
    const struct loaded *loaded =
        read_map(look->reader, texture, is_colour ? COLOUR_MEAN : DATA_MEAN, 0, &map);
    for (int c = 0; c < 4; c++)
        if (strchr(is_colour ? "rgb" : which, "rgba"[c]) && loaded->varies[c])
            model_approximate(look->model, "%s varies over a texture: its mean is used", what);
    if (!loaded->has_means)
        return (struct model_mean){1, 1, 1, 1};
    return (struct model_mean){loaded->means[0], loaded->means[1], loaded->means[2], loaded->means[3]};
}

void model_colour_map(const struct model_look *look, const struct gltf_texture *texture, struct tl_map *out)
{
    read_map(look->reader, texture, COLOUR, 0, out);
}

static float unit(float value, float otherwise)
{
    return isfinite(value) ? fminf(fmaxf(value, 0), 1) : otherwise;
}

/* The file's alpha is factor times texel; ours is the texel alone, so the factor goes into the cutoff. What
 * is evenly half transparent stays visible. */
static float alpha_cutoff(struct model_reader *reader, const struct gltf_material *from)
{
    float factor = fmaxf(unit(from->base_colour[3], 1), 1e-3f);
    if (from->alpha == GLTF_MASK)
        return fmaxf(unit(from->alpha_cutoff, 0.5f), 1e-3f) / factor;
    if (from->alpha == GLTF_OPAQUE)
        return 0;
    model_ignore(reader->model, "alpha blending (shown as a mask at 0.5)");
    return fminf(0.5f / factor, 1);
}

/* glTF's metallic-roughness model in two lobes: diffuse = base (1 - metallic), F0 = mix(F0 of what is no
 * metal, base, metallic). */
static tl_material read_material(struct model_reader *reader, const struct gltf_material *from)
{
    tl_material to = tl_material_default(from->name && from->name[0] ? from->name : "unnamed");
    float metallic = unit(from->metallic, 1), roughness = unit(from->roughness, 1);
    to.double_sided = from->double_sided;
    to.normal_scale = isfinite(from->normal_scale) ? from->normal_scale : 1;
    to.occlusion_strength = unit(from->occlusion_strength, 1);
    to.glossiness = tl_glossiness_from_roughness(roughness);
    read_map(reader, &from->base_colour_map, COLOUR, 0, &to.diffuse_map);
    read_map(reader, &from->normal_map, DATA, 0, &to.normal_map);
    read_map(reader, &from->occlusion_map, DATA, 0, &to.occlusion_map);
    const struct loaded *packed =
        read_map(reader, &from->metallic_roughness_map, GLOSS, roughness, &to.gloss_map);
    if (packed->image) {
        to.glossiness = packed->glossiest;
        metallic *= packed->metallic_mean;
        if (packed->metallic_varies)
            model_ignore(reader->model, "metalness that varies over a texture (its mean is used)");
    }
    struct model_look look = {.reader = reader,
                              .model = reader->model,
                              .from = from,
                              .metallic = metallic,
                              .roughness = roughness * (packed->image ? packed->roughness_mean : 1),
                              .roughness_varies = packed->roughness_varies,
                              .to = &to};
    vec3s f0 = model_dielectric_f0(&look);
    for (int i = 0; i < 3; i++) {
        look.base[i] = unit(from->base_colour[i], 1);
        to.diffuse.raw[i] = look.base[i] * (1 - metallic);
        to.specular.raw[i] = f0.raw[i] * (1 - metallic) + look.base[i] * metallic;
    }
    if (metallic > 0.5f)
        to.specular_map = to.diffuse_map; /* a metal's colour is in what it mirrors */
    to.alpha_cutoff = alpha_cutoff(reader, from);
    model_apply_extensions(&look);
    if (from->is_emissive)
        model_ignore(reader->model, "emission");
    return to;
}

void model_read_materials(const gltf_document *document, tl_model *model)
{
    size_t count = document->material_count;
    struct model_reader reader = {
        .document = document, .model = model, .loaded = TL_NEW_ARRAY(struct loaded, MAPS_MAX * count)};
    model->images = TL_NEW_ARRAY(tl_image, MAPS_MAX * count); /* never moved: materials point into it */
    model->materials = TL_NEW_ARRAY(tl_material, count + 1);
    model->material_count = count + 1;
    for (size_t i = 0; i < count; i++)
        model->materials[i] = read_material(&reader, &document->materials[i]);
    model->materials[count] = tl_material_default("default");
    free(reader.loaded);
}
