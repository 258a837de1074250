#version 450 core
// Means with neighbours of what bounces to the listed probes: seventeen threads a probe
// (render/bounce/bounce_smooth.c).
#include "card_frame.glsl"
layout(local_size_x = 17, local_size_y = 4) in;
layout(std430, binding = CARD_FROM) restrict readonly buffer From
{
    uint from[];
};
layout(std430, binding = CARD_SHARES) restrict readonly buffer Shares
{
    vec4 shares[];
};
layout(std430, binding = CARD_FOUND) restrict readonly buffer Found
{
    vec4 found[];
};
layout(std430, binding = CARD_LISTED) restrict readonly buffer Listed
{
    uint listed;
};
layout(std430, binding = CARD_LIST) restrict readonly buffer List
{
    uint list[];
};
layout(std430, binding = CARD_RINGS) restrict readonly buffer Rings
{
    uint rings[];
};
layout(std430, binding = CARD_BOUNCED) restrict writeonly buffer Bounced
{
    vec4 bounced[];
};

vec4 mean_of(uint probe, uint term)
{
    float known = found[17u * probe].w;
    vec4 sum = known * found[17u * probe + term];
    for (uint i = rings[probe]; i < rings[probe + 1u]; i++) {
        float is_known = found[17u * rings[i]].w;
        sum += is_known * found[17u * rings[i] + term];
        known += is_known;
    }
    return known > 0.0 ? sum / known : vec4(0.0);
}

void main()
{
    uint at = gl_WorkGroupID.x * 4u + gl_LocalInvocationID.y, term = gl_LocalInvocationID.x;
    if (at >= listed)
        return;
    uint probe = list[at];
    vec4 sum = vec4(0.0);
    if ((from[4u * probe + 3u] & 1u) != 0u)
        sum = mean_of(probe, term);
    else
        for (uint k = 0u; k < 3u; k++)
            sum += shares[probe][k] * mean_of(from[4u * probe + k], term);
    bounced[17u * probe + term] = sum;
}
