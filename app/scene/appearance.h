/* The appearance of garment and avatar: the materials of their files, what the settings' fabric makes of the
 * garment's, and what scene.colourway changes: the swatches of the scene (app/settings/colourway.h) and the
 * files' own variants. Never how anything moves. Reads the files of weave.picture, weave.pictures and
 * material.samples,
 * detail.normals and detail.heights and no other.
 *
 * Threads: pure, but for reading that file; an appearance may be made on any thread while the models are not
 * written to. */
#ifndef TOILE_APP_SCENE_APPEARANCE_H
#define TOILE_APP_SCENE_APPEARANCE_H

#include "app/display/moving.h"
#include "app/settings/settings.h"
#include "app/textures/measured_files.h"
#include "app/textures/weaves.h"

struct tl_appearance {
    struct tl_dressing garment, avatar; /* empty where there is none */
    const struct tl_fabric_pictures *
        *weaves; /* the garment's materials point to these, which are shared ... */
    size_t weave_count;
    const struct tl_measured **measured; /* ... these, shared too ... */
    size_t measured_count;
    tl_image **images; /* ... and to these: colour maps without their print */
    size_t image_count;
    char **names; /* colourways: the scene's, then the variants of garment and avatar; each once */
    size_t name_count;
};

/* Makes the appearance of the models, either of which may be NULL.
 * Errors: TL_USAGE when neither the scene nor a model has the colourway, or the garment has no material of a
 * name that the colourway gives; those of tl_weaves_take and tl_measured_take. `out` is then empty.
 * Lifetime: the caller releases `out`; it refers to the models' maps, so it is released before they are. */
bool tl_appearance_make(const struct tl_settings *settings, const tl_model *garment, const tl_model *avatar,
                        struct tl_appearance *out, tl_error *error);
void tl_appearance_release(struct tl_appearance *appearance); /* frees and zeroes */

/* True when two settings give the same models the same appearance. */
bool tl_appearance_is_same(const struct tl_settings *a, const struct tl_settings *b);

/* Appearances that were made and are not shown: the newest first. Comparisons alternate between two. */
struct tl_spare_appearance {
    bool is_kept;
    struct tl_appearance appearance;
    uint64_t revision;
    struct tl_settings made_of;
};
#define TL_SPARE_APPEARANCES 2

/* The one that these settings would make; NULL: none is kept. */
struct tl_spare_appearance *tl_spare_find(struct tl_spare_appearance spares[TL_SPARE_APPEARANCES],
                                          const struct tl_settings *settings);

/* Keeps an appearance, whose contents it takes, in place of the oldest one. */
void tl_spare_add(struct tl_spare_appearance spares[TL_SPARE_APPEARANCES], const struct tl_settings *made_of,
                  const struct tl_appearance *appearance, uint64_t revision);

/* The options that may differ between two appearances: colourways belong to a garment, so another garment
 * keeps its own. Pure. */
struct tl_option_filter tl_appearance_filter(const struct tl_settings *a, const struct tl_settings *b);

/* Copies into `settings` the options of `from` that may differ between two appearances under comparison:
 * those of materials, and of how they are drawn. Camera, light and cloth stay; so do the colourways of
 * another garment. Pure. */
void tl_appearance_take(const struct tl_settings *from, struct tl_settings *settings);

#endif
