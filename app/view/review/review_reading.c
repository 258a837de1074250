#include "app/view/review/review_reading.h"

#include "app/view/review/review.h"
#include "app/view/review/review_edit.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- The file ---- */

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

/* The requested value, also while that is loading; else the guessed one. */
static enum tl_units units_of(const struct tl_review *review, enum tl_reading_of of)
{
    const struct tl_scene_params *scene = &review->wanted.scene;
    enum tl_units units = (enum tl_units)(of == TL_READING_GARMENT ? scene->units : scene->avatar_units);
    return units != TL_UNITS_AUTO ? units : model_of(review, of)->units.units;
}

/* A motion or a rig moves in its file's own axes. */
static bool plays(const struct tl_review *review, enum tl_reading_of of)
{
    return of == TL_READING_GARMENT ? strcmp(review->wanted.scene.motion, "none") != 0
                                    : model_of(review, of)->rig != NULL;
}

static enum tl_up up_in(const struct tl_review *review, const struct tl_scene_params *scene,
                        enum tl_reading_of of)
{
    enum tl_up up = (enum tl_up)(of == TL_READING_GARMENT ? scene->up : scene->avatar_up);
    if (up != TL_UP_AUTO)
        return up;
    return model_of(review, of)->units.z_up && !plays(review, of) ? TL_UP_Z : TL_UP_Y;
}

static enum tl_up up_of(const struct tl_review *review, enum tl_reading_of of)
{
    return up_in(review, &review->wanted.scene, of);
}

/* A reading that an option has decided is in no doubt. */
static bool is_in_doubt(const struct tl_review *review, enum tl_reading_of of)
{
    if (!tl_review_has_units(review, of))
        return false;
    const struct tl_scene_params *scene = &tl_session_settings(review->session)->scene;
    bool is_garment = of == TL_READING_GARMENT;
    unsigned doubts = tl_units_doubts(&model_of(review, of)->units);
    if ((is_garment ? scene->units : scene->avatar_units) != TL_UNITS_AUTO)
        doubts &= ~(unsigned)TL_DOUBT_UNITS;
    if ((is_garment ? scene->up : scene->avatar_up) != TL_UP_AUTO || plays(review, of))
        doubts &= ~(unsigned)TL_DOUBT_UP;
    return doubts != 0;
}

static bool is_kept(const struct tl_review *review, enum tl_reading_of of)
{
    return strcmp(review->reading.kept[of], name_of(&review->wanted, of)) == 0;
}

/* ---- The question ---- */

/* The options that read a file as it is read, for the command line. */
static char *options_of(const struct tl_review *review, enum tl_reading_of of)
{
    const char *units = tl_units_names[units_of(review, of)];
    const char *up = tl_up_names[up_of(review, of)];
    return of == TL_READING_GARMENT
               ? tl_format("--units %s --up %s", units, up)
               : tl_format("--set scene.avatar_units=%s --set scene.avatar_up=%s", units, up);
}

static vec3s size_of(const tl_mesh *mesh)
{
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    return glms_vec3_sub(box.upper, box.lower);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Size beside the other model of the scene, if there is one. */
static char *describe(const struct tl_review *review, enum tl_reading_of of)
{
    const struct tl_session_models models = tl_session_models(review->session);
    const tl_model *model = model_of(review, of),
                   *other = models.garment == model ? models.avatar : models.garment;
    char *options = options_of(review, of);
    char *beside = other
                       ? tl_format("; %s is %.3g m", base_name(other->name), (double)size_of(&other->mesh).y)
                       : tl_copy_string("");
    char *text = tl_format("%s: in which unit is it, and which axis is up?\n"
                           "Read in %s with %c up it is %.3g m high%s%s\nThe command line has it as %s",
                           base_name(name_of(&review->wanted, of)), tl_units_plurals[units_of(review, of)],
                           up_of(review, of) == TL_UP_Z ? 'Z' : 'Y', (double)size_of(&model->mesh).y, beside,
                           model->units.fits ? "" : "; no unit gives it the size of a garment", options);
    free(beside);
    free(options);
    return text;
}

/* Notices about sizes hold for this garment on this body. */
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
    snprintf(reading->notice, sizeof reading->notice, "%s%s%s%s", read_as, read_as[0] && size ? "\n" : "",
             size ? size : "",
             size ? "\nD drapes the garment; M shows handles that move, turn and size it" : "");
    free(read_as);
    review->due.redraws = review->due.redraws > 1 ? review->due.redraws : 1;
}

/* A file that is being changed stays; else the first whose reading is in doubt and was not accepted. */
void tl_review_note_reading(struct tl_review *review)
{
    struct tl_review_reading *reading = &review->reading;
    bool was_shown = reading->of != TL_READING_NONE && reading->notice[0];
    bool stays = reading->of != TL_READING_NONE && tl_review_has_units(review, reading->of) &&
                 strcmp(reading->name, name_of(&review->wanted, reading->of)) == 0;
    for (int of = TL_READING_GARMENT; of < TL_READING_COUNT && !stays; of++) {
        enum tl_reading_of candidate = (enum tl_reading_of)of;
        stays = is_in_doubt(review, candidate) && !is_kept(review, candidate);
        reading->of = stays ? candidate : TL_READING_NONE;
    }
    if (stays)
        snprintf(reading->name, sizeof reading->name, "%s", name_of(&review->wanted, reading->of));
    if (stays && !was_shown) {
        char *options = options_of(review, reading->of);
        tl_info("view: asks how %s is to be read: %s so far", reading->name, options);
        free(options);
    }
    write_notice(review);
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

/* Both at once: each was guessed for what the file was with the other, and might now be guessed otherwise. */
static bool set_reading(struct tl_review *review, enum tl_reading_of of, enum tl_units units, enum tl_up up)
{
    bool is_garment = of == TL_READING_GARMENT;
    return tl_review_set(review, is_garment ? "scene.up" : "scene.avatar_up", tl_up_names[up]) &&
           tl_review_set(review, is_garment ? "scene.units" : "scene.avatar_units", tl_units_names[units]);
}

static void choose_units(struct tl_review *review, enum tl_units units)
{
    const enum tl_reading_of of = review->reading.of;
    if (set_reading(review, of, units, up_of(review, of)))
        tl_review_report(review, "reads it in %s", tl_units_plurals[units]);
}

static void choose_up(struct tl_review *review, enum tl_up up)
{
    const enum tl_reading_of of = review->reading.of;
    if (set_reading(review, of, units_of(review, of), up))
        tl_review_report(review, "reads it with %c up", up == TL_UP_Z ? 'Z' : 'Y');
}

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
    else
        choose_units(review, (enum tl_units)next);
}

void tl_review_next_up(struct tl_review *review)
{
    if (choose_file(review))
        choose_up(review, up_of(review, review->reading.of) == TL_UP_Z ? TL_UP_Y : TL_UP_Z);
}

/* ---- Answers ---- */

/* Makes options of what was guessed, so that nothing is guessed, or asked, when the scene is opened again.
 * The session's change with them: the models are read so already. */
static void remember(struct tl_review *review, enum tl_reading_of of)
{
    struct tl_scene_params named = tl_session_settings(review->session)->scene;
    const enum tl_units units = units_of(review, of);
    const enum tl_up up = up_of(review, of);
    bool is_garment = of == TL_READING_GARMENT;
    int *named_units = is_garment ? &named.units : &named.avatar_units;
    int *named_up = is_garment ? &named.up : &named.avatar_up;
    if (review->load.loader) /* which may read it otherwise */
        return;
    if (*named_units == TL_UNITS_AUTO)
        *named_units = units;
    if (*named_up == TL_UP_AUTO)
        *named_up = up;
    tl_session_name_reading(review->session, &named);
    set_reading(review, of, units, up);
}

bool tl_review_keep_reading(struct tl_review *review)
{
    struct tl_review_reading *reading = &review->reading;
    if (!reading->notice[0])
        return false;
    if (open_size_note(review))
        snprintf(reading->kept_size, sizeof reading->kept_size, "%s", open_size_note(review));
    if (reading->of != TL_READING_NONE) {
        char *options = options_of(review, reading->of);
        snprintf(reading->kept[reading->of], sizeof reading->kept[0], "%s", reading->name);
        remember(review, reading->of);
        tl_review_report(review, "keeps %s", options);
        free(options);
    }
    reading->of = TL_READING_NONE;
    tl_review_note_reading(review);
    return true;
}

/* One for each conceivable unit, two axes, one to keep it; `units` and `up` are those of a choice, AUTO: it
 * changes none. */
struct answer {
    enum tl_units units;
    enum tl_up up;
};

static size_t list_answers(const struct tl_review *review, struct answer answers[TL_REVIEW_CHOICES])
{
    const struct tl_review_reading *reading = &review->reading;
    size_t count = 0;
    if (reading->of != TL_READING_NONE) {
        for (int units = TL_UNITS_M; units <= TL_UNITS_IN; units++)
            if (is_conceivable(&model_of(review, reading->of)->units, units) ||
                units == (int)units_of(review, reading->of))
                answers[count++] = (struct answer){.units = (enum tl_units)units};
        answers[count++] = (struct answer){.up = TL_UP_Y};
        answers[count++] = (struct answer){.up = TL_UP_Z};
    }
    if (reading->notice[0])
        answers[count++] = (struct answer){0};
    return count;
}

size_t tl_review_reading_choices(const struct tl_review *review, struct tl_panel_choice *out)
{
    const enum tl_reading_of of = review->reading.of;
    struct answer answers[TL_REVIEW_CHOICES];
    size_t count = list_answers(review, answers);
    for (size_t i = 0; i < count; i++) {
        const struct answer *answer = &answers[i];
        out[i] = (struct tl_panel_choice){.row = "", .help = "Enter"};
        if (answer->units == TL_UNITS_AUTO && answer->up == TL_UP_AUTO) {
            snprintf(out[i].label, sizeof out[i].label, of == TL_READING_NONE ? "Close" : "Keep this");
            continue;
        }
        const tl_model *model = model_of(review, of);
        const vec3s size = size_of(&model->mesh);
        double high_m = (double)size.y;
        if (answer->units != TL_UNITS_AUTO) {
            high_m *= tl_units_metres(answer->units) / tl_units_metres(model->units.units);
            out[i].is_chosen = answer->units == units_of(review, of);
        } else {
            bool is_loaded = answer->up == up_in(review, &tl_session_settings(review->session)->scene, of);
            high_m = is_loaded ? high_m : (double)size.z;
            out[i].is_chosen = answer->up == up_of(review, of);
        }
        out[i].row = answer->units != TL_UNITS_AUTO ? "Unit" : "Up";
        out[i].help = answer->units != TL_UNITS_AUTO ? "U: the next unit" : "A: the other axis";
        snprintf(out[i].label, sizeof out[i].label, "%s: %.3g m high",
                 answer->units != TL_UNITS_AUTO ? tl_units_names[answer->units]
                 : answer->up == TL_UP_Z        ? "Z"
                                                : "Y",
                 high_m);
    }
    return count;
}

void tl_review_choose_reading(struct tl_review *review, size_t index)
{
    struct answer answers[TL_REVIEW_CHOICES];
    if (index >= list_answers(review, answers))
        return;
    if (answers[index].units != TL_UNITS_AUTO)
        choose_units(review, answers[index].units);
    else if (answers[index].up != TL_UP_AUTO)
        choose_up(review, answers[index].up);
    else
        tl_review_keep_reading(review);
}
