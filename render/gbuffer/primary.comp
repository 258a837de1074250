#version 450 core
// The ID buffer by rays (primary.h).
#include "trace.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(r32ui, binding = 0) restrict writeonly uniform uimage2D ids; // 0; or 1 + the triangle, and its back << 31
layout(location = 0) uniform vec3 eye;
layout(location = 1) uniform vec3 forward; // the plane at distance 1: its middle, and from there its edges (tl_view)
layout(location = 2) uniform vec3 right;
layout(location = 3) uniform vec3 up;
layout(location = 4) uniform vec2 depths; // near and far, along `forward`: its length is the rays' unit

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(ids);
    if (any(greaterThanEqual(pixel, size)))
        return;
    const vec2 at = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    const TreeHit hit = tree_seen(eye, forward + at.x * right + at.y * up, depths.x, depths.y);
    const uint id = hit.triangle == TREE_NO_TRIANGLE ? 0u : hit.triangle + 1u | (hit.back ? 0x80000000u : 0u);
    imageStore(ids, pixel, uvec4(id));
}
