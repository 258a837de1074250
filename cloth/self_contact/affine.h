/* Affine motions, fitted to the motion of many points. What is safe about separate features stays safe under
 * any invertible affine map of all of them, so that motion which all cloth shares need not count as motion.
 * Threads: pure. */
#ifndef TOILE_CLOTH_SELF_CONTACT_AFFINE_H
#define TOILE_CLOTH_SELF_CONTACT_AFFINE_H

#include "cloth/mesh/vec3d.h"

#include <stdbool.h>
#include <stddef.h>

/* The map p -> p + mean + gradient (p - centre). */
struct tl_affine {
    vec3d centre, mean;
    vec3d gradient[3]; /* rows */
};

/* Fits mean and gradient to the displacements (or velocities) of `count` points, by least squares over an
 * even choice of at most a few hundred of them. Directions in which the points have no extent get a small
 * gradient. */
struct tl_affine tl_affine_fit(const vec3d *points, const vec3d *displacements, size_t count);

/* The root of the sum of the gradient's squares: a bound of how far directions are turned and stretched. */
double tl_affine_gradient_norm(const struct tl_affine *affine);

/* The same map with mean and gradient times t. */
struct tl_affine tl_affine_scaled(const struct tl_affine *affine, double t);

vec3d tl_affine_apply(const struct tl_affine *affine, vec3d p);

/* The displacement, or velocity, of the map at p. */
vec3d tl_affine_at(const struct tl_affine *affine, vec3d p);

/* The inverse of an affine map: p -> centre + rows (p - centre - mean). */
struct tl_affine_inverse {
    vec3d centre, moved; /* of the map: centre, and centre + mean */
    vec3d rows[3];
    double norm; /* not less than the largest factor by which it stretches any direction */
};

/* Returns false for a map that is not, or hardly, invertible. */
bool tl_affine_invert(const struct tl_affine *affine, struct tl_affine_inverse *inverse);

static inline vec3d tl_affine_undo(const struct tl_affine_inverse *inverse, vec3d p)
{
    vec3d at = vec3d_sub(p, inverse->moved);
    return (vec3d){inverse->centre.x + vec3d_dot(inverse->rows[0], at),
                   inverse->centre.y + vec3d_dot(inverse->rows[1], at),
                   inverse->centre.z + vec3d_dot(inverse->rows[2], at)};
}

#endif
