/* The plan of a contact sheet: a row for each garment, fabric and colourway, a column for each environment
 * and view. Every cell has a stable file name and a hash of everything that its picture depends on. Angles
 * are in degrees. Threads: a plan is read-only once made. */
#ifndef TOILE_APP_SHEET_CONTACT_PLAN_H
#define TOILE_APP_SHEET_CONTACT_PLAN_H

#include "app/cli/arguments.h"
#include "app/scene/path.h"
#include "app/settings/settings.h"
#include "app/sheet/contact_layout.h"

#define TL_CONTACT_CELLS_MAX 4096

enum tl_contact_camera {
    TL_CONTACT_ORBIT, /* the scene's camera, turned; it frames the garment unless the scene places it */
    TL_CONTACT_SCENE, /* the scene's camera */
    TL_CONTACT_KEY    /* a key of a camera path */
};

struct tl_contact_view {
    char *name;
    enum tl_contact_camera camera;
    bool has_pitch;           /* else the scene's pitch is kept */
    float yaw_deg, pitch_deg; /* of TL_CONTACT_ORBIT */
    struct tl_path_key key;   /* of TL_CONTACT_KEY */
};

struct tl_contact_row {
    char *garment, *name; /* labels */
    char *slug;           /* part of file names */
    struct tl_settings settings;
    uint64_t hash; /* of the settings and of the files that they name */
};

struct tl_contact_column {
    char *environment; /* a value of scene.environment */
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
    struct tl_contact_grid grid; /* borrows the texts above */
    bool same_drape;             /* the first fabric's drape serves for all rows of a garment */
};

/* Makes the plan that the command line asks for; release it with tl_contact_plan_release. Reads all settings,
 * so that a wrong name fails before anything is rendered. Errors: false with TL_USAGE or TL_INPUT, and
 * nothing to release. */
bool tl_contact_plan_make(const struct tl_arguments *arguments, struct tl_contact_plan *out, tl_error *error);
void tl_contact_plan_release(struct tl_contact_plan *plan);

/* Reads a view: "front", "back-3/4", "scene", or YAW or YAW:PITCH in degrees. The caller frees `out->name`.
 */
bool tl_contact_view_read(const char *text, struct tl_contact_view *out, tl_error *error);

/* Combines a row's settings with a column's environment and view. An orbiting camera has its angles, but no
 * place yet: that follows from the drape. */
bool tl_contact_cell_settings(const struct tl_contact_plan *plan, size_t row, size_t column,
                              struct tl_settings *out, tl_error *error);

/* Returns a cell's file name, such as "dress_satin_studio_front.png", as a new string. No two cells of a plan
 * have the same name. */
char *tl_contact_cell_name(const struct tl_contact_plan *plan, size_t row, size_t column);
/* Returns the hash of the settings, files, view and program version that a cell shows. */
uint64_t tl_contact_cell_hash(const struct tl_contact_plan *plan, size_t row, size_t column);

#endif
