#include "app/lab/gallery/gallery.h"
#include "app/lab/gallery/gallery_figures.h"
#include "app/report/cells.h"
#include "app/report/report.h"

#include <math.h>
#include <string.h>

/* The section's title after its id. */
static const char *technique_of(const struct tl_experiment *section)
{
    const char *space = strstr(section->title, "  ");
    return space ? space + 2 : section->title;
}

static double worse(const double values[TL_PICTURE_OBJECTS])
{
    return fmax(values[TL_PICTURE_SOLID], values[TL_PICTURE_SHEET]);
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
        const struct tl_gallery_entry *entry = &gallery->entries[i];
        fprintf(out, "%s,", entry->picture.technique->id);
        print_field(out, technique_of(entry->picture.experiment));
        print_field(out, entry->setting);
        fprintf(out, "%.6g,%s,%.3f,%s\n", worse(entry->error),
                entry->picture.experiment->by_flip ? "flip_mean" : "rel_rmse", worse(entry->time_ms),
                entry->image);
    }
}

static void print_error(const struct tl_gallery_entry *entry, int object, char *text, size_t size)
{
    if (entry->picture.experiment->by_flip)
        snprintf(text, size, "FLIP %.3f", entry->error[object]);
    else
        snprintf(text, size, "%.3g %%", 100 * entry->error[object]);
}

static void print_caption(const struct tl_gallery_entry *entry, char *text, size_t size)
{
    char errors[TL_PICTURE_OBJECTS][32];
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++)
        print_error(entry, i, errors[i], sizeof errors[i]);
    snprintf(text, size, "error %s on the %s, %s on the sheet; %.1f and %.1f ms CPU",
             errors[TL_PICTURE_SOLID], entry->picture.experiment->solid, errors[TL_PICTURE_SHEET],
             entry->time_ms[TL_PICTURE_SOLID], entry->time_ms[TL_PICTURE_SHEET]);
}

static size_t print_section(const struct tl_gallery *gallery, size_t first, FILE *out)
{
    const struct tl_experiment *section = gallery->entries[first].picture.experiment;
    tl_report_heading(out, section->title);
    tl_report_paragraph(out, section->text);
    tl_report_pictures_begin(out);
    size_t i = first;
    for (; i < gallery->count && gallery->entries[i].picture.experiment == section; i++) {
        const struct tl_gallery_entry *entry = &gallery->entries[i];
        char caption[200];
        print_caption(entry, caption, sizeof caption);
        tl_report_picture(out, entry->png, entry->png_size, entry->setting, caption);
    }
    tl_report_pictures_end(out);
    tl_gallery_write_figures(section->name, out);
    return i;
}

void tl_gallery_write_html(const struct tl_gallery *gallery, FILE *out)
{
    char subtitle[300];
    snprintf(
        subtitle, sizeof subtitle,
        "toile gallery: %zu settings, each on a solid and on a draped sheet of %d x %d pixels; below each "
        "picture its difference from the exact evaluation, eight times as bright%s",
        gallery->count, gallery->side, gallery->side,
        gallery->complete ? "" : "; interrupted: what was drawn until then");
    tl_report_begin(out, "The gallery of techniques", subtitle);
    tl_report_paragraph(
        out,
        "Errors are relative RMSE over covered pixels against the reference that the section's text names. "
        "Times are process CPU time of a whole frame, all threads, in this one run: compare them "
        "with one another, not with other machines.");
    for (size_t i = 0; i < gallery->count;)
        i = print_section(gallery, i, out);
    tl_report_end(out);
}
