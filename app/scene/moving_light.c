#include "app/scene/moving_light.h"

#include "assets/environment/studio.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/env/convert.h"

#include <string.h>

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

enum tl_layout tl_environment_layout(const tl_environment *environment)
{
    static const enum tl_layout layouts[] = {[TL_ENV_LATLONG] = TL_LAYOUT_LATLONG,
                                             [TL_ENV_CUBE] = TL_LAYOUT_CUBE,
                                             [TL_ENV_SPHERE] = TL_LAYOUT_SPHERE,
                                             [TL_ENV_PARABOLOID] = TL_LAYOUT_PARABOLOID,
                                             [TL_ENV_OCTAHEDRAL] = TL_LAYOUT_OCTAHEDRAL};
    return layouts[environment->layout];
}

/* Converts a map of a layout that is only drawn as lat-long. Zeroes it on failure. */
static bool lay_out(const char *name, tl_environment *environment, tl_error *error)
{
    const tl_image *image = &environment->image;
    if (environment->layout == TL_ENV_CUBE || environment->layout == TL_ENV_LATLONG)
        return true;
    const struct tl_sphere_map from = {tl_environment_layout(environment), image->width, image->height};
    struct tl_sphere_map to = {.layout = TL_LAYOUT_LATLONG};
    int64_t width, height;
    tl_layout_extent(to.layout, tl_convert_size(&from, to.layout), &width, &height);
    to.width = (int)width;
    to.height = (int)height;
    tl_image latlong = {0};
    if (tl_image_size_check(name, width, height, error) &&
        tl_memory_request(name, tl_convert_bytes(&from, &to), error)) {
        latlong = tl_image_convert(image, &from, &to, NULL);
        if (!latlong.texels)
            tl_fail(error, TL_INTERRUPTED, "%s: stopped", name);
    }
    if (!latlong.texels) {
        tl_environment_release(environment);
        return false;
    }
    tl_image_release(&environment->image);
    environment->image = latlong;
    environment->layout = TL_ENV_LATLONG;
    tl_environment_adapt(environment);
    return true;
}

static bool load_numbered(const tl_environment_sequence *sequence, int index, tl_environment *out,
                          tl_error *error)
{
    return tl_environment_sequence_load(sequence, index, out, error) &&
           lay_out(sequence->pattern, out, error);
}

static bool load_frame(struct tl_moving_light *light, tl_error *error)
{
    tl_environment first;
    if (!load_numbered(&light->sequence, 0, &first, error))
        return false;
    if (light->shown == 0) {
        light->environment = first;
        return true;
    }
    bool loaded = load_numbered(&light->sequence, light->shown, &light->environment, error);
    if (loaded)
        show_like(&first, &light->environment);
    tl_environment_release(&first);
    return loaded;
}

static bool load(struct tl_moving_light *light, const char *name, double seconds, double rate,
                 tl_error *error)
{
    if (tl_environment_find(name, &light->environment))
        return true;
    if (!tl_environment_is_sequence(name))
        return tl_environment_load(name, &light->environment, error) &&
               lay_out(name, &light->environment, error);
    if (!tl_environment_sequence_open(name, &light->sequence, error))
        return false;
    if (light->sequence.film)
        tl_info(
            "%s: %d frame%s; a film has no light above white: its lamps and suns are weaker than they were",
            name, light->sequence.count, light->sequence.count == 1 ? " at a time" : "s");
    light->shown = tl_environment_sequence_at(&light->sequence, seconds, rate);
    return load_frame(light, error);
}

static void warn_of_shape(const char *name, const tl_environment *environment)
{
    const tl_image *image = &environment->image;
    if (environment->layout == TL_ENV_LATLONG && image->width == image->height && image->width > 1)
        tl_warn(
            "%s: %d x %d texels are taken for lat-long, which is twice as wide as high: a mirror ball or an "
            "octahedral map is converted by toile env --from sphere (or octahedral) --layout latlong",
            name, image->width, image->height);
}

bool tl_moving_light_open(struct tl_moving_light *light, const char *name, double seconds, double rate,
                          tl_error *error)
{
    struct tl_moving_light fresh = {.revision = light->revision + 1};
    if (!load(&fresh, name, seconds, rate, error)) {
        tl_moving_light_release(&fresh);
        return false;
    }
    tl_environment_warn_of_cleaning(&fresh.environment);
    warn_of_shape(name, &fresh.environment);
    tl_moving_light_release(light);
    *light = fresh;
    return true;
}

bool tl_moving_light_follow(struct tl_moving_light *light, double seconds, double rate, tl_error *error)
{
    tl_environment fresh;
    int due = tl_environment_sequence_at(&light->sequence, seconds, rate);
    if (due == light->shown)
        return true;
    if (!load_numbered(&light->sequence, due, &fresh, error))
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
