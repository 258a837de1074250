// The whole environment through exact cosine lobes (env/lobes.h), one octahedral map an exponent, stacked in a texture.
#include "exponents.glsl"

layout(location = 8) uniform int last_exponent;
layout(location = 9) uniform vec2 lobe_places[48]; // by exponent: first row, texels a side without the border

layout(binding = 8) uniform sampler2D lobes;

// Unfolded about +Y, as env/lobes.c does.
vec2 unfolded(vec3 d)
{
    vec3 p = d / (abs(d.x) + abs(d.y) + abs(d.z));
    vec2 away = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.z >= 0.0 ? 1.0 : -1.0);
    return p.y >= 0.0 ? p.xz : (1.0 - abs(p.zx)) * away;
}

vec3 lobe_map(int exponent, vec2 place)
{
    vec2 where = lobe_places[exponent];
    vec2 texel = (0.5 * place + 0.5) * where.y + vec2(1.0, 1.0 + where.x);
    return textureLod(lobes, texel / vec2(textureSize(lobes, 0)), 0.0).rgb;
}

// E(d, s); d in the environment's frame.
vec3 exact_light(vec3 d, float level)
{
    int exponent = clamp(int(level), 0, last_exponent - 1);
    vec2 place = unfolded(d);
    return mix(lobe_map(exponent, place), lobe_map(exponent + 1, place), clamp(level - float(exponent), 0.0, 1.0));
}
