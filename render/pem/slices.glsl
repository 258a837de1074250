// P_i(d, s) of the slices of regions (pem/slices.h), from the texture of pem/slice_maps.c.
const int SLICE_EXPONENTS = 32; // TL_EXPONENT_COUNT + 1

struct SliceFrame {
    vec4 right, up, direction; // environment's frame; fourth: unused
    float scale[SLICE_EXPONENTS];
};
layout(std430, binding = 1) readonly buffer SliceFrames
{
    vec4 slice_places[SLICE_EXPONENTS]; // first column, first row and side (texels); radiance of a stored 1
    SliceFrame slice_frames[];          // by region
};
layout(binding = 10) uniform sampler2DArray slice_maps;

vec3 slice_map(int region, int exponent, vec2 p)
{
    vec4 place = slice_places[exponent];
    vec2 texel = (0.5 + p * slice_frames[region].scale[exponent]) * place.z;
    texel = place.xy + clamp(texel, 0.5, place.z - 0.5); // the outermost texels are black
    vec2 size = vec2(textureSize(slice_maps, 0).xy);
    return place.w * textureLod(slice_maps, vec3(texel / size, float(region)), 0.0).rgb;
}

// P_region(d, s) for a unit d in the environment's frame. `level` is the fractional index of the exponent: index +
// weight of tl_exponent_blend(s). The maps of the exponents on both sides must exist, or the one at an integer level.
vec3 slice_fetch(int region, vec3 d, float level)
{
    SliceFrame frame = slice_frames[region];
    float above = 1.0 + dot(d, frame.direction.xyz);
    vec2 p = vec2(2.0, 0.0); // the antipode
    if (above > 1e-6)
        p = vec2(dot(d, frame.right.xyz), dot(d, frame.up.xyz)) * sqrt(2.0 / above);
    int exponent = clamp(int(level), 0, SLICE_EXPONENTS - 1);
    float part = level - float(exponent);
    vec3 light = slice_map(region, exponent, p);
    return part > 0.0 ? mix(light, slice_map(region, exponent + 1, p), part) : light;
}
