// The reflectance models of render/brdf/brdf.h, evaluated directly. MODEL, FACETS, MASKING, WARD_FORM and FRESNEL are
// the numbers of the enums of assets/base/material.h.
const float PI = 3.14159265;
#include "lamp.glsl"
#include "lobes_terms.glsl"
#include "tables.glsl"
#include "layers_terms.glsl"

layout(location = 71) uniform vec2 gloss_optics; // index, extinction
layout(location = 102) uniform vec4 matt_law; // of the diffuse reflectance
#ifdef THREADS
layout(location = 88) uniform vec2 thread_widths[THREADS]; // along weft and warp without maps
layout(location = 90) uniform vec3 thread_ratios[THREADS]; // of their light to the diffuse colour
#endif

const int BOUNDED = 1;

// The material's widths with the sum that maps and bumps add to their squares along weft and warp, and to their product:
// the entries of a symmetric matrix (tl_brdf_bumped).
vec3 squares_of(vec2 widths, vec3 widening)
{
    float weft = facet_square(widths.x * widths.x, widening.x), warp = facet_square(widths.y * widths.y, widening.y);
    return vec3(weft, warp, facet_product(weft, warp, widening.z));
}

float ward(Cosines c, vec3 squares, bool is_bounded)
{
    vec2 slope = c.half_plane / c.half_normal;
    float steep = c.t * c.half_normal * c.half_normal;
    return ward_lobe(is_bounded, slope.x, slope.y, steep * steep, c.a, c.b, squares.x, squares.y, squares.z);
}

// f_r cos a without the Fresnel term.
float lobe(Cosines c, float s, vec3 widening)
{
    if (MODEL == WARD)
        return ward(c, squares_of(gloss_widths.xy, widening), WARD_FORM == BOUNDED);
    return lobe_of(MODEL, FACETS, MASKING, c, s, sqrt(facet_square(gloss_widths.x * gloss_widths.x, widening.x)));
}

// f_r cos a of a material whose maps give f0, s and `widening`. Tables are made for constant values and ignore the maps.
// FOLDED: with the diffuse light.
vec3 gloss(Cosines c, vec3 f0, float s, vec3 widening)
{
#ifdef FOLDED
    return tables_folded(c);
#endif
    if (!(c.a > 0.0 && c.b > 0.0 && c.half_normal > 0.0))
        return vec3(0.0);
#if TABLES > 0
    return tables_gloss(c, tables_product(c));
#else
    return fresnel_colour(FRESNEL, gloss_optics.x, gloss_optics.y, f0, fresnel_cosine(MODEL, c)) * lobe(c, s, widening);
#endif
}

// f_r cos a of a white diffuse colour, unless that is in a table.
float matt(Cosines c)
{
#ifdef FOLDED
    return 0.0;
#endif
    return max(c.a, 0.0) / PI * matt_factor(matt_law, c.a, c.b, 2.0 * c.t * c.t - 1.0, c.thread.x);
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
