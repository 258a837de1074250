#include "app/view/review/review_wipe.h"

#include "app/scene/appearance.h"
#include "config/log.h"
#include "config/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tl_review_compare(struct tl_review *review)
{
    struct tl_review_wipe *wipe = &review->wipe;
    tl_error error;
    if (wipe->renderer) {
        tl_renderer_destroy(&wipe->renderer);
        tl_review_report(review, "comparison ended");
        review->redraws = 1;
        return;
    }
    wipe->renderer = tl_renderer_create(review->gpu, &error);
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
    review->image_is_old = true;
    tl_review_report(review,
                     "compares: A, left, keeps its appearance; change fabric, preset or options for B");
}

void tl_review_swap(struct tl_review *review)
{
    if (!review->wipe.renderer) {
        tl_review_report(review, "nothing is compared: W starts a comparison");
        return;
    }
    struct tl_settings b = review->wanted;
    review->wanted = tl_review_settings_a(review, &b);
    review->wipe.settings = b;
    tl_renderer *renderer_b =
        review->renderer; /* each appearance keeps the renderer that has its resources */
    review->renderer = review->wipe.renderer;
    review->wipe.renderer = renderer_b;
    review->loaded_appearance = review->wanted;
    review->changed = true;
    tl_review_report(review, "A and B exchanged");
}

void tl_review_move_wipe(struct tl_review *review, float place)
{
    const float margin = 0.02f; /* so that the pointer can reach the line again */
    review->wipe.place = fminf(fmaxf(place, margin), 1 - margin);
    review->redraws = 2;
}

int tl_review_wipe_column(const struct tl_review *review, int width)
{
    return review->wipe.renderer ? (int)lrintf(review->wipe.place * (float)width) : 0;
}

struct tl_settings tl_review_settings_a(const struct tl_review *review, const struct tl_settings *settings)
{
    struct tl_settings result = *settings;
    tl_appearance_take(&review->wipe.settings, &result);
    return result;
}

static const char *short_name(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

static void label(char *out, size_t size, const char *side, const struct tl_scene_params *scene,
                  const char *difference)
{
    bool has_colourway = scene->colourway[0] != '\0', differs = difference[0] != '\0';
    snprintf(out, size, "%s  %.40s, %s%.40s%s%.30s%s%.120s%s", side, short_name(scene->fabric),
             has_colourway ? "colourway " : "", scene->colourway, has_colourway ? ", " : "",
             short_name(scene->preset), differs ? " (" : "", difference, differs ? ")" : "");
}

void tl_review_wipe_labels(const struct tl_review *review, char *a, char *b, size_t size)
{
    const struct tl_settings *now = &review->good;
    struct tl_settings same = tl_review_settings_a(review, now);
    char *difference = tl_history_describe(&same, now);
    label(a, size, "A", &same.scene, "");
    label(b, size, "B", &now->scene, strcmp(difference, "nothing") == 0 ? "the same" : difference);
    free(difference);
}
