#version 450 core
// Traces what every pixel sees of a sun or lamp. Where the corners of its cell agree and are of its surface, that; else by rays of its
// own: four places first, and where these disagree the others, by all threads of the group alike.
#include "card_frame.glsl"
#include "card_pixel.glsl"
#define TREE_BINDING CARD_NODES
#define HOLES_BINDING CARD_HOLES
#include "trace.glsl"
#include "card_sun_start.glsl"
layout(local_size_x = 8, local_size_y = 8, local_size_z = 4) in;
layout(std430, binding = CARD_TRIANGLE_PARTS) restrict readonly buffer TriangleParts
{
    uint triangle_parts[];
};
layout(binding = 1) uniform usampler2D coarse;
layout(r8, binding = 0) restrict writeonly uniform image2D visible; // the sun's layer
layout(location = 0) uniform int sun;
layout(location = 1) uniform uvec2 places; // of a pixel: at first, and in a penumbra

shared vec3 starts[64];
shared uint seen[64], again[64], count, again_count;

// The state that the corners of the pixel's cell agree on; -1: none.
float agreed(uint id, ivec2 pixel)
{
    uint surface = triangle_parts[(id & 0x7fffffffu) - 1u] >> 12 & 15u;
    ivec2 cell = pixel / 4, next = min(cell + 1, (size.xy - 1 + 3) / 4);
    uint a = texelFetch(coarse, cell, 0).r, b = texelFetch(coarse, ivec2(next.x, cell.y), 0).r;
    uint c = texelFetch(coarse, ivec2(cell.x, next.y), 0).r, d = texelFetch(coarse, next, 0).r;
    if (a != b || b != c || c != d || a >> 4 != surface)
        return -1.0;
    return (a & 7u) == 0u ? 0.0 : (a & 7u) == 4u ? 1.0 : -1.0;
}

void main()
{
    uint mine = gl_LocalInvocationIndex, slot = 64u;
    if (mine == 0u) {
        count = 0u;
        again_count = 0u;
    }
    barrier();
    ivec2 pixel = ivec2(gl_WorkGroupID.xy * 8u + gl_LocalInvocationID.xy);
    bool is_inside = mine < 64u && all(lessThan(pixel, size.xy));
    uint id = is_inside ? texelFetch(ids, pixel, 0).r : 0u;
    float result = id != 0u ? agreed(id, pixel) : 0.0;
    if (result < 0.0) {
        vec3 start;
        result = 0.0;
        bool transmits = (triangle_parts[(id & 0x7fffffffu) - 1u] & CARD_TRANSMITS) != 0u;
        if (sun_start(place_of(id, pixel), sun, transmits, start) != 0u) {
            slot = atomicAdd(count, 1u);
            starts[slot] = start;
            seen[slot] = 0u;
        }
    }
    barrier();
    uint traced = count;
    for (uint k = mine; k < places.x * traced; k += 256u)
        atomicAdd(seen[k % traced], sees_sun(sun, k / traced, starts[k % traced]));
    barrier();
    bool is_partial = slot < 64u && seen[slot] != 0u && seen[slot] != 255u * places.x;
    if (slot < 64u && !is_partial)
        result = seen[slot] == 255u * places.x ? 1.0 : 0.0;
    if (is_partial)
        again[atomicAdd(again_count, 1u)] = slot;
    barrier();
    uint partial = again_count;
    for (uint k = mine; k < (places.y - places.x) * partial; k += 256u) {
        uint at = again[k % partial];
        atomicAdd(seen[at], sees_sun(sun, places.x + k / partial, starts[at]));
    }
    barrier();
    if (is_partial)
        result = float(seen[slot]) / (255.0 * float(places.y));
    if (is_inside)
        imageStore(visible, pixel, vec4(result));
}
