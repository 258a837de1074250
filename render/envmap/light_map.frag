#version 450 core
// The baked diffuse light of the samples that are seen.
#include "surface.glsl"

layout(location = 66) uniform int layer;

layout(binding = 16) uniform usampler2D seen_triangle;
layout(binding = 17) uniform sampler2DArray light_map;

in vec2 chart;
in vec3 light_front, light_back;

layout(location = 0) out vec4 light;

const uint TRIANGLE_BACK = 0x80000000u;

void main()
{
    uint triangle = (first_triangle + uint(gl_PrimitiveID) + 1u) | (gl_FrontFacing ? 0u : TRIANGLE_BACK);
    if (texelFetch(seen_triangle, ivec2(gl_FragCoord.xy), 0).r != triangle)
        discard;
    vec3 baked = textureLod(light_map, vec3(chart, float(max(layer, 0) + (gl_FrontFacing ? 0 : 1))), 0.0).rgb;
    light = vec4(layer >= 0 ? baked : gl_FrontFacing ? light_front : light_back, 1.0);
}
