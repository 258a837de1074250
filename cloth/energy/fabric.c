#include "cloth/energy/fabric.h"

#include <math.h>

/* A light cotton, between the measured ranges of KES tests: G about 30-150 N/m, B about 5e-6 to 2e-5 N m. */
#define TL_CLOTH_FABRIC_DEFAULTS                                                                             \
    .areal_density = 0.15, .stretch_weft = 1000, .stretch_warp = 1500, .shear = 100, .bend_weft = 6e-6,      \
    .bend_warp = 1e-5, .damping = 0.5, .friction = 0.4, .thickness_m = 0.003

/* It decides where the cloth settles, and can be set while the cloth moves. */
#define AFFECTS (TL_AFFECTS_CLOTH | TL_AFFECTS_DRAPE)

static const struct tl_option fabric_rows[] = {
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, areal_density, AFFECTS, 1e-4, 100, "kg/m^2",
                     "mass per area; larger: hangs more heavily"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, stretch_weft, AFFECTS, 0, 1e9, "N/m",
                     "membrane stiffness along the weft; larger: stretches less"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, stretch_warp, AFFECTS, 0, 1e9, "N/m",
                     "membrane stiffness along the warp; larger: stretches less"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, shear, AFFECTS, 0, 1e9, "N/m",
                     "shear stiffness; larger: shears less, drapes in fewer folds"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, bend_weft, AFFECTS, 0, 1e3, "N m",
                     "bending stiffness of a strip cut along the weft; larger: rounder folds"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, bend_warp, AFFECTS, 0, 1e3, "N m",
                     "bending stiffness of a strip cut along the warp; larger: rounder folds"),
    TL_OPTION_DOUBLE(
        struct tl_cloth_fabric, damping, AFFECTS, 0, 1e3, "1/s",
        "air drag; the weave damps relative motion ten times as fast; larger: comes to rest sooner"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, friction, AFFECTS, 0, 10, "",
                     "Coulomb coefficient against avatar and ground; larger: slides less"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, thickness_m, AFFECTS, 0, 0.1, "m",
                     "distance kept between the cloth's middle surface and the avatar"),
};
const struct tl_option_table tl_cloth_fabric_options =
    TL_OPTION_TABLE("fabric", "mechanical properties of the cloth", fabric_rows, struct tl_cloth_fabric,
                    TL_CLOTH_FABRIC_DEFAULTS);

#define CLOTH_DENSITY 500.0 /* kg/m^3 */
#define THINNEST_M    1e-4
#define THICKEST_M    3e-3 /* of what is only weighed */

double tl_cloth_fabric_ply(const struct tl_cloth_fabric *fabric)
{
    double ply = fabric->ply_m > 0 ? fabric->ply_m : fmin(fabric->areal_density / CLOTH_DENSITY, THICKEST_M);
    return fmax(ply, THINNEST_M);
}
