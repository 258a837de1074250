#include "app/view/review/review_load.h"

#include "app/view/review/review.h"
#include "app/view/review/review_keep.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_reading.h"
#include "app/view/review/review_wipe.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"

#include <omp.h>
#include <string.h>

/* Whether an appearance must be loaded first: the session does not have it, and it was not loaded last.
 * Nothing can be prepared for an environment sequence, whose light changes with every frame. While a slider
 * is held, options whose rows have AT_ONCE are applied at once. */
static bool needs_appearance(const struct tl_review *review, const struct tl_settings *settings)
{
    struct tl_settings present = *tl_session_settings(review->session);
    if (review->input.editing)
        tl_settings_take(settings, &present, (struct tl_option_filter){.any_of = TL_AFFECTS_AT_ONCE});
    return !tl_session_light_plays(review->session) && tl_session_needs_appearance(&present, settings) &&
           tl_session_needs_appearance(&review->load.appearance, settings);
}

static bool is_slow(const struct tl_review *review, const struct tl_settings *settings)
{
    const struct tl_settings *present = tl_session_settings(review->session);
    return tl_session_needs_scene(present, settings) || tl_session_needs_light(present, settings) ||
           needs_appearance(review, settings);
}

/* Sets the options that need loading to the values that the session has; an appearance is the last one that
 * was drawn. */
static void keep_present(const struct tl_review *review, struct tl_settings *settings)
{
    const struct tl_settings *present = tl_session_settings(review->session);
    tl_session_keep_scene(present, settings);
    if (needs_appearance(review, settings))
        tl_appearance_take(&review->good, settings);
}

void tl_review_drawable_settings(const struct tl_review *review, struct tl_settings *out)
{
    *out = review->wanted;
    if (is_slow(review, out))
        keep_present(review, out);
}

/* Leaves a core to the window. */
static int loader_threads(void)
{
    int cores = omp_get_num_procs();
    return cores > 1 ? cores - 1 : 1;
}

/* Requests the light of every number of regions that the governor's levels may choose. */
static struct tl_prepared_request light_of(const struct tl_review *review, const struct tl_settings *settings)
{
    struct tl_prepared_request request = {.settings = tl_settings_render(settings)};
    request.region_counts[0] = settings->light.regions;
    for (int level = 1; review->screen.params.budget_ms > 0 && level < TL_PREPARED_COUNTS_MAX; level++) {
        struct tl_quality levels = {.of[TL_CONTROL_REGIONS] = (uint8_t)level};
        if (!tl_quality_is_valid(&levels))
            break;
        int regions = tl_quality_at(&levels, &request.settings).light.regions;
        request.region_counts[level] = regions < request.region_counts[level - 1] ? regions : 0;
        if (request.region_counts[level] == 0)
            break;
    }
    return request;
}

/* A scene needs its own light; an environment, the lobes of the appearances that are shown; an appearance,
 * which is B's, its own lobes in addition to those of B's renderer, so that going back costs nothing. */
static struct tl_load_lights lights_of(struct tl_review *review, enum tl_load kind)
{
    const tl_renderer *renderers[TL_LOADER_LIGHTS_MAX] = {review->renderer, review->wipe.renderer};
    struct tl_settings drawn = review->wanted;
    if (kind == TL_LOAD_LIGHT &&
        needs_appearance(review, &drawn)) /* the appearance is loaded after the light */
        tl_appearance_take(tl_session_settings(review->session), &drawn);
    struct tl_settings other;
    tl_review_settings_a(review, &drawn, &other);
    struct tl_load_lights lights = {.count = review->wipe.renderer && kind != TL_LOAD_APPEARANCE ? 2 : 1,
                                    .of = {light_of(review, &drawn), light_of(review, &other)}};
    for (int i = 0; i < lights.count && kind != TL_LOAD_SCENE; i++)
        lights.of[i].exponents = tl_renderer_exponents(renderers[i]);
    if (kind == TL_LOAD_APPEARANCE) {
        lights.of[0].environment = tl_session_frame(review->session).environment;
        lights.of[0].known = tl_renderer_copy_prepared(review->renderer);
    }
    return lights;
}

/* Whether the garment hangs as it was draped, and does not set out to move. */
static bool hangs(const struct tl_review *review)
{
    return !review->play.is_on && tl_session_frame_number(review->session) == 0 &&
           tl_session_cloth(review->session) && !tl_session_is_undraped(review->session);
}

static bool is_same_fabric(const struct tl_cloth_fabric *a, const struct tl_cloth_fabric *b)
{
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): floats as they were set
    return memcmp(a, b, sizeof *a) == 0;
}

/* Whether the garment hangs in another fabric than it was draped in: it would hang otherwise. Cloth that
 * moves takes a new fabric up as it moves on. */
static bool wants_drape(const struct tl_review *review)
{
    return hangs(review) && !is_same_fabric(&review->load.draped, &review->wanted.fabric);
}

static enum tl_load what_to_load(const struct tl_review *review)
{
    const struct tl_settings *present = tl_session_settings(review->session);
    return tl_session_needs_scene(present, &review->wanted)   ? TL_LOAD_SCENE
           : tl_session_needs_light(present, &review->wanted) ? TL_LOAD_LIGHT
           : needs_appearance(review, &review->wanted)        ? TL_LOAD_APPEARANCE
                                                              : TL_LOAD_SCENE;
}

static void start(struct tl_review *review)
{
    enum tl_load kind = what_to_load(review);
    const struct tl_load_lights lights = lights_of(review, kind);
    const struct tl_session_models models = tl_session_models(review->session);
    review->load.loader =
        tl_loader_start(kind, &review->wanted, &models, &lights, loader_threads(), tl_window_wake);
    const struct tl_scene_params *scene = &review->wanted.scene;
    review->load.drapes_again = kind == TL_LOAD_SCENE && !is_slow(review, &review->wanted);
    if (review->load.drapes_again)
        tl_info("view: drapes %s in %s", scene->garment, scene->fabric);
    else if (kind != TL_LOAD_APPEARANCE)
        tl_info("view: loads %s", kind == TL_LOAD_SCENE ? scene->garment : scene->environment);
}

/* Whether `wanted` has changed since the loader was started. */
static bool is_outdated(const struct tl_review *review)
{
    const struct tl_settings *made = tl_loader_settings(review->load.loader);
    if (review->load.drapes_again &&
        (!hangs(review) || !is_same_fabric(&made->fabric, &review->wanted.fabric)))
        return true;
    return tl_session_needs_scene(made, &review->wanted) || tl_session_needs_light(made, &review->wanted) ||
           ((review->load.drapes_again || tl_loader_kind(review->load.loader) == TL_LOAD_APPEARANCE) &&
            tl_session_needs_appearance(made, &review->wanted));
}

/* Hands the loaded light to the renderers. */
static void take_lights(struct tl_review *review, struct tl_loaded *loaded)
{
    uint64_t revision = tl_session_frame(review->session).environment_revision;
    tl_renderer *renderers[TL_LOADER_LIGHTS_MAX] = {review->renderer, review->wipe.renderer};
    for (int i = 0; i < TL_LOADER_LIGHTS_MAX; i++)
        if (renderers[i] && loaded->prepared[i])
            tl_renderer_take_prepared(renderers[i], &loaded->prepared[i], revision);
}

/* A comparison keeps the old one, if it has none, and its view: another drape may be framed otherwise. */
static void take_session(struct tl_review *review, tl_session **loaded)
{
    tl_session *old = review->session;
    if (review->wipe.renderer)
        tl_review_fix_camera(review);
    tl_session_show_placed(old, &(struct tl_placing){.scale = 1}); /* A stays where it was */
    tl_session_succeed(*loaded, old);
    review->session = *loaded;
    *loaded = NULL;
    tl_review_keep_for_a(review, &old);
    tl_session_destroy(&old);
}

static void finish(struct tl_review *review)
{
    enum tl_load kind = tl_loader_kind(review->load.loader);
    const struct tl_settings made_of = *tl_loader_settings(review->load.loader);
    const char *environment = review->wanted.scene.environment;
    struct tl_loaded loaded;
    tl_error error;
    bool is_loaded = tl_loader_take(&review->load.loader, &loaded, &error);
    if (!is_loaded) {
        keep_present(review, &review->wanted);
        tl_review_report_error(review, &error);
    } else if (kind == TL_LOAD_APPEARANCE) {
        tl_session_keep_appearance(review->session, &made_of, &loaded.appearance);
        take_lights(review, &loaded);
        review->load.appearance = made_of;
    } else if (kind == TL_LOAD_SCENE) {
        take_session(review, &loaded.session);
        take_lights(review, &loaded);
        if (review->load.drapes_again)
            tl_info("view: %s hangs in %s", made_of.scene.garment, made_of.scene.fabric);
        review->input.reported_frame = -1;
        if (review->input.drag == TL_DRAG_CLOTH)
            tl_review_set_drag(review, TL_DRAG_NONE); /* the cloth that was pulled is gone */
        tl_review_note_reading(review);
        tl_review_keep_recent(review);
    } else {
        tl_session_replace_light(review->session, &loaded.light, environment);
        take_lights(review, &loaded);
    }
    if (kind == TL_LOAD_SCENE && (is_loaded || review->load.drapes_again))
        review->load.draped = made_of.fabric; /* what cannot be draped is not tried again */
    tl_loaded_release(&loaded);
}

/* A stopped loader still finishes its current step. The window does not wait for it: the next loader starts
 * once it is done. */
void tl_review_load(struct tl_review *review)
{
    if (review->load.loader && is_outdated(review))
        tl_loader_stop(review->load.loader);
    if (review->load.loader && tl_loader_is_done(review->load.loader)) {
        if (tl_loader_is_stopped(review->load.loader))
            tl_loader_cancel(&review->load.loader);
        else
            finish(review);
        tl_review_mark_changed(review);
    }
    bool waits = review->load.loader || review->input.editing || review->input.drag == TL_DRAG_PLACE;
    if (!waits && ((review->due.changed && is_slow(review, &review->wanted)) || wants_drape(review)))
        start(review);
}

bool tl_review_stop_loading(struct tl_review *review)
{
    struct tl_settings kept = review->wanted;
    if (review->load.loader && !review->load.drapes_again)
        keep_present(review, &kept);
    if (!review->load.loader || (!review->load.drapes_again && tl_settings_equal(&kept, &review->wanted)))
        return false; /* the loader, if any, prepares what was not asked for, or is stopped already */
    tl_loader_stop(review->load.loader);
    review->wanted = kept;
    if (review->load.drapes_again)
        review->load.draped = review->wanted.fabric;
    tl_review_mark_changed(review);
    tl_review_report(review, review->load.drapes_again ? "draping was stopped: the garment hangs as before"
                                                       : "loading was stopped: the scene is unchanged");
    return true;
}

struct tl_panel_progress tl_review_progress(const struct tl_review *review, char *text, size_t size)
{
    if (!review->load.loader || tl_loader_is_stopped(review->load.loader))
        return (struct tl_panel_progress){0};
    const struct tl_scene_params *scene = &tl_loader_settings(review->load.loader)->scene;
    enum tl_load kind = tl_loader_kind(review->load.loader);
    const char *name = kind == TL_LOAD_LIGHT                 ? scene->environment
                       : kind == TL_LOAD_APPEARANCE          ? scene->fabric
                       : strcmp(scene->garment, "none") == 0 ? scene->avatar
                                                             : scene->garment;
    const char *slash = strrchr(name, '/');
    struct tl_load_progress progress = tl_loader_progress(review->load.loader);
    const double unseen_s = 0.3; /* most appearances load faster: the progress would only flicker */
    if (kind == TL_LOAD_APPEARANCE && progress.seconds < unseen_s)
        return (struct tl_panel_progress){0};
    bool is_known = progress.what[0] != '\0';
    bool drapes = review->load.drapes_again || (kind == TL_LOAD_SCENE && scene->drape == TL_DRAPE_SETTLE);
    snprintf(text, size, "%s %.100s%s%s", drapes ? "Draping" : "Loading", slash ? slash + 1 : name,
             is_known ? ": " : "", progress.what);
    return (struct tl_panel_progress){.what = text,
                                      .share = is_known ? (float)progress.share : -1,
                                      .hint = review->session ? "Esc stops it" : "Esc leaves"};
}

void tl_review_start_first(struct tl_review *review)
{
    const struct tl_load_lights lights = lights_of(review, TL_LOAD_SCENE);
    review->load.loader = tl_loader_start(TL_LOAD_SCENE, &review->wanted, NULL, &lights, 0, tl_window_wake);
}

bool tl_review_finish_first(struct tl_review *review, tl_error *error)
{
    struct tl_loaded loaded;
    if (!tl_loader_take(&review->load.loader, &loaded, error))
        return false;
    review->session = loaded.session;
    loaded.session = NULL;
    review->wanted.scene =
        tl_session_settings(review->session)->scene; /* garment or body, if that was open */
    review->load.draped = review->wanted.fabric;
    tl_review_note_reading(review);
    tl_review_keep_recent(review);
    take_lights(review, &loaded);
    tl_loaded_release(&loaded);
    return true;
}
