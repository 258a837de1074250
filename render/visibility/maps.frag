#version 450 core
// The two moments of a variance shadow map [Donnelly and Lauritzen 2006], for opaque parts. Never discards: that
// would cost it the early depth test and more than half its speed.
#include "surface.glsl" // unused, but its uniforms are set for every program that draws surfaces

in float depth;
in vec2 uv;

layout(location = 0) out vec2 moments;

void main()
{
    moments = vec2(depth, depth * depth);
}
