/* The frame of a surface, and the angles with which reflectance models are evaluated. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_ANGLES_H
#define TOILE_RENDER_BRDF_ANGLES_H

#include <cglm/struct.h>

/* An orthonormal surface frame. `tangent` runs along u (weft), after the rotation by gloss.rotation. */
struct tl_brdf_frame {
    vec3s normal, tangent, bitangent;
};

/* The orthonormal frame about a unit normal, turned by `rotation` (rad, counter-clockwise seen from outside).
 * `tangent` need not be at right angles to the normal; where it is zero, any tangent is chosen. The bitangent
 * is handedness * cross(normal, tangent). */
struct tl_brdf_frame tl_brdf_frame_make(vec3s normal, vec3s tangent, float handedness, float rotation);

/* The angles of l and v and of the vector half way between them. */
struct tl_brdf_angles {
    float cos_a, cos_b; /* n.l, n.v: not clamped */
    float cos_t;        /* h.l = h.v */
    vec3s h;            /* in the frame: along tangent, bitangent, normal; 0 where l = -v */
};
/* The angles of unit vectors l and v in a frame. */
struct tl_brdf_angles tl_brdf_angles_of(const struct tl_brdf_frame *frame, vec3s l, vec3s v);

/* cosine^exponent, from the cosine and its squared sine, which keeps its digits near the peak. 0 for a cosine
 * that is not positive. */
float tl_cosine_power(float cosine, float sine_squared, float exponent);
/* cos^exponent of the angle between two unit vectors, 0 beyond a right angle. Accurate to the last digits
 * near the peak, too. */
float tl_brdf_cosine_power(vec3s a, vec3s b, float exponent);

/* v reflected about n. */
vec3s tl_brdf_mirror(vec3s normal, vec3s v);

/* Angle (rad, signed) between l and the nearest mirror direction of a thread along t, from the cosines t.l
 * and t.v. */
float tl_brdf_thread_angle(float t_dot_l, float t_dot_v);

#endif
