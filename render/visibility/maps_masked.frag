#version 450 core
// A shadow map of parts with holes.
#include "moments.glsl"
#include "surface.glsl"

in float depth;
in vec2 uv;

layout(location = 0) out vec2 moments;

void main()
{
    moments = depth_moments(depth);
    if (surface_cut_away(surface_colour(uv).a))
        discard;
}
