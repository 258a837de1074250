/* Wind: the pressure of air on every triangle that moves against it,
 *     F = 1/2 rho A |v_n| v_n n,   v_n = n.(wind - velocity of the triangle)
 * (a plate across a stream, drag coefficient 1 [as in Rayleigh 1876]), so a sheet
 * falls flat at sqrt(2 g areal density / rho). Gusts travel with the wind unchanged [Taylor 1938], as three
 * waves whose lengths have no common measure. SI. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_WIND_H
#define TOILE_CLOTH_DRIVE_WIND_H

#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"

#define TL_AIR_DENSITY 1.225 /* kg/m^3, International Standard Atmosphere at sea level */

struct tl_wind {
    vec3d velocity; /* m/s */
    double gust;    /* 0 to 1: by how much of its speed it rises and falls */
    double time_s;
    double areal_density; /* kg/m^2, of the cloth */
};

/* The wind's velocity at a point. */
vec3d tl_wind_at(const struct tl_wind *wind, vec3d point);

/* Writes the forces (N) on the particles, constant for h seconds, to `forces` [particles->count]. If a free
 * sheet would lose more than half of its speed against the air within h (0.15 kg/m^2 and h = 1/60 s: above 7
 * m/s), forces are reduced to that: the explicit impulse would otherwise overshoot and throw a light cloth
 * back. Gusts are interpolated from a table: the wind is off by at most 2e-5 of the gusts' amplitude. */
void tl_wind_forces(const struct tl_wind *wind, const struct tl_topology *topology, double h,
                    const struct tl_particles *particles, vec3d *forces);

#endif
