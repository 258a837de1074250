#version 450 core
// As maps.frag, for parts with holes.
#include "surface.glsl"

in float depth;
in vec2 uv;

layout(location = 0) out vec2 moments;

void main()
{
    if (surface_cut_away(surface_colour(uv).a))
        discard;
    moments = vec2(depth, depth * depth);
}
