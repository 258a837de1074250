#version 450 core
// The two moments of a variance shadow map [Donnelly and Lauritzen 2006].
#include "surface.glsl"

layout(location = 19) uniform float slope_max; // depth per texel

in float depth;
in vec2 uv;

layout(location = 0) out vec2 moments;

void main()
{
    // Derivatives come first: past a discard they are undefined.
    vec2 slope = clamp(vec2(dFdx(depth), dFdy(depth)), -slope_max, slope_max);
    if (material_scalars.w > 0.0 && surface_cut_away(surface_colour(uv).a))
        discard;
    // A texel stands for a tilted piece of surface, whose depths vary by slope^2 / 12 along each side.
    moments = vec2(depth, depth * depth + dot(slope, slope) / 12.0);
}
