#version 450 core
// Traces what every fourth pixel each way sees of a sun: four of its places, a ray a thread. 0: nothing; 4: all; 2: a part;
// and 8: from the other side; 7: it faces away; 15: nothing is there; and the surface << 4.
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
layout(r8ui, binding = 0) restrict writeonly uniform uimage2D coarse;
layout(location = 0) uniform int sun;

shared vec4 starts[64]; // w: 1: it faces the sun
shared uint states[64], sums[64];

void main()
{
    uint lane = gl_LocalInvocationID.y * 8u + gl_LocalInvocationID.x, k = gl_LocalInvocationID.z, surface = 0u;
    ivec2 cell = ivec2(gl_WorkGroupID.xy * 8u + gl_LocalInvocationID.xy), last = (size.xy - 1 + 3) / 4;
    bool is_inside = all(lessThanEqual(cell, last));
    if (k == 0u) {
        ivec2 pixel = min(4 * cell, size.xy - 1);
        uint id = is_inside ? texelFetch(ids, pixel, 0).r : 0u;
        states[lane] = 15u;
        starts[lane] = vec4(0.0);
        sums[lane] = 0u;
        if (id != 0u) {
            Place p = place_of(id, pixel);
            vec3 start;
            uint faces = sun_start(p, sun, (triangle_parts[p.triangle] & CARD_TRANSMITS) != 0u, start);
            surface = triangle_parts[p.triangle] >> 12 & 15u;
            states[lane] = faces == FACES ? 0u : faces == LETS_THROUGH ? 8u : 7u;
            starts[lane] = vec4(start, faces != 0u ? 1.0 : 0.0);
        }
    }
    barrier();
    vec4 start = starts[lane];
    bool is_lamp = suns[sun].w < 0.0; // it has one place
    if (start.w > 0.0 && !(is_lamp && k > 0u))
        atomicAdd(sums[lane], (is_lamp ? 4u : 1u) * sees_sun(sun, k, start.xyz));
    barrier();
    if (k == 0u && is_inside)
        imageStore(coarse, cell, uvec4(states[lane] + (sums[lane] == 1020u ? 4u : sums[lane] > 0u ? 2u : 0u) | surface << 4));
}
