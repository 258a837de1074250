/* What the models and their draws share; inside render/brdf only. */
#ifndef TOILE_RENDER_BRDF_INTERNAL_H
#define TOILE_RENDER_BRDF_INTERNAL_H

#include "render/brdf/brdf.h"

/* l, v and what lies between them. */
struct tl_brdf_angles {
    float cos_a, cos_b; /* n.l, n.v: not clamped */
    float cos_t;        /* h.l = h.v */
    vec3s h;            /* in the frame: along tangent, bitangent, normal; 0 where l = -v */
};
struct tl_brdf_angles tl_brdf_angles_of(const struct tl_brdf_frame *frame, vec3s l, vec3s v);

/* cos^exponent of the angle between two unit vectors, 0 beyond a right angle, with all its digits near 0. */
float tl_brdf_cosine_power(vec3s a, vec3s b, float exponent);

/* v reflected about n. */
vec3s tl_brdf_mirror(vec3s normal, vec3s v);

/* Angle of the nearest mirror direction of a thread along t to l, from the cosines t.l and t.v. */
float tl_brdf_thread_angle(float t_dot_l, float t_dot_v);

#endif
