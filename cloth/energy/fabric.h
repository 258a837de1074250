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
    double ply_m;         /* m, of the cloth itself; 0: unknown (tl_cloth_fabric_ply); no option of its own */
};
extern const struct tl_option_table tl_cloth_fabric_options;

/* The distance that contact keeps between the middle surfaces of two plies, metres: the cloth's thickness, or
 * where it is unknown that of a cloth of 500 kg/m^3, up to 3 mm. [Penava et al. 2014] have cotton 470, wool
 * 410, polyester 650. At least a tenth of a millimetre, five times what a ply keeps from the planes that hold
 * it apart from others (cloth/contact/window.c): nearer plies would stop without friction. */
double tl_cloth_fabric_ply(const struct tl_cloth_fabric *fabric);

#endif
