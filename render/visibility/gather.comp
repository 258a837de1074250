#version 450 core
// Lists the marked probes. Those of a group stay in order: neighbours stay side by side.
#include "card_points.glsl"
layout(local_size_x = 256) in;
layout(std430, binding = CARD_MARKS) restrict readonly buffer Marks { uint marks[]; };
layout(std430, binding = CARD_LIST) restrict writeonly buffer List { uint list[]; };
layout(std430, binding = CARD_WORK) restrict buffer Work { uint work[]; };
layout(location = 0) uniform uint frame;
layout(location = 1) uniform uint probe_count;

shared uint sums[256], first; // sums: of the threads up to and with each

void main()
{
    const uint thread = gl_LocalInvocationID.x, probe = gl_GlobalInvocationID.x;
    const bool is_seen = probe < probe_count && marks[probe] == frame;
    sums[thread] = is_seen ? 1u : 0u;
    barrier();
    for (uint reach = 1u; reach < 256u; reach *= 2u) {
        const uint before = thread >= reach ? sums[thread - reach] : 0u;
        barrier();
        sums[thread] += before;
        barrier();
    }
    if (thread == 0u && sums[255] > 0u) {
        first = atomicAdd(work[CARD_LISTED], sums[255]);
        const uint groups = (first + sums[255] + 63u) / 64u;
        atomicMax(work[CARD_GROUPS], groups);
        atomicMax(work[CARD_BY_REGIONS], groups);
    }
    barrier();
    if (is_seen)
        list[first + sums[thread] - 1u] = probe;
}
