/* Points of the cloth that must stay outside of what it touches: vertices, and a few more in coarse
 * triangles, for between vertices that touch a round body, its edge of length e would sink in by e^2 / 8R.
 * Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_SAMPLE_H
#define TOILE_CLOTH_CONTACT_SAMPLE_H

#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"

#include <cglm/struct.h>

struct tl_contact_sample {
    uint32_t vertices[3];
    double weights[3]; /* sum 1; a vertex is {1, 0, 0} */
};

/* The middles of edges longer than `coarse_m` at rest, and of the triangles that have one. New array. */
struct tl_contact_sample *tl_contact_samples_create(const struct tl_topology *topology,
                                                    const vec2s (*rest)[3], double coarse_m, size_t *count);

vec3d tl_contact_sample_position(const struct tl_contact_sample *sample, const vec3d *x);

/* The inverse mass that a push on the probe meets. */
double tl_contact_sample_inverse_mass(const struct tl_contact_sample *sample, const double *w);

/* Changes x, places or velocities, of the vertices, each in proportion to its share and inverse mass: by push
 * w_i weight_i. */
void tl_contact_sample_push(const struct tl_contact_sample *sample, vec3d push, const double *w, vec3d *x);

#endif
