// P_i(d, level) of PEMs that are cropped parts of paraboloid maps (pem/paraboloids.h), those of a pass in one texture.
const int PARABOLOID_LEVELS = 10, PARABOLOID_CHARTS = 6; // TL_PARABOLOID_LEVELS_MAX, TL_PARABOLOID_CHARTS

// One level of a region, by chart.
struct Paraboloid {
    vec4 bounds[PARABOLOID_CHARTS]; // centres of the first and of the last texel of its part of the texture
    vec2 shifts[PARABOLOID_CHARTS]; // texel of the texture at p = 0
};
layout(std430, binding = 2) readonly buffer Paraboloids
{
    Paraboloid paraboloids[]; // by region and level
};
layout(location = 8) uniform ivec2 paraboloid_density; // texels a unit of p at level 0; number of levels
layout(binding = 11) uniform sampler2D paraboloid_maps;

// The place of a direction, the same in all regions.
struct ParaboloidPoint {
    vec2 p;
    int chart;
};

// d is unit, in the environment's frame.
ParaboloidPoint paraboloid_project(vec3 d)
{
    vec3 size = abs(d);
    if (size.x >= size.y && size.x >= size.z)
        return ParaboloidPoint(d.yz / (1.0 + size.x), d.x >= 0.0 ? 0 : 1);
    if (size.y >= size.z)
        return ParaboloidPoint(d.xz / (1.0 + size.y), d.y >= 0.0 ? 2 : 3);
    return ParaboloidPoint(d.xy / (1.0 + size.z), d.z >= 0.0 ? 4 : 5);
}

// Black outside of the crop.
vec3 paraboloid_level(int region, int level, ParaboloidPoint at)
{
    int map = region * PARABOLOID_LEVELS + level;
    vec4 bounds = paraboloids[map].bounds[at.chart];
    vec2 texel = at.p * float(paraboloid_density.x >> level) + paraboloids[map].shifts[at.chart];
    if (any(lessThan(texel, bounds.xy)) || any(greaterThan(texel, bounds.zw)))
        return vec3(0.0);
    return textureLod(paraboloid_maps, texel / vec2(textureSize(paraboloid_maps, 0)), 0.0).rgb;
}

vec3 paraboloid_fetch(int region, ParaboloidPoint at, float level)
{
    int below = clamp(int(level), 0, paraboloid_density.y - 1), above = min(below + 1, paraboloid_density.y - 1);
    return mix(paraboloid_level(region, below, at), paraboloid_level(region, above, at), level - float(below));
}
