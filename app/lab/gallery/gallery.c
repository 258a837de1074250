#include "app/lab/gallery/gallery.h"

#include "app/lab/experiments/experiments.h"
#include "app/lab/gallery/baked.h"
#include "app/lab/gallery/moving_sky.h"
#include "app/lab/gallery/sampled.h"
#include "app/lab/gallery/shots.h"
#include "app/lab/gallery/store.h"
#include "app/report/folder.h"
#include "assets/image/image_file.h"
#include "config/base/hash.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/base/words.h"
#include "render/metrics/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Raised when the same settings give other pictures or figures: those of earlier runs are then drawn again.
 */
#define EDITION 2

struct gallery_drawing {
    const char *folder;
    struct tl_shots shots;
    tl_gallery_store *store;
    struct tl_progress progress;
    size_t total; /* pictures */
};

static void release_entry(struct tl_gallery_entry *entry)
{
    free(entry->setting);
    free(entry->image);
    free(entry->strip);
}

/* ---- One picture ---- */

/* Covers all that its files show: the settings of both objects, exact and not, and what moves. */
static bool hash_picture(const struct tl_experiment_picture *picture, uint64_t *hash, tl_error *error)
{
    const struct tl_experiment *experiment = picture->experiment;
    const int shape[] = {EDITION, (int)experiment->exact, (int)experiment->motion,
                         (int)lrintf(1000 * experiment->motion_step), experiment->by_flip};
    *hash = tl_hash(TL_HASH_START, TOILE_VERSION, strlen(TOILE_VERSION));
    *hash = tl_hash(*hash, shape, sizeof shape);
    *hash = tl_hash(*hash, experiment->exact_text, strlen(experiment->exact_text));
    for (int i = 0; i < 2 * TL_PICTURE_OBJECTS; i++) {
        struct tl_settings settings;
        if (!tl_shots_settings(picture, i / 2, tl_shots_side(experiment), i % 2, &settings, error))
            return false;
        uint64_t values = tl_settings_hash(&settings, (struct tl_option_filter){.any_of = UINT64_MAX});
        *hash = tl_hash(*hash, &values, sizeof values);
    }
    return true;
}

static bool save_picture(const struct gallery_drawing *drawing, const char *name, const tl_image *picture,
                         tl_error *error)
{
    void *png = NULL;
    size_t size = 0;
    bool saved = tl_image_encode_png(name, picture, &png, &size, error) &&
                 tl_folder_put(drawing->folder, name, png, size, error);
    free(png);
    return saved;
}

double tl_gallery_error_less_noise(double rel_rmse, double noise)
{
    const double unresolved = noise / 4;
    return sqrt(fmax(rel_rmse * rel_rmse - noise * noise, unresolved * unresolved));
}

bool tl_gallery_measure_error(const struct tl_experiment *experiment, const struct tl_gallery_shot *tested,
                              const struct tl_gallery_shot *exact, double *error_of, tl_error *error)
{
    struct tl_comparison result;
    if (!tl_image_compare(&tested->light, &exact->light, experiment->by_flip ? -1 : 0, 0, &result, error))
        return false;
    *error_of =
        experiment->by_flip ? result.flip_mean : tl_gallery_error_less_noise(result.rel_rmse, exact->noise);
    return true;
}

/* The page has all of the text. */
char *tl_gallery_exact_head(const struct tl_experiment *experiment)
{
    const char *text = experiment->exact_text;
    return experiment->exact == TL_EXACT_NONE ? tl_copy_string("for comparison")
                                              : tl_format("exact: %.*s", (int)strcspn(text, ";"), text);
}

static bool draw_panels(struct gallery_drawing *drawing, struct tl_gallery_entry *entry, tl_error *error)
{
    const struct tl_experiment *experiment = entry->picture.experiment;
    struct tl_gallery_shot tested[TL_PICTURE_OBJECTS] = {0};
    struct tl_panel_row rows[TL_PICTURE_OBJECTS];
    bool done = true;
    for (int i = 0; done && i < TL_PICTURE_OBJECTS; i++) {
        rows[i].tested = &tested[i];
        rows[i].exact = tl_shots_exact(&drawing->shots, &entry->picture, i, error);
        done =
            rows[i].exact && tl_shots_draw(&drawing->shots, &entry->picture, i, &tested[i], error) &&
            tl_gallery_measure_error(experiment, &tested[i], rows[i].exact, &entry->figures.error[i], error);
        entry->figures.time_ms[i] = tested[i].time_ms;
    }
    if (done) {
        char *exact = tl_gallery_exact_head(experiment);
        entry->figures.difference_end = tl_panels_end(rows, TL_PICTURE_OBJECTS);
        tl_image picture = tl_panels_make(rows, TL_PICTURE_OBJECTS, tl_shots_side(experiment), exact,
                                          entry->setting, entry->figures.difference_end);
        done = save_picture(drawing, entry->image, &picture, error);
        tl_image_release(&picture);
        free(exact);
    }
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++)
        tl_gallery_shot_release(&tested[i]);
    return done;
}

/* Compares the pictures as shown: in linear light the small lamp of the studio would outweigh all else. */
static double measure_change(const struct tl_gallery_shot frames[])
{
    size_t bytes = (size_t)3 * TL_STRIP_SIDE * TL_STRIP_SIDE;
    double sum = 0;
    for (int i = 1; i < TL_STRIP_FRAMES; i++) {
        const uint8_t *now = tl_image_bytes(&frames[i].shown), *before = tl_image_bytes(&frames[i - 1].shown);
        for (size_t k = 0; k < bytes; k++)
            sum += abs(now[k] - before[k]);
    }
    return sum / ((double)bytes * (TL_STRIP_FRAMES - 1));
}

static bool draw_strip(struct gallery_drawing *drawing, struct tl_gallery_entry *entry, tl_error *error)
{
    struct tl_gallery_shot exact[TL_STRIP_FRAMES], tested[TL_STRIP_FRAMES];
    bool done = tl_shots_strip(&drawing->shots, &entry->picture, exact, tested, error);
    if (done) {
        entry->figures.exact_change = measure_change(exact);
        entry->figures.change = measure_change(tested);
        char *head = tl_gallery_exact_head(entry->picture.experiment);
        tl_image strip = tl_panels_strip(exact, tested, TL_STRIP_FRAMES, TL_STRIP_SIDE, head, entry->setting);
        free(head);
        done = save_picture(drawing, entry->strip, &strip, error);
        tl_image_release(&strip);
    }
    for (int i = 0; i < TL_STRIP_FRAMES; i++) {
        tl_gallery_shot_release(&exact[i]);
        tl_gallery_shot_release(&tested[i]);
    }
    return done;
}

static bool fail_if_interrupted(tl_error *error)
{
    return !tl_interrupted() || tl_fail(error, TL_INTERRUPTED, "stopped: the same command continues");
}

/* A reference that Ctrl-C ended has fewer rays than it should: its picture is not recorded as drawn. */
static bool draw_entry(struct gallery_drawing *drawing, struct tl_gallery_entry *entry, tl_error *error)
{
    uint64_t hash;
    if (!hash_picture(&entry->picture, &hash, error))
        return false;
    entry->kept = tl_gallery_store_find(drawing->store, hash, entry);
    return entry->kept ||
           (tl_gallery_store_forget(drawing->store, entry, error) && draw_panels(drawing, entry, error) &&
            (!entry->strip || draw_strip(drawing, entry, error)) && fail_if_interrupted(error) &&
            tl_gallery_store_put(drawing->store, hash, entry, error));
}

/* ---- Sections ---- */

/* Section `index` of those that are drawn (all, or the one called `only`); NULL past the last one. */
static const struct tl_experiment *section_at(const char *only, size_t index)
{
    if (!only)
        return tl_experiment_at(TL_OUTPUT_PICTURES, index);
    return index == 0 ? tl_experiment_find(TL_OUTPUT_PICTURES, only) : NULL;
}

static size_t count_pictures(bool quick, const char *only)
{
    const struct tl_experiment *section;
    size_t count = 0;
    for (size_t i = 0; (section = section_at(only, i)); i++)
        count += quick ? 1 : tl_picture_count(section, TL_OUTPUT_PICTURES);
    return count;
}

bool tl_gallery_has(const char *name, tl_error *error)
{
    size_t count = 0;
    if (section_at(name, 0))
        return true;
    while (section_at(NULL, count))
        count++;
    const char **names = TL_NEW_ARRAY(const char *, count);
    for (size_t i = 0; i < count; i++)
        names[i] = section_at(NULL, i)->name;
    const char *near = tl_nearest_word(name, names, count), *first = names[0];
    free(names);
    return tl_fail(error, TL_USAGE, "gallery: \"%s\": no such section: expected %s%s%s", name, first,
                   near ? ": did you mean " : " or another row of the technique set", near ? near : "");
}

static struct tl_gallery_entry make_entry(const struct tl_experiment_picture *picture, size_t number)
{
    const struct tl_experiment *section = picture->experiment;
    return (struct tl_gallery_entry){
        .picture = *picture,
        .setting = tl_picture_name(picture, TL_OUTPUT_PICTURES),
        .image = tl_format("%s-%02zu.png", section->name, number),
        .strip = section->motion ? tl_format("%s-%02zu-motion.png", section->name, number) : NULL};
}

static bool draw_section(struct gallery_drawing *drawing, const struct tl_experiment *section, bool quick,
                         struct tl_gallery *out, tl_error *error)
{
    struct tl_experiment_picture picture = {.experiment = section, .folder = drawing->folder};
    bool done =
        (!section->baked || tl_baked_make(&picture, error)) &&
        (!section->moving_sky || tl_moving_sky_make(&picture, error)) &&
        (!section->photographed || tl_photographs_make(&drawing->shots, &picture, out->photographs, error));
    for (size_t number = 1; done && !(quick && number > 1) && tl_picture_next(&picture, TL_OUTPUT_PICTURES);
         number++) {
        struct tl_gallery_entry *entry = &out->entries[out->count++];
        *entry = make_entry(&picture, number);
        done = (!section->sampled || tl_sampled_make(&picture, error)) && draw_entry(drawing, entry, error);
        if (!done)
            release_entry(&out->entries[--out->count]);
        tl_progress_update(&drawing->progress, (int)out->count, (int)drawing->total);
    }
    return done;
}

static bool draw_sections(struct gallery_drawing *drawing, bool quick, const char *only,
                          struct tl_gallery *out, tl_error *error)
{
    const struct tl_experiment *section;
    drawing->total = count_pictures(quick, only);
    drawing->progress = tl_progress_begin("drawing the gallery");
    out->entries = TL_NEW_ARRAY(struct tl_gallery_entry, drawing->total);
    bool done = true;
    for (size_t i = 0; done && (section = section_at(only, i)); i++)
        done = draw_section(drawing, section, quick, out, error);
    tl_progress_end(&drawing->progress);
    return done;
}

bool tl_gallery_draw(const char *folder, bool quick, const char *only, struct tl_gallery *out,
                     tl_error *error)
{
    struct gallery_drawing drawing = {.folder = folder};
    *out = (struct tl_gallery){0};
    drawing.store = tl_gallery_store_open(folder, error);
    bool ready = drawing.store && tl_shots_open(&drawing.shots, error);
    out->complete = ready && draw_sections(&drawing, quick, only, out, error);
    tl_shots_close(&drawing.shots);
    tl_gallery_store_close(&drawing.store);
    return out->complete;
}

void tl_gallery_release(struct tl_gallery *gallery)
{
    for (size_t i = 0; i < gallery->count; i++)
        release_entry(&gallery->entries[i]);
    free(gallery->entries);
    *gallery = (struct tl_gallery){0};
}
