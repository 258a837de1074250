/* Texture maps by their names, as ambientCG, Poly Haven, MaterialX and Substance have them: what a picture is
 * stands at the end of its name, before its size and its convention. fabric_004_nor_gl_1k.png,
 * Fabric061_2K-JPG_NormalGL.jpg, cloth_baseColor.png. */
#include "assets/fabric/fabric_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum packed { PACKED = TL_PICTURE_USES }; /* occlusion, roughness and metalness in red, green and blue */

struct word {
    const char *word;
    int use; /* enum tl_picture_use, or PACKED */
    bool is_inverted, is_y_down;
};

/* Without capitals, separators and the ends that `shorten` removes. Longer words stand before those that they
 * end in. */
static const struct word words[] = {
    {"basecolor", TL_PICTURE_COLOUR, false, false},
    {"basecolour", TL_PICTURE_COLOUR, false, false},
    {"albedo", TL_PICTURE_COLOUR, false, false},
    {"diffuse", TL_PICTURE_COLOUR, false, false},
    {"diff", TL_PICTURE_COLOUR, false, false},
    {"color", TL_PICTURE_COLOUR, false, false},
    {"colour", TL_PICTURE_COLOUR, false, false},
    {"normaldirectx", TL_PICTURE_NORMAL, false, true},
    {"normaldx", TL_PICTURE_NORMAL, false, true},
    {"nordx", TL_PICTURE_NORMAL, false, true},
    {"normalopengl", TL_PICTURE_NORMAL, false, false},
    {"normalgl", TL_PICTURE_NORMAL, false, false},
    {"normalogl", TL_PICTURE_NORMAL, false, false},
    {"norgl", TL_PICTURE_NORMAL, false, false},
    {"normal", TL_PICTURE_NORMAL, false, false},
    {"normals", TL_PICTURE_NORMAL, false, false},
    {"nrm", TL_PICTURE_NORMAL, false, false},
    {"nor", TL_PICTURE_NORMAL, false, false},
    {"roughness", TL_PICTURE_ROUGHNESS, false, false},
    {"rough", TL_PICTURE_ROUGHNESS, false, false},
    {"glossiness", TL_PICTURE_ROUGHNESS, true, false},
    {"gloss", TL_PICTURE_ROUGHNESS, true, false},
    {"smoothness", TL_PICTURE_ROUGHNESS, true, false},
    {"metalness", TL_PICTURE_METALNESS, false, false},
    {"metallic", TL_PICTURE_METALNESS, false, false},
    {"metal", TL_PICTURE_METALNESS, false, false},
    {"ambientocclusion", TL_PICTURE_OCCLUSION, false, false},
    {"occlusion", TL_PICTURE_OCCLUSION, false, false},
    {"ao", TL_PICTURE_OCCLUSION, false, false},
    {"height", TL_PICTURE_HEIGHT, false, false},
    {"displacement", TL_PICTURE_HEIGHT, false, false},
    {"disp", TL_PICTURE_HEIGHT, false, false},
    {"depth", TL_PICTURE_HEIGHT, false, false},
    {"bump", TL_PICTURE_HEIGHT, false, false},
    {"opacity", TL_PICTURE_OPACITY, false, false},
    {"alpha", TL_PICTURE_OPACITY, false, false},
    {"mask", TL_PICTURE_OPACITY, false, false},
    {"orm", PACKED, false, false},
    {"arm", PACKED, false, false},
    {"occlusionroughnessmetallic", PACKED, false, false},
};

static bool is_picture(const char *name)
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "tif", "tiff"};
    for (size_t i = 0; i < TL_COUNT(extensions); i++)
        if (tl_path_has_extension(name, extensions[i]))
            return true;
    return false;
}

/* Letters and digits of the name without folder and extension, in lower case; `cuts` has a bit where a part
 * begins after a separator or at a capital. */
static char *plain_of(const char *name, char **starts)
{
    const char *slash = strrchr(name, '/'), *base = slash ? slash + 1 : name, *dot = strrchr(base, '.');
    size_t length = dot ? (size_t)(dot - base) : strlen(base), count = 0;
    char *plain = TL_NEW_ARRAY(char, length + 1);
    *starts = TL_NEW_ARRAY(char, length + 1);
    bool begins = true;
    for (size_t i = 0; i < length; i++) {
        unsigned char letter = (unsigned char)base[i];
        if (!isalnum(letter)) {
            begins = true;
            continue;
        }
        bool capital = isupper(letter) && i > 0 && islower((unsigned char)base[i - 1]);
        (*starts)[count] = begins || capital;
        plain[count++] = (char)tolower(letter);
        begins = false;
    }
    return plain;
}

/* Removes sizes and file kinds from the end: "1k", "2048", "jpg", "png", "srgb". */
static void shorten(char *plain)
{
    static const char *const ends[] = {"jpg", "png", "tif", "exr", "srgb", "linear", "raw", "8bit", "16bit"};
    for (bool again = true; again;) {
        size_t length = strlen(plain), kept = length;
        again = false;
        for (size_t i = 0; i < TL_COUNT(ends); i++) {
            size_t end = strlen(ends[i]);
            if (length > end && strcmp(plain + length - end, ends[i]) == 0)
                kept = length - end;
        }
        if (kept == length && length > 1 &&
            (plain[length - 1] == 'k' && isdigit((unsigned char)plain[length - 2])))
            kept--;
        while (kept > 0 && isdigit((unsigned char)plain[kept - 1]))
            kept--;
        again = kept < length;
        plain[kept] = '\0';
    }
}

static const struct word *word_of(const char *name)
{
    char *starts, *plain = plain_of(name, &starts);
    const struct word *found = NULL;
    shorten(plain);
    size_t length = strlen(plain);
    for (size_t i = 0; i < TL_COUNT(words) && !found; i++) {
        size_t end = strlen(words[i].word);
        if (length >= end && strcmp(plain + length - end, words[i].word) == 0 && starts[length - end])
            found = &words[i];
    }
    free(plain);
    free(starts);
    return found;
}

static void use_picture(tl_fabric_file *file, const char *name, int use, int channel, const struct word *word)
{
    struct tl_fabric_picture *picture = &file->pictures[use];
    *picture = tl_picture_plain(tl_copy_string(name));
    picture->channel = channel;
    picture->is_inverted = word && word->is_inverted;
    picture->is_y_down = word && word->is_y_down;
}

static void list(tl_fabric_file *file, const char *name, bool is_used, char *use)
{
    tl_fabric_add_field(file, name, tl_copy_string("picture"), is_used, use);
}

/* Takes a picture whose normals' y is as asked. Those of OpenGL are asked for first: they are the program's
 * own. */
static void take(tl_fabric_file *file, const char *name, bool y_down)
{
    const struct word *word = word_of(name);
    if (!word || word->use == PACKED || word->is_y_down != y_down)
        return;
    const char *const use = tl_picture_names[word->use];
    const struct tl_fabric_picture *picture = &file->pictures[word->use];
    if (picture->file) {
        list(file, name, false, tl_format("not used: \"%s\" is the %s, too", picture->file, use));
        return;
    }
    use_picture(file, name, word->use, -1, word);
    list(file, name, true,
         tl_format("%s%s%s", use, word->is_inverted ? ", from gloss" : "",
                   y_down ? ", y down (DirectX)" : ""));
}

static void leave(struct tl_fabric_picture *picture)
{
    free(picture->file);
    *picture = (struct tl_fabric_picture){0};
}

/* Channels by which nothing is hidden and all is metal were not filled: no cloth is metal throughout. */
static bool leave_unfilled(tl_fabric_file *file, const char *name)
{
    struct tl_fabric_picture *occlusion = &file->pictures[TL_PICTURE_OCCLUSION],
                             *metalness = &file->pictures[TL_PICTURE_METALNESS];
    bool are_packed = occlusion->file && metalness->file && strcmp(occlusion->file, name) == 0 &&
                      strcmp(metalness->file, name) == 0;
    if (!are_packed || !tl_fabric_maps_are_white(file, name, occlusion->channel) ||
        !tl_fabric_maps_are_white(file, name, metalness->channel))
        return false;
    leave(occlusion);
    leave(metalness);
    return true;
}

static void take_packed(tl_fabric_file *file, const char *name)
{
    static const int uses[] = {TL_PICTURE_OCCLUSION, TL_PICTURE_ROUGHNESS, TL_PICTURE_METALNESS};
    const struct word *word = word_of(name);
    if (!word || word->use != PACKED)
        return;
    int taken = 0;
    for (int channel = 0; channel < (int)TL_COUNT(uses); channel++)
        if (!file->pictures[uses[channel]].file) {
            use_picture(file, name, uses[channel], channel, NULL);
            taken++;
        }
    const char *use = taken == 0 ? "not used: other pictures have occlusion, roughness and metalness"
                      : leave_unfilled(file, name)
                          ? "roughness; occlusion and metalness are white throughout: not filled"
                          : "occlusion, roughness and metalness, where no picture of its own has them";
    list(file, name, taken > 0, tl_copy_string(use));
}

/* A picture whose name has no meaning is the colour, if it is the only one of its kind. */
static void take_rest(tl_fabric_file *file)
{
    const tl_store *store = &file->store;
    size_t unknown = 0;
    for (size_t i = 0; i < store->count; i++)
        unknown += is_picture(store->names[i]) && !word_of(store->names[i]);
    for (size_t i = 0; i < store->count; i++) {
        const char *name = store->names[i];
        bool picture = is_picture(name);
        if (picture && word_of(name))
            continue;
        if (picture && unknown == 1 && !file->pictures[TL_PICTURE_COLOUR].file) {
            use_picture(file, name, TL_PICTURE_COLOUR, -1, NULL);
            list(file, name, true, tl_copy_string("colour: the only picture without a known name"));
        } else if (picture) {
            list(file, name, false, tl_copy_string("not used: its name does not state what it is"));
        } else {
            tl_fabric_add_field(file, name, tl_copy_string("file"), false,
                                tl_copy_string("not used: is no PNG, JPEG or TIFF"));
        }
    }
}

bool tl_map_names_read(tl_fabric_file *file, tl_error *error)
{
    const tl_store *store = &file->store;
    for (int y_down = 0; y_down < 2; y_down++)
        for (size_t i = 0; i < store->count; i++)
            if (is_picture(store->names[i]))
                take(file, store->names[i], y_down);
    for (size_t i = 0; i < store->count; i++)
        if (is_picture(store->names[i]))
            take_packed(file, store->names[i]);
    take_rest(file);
    if (!tl_fabric_file_has_pictures(file))
        return tl_fail(
            error, TL_INPUT,
            "%s: holds no texture maps: expected pictures named as in cloth_basecolor.png, cloth_normal.png",
            store->path);
    file->has_surface = true;
    return true;
}
