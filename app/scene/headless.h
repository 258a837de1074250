/* A session with a headless renderer: what every command without a window works on. */
#ifndef TOILE_APP_SCENE_HEADLESS_H
#define TOILE_APP_SCENE_HEADLESS_H

#include "app/cli/arguments.h"
#include "app/scene/session.h"

struct tl_stage {
    struct tl_settings settings;
    tl_session *session;
    tl_gpu *gpu;
    tl_renderer *renderer;
    bool aovs; /* frames are drawn with what render/inspect/aovs.h reads */
};

/* Settings from the command line: its scene and its assignments. */
bool tl_stage_settings(const struct tl_arguments *arguments, struct tl_settings *out, tl_error *error);

/* Device and session (settled) for settings. On failure nothing is left. */
bool tl_stage_open(struct tl_stage *stage, const struct tl_settings *settings, tl_error *error);
/* Both. */
bool tl_stage_create(struct tl_stage *stage, const struct tl_arguments *arguments, tl_error *error);
void tl_stage_release(struct tl_stage *stage);

/* Draws the session's current frame. */
bool tl_stage_draw(struct tl_stage *stage, tl_error *error);
/* The same as a still image: with light.jitter it is drawn light.rounds times, which the renderer averages.
 * Ctrl-C ends the averaging, not the image: who keeps it asks tl_interrupted. */
bool tl_stage_draw_still(struct tl_stage *stage, tl_error *error);

#endif
