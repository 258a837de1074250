/* How garment and avatar look: the materials of their files, what the settings' fabric makes of the
 * garment's, and what the colourway changes: scene.colourway's looks (app/settings/colourway.h) and the
 * files' own variants. Never how anything moves. Reads weave.picture's file and nothing else. */
#ifndef TOILE_APP_SCENE_APPEARANCE_H
#define TOILE_APP_SCENE_APPEARANCE_H

#include "app/scene/moving.h"
#include "app/settings/settings.h"

struct tl_woven {
    struct tl_weave_params params;
    tl_weave *weave;
};

struct tl_looks {
    struct tl_dressing garment, avatar; /* empty where there is none */
    struct tl_woven *weaves;            /* what the garment's materials point to, and their plain maps */
    size_t weave_count;
    tl_image **images;
    size_t image_count;
    char **names; /* colourways: the scene's, then the variants of garment and avatar; each once */
    size_t name_count;
};

/* Either model may be NULL. Fails when nobody knows the colourway, the garment has no material of a name that
 * it gives, or a weave's picture cannot be read. */
bool tl_looks_make(const struct tl_settings *settings, const tl_model *garment, const tl_model *avatar,
                   struct tl_looks *out, tl_error *error);
void tl_looks_release(struct tl_looks *looks); /* frees and zeroes */

/* Whether two settings make the same looks of the same models. */
bool tl_looks_are_same(const struct tl_settings *a, const struct tl_settings *b);

/* Gives `settings` the look of others, and the way in which it is drawn: what may differ between two looks
 * that are compared. Camera, light and cloth stay; of another garment, its colourways. Pure. */
void tl_looks_take(const struct tl_settings *look, struct tl_settings *settings);

#endif
