#include "app/fabric/fabric.h"
#include "app/settings/imported.h"
#include "assets/fabric/fabric_maps.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/intern.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define PICTURE_BYTES_MAX ((size_t)512 << 20)

/* Destinations of the parts of a fabric. */
struct target {
    char *options;        /* the file of options */
    char *pictures;       /* the folder of pictures */
    const char *relative; /* ... as seen from the file of options */
};

static struct target target_of(const char *path)
{
    size_t length = strlen(path);
    if (!tl_path_has_extension(path, "yaml") && !tl_path_has_extension(path, "yml"))
        return (struct target){tl_format("%s/%s", path, TL_FABRIC_OWN_FILE), tl_copy_string(path), "."};
    const char *slash = strrchr(path, '/');
    char *folder = tl_format("%.*s_pictures", (int)(strrchr(path, '.') - path), path);
    return (struct target){tl_format("%.*s", (int)length, path), folder,
                           folder + (slash ? slash + 1 - path : 0)};
}

static void release_target(struct target *target)
{
    free(target->options);
    free(target->pictures);
}

static bool write_bytes(const char *path, const char *data, size_t size, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    fwrite(data, 1, size, writer.stream); /* the stream remembers a failure until the commit */
    return tl_writer_commit(&writer, error);
}

/* The name that states how to read a picture; NULL when none does, because it has a factor or another rule. */
static const char *plain_name(const struct tl_fabric_picture *picture, enum tl_picture_use use)
{
    bool is_plain = picture->mode == TL_PICTURE_MULTIPLY && picture->offset == 0 && picture->factor[0] == 1 &&
                    picture->factor[1] == 1 && picture->factor[2] == 1;
    bool is_scaled = use == TL_PICTURE_HEIGHT && picture->factor[0] > 0; /* weave.depth_mm has the scale */
    if (!is_plain && !is_scaled)
        return NULL;
    return picture->channel >= 0  ? "orm"
           : picture->is_inverted ? "gloss"
           : picture->is_y_down   ? "normal_dx"
                                  : tl_picture_names[use];
}

static bool copy_picture(const tl_fabric_file *file, const struct tl_fabric_picture *picture,
                         const char *name, const struct target *target, tl_error *error)
{
    char *data;
    size_t size;
    const char *extension = strrchr(picture->file, '.');
    if (!tl_store_read(&file->store, picture->file, PICTURE_BYTES_MAX, &data, &size, error))
        return false;
    char *path = tl_format("%s/%s%s", target->pictures, name, extension ? extension : "");
    bool written = write_bytes(path, data, size, error);
    free(path);
    free(data);
    return written;
}

static bool convert_picture(const tl_fabric_file *file, enum tl_picture_use use, const struct target *target,
                            tl_error *error)
{
    tl_image image;
    if (!tl_fabric_maps_bake(file, use, &image, error))
        return false;
    char *path = tl_format("%s/%s.png", target->pictures, tl_picture_names[use]);
    bool written = tl_image_save_png(path, &image, error);
    free(path);
    tl_image_release(&image);
    return written;
}

static bool write_pictures(const tl_fabric_file *file, const struct target *target, tl_error *error)
{
    bool written = tl_folder_make(target->pictures, error), packed = false;
    for (int use = 0; written && use < TL_PICTURE_USES; use++) {
        const struct tl_fabric_picture *picture = &file->pictures[use];
        const char *name = picture->file ? plain_name(picture, use) : NULL;
        if (!picture->file || (name && picture->channel >= 0 && packed))
            continue;
        packed = packed || (name && picture->channel >= 0);
        written = name ? copy_picture(file, picture, name, target, error)
                       : convert_picture(file, use, target, error);
    }
    return written;
}

/* The picture of heights of a fabric made of options. */
static bool write_heights(struct tl_weave_params *weave, const struct target *target, tl_error *error)
{
    char *data, *path;
    size_t size;
    const char *extension = strrchr(weave->picture, '.');
    if (!tl_folder_make(target->pictures, error) || !tl_file_read(weave->picture, &data, &size, error))
        return false;
    path = tl_format("%s/relief%s", target->pictures, extension);
    bool written = write_bytes(path, data, size, error);
    char *relative = tl_format("%s/relief%.16s", target->relative, extension);
    weave->picture = tl_intern(relative);
    free(relative);
    free(path);
    free(data);
    return written;
}

static bool write_weave(struct tl_weave_params *weave, const struct target *target, tl_error *error)
{
    tl_fabric_file file;
    if (tl_text_is_given(weave->pictures)) {
        if (!tl_fabric_file_open(weave->pictures, &file, error))
            return false;
        bool written = write_pictures(&file, target, error);
        tl_fabric_file_release(&file);
        weave->pictures = tl_intern(target->relative);
        return written;
    }
    return !tl_text_is_given(weave->picture) || write_heights(weave, target, error);
}

static bool write_options(struct tl_fabric *fabric, const struct target *target, tl_error *error)
{
    struct tl_writer writer;
    struct tl_binding bindings[TL_FABRIC_TABLES];
    if (!tl_writer_begin(&writer, target->options, error))
        return false;
    fprintf(writer.stream, "# Written by toile fabric; --fabric takes this file.\n");
    tl_fabric_bind(fabric, bindings);
    tl_options_print_yaml(bindings, TL_FABRIC_TABLES, writer.stream);
    return tl_writer_commit(&writer, error);
}

bool tl_fabric_write(struct tl_fabric *fabric, const char *path, tl_error *error)
{
    struct target target = target_of(path);
    const struct tl_weave_params kept = fabric->weave;
    bool own = strcmp(target.relative, ".") == 0;
    bool written = (!own || tl_folder_make(target.pictures, error)) &&
                   write_weave(&fabric->weave, &target, error) && write_options(fabric, &target, error);
    fabric->weave = kept;
    if (written)
        tl_info("%s: use it with --fabric %s%s", target.options, own ? path : target.options,
                own && path[strlen(path) - 1] != '/' ? "/" : "");
    release_target(&target);
    return written;
}
