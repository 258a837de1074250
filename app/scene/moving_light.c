#include "app/scene/moving_light.h"

#include "config/base/log.h"

#include <math.h>
#include <string.h>

/* Positions are quotients of rates: one that should be whole may lie just below. */
#define ROUNDING 1e-6

static int frame_at(const tl_environment_sequence *sequence, double position)
{
    return sequence->count > 0 ? (int)fmod(floor(position + ROUNDING), sequence->count) : 0;
}

void tl_environment_warn_of_cleaning(const tl_environment *environment)
{
    const float brightest = 1e10f; /* the sun's disc has 1.6e9 cd/m2 */
    if (environment->peak > brightest)
        tl_warn("%s: its brightest texel is %.2g, more than the sun in any unit: correct it in the program "
                "that made it",
                environment->name, (double)environment->peak);
    size_t cleaned = environment->negative_count + environment->nan_count + environment->inf_count;
    if (cleaned)
        tl_warn("%s: cleaned %zu negative, %zu NaN and %zu infinite values", environment->name,
                environment->negative_count, environment->nan_count, environment->inf_count);
}

/* Every frame of a sequence is shown like its first one, with its ground: a picture does not flicker, and a
 * frame looks the same wherever a run begins. */
static void show_like(const tl_environment *first, tl_environment *frame)
{
    frame->shown = first->shown;
    frame->ground = first->ground;
}

static bool load_frame(struct tl_moving_light *light, tl_error *error)
{
    tl_environment first;
    if (!tl_environment_sequence_load(&light->sequence, light->shown, &light->environment, error))
        return false;
    if (light->shown == 0)
        return true;
    if (!tl_environment_sequence_load(&light->sequence, 0, &first, error))
        return false;
    show_like(&first, &light->environment);
    tl_environment_release(&first);
    return true;
}

static bool load(struct tl_moving_light *light, const char *name, double position, tl_error *error)
{
    if (strcmp(name, "studio") == 0) {
        light->environment = tl_environment_studio();
        return true;
    }
    if (strcmp(name, "none") == 0 || strcmp(name, "white") == 0) {
        float radiance = strcmp(name, "white") == 0 ? 1 : 0;
        light->environment = tl_environment_constant(radiance, radiance, radiance);
        return true;
    }
    if (!tl_environment_is_sequence(name))
        return tl_environment_load(name, &light->environment, error);
    if (!tl_environment_sequence_open(name, &light->sequence, error))
        return false;
    light->shown = frame_at(&light->sequence, position);
    return load_frame(light, error);
}

bool tl_moving_light_open(struct tl_moving_light *light, const char *name, double position, tl_error *error)
{
    struct tl_moving_light fresh = {.revision = light->revision + 1};
    if (!load(&fresh, name, position, error)) {
        tl_moving_light_release(&fresh);
        return false;
    }
    tl_environment_warn_of_cleaning(&fresh.environment);
    tl_moving_light_release(light);
    *light = fresh;
    return true;
}

bool tl_moving_light_follow(struct tl_moving_light *light, double position, tl_error *error)
{
    tl_environment fresh;
    int due = frame_at(&light->sequence, position);
    if (due == light->shown)
        return true;
    if (!tl_environment_sequence_load(&light->sequence, due, &fresh, error))
        return false;
    show_like(&light->environment, &fresh);
    tl_environment_release(&light->environment);
    light->environment = fresh;
    light->shown = due;
    light->revision++;
    return true;
}

void tl_moving_light_release(struct tl_moving_light *light)
{
    tl_environment_release(&light->environment);
    tl_environment_sequence_release(&light->sequence);
}
