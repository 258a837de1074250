// The current lamp, and the cosines at a point that it lights.
#include "lamp_terms.glsl"
#include "models_terms.glsl"

layout(location = 64) uniform mat4 view_projection;
layout(location = 65) uniform vec3 eye;
layout(location = 66) uniform vec4 lamp; // w = 1: position; w = 0: direction towards it
layout(location = 67) uniform vec3 lamp_irradiance;
layout(location = 68) uniform vec3 constant_lamp; // COORDINATES_MATRIX: l and v, constant over the image
layout(location = 69) uniform vec3 constant_eye;
layout(location = 70) uniform vec4 gloss_widths; // widths along weft and warp without maps; cosine and sine of the rotation

// The frame of tl_brdf_frame_make: t at right angles to the unit normal, turned counter-clockwise as seen from the
// front; `side` is -1 on back faces. The sign of the bitangent matters to correlated slopes alone (plane_side in
// local.frag).
Frame frame_of(vec3 n, vec3 tangent, float side)
{
    vec3 t = thread_direction(n, tangent, gloss_widths.z, side * gloss_widths.w);
    return Frame(n, t, cross(n, t));
}

// A cosine as precise as the way of making vectors unit.
float held(float cosine)
{
#ifdef NORMALISE_NEWTON8
    return register_value(cosine);
#else
    return cosine;
#endif
}

// The cosines of vectors that are nearly unit: everything is derived from dot products.
Cosines cosines_from(vec4 a_b_half_t, vec4 half_plane_thread, vec2 across, float l_dot_v)
{
    Cosines c;
    c.a = a_b_half_t.x;
    c.b = a_b_half_t.y;
    c.half_normal = min(a_b_half_t.z, 1.0);
    c.t = a_b_half_t.w;
    c.half_sine2 = 1.0 - c.half_normal * c.half_normal;
    c.mirror = min(held(2.0 * c.a * c.b - l_dot_v), 1.0);
    c.mirror_sine2 = 1.0 - c.mirror * c.mirror;
    c.half_plane = half_plane_thread.xy;
    c.thread = half_plane_thread.zw;
    c.across = across;
    c.hand = 1.0;
    return c;
}

// Calls cosines_from with the dot products.
Cosines cosines_near(Frame frame, vec3 l, vec3 v, vec3 h)
{
    return cosines_from(
        vec4(held(dot(frame.n, l)), held(dot(frame.n, v)), held(dot(frame.n, h)), held(dot(h, l))),
        vec4(held(dot(frame.t, h)), held(dot(frame.b, h)), held(dot(frame.t, l)), held(dot(frame.t, v))),
        vec2(held(dot(frame.b, l)), held(dot(frame.b, v))), held(dot(l, v)));
}
