// The two moments of a variance shadow map [Donnelly and Lauritzen 2006].
layout(location = 19) uniform float slope_max; // depth per texel

// Needs derivatives, so it is called before any discard.
vec2 depth_moments(float depth)
{
    vec2 slope = clamp(vec2(dFdx(depth), dFdy(depth)), -slope_max, slope_max);
    // A texel stands for a tilted piece of surface, whose depths vary by slope^2 / 12 along each side.
    return vec2(depth, depth * depth + dot(slope, slope) / 12.0);
}
