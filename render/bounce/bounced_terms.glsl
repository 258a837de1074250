// Bounced light of one place in spherical harmonics of bands 0 to 3, for GLSL and C (bounced.h).
//
// Only directions above the surface have light. A lobe of light that is cut off at a horizon rings in so few bands, so
// what comes through a lobe is compared with what would if the hemisphere above the surface were even:
//
//     light through K_s(d) = (terms through K_s(d)) / (hemisphere through K_s(d)) * share above
//
// which for even light is the share of the lobe above the horizon. In these bands the hemisphere of n is
// 1/2 + 3/4 P_1 - 7/16 P_3 of d.n, and K_s keeps 1, (s + 1) / (s + 2), s / (s + 3) and
// (s + 1) (s - 1) / (s + 2) (s + 4) of them [Ramamoorthi and Hanrahan 2001].
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

#define BOUNCED_TERMS 16

// The real spherical harmonics of a unit direction, orthonormal over the sphere.
TERM void bounced_basis(vec3 d, out float basis[BOUNCED_TERMS])
{
    float x2 = d.x * d.x, y2 = d.y * d.y, z2 = d.z * d.z;
    basis[0] = 0.28209479f;
    basis[1] = 0.48860251f * d.y;
    basis[2] = 0.48860251f * d.z;
    basis[3] = 0.48860251f * d.x;
    basis[4] = 1.0925484f * d.x * d.y;
    basis[5] = 1.0925484f * d.y * d.z;
    basis[6] = 0.31539157f * (3.0f * z2 - 1.0f);
    basis[7] = 1.0925484f * d.x * d.z;
    basis[8] = 0.54627422f * (x2 - y2);
    basis[9] = 0.59004359f * d.y * (3.0f * x2 - y2);
    basis[10] = 2.8906114f * d.x * d.y * d.z;
    basis[11] = 0.45704580f * d.y * (5.0f * z2 - 1.0f);
    basis[12] = 0.37317633f * d.z * (5.0f * z2 - 3.0f);
    basis[13] = 0.45704580f * d.x * (5.0f * z2 - 1.0f);
    basis[14] = 1.4453057f * d.z * (x2 - y2);
    basis[15] = 0.59004359f * d.x * (x2 - 3.0f * y2);
}

// The share of K_s above the horizon is (1 + cosine) / 2 for s = 1, and for narrow lobes the integral of a Gaussian; in
// between it is interpolated: within 0.012 of the integral (tests/render/bounce/test_bounced.c).
TERM float share_above(float cosine, float exponent)
{
    float narrow = max(exponent - 1.0f, 0.0f), square = cosine * cosine;
    float steep = cosine * sqrt(1.0f + 0.6366f * narrow) * (1.0f + 0.25f * narrow * square);
    return 0.5f + 0.5f * steep / sqrt(max(1.0f - square, 0.0f) + steep * steep + 1e-12f);
}

// Below this share of the hemisphere nothing is divided by it: the lobe points into the surface.
#define BOUNCED_MIN_EVEN 0.3f
// The terms show light as a lobe of this exponent would, and so they do a horizon. Where it is cut off as sharply as K_s
// has it, pleats of metal were 4 to 5 % brighter, and too bright (docs/notes/bounce.md).
#define BOUNCED_BLUR 6.0f

struct BouncedShares {
    float even;  // what comes through the lobe from the hemisphere above the surface
    float above; // the share of it that is above the surface
};

// K_s about a direction over a surface with a normal. `basis`: what the lobe keeps of the harmonics.
TERM BouncedShares bounced_lobe(vec3 normal, vec3 direction, float exponent, out float basis[BOUNCED_TERMS])
{
    float s = exponent, one = (s + 1.0f) / (s + 2.0f), two = s / (s + 3.0f), three = one * (s - 1.0f) / (s + 4.0f);
    float cosine = dot(normal, direction);
    bounced_basis(direction, basis);
    for (int i = 1; i < BOUNCED_TERMS; i++)
        basis[i] *= i < 4 ? one : i < 9 ? two : three;
    BouncedShares shares;
    shares.even = 0.5f + 0.75f * one * cosine - 0.21875f * three * cosine * (5.0f * cosine * cosine - 3.0f);
    shares.even = max(shares.even, BOUNCED_MIN_EVEN);
    shares.above = share_above(cosine, s * BOUNCED_BLUR / (s + BOUNCED_BLUR));
    return shares;
}

// The pdf of directions of rays about a normal, half of them by the cosine and half even: gloss towards the horizon needs
// rays there.
TERM float bounce_pdf(float cosine)
{
    return (cosine + 0.5f) / 6.28318531f;
}

// A direction by that pdf, fixed to the surface by its tangent; (x, y): even in the unit square.
TERM vec3 bounce_direction(vec3 normal, vec3 tangent, float x, float y)
{
    vec3 along = vec3_subtract(tangent, vec3_scale(normal, dot(normal, tangent)));
    if (!(dot(along, along) > 1e-6f))
        along = cross(normal, abs(normal.x) < 0.6f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f));
    along = direction_or(along, along);
    float cosine = max(sqrt(0.25f + 2.0f * (1.0f - x)) - 0.5f, 1e-2f);
    float radius = sqrt(1.0f - cosine * cosine), angle = 6.28318531f * y;
    vec3 d = vec3_add(vec3_scale(normal, cosine), vec3_scale(along, radius * cos(angle)));
    d = vec3_add(d, vec3_scale(cross(normal, along), radius * sin(angle)));
    return direction_or(d, normal);
}
