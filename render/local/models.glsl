// The reflectance models of render/brdf/brdf.h but for Ward's, from cosines. Models and Fresnel terms are the numbers of the
// enums of assets/base/material.h. PI is the includer's.
#include "facets_terms.glsl"
#include "power.glsl"

const int PHONG = 0, BLINN_PHONG = 1, COSINE_LOBE = 2, TORRANCE_SPARROW = 3, WARD = 4, BANKS = 5;

// Cosines of the vectors of shading. The squared sines keep their digits near a peak, where cosines do not.
struct Cosines {
    float a, b;                    // n.l, n.v
    float t;                       // h.l
    float half_normal, half_sine2; // n.h
    float mirror, mirror_sine2;    // r.l
    vec2 half_plane;               // h along tangent and bitangent
    vec2 thread;                   // t.l, t.v
    vec2 across;                   // b.l, b.v
    float hand;                    // -1 where b is opposite to the bitangent of the surface (plane_side)
};

struct Frame {
    vec3 n, t, b;
};

// The cosines of unit vectors.
Cosines cosines_of(Frame frame, vec3 l, vec3 v, vec3 h)
{
    Cosines c;
    c.a = dot(frame.n, l);
    c.b = dot(frame.n, v);
    c.t = dot(h, l);
    c.half_normal = dot(frame.n, h);
    vec3 across = cross(frame.n, h);
    c.half_sine2 = dot(across, across);
    vec3 r = 2.0 * c.b * frame.n - v;
    c.mirror = dot(r, l);
    across = cross(r, l);
    c.mirror_sine2 = dot(across, across);
    c.half_plane = vec2(dot(frame.t, h), dot(frame.b, h));
    c.thread = vec2(dot(frame.t, l), dot(frame.t, v));
    c.across = vec2(dot(frame.b, l), dot(frame.b, v));
    c.hand = 1.0;
    return c;
}

// The Fresnel term. PHONG and BANKS take it at the cosine of the viewer, as the G-buffer does. `optics`: index, extinction.
vec3 fresnel_of(int model, int kind, vec2 optics, vec3 f0, Cosines c)
{
    float cosine = clamp(model == PHONG || model == BANKS ? c.b : c.t, 0.0, 1.0);
    return kind == FRESNEL_SCHLICK ? schlick_colour(f0, cosine) : f0 * fresnel_by_index(kind, optics.x, optics.y, cosine);
}

// The cosine of l with the nearest mirror direction of a thread, and its squared sine.
vec2 thread_mirror(vec2 thread)
{
    vec2 cosine = clamp(thread, -1.0, 1.0), sine = sqrt(1.0 - cosine * cosine);
    float across = sine.x * cosine.y + cosine.x * sine.y;
    return vec2(sine.x * sine.y - cosine.x * cosine.y, across * across);
}

// f_r cos a without the Fresnel term. `s`: the exponent of lobes; `width`: of facets.
float lobe_of(int model, int facets, int masking, Cosines c, float s, float width)
{
    if (model == TORRANCE_SPARROW)
        return facet_density(facets, width, c.half_sine2 / (c.half_normal * c.half_normal)) *
               facet_masking(facets, masking, width, c.a, c.b, c.t, c.half_normal) / (PI * c.b);
    if (model == BLINN_PHONG)
        return (4.0 * s + 2.0) / (8.0 * PI) * power(c.half_normal, c.half_sine2, 4.0 * s);
    if (model == BANKS) {
        vec2 mirror = thread_mirror(c.thread);
        return thread_scale(s) * power(mirror.x, mirror.y, s) * c.a;
    }
    if (model == COSINE_LOBE)
        return (s + 2.0) / (2.0 * PI) * power(c.mirror, c.mirror_sine2, s) * c.a;
    return (s + 1.0) / (2.0 * PI) * power(c.mirror, c.mirror_sine2, s);
}
