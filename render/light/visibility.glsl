// Visibility of a region at a sample, by its shadow map. VSM: variance shadow maps, as in the paper. DEPTH: plain depth
// maps, which cannot separate a surface from itself where light grazes it, so the light is cut by a ramp at the
// horizon. Neither: everything is seen.
#include "ground.glsl"
#include "region.glsl"
#include "terms.glsl"
#include "vsm.glsl"

layout(location = 6) uniform vec3 map_limits; // VSM: bias, variance floor (both in depth units), bleed reduction
layout(location = 7) uniform vec4 ground_disc;

#ifdef VSM
layout(binding = 7) uniform sampler2DArray maps;
#else
layout(binding = 7) uniform sampler2DArrayShadow maps;
#endif

vec3 on_map(Region region, vec3 point)
{
    vec4 p = vec4(point, 1.0);
    return vec3(dot(region.map_rows[0], p), dot(region.map_rows[1], p), dot(region.map_rows[2], p));
}

// Outside of a map its empty margin is read. Behind all casters depth stays that of nothing.
float depth_visibility(sampler2DArrayShadow depths, int layer, Region region, vec3 point, vec3 smooth_normal)
{
    float risen = self_shadow_ramp(dot(smooth_normal, region.direction.xyz));
    if (risen == 0.0)
        return 0.0;
    vec3 place = on_map(region, point);
    risen *= texture(depths, vec4(place.xy, float(layer), min(place.z, 1.0)));
    return risen * ground_passes(ground_disc, point, region.direction.xyz);
}

float visibility(int layer, Region region, vec3 point, vec3 smooth_normal)
{
#if defined(VSM)
    vec3 place = on_map(region, point);
    vec2 moments = textureLod(maps, vec3(place.xy, float(layer)), 0.0).xy;
    bool inside = all(greaterThan(place.xy, vec2(0.0))) && all(lessThan(place.xy, vec2(1.0)));
    float vis = inside ? vsm_visibility(moments, place.z - map_limits.x, map_limits.y, map_limits.z) : 1.0;
    return vis * ground_passes(ground_disc, point, region.direction.xyz);
#elif defined(DEPTH)
    return depth_visibility(maps, layer, region, point, smooth_normal);
#else
    return 1.0;
#endif
}
