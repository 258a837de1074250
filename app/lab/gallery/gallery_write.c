#include "app/lab/gallery/gallery.h"
#include "app/lab/gallery/gallery_figures.h"
#include "app/lab/gallery/gallery_times.h"
#include "app/lab/gallery/shots.h"
#include "app/lab/gallery/words.h"
#include "app/report/report.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
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
        fprintf(out, "%.6g,%s,%.3f,%s\n", worse(entry->figures.error),
                entry->picture.experiment->by_flip ? "flip_mean" : "rel_rmse", worse(entry->figures.time_ms),
                entry->image);
    }
}

static void print_caption(const struct tl_gallery_entry *entry, char *text, size_t size)
{
    const struct tl_gallery_figures *figures = &entry->figures;
    const struct tl_experiment *experiment = entry->picture.experiment;
    char *solid = tl_words_error(experiment, figures->error[TL_PICTURE_SOLID]),
         *sheet = tl_words_error(experiment, figures->error[TL_PICTURE_SHEET]);
    snprintf(text, size, "%s %s on the %s, %s on the sheet; %.1f and %.1f ms CPU%s",
             experiment->exact == TL_EXACT_NONE ? "difference" : "error", solid, experiment->solid, sheet,
             figures->time_ms[TL_PICTURE_SOLID], figures->time_ms[TL_PICTURE_SHEET],
             entry->kept ? " (of an earlier run)" : "");
    free(solid);
    free(sheet);
}

static void print_sentence(FILE *out, char *text)
{
    if (text)
        tl_report_paragraph(out, text);
    free(text);
}

/* What the exact picture is, or why there is none. */
static void print_exact(const struct tl_experiment *section, FILE *out)
{
    print_sentence(out, section->exact == TL_EXACT_NONE
                            ? tl_format("No exact picture: %s.", section->exact_text)
                            : tl_format("Exact picture: %s.", section->exact_text));
}

static void print_sentences(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                            FILE *out)
{
    const struct tl_experiment *section = first->picture.experiment;
    int appearances = section->appearance_count ? section->appearance_count : 1;
    for (int a = 0; a < appearances; a++)
        for (int object = 0; object < TL_PICTURE_OBJECTS; object++)
            print_sentence(out, tl_words_order(first, end, (enum tl_picture_object)object,
                                               section->appearances ? section->appearances + a : NULL));
    for (int i = 0; i < TL_EXPERIMENT_CLAIMS && section->claims[i].nearer; i++)
        print_sentence(out, tl_words_claim(first, end, &section->claims[i]));
}

static void print_entry(const struct tl_gallery_entry *entry, FILE *out)
{
    struct tl_report_file file = {.name = entry->image};
    char caption[200];
    print_caption(entry, caption, sizeof caption);
    tl_panels_size(TL_PICTURE_OBJECTS, tl_shots_side(entry->picture.experiment), &file.width, &file.height);
    tl_report_wide_picture(out, &file, entry->setting, caption);
    if (!entry->strip)
        return;
    char *motion = tl_words_motion(entry);
    file.name = entry->strip;
    tl_panels_strip_size(TL_STRIP_FRAMES, TL_STRIP_SIDE, &file.width, &file.height);
    tl_report_wide_picture(out, &file, "in motion", motion);
    free(motion);
}

static size_t print_section(const struct tl_gallery *gallery, size_t first, FILE *out)
{
    const struct tl_experiment *section = gallery->entries[first].picture.experiment;
    size_t end = first;
    while (end < gallery->count && gallery->entries[end].picture.experiment == section)
        end++;
    tl_report_heading(out, section->title);
    tl_report_paragraph(out, section->text);
    print_exact(section, out);
    print_sentences(gallery->entries + first, gallery->entries + end, out);
    for (size_t i = first; i < end; i++)
        print_entry(&gallery->entries[i], out);
    if (strcmp(section->name, "d10") == 0)
        tl_gallery_write_times(gallery->entries + first, gallery->entries + end, out);
    tl_gallery_write_figures(section->name, out);
    return end;
}

void tl_gallery_write_html(const struct tl_gallery *gallery, FILE *out)
{
    char subtitle[300];
    snprintf(subtitle, sizeof subtitle,
             "toile gallery: %zu settings, each on a solid and on a draped sheet: the exact picture, the "
             "technique, their difference, and where they differ most%s",
             gallery->count, gallery->complete ? "" : "; interrupted: what was drawn until then");
    tl_report_begin(out, "The gallery of techniques", subtitle);
    tl_report_paragraph(
        out,
        "Errors are relative RMSE over covered pixels, or mean FLIP where edges matter, against the exact "
        "picture that each section names. Each difference has a scale of its own, in linear radiance: the "
        "largest of the three channels. Times are process CPU time of a whole frame, all threads: compare "
        "them with one another within one run, not with other machines. Sentences that compare are made "
        "from the figures.");
    for (size_t i = 0; i < gallery->count;)
        i = print_section(gallery, i, out);
    tl_report_end(out);
}
