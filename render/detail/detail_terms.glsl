// Scalar terms of fabric detail, written once for GLSL and C (detail_terms.h): the common subset of both.
#ifndef TERM
#define TERM
#endif

// Metres along the surface for a metre of height, seen from a direction of this height over the surface. Below 3
// degrees it stays as it is there, so that no shift ever exceeds twenty times the height.
TERM float detail_slant(float view_z)
{
    return 1.0f / max(view_z, 0.05f);
}

// Normals that are averaged get shorter, and what they lose tells how far they spread [Toksvig 2005]: the variance of
// their slope along one axis.
TERM float detail_variance(float mean_length)
{
    float length = clamp(mean_length, 0.05f, 1.0f);
    return (1.0f - length) / length;
}

// 1 - g of the lobe K_s about the mirror direction, s = 1 / (1 - g), once facets spread. Along each axis the lobe's
// variance is nearly 1 / s and adds up with that of its directions, which turn twice as far as the facets do in the
// plane of incidence (variance `along`) and by twice the cosine beside it (`beside`).
TERM float detail_widened(float rough, float along, float beside, float cosine)
{
    return clamp(rough + 2.0f * (along + beside * cosine * cosine), 0.0f, 1.0f);
}

// Share of a broad light that facets spread about the surface's normal still see above its plane: the mean of
// (1 + cos tilt) / 2.
TERM float detail_open(float mean_length)
{
    return 0.5f + 0.5f * clamp(mean_length, 0.0f, 1.0f);
}

// How much of a light is seen over a horizon, both as sines of their heights over the surface. The ramp hides the steps
// of eight angles and 8 bits.
TERM float detail_over_horizon(float light, float horizon)
{
    return clamp(0.5f + 12.0f * (light - horizon), 0.0f, 1.0f);
}

// Integral of (a cos e + b sin e) ds up to s = sin e: light by a slice of the sky from the horizon to the height e,
// received by a normal with b along the surface's and a along the slice's azimuth.
TERM float detail_slice(float a, float b, float s)
{
    return 0.5f * (a * (asin(s) + s * sqrt(max(1.0f - s * s, 0.0f))) + b * s * s);
}

// The same from a horizon upwards, or from where the surface itself turns away, whichever is higher.
TERM float detail_slice_over(float a, float b, float horizon)
{
    float turned = a < 0.0f ? -a / sqrt(max(a * a + b * b, 1e-12f)) : 0.0f;
    return detail_slice(a, b, 1.0f) - detail_slice(a, b, clamp(max(horizon, turned), 0.0f, 1.0f));
}
