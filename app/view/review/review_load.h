/* Scenes, environments and appearances are loaded on a worker thread, while the window goes on with those
 * that it has. Owns `load`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_LOAD_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_LOAD_H

#include "app/settings/settings.h"
#include "app/view/loader/loader.h"
#include "app/view/panel/panel_shim.h"

struct tl_review;

struct tl_review_load {
    tl_loader *loader;             /* NULL: nothing is loading */
    bool drapes_again;             /* the loader drapes the present scene in another fabric */
    struct tl_cloth_fabric draped; /* that the garment hangs in, or that it was last draped in without success
                                    */
    struct tl_settings appearance; /* the settings of the last appearance that was loaded */
};

/* Starts and stops loaders as `wanted` demands, and takes over what one has loaded; called every frame. */
void tl_review_load(struct tl_review *review);
/* Stops loading and takes the edit that asked for it out of `wanted`. False when nothing is loading. */
bool tl_review_stop_loading(struct tl_review *review);
/* `wanted`, with the options that need loading as the session has them: what can be drawn now. */
void tl_review_drawable_settings(const struct tl_review *review, struct tl_settings *out);

/* The loader's progress for the panel; `text` holds its words. */
struct tl_panel_progress tl_review_progress(const struct tl_review *review, char *text, size_t size);

/* The first scene, when there is no session yet: starts a loader; makes the session of what it has loaded. */
void tl_review_start_first(struct tl_review *review);
bool tl_review_finish_first(struct tl_review *review, tl_error *error);

#endif
