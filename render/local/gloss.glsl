// The reflectance models of render/brdf/brdf.h, evaluated directly. MODEL, FACETS, MASKING, WARD_FORM and FRESNEL are
// the numbers of the enums of assets/base/material.h.
#include "lamp.glsl"
#include "lobes_terms.glsl"
#include "power.glsl"
#include "tables.glsl"

layout(location = 71) uniform vec2 gloss_optics; // index, extinction
#ifdef THREADS
layout(location = 88) uniform vec2 thread_widths[THREADS]; // along weft and warp without maps
layout(location = 90) uniform vec3 thread_ratios[THREADS]; // of their light to the diffuse colour
#endif

const int PHONG = 0, BLINN_PHONG = 1, COSINE_LOBE = 2, TORRANCE_SPARROW = 3, WARD = 4, BANKS = 5;
const int BOUNDED = 1;
const int SCHLICK = 0, DIELECTRIC = 1, CONDUCTOR = 2;

const float PI = 3.14159265;

// The material's widths with the sum that maps and bumps add to their squares along weft and warp, and to their product:
// the entries of a symmetric matrix (tl_brdf_bumped).
vec3 squares_of(vec2 widths, vec3 widening)
{
    float weft = facet_square(widths.x * widths.x, widening.x), warp = facet_square(widths.y * widths.y, widening.y);
    return vec3(weft, warp, facet_product(weft, warp, widening.z));
}

float fresnel_conductor(float n, float k, float cosine)
{
    float c = cosine, s2 = 1.0 - c * c, real = n * n - k * k - s2;
    if (k == 0.0)
        return fresnel_dielectric(n, c);
    float size = sqrt(real * real + 4.0 * n * n * k * k), p = sqrt(max(0.5 * (size + real), 0.0));
    float across = (size - 2.0 * p * c + c * c) / max(size + 2.0 * p * c + c * c, 1e-12);
    float along = (c * c * size - 2.0 * p * c * s2 + s2 * s2) / max(c * c * size + 2.0 * p * c * s2 + s2 * s2, 1e-12);
    return clamp(0.5 * across * (1.0 + along), 0.0, 1.0);
}

// The Fresnel term. PHONG and BANKS take it at the cosine of the viewer, as the G-buffer does.
vec3 fresnel(vec3 f0, Cosines c)
{
    float cosine = clamp(MODEL == PHONG || MODEL == BANKS ? c.b : c.t, 0.0, 1.0);
    if (FRESNEL == DIELECTRIC)
        return f0 * fresnel_dielectric(gloss_optics.x, cosine);
    if (FRESNEL == CONDUCTOR)
        return f0 * fresnel_conductor(gloss_optics.x, gloss_optics.y, cosine);
    return schlick_colour(f0, cosine);
}

float ward(Cosines c, vec3 squares, bool is_bounded)
{
    vec2 slope = c.half_plane / c.half_normal;
    float steep = c.t * c.half_normal * c.half_normal;
    return ward_lobe(is_bounded, slope.x, slope.y, steep * steep, c.a, c.b, squares.x, squares.y, squares.z);
}

// The cosine of l with the nearest mirror direction of a thread, and its squared sine.
vec2 thread_mirror(vec2 thread)
{
    vec2 cosine = clamp(thread, -1.0, 1.0), sine = sqrt(1.0 - cosine * cosine);
    float across = sine.x * cosine.y + cosine.x * sine.y;
    return vec2(sine.x * sine.y - cosine.x * cosine.y, across * across);
}

// f_r cos a without the Fresnel term.
float lobe(Cosines c, float s, vec3 widening)
{
    if (MODEL == TORRANCE_SPARROW) {
        float width = sqrt(facet_square(gloss_widths.x * gloss_widths.x, widening.x));
        return facet_density(FACETS, width, c.half_sine2 / (c.half_normal * c.half_normal)) *
               facet_masking(FACETS, MASKING, width, c.a, c.b, c.t, c.half_normal) / (PI * c.b);
    }
    if (MODEL == WARD)
        return ward(c, squares_of(gloss_widths.xy, widening), WARD_FORM == BOUNDED);
    if (MODEL == BLINN_PHONG)
        return (4.0 * s + 2.0) / (8.0 * PI) * power(c.half_normal, c.half_sine2, 4.0 * s);
    if (MODEL == BANKS) {
        vec2 mirror = thread_mirror(c.thread);
        return thread_scale(s) * power(mirror.x, mirror.y, s) * c.a;
    }
    if (MODEL == COSINE_LOBE)
        return (s + 2.0) / (2.0 * PI) * power(c.mirror, c.mirror_sine2, s) * c.a;
    return (s + 1.0) / (2.0 * PI) * power(c.mirror, c.mirror_sine2, s);
}

// f_r cos a of a material whose maps give f0, s and `widening`. Tables are made for constant values and ignore the maps.
vec3 gloss(Cosines c, vec3 f0, float s, vec3 widening)
{
    if (!(c.a > 0.0 && c.b > 0.0 && c.half_normal > 0.0))
        return vec3(0.0);
#if TABLES > 0
    return tables_gloss(c, tables_product(c));
#else
    return fresnel(f0, c) * lobe(c, s, widening);
#endif
}

// Light that has been inside threads (tl_brdf_sum_of of brdf.h); `widening` along weft and warp as Ward's facets have it.
vec3 inside_threads(Cosines c, vec3 f0, vec3 kd, vec3 widening)
{
    vec3 sent = vec3(0.0);
#ifdef THREADS
    if (!(c.a > 0.0 && c.b > 0.0 && c.half_normal > 0.0))
        return sent;
    for (int i = 0; i < THREADS; i++)
        sent += clamp(thread_ratios[i] * kd, 0.0, 1.0) * ward(c, squares_of(thread_widths[i], widening), true);
    sent *= 1.0 - schlick_colour(f0, c.t);
#endif
    return sent;
}
