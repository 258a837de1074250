/* The fabric: the physical constants of the material, in SI, per metre of fabric width where the quantity is
 * per width. Option table "fabric". */
#ifndef TOILE_CLOTH_ENERGY_FABRIC_H
#define TOILE_CLOTH_ENERGY_FABRIC_H

#include "config/options.h"

struct tl_cloth_fabric {
    double areal_density; /* kg/m^2 */
    double stretch_weft;  /* N/m, membrane stiffness along u */
    double stretch_warp;  /* N/m, along v */
    double shear;         /* N/m */
    double bend_weft;     /* N m, bending stiffness B of a strip cut along u */
    double bend_warp;     /* N m, along v */
    double damping;       /* 1/s, air drag; relative velocity between neighbours decays ten times as fast */
    double friction;      /* Coulomb coefficient against avatar, ground and other layers */
    double thickness_m;   /* distance kept between the cloth's middle surface and the avatar */
};
extern const struct tl_option_table tl_cloth_fabric_options;

#endif
