/* Loads what a scene names: its avatar and its garment, from files or built in; places them, lifts a garment
 * onto the ground, splits edges across which cloth could not fold; logs what was guessed. Metres, world axes
 * with y up. Threads: any. */
#ifndef TOILE_APP_SCENE_LOAD_H
#define TOILE_APP_SCENE_LOAD_H

#include "app/settings/settings.h"
#include "assets/avatar.h"
#include "assets/base/garment.h"

/* Whether the garment plays a recorded motion in place of being simulated. */
bool tl_scene_plays_motion(const struct tl_settings *settings);

/* Loads the model of a scene that is undecided (tl_scene_params), and decides: stitches, or the shape of
 * something worn (app/fit/sewn.h), make it the garment, else it is the avatar. *out is the model, which the
 * functions below take instead of loading it again; empty for another scene. Errors: TL_INPUT. Lifetime: the
 * caller releases *out. */
bool tl_scene_decide(struct tl_scene_params *scene, tl_model *out, tl_error *error);

/* `loaded`: from tl_scene_decide, whose contents are taken over when the avatar is that file.
 * *out is NULL when the scene has no avatar; `clip` is the animation that it plays, -1: the rest pose.
 * Errors: TL_INPUT for a file or a clip, TL_USAGE for an option without meaning; *out may be set then.
 * Lifetime: the caller releases and frees *out. */
bool tl_scene_load_avatar(const struct tl_settings *settings, tl_model *loaded, tl_avatar **out, int *clip,
                          tl_error *error);

/* Loads again, and places, the file of an avatar that was simplified: with all of its vertices. Logs nothing.
 * Errors: as above. Lifetime: the caller releases *out. */
bool tl_scene_load_whole_avatar(const struct tl_settings *settings, tl_avatar *out, tl_error *error);

/* The steps by which a garment was placed. */
struct tl_scene_standing {
    float lifted_m; /* onto the ground */
    char *size;     /* one line about a garment that is of another size than its wearer; NULL: none */
    char *inside;   /* the same about one that lies inside its wearer (app/scene/drape.h) */
};

/* `loaded`: as above. `wearer` NULL: nobody wears it. *out is NULL when the scene has no garment.
 * Errors: as above. Lifetime: the caller releases and frees *out, and frees standing->size, also after an
 * error. */
bool tl_scene_load_garment(const struct tl_settings *settings, tl_model *loaded, const tl_avatar *wearer,
                           tl_garment **out, struct tl_scene_standing *standing, tl_error *error);

#endif
