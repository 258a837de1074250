/* The residual of cloth at rest: how far its forces are from balance.
 *
 * Cloth that does not move need not be in balance: a solver may have stopped, or hold it by an error of its
 * own. The residual of a vertex is the acceleration with which it would start from rest, as a share of
 * gravity, which is a share of the vertex's weight. Weight and elastic forces accelerate the vertices; body,
 * ground and the cloth itself push back with Coulomb friction, without which nothing that lies would be in
 * balance. These contact forces are found by projected Gauss-Seidel sweeps at the level of accelerations:
 * each contact in turn gets the force that takes the acceleration of its points towards each other away and,
 * of the acceleration along each other, as much as friction can. Wind, seams and a hand are left out.
 *
 * SI. Errors: none. Threads: pure; the order of the sweeps is that of the vertices and contacts. */
#ifndef TOILE_CLOTH_BALANCE_RESIDUAL_H
#define TOILE_CLOTH_BALANCE_RESIDUAL_H

#include "cloth/contact/contact.h"
#include "cloth/mesh/particles.h"
#include "cloth/self_contact/self_contact.h"

/* Shares of a vertex's weight, over the vertices that are not held. */
struct tl_residual {
    double rms;
    double high; /* 99 % of the vertices have at most this */
    double largest;
    double bounded_rms; /* no vertex counts as more than one that falls freely, which is 1 */
};

/* Cloth that has at most this is in balance. The largest is not bounded, and so neither is the plain rms: in
 * a crease of the body, or of the cloth, some vertices are pressed between surfaces of which contact knows
 * one plane each (in the default dress of plain cotton one vertex, by 19 times its weight). */
#define TL_RESIDUAL_RMS  0.1
#define TL_RESIDUAL_HIGH 0.5
static inline bool tl_residual_is_balance(const struct tl_residual *residual)
{
    return residual->bounded_rms <= TL_RESIDUAL_RMS && residual->high <= TL_RESIDUAL_HIGH;
}

/* Borrowed for the call. */
struct tl_residual_source {
    const struct tl_particles *particles;
    const vec3d *forces;                      /* [particles->count] N, elastic */
    const struct tl_contacts *body;           /* updated for these positions */
    const struct tl_self_contact_pairs *self; /* the same; NULL: the cloth passes through itself */
    double gravity;                           /* m/s^2; where it is 0, shares are of 9.81 */
    double friction, thickness_m;
};
struct tl_residual tl_residual_measure(const struct tl_residual_source *source);

#endif
