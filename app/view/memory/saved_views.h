/* Nine saved views of a scene, each a camera with its light: a YAML file of option tables view1, camera1,
 * lamp1, fill1
 * ... fill9, of which only those of saved views are written.
 *
 * Pure except for the files. Units as in the tables. Errors: TL_USAGE or TL_INPUT for a malformed file,
 * TL_OUTPUT for one that cannot be written. Threads: any, one at a time for a file. */
#ifndef TOILE_APP_VIEW_MEMORY_SAVED_VIEWS_H
#define TOILE_APP_VIEW_MEMORY_SAVED_VIEWS_H

#include "app/settings/settings.h"

#define TL_SAVED_VIEWS 9

struct tl_saved_view { /* tables "view1" ...: the fields that the tables camera, lamp and fill do not have */
    bool saved;
    const char *environment;
    float environment_yaw_deg;
    float exposure_ev;
    struct tl_camera_params camera;
    struct tl_lamp_params lamp, fill;
};

struct tl_saved_views {
    struct tl_saved_view of[TL_SAVED_VIEWS];
};

struct tl_saved_view tl_saved_view_take(const struct tl_settings *settings);
void tl_saved_view_apply(const struct tl_saved_view *view, struct tl_settings *settings);

/* The view at `share` of a smooth transition: angles take the shorter way, distances change by equal ratios.
 * Fields that cannot be interpolated (environment, lamps) are those of `to` from the start. Both distances
 * must be above 0. */
struct tl_saved_view tl_saved_view_between(const struct tl_saved_view *from, const struct tl_saved_view *to,
                                           float share);

/* A missing file holds no views. On failure *out holds none. */
bool tl_saved_views_load(const char *file, struct tl_saved_views *out, tl_error *error);
/* Creates the file's folder. */
bool tl_saved_views_save(const char *file, const struct tl_saved_views *views, tl_error *error);

/* The file's name for a scene, from its garment and avatar: "dress-form-0123456789abcdef.yaml". New string.
 */
char *tl_saved_views_name(const struct tl_scene_params *scene);

#endif
