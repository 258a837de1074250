#include "app/lab/experiments/picture.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

static bool step(struct tl_experiment_picture *picture, enum tl_output output)
{
    const struct tl_experiment *experiment = picture->experiment;
    const struct tl_experiment_appearance *end = experiment->appearances + experiment->appearance_count;
    bool begins = !picture->technique;
    picture->technique = tl_experiment_next(experiment, output, picture->technique);
    if (begins && experiment->appearance_count)
        picture->appearance = experiment->appearances;
    if (!picture->technique && picture->appearance && ++picture->appearance < end)
        picture->technique = tl_experiment_next(experiment, output, NULL);
    return picture->technique != NULL;
}

bool tl_picture_next(struct tl_experiment_picture *picture, enum tl_output output)
{
    while (step(picture, output))
        if (!picture->technique->once || picture->appearance == picture->experiment->appearances)
            return true;
    return false;
}

size_t tl_picture_count(const struct tl_experiment *experiment, enum tl_output output)
{
    struct tl_experiment_picture picture = {.experiment = experiment};
    size_t count = 0;
    while (tl_picture_next(&picture, output))
        count++;
    return count;
}

char *tl_picture_name(const struct tl_experiment_picture *picture, enum tl_output output)
{
    const char *name = picture->technique->names[output];
    return picture->appearance ? tl_format("%s, %s", name, picture->appearance->title) : tl_copy_string(name);
}

static size_t append(const char **all, size_t count, const char *const *list, size_t length)
{
    for (size_t i = 0; i < length && list[i]; i++)
        all[count++] = list[i];
    return count;
}

char *tl_picture_file(const struct tl_experiment_picture *picture, enum tl_picture_object object,
                      const char *name)
{
    return tl_format("%s/%s-%s-%s", picture->folder, picture->experiment->name,
                     object == TL_PICTURE_SOLID ? "solid" : "sheet", name);
}

/* Puts paths in place of "@NAME". */
static char *with_path(const struct tl_experiment_picture *picture, enum tl_picture_object object,
                       const char *assignment)
{
    const char *value = strstr(assignment, "=@");
    if (!value || !picture->folder)
        return tl_copy_string(assignment);
    char *file = tl_picture_file(picture, object, value + 2);
    char *made = tl_format("%.*s=%s", (int)(value - assignment), assignment, file);
    free(file);
    return made;
}

static bool assign(const struct tl_experiment_picture *picture, enum tl_picture_object object,
                   const char *const *list, size_t length, struct tl_settings *out, tl_error *error)
{
    bool assigned = true;
    for (size_t i = 0; assigned && i < length && list[i]; i++) {
        char *one = with_path(picture, object, list[i]);
        assigned = tl_settings_assign(out, (const char *const[]){one}, 1, error);
        free(one);
    }
    return assigned;
}

#define OWN 7 /* assignments that depend on the object, the size and the preset */

bool tl_picture_settings(const struct tl_experiment_picture *picture, enum tl_picture_object object, int side,
                         bool reference, struct tl_settings *out, tl_error *error)
{
    const struct tl_experiment *experiment = picture->experiment;
    const struct tl_experiment_appearance *appearance = picture->appearance;
    const struct tl_setup *setup = &picture->technique->setup, *exact = &experiment->reference;
    bool is_solid = object == TL_PICTURE_SOLID, alone = reference && experiment->reference_alone;
    char *own[OWN] = {tl_format("image.width=%d", side),
                      tl_format("image.height=%d", side),
                      tl_format("scene.garment=%s", is_solid ? experiment->solid : "sheet"),
                      tl_format("scene.avatar=%s", is_solid ? "none" : "ball"),
                      tl_format("camera.target=[0, %g, 0]", is_solid ? 0.2 : 0.27),
                      tl_format("camera.distance_m=%g", is_solid ? 0.9 : 1.15),
                      setup->preset && !alone ? tl_format("scene.preset=%s", setup->preset) : NULL};
    const char
        *all[OWN + 2 * TL_EXPERIMENT_ASSIGNMENTS + TL_SETUP_ASSIGNMENTS + TL_COUNT(experiment->solid_only)];
    size_t count = append(all, 0, (const char *const *)own, OWN);
    count = append(all, count, experiment->base, TL_COUNT(experiment->base));
    if (appearance)
        count = append(all, count, appearance->assignments, TL_COUNT(appearance->assignments));
    if (!alone)
        count = append(all, count, setup->assignments, TL_COUNT(setup->assignments));
    if (is_solid)
        count = append(all, count, experiment->solid_only, TL_COUNT(experiment->solid_only));
    char *given[TL_COUNT(all)];
    for (size_t i = 0; i < count; i++)
        given[i] = with_path(picture, object, all[i]);
    const struct tl_settings_source source = {experiment->scene, (const char *const *)given, count};
    bool chosen = tl_settings_load(out, &source, error);
    if (chosen && reference)
        chosen = assign(picture, object, exact->assignments, TL_COUNT(exact->assignments), out, error);
    if (chosen && reference && appearance)
        chosen = assign(picture, object, appearance->reference, TL_COUNT(appearance->reference), out, error);
    for (size_t i = 0; i < count; i++)
        free(given[i]);
    for (size_t i = 0; i < OWN; i++)
        free(own[i]);
    return chosen;
}
