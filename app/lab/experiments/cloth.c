/* Cloth: fabrics, solvers, contact, layers, sewn garments. Each is compared with a slower solution of the
 * same motion, so that errors are those of the cloth and the light is the same. Ids E1 to E3, E5, E6. */
#include "app/lab/experiments/rows_internal.h"

/* The converged cloth of its row: five times as many substeps, and their strains, which shrink with the
 * square of the substep, are gone. */
#define CONVERGED "cloth.substeps=150"

static const struct tl_technique techniques[] = {
    {.picture = "silk", .id = "E1", SET("scene.fabric=silk")},
    {.picture = "plain cotton", .id = "E1", SET("scene.fabric=cotton_plain")},
    {.picture = "denim", .id = "E1", SET("scene.fabric=denim")},

    {.picture = "preview", .id = "E2", SET("cloth.solver=preview")},

    {.picture = "friction 0.3", .id = "E3", SET("fabric.friction=0.3")},
    {.picture = "friction 1", .id = "E3", SET("fabric.friction=1")},
    {.picture = "wind of 2 m/s", .id = "E3", SET("cloth.wind=[2, 0, 0]")},

    {.picture = "cloth that passes through itself", .id = "E5", SET("cloth.self_contact=false")},

    {.picture = "edges of 5 cm", .id = "E6", SET("cloth.edge_m=0.05")},
    {.picture = "edges of 3 cm", .id = "E6", SET("cloth.edge_m=0.03")},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PICTURES,
     .name = "e1",
     .scene = "gallery",
     .title = "E1  Fabrics by what was measured of them",
     .text =
         "Stretch, shear and bending along weft and warp, weight and friction are each fabric's own, and "
         "so are its weave and colour. Which folds form depends on the smallest differences, so that "
         "errors are mostly of folds that lie elsewhere; test drape holds what was measured. The solid is "
         "no cloth and stays equal.",
     .exact_text = "the same cloth by five times as many substeps",
     .solid = "torus",
     .base = {LAMPLIT, "cloth.edge_m=0.02"},
     .reference = {.assignments = {CONVERGED}},
     .by_flip = true,
     .side = 256,
     .ids = {"E1"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "e2",
     .scene = "gallery",
     .title = "E2  Solvers of the cloth",
     .text = "Two integrators over one energy. The sheet falls over the ball and comes to rest; the solid "
             "is no cloth and stays equal.",
     .exact_text = "the solver `reference`, whose step follows the fabric's stiffness",
     .motion = TL_MOTION_CLOTH,
     .motion_step = 4,
     .solid = "torus",
     .base = {LAMPLIT, "cloth.edge_m=0.02", "material.glossiness=0.5"},
     .reference = {.assignments = {"cloth.solver=reference"}},
     .by_flip = true,
     .side = 384,
     .ids = {"E2"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "e3",
     .scene = "gallery",
     .title = "E3  Contact, friction and wind",
     .text = "The ball holds the sheet by friction, or lets it slide; air that moves past the cloth presses "
             "on it. Errors are mostly of folds that lie elsewhere. The solid is no cloth and stays equal.",
     .exact_text = "the same cloth by five times as many substeps",
     .solid = "torus",
     .base = {LAMPLIT, "cloth.edge_m=0.02", "material.glossiness=0.5"},
     .reference = {.assignments = {CONVERGED}},
     .by_flip = true,
     .side = 256,
     .ids = {"E3"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "e5",
     .scene = "gallery",
     .title = "E5  Cloth that keeps apart from itself",
     .text = "Folds and layers lie on each other; without contact of the cloth with itself they pass through "
             "each other. The solid is no cloth and stays equal.",
     .exact = TL_EXACT_NONE,
     .exact_text = "crossings of triangles are counted, not seen (test uncrossed: none in motion, by brute "
                   "force over all pairs); the picture for comparison is of cloth that keeps apart",
     .solid = "torus",
     .base = {LAMPLIT, "cloth.edge_m=0.02", "material.glossiness=0.5"},
     .reference = {.assignments = {"cloth.self_contact=true"}},
     .by_flip = true,
     .side = 256,
     .ids = {"E5"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "e6",
     .scene = "gallery",
     .title = "E6  A sewn garment",
     .text =
         "Flat pieces are cut into triangles, placed around the body, sewn, and come to rest: a shirt, and "
         "the sheet for comparison. Larger triangles cannot show the finest folds, folds may lie elsewhere, "
         "and between vertices the arm shows through a cuff.",
     .exact_text = "edges of 2 cm",
     .claims = {{"edges of 3 cm", "edges of 5 cm", "The design of this program"}},
     .solid = "shirt",
     .solid_only = {"scene.avatar=figure", "camera.target=[0, 1.2, 0]", "camera.distance_m=1.9",
                    "camera.pitch_deg=5"},
     .base = {LAMPLIT, "material.glossiness=0.5"},
     .reference = {.assignments = {"cloth.edge_m=0.02"}},
     .by_flip = true,
     .side = 256,
     .ids = {"E6"},
     METHODS(techniques)},
};
const struct tl_experiment_list tl_cloth_experiments = {experiments, TL_COUNT(experiments)};
