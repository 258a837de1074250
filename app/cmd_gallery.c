/* toile gallery: every technique with its error and its time, as pictures, a page and a table. */
#include "app/commands.h"
#include "app/gallery.h"
#include "config/file.h"
#include "config/memory.h"

#include <stdlib.h>

static bool write_file(const char *folder, const char *name, const struct tl_gallery *gallery,
                       void (*write)(const struct tl_gallery *, FILE *), tl_error *error)
{
    struct tl_writer writer;
    char *path = tl_format("%s/%s", folder, name);
    bool written = tl_writer_begin(&writer, path, error);
    if (written) {
        write(gallery, writer.stream);
        written = tl_writer_commit(&writer, error);
    }
    free(path);
    return written;
}

static bool write_picture(const char *folder, const struct tl_hung *hung, tl_error *error)
{
    struct tl_writer writer;
    char *path = tl_format("%s/%s", folder, hung->image);
    bool written = tl_writer_begin(&writer, path, error);
    if (written) {
        fwrite(hung->png, 1, hung->png_size, writer.stream);
        written = tl_writer_commit(&writer, error);
    }
    free(path);
    return written;
}

static bool write_all(const char *folder, const struct tl_gallery *gallery, tl_error *error)
{
    for (size_t i = 0; i < gallery->count; i++)
        if (!write_picture(folder, &gallery->items[i], error))
            return false;
    return write_file(folder, "gallery.csv", gallery, tl_gallery_write_csv, error) &&
           write_file(folder, "gallery.html", gallery, tl_gallery_write_html, error);
}

/* Interrupted, what hangs is worth as much as before. */
bool tl_command_gallery(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "gallery: no folder named: add -o FOLDER");
    if (arguments->positional_count > 1)
        return tl_fail(error, TL_USAGE, "gallery: %s: one wall at a time, or none for all",
                       arguments->positionals[1]);
    if (!tl_folder_make(arguments->output, error))
        return false;
    struct tl_gallery gallery;
    tl_error failure = {0};
    const char *only = arguments->positional_count ? arguments->positionals[0] : NULL;
    bool done = tl_gallery_draw(arguments->quick, only, &gallery, error);
    if (gallery.count && !write_all(arguments->output, &gallery, &failure)) {
        *error = failure;
        done = false;
    }
    tl_gallery_release(&gallery);
    return done;
}
