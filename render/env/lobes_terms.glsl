// Cosine lobes, and fetches from the maps of light through them (lobes.h), for GLSL and C.
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// A direction of the world in an environment that is turned by its yaw about +Y; with -sine back.
TERM vec3 turned_direction(float cosine, float sine, vec3 d)
{
    return vec3(cosine * d.x - sine * d.z, d.y, sine * d.x + cosine * d.z);
}

// The viewer mirrored at a surface. Where an interpolated normal turns away from the viewer it passes straight on instead
// of flipping.
TERM vec3 mirrored_viewer(vec3 n, vec3 viewer)
{
    return vec3_subtract(vec3_scale(n, 2.0f * max(dot(n, viewer), 0.0f)), viewer);
}

// ... unit.
TERM vec3 mirror_direction(vec3 n, vec3 viewer)
{
    return direction_or(mirrored_viewer(n, viewer), n);
}

// Exponent s = 1 / (1 - g) of glossiness g, from 1 to 1e6.
TERM float lobe_exponent(float glossiness)
{
    return 1.0f / max(1.0f - max(min(glossiness, 1.0f), 0.0f), 1e-6f);
}

// K_s(d, w) = (s + 1) / 2 pi max(0, d . w)^s
TERM float lobe_cosine(float s, float cosine)
{
    return 0.15915494f * (s + 1.0f) * pow(max(cosine, 1e-30f), s); // GLSL leaves pow(0, s) to the driver
}

// Exponent of the cosine lobe that stands for K_s averaged over a region whose directions lie `spread` (root mean
// square angle, rad) about its centre. Along each of two axes the region's variance is spread^2 / 2 and the lobe's
// nearly 1 / (s + 1); variances add. Against the average over a disc it is off by less than 3 % in L1 while
// spread^2 (s + 1) < 1, by 10 % at 2: beyond that a lobe's peak is the region's own shape. Broad lobes over large
// regions add up to 0.9 spread^2 / sqrt(s): their foot, where the hemisphere cuts them, is no power.
TERM float lobe_broadened_exponent(float s, float spread)
{
    return max((s + 1.0f) / (1.0f + (s + 1.0f) * 0.5f * spread * spread) - 1.0f, 0.25f);
}

// A point of the octahedron unfolded about +Y, in [0, 1]: that of a direction of any length. Below the horizon
// 1 - |v| = |u| + |y|.
TERM vec2 octahedral_place(vec3 d)
{
    float scale = 0.5f / (abs(d.x) + abs(d.y) + abs(d.z));
    float u = d.x * scale, v = d.z * scale, outwards = max(-d.y, 0.0f) * scale;
    u += u < 0.0f ? -outwards : outwards;
    v += v < 0.0f ? -outwards : outwards;
    return vec2(u + 0.5f, v + 0.5f);
}

// The texel of a map with a border of one, at u or v; whole numbers are centres. NaN becomes 0.
TERM float lobe_texel(float at, float side)
{
    return min(max(at * side + 0.5f, 0.0f), side + 0.5f);
}

// Blends of exponents (tl_exponent_blend) by the base-2 logarithm of the exponent, in steps that a blend is linear over.
#define LOBE_BLEND_STEPS 64.0f // an octave
#define LOBE_BLEND_OCTAVES 10.0f
#define LOBE_BLENDS 641 // steps in all, and one
TERM int lobe_blend_number(float log_exponent)
{
    return int(max(min(log_exponent, LOBE_BLEND_OCTAVES), 0.0f) * LOBE_BLEND_STEPS + 0.5f);
}
