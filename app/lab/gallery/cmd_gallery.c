/* toile gallery: every technique with its error and its time, as pictures, a page and a table. */
#include "app/lab/gallery/commands.h"
#include "app/lab/gallery/gallery.h"
#include "app/report/folder.h"
#include "app/report/report.h"
#include "config/base/file.h"
#include "config/embedded.h"

extern const struct tl_embedded tl_embedded_gallery[]; /* gallery.js */

static void write_csv(const void *gallery, FILE *out)
{
    tl_gallery_write_csv(gallery, out);
}

static bool write_pages(const char *folder, const struct tl_gallery *gallery, tl_error *error)
{
    return tl_folder_print(folder, "gallery.csv", gallery, write_csv, error) &&
           tl_report_write(folder, "gallery.html", tl_embedded_gallery[0].data, tl_gallery_data(gallery),
                           error);
}

/* After Ctrl-C the page holds what was drawn until then; the same command continues. */
bool tl_command_gallery(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "gallery: no folder named: add -o FOLDER");
    if (arguments->positional_count > 1)
        return tl_fail(error, TL_USAGE, "gallery: %s: one section at a time, or none for all",
                       arguments->positionals[1]);
    const char *only = arguments->positional_count ? arguments->positionals[0] : NULL;
    if (!tl_gallery_has(only, error) || !tl_folder_make(arguments->output, error))
        return false;
    struct tl_gallery gallery;
    tl_error failure = {0};
    bool done = tl_gallery_draw(arguments->output, arguments->quick, only, &gallery, error);
    if (gallery.count && !write_pages(arguments->output, &gallery, &failure)) {
        *error = failure;
        done = false;
    }
    tl_gallery_release(&gallery);
    return done;
}
