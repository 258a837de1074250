#include "app/sheet/contact_names.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

void tl_names_add(struct tl_names *names, char *item)
{
    names->items = tl_resize(names->items, names->count + 1, sizeof(char *));
    names->items[names->count++] = item;
}

void tl_names_release(struct tl_names *names)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->items[i]);
    free((void *)names->items);
    *names = (struct tl_names){0};
}

bool tl_names_read(const char *flag, const char *text, const char *otherwise, struct tl_names *out,
                   tl_error *error)
{
    *out = (struct tl_names){0};
    if (!text) {
        tl_names_add(out, tl_copy_string(otherwise));
        return true;
    }
    for (const char *from = text; from; from = strchr(from, ',') ? strchr(from, ',') + 1 : NULL) {
        char *item = tl_format("%.*s", (int)strcspn(from, ","), from);
        bool again = false;
        for (size_t i = 0; i < out->count; i++)
            again = again || strcmp(out->items[i], item) == 0;
        tl_names_add(out, item);
        if (item[0] != '\0' && !again)
            continue;
        tl_fail(error, TL_USAGE,
                again ? "%s: \"%s\" is named twice: remove one"
                      : "%s: \"%s\": expected names with commas between them",
                flag, again ? item : text);
        tl_names_release(out);
        return false;
    }
    return true;
}

char *tl_contact_plain(const char *text, size_t length)
{
    char *slug = tl_format("%.*s", (int)length, text);
    for (char *letter = slug; *letter; letter++) {
        unsigned char byte = (unsigned char)*letter;
        *letter = isalnum(byte) && byte < 0x80 ? (char)tolower(byte) : byte == '.' ? '.' : '-';
    }
    return slug;
}

char *tl_contact_slug(const char *text)
{
    const char *slash = strrchr(text, '/'), *last = slash ? slash + 1 : text;
    static const char *const extensions[] = {"glb", "gltf", "obj", "ply",  "stl",
                                             "off", "exr",  "hdr", "yaml", "yml"};
    size_t length = strlen(last);
    for (size_t i = 0; i < TL_COUNT(extensions); i++)
        if (tl_path_has_extension(last, extensions[i]))
            length = (size_t)(strrchr(last, '.') - last);
    return tl_contact_plain(last, length);
}

char *tl_contact_label_of(const char *name)
{
    const char *slash = strrchr(name, '/');
    return tl_copy_string(slash ? slash + 1 : name);
}

static bool is_taken(char **const *slugs, size_t count, const char *slug)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(*slugs[i], slug) == 0)
            return true;
    return false;
}

void tl_contact_make_unique(char **const *slugs, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        char *slug = tl_copy_string(*slugs[i]);
        for (int number = 2; is_taken(slugs, i, slug); number++) {
            free(slug);
            slug = tl_format("%s-%d", *slugs[i], number);
        }
        free(*slugs[i]);
        *slugs[i] = slug;
    }
}
