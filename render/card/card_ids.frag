#version 450 core
// The number of the nearest triangle at a pixel, as gbuffer.frag has it for ONLY_TRIANGLE. HOLES: where it is whole.
#include "depth_terms.glsl"
#ifdef HOLES
#include "card_frame.glsl"
#include "card_pixel.glsl"
#define HOLES_BINDING CARD_HOLES
#include "holes.glsl"
#endif
layout(location = 0) out uint out_triangle; // 1 + its number, and its back << 31
layout(depth_greater) out float gl_FragDepth;

void main()
{
#ifdef HOLES
    if (is_hole(uint(gl_PrimitiveID), place_of(uint(gl_PrimitiveID) + 1u, ivec2(gl_FragCoord.xy)).weights))
        discard;
#endif
    gl_FragDepth = gl_FragCoord.z + (gl_FrontFacing ? 0.0 : DEPTH_OF_BACKS);
    out_triangle = uint(gl_PrimitiveID + 1) | (gl_FrontFacing ? 0u : 0x80000000u);
}
