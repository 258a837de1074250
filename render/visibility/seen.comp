#version 450 core
// Marks the probes at the corners of marked sides (points.c: mark_triangles). Light that comes through a triangle is that
// of its other side.
#include "card_points.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = CARD_SIDES) restrict readonly buffer Sides { uint sides[]; };
layout(std430, binding = CARD_FACTS) restrict readonly buffer Facts { uint facts[]; };
layout(std430, binding = CARD_CORNERS) restrict readonly buffer TriangleProbes { uint triangle_probes[]; };
layout(std430, binding = CARD_MARKS) restrict writeonly buffer Marks { uint marks[]; };
layout(location = 0) uniform uint frame;
layout(location = 1) uniform uint side_count;

void main()
{
    const uint side = gl_GlobalInvocationID.x;
    if (side >= side_count)
        return;
    const bool both = (facts[side / 2u] & CARD_TRANSMITS) != 0u;
    if (sides[side] == frame || (both && sides[side ^ 1u] == frame))
        for (uint k = 0u; k < 3u; k++)
            marks[triangle_probes[3u * side + k]] = frame;
}
