#include "cloth/cloth.h"

/* The solver decides where the cloth settles, and can be set while it moves. */
#define AFFECTS (TL_AFFECTS_CLOTH | TL_AFFECTS_DRAPE)

#define TL_CLOTH_DEFAULTS                                                                                    \
    .solver = TL_CLOTH_PREVIEW, .strain_limit = 0.1, .dt = 1.0 / 60, .frame_rate = 30, .self_contact = true, \
    .reference_substeps = 20000, .gravity = 9.81, .settle_s = 10, .settle_speed = 0.003, .cages = true,      \
    .caged_above = 10000, .edge_m = 0.02f, .longest_edge_m = 0.1f

const char *const tl_cloth_solver_names[] = {"preview", "reference", NULL};

const char *const tl_pin_colour_names[] = {"none", "red", "green", "blue", NULL};

static const struct tl_option cloth_rows[] = {
    TL_OPTION_ENUM(struct tl_cloth_params, solver, AFFECTS, tl_cloth_solver_names,
                   "of the motion. preview: bounded cost; reference: exact, its step shrinks with the "
                   "fabric's stiffness"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, dt, AFFECTS, 1e-5, 0.1, "s",
                     "maximum time step; a frame is divided into equal steps; larger: faster, less exact"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, frame_rate, AFFECTS | TL_AFFECTS_WORK, 1, 1000, "1/s",
                     "frames per second of animation"),
    TL_OPTION_INT(
        struct tl_cloth_params, substeps, AFFECTS, 0, TL_CLOTH_MAX_SUBSTEPS, "",
        "preview: substeps per step; more: slower, stretches less in motion; 0: 30, or as many as the "
        "fabric's stiffness and mean edges below 12 mm need"),
    TL_OPTION_INT(struct tl_cloth_params, reference_substeps, AFFECTS, 1, 100000000, "",
                  "reference: maximum substeps per frame; a fabric that needs more is refused"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, strain_limit, AFFECTS, 0, 10, "",
                     "preview: maximum strain of an edge; 0: no limit"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, pin_above_m, AFFECTS, 0, 1000, "m",
                     "pins the vertices that start higher than this, for example a waistband; 0: none"),
    TL_OPTION_ENUM(struct tl_cloth_params, pin_colour, AFFECTS, tl_pin_colour_names,
                   "pins the vertices that have this vertex colour in the garment's file"),
    TL_OPTION_STRING(
        struct tl_cloth_params, pin_openings, TL_AFFECTS_SCENE | AFFECTS,
        "pins openings by name, with commas between them: waist,left cuff; `toile info` and `toile "
        "measure` list them"),
    TL_OPTION_BOOL(
        struct tl_cloth_params, self_contact, AFFECTS,
        "the cloth does not pass through itself: folds and layers (a shirt over trousers) lie on each other; "
        "false: faster"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, gravity, AFFECTS, -100, 100, "m/s^2",
                     "acceleration along -Y; larger: hangs more heavily"),
    TL_OPTION_VECTOR(struct tl_cloth_params, wind, AFFECTS, -100, 100, "m/s",
                     "velocity of the air, which exerts pressure on the cloth; 0 0 0: no wind is computed"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, gust, AFFECTS, 0, 1, "",
                     "amplitude of the gusts, relative to the wind's speed"),
    TL_OPTION_DOUBLE(
        struct tl_cloth_params, settle_s, AFFECTS, 0, 600, "s",
        "maximum time for coming to balance before the first frame, in substeps; 0: the cloth is not "
        "settled"),
    TL_OPTION_DOUBLE(
        struct tl_cloth_params, settle_speed, AFFECTS, 0, 10, "m/s",
        "cloth in motion is at rest when its vertices move no faster than this over a frame (rms)"),
    TL_OPTION_BOOL(struct tl_cloth_params, cages, AFFECTS,
                   "settles coarser versions of a fine cloth first, from which it comes to rest sooner"),
    TL_OPTION_INT(struct tl_cloth_params, caged_above, AFFECTS, 0, 1000000000, "",
                  "cloth of more vertices moves by a cage of 3,000, which it follows: in a hundredth of the "
                  "time, without new folds finer than the cage; it settles as it is; 0: all of it moves"),
    TL_OPTION_FLOAT(struct tl_cloth_params, edge_m, TL_AFFECTS_SCENE | AFFECTS | TL_AFFECTS_WORK, 0.001f, 1,
                    "m", "target edge length of built-in garments; larger: coarser, faster"),
    TL_OPTION_ENUM(struct tl_cloth_params, rest, TL_AFFECTS_SCENE | AFFECTS, tl_rest_names,
                   "rest shape, grain and strain of a garment's file: uv: its UVs are its pattern, at one "
                   "scale; mesh: its first shape; auto: uv where they are one, which `toile info` states"),
    TL_OPTION_FLOAT(struct tl_cloth_params, longest_edge_m, TL_AFFECTS_SCENE | AFFECTS, 0, 1000, "m",
                    "longer edges of a garment's file are halved, so that it can fold; 0: never"),
};
const struct tl_option_table tl_cloth_options = TL_OPTION_TABLE(
    "cloth", "simulation of the cloth", cloth_rows, struct tl_cloth_params, TL_CLOTH_DEFAULTS);
