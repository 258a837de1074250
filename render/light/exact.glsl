// The whole environment through exact cosine lobes (env/lobes.h), one octahedral map an exponent, stacked in a texture.
layout(location = 8) uniform int last_exponent;
layout(location = 9) uniform vec2 lobe_places[48]; // by exponent: first row, texels a side without the border

layout(binding = 5) uniform sampler2D exponent_levels; // fractional number of the exponent by log2(s) / LOG_RANGE
layout(binding = 8) uniform sampler2D lobes;

const float EXPONENT_LOG_RANGE = 15.0; // of light.c

float exponent_level(float s)
{
    float steps = float(textureSize(exponent_levels, 0).x);
    float place = clamp(log2(s) / EXPONENT_LOG_RANGE, 0.0, 1.0);
    return texture(exponent_levels, vec2((place * (steps - 1.0) + 0.5) / steps, 0.5)).r;
}

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
