#version 450 core
// A shadow map of opaque parts. Never discards: that would cost it the early depth test and half its speed.
#include "moments.glsl"
#include "surface.glsl" // unused, but its uniforms are set for every program that draws surfaces

in float depth;
in vec2 uv;

layout(location = 0) out vec2 moments;

void main()
{
    moments = depth_moments(depth);
}
