// Terms of the light of discs and regions, written once for GLSL and C (terms.h).
#ifdef GL_core_profile
#include "lobes_terms.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// Mean over a disc of the height above the horizon, in radii, 0 below it, when the centre is u radii above: u itself
// above, 0 below; while the disc sets (u (pi/2 + asin u) + (2 + u^2) sqrt(1 - u^2) / 3) / pi, within 0.0015, as a
// polynomial that joins both smoothly.
TERM float disc_height(float u)
{
    float risen = clamp(u + 1.0f, 0.0f, 2.0f), v = risen - 1.0f;
    return risen * risen * (0.2122f + v * (0.0756f - 0.0378f * v)) + max(u - 1.0f, 0.0f);
}

// Mean of max(0, cosine) over a disc of this sine of its half-angle, when its centre has this cosine.
TERM float disc_cosine(float cosine, float sine)
{
    float radius = max(sine, 1e-4f);
    return radius * disc_height(cosine / radius);
}

// K_s averaged over a region, at a direction with this cosine to it, without its power. `sine`: of the half-angle over
// which its light is spread; `exponent`: broadened.
TERM float region_lobe(float cosine, float sine, float inverse_sine, float exponent)
{
    float base = sine * disc_height(cosine * inverse_sine);
    return 0.159154943f * (exponent + 1.0f) * exp2(exponent * log2(max(base, 1e-30f)));
}

// ... and of K_1, which needs no power.
TERM float region_lobe_diffuse(float cosine, float sine, float inverse_sine)
{
    return 0.318309886f * sine * disc_height(cosine * inverse_sine);
}

// Share of a disc above a line that runs at -u radii from its centre: 1/2 + (u sqrt(1 - u^2) + asin u) / pi, within
// 0.0013, as a polynomial.
TERM float disc_share(float u)
{
    float v = clamp(u, -1.0f, 1.0f);
    return 0.5f + v * (0.63f - v * v * (0.069f + 0.061f * v * v));
}

// A bumped surface's own shadow: 0 where the light lies below the plane of the smooth normal, a steep ramp above, which
// flickers less than a step does [Schroecker 2002, 4.5]. Its steepness costs light: with 8 an image is 0.7 % darker
// than with 32.
TERM float self_shadow_ramp(float cosine)
{
    return clamp(32.0f * cosine, 0.0f, 1.0f);
}

// The share of a light above the plane of a surface's smooth normal: of a sun's disc, of this angular radius, or of a lamp.
TERM float light_above(bool is_lamp, float radius, float cosine)
{
    return is_lamp ? self_shadow_ramp(cosine) : disc_share(cosine / max(radius, 1e-3f));
}
