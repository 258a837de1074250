/* A session with a headless renderer: what every command without a window works on. */
#ifndef TOILE_APP_SCENE_HEADLESS_H
#define TOILE_APP_SCENE_HEADLESS_H

#include "app/cli/arguments.h"
#include "app/scene/session.h"

struct tl_headless {
    struct tl_settings settings;
    tl_session *session;
    tl_gpu *gpu;
    tl_renderer *renderer;
    bool aovs; /* frames are drawn with what render/inspect/aovs.h reads */
};

/* Device and session (settled) for settings, which become the session's. On failure nothing is left. */
bool tl_headless_open(struct tl_headless *headless, const struct tl_settings *settings, tl_error *error);
/* The same for the settings of the command line. */
bool tl_headless_create(struct tl_headless *headless, const struct tl_arguments *arguments, tl_error *error);
/* False for live light, of which no frame comes twice; `what`: the command. Call before the scene is opened.
 */
bool tl_headless_may_repeat(const struct tl_settings *settings, const char *what, tl_error *error);
void tl_headless_release(struct tl_headless *headless);

/* Draws the session's current frame. */
bool tl_headless_draw(struct tl_headless *headless, tl_error *error);
/* The same as a still image: with light.jitter it is drawn light.rounds times, which the renderer averages.
 * Ctrl-C ends the averaging; a caller that keeps the image checks tl_interrupted. */
bool tl_headless_draw_still(struct tl_headless *headless, tl_error *error);

#endif
