#version 450 core
// The next triangle behind an open one at every pixel: the ray from the eye goes on there (render/light/transparency.h).
#include "card_frame.glsl"
#include "card_pixel.glsl"
#define TREE_BINDING CARD_NODES
#define HOLES_BINDING CARD_HOLES
#include "trace.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = CARD_TRIANGLE_PARTS) restrict readonly buffer TriangleParts
{
    uint triangle_parts[];
};
layout(r32ui, binding = 0) restrict writeonly uniform uimage2D behind;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size.xy)))
        return;
    uint id = texelFetch(ids, pixel, 0).r, next = 0u;
    if (id != 0u && (triangle_parts[(id & 0x7fffffffu) - 1u] & CARD_IS_OPEN) != 0u) {
        Place p = place_of(id, pixel);
        TreeHit hit = tree_seen(eye.xyz, p.ray, distance(point_of(p), eye.xyz) + eye.w, 1e30);
        bool is_drawn = hit.triangle < numbers.z || eye.y > disc.y; // the ground has an upper side only
        next = hit.triangle != TREE_NO_TRIANGLE && is_drawn ? hit.triangle + 1u | (hit.back ? 0x80000000u : 0u) : 0u;
    }
    imageStore(behind, pixel, uvec4(next));
}
