/* light.visibility auto: rays, or shadow maps where rays cannot hold a frame's budget and maps can.
 *
 * Maps err about four times as much as rays (`toile fly --oracle 12 --size 256x256`, default dress in motion:
 * 16 to 18 % relative RMSE next to 4 %), and know no bounced light. So they are chosen for their time alone:
 * a few frames of each are drawn at start, with the levels that the governor gives to the budget; ties go to
 * rays. Where GL runs on the CPU maps cost more than rays: nothing is measured there unless asked for. */
#ifndef TOILE_APP_BUDGET_BACK_END_H
#define TOILE_APP_BUDGET_BACK_END_H

#include "app/settings/settings.h"

#include <stdbool.h>

/* Milliseconds of a frame that draws with a back-end (enum tl_visibility). */
typedef bool (*tl_back_end_measure)(void *context, int visibility, double *ms, tl_error *error);

struct tl_back_end_request {
    double budget_ms;   /* of a frame; 0: none */
    bool is_software;   /* GL runs on the CPU */
    bool needs_rays;    /* a material shows by rays alone */
    bool measures_both; /* also where the answer is known without */
    tl_back_end_measure measure;
    void *context;
};

struct tl_back_end {
    int visibility;          /* TL_VISIBILITY_RAYS or TL_VISIBILITY_VSM */
    double rays_ms, maps_ms; /* NaN: not measured */
    char reason[200];        /* one line: what was measured and chosen, and how to decide otherwise */
};

/* The decision. It measures rays, and maps where rays take too long. Errors: those of `measure`. */
bool tl_back_end_choose(const struct tl_back_end_request *request, struct tl_back_end *out, tl_error *error);

/* Replaces light.visibility auto in `settings` by maps where these are chosen; auto that remains means rays.
 * Any other value stands. `frame` is the first frame; measuring draws it with `renderer`, which then forgets
 * the scene. Errors: false, with `error` set, when drawing fails. */
struct tl_back_end_start {
    tl_renderer *renderer;
    const tl_frame *frame;
    double budget_ms;
    bool is_software, measures_both;
};
bool tl_back_end_calibrate(const struct tl_back_end_start *start, struct tl_settings *settings,
                           struct tl_back_end *out, tl_error *error);

#endif
