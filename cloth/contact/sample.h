/* Contact samples: points of the cloth, besides its vertices, at which contact is enforced.
 *
 * Between vertices that rest on a body of radius R, an edge of length e sinks in by e^2 / 8R, so coarse
 * triangles get samples in between. A sample is a fixed weighted mean of three vertices. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_SAMPLE_H
#define TOILE_CLOTH_CONTACT_SAMPLE_H

#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"

#include <cglm/struct.h>

struct tl_contact_sample {
    uint32_t vertices[3];
    double weights[3]; /* sum 1; a vertex itself is {1, 0, 0} */
};

/* Samples at the middles of edges longer than `coarse_m` at rest and of the triangles that have one. The
 * caller frees the array. */
struct tl_contact_sample *tl_contact_samples_create(const struct tl_topology *topology,
                                                    const vec2s (*rest)[3], double coarse_m, size_t *count);

/* The sample's position, or velocity, from those of the vertices. */
vec3d tl_contact_sample_position(const struct tl_contact_sample *sample, const vec3d *x);

/* The effective inverse mass at the sample: sum of w_i weight_i^2. */
double tl_contact_sample_inverse_mass(const struct tl_contact_sample *sample, const double *w);

/* Adds push w_i weight_i to each vertex of x (positions or velocities): with push = displacement / effective
 * inverse mass, the sample moves by the displacement and momentum is conserved. */
void tl_contact_sample_push(const struct tl_contact_sample *sample, vec3d push, const double *w, vec3d *x);

#endif
