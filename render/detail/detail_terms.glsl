// Scalar terms of fabric detail in the common subset of GLSL and C; detail_terms.h includes them in C.
#ifndef TERM
#define TERM
#endif

// Distance along the surface per height, for a view direction with z component view_z. Below 3 degrees it is constant,
// so that no displacement exceeds twenty times the height.
TERM float detail_slant(float view_z)
{
    return 1.0f / max(view_z, 0.05f);
}

// The height of a view ray over the circle that touches the surface, at a distance towards the eye, but for a term of
// the height's square over the diameter.
TERM float detail_over_circle(float view_z, float curvature, float distance)
{
    return distance * (view_z + 0.5f * curvature * distance);
}

// The distance at which a view ray has this height: of two the one nearer to the eye.
TERM float detail_circle_distance(float view_z, float curvature, float height)
{
    float square = max(view_z * view_z + 2.0f * curvature * height, 0.0f);
    return 2.0f * height / max(view_z + sqrt(square), 1e-6f);
}

// The same for light, without the limit, because shadows may be long. Shadows reach at most DETAIL_REACH repeats of the
// field; their rays start DETAIL_LIFT (a fraction of the depth of the field) above the surface, against self-shadowing
// by rounding.
#define DETAIL_REACH 2.0f
#define DETAIL_LIFT 0.002f
TERM float detail_climb(float light_z)
{
    return 1.0f / max(light_z, 1e-4f);
}

// The fraction of its clearance that a ray may descend in one step of the cone march (cones.h). `cone` is the value of
// the map; `slant` is the number of texels that the ray passes from the top of the field to its bottom.
#define DETAIL_CONE_TEXELS 16.0f
TERM float detail_cone_step(float cone, float slant)
{
    float opens = DETAIL_CONE_TEXELS * cone;
    return opens / max(opens + (1.0f - cone) * slant, 1e-6f);
}

// The height to the next line between texel centres along one axis. A ray may always step there, because a bilinear
// field has no crest between two such lines. `at`: position in texels relative to any of these lines; `speed`: texels
// per metre of descent.
TERM float detail_to_line(float at, float speed)
{
    float passed = at - floor(at), left = speed > 0.0f ? 1.0f - passed : passed;
    return (left + 0.001f) / max(max(speed, -speed), 1e-6f);
}

// The smallest step: the last of the remaining `steps` reaches the bottom, `rest` below. It is very small at first.
TERM float detail_due(float rest, float steps)
{
    return rest / (steps * steps);
}

// The factor on slopes along an axis where the surface is stretched: heights keep their millimetres, lengths grow.
// `metres`: of the surface per UV unit there; `nominal`: of the UV unit to which the bumps are made. At least a half,
// of cloth twice as long; at most 1.25, for cloth buckles before it is shorter than that: what is more are UVs of
// another scale. 1 where one of the two is unknown.
TERM float detail_slope_factor(float metres, float nominal)
{
    return metres > 0.0f && nominal > 0.0f ? clamp(nominal / metres, 0.5f, 1.25f) : 1.0f;
}

// The variance of the slope along one axis, from the length of the mean of unit normals [Toksvig 2005].
TERM float detail_variance(float mean_length)
{
    float length = clamp(mean_length, 0.05f, 1.0f);
    return (1.0f - length) / length;
}

// Roughness 1 - g of the lobe K_s about the mirror direction, s = 1 / (1 - g), widened by the spread of the facets.
// Along each axis the variance of the lobe is close to 1 / s and adds to that of its directions. These turn by twice
// the angle of the facets in the plane of incidence (variance `along`) and by twice that angle times the cosine across
// it (`beside`).
TERM float detail_widened(float rough, float along, float beside, float cosine)
{
    return clamp(rough + 2.0f * (along + beside * cosine * cosine), 0.0f, 1.0f);
}

// The squared width of facets whose mirror lobe has roughness 1 - g: 2 / (4 s + 2), s = 1 / (1 - g), as in render/brdf.
TERM float detail_facet_square(float rough)
{
    return rough / (2.0f + rough);
}

// The sum that is added to a squared width of facets when the roughness of the yarn is `rough` in place of the
// material's own, and the slopes of unresolved bumps have this variance: a width squared is twice the variance of its
// slopes.
TERM float detail_widening(float own_rough, float rough, float variance)
{
    return detail_facet_square(rough) - detail_facet_square(own_rough) + 2.0f * variance;
}

// The fraction of a broad light above the tangent plane of facets that spread about the surface's normal: the mean of
// (1 + cos tilt) / 2.
TERM float detail_open(float mean_length)
{
    return 0.5f + 0.5f * clamp(mean_length, 0.0f, 1.0f);
}

// The turn of a shading normal towards a viewer at this cosine to it, as a multiple of the direction to the viewer that
// is added to the normal. Near an outline interpolated normals point away from a viewer who sees the surface: no
// gloss would be sent there, and satin, whose light is gloss, had a black rim. Normals keep what they are up to 1.1
// degrees from edge-on.
TERM float detail_facing(float cosine)
{
    return max(0.02f - cosine, 0.0f);
}

// The slope of a horizon from the sine of its elevation. Bytes do not resolve slopes above 16.
TERM float detail_slope(float sine)
{
    return sine / sqrt(max(1.0f - sine * sine, 0.004f));
}

// The sine of the horizon between two baked angles `step` apart, `turned` from the first. The slope of a straight
// ridge, and of the segment between two corners of any horizon, is linear in the direction; each angle is weighted by
// the component of the direction along it.
TERM float detail_between(float first, float second, float turned, float step)
{
    float slope = (sin(step - turned) * detail_slope(first) + sin(turned) * detail_slope(second)) / sin(step);
    return slope / sqrt(1.0f + slope * slope);
}

// The visibility of a light over a horizon, both given as sines of their elevation. `change` is the change of their
// difference per sample: the edge is one sample wide, at least the quantisation of 8 bits, and not much wider at the
// end of a yarn. A horizon of 0 occludes nothing.
TERM float detail_over_horizon(float light, float horizon, float change)
{
    return horizon > 0.0f ? clamp(0.5f + (light - horizon) / clamp(change, 0.004f, 0.08f), 0.0f, 1.0f) : 1.0f;
}

// The integral of (a cos e + b sin e) ds up to s = sin e: the light of a slice of a uniform sky from the surface to
// elevation e, received by a normal with component b along the surface normal and a along the azimuth of the slice.
TERM float detail_slice(float a, float b, float s)
{
    return 0.5f * (a * (asin(s) + s * sqrt(max(1.0f - s * s, 0.0f))) + b * s * s);
}

// The same from the horizon upwards, or from the plane of the normal if that is higher.
TERM float detail_slice_over(float a, float b, float horizon)
{
    float turned = a < 0.0f ? -a / sqrt(max(a * a + b * b, 1e-12f)) : 0.0f;
    return detail_slice(a, b, 1.0f) - detail_slice(a, b, clamp(max(horizon, turned), 0.0f, 1.0f));
}

// The level of a map by the squares of the steps to the next sample across and down, in texels; 0 where a texel is
// larger than a sample.
TERM float texel_level(float across, float down)
{
    return 0.5f * log2(max(max(across, down), 1.0f));
}
