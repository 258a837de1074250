// P_i(d, level) of PEMs whose fine levels are cropped paraboloid maps (pem/paraboloids.h) in one texture a pass, and whose
// coarse levels are cube maps (pem/pems.c).
const int PARABOLOID_LEVELS = 7; // TL_PARABOLOID_LEVELS_MAX

struct Paraboloid {
    vec4 right, up, direction;      // environment's frame; fourth: unused
    vec4 places[PARABOLOID_LEVELS]; // texel of the texture at p = 0, texels a unit of p; fourth: unused
    vec4 bounds[PARABOLOID_LEVELS]; // centres of the first and of the last texel
};
layout(std430, binding = 2) readonly buffer Paraboloids
{
    Paraboloid paraboloids[]; // by region
};
layout(location = 8) uniform int cube_level; // the level that is the first one of the cubes
layout(binding = 11) uniform sampler2D paraboloid_maps;

// Black outside of the crop, whose outermost texels are black.
vec3 paraboloid_level(int region, int level, vec2 p)
{
    vec4 place = paraboloids[region].places[level], bounds = paraboloids[region].bounds[level];
    vec2 texel = p * place.z + place.xy;
    if (any(lessThan(texel, bounds.xy)) || any(greaterThan(texel, bounds.zw)))
        return vec3(0.0);
    return textureLod(paraboloid_maps, texel / vec2(textureSize(paraboloid_maps, 0)), 0.0).rgb;
}

// `layer` is the region's cube in `cubes`; d is unit, in the environment's frame.
vec3 paraboloid_fetch(samplerCubeArray cubes, int region, int layer, vec3 d, float level)
{
    int below = int(level);
    float part = level - float(below);
    if (below >= cube_level)
        return textureLod(cubes, vec4(d, float(layer)), level - float(cube_level)).rgb;
    vec2 across = vec2(dot(d, paraboloids[region].right.xyz), dot(d, paraboloids[region].up.xyz));
    vec2 p = across / max(1.0 + dot(d, paraboloids[region].direction.xyz), 1e-6);
    vec3 light = paraboloid_level(region, below, p);
    if (part > 0.0)
        light = mix(light,
                    below + 1 < cube_level ? paraboloid_level(region, below + 1, p)
                                           : textureLod(cubes, vec4(d, float(layer)), 0.0).rgb,
                    part);
    return light;
}
