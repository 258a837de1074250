#include "app/view/review/review_wipe.h"

#include "app/scene/appearance.h"
#include "app/view/review/review.h"
#include "app/view/review/review_edit.h"
#include "app/view/review/review_reading.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A loader of an appearance reads the models of a session. */
static void cancel_appearance(struct tl_review *review)
{
    if (review->load.loader && tl_loader_kind(review->load.loader) == TL_LOAD_APPEARANCE)
        tl_loader_cancel(&review->load.loader);
}

void tl_review_end_comparison(struct tl_review *review)
{
    if (review->wipe.session)
        cancel_appearance(review);
    tl_renderer_destroy(&review->wipe.renderer);
    tl_session_destroy(&review->wipe.session);
}

void tl_review_compare(struct tl_review *review)
{
    struct tl_review_wipe *wipe = &review->wipe;
    tl_error error;
    if (wipe->renderer) {
        tl_review_end_comparison(review);
        tl_review_report(review, "comparison ended");
        review->due.redraws = 1;
        return;
    }
    wipe->renderer = tl_renderer_create(review->screen.gpu, &error);
    if (!wipe->renderer) {
        tl_review_report_error(review, &error);
        return;
    }
    tl_prepared *light = tl_renderer_copy_prepared(review->renderer); /* both draw the same light */
    if (light)
        tl_renderer_take_prepared(wipe->renderer, &light,
                                  tl_session_frame(review->session).environment_revision);
    wipe->settings = review->good;
    wipe->place = 0.5f;
    tl_review_mark_old(review);
    tl_review_report(review,
                     "compares: A, left, stays as it is; change fabric, preset or options for B, which "
                     "is draped in its own fabric");
}

void tl_review_keep_for_a(struct tl_review *review, tl_session **left)
{
    struct tl_review_wipe *wipe = &review->wipe;
    if (!wipe->renderer || wipe->session)
        return;
    wipe->session = *left;
    wipe->draped = review->load.draped;
    *left = NULL;
    tl_info("view: A keeps its drape");
}

/* The sessions change places with the renderers that have drawn them; the light stays with B's. */
static void swap_sessions(struct tl_review *review)
{
    struct tl_review_wipe *wipe = &review->wipe;
    tl_session *session_b = review->session;
    const struct tl_cloth_fabric draped_b = review->load.draped;
    cancel_appearance(review);
    tl_session_exchange_light(review->session, wipe->session);
    review->session = wipe->session;
    review->load.draped = wipe->draped;
    wipe->session = session_b;
    wipe->draped = draped_b;
    review->input.reported_frame = -1;
}

void tl_review_swap(struct tl_review *review)
{
    if (!review->wipe.renderer) {
        tl_review_report(review, "nothing is compared: W starts a comparison");
        return;
    }
    tl_review_note_wanted(review);
    const struct tl_settings b = review->wanted;
    tl_review_settings_a(review, &b, &review->wanted);
    review->wanted.fabric = review->wipe.settings.fabric;
    review->wipe.settings = b;
    tl_renderer *renderer_b =
        review->renderer; /* each appearance keeps the renderer that has its resources */
    review->renderer = review->wipe.renderer;
    review->wipe.renderer = renderer_b;
    if (review->wipe.session)
        swap_sessions(review);
    review->load.appearance = review->wanted;
    tl_review_mark_changed(review);
    tl_review_note_reading(review);
    tl_review_report(review, "A and B exchanged");
}

/* Brings the session of A, which may be that of B, to the frame, and describes it. A's own session shows what
 * it holds in B's view: its camera, environment and lamps. */
static bool frame_of_a(struct tl_review *review, const struct tl_settings *settings, tl_frame *out,
                       tl_error *error)
{
    const struct tl_review_wipe *wipe = &review->wipe;
    if (!wipe->session) {
        if (!tl_session_apply(review->session, settings, error))
            return false;
        *out = tl_session_frame(review->session);
        return true;
    }
    struct tl_settings own = *settings;
    tl_settings_take(tl_session_settings(wipe->session), &own,
                     (struct tl_option_filter){.any_of = TL_AFFECTS_ENVIRONMENT});
    int number = tl_session_frame_number(review->session);
    if ((number != tl_session_frame_number(wipe->session) &&
         !tl_session_go_to(wipe->session, number, error)) ||
        !tl_session_apply(wipe->session, &own, error))
        return false;
    const tl_frame a = tl_session_frame(wipe->session);
    *out = tl_session_frame(review->session);
    out->surfaces = a.surfaces;
    out->surface_count = a.surface_count;
    return true;
}

bool tl_review_draw_a(struct tl_review *review, const struct tl_settings *settings, bool smooth,
                      tl_error *error)
{
    struct tl_settings a;
    tl_frame frame;
    tl_review_settings_a(review, settings, &a);
    const struct tl_render_settings full = tl_settings_render(&a);
    const struct tl_render_settings render = tl_quality_at(&review->image.choice.levels, &full);
    if (!frame_of_a(review, &a, &frame, error))
        return false;
    frame.smooth = smooth;
    return tl_renderer_draw(review->wipe.renderer, &frame, &render, error) &&
           (review->wipe.session || tl_session_apply(review->session, settings, error));
}

void tl_review_move_wipe(struct tl_review *review, float place)
{
    const float margin = 0.02f; /* so that the pointer can reach the line again */
    review->wipe.place = fminf(fmaxf(place, margin), 1 - margin);
    review->due.redraws = 2;
}

int tl_review_wipe_column(const struct tl_review *review, int width)
{
    return review->wipe.renderer ? (int)lrintf(review->wipe.place * (float)width) : 0;
}

void tl_review_settings_a(const struct tl_review *review, const struct tl_settings *settings,
                          struct tl_settings *out)
{
    const struct tl_settings *a = &review->wipe.settings;
    *out = *settings;
    if (review->wipe.session) {
        tl_settings_take(a, out, (struct tl_option_filter){.any_of = TL_AFFECTS_SCENE | TL_AFFECTS_GARMENT});
        out->colourways = a->colourways;
        out->fabric = a->fabric;
    }
    tl_appearance_take(a, out);
}

static const char *short_name(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

static void label(char *out, size_t size, const char *side, const struct tl_scene_params *scene,
                  bool has_own_drape, const char *difference)
{
    bool has_colourway = scene->colourway[0] != '\0', differs = difference[0] != '\0';
    snprintf(out, size, "%s  %.40s, %s%.40s%s%.30s%s%s%.60s%s", side, short_name(scene->fabric),
             has_colourway ? "colourway " : "", scene->colourway, has_colourway ? ", " : "",
             short_name(scene->preset), has_own_drape ? ", own drape" : "", differs ? " (" : "", difference,
             differs ? ")" : "");
}

void tl_review_wipe_labels(const struct tl_review *review, char *a, char *b, size_t size)
{
    const struct tl_settings *now = &review->good;
    struct tl_settings same;
    tl_review_settings_a(review, now, &same);
    char *difference = tl_history_describe(&same, now);
    bool has_own = review->wipe.session != NULL;
    label(a, size, "A", &same.scene, has_own, "");
    label(b, size, "B", &now->scene, has_own, strcmp(difference, "nothing") == 0 ? "the same" : difference);
    free(difference);
}
