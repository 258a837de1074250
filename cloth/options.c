#include "cloth/cloth.h"

/* How the cloth is solved decides where it settles, and can be set while it moves. */
#define AFFECTS (TL_AFFECTS_CLOTH | TL_AFFECTS_DRAPE)

#define TL_CLOTH_DEFAULTS                                                                                    \
    .solver = TL_CLOTH_PREVIEW, .strain_limit = 0.1, .dt = 1.0 / 60, .frame_rate = 30, .substeps = 30,       \
    .cg_iterations = 200, .cg_tolerance = 3e-2, .reference_substeps = 20000, .gravity = 9.81,                \
    .settle_s = 10, .settle_speed = 0.003, .edge_m = 0.02f, .longest_edge_m = 0.1f

const char *const tl_cloth_solver_names[] = {"preview", "settle", "reference", NULL};

const char *const tl_pin_colour_names[] = {"none", "red", "green", "blue", NULL};

static const struct tl_option cloth_rows[] = {
    TL_OPTION_ENUM(
        struct tl_cloth_params, solver, AFFECTS, tl_cloth_solver_names,
        "preview: bounded cost, rests a little too soft; settle: any step, rests exactly, moves too calmly; "
        "reference: exact, its step follows the fabric"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, dt, AFFECTS, 1e-5, 0.1, "s",
                     "longest step; a frame is made of equal ones: faster, less exact"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, frame_rate, AFFECTS | TL_AFFECTS_WORK, 1, 1000, "1/s",
                     "frames per second of animation"),
    TL_OPTION_INT(struct tl_cloth_params, substeps, AFFECTS, 1, 1000, "",
                  "preview: substeps per step: slower, stretches less"),
    TL_OPTION_INT(struct tl_cloth_params, cg_iterations, AFFECTS, 1, 1000000, "",
                  "settle: most iterations of a step's solve: slower, less often cut short"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, cg_tolerance, AFFECTS, 1e-12, 0.5, "",
                     "settle: residual that is left of a step's first one: faster, less exact motion"),
    TL_OPTION_INT(struct tl_cloth_params, reference_substeps, AFFECTS, 1, 100000000, "",
                  "reference: most substeps per frame; a fabric that needs more is refused"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, strain_limit, AFFECTS, 0, 10, "",
                     "preview: most that an edge may stretch, as a share of its length; 0: no limit"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, pin_above_m, AFFECTS, 0, 1000, "m",
                     "holds the vertices that start higher than this, a waistband say; 0: none of them"),
    TL_OPTION_ENUM(
        struct tl_cloth_params, pin_colour, AFFECTS, tl_pin_colour_names,
        "holds the vertices that the garment's file has in this colour, where it has vertex colours"),
    TL_OPTION_BOOL(struct tl_cloth_params, self_repulsion, AFFECTS,
                   "layers, a shirt over trousers, and folds keep their distance: takes up to twice as long"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, gravity, AFFECTS, -100, 100, "m/s^2",
                     "along -Y: hangs more heavily"),
    TL_OPTION_VECTOR(
        struct tl_cloth_params, wind, AFFECTS, -100, 100, "m/s",
        "which way the air moves: presses on the cloth; 0 0 0: nothing, and nothing is computed"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, gust, AFFECTS, 0, 1, "",
                     "how much of its speed the wind rises and falls by"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, settle_s, AFFECTS, 0, 600, "s",
                     "longest simulated time for coming to rest before the first frame"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, settle_speed, AFFECTS, 0, 10, "m/s",
                     "settled when no vertex is faster than this over a frame: settles sooner"),
    TL_OPTION_FLOAT(struct tl_cloth_params, edge_m, TL_AFFECTS_SCENE | AFFECTS | TL_AFFECTS_WORK, 0.001f, 1,
                    "m", "length of an edge of the built-in garments: coarser, faster"),
    TL_OPTION_FLOAT(
        struct tl_cloth_params, longest_edge_m, TL_AFFECTS_SCENE | AFFECTS, 0, 1000, "m",
        "a garment's file may have longer edges, but they are halved: without, it cannot fold; 0: "
        "as the file has them"),
};
const struct tl_option_table tl_cloth_options = TL_OPTION_TABLE(
    "cloth", "how the cloth is solved", cloth_rows, struct tl_cloth_params, TL_CLOTH_DEFAULTS);
