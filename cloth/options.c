#include "cloth/cloth.h"

/* A light cotton, between the measured ranges of KES tests: G about 30-150 N/m, B about 5e-6 to 2e-5 N m. */
#define TL_CLOTH_FABRIC_DEFAULTS                                                                             \
    .areal_density = 0.15, .stretch_weft = 1000, .stretch_warp = 1500, .shear = 100, .bend_weft = 6e-6,      \
    .bend_warp = 1e-5, .damping = 0.5, .friction = 0.4, .thickness_m = 0.003

static const struct tl_option fabric_rows[] = {
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, areal_density, 1e-4, 100, "kg/m^2", "mass per area: heavier"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, stretch_weft, 0, 1e9, "N/m",
                     "membrane stiffness along the weft: stretches less"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, stretch_warp, 0, 1e9, "N/m",
                     "membrane stiffness along the warp: stretches less"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, shear, 0, 1e9, "N/m",
                     "resistance of the weave's right angles: shears less, drapes in fewer folds"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, bend_weft, 0, 1e3, "N m",
                     "bending stiffness of a strip cut along the weft: rounder folds"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, bend_warp, 0, 1e3, "N m",
                     "bending stiffness of a strip cut along the warp: rounder folds"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, damping, 0, 1e3, "1/s",
                     "drag of the air and, ten times it, of the weave in itself: comes to rest sooner"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, friction, 0, 10, "",
                     "Coulomb coefficient against avatar and ground: slides less"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, thickness_m, 0, 0.1, "m",
                     "distance kept between the cloth's middle surface and the avatar"),
};
const struct tl_option_table tl_cloth_fabric_options = TL_OPTION_TABLE(
    "fabric", "what the cloth is made of", fabric_rows, struct tl_cloth_fabric, TL_CLOTH_FABRIC_DEFAULTS);

#define TL_CLOTH_DEFAULTS                                                                                    \
    .solver = TL_CLOTH_PREVIEW, .strain_limit = 0.1, .dt = 1.0 / 60, .frame_rate = 30, .substeps = 30,       \
    .cg_iterations = 200, .cg_tolerance = 3e-2, .reference_substeps = 20000, .gravity = 9.81,                \
    .settle_s = 10, .settle_speed = 0.003, .edge_m = 0.02f, .longest_edge_m = 0.1f

const char *const tl_cloth_solver_names[] = {"preview", "settle", "reference", NULL};

const char *const tl_pin_colour_names[] = {"none", "red", "green", "blue", NULL};

static const struct tl_option cloth_rows[] = {
    TL_OPTION_ENUM(
        struct tl_cloth_params, solver, tl_cloth_solver_names,
        "preview: bounded cost, rests a little too soft; settle: any step, rests exactly, moves too calmly; "
        "reference: exact, its step follows the fabric"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, dt, 1e-5, 0.1, "s",
                     "longest step; a frame is made of equal ones: faster, less exact"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, frame_rate, 1, 1000, "1/s", "frames per second of animation"),
    TL_OPTION_INT(struct tl_cloth_params, substeps, 1, 1000, "",
                  "preview: substeps per step: slower, stretches less"),
    TL_OPTION_INT(struct tl_cloth_params, cg_iterations, 1, 1000000, "",
                  "settle: most iterations of a step's solve: slower, less often cut short"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, cg_tolerance, 1e-12, 0.5, "",
                     "settle: residual that is left of a step's first one: faster, less exact motion"),
    TL_OPTION_INT(struct tl_cloth_params, reference_substeps, 1, 100000000, "",
                  "reference: most substeps per frame; a fabric that needs more is refused"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, strain_limit, 0, 10, "",
                     "preview: most that an edge may stretch, as a share of its length; 0: no limit"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, pin_above_m, 0, 1000, "m",
                     "holds the vertices that start higher than this, a waistband say; 0: none of them"),
    TL_OPTION_ENUM(
        struct tl_cloth_params, pin_colour, tl_pin_colour_names,
        "holds the vertices that the garment's file has in this colour, where it has vertex colours"),
    TL_OPTION_BOOL(struct tl_cloth_params, self_repulsion,
                   "layers, a shirt over trousers, and folds keep their distance: takes up to twice as long"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, gravity, -100, 100, "m/s^2", "along -Y: hangs more heavily"),
    TL_OPTION_VECTOR(
        struct tl_cloth_params, wind, -100, 100, "m/s",
        "which way the air moves: presses on the cloth; 0 0 0: nothing, and nothing is computed"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, gust, 0, 1, "",
                     "how much of its speed the wind rises and falls by"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, settle_s, 0, 600, "s",
                     "longest simulated time for coming to rest before the first frame"),
    TL_OPTION_DOUBLE(struct tl_cloth_params, settle_speed, 0, 10, "m/s",
                     "settled when no vertex is faster than this over a frame: settles sooner"),
    TL_OPTION_FLOAT(struct tl_cloth_params, edge_m, 0.001f, 1, "m",
                    "length of an edge of the built-in garments: coarser, faster"),
    TL_OPTION_FLOAT(
        struct tl_cloth_params, longest_edge_m, 0, 1000, "m",
        "a garment's file may have longer edges, but they are halved: without, it cannot fold; 0: "
        "as the file has them"),
};
const struct tl_option_table tl_cloth_options = TL_OPTION_TABLE(
    "cloth", "how the cloth is solved", cloth_rows, struct tl_cloth_params, TL_CLOTH_DEFAULTS);
