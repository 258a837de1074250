#version 450 core
// Traces what the listed probes see of the regions: sixty-four neighbours look in one direction at a time, a ray a thread
// (refresh.c: trace_direction, store).
#include "card_points.glsl"
#include "visibility_terms.glsl"
#include "ground.glsl"
#define TREE_BINDING CARD_TREE
#define HOLES_BINDING CARD_HOLES
#include "trace.glsl"
layout(local_size_x = 64, local_size_y = 4) in;
layout(std430, binding = CARD_WORK) restrict readonly buffer Work { uint work[]; };
layout(std430, binding = CARD_ORIGINS) restrict readonly buffer Origins { vec4 origins[]; };
layout(std430, binding = CARD_DIRECTIONS) restrict readonly buffer Directions { vec4 directions[]; };
layout(std430, binding = CARD_VALUES) restrict writeonly buffer Values { uint values[]; };
layout(location = 0) uniform uint region_count;
layout(location = 1) uniform uint ray_count;
layout(location = 2) uniform uint probe_count;
layout(location = 3) uniform vec4 disc; // of the ground: centre, radius; 0: none

shared uint seen[64]; // a byte for each of four regions

// The mean over the rays of a region.
float visibility(vec3 origin, vec3 normal, uint region)
{
    float sum = 0.0, weights = 0.0;
    for (uint ray = 0u; ray < ray_count; ray++) {
        const vec3 direction = directions[ray * region_count + region].xyz;
        const float cosine = dot(normal, direction);
        if (cosine < -TL_SINE_BELOW)
            continue;
        const float weight = visibility_weight(cosine), share = ground_passes(disc, origin, direction);
        const vec3 ahead = cosine < 0.0 ? direction - 2.0 * cosine * normal : direction;
        weights += weight;
        if (share > 0.0)
            sum += weight * share * tree_transmittance(origin, ahead, 0.0, 1e30);
    }
    return weights > 0.0 ? sum / weights : 0.0;
}

void main()
{
    const uint lane = gl_LocalInvocationID.x, at = gl_WorkGroupID.x * 64u + lane;
    const uint byte = gl_LocalInvocationID.y, region = gl_WorkGroupID.y * 4u + byte;
    const bool is_listed = at < work[CARD_LISTED];
    if (byte == 0u)
        seen[lane] = 0u;
    barrier();
    if (is_listed && region < region_count) {
        const float value = visibility(origins[2u * at].xyz, origins[2u * at + 1u].xyz, region);
        atomicOr(seen[lane], uint(value * 255.0 + 0.5) << 8u * byte);
    }
    barrier();
    if (byte == 0u && is_listed)
        values[gl_WorkGroupID.y * probe_count + at] = seen[lane];
}
