#version 450 core
// Keeps what probes send for the next frame, with what comes through from their other side: those without light of their
// own the mean of three.
#include "card_frame.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = CARD_FROM) restrict readonly buffer From
{
    uint from[];
};
layout(std430, binding = CARD_SHARES) restrict readonly buffer Shares
{
    vec4 shares[];
};
layout(std430, binding = CARD_SENT_NOW) restrict readonly buffer SentNow
{
    vec4 sent_now[];
};
layout(std430, binding = CARD_SENT) restrict writeonly buffer Sent
{
    vec4 sent[];
};

layout(std430, binding = CARD_PROBES) restrict readonly buffer Probes
{
    uvec2 probes[];
};
layout(std430, binding = CARD_VERTEX_PARTS) restrict readonly buffer VertexParts
{
    uint vertex_parts[];
};
layout(std430, binding = CARD_ALBEDOS) restrict readonly buffer Albedos
{
    vec4 albedos[];
};

vec4 sent_by(uint probe)
{
    vec4 other = sent_now[uint(counts.z) + (from[4u * probe + 3u] >> 1)];
    return sent_now[probe] + vec4(albedos[5u * vertex_parts[probes[probe].x & 0x7fffffffu] + 4u].rgb * other.rgb * other.w, 0.0);
}

void main()
{
    uint probe = gl_GlobalInvocationID.x;
    if (probe >= uint(counts.z))
        return;
    if ((from[4u * probe + 3u] & 1u) != 0u) {
        sent[probe] = sent_by(probe);
        return;
    }
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < 3u; k++) {
        vec4 other = sent_by(from[4u * probe + k]);
        sum += shares[probe][k] * other.w * vec4(other.rgb, 1.0);
    }
    sent[probe] = sum.w > 0.0 ? vec4(sum.rgb / sum.w, 1.0) : vec4(0.0);
}
