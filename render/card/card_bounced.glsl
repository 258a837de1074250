// Bounced light of a probe through a lobe (render/bounce/bounced.h).
#include "bounced_terms.glsl"
layout(std430, binding = CARD_BOUNCED) restrict readonly buffer Bounced
{
    vec4 bounced[];
};

vec3 bounced_through(uint probe, vec3 normal, vec3 d, float exponent)
{
    float basis[BOUNCED_TERMS];
    BouncedShares shares = bounced_lobe(normal, d, exponent, basis);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < BOUNCED_TERMS; i++)
        sum += bounced[17u * probe + 1u + uint(i)].rgb * basis[i];
    return max(sum, 0.0) * (shares.above / shares.even);
}
