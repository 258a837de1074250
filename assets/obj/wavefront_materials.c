#include "assets/base/model_build.h"
#include "assets/image/image_file.h"
#include "assets/obj/wavefront_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/base/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* MTL describes a Phong model. Kd is the diffuse colour, taken as linear; Ks the strength of the
 * highlight, which exporters write from 0 to 1 with 0.5 for ordinary surfaces, so F0 = 0.08 Ks [Burley
 * 2012, 5.5: the specular parameter]; Ns the exponent of the halfway vector, four times that of the mirror
 * direction (as in tl_glossiness_from_roughness). */
#define F0_OF_KS 0.08f

/* The state of reading. */
struct mtl_reader {
    const char *path; /* the OBJ file; borrowed */
    struct tl_text text;
    const struct wave_object *object;
    tl_model *model;
    char **image_paths; /* [model->image_count] */
    size_t image_capacity;
    uint64_t decoded_bytes, file_bytes; /* of all pictures so far */
    bool is_full;                       /* they are more than the files may take: no more are decoded */
    tl_material *current;               /* NULL: one that no face uses */
};

static float unit(float value)
{
    return fminf(fmaxf(value, 0), 1);
}

/* The number of arguments of a map statement's option, a word that starts with -. */
static int option_arguments(const char *option)
{
    static const struct {
        const char *name;
        int count;
    } known[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1},   {"-mm", 2},   {"-texres", 1},
                 {"-clamp", 1},  {"-bm", 1},     {"-imfchan", 1}, {"-type", 1}, {"-cc", 1}};
    for (size_t i = 0; i < TL_COUNT(known); i++)
        if (strcmp(known[i].name, option) == 0)
            return known[i].count;
    return 0;
}

/* -o and -s take one to three numbers, of which two are used; the word after them is not consumed. */
static void read_pair(struct tl_text *text, float out[2])
{
    for (int i = 0; i < 3; i++) {
        char *before = text->word, *end;
        while (*before == ' ' || *before == '\t')
            before++;
        float value = strtof_l(before, &end, text->plain);
        if (end == before || (*end != ' ' && *end != '\t') || !isfinite(value))
            return;
        if (i < 2)
            out[i] = value;
        text->word = end;
    }
}

/* The file name at the end of a map statement, after its options; "" when there is none. */
static const char *read_map_name(struct tl_text *text, struct tl_map *map)
{
    for (;;) {
        char *start = text->word + strspn(text->word, " \t");
        if (*start != '-')
            break;
        char *option = tl_text_word(text);
        float pair[2] = {0, 0};
        bool is_scale = strcmp(option, "-s") == 0;
        if (is_scale || strcmp(option, "-o") == 0 || strcmp(option, "-t") == 0) {
            pair[0] = pair[1] = is_scale ? 1 : 0;
            read_pair(text, pair);
            if (is_scale || strcmp(option, "-o") == 0)
                memcpy(is_scale ? map->transform.scale : map->transform.offset, pair, sizeof pair);
            continue;
        }
        for (int i = option_arguments(option); i > 0; i--) {
            const char *argument = tl_text_word(text);
            if (strcmp(option, "-clamp") == 0 && argument)
                map->clamp_u = map->clamp_v = strcmp(argument, "on") == 0;
        }
    }
    return tl_text_rest(text);
}

/* OBJ's v runs up, ours runs down. A map's transform is for the former:
 * 1 - (offset + scale (1 - v)) = (1 - offset - scale) + scale v. */
static void turn_over(struct tl_uv_transform *transform)
{
    transform->offset[1] = 1 - transform->offset[1] - transform->scale[1];
}

/* The path of an image, relative to the MTL file. Exporters also write paths of the machine that they ran on:
 * when such a file does not exist, or lies outside the folder of `model`, its name is looked for in the MTL
 * file's folder. */
static char *picture_path(const char *model, const char *library, const char *name)
{
    char *plain = tl_copy_string(name);
    for (char *c = plain; *c; c++)
        if (*c == '\\')
            *c = '/';
    char *path = tl_path_relative_to(library, plain);
    const char *slash = strrchr(plain, '/');
    if (slash && (!tl_file_exists(path) || !tl_path_is_inside(model, path, NULL))) {
        char *sibling = tl_path_relative_to(library, slash + 1);
        if (tl_file_exists(sibling)) {
            char *swap = path;
            path = sibling;
            sibling = swap;
        }
        free(sibling);
    }
    free(plain);
    return path;
}

/* Asks for all pictures so far and this one. A material file may name one small picture by many paths, so
 * that the sizes of different files alone are added. */
static bool request_memory(struct mtl_reader *reader, const char *path, const tl_image *image,
                           tl_error *error)
{
    const uint64_t copies = 2; /* the decoder's */
    reader->decoded_bytes +=
        copies * (uint64_t)image->width * (uint64_t)image->height * (uint64_t)image->channels;
    reader->file_bytes += tl_file_size(path);
    reader->is_full =
        !tl_memory_request_for_file(reader->text.path, reader->file_bytes, reader->decoded_bytes, error);
    return !reader->is_full;
}

static void note_unread(const struct mtl_reader *reader, const char *path, const tl_error *error)
{
    bool is_there = tl_file_exists(path) && tl_path_is_inside(reader->path, path, NULL);
    model_unread(reader->model, path, !is_there, error->message);
}

static const tl_image *load_picture(struct mtl_reader *reader, const char *name, bool linear)
{
    char *named = picture_path(reader->path, reader->text.path, name), *real = realpath(named, NULL);
    char *path = real ? real : named; /* one name for one file */
    if (real)
        free(named);
    tl_model *model = reader->model;
    for (size_t i = 0; i < model->image_count; i++)
        if (strcmp(reader->image_paths[i], path) == 0 && model->images[i].linear == linear) {
            free(path);
            return &model->images[i];
        }
    tl_error error;
    tl_image image = {0};
    if (reader->is_full || model->image_count == reader->image_capacity)
        goto failed;
    if (!tl_path_is_inside(reader->path, path, &error) || !tl_image_load(path, &image, &error) ||
        !request_memory(reader, path, &image, &error)) {
        note_unread(reader, path, &error);
        goto failed;
    }
    image.linear = linear;
    reader->image_paths[model->image_count] = path;
    model->images[model->image_count] = image;
    return &model->images[model->image_count++];
failed:
    tl_image_release(&image);
    free(path);
    return NULL;
}

static void read_map(struct mtl_reader *reader, struct tl_map *map, bool linear)
{
    *map = (struct tl_map){.transform = {.scale = {1, 1}}};
    const char *name = read_map_name(&reader->text, map);
    turn_over(&map->transform);
    if (name[0])
        map->image = load_picture(reader, name, linear);
}

/* Starts a material. Of several definitions of one material the last is used. */
static void begin_material(struct mtl_reader *reader)
{
    const char *name = tl_text_rest(&reader->text);
    reader->current = NULL;
    for (size_t i = 0; i < reader->object->material_count; i++)
        if (strcmp(reader->object->materials[i], name) == 0) {
            reader->current = &reader->model->materials[i];
            *reader->current = tl_material_default(name[0] ? name : "unnamed");
        }
}

/* map_d is supported when it is the alpha channel of map_Kd. */
static void read_alpha_map(struct mtl_reader *reader)
{
    struct tl_map map;
    read_map(reader, &map, false);
    tl_material *material = reader->current;
    if (map.image && map.image == material->diffuse_map.image && map.image->channels == 4)
        material->alpha_cutoff = 0.5f;
    else
        model_ignore(reader->model, "map_d other than the alpha of map_Kd");
}

static void read_highlight(struct mtl_reader *reader, const float specular[3])
{
    for (int i = 0; i < 3; i++)
        reader->current->specular.raw[i] = F0_OF_KS * unit(specular[i]);
}

static bool read_statement(struct mtl_reader *reader, const char *keyword, tl_error *error)
{
    tl_material *material = reader->current;
    float value[3] = {0, 0, 0};
    if (strcmp(keyword, "newmtl") == 0) {
        begin_material(reader);
    } else if (!material) {
        return true;
    } else if (strcmp(keyword, "Kd") == 0 || strcmp(keyword, "Ks") == 0) {
        if (!tl_text_numbers(&reader->text, keyword, 3, value, error))
            return false;
        if (keyword[1] == 's')
            read_highlight(reader, value);
        for (int i = 0; keyword[1] == 'd' && i < 3; i++)
            material->diffuse.raw[i] = unit(value[i]);
    } else if (strcmp(keyword, "Ns") == 0) {
        if (!tl_text_numbers(&reader->text, keyword, 1, value, error))
            return false;
        material->glossiness = 1 - 1 / fmaxf(value[0] / 4, 1);
    } else if (strcmp(keyword, "illum") == 0) {
        if (!tl_text_numbers(&reader->text, keyword, 1, value, error))
            return false;
        if (value[0] < 2) /* colour, or colour and diffuse light: no highlight */
            read_highlight(reader, (const float[3]){0, 0, 0});
    } else if (strcmp(keyword, "map_Kd") == 0) {
        read_map(reader, &material->diffuse_map, false);
    } else if (strcmp(keyword, "map_Ks") == 0) {
        read_map(reader, &material->specular_map, false);
    } else if (strcmp(keyword, "norm") == 0) {
        read_map(reader, &material->normal_map, true);
    } else if (strcmp(keyword, "map_d") == 0) {
        read_alpha_map(reader);
    } else if (strcmp(keyword, "d") == 0) {
        if (!tl_text_numbers(&reader->text, keyword, 1, value, error))
            return false;
        if (value[0] < 1)
            model_ignore(reader->model, "transparency of a material");
    } else if (strcmp(keyword, "Ka") != 0 && strcmp(keyword, "Ni") != 0) {
        model_ignore(reader->model, "\"%.24s\" of a material", keyword);
    }
    return true;
}

static void read_library(struct mtl_reader *reader, const char *path)
{
    tl_error error;
    bool good = tl_text_open(path, &reader->text, &error);
    for (const char *keyword; good && (keyword = tl_text_line(&reader->text));)
        good = read_statement(reader, keyword, &error);
    reader->current = NULL;
    if (!good)
        note_unread(reader, path, &error);
    tl_text_close(&reader->text);
}

void wave_read_materials(const char *path, const struct wave_object *object, tl_model *model)
{
    const size_t maps_each = 3;
    struct mtl_reader reader = {.path = path,
                                .object = object,
                                .model = model,
                                .image_capacity = 2 * maps_each * object->material_count};
    reader.image_paths = TL_NEW_ARRAY(char *, reader.image_capacity);
    model->images = TL_NEW_ARRAY(tl_image, reader.image_capacity); /* never moved: materials point into it */
    model->material_count = object->material_count;
    model->materials = TL_NEW_ARRAY(tl_material, model->material_count);
    for (size_t i = 0; i < object->material_count; i++)
        model->materials[i] = tl_material_default(i > 0 ? object->materials[i] : "default");
    for (size_t i = 0; i < object->library_count; i++) {
        char *library = tl_path_relative_to(path, object->libraries[i]);
        tl_error error;
        if (tl_path_is_inside(path, library, &error))
            read_library(&reader, library);
        else
            note_unread(&reader, library, &error);
        free(library);
    }
    for (size_t i = 0; i < model->image_count; i++)
        free(reader.image_paths[i]);
    free(reader.image_paths);
}
