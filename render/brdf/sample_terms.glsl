// Directions by uniform numbers in [0, 1), and their pdfs, for GLSL and C (sample.c, render/reference/lobe_sample.c).
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// 1 - the cosine of a direction of K_s with its axis: the cosine's distribution is (s + 1) cos^s. The series keeps the digits of
// narrow lobes.
TERM float lobe_off_axis(float s, float share)
{
    float y = 0.693147181f * log2(max(1.0f - share, 1e-30f)) / (s + 1.0f);
    return y > -0.03f ? -y * (1.0f + y * (0.5f + y * (0.16666667f + y * 0.041666667f))) : 1.0f - exp(y);
}

// The direction so far off a unit axis, `turn` of a circle about it.
TERM vec3 lobe_direction(vec3 axis, float off, float turn)
{
    float radius = sqrt(max(off * (2.0f - off), 0.0f)), angle = 6.28318531f * turn, is_aside = abs(axis.x) < 0.6f ? 1.0f : 0.0f;
    vec3 across = direction_or(cross(axis, vec3(is_aside, 1.0f - is_aside, 0.0f)), axis);
    vec3 around = vec3_add(vec3_scale(across, radius * cos(angle)), vec3_scale(cross(axis, across), radius * sin(angle)));
    return direction_or(vec3_add(vec3_scale(axis, 1.0f - off), around), axis);
}

// A slope of facets whose slopes are Gaussian, from their squared widths along weft and warp, and product.
TERM vec2 facet_slope(vec3 squares, float share, float turn)
{
    float r = sqrt(max(-0.693147181f * log2(1.0f - share), 0.0f)), angle = 6.28318531f * turn;
    float a = sqrt(squares.x), b = squares.z / a, c = sqrt(max(squares.y - b * b, 1e-12f));
    return vec2(a * r * cos(angle), b * r * cos(angle) + c * r * sin(angle));
}

// The pdf of the normals of such facets, by solid angle, at h: its coordinates along weft, warp and the surface's normal, > 0.
TERM float facet_slope_pdf(vec3 squares, vec3 h)
{
    float determinant = max(squares.x * squares.y - squares.z * squares.z, 1e-16f);
    float e = h.x * h.x * squares.y - 2.0f * h.x * h.y * squares.z + h.y * h.y * squares.x;
    float fall = exp(-e / (determinant * h.z * h.z));
    return fall > 0.0f ? fall * inversesqrt(determinant) / (3.14159265f * h.z * h.z * h.z) : 0.0f;
}
