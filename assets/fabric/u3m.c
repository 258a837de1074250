/* U3M 1.0 and 1.1 (github.com/vizoogmbh/u3m): one JSON object for how a fabric looks, and for its physics.
 * Read after its schema and u3m_additional_spec_u3m.txt: a texture takes the place of its constant; value =
 * offset + factor * texture; colours are blended with their factor in linear light. */
#include "assets/fabric/fabric_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME_MAX_BYTES 200

struct u3m_reader {
    tl_fabric_file *file;
    char *place;  /* of the .u3m, for messages */
    char *folder; /* of it in its store, "" or "x/" */
    const cJSON *side;
    const char *side_name; /* "front" */
    bool has_size;
    tl_error *error;
};

/* ---- Fields ---- */

static void used(const struct u3m_reader *reader, const char *name, char *value, char *use)
{
    tl_fabric_add_field(reader->file, name, value, true, use);
}

static void unused(const struct u3m_reader *reader, const char *name, char *value, const char *why)
{
    tl_fabric_add_field(reader->file, name, value, false, tl_copy_string(why));
}

/* A value in short: text, number, or what kind it is. */
static char *brief(const cJSON *value)
{
    if (cJSON_IsString(value))
        return tl_format("%.80s", value->valuestring);
    if (cJSON_IsNumber(value))
        return tl_format("%.7g", value->valuedouble);
    if (cJSON_IsBool(value))
        return tl_copy_string(cJSON_IsTrue(value) ? "true" : "false");
    if (cJSON_IsArray(value))
        return tl_format("list of %d", cJSON_GetArraySize(value));
    if (cJSON_IsObject(value))
        return tl_format("%d fields", cJSON_GetArraySize(value));
    return tl_copy_string("null");
}

static bool is_given(const cJSON *value)
{
    return value && !cJSON_IsNull(value);
}

static bool fail_type(const struct u3m_reader *reader, const char *name, const char *expected)
{
    return tl_fail(reader->error, TL_INPUT, "%s: %s: expected %s", reader->place, name, expected);
}

static bool read_number(const struct u3m_reader *reader, const cJSON *value, const char *name, double low,
                        double high, float *out)
{
    if (!is_given(value))
        return true;
    if (!cJSON_IsNumber(value) || !(value->valuedouble >= low && value->valuedouble <= high)) {
        char *expected = tl_format("a number from %g to %g", low, high);
        fail_type(reader, name, expected);
        free(expected);
        return false;
    }
    *out = (float)value->valuedouble;
    return true;
}

static const char *const rgb[] = {"r", "g", "b"};

static bool read_colour(const struct u3m_reader *reader, const cJSON *value, const char *name, float out[3])
{
    for (int c = 0; is_given(value) && c < 3; c++)
        if (!read_number(reader, cJSON_GetObjectItemCaseSensitive(value, rgb[c]), name, 0, 1e6, &out[c]))
            return false;
    return true;
}

/* ---- Textures ---- */

struct parameter {
    char *name; /* "material.front.roughness" */
    const cJSON *constant, *texture;
    struct tl_fabric_picture picture; /* `file` NULL: none, or it is missing */
    char *image;                      /* what the texture's image is, in short; NULL: no texture */
    bool is_missing;
};

static bool read_mirrors(const struct u3m_reader *reader, const struct parameter *parameter,
                         const cJSON *repeat, bool out[2])
{
    static const char *const modes[] = {"normal", "mirror_x", "mirror_y", "mirror_xy"};
    const cJSON *mode = cJSON_GetObjectItemCaseSensitive(repeat, "mode");
    for (int i = 0; is_given(mode) && i < (int)TL_COUNT(modes); i++)
        if (cJSON_IsString(mode) && strcmp(mode->valuestring, modes[i]) == 0) {
            out[0] = i & 1;
            out[1] = i & 2;
            return true;
        }
    return !is_given(mode) || fail_type(reader, parameter->name,
                                        "texture.image.repeat.mode normal, mirror_x, mirror_y or mirror_xy");
}

/* The sizes and the repeat of the first picture hold for all: scans are registered. Others' differences are
 * named. */
static bool read_placing(struct u3m_reader *reader, struct parameter *parameter, const cJSON *image)
{
    float width = 0, length = 0, rotation = 0;
    bool mirrors[2] = {false, false};
    const cJSON *repeat = cJSON_GetObjectItemCaseSensitive(image, "repeat");
    if (!read_number(reader, cJSON_GetObjectItemCaseSensitive(image, "width"), parameter->name, 0, 1e4,
                     &width) ||
        !read_number(reader, cJSON_GetObjectItemCaseSensitive(image, "height"), parameter->name, 0, 1e4,
                     &length) ||
        !read_number(reader, cJSON_GetObjectItemCaseSensitive(repeat, "rotation"), parameter->name, -1e6, 1e6,
                     &rotation) ||
        !read_mirrors(reader, parameter, repeat, mirrors))
        return false;
    tl_fabric_file *file = reader->file;
    if (!reader->has_size && width > 0 && length > 0) {
        file->width_mm = width;
        file->length_mm = length;
        file->mirrors_u = mirrors[0];
        file->mirrors_v = mirrors[1];
        reader->has_size = true;
    }
    bool differs = reader->has_size && (fabsf(width - file->width_mm) > 0.01f * width ||
                                        fabsf(length - file->length_mm) > 0.01f * length ||
                                        mirrors[0] != file->mirrors_u || mirrors[1] != file->mirrors_v);
    char *name = tl_format("%s.texture.image", parameter->name);
    if (differs)
        unused(reader, name, tl_format("%g x %g mm", (double)width, (double)length),
               "not used: its own size or repeat; the picture is laid over the first one's");
    free(name);
    name = tl_format("%s.texture.image.repeat.rotation", parameter->name);
    if (rotation != 0)
        unused(reader, name, tl_format("%g", (double)rotation), "not used: pictures are not turned");
    free(name);
    return true;
}

static bool fail_outside(const struct u3m_reader *reader, const char *field, const char *path)
{
    return tl_fail(reader->error, TL_INPUT,
                   "%s: %s: \"%s\" leads out of it: expected a relative path without \"..\"", reader->place,
                   field, path);
}

static bool read_image(struct u3m_reader *reader, struct parameter *parameter, const cJSON *image)
{
    const cJSON *path = cJSON_GetObjectItemCaseSensitive(image, "path");
    if (!cJSON_IsString(path) || path->valuestring[0] == '\0')
        return fail_type(reader, parameter->name, "texture.image.path, the name of a picture");
    char *name = tl_format("%s%s", reader->folder, path->valuestring);
    parameter->image = tl_format("texture %.200s", path->valuestring);
    enum tl_store_found state = tl_store_find(&reader->file->store, name, reader->error);
    if (state == TL_STORE_REFUSED) {
        free(name);
        return fail_outside(reader, parameter->name, path->valuestring);
    }
    parameter->is_missing = state == TL_STORE_MISSING;
    parameter->picture.file = parameter->is_missing ? NULL : name;
    if (parameter->is_missing) {
        tl_fabric_add_missing(reader->file, name);
        free(name);
    }
    return parameter->is_missing || read_placing(reader, parameter, image);
}

static bool read_mode(const struct u3m_reader *reader, struct parameter *parameter)
{
    static const char *const modes[] = {"multiply", "add", "subtract", "divide", "max", "min", "overlay"};
    const cJSON *mode = cJSON_GetObjectItemCaseSensitive(parameter->texture, "mode");
    for (int i = 0; cJSON_IsString(mode) && i < (int)TL_COUNT(modes); i++)
        if (strcmp(mode->valuestring, modes[i]) == 0) {
            parameter->picture.mode = i;
            return true;
        }
    return !is_given(mode) || fail_type(reader, parameter->name,
                                        "texture.mode multiply, add, subtract, divide, max, min or overlay");
}

static bool read_texture(struct u3m_reader *reader, struct parameter *parameter)
{
    const cJSON *texture = parameter->texture, *factor = cJSON_GetObjectItemCaseSensitive(texture, "factor");
    parameter->picture = tl_picture_plain(NULL);
    if (!is_given(texture))
        return true;
    if (!cJSON_IsObject(texture))
        return fail_type(reader, parameter->name, "texture to be an object or null");
    if (!is_given(factor))
        factor = cJSON_GetObjectItemCaseSensitive(texture, "scale");
    bool good = cJSON_IsObject(factor)
                    ? read_colour(reader, factor, parameter->name, parameter->picture.factor)
                    : read_number(reader, factor, parameter->name, -1e6, 1e6, &parameter->picture.factor[0]);
    return good && read_mode(reader, parameter) &&
           read_number(reader, cJSON_GetObjectItemCaseSensitive(texture, "offset"), parameter->name, -1e6,
                       1e6, &parameter->picture.offset) &&
           read_image(reader, parameter, cJSON_GetObjectItemCaseSensitive(texture, "image"));
}

static void release_parameter(struct parameter *parameter)
{
    free(parameter->name);
    free(parameter->image);
    free(parameter->picture.file);
}

/* Finds a parameter of the side. False on a fault; a parameter that the side lacks has no constant and no
 * texture. */
static bool read_parameter(struct u3m_reader *reader, const char *key, struct parameter *out)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(reader->side, key);
    *out = (struct parameter){.name = tl_format("material.%s.%s", reader->side_name, key)};
    bool is_object = cJSON_IsObject(value);
    out->constant = is_object ? cJSON_GetObjectItemCaseSensitive(value, "constant") : value;
    out->texture = is_object ? cJSON_GetObjectItemCaseSensitive(value, "texture") : NULL;
    return read_texture(reader, out);
}

/* The parameter's value for its row: "0.7", "texture a.png * 0.5 + 0.1", and where the texture is missing. */
static char *shown(const struct parameter *parameter)
{
    const struct tl_fabric_picture *picture = &parameter->picture;
    if (!parameter->image)
        return cJSON_IsObject(parameter->constant) ? tl_copy_string("a constant")
                                                   : brief(parameter->constant);
    bool scaled = picture->factor[0] != 1 || picture->offset != 0;
    return scaled ? tl_format("%s * %g + %g", parameter->image, (double)picture->factor[0],
                              (double)picture->offset)
                  : tl_copy_string(parameter->image);
}

/* ---- Numbers that are used ---- */

struct number_rule {
    const char *key;
    size_t offset; /* of the field in tl_fabric_surface */
    float low, high, scale;
    int picture; /* enum tl_picture_use, or -1: only the constant is used */
    const char *use;
};

#define AT(field) offsetof(struct tl_fabric_surface, field)
static const struct number_rule number_rules[] = {
    {"roughness", AT(roughness), 0, 1, 1, TL_PICTURE_ROUGHNESS, "material.glossiness"},
    {"metalness", AT(metalness), 0, 1, 1, TL_PICTURE_METALNESS, "material.specular and diffuse"},
    {"specular_value", AT(specular), 0, 1, 0.08f, TL_PICTURE_SPECULAR, "material.specular: 1 is 8 %"},
    {"alpha", AT(alpha), 0, 1, 1, TL_PICTURE_OPACITY, "material.openness, or holes where a texture has them"},
    {"transmission", AT(transmission), 0, 1, 1, -1,
     "material.transmission, as light that is scattered through"},
    {"clearcoat_value", AT(coat), 0, 1, 1, -1, "material.coat"},
    {"clearcoat_roughness", AT(coat_roughness), 0, 1, 1, -1, "material.coat_glossiness"},
    {"anisotropy_value", AT(anisotropy), 0, 1, 1, -1, "material.model ward, width_weft and width_warp"},
    {"anisotropy_rotation", AT(rotation_deg), 0, 1, 360, -1, "material.rotation_deg"},
    {"sheen_value", AT(sheen), 0, 1, 1, -1,
     "material.fuzz, which is another lobe than the principled model's"},
    {"sheen_tint", AT(sheen_tint), 0, 1, 1, -1, "material.fuzz_colour: towards a constant base colour"},
};

/* The value of a missing or unused texture: the constant where no texture was meant, else the schema's
 * default. */
static bool take_constant(const struct u3m_reader *reader, const struct number_rule *rule,
                          const struct parameter *parameter)
{
    float *field = (float *)((char *)&reader->file->surface + rule->offset);
    float value = *field / rule->scale;
    if (!read_number(reader, parameter->constant, parameter->name, -1e6, 1e6, &value))
        return false;
    *field = rule->scale * fminf(fmaxf(value, rule->low), rule->high);
    return true;
}

static bool read_number_field(struct u3m_reader *reader, const struct number_rule *rule)
{
    struct parameter parameter;
    bool good = read_parameter(reader, rule->key, &parameter), textured = parameter.picture.file != NULL;
    if (good && parameter.is_missing)
        unused(reader, parameter.name, shown(&parameter),
               "not used: the file is missing; the format's default is taken");
    else if (good && textured && rule->picture >= 0) {
        float *field = (float *)((char *)&reader->file->surface + rule->offset);
        *field = rule->scale;
        used(reader, parameter.name, shown(&parameter), tl_copy_string(rule->use));
        reader->file->pictures[rule->picture] = parameter.picture;
        parameter.picture.file = NULL;
    } else if (good && is_given(parameter.constant)) {
        good = take_constant(reader, rule, &parameter);
        used(reader, parameter.name, brief(parameter.constant),
             tl_format("%s%s", rule->use, textured ? "; its texture is not used" : ""));
    }
    release_parameter(&parameter);
    return good;
}

/* ---- Fields of their own kinds ---- */

static bool read_basecolor(struct u3m_reader *reader)
{
    struct parameter parameter;
    float *colour = reader->file->surface.colour;
    bool good = read_parameter(reader, "basecolor", &parameter);
    if (good && parameter.picture.file) {
        used(reader, parameter.name, shown(&parameter), tl_copy_string("the colour of the cloth"));
        reader->file->pictures[TL_PICTURE_COLOUR] = parameter.picture;
        parameter.picture.file = NULL;
    } else if (good && parameter.is_missing) {
        unused(reader, parameter.name, shown(&parameter),
               "not used: the file is missing; the cloth is white");
    } else if (good) {
        good = read_colour(reader, parameter.constant, parameter.name, colour);
        used(reader, parameter.name,
             tl_format("%.3g %.3g %.3g", (double)colour[0], (double)colour[1], (double)colour[2]),
             tl_copy_string("material.diffuse"));
    }
    for (int c = 0; c < 3; c++)
        colour[c] = fminf(colour[c], 1);
    release_parameter(&parameter);
    return good;
}

/* Normals and heights, whose constants mean nothing. */
static bool read_relief(struct u3m_reader *reader, const char *key, enum tl_picture_use picture,
                        const char *use)
{
    struct parameter parameter;
    bool good = read_parameter(reader, key, &parameter);
    if (good && parameter.picture.file) {
        used(reader, parameter.name, shown(&parameter), tl_copy_string(use));
        reader->file->pictures[picture] = parameter.picture;
        parameter.picture.file = NULL;
    } else if (good && parameter.is_missing) {
        unused(reader, parameter.name, shown(&parameter), "not used: the file is missing");
    } else if (good) {
        unused(reader, parameter.name, brief(parameter.constant), "not used: a constant changes nothing");
    }
    release_parameter(&parameter);
    return good;
}

static const struct {
    const char *key, *why;
} not_used[] = {
    {"shader", "not used: the principled model is the only one"},
    {"ior", "not used: reflectance follows from specular_value"},
    {"specular_tint", "not used: the gloss of what is no metal is white"},
    {"clearcoat_normal", "not used: the coat follows the cloth's own normals"},
    {"subsurface_value", "not used: light leaves cloth where it entered"},
    {"subsurface_color", "not used: light leaves cloth where it entered"},
    {"subsurface_radius", "not used: light leaves cloth where it entered"},
    {"preview", "not used: a picture for catalogues"},
};

static bool is_known(const char *key)
{
    static const char *const own[] = {"basecolor", "normal", "displacement"};
    for (size_t i = 0; i < TL_COUNT(own); i++)
        if (strcmp(own[i], key) == 0)
            return true;
    for (size_t i = 0; i < TL_COUNT(number_rules); i++)
        if (strcmp(number_rules[i].key, key) == 0)
            return true;
    return false;
}

static const char *why_not_used(const char *key)
{
    for (size_t i = 0; i < TL_COUNT(not_used); i++)
        if (strcmp(not_used[i].key, key) == 0)
            return not_used[i].why;
    return "not used: not a field of the format";
}

static void list_others(const struct u3m_reader *reader)
{
    const cJSON *child;
    cJSON_ArrayForEach(child, reader->side)
    {
        if (is_known(child->string))
            continue;
        const cJSON *texture = cJSON_GetObjectItemCaseSensitive(child, "texture");
        const cJSON *constant = cJSON_GetObjectItemCaseSensitive(child, "constant");
        char *name = tl_format("material.%s.%.*s", reader->side_name, NAME_MAX_BYTES, child->string);
        unused(reader, name,
               is_given(texture) ? tl_copy_string("a texture") : brief(constant ? constant : child),
               why_not_used(child->string));
        free(name);
    }
}

static bool read_front(struct u3m_reader *reader)
{
    reader->file->has_surface = true;
    if (!read_basecolor(reader))
        return false;
    for (size_t i = 0; i < TL_COUNT(number_rules); i++)
        if (!read_number_field(reader, &number_rules[i]))
            return false;
    if (!read_relief(reader, "normal", TL_PICTURE_NORMAL, "the normals of the cloth") ||
        !read_relief(reader, "displacement", TL_PICTURE_HEIGHT,
                     "heights, taken for millimetres: relief and its shadows"))
        return false;
    list_others(reader);
    return true;
}

/* The back has a colour only. */
static bool read_back(struct u3m_reader *reader)
{
    struct parameter parameter;
    bool good = read_parameter(reader, "basecolor", &parameter);
    for (int c = 0; c < 3; c++)
        reader->file->back[c] = 1;
    if (good && parameter.picture.file) {
        used(reader, parameter.name, shown(&parameter), tl_copy_string("material.back: its mean colour"));
        reader->file->back_picture = parameter.picture;
        parameter.picture.file = NULL;
    } else if (good && parameter.is_missing) {
        unused(reader, parameter.name, shown(&parameter),
               "not used: the file is missing; the back is as the front");
    } else if (good) {
        good = read_colour(reader, parameter.constant, parameter.name, reader->file->back);
        used(reader, parameter.name, brief(parameter.constant), tl_copy_string("material.back"));
    }
    reader->file->has_back = good && !parameter.is_missing;
    release_parameter(&parameter);
    const cJSON *child;
    cJSON_ArrayForEach(child, reader->side)
    {
        if (strcmp(child->string, "basecolor") == 0)
            continue;
        char *name = tl_format("material.%s.%.*s", reader->side_name, NAME_MAX_BYTES, child->string);
        unused(reader, name, brief(child), "not used: the back differs from the front in colour only");
        free(name);
    }
    return good;
}

/* ---- Physics ---- */

static bool read_measure(const struct u3m_reader *reader, const cJSON *physics, const char *key, double scale,
                         double *out, const char *use)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(physics, key);
    char *name = tl_format("material.physics.%s", key);
    float number = 0;
    bool good = read_number(reader, value, name, 1e-6, 1e6, &number);
    if (good && is_given(value)) {
        *out = scale * (double)number;
        used(reader, name, brief(value), tl_copy_string(use));
    }
    free(name);
    return good;
}

/* The weave that a construction's name stands for. */
static enum tl_fabric_pattern pattern_of(const char *construction)
{
    static const struct {
        const char *begins;
        enum tl_fabric_pattern pattern;
    } known[] = {{"Twill", TL_FABRIC_PATTERN_TWILL},       {"Satin", TL_FABRIC_PATTERN_SATIN},
                 {"Plain weave", TL_FABRIC_PATTERN_PLAIN}, {"Poplin", TL_FABRIC_PATTERN_PLAIN},
                 {"Canvas", TL_FABRIC_PATTERN_PLAIN},      {"TafFeta", TL_FABRIC_PATTERN_PLAIN}};
    for (size_t i = 0; i < TL_COUNT(known); i++)
        if (strncmp(construction, known[i].begins, strlen(known[i].begins)) == 0)
            return known[i].pattern;
    return TL_FABRIC_PATTERN_NONE;
}

static void read_construction(const struct u3m_reader *reader, const cJSON *construction)
{
    const cJSON *type = cJSON_GetObjectItemCaseSensitive(construction, "type");
    if (!is_given(construction))
        return;
    enum tl_fabric_pattern pattern =
        cJSON_IsString(type) ? pattern_of(type->valuestring) : TL_FABRIC_PATTERN_NONE;
    const char *name = "material.physics.construction";
    if (pattern == TL_FABRIC_PATTERN_NONE)
        unused(reader, name, brief(type), "not used: no weave of this kind is generated");
    else if (tl_fabric_file_has_pictures(reader->file))
        unused(reader, name, brief(type), "not used: the pictures show the weave");
    else
        used(reader, name, brief(type), tl_copy_string("weave.pattern"));
    if (!tl_fabric_file_has_pictures(reader->file))
        reader->file->pattern = pattern;
}

static bool read_fab(struct u3m_reader *reader, const cJSON *physics)
{
    const cJSON *fab =
        cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(physics, "devices"), "fab");
    if (!cJSON_IsString(fab) || strcmp(fab->valuestring, "null") == 0)
        return true;
    char *name = tl_format("%s%s", reader->folder, fab->valuestring);
    enum tl_store_found state = tl_store_find(&reader->file->store, name, reader->error);
    bool good =
        state != TL_STORE_REFUSED || fail_outside(reader, "material.physics.devices.fab", fab->valuestring);
    if (state == TL_STORE_MISSING) {
        unused(reader, "material.physics.devices.fab", brief(fab), "not used: the file is missing");
        tl_fabric_add_missing(reader->file, name);
    } else if (good) {
        used(reader, "material.physics.devices.fab", brief(fab),
             tl_copy_string("stretch, shear and bending, below"));
        good = tl_fab_read(reader->file, name, "fab.", reader->error);
    }
    free(name);
    return good;
}

static bool read_physics(struct u3m_reader *reader, const cJSON *physics)
{
    struct tl_fabric_physics *out = &reader->file->physics;
    if (!is_given(physics))
        return true;
    if (!cJSON_IsObject(physics))
        return fail_type(reader, "material.physics", "an object or null");
    if (!read_measure(reader, physics, "weight", 1e-3, &out->weight_kg_m2, "fabric.areal_density") ||
        !read_measure(reader, physics, "thickness", 1e-3, &out->thickness_m, "construction.thickness_mm"))
        return false;
    read_construction(reader, cJSON_GetObjectItemCaseSensitive(physics, "construction"));
    const cJSON *child;
    cJSON_ArrayForEach(child, physics)
    {
        static const char *const known[] = {"weight", "thickness", "construction", "devices"};
        bool is_read = false;
        for (size_t i = 0; i < TL_COUNT(known); i++)
            is_read = is_read || strcmp(known[i], child->string) == 0;
        char *name = tl_format("material.physics.%.*s", NAME_MAX_BYTES, child->string);
        if (!is_read && is_given(child))
            unused(reader, name, brief(child), "not used: words for people");
        free(name);
    }
    return read_fab(reader, physics);
}

/* ---- The file ---- */

static bool read_side(struct u3m_reader *reader, const cJSON *material, const char *name,
                      bool (*read)(struct u3m_reader *))
{
    reader->side = cJSON_GetObjectItemCaseSensitive(material, name);
    reader->side_name = name;
    if (!is_given(reader->side))
        return true;
    return cJSON_IsObject(reader->side) ? read(reader) : fail_type(reader, name, "an object or null");
}

/* The front, or what the format has in its place: the back, or else the side. */
static bool read_sides(struct u3m_reader *reader, const cJSON *material)
{
    static const char *const sides[] = {"front", "back", "side"};
    const char *front = NULL;
    for (size_t i = 0; i < TL_COUNT(sides) && !front; i++)
        if (is_given(cJSON_GetObjectItemCaseSensitive(material, sides[i])))
            front = sides[i];
    if (front && !read_side(reader, material, front, read_front))
        return false;
    if (front && strcmp(front, "front") == 0 && !read_side(reader, material, "back", read_back))
        return false;
    const cJSON *side = cJSON_GetObjectItemCaseSensitive(material, "side");
    if (is_given(side) && front && strcmp(front, "side") != 0)
        unused(reader, "material.side", brief(side), "not used: edges have the front's colour");
    return true;
}

static void list_head(const struct u3m_reader *reader, const cJSON *root, const cJSON *material)
{
    static const char *const words[] = {"id", "description", "created", "modified", "metadata"};
    const cJSON *custom = cJSON_GetObjectItemCaseSensitive(root, "custom");
    for (size_t i = 0; i < TL_COUNT(words); i++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(material, words[i]);
        char *name = tl_format("material.%s", words[i]);
        if (is_given(value))
            unused(reader, name, brief(value), "not used: words for people");
        free(name);
    }
    if (is_given(custom))
        unused(reader, "custom", brief(custom), "not used: other companies' own sections are not read");
}

static bool read_root(struct u3m_reader *reader, const cJSON *root)
{
    const cJSON *schema = cJSON_GetObjectItemCaseSensitive(root, "schema");
    const cJSON *material = cJSON_GetObjectItemCaseSensitive(root, "material");
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(material, "name");
    if (!cJSON_IsString(schema) || !cJSON_IsObject(material))
        return tl_fail(reader->error, TL_INPUT, "%s: is no U3M file: expected \"schema\" and \"material\"",
                       reader->place);
    bool known = strcmp(schema->valuestring, "1.0") == 0 || strcmp(schema->valuestring, "1.1") == 0;
    used(reader, "schema", brief(schema),
         tl_copy_string(known ? "the format" : "read as 1.1, which it is not"));
    if (cJSON_IsString(name) && name->valuestring[0])
        used(reader, "material.name", brief(name), tl_copy_string("the fabric's name"));
    if (!read_sides(reader, material) ||
        !read_physics(reader, cJSON_GetObjectItemCaseSensitive(material, "physics")))
        return false;
    list_head(reader, root, material);
    const struct tl_fabric_physics *physics = &reader->file->physics;
    bool has_any = reader->file->has_surface || !isnan(physics->weight_kg_m2) ||
                   !isnan(physics->thickness_m) || !isnan(physics->stretch_weft);
    return has_any || tl_fail(reader->error, TL_INPUT, "%s: has neither a front nor physics: write it again",
                              reader->place);
}

bool tl_u3m_read(tl_fabric_file *file, const char *name, tl_error *error)
{
    cJSON *root = tl_fabric_parse_json(&file->store, name, error);
    const char *slash = strrchr(name, '/');
    if (!root)
        return false;
    struct u3m_reader reader = {.file = file,
                                .place = tl_store_place(&file->store, name),
                                .folder = tl_format("%.*s", slash ? (int)(slash + 1 - name) : 0, name),
                                .error = error};
    bool read = read_root(&reader, root);
    const cJSON *title =
        cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(root, "material"), "name");
    if (read && cJSON_IsString(title) && title->valuestring[0])
        tl_fabric_set_name(file, title->valuestring);
    free(reader.place);
    free(reader.folder);
    cJSON_Delete(root);
    return read;
}
