#include "app/lab/gallery/gallery.h"
#include "app/report/cells.h"
#include "app/report/report.h"

#include <math.h>
#include <string.h>

/* The heading after its id. */
static const char *technique_of(const struct tl_gallery_wall *wall)
{
    const char *space = strstr(wall->heading, "  ");
    return space ? space + 2 : wall->heading;
}

static double worse(const double values[TL_GALLERY_OBJECTS])
{
    return fmax(values[TL_GALLERY_SOLID], values[TL_GALLERY_SHEET]);
}

static void print_field(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"')
            fputc('"', out);
        fputc(*text, out);
    }
    fputs("\",", out);
}

void tl_gallery_write_csv(const struct tl_gallery *gallery, FILE *out)
{
    fputs("id,technique,setting,error,error_metric,time_ms,image\n", out);
    for (size_t i = 0; i < gallery->count; i++) {
        const struct tl_hung *hung = &gallery->items[i];
        fprintf(out, "%s,", hung->exhibit->id);
        print_field(out, technique_of(hung->wall));
        print_field(out, hung->exhibit->setting);
        fprintf(out, "%.6g,%s,%.3f,%s\n", worse(hung->error), hung->wall->by_flip ? "flip_mean" : "rel_rmse",
                worse(hung->time_ms), hung->image);
    }
}

static void print_error(const struct tl_hung *hung, int object, char *text, size_t size)
{
    if (hung->wall->by_flip)
        snprintf(text, size, "FLIP %.3f", hung->error[object]);
    else
        snprintf(text, size, "%.3g %%", 100 * hung->error[object]);
}

static void print_caption(const struct tl_hung *hung, char *text, size_t size)
{
    char errors[TL_GALLERY_OBJECTS][32];
    for (int i = 0; i < TL_GALLERY_OBJECTS; i++)
        print_error(hung, i, errors[i], sizeof errors[i]);
    snprintf(text, size, "error %s on the %s, %s on the sheet; %.1f and %.1f ms CPU",
             errors[TL_GALLERY_SOLID], hung->wall->solid, errors[TL_GALLERY_SHEET],
             hung->time_ms[TL_GALLERY_SOLID], hung->time_ms[TL_GALLERY_SHEET]);
}

static size_t print_wall(const struct tl_gallery *gallery, size_t first, FILE *out)
{
    const struct tl_gallery_wall *wall = gallery->items[first].wall;
    tl_report_heading(out, wall->heading);
    tl_report_paragraph(out, wall->text);
    tl_report_pictures_begin(out);
    size_t i = first;
    for (; i < gallery->count && gallery->items[i].wall == wall; i++) {
        const struct tl_hung *hung = &gallery->items[i];
        char caption[200];
        print_caption(hung, caption, sizeof caption);
        tl_report_picture(out, hung->png, hung->png_size, hung->exhibit->setting, caption);
    }
    tl_report_pictures_end(out);
    if (wall->figures)
        wall->figures(out);
    return i;
}

void tl_gallery_write_html(const struct tl_gallery *gallery, FILE *out)
{
    char subtitle[300];
    snprintf(
        subtitle, sizeof subtitle,
        "toile gallery: %zu settings, each on a solid and on a draped sheet of %d x %d pixels; below each "
        "picture what differs from the exact evaluation, eight times as bright%s",
        gallery->count, gallery->side, gallery->side,
        gallery->complete ? "" : "; interrupted: what was drawn until then");
    tl_report_begin(out, "The gallery of techniques", subtitle);
    tl_report_paragraph(
        out, "Errors are relative RMSE over covered pixels against what the wall's text names as exact. "
             "Times are process CPU time of a whole frame, all threads, in this one run: compare them "
             "with one another, not with other machines.");
    for (size_t i = 0; i < gallery->count;)
        i = print_wall(gallery, i, out);
    tl_report_end(out);
}
