// Visibility at points, for GLSL and C (refresh.h).
#ifndef TERM
#define TERM
#endif

// A pixel's horizon differs from its vertices' by up to half the bend of a triangle. Regions are therefore traced down to
// 17 degrees below a vertex's tangent plane, and clipped at the pixel's horizon. The clipped part must not count as hidden
// here, too, so a value describes the part above the horizon: a direction below it is mirrored at the vertex's plane.
// (Review at rest: 3.3 to 3.1 % in a studio, 1.8 to 1.6 % in the sun; mean FLIP 0.041 to 0.033, 0.033 to 0.027.)
#define TL_SINE_BELOW 0.2924f

// A surface within this distance above a point covers it: the point's value then does not hold for uncovered neighbours.
// In ray offsets; 1 cm for a figure.
#define TL_COVER_OFFSETS 100

// Weights of directions are kept in sixteen bits: a thousand rounds fill them, and from then on the mean is a running
// one.
#define TL_WEIGHT_ONE 64.0f

// The weight of a direction in the mean over its region: the cosine of incidence. Without it the mean would be too dark,
// because directions near the horizon are hidden more often and contribute less light. It never is 0, because glossy
// lobes may lie near the horizon.
TERM float visibility_weight(float cosine)
{
    return floor(TL_WEIGHT_ONE * max(abs(cosine), 0.03125f) + 0.5f);
}
