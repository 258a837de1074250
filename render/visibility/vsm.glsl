// Chebyshev's upper bound on the share of a filtered shadow map that lies behind depth `t` [Donnelly and
// Lauritzen 2006, eq. 5]. `floor_variance` keeps rounding from shadowing; values below `bleed` become 0 and the
// rest is stretched, which darkens light that leaks where shadows overlap.
float vsm_visibility(vec2 moments, float t, float floor_variance, float bleed)
{
    float distance = t - moments.x;
    if (distance <= 0.0)
        return 1.0;
    float variance = max(moments.y - moments.x * moments.x, floor_variance);
    float bound = variance / (variance + distance * distance);
    return clamp((bound - bleed) / (1.0 - bleed), 0.0, 1.0);
}
