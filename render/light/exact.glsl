// The whole environment through exact cosine lobes (env/lobes.h), one octahedral map an exponent, stacked in a texture.
#include "exponents.glsl"
#include "lobes_terms.glsl"

layout(location = 8) uniform int last_exponent;
layout(location = 9) uniform vec2 lobe_places[48]; // by exponent: first row, texels a side without the border

layout(binding = 8) uniform sampler2D lobes;

vec3 lobe_map(int exponent, vec2 place)
{
    vec2 where = lobe_places[exponent];
    vec2 texel = place * where.y + vec2(1.0, 1.0 + where.x);
    return textureLod(lobes, texel / vec2(textureSize(lobes, 0)), 0.0).rgb;
}

// E(d, s); d in the environment's frame.
vec3 exact_light(vec3 d, float level)
{
    int exponent = clamp(int(level), 0, last_exponent - 1);
    vec2 place = octahedral_place(d);
    return mix(lobe_map(exponent, place), lobe_map(exponent + 1, place), clamp(level - float(exponent), 0.0, 1.0));
}
