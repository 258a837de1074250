/* gallery.csv, and gallery.html, which gallery.js shows. */
#include "app/lab/gallery/gallery.h"
#include "app/lab/gallery/gallery_figures.h"
#include "app/lab/gallery/shots.h"
#include "app/report/report.h"
#include "config/base/memory.h"

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

static void add_file(cJSON *object, const char *key, const char *name, int width, int height)
{
    cJSON *file = cJSON_AddObjectToObject(object, key);
    cJSON_AddStringToObject(file, "file", name);
    cJSON_AddNumberToObject(file, "width", width);
    cJSON_AddNumberToObject(file, "height", height);
}

static void add_strip(cJSON *object, const struct tl_gallery_entry *entry)
{
    int width, height;
    if (!entry->strip)
        return;
    tl_panels_strip_size(TL_STRIP_FRAMES, TL_STRIP_SIDE, &width, &height);
    add_file(object, "strip", entry->strip, width, height);
    cJSON_AddNumberToObject(object, "change", entry->figures.change);
    cJSON_AddNumberToObject(object, "exact_change", entry->figures.exact_change);
}

/* What the plot of times (section D10) is drawn over. */
static void add_sizes(cJSON *object, const struct tl_gallery_entry *entry)
{
    struct tl_settings settings;
    tl_error error = {0};
    int side = tl_shots_side(entry->picture.experiment);
    if (!tl_picture_settings(&entry->picture, TL_PICTURE_SOLID, side, false, &settings, &error))
        return;
    cJSON_AddNumberToObject(object, "regions", settings.light.regions);
    cJSON_AddNumberToObject(object, "map_size", settings.light.map_size);
}

static cJSON *make_entry(const struct tl_gallery_entry *entry, bool shows_times)
{
    const struct tl_gallery_figures *figures = &entry->figures;
    const struct tl_experiment_appearance *look = entry->picture.appearance;
    int width, height;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "technique", entry->picture.technique->picture);
    cJSON_AddItemToObject(object, "look", look ? cJSON_CreateString(look->title) : cJSON_CreateNull());
    tl_panels_size(TL_PICTURE_OBJECTS, tl_shots_side(entry->picture.experiment), &width, &height);
    add_file(object, "image", entry->image, width, height);
    add_strip(object, entry);
    cJSON_AddItemToObject(object, "error", cJSON_CreateDoubleArray(figures->error, TL_PICTURE_OBJECTS));
    cJSON_AddItemToObject(object, "time_ms", cJSON_CreateDoubleArray(figures->time_ms, TL_PICTURE_OBJECTS));
    cJSON_AddBoolToObject(object, "kept", entry->kept);
    if (shows_times)
        add_sizes(object, entry);
    return object;
}

static void add_claims(cJSON *object, const struct tl_experiment *section)
{
    cJSON *claims = cJSON_AddArrayToObject(object, "claims");
    for (int i = 0; i < TL_EXPERIMENT_CLAIMS && section->claims[i].nearer; i++) {
        cJSON *claim = cJSON_CreateObject();
        cJSON_AddStringToObject(claim, "nearer", section->claims[i].nearer);
        cJSON_AddStringToObject(claim, "farther", section->claims[i].farther);
        cJSON_AddStringToObject(claim, "source", section->claims[i].source);
        cJSON_AddItemToArray(claims, claim);
    }
}

static void add_photographs(cJSON *figures, const struct tl_photographs_error errors[TL_PHOTOGRAPHS_RIGS])
{
    const struct tl_photographs_error *few = &errors[0], *many = &errors[TL_PHOTOGRAPHS_RIGS - 1];
    char *caption =
        tl_format("What photographs of the weave show against its own normals and colours: %d lamps "
                  "leave %.2f degrees and %.2f %%, %d lamps %.2f degrees and %.2f %%: the normals of more "
                  "lamps are %s.",
                  few->lamps, few->normal_deg, 100 * few->albedo, many->lamps, many->normal_deg,
                  100 * many->albedo, many->normal_deg < few->normal_deg ? "nearer" : "no nearer");
    cJSON *series = tl_report_add_plot(
        figures, &(const struct tl_report_plot){.x_label = "lamps",
                                                .y_label = "mean angle, degrees; error of colours, %",
                                                .caption = caption});
    cJSON *angles = tl_report_add_series(series, "normals, degrees", false),
          *colours = tl_report_add_series(series, "colours, %", false);
    for (int i = 0; i < TL_PHOTOGRAPHS_RIGS; i++) {
        tl_report_add_point(angles, errors[i].lamps, errors[i].normal_deg);
        tl_report_add_point(colours, errors[i].lamps, 100 * errors[i].albedo);
    }
    free(caption);
}

static void add_section(cJSON *sections, const struct tl_gallery *gallery,
                        const struct tl_gallery_entry *first, const struct tl_gallery_entry *end)
{
    static const char *const motions[] = {[TL_MOTION_CAMERA] = "camera",
                                          [TL_MOTION_LAMP] = "lamp",
                                          [TL_MOTION_SKY] = "sky",
                                          [TL_MOTION_CLOTH] = "cloth"};
    const struct tl_experiment *section = first->picture.experiment;
    bool shows_times = strcmp(section->name, "d10") == 0;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "title", section->title);
    cJSON_AddStringToObject(object, "text", section->text);
    cJSON_AddStringToObject(object, "source", section->source ? section->source : "This program");
    cJSON_AddBoolToObject(object, "is_exact", section->exact != TL_EXACT_NONE);
    cJSON_AddStringToObject(object, "exact_text", section->exact_text);
    cJSON_AddStringToObject(object, "solid", section->solid);
    cJSON_AddBoolToObject(object, "by_flip", section->by_flip);
    cJSON_AddBoolToObject(object, "shows_times", shows_times);
    if (section->motion) {
        cJSON_AddStringToObject(object, "motion", motions[section->motion]);
        cJSON_AddNumberToObject(object, "motion_step", (double)section->motion_step);
    }
    add_claims(object, section);
    cJSON *entries = cJSON_AddArrayToObject(object, "entries");
    for (const struct tl_gallery_entry *entry = first; entry < end; entry++)
        cJSON_AddItemToArray(entries, make_entry(entry, shows_times));
    cJSON *figures = cJSON_AddArrayToObject(object, "figures");
    tl_gallery_add_figures(section->name, figures);
    if (section->photographed)
        add_photographs(figures, gallery->photographs);
    cJSON_AddItemToArray(sections, object);
}

cJSON *tl_gallery_data(const struct tl_gallery *gallery)
{
    cJSON *data = cJSON_CreateObject();
    cJSON_AddBoolToObject(data, "complete", gallery->complete);
    cJSON *sections = cJSON_AddArrayToObject(data, "sections");
    for (size_t first = 0, end; first < gallery->count; first = end) {
        for (end = first + 1; end < gallery->count && gallery->entries[end].picture.experiment ==
                                                          gallery->entries[first].picture.experiment;)
            end++;
        add_section(sections, gallery, gallery->entries + first, gallery->entries + end);
    }
    return data;
}
