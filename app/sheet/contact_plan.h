/* What a contact sheet shows: garments, and for each its fabrics and colourways, down; environments, and for
 * each the views, across. Every cell has a stable file name and a hash of all that its picture depends on. */
#ifndef TOILE_APP_SHEET_CONTACT_PLAN_H
#define TOILE_APP_SHEET_CONTACT_PLAN_H

#include "app/cli/arguments.h"
#include "app/scene/path.h"
#include "app/scene/settings.h"
#include "app/sheet/contact_layout.h"

#define TL_CONTACT_CELLS_MAX 4096

enum tl_contact_camera {
    TL_CONTACT_ORBIT, /* the scene's, turned; it frames the garment unless the scene has placed it */
    TL_CONTACT_SCENE, /* the scene's own */
    TL_CONTACT_KEY    /* of a camera path */
};

struct tl_contact_view {
    char *name;
    enum tl_contact_camera camera;
    bool has_pitch;
    float yaw_deg, pitch_deg;
    struct tl_path_key key;
};

struct tl_contact_row {
    char *garment, *name; /* labels */
    char *slug;           /* part of file names */
    struct tl_settings settings;
    uint64_t hash;
};

struct tl_contact_column {
    char *environment; /* for scene.environment */
    struct tl_contact_view view;
    char *group, *slug;
};

struct tl_contact_plan {
    struct tl_contact_row *rows;
    size_t row_count;
    struct tl_contact_column *columns;
    size_t column_count;
    char *title, *note;
    struct tl_contact_label *row_labels, *column_labels;
    struct tl_contact_grid grid; /* all of the above, for show */
    bool same_drape;
};

/* From the command line; all settings are read, so that a name that is wrong is told before any work. */
bool tl_contact_plan_make(const struct tl_arguments *arguments, struct tl_contact_plan *out, tl_error *error);
void tl_contact_plan_release(struct tl_contact_plan *plan);

/* "front", "back-3/4", "scene", or YAW or YAW:PITCH in degrees. */
bool tl_contact_view_read(const char *text, struct tl_contact_view *out, tl_error *error);

/* A row's settings with a column's environment and view, but for where the camera is. */
bool tl_contact_cell_settings(const struct tl_contact_plan *plan, size_t row, size_t column,
                              struct tl_settings *out, tl_error *error);

/* "dress_satin_studio_front.png": new string; no two cells of a plan have one name. */
char *tl_contact_cell_name(const struct tl_contact_plan *plan, size_t row, size_t column);
uint64_t tl_contact_cell_hash(const struct tl_contact_plan *plan, size_t row, size_t column);

#endif
