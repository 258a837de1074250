/* Every params struct, one value; and the layers that fill it: defaults < preset < fabric < scene file <
 * command line. */
#ifndef TOILE_APP_SETTINGS_SETTINGS_H
#define TOILE_APP_SETTINGS_SETTINGS_H

#include "app/settings/colourway.h"
#include "assets/base/placing.h"
#include "assets/cut/options.h"
#include "assets/weave/weave.h"
#include "cloth/cloth.h"
#include "config/options.h"
#include "render/brdf/options.h"
#include "render/construction/options.h"
#include "render/local/lamp.h"
#include "render/renderer.h"

/* Whether a heavy body that wears a garment is simplified. */
enum tl_body_detail { TL_BODY_AUTO, TL_BODY_FULL };
enum tl_drape_choice { TL_DRAPE_AUTO, TL_DRAPE_AUTHORED, TL_DRAPE_SETTLE };

struct tl_scene_params {     /* table "scene": what to show; names of built-ins or paths */
    const char *garment;     /* "dress", "skirt", "layers", a specimen, "none", or a glTF or OBJ file */
    const char *avatar;      /* "auto", "form", "none", or a glTF or OBJ file */
    int units, avatar_units; /* enum tl_units: of their files */
    int drape;               /* enum tl_drape_choice */
    int body_detail;         /* enum tl_body_detail */
    bool refit;              /* built-in garments cut for the form are scaled to the avatar */
    int up, avatar_up;       /* enum tl_up: of their files */
    float turn_deg, scale, move_m[3]; /* places the garment's file */
    bool pattern;                     /* its pieces hang beside it */
    bool smooth;                      /* it is drawn as Loop's surface */
    const char *motion;               /* point cache that moves the garment, or "none": it is simulated */
    float motion_rate;                /* frames of it a second; 0: as its file states */
    const char *environment;          /* "studio", an .exr or .hdr file, or a pattern: sky.####.exr */
    const char *fabric;               /* name of an embedded fabric, a YAML file, or "none" */
    const char *colourway;  /* name of one of the scene's or of a model's variants; "": as they are */
    const char *colourways; /* scene, built in or YAML, that has them; "own": the garment's */
    const char *preset;     /* name of an embedded preset, or a YAML file */
    const char *clip;       /* animation of the avatar; "": the first; "none": the rest pose */
    float environment_yaw_deg;
    float environment_rate; /* frames of a sequence a second */
    /* No option: the avatar is a model in place of a scene, of which nothing states whether it is a garment.
     * A session decides by its shape when it has loaded it, and its own settings state the decision
     * (app/scene/load.h). */
    bool is_undecided;
};

struct tl_camera_params { /* table "camera": an orbit about a target */
    float yaw_deg;        /* 0 looks from +Z; positive moves the eye towards +X */
    float pitch_deg;      /* positive looks down */
    float distance_m;     /* 0: frames what is there */
    float target[3];      /* metres; used when distance_m > 0 */
    float fov_deg;        /* vertical */
};
extern const struct tl_option_table tl_camera_options;

/* Copied by assignment: its texts and colourways are shared and live as long as the program. Functions take
 * and fill it by pointer. */
struct tl_settings {
    struct tl_scene_params scene;
    struct tl_camera_params camera;
    struct tl_cut_params cut;
    struct tl_cloth_params cloth;
    struct tl_cloth_fabric fabric;
    struct tl_weave_params weave;
    struct tl_material_params material;
    struct tl_construction_params construction;
    const struct tl_colourways *colourways; /* follow from scene.colourway, .colourways and .garment */
    struct tl_light_params light;
    struct tl_detail_params detail;
    struct tl_maps_params maps;
    struct tl_lamp_params lamp, fill;
    struct tl_shading_params shading;
    struct tl_image_params image;
    struct tl_reference_params reference;
};

#define TL_SETTINGS_TABLES 16
/* The bindings of a settings value, in the order of the reference page. */
void tl_settings_bind(struct tl_settings *settings, struct tl_binding bindings[TL_SETTINGS_TABLES]);

/* The same for settings that are only read through the bindings. */
void tl_settings_bind_const(const struct tl_settings *settings,
                            struct tl_binding bindings[TL_SETTINGS_TABLES]);
/* The defaults of every option; no colourways. */
void tl_settings_reset(struct tl_settings *settings);

/* True when every option of every table agrees. */
bool tl_settings_equal(const struct tl_settings *a, const struct tl_settings *b);

/* Compares, or copies from `from` to `to`, the options whose rows pass a filter: those that affect a given
 * part (config/options.h). Pure. */
bool tl_settings_differ(const struct tl_settings *a, const struct tl_settings *b,
                        struct tl_option_filter filter);
/* The bits of all that the options affect that differ: 0 when all agree. Pure. */
uint64_t tl_settings_changes(const struct tl_settings *a, const struct tl_settings *b);
void tl_settings_take(const struct tl_settings *from, struct tl_settings *to, struct tl_option_filter filter);
/* A hash of the values of such options. Pure. */
uint64_t tl_settings_hash(const struct tl_settings *settings, struct tl_option_filter filter);

/* True when to go from one to the other takes longer than a frame: while a slider is dragged, such a change
 * waits until it is released. Pure. */
bool tl_settings_differ_slowly(const struct tl_settings *a, const struct tl_settings *b);

/* Whether the fabrics have parts that shadow maps do not show: more than two plain lobes. Pure. */
bool tl_settings_need_rays(const struct tl_settings *settings);

/* The part of the settings that the renderer takes; light.visibility auto is rays. Pure. */
struct tl_render_settings tl_settings_render(const struct tl_settings *settings);

/* The parts of the command line that settings are loaded from. */
struct tl_settings_source {
    const char *scene_file;         /* YAML, a model or a pattern, or NULL: the built-in scene */
    const char *const *assignments; /* "table.key=value", later ones win */
    size_t assignment_count;
};
/* Whether a name in place of a scene is one: built in, or YAML; else it is a model, a pattern or a motion.
 * Pure. */
bool tl_settings_is_scene(const char *name);
bool tl_settings_load(struct tl_settings *out, const struct tl_settings_source *source, tl_error *error);

/* Makes the model of an undecided scene the garment. */
void tl_settings_wear(struct tl_scene_params *scene);

/* Turns the lights of the built-in studio by as much as the camera is turned from `from_deg`: they stand for
 * the view. Other environments stay. */
void tl_settings_turn_studio(struct tl_settings *settings, float from_deg);

/* Single options over settings already there: up to `maximum` of "table.key=value"; NULL ends them. */
bool tl_settings_assign(struct tl_settings *settings, const char *const *assignments, size_t maximum,
                        tl_error *error);

/* Layers a named fabric, preset or colourway ("": none) over settings already there (the panel does this,
 * also after scene.garment or scene.colourways changed). */
bool tl_settings_apply_fabric(struct tl_settings *settings, const char *name, tl_error *error);
bool tl_settings_apply_preset(struct tl_settings *settings, const char *name, tl_error *error);
/* Gives the garment's second fabric the appearance of a named one. */
bool tl_settings_apply_colourway(struct tl_settings *settings, const char *name, tl_error *error);

/* The fabric as the cloth takes it: with the thickness that the garment is sewn with. */
struct tl_cloth_fabric tl_settings_fabric(const struct tl_settings *settings);

/* The fabric of a garment for which none is named: a garment file has materials of its own, a built-in
 * garment and a pattern get theirs from a fabric that such a garment is made of: a shirt in satin would be
 * judged for its fabric, a pattern is sewn in plain cotton as a toile is. */
const char *tl_settings_own_fabric(const char *garment);

/* The name of the avatar, which may be chosen by the garment ("auto"). */
const char *tl_settings_avatar(const struct tl_scene_params *scene);

/* The scene that the colourways are read from, "" for none. */
const char *tl_settings_colourways_source(const struct tl_settings *settings);

#endif
