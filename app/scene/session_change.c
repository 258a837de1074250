/* Changes of a session: what other settings require, and how a session takes over another's contents. */
#include "app/scene/session_internal.h"
#include "config/base/intern.h"

#include <stdio.h>
#include <string.h>

bool tl_session_needs_scene(const struct tl_settings *old, const struct tl_settings *new)
{
    return tl_settings_differ(old, new, (struct tl_option_filter){.any_of = TL_AFFECTS_SCENE});
}

bool tl_session_needs_light(const struct tl_settings *old, const struct tl_settings *new)
{
    return tl_settings_differ(old, new, (struct tl_option_filter){.any_of = TL_AFFECTS_ENVIRONMENT});
}

bool tl_session_needs_appearance(const struct tl_settings *old, const struct tl_settings *new)
{
    const struct tl_option_filter filter = tl_appearance_filter(old, new);
    return tl_settings_differ(old, new, filter) || (!filter.none_of && old->colourways != new->colourways);
}

/* Copies the colourways with the garment: they belong to it. */
void tl_session_keep_scene(const struct tl_settings *kept, struct tl_settings *settings)
{
    const struct tl_option_filter colourways = {.any_of = TL_AFFECTS_GARMENT};
    const struct tl_option_filter scene = {.any_of = TL_AFFECTS_SCENE | TL_AFFECTS_ENVIRONMENT};
    if (strcmp(settings->scene.garment, kept->scene.garment) != 0) {
        tl_settings_take(kept, settings, colourways);
        settings->colourways = kept->colourways;
    }
    tl_settings_take(kept, settings, scene);
}

void tl_session_succeed(tl_session *fresh, const tl_session *old)
{
    fresh->light.revision += old->light.revision;
    fresh->appearances_made += old->appearances_made + 1;
    fresh->appearance_revision = fresh->appearances_made;
    fresh->body.motion_revision += old->body.motion_revision;
    fresh->dress.motion_revision += old->dress.motion_revision;
    fresh->strain.wanted = old->strain.wanted;
}

void tl_session_exchange_light(tl_session *session, tl_session *other)
{
    const struct tl_option_filter environment = {.any_of = TL_AFFECTS_ENVIRONMENT};
    const struct tl_moving_light light = session->light;
    const struct tl_settings settings = session->settings;
    session->light = other->light;
    other->light = light;
    tl_settings_take(&other->settings, &session->settings, environment);
    tl_settings_take(&settings, &other->settings, environment);
}

void tl_session_replace_light(tl_session *session, struct tl_moving_light *made, const char *name)
{
    made->revision += session->light.revision;
    tl_moving_light_release(&session->light);
    session->light = *made;
    *made = (struct tl_moving_light){0};
    session->settings.scene.environment = tl_intern(name);
}

void tl_session_name_reading(tl_session *session, const struct tl_scene_params *scene)
{
    session->settings.scene.units = scene->units;
    session->settings.scene.up = scene->up;
    session->settings.scene.avatar_units = scene->avatar_units;
    session->settings.scene.avatar_up = scene->avatar_up;
}

bool tl_session_restart(tl_session *session, const struct tl_settings *settings, tl_error *error)
{
    tl_session *fresh = tl_session_create(settings, error);
    if (!fresh)
        return false;
    tl_session_succeed(fresh, session);
    tl_session swap = *session;
    *session = *fresh;
    *fresh = swap;
    tl_session_destroy(&fresh);
    return true;
}

/* Changes environment and cloth without loading the scene again. */
static bool change_in_place(tl_session *session, const struct tl_settings *settings, uint64_t changes,
                            tl_error *error)
{
    const double seconds = session->frame / settings->cloth.frame_rate,
                 rate = (double)settings->scene.environment_rate;
    const char *environment = settings->scene.environment;
    if (changes & TL_AFFECTS_ENVIRONMENT
            ? !tl_moving_light_open(&session->light, environment, seconds, rate, error)
            : !tl_moving_light_follow(&session->light, seconds, rate, error))
        return false;
    /* tl_cloth_set discards the contacts, so it is called only when one of its options has changed. */
    const bool same_cloth = !(changes & TL_AFFECTS_CLOTH);
    const struct tl_cloth_fabric fabric = tl_settings_fabric(settings);
    return !session->cloth || same_cloth || tl_cloth_set(session->cloth, &fabric, &settings->cloth, error);
}

/* Exchanges the present appearance for a kept one. */
static void exchange_appearance(tl_session *session, struct tl_spare_appearance *spare)
{
    const struct tl_spare_appearance taken = *spare;
    spare->appearance = (struct tl_appearance){0};
    memmove(session->spares + 1, session->spares, (size_t)(spare - session->spares) * sizeof *spare);
    session->spares[0] = (struct tl_spare_appearance){true, session->appearance, session->appearance_revision,
                                                      session->settings};
    session->appearance = taken.appearance;
    session->appearance_revision = taken.revision;
}

void tl_session_keep_appearance(tl_session *session, const struct tl_settings *made_of,
                                struct tl_appearance *made)
{
    if (tl_appearance_is_same(&session->settings, made_of) || tl_spare_find(session->spares, made_of))
        tl_appearance_release(made);
    else
        tl_spare_add(session->spares, made_of, made, ++session->appearances_made);
    *made = (struct tl_appearance){0};
}

bool tl_session_apply(tl_session *session, const struct tl_settings *settings, tl_error *error)
{
    const uint64_t changes = tl_settings_changes(&session->settings, settings);
    tl_session_end_step(session);
    if (changes & TL_AFFECTS_SCENE)
        return tl_session_restart(session, settings, error);
    struct tl_appearance appearance = {0};
    const bool is_new = changes & TL_AFFECTS_MATERIALS;
    struct tl_spare_appearance *spare = is_new ? tl_spare_find(session->spares, settings) : NULL;
    const struct tl_session_models models = tl_session_models(session);
    if (is_new && !spare && !tl_session_make_appearance(&models, settings, &appearance, error))
        return false;
    if (!change_in_place(session, settings, changes, error)) {
        tl_appearance_release(&appearance);
        return false;
    }
    if (is_new && spare) {
        exchange_appearance(session, spare);
    } else if (is_new) {
        tl_spare_add(session->spares, &session->settings, &session->appearance, session->appearance_revision);
        session->appearance = appearance;
        session->appearance_revision = ++session->appearances_made;
    }
    session->settings = *settings;
    return true;
}
