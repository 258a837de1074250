#version 450 core
// Keeps the interpolated directions of the samples that are seen.
#include "surface.glsl"

layout(binding = 16) uniform usampler2D seen_triangle;

in vec3 over;
in float cosine;
in vec3 under_front, under_back;

layout(location = 0) out vec4 over_vector;
layout(location = 1) out vec4 under_vector;

const uint TRIANGLE_BACK = 0x80000000u;

void main()
{
    uint triangle = (first_triangle + uint(gl_PrimitiveID) + 1u) | (gl_FrontFacing ? 0u : TRIANGLE_BACK);
    if (texelFetch(seen_triangle, ivec2(gl_FragCoord.xy), 0).r != triangle)
        discard;
    over_vector = vec4(over, gl_FrontFacing ? cosine : -cosine);
    under_vector = vec4(gl_FrontFacing ? under_front : under_back, 0.0);
}
