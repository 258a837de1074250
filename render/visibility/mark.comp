#version 450 core
// Marks the sides of triangles that an image of IDs shows with the frame's number (gbuffer/ids.c: mark_pixels).
#include "card_points.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = CARD_SIDES) restrict writeonly buffer Sides { uint sides[]; };
layout(binding = 0) uniform usampler2D ids; // 1 + triangle, and its back << 31; 0: nothing
layout(location = 0) uniform uint frame;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(ids, 0))))
        return;
    const uint id = texelFetch(ids, pixel, 0).r;
    if (id != 0u)
        sides[2u * ((id & ~CARD_BACK) - 1u) + (id >> 31)] = frame;
}
