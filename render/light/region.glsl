// A region or a sun in the light passes (light.h: struct tl_region_light).
struct Region {
    vec4 map_rows[3]; // world point -> map u, map v, depth (of depth maps: less the bias)
    vec4 direction;   // towards the light, as its map sees it, world; 1 where it is jittered, 0 for the region's own
    vec4 centre;      // world; sine of the half-angle over which its light is spread
    vec4 power;       // RGB; spread, rad
};
layout(std430, binding = 0) readonly buffer Regions
{
    Region regions[];
};
