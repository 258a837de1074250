#version 450 core
// The number of the nearest triangle at a pixel, as gbuffer.frag has it for ONLY_TRIANGLE.
#include "depth_terms.glsl"
layout(location = 0) out uint out_triangle; // 1 + its number, and its back << 31
layout(depth_greater) out float gl_FragDepth;

void main()
{
    gl_FragDepth = gl_FragCoord.z + (gl_FrontFacing ? 0.0 : DEPTH_OF_BACKS);
    out_triangle = uint(gl_PrimitiveID + 1) | (gl_FrontFacing ? 0u : 0x80000000u);
}
