// The reflectance models of brdf.h but for Ward's, from cosines, for GLSL and C (brdf.c). What includes it in C has
// power(cosine, squared sine, exponent).
#ifdef GL_core_profile
#include "facets_terms.glsl"
#include "power.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// enum tl_reflectance (assets/base/material.h)
#define PHONG 0
#define BLINN_PHONG 1
#define COSINE_LOBE 2
#define TORRANCE_SPARROW 3
#define WARD 4
#define BANKS 5

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
TERM Cosines cosines_of(Frame frame, vec3 l, vec3 v, vec3 h)
{
    Cosines c;
    c.a = dot(frame.n, l);
    c.b = dot(frame.n, v);
    c.t = dot(h, l);
    c.half_normal = dot(frame.n, h);
    vec3 across = cross(frame.n, h), r = vec3_subtract(vec3_scale(frame.n, 2.0f * c.b), v), aside = cross(r, l);
    c.half_sine2 = dot(across, across);
    c.mirror = dot(r, l);
    c.mirror_sine2 = dot(aside, aside);
    c.half_plane = vec2(dot(frame.t, h), dot(frame.b, h));
    c.thread = vec2(dot(frame.t, l), dot(frame.t, v));
    c.across = vec2(dot(frame.b, l), dot(frame.b, v));
    c.hand = 1.0f;
    return c;
}

// The cosine of the Fresnel term. PHONG and BANKS take that of the viewer, as the G-buffer does.
TERM float fresnel_cosine(int model, Cosines c)
{
    return clamp(model == PHONG || model == BANKS ? c.b : c.t, 0.0f, 1.0f);
}

TERM vec3 fresnel_colour(int kind, float index, float extinction, vec3 f0, float cosine)
{
    if (kind == FRESNEL_SCHLICK)
        return schlick_colour(f0, cosine);
    return vec3_scale(f0, fresnel_by_index(kind, index, extinction, cosine));
}

// The cosine of l with the nearest mirror direction of a thread, and its squared sine.
TERM vec2 thread_mirror(vec2 thread)
{
    float l = clamp(thread.x, -1.0f, 1.0f), v = clamp(thread.y, -1.0f, 1.0f);
    float sine_l = sqrt(1.0f - l * l), sine_v = sqrt(1.0f - v * v), across = sine_l * v + l * sine_v;
    return vec2(sine_l * sine_v - l * v, across * across);
}

// The normalisation of a lobe of exponent s.
TERM float lobe_scale(int model, float s)
{
    float about_mirror = model == COSINE_LOBE ? s + 2.0f : model == BLINN_PHONG ? s + 0.5f : s + 1.0f;
    return model == BANKS ? thread_scale(s) : about_mirror * 0.159154943f;
}

// f_r cos a without the Fresnel term. `s`: the exponent of lobes; `width`: of facets.
TERM float lobe_of(int model, int facets, int masking, Cosines c, float s, float width)
{
    if (model == TORRANCE_SPARROW)
        return facet_density(facets, width, c.half_sine2 / (c.half_normal * c.half_normal)) *
               facet_masking(facets, masking, width, c.a, c.b, c.t, c.half_normal) / (3.14159265f * c.b);
    float scale = lobe_scale(model, s);
    if (model == BLINN_PHONG)
        return scale * power(c.half_normal, c.half_sine2, 4.0f * s);
    vec2 mirror = model == BANKS ? thread_mirror(c.thread) : vec2(c.mirror, c.mirror_sine2);
    float sent = scale * power(mirror.x, mirror.y, s);
    return model == BANKS || model == COSINE_LOBE ? sent * c.a : sent;
}
