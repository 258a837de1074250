/* Nine places to look from, with their light, kept for a scene: in a YAML file of option tables view1,
 * camera1, lamp1, fill1 ... fill9, of which only those of saved views are written.
 *
 * Pure but for the files. Units as in the tables. Failure: TL_USAGE or TL_INPUT for a file that makes no
 * sense, TL_OUTPUT for one that cannot be written. */
#ifndef TOILE_APP_VIEW_MEMORY_SAVED_VIEWS_H
#define TOILE_APP_VIEW_MEMORY_SAVED_VIEWS_H

#include "app/scene/settings.h"

#define TL_SAVED_VIEWS 9

struct tl_saved_view { /* tables "view1" ... : what the tables camera, lamp and fill do not hold */
    bool saved;
    char environment[TL_STRING_SIZE];
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

/* `share` of the way from one to the other, smoothly: angles the shorter way round, distances by ratios.
 * What cannot lie between (environment, lamps) is that of `to` from the start. Both distances above 0. */
struct tl_saved_view tl_saved_view_between(const struct tl_saved_view *from, const struct tl_saved_view *to,
                                           float share);

/* A missing file holds no views. On failure *out holds none. */
bool tl_saved_views_load(const char *file, struct tl_saved_views *out, tl_error *error);
/* Makes the file's folder too. */
bool tl_saved_views_save(const char *file, const struct tl_saved_views *views, tl_error *error);

/* The file's name for what is shown, of its garment and avatar: "dress-form-0123456789abcdef.yaml". New
 * string. */
char *tl_saved_views_name(const struct tl_scene_params *scene);

#endif
