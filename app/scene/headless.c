#include "app/scene/headless.h"

#include "app/settings/command.h"
#include "assets/environment/film.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"

bool tl_headless_open(struct tl_headless *headless, const struct tl_settings *settings, tl_error *error)
{
    *headless = (struct tl_headless){.settings = *settings};
    const struct tl_render_settings drawn = tl_settings_render(&headless->settings);
    if (!tl_renderer_request(&drawn, error))
        return false;
    headless->gpu = tl_gpu_create_headless(error);
    headless->renderer = headless->gpu ? tl_renderer_create(headless->gpu, error) : NULL;
    headless->session = headless->renderer ? tl_session_create(&headless->settings, error) : NULL;
    if (headless->session) {
        headless->settings = *tl_session_settings(headless->session);
        tl_debug("rendering with %s", tl_gpu_name(headless->gpu));
        return true;
    }
    tl_headless_release(headless);
    return false;
}

bool tl_headless_may_repeat(const struct tl_settings *settings, const char *what, tl_error *error)
{
    return !tl_film_is_live(settings->scene.environment) ||
           tl_fail(error, TL_USAGE,
                   "%s: draws frames more than once, for which light from stdin does not wait: save the film "
                   "to a file",
                   what);
}

bool tl_headless_create(struct tl_headless *headless, const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_settings settings;
    *headless = (struct tl_headless){0};
    return tl_settings_of_command(arguments, false, &settings, error) &&
           tl_headless_open(headless, &settings, error);
}

void tl_headless_release(struct tl_headless *headless)
{
    tl_renderer_destroy(&headless->renderer);
    tl_gpu_destroy(&headless->gpu);
    tl_session_destroy(&headless->session);
}

static bool draw(struct tl_headless *headless, bool still, tl_error *error)
{
    tl_frame frame = tl_session_frame(headless->session);
    frame.still = still;
    frame.aovs = headless->aovs;
    const struct tl_render_settings settings = tl_settings_render(&headless->settings);
    return tl_renderer_draw(headless->renderer, &frame, &settings, error);
}

bool tl_headless_draw(struct tl_headless *headless, tl_error *error)
{
    return draw(headless, false, error);
}

bool tl_headless_draw_still(struct tl_headless *headless, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("averaging");
    bool drawn = draw(headless, true, error);
    for (int round = 1; drawn && !tl_renderer_is_at_rest(headless->renderer) && !tl_interrupted(); round++) {
        drawn = draw(headless, true, error);
        tl_progress_update(&progress, round + 1, headless->settings.light.rounds);
    }
    tl_progress_end(&progress);
    return drawn;
}
