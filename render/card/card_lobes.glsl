// The exact light of the environment through lobes, and the gain of the regions over it: octahedral maps of render/env
// in two atlases, at the same places.
layout(binding = 4) uniform sampler2D lobe_atlas;
layout(binding = 5) uniform sampler2D gain_atlas;
layout(std140, binding = 1) uniform Blends
{
    vec4 blends[321]; // by number: index and weight, two a vector
};
#define DIFFUSE_GAIN 32 // the map of diffuse light's gains

vec3 fetch_map(sampler2D atlas, int map, vec2 place)
{
    vec4 m = lobe_maps[map];
    vec2 at = m.xy + vec2(lobe_texel(place.x, m.z), lobe_texel(place.y, m.z)) + 0.5;
    return textureLod(atlas, at / vec2(textureSize(atlas, 0)), 0.0).rgb;
}

vec3 fetch_lobe(sampler2D atlas, vec3 d, float log_exponent)
{
    int at = lobe_blend_number(log_exponent);
    vec2 place = octahedral_place(d), blend = (at & 1) != 0 ? blends[at >> 1].zw : blends[at >> 1].xy;
    vec3 low = fetch_map(atlas, int(blend.x), place);
    return blend.y > 0.0 ? mix(low, fetch_map(atlas, int(blend.x) + 1, place), blend.y) : low;
}

vec3 exact_diffuse(vec3 d)
{
    return fetch_map(lobe_atlas, 0, octahedral_place(d));
}
