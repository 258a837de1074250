#include "app/view/review/review_reading.h"

#include "app/view/review/review_edit.h"
#include "config/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Which file ---- */

static const char *name_of(const struct tl_settings *settings, enum tl_reading_of of)
{
    return of == TL_READING_GARMENT ? settings->scene.garment : tl_settings_avatar(&settings->scene);
}

static const tl_model *model_of(const struct tl_review *review, enum tl_reading_of of)
{
    const struct tl_session_models models = tl_session_models(review->session);
    return of == TL_READING_GARMENT ? models.garment : models.avatar;
}

/* Whether the model was read from a file whose units are an option: built-in ones and patterns are metric. */
bool tl_review_has_units(const struct tl_review *review, enum tl_reading_of of)
{
    const tl_model *model = model_of(review, of);
    return model && tl_option_is_file_name(name_of(&review->wanted, of)) && model->units.longest > 0;
}

/* As asked for, also while that is loading; else as it was guessed. */
static enum tl_units units_of(const struct tl_review *review, enum tl_reading_of of)
{
    const struct tl_scene_params *scene = &review->wanted.scene;
    enum tl_units units = (enum tl_units)(of == TL_READING_GARMENT ? scene->units : scene->avatar_units);
    return units != TL_UNITS_AUTO ? units : model_of(review, of)->units.units;
}

static enum tl_up up_of(const struct tl_review *review, enum tl_reading_of of)
{
    const struct tl_scene_params *scene = &review->wanted.scene;
    enum tl_up up = (enum tl_up)(of == TL_READING_GARMENT ? scene->up : scene->avatar_up);
    bool moves =
        of == TL_READING_GARMENT ? strcmp(scene->motion, "none") != 0 : model_of(review, of)->rig != NULL;
    if (up != TL_UP_AUTO)
        return up;
    return model_of(review, of)->units.z_up && !moves ? TL_UP_Z : TL_UP_Y;
}

/* Metres with Y up are what a file is expected to have. */
static bool was_guessed(const struct tl_review *review, enum tl_reading_of of)
{
    if (!tl_review_has_units(review, of))
        return false;
    const struct tl_units_reading *reading = &model_of(review, of)->units;
    const struct tl_scene_params *scene = &tl_session_settings(review->session)->scene;
    bool chose_up = (of == TL_READING_GARMENT ? scene->up : scene->avatar_up) == TL_UP_AUTO &&
                    up_of(review, of) == TL_UP_Z;
    bool is_usual = reading->units == TL_UNITS_M && reading->fits && !reading->absurd;
    return chose_up || (reading->guessed && !is_usual);
}

static bool is_kept(const struct tl_review *review, enum tl_reading_of of)
{
    return strcmp(review->reading.kept[of], name_of(&review->wanted, of)) == 0;
}

/* ---- The notice ---- */

/* The options that read a file as it is read, for the command line. */
static char *options_of(const struct tl_review *review, enum tl_reading_of of)
{
    const char *units = tl_units_names[units_of(review, of)];
    const char *up = tl_up_names[up_of(review, of)];
    return of == TL_READING_GARMENT
               ? tl_format("--units %s --up %s", units, up)
               : tl_format("--set scene.avatar_units=%s --set scene.avatar_up=%s", units, up);
}

static char *describe(const struct tl_review *review, enum tl_reading_of of)
{
    const struct tl_units_reading *reading = &model_of(review, of)->units;
    const char *path = name_of(&review->wanted, of), *slash = strrchr(path, '/');
    double length = (double)reading->longest;
    char *options = options_of(review, of);
    enum tl_units units = units_of(review, of);
    char *text = tl_format("%s: %.4g units long, taken as %s (%.3g m), %c up%s\n"
                           "Enter keeps this, U changes the unit, A the axis: %s",
                           slash ? slash + 1 : path, length, tl_units_plurals[units],
                           length * tl_units_metres(units), up_of(review, of) == TL_UP_Z ? 'Z' : 'Y',
                           reading->fits ? "" : "; no unit fits this size", options);
    free(options);
    return text;
}

/* What is said about sizes is said about this garment on this body. */
static const char *open_size_note(const struct tl_review *review)
{
    const char *note = tl_session_size_note(review->session);
    return note && strcmp(note, review->reading.kept_size) != 0 ? note : NULL;
}

static void write_notice(struct tl_review *review)
{
    struct tl_review_reading *reading = &review->reading;
    const char *size = open_size_note(review);
    char *read_as = reading->of != TL_READING_NONE ? describe(review, reading->of) : tl_copy_string("");
    snprintf(reading->notice, sizeof reading->notice, "%s%s%s%s%s", read_as, read_as[0] && size ? "\n" : "",
             size ? size : "", size && !read_as[0] ? "\nEnter closes this" : "",
             size ? "\nD drapes the garment; Ctrl + Shift and a drag moves it, the wheel sizes it" : "");
    free(read_as);
    review->redraws = review->redraws > 1 ? review->redraws : 1;
}

/* A file that is being changed stays; else the first whose reading was guessed and is not accepted. */
void tl_review_note_reading(struct tl_review *review)
{
    struct tl_review_reading *reading = &review->reading;
    bool stays = reading->of != TL_READING_NONE && tl_review_has_units(review, reading->of) &&
                 strcmp(reading->name, name_of(&review->wanted, reading->of)) == 0;
    for (int of = TL_READING_GARMENT; of < TL_READING_COUNT && !stays; of++) {
        enum tl_reading_of candidate = (enum tl_reading_of)of;
        stays = was_guessed(review, candidate) && !is_kept(review, candidate);
        reading->of = stays ? candidate : TL_READING_NONE;
    }
    if (stays)
        snprintf(reading->name, sizeof reading->name, "%s", name_of(&review->wanted, reading->of));
    write_notice(review);
}

bool tl_review_keep_reading(struct tl_review *review)
{
    struct tl_review_reading *reading = &review->reading;
    if (!reading->notice[0])
        return false;
    if (reading->of != TL_READING_NONE) {
        char *options = options_of(review, reading->of);
        snprintf(reading->kept[reading->of], sizeof reading->kept[0], "%s", reading->name);
        tl_review_report(review, "keeps %s", options);
        free(options);
    } else if (open_size_note(review))
        snprintf(reading->kept_size, sizeof reading->kept_size, "%s", open_size_note(review));
    reading->of = TL_READING_NONE;
    tl_review_note_reading(review);
    return true;
}

/* ---- Units and axes ---- */

/* The file that U and A mean. */
static bool choose_file(struct tl_review *review)
{
    struct tl_review_reading *reading = &review->reading;
    if (reading->of == TL_READING_NONE)
        reading->of = tl_review_has_units(review, TL_READING_GARMENT)  ? TL_READING_GARMENT
                      : tl_review_has_units(review, TL_READING_AVATAR) ? TL_READING_AVATAR
                                                                       : TL_READING_NONE;
    if (reading->of == TL_READING_NONE)
        tl_review_report(review,
                         "built-in garments and patterns have their size: there is no unit to change");
    else
        snprintf(reading->name, sizeof reading->name, "%s", name_of(&review->wanted, reading->of));
    return reading->of != TL_READING_NONE;
}

/* Whether a garment or a body could be as long as the file would be in a unit: a wrong one can make millions
 * of edges that are too long. */
static bool is_conceivable(const struct tl_units_reading *reading, int units)
{
    double length_m = (double)reading->longest * tl_units_metres((enum tl_units)units);
    return length_m >= 0.1 && length_m <= 10;
}

static bool set_up(struct tl_review *review, enum tl_reading_of of, enum tl_up up)
{
    return tl_review_set(review, of == TL_READING_GARMENT ? "scene.up" : "scene.avatar_up", tl_up_names[up]);
}

/* The axis stays: it was guessed for the size that the file had, and in another unit the guess may be
 * another. */
void tl_review_next_units(struct tl_review *review, int by)
{
    if (!choose_file(review))
        return;
    enum tl_reading_of of = review->reading.of;
    const struct tl_units_reading *reading = &model_of(review, of)->units;
    int present = (int)units_of(review, of), next = present;
    const int count = TL_UNITS_IN; /* those after AUTO */
    do
        next = (next - 1 + by + count) % count + 1;
    while (next != present && !is_conceivable(reading, next));
    if (next == present)
        tl_review_report(review, "in no other unit it would be from 0.1 to 10 m long");
    else if (set_up(review, of, up_of(review, of)) &&
             tl_review_set(review, of == TL_READING_GARMENT ? "scene.units" : "scene.avatar_units",
                           tl_units_names[next]))
        tl_review_report(review, "reads it in %s", tl_units_plurals[next]);
}

void tl_review_next_up(struct tl_review *review)
{
    if (!choose_file(review))
        return;
    enum tl_reading_of of = review->reading.of;
    enum tl_up next = up_of(review, of) == TL_UP_Z ? TL_UP_Y : TL_UP_Z;
    if (set_up(review, of, next))
        tl_review_report(review, "reads it with %c up", next == TL_UP_Z ? 'Z' : 'Y');
}
