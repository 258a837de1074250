#version 450 core
// Lists the tiles of each class of materials, and how many groups the listed probes take.
#include "card_frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = CARD_TRIANGLE_PARTS) restrict readonly buffer TriangleParts
{
    uint triangle_parts[];
};
layout(std430, binding = CARD_TILES) restrict writeonly buffer Tiles
{
    uint tiles[];
};
layout(std430, binding = CARD_LISTED) restrict readonly buffer Listed
{
    uint listed; // tl_card_points_list
};
layout(std430, binding = CARD_WORK) restrict buffer Work
{
    uint work[];
};
layout(binding = 0) uniform usampler2D ids;

shared uint classes; // bits of those in this tile; class 0: nothing is seen

void main()
{
    uint mine = gl_LocalInvocationIndex;
    if (mine == 0u)
        classes = 0u;
    barrier();
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, size.xy))) {
        uint id = texelFetch(ids, at, 0).r;
        atomicOr(classes, 1u << (id != 0u ? triangle_parts[(id & 0x7fffffffu) - 1u] >> 16 & 15u : 0u));
    }
    barrier();
    if (mine < uint(CARD_CLASSES_MAX) && (classes >> mine & 1u) != 0u) {
        uint slot = atomicAdd(work[4u * mine], 1u);
        tiles[mine * uint(size.z * size.w) + slot] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16;
    }
    if (gl_WorkGroupID.xy == uvec2(0u) && mine == 0u) {
        work[CARD_WORK_OF_32] = (listed + 31u) / 32u;
        work[CARD_WORK_OF_4] = (listed + 3u) / 4u;
    }
}
