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

// The same for light, which shifts nothing: its shadows are as long as they are. They are looked for so many repeats
// of the field away, from a little over the surface (in shares of the field's depth), which rounding must not shade.
#define DETAIL_REACH 2.0f
#define DETAIL_LIFT 0.002f
TERM float detail_climb(float light_z)
{
    return 1.0f / max(light_z, 1e-4f);
}

// Relief walks from cone to cone (cones.h). The share of its clearance that a ray may come down at once: `cone` is the
// map's, `slant` how many texels the ray passes from the field's top to its bottom.
#define DETAIL_CONE_TEXELS 16.0f
TERM float detail_cone_step(float cone, float slant)
{
    float opens = DETAIL_CONE_TEXELS * cone;
    return opens / max(opens + (1.0f - cone) * slant, 1e-6f);
}

// Where a cone says less, a ray goes on to the next line between middles of texels, for between two of them a bilinear
// field has no crest: by how much height along one axis. `at`: texels from any of these lines; `speed`: texels that the
// ray passes while it comes down a metre.
TERM float detail_to_line(float at, float speed)
{
    float passed = at - floor(at), left = speed > 0.0f ? 1.0f - passed : passed;
    return (left + 0.001f) / max(max(speed, -speed), 1e-6f);
}

// And so far that the last of `steps` that are left reaches the bottom from `rest` above it: hardly at all at first.
TERM float detail_due(float rest, float steps)
{
    return rest / (steps * steps);
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

// Slope of a horizon by the sine of its height. Bytes tell slopes above 16 from each other no more.
TERM float detail_slope(float sine)
{
    return sine / sqrt(max(1.0f - sine * sine, 0.004f));
}

// Sine of the horizon between two angles that were baked `step` apart, `turned` from the first. The slope of a straight
// ridge, and of what lies between two corners of any horizon, is linear in the direction that looks at it: each angle
// has the share of that direction that a parallelogram gives it.
TERM float detail_between(float first, float second, float turned, float step)
{
    float slope = (sin(step - turned) * detail_slope(first) + sin(turned) * detail_slope(second)) / sin(step);
    return slope / sqrt(1.0f + slope * slope);
}

// How much of a light is seen over a horizon, both as sines of their heights over the surface, where the two come
// nearer by `change` from one sample to the next: an edge is a sample wide, never narrower than the step of 8 bits, and
// not much wider where a yarn ends. A horizon of 0 hides nothing.
TERM float detail_over_horizon(float light, float horizon, float change)
{
    return horizon > 0.0f ? clamp(0.5f + (light - horizon) / clamp(change, 0.004f, 0.08f), 0.0f, 1.0f) : 1.0f;
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
