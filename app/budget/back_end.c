#include "app/budget/back_end.h"

#include "app/budget/governor.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Share of the budget that drawing may take: the cloth takes the rest. */
#define DRAWING_SHARE 0.6
/* Factor by which maps must be faster to be worth their error where neither holds the budget. */
#define WORTH 3

/* ---- The decision ---- */

#define OTHERWISE "light.visibility=rays, vsm or depth decides otherwise"

static void settle(struct tl_back_end *out, const char *why)
{
    snprintf(out->reason, sizeof out->reason, "rays: %s; " OTHERWISE, why);
}

static void describe(struct tl_back_end *out, double limit_ms)
{
    bool by_rays = out->visibility == TL_VISIBILITY_RAYS;
    char maps[48] = "";
    if (isfinite(out->maps_ms))
        snprintf(maps, sizeof maps, ", shadow maps %.1f ms", out->maps_ms);
    snprintf(out->reason, sizeof out->reason,
             "%s: to draw a frame of this scene rays take %.1f ms%s, of %.1f ms that the budget "
             "leaves; " OTHERWISE,
             by_rays ? "rays" : "vsm", out->rays_ms, maps, limit_ms);
}

static bool are_maps_worth_it(const struct tl_back_end *measured, double limit_ms)
{
    bool rays_hold = measured->rays_ms <= limit_ms, maps_hold = measured->maps_ms <= limit_ms;
    return !rays_hold && (maps_hold || WORTH * measured->maps_ms <= measured->rays_ms);
}

bool tl_back_end_choose(const struct tl_back_end_request *request, struct tl_back_end *out, tl_error *error)
{
    const double limit_ms = DRAWING_SHARE * request->budget_ms;
    *out = (struct tl_back_end){
        .visibility = TL_VISIBILITY_RAYS, .rays_ms = (double)NAN, .maps_ms = (double)NAN};
    if (request->needs_rays) {
        settle(out, "shadow maps do not show this material");
        return true;
    }
    if (request->budget_ms <= 0) {
        settle(out, "the more exact ones, as no budget is given");
        return true;
    }
    if (!request->measures_both && request->is_software) {
        settle(out, "GL runs on the CPU, where shadow maps take longer, so that nothing was measured");
        return true;
    }
    if (!request->measure(request->context, TL_VISIBILITY_RAYS, &out->rays_ms, error))
        return false;
    if ((request->measures_both || out->rays_ms > limit_ms) &&
        !request->measure(request->context, TL_VISIBILITY_VSM, &out->maps_ms, error))
        return false;
    if (are_maps_worth_it(out, limit_ms))
        out->visibility = TL_VISIBILITY_VSM;
    describe(out, limit_ms);
    return true;
}

/* ---- The measurement ---- */

#define FRAMES   8 /* the governor finds its levels within five */
#define LAST     3 /* of them, the fastest counts: what is not the program's makes a frame slower */
#define MOVED(i) ((uint64_t)(i) << 48)

struct meter {
    const struct tl_back_end_start *start;
    const struct tl_settings *settings;
};

/* Draws one frame at the levels that the governor chooses, and returns its time in ms. */
static bool draw_frame(const struct meter *meter, tl_quality_governor *governor, const tl_frame *frame,
                       const struct tl_settings *settings, double *ms, tl_error *error)
{
    tl_renderer *renderer = meter->start->renderer;
    double began_s = tl_clock_s();
    struct tl_quality_choice choice = tl_quality_governor_choose(governor, renderer, frame, settings);
    const struct tl_render_settings full = tl_settings_render(settings);
    const struct tl_render_settings drawn = tl_quality_at(&choice.levels, &full);
    if (!tl_renderer_draw(renderer, frame, &drawn, error))
        return false;
    *ms = 1000 * (tl_clock_s() - began_s);
    tl_quality_governor_learn(governor, tl_renderer_last_plan(renderer), 0, *ms);
    return true;
}

/* Surfaces that are marked as moved make the renderer do what it does in motion. */
static bool measure_frames(void *context, int visibility, double *ms, tl_error *error)
{
    const struct meter *meter = context;
    struct tl_settings settings = *meter->settings;
    settings.light.visibility = visibility;
    tl_frame frame = *meter->start->frame;
    tl_surface *moved = TL_NEW_ARRAY(tl_surface, frame.surface_count + 1);
    if (frame.surface_count > 0)
        memcpy(moved, frame.surfaces, frame.surface_count * sizeof *moved);
    frame.surfaces = moved;
    tl_quality_governor *governor = tl_quality_governor_create(DRAWING_SHARE * meter->start->budget_ms);
    bool done = true;
    *ms = INFINITY;
    for (int i = 0; done && i < FRAMES; i++) {
        for (size_t k = 0; k < frame.surface_count; k++)
            moved[k].motion_revision = meter->start->frame->surfaces[k].motion_revision + MOVED(i + 1);
        double took_ms = 0;
        done = draw_frame(meter, governor, &frame, &settings, &took_ms, error);
        if (i >= FRAMES - LAST)
            *ms = fmin(*ms, took_ms);
    }
    tl_quality_governor_destroy(&governor);
    done = done && tl_renderer_forget_scene(meter->start->renderer, error);
    free(moved);
    return done;
}

bool tl_back_end_calibrate(const struct tl_back_end_start *start, struct tl_settings *settings,
                           struct tl_back_end *out, tl_error *error)
{
    if (settings->light.visibility != TL_VISIBILITY_AUTO || settings->light.method != TL_METHOD_PEM) {
        *out = (struct tl_back_end){
            .visibility = settings->light.visibility, .rays_ms = (double)NAN, .maps_ms = (double)NAN};
        snprintf(out->reason, sizeof out->reason, "as light.visibility and light.method state");
        return true;
    }
    struct meter meter = {.start = start, .settings = settings};
    const struct tl_back_end_request request = {.budget_ms = start->budget_ms,
                                                .is_software = start->is_software,
                                                .needs_rays = tl_settings_need_rays(settings),
                                                .measures_both = start->measures_both,
                                                .measure = measure_frames,
                                                .context = &meter};
    if (!tl_back_end_choose(&request, out, error))
        return false;
    if (out->visibility != TL_VISIBILITY_RAYS)
        settings->light.visibility = out->visibility;
    if (isfinite(out->rays_ms))
        tl_info("visibility: %s", out->reason);
    else
        tl_debug("visibility: %s", out->reason);
    return true;
}
