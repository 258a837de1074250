#version 450 core
// One additive pass over some of the regions [002, eq. 5]: c += VIS_i PEM_i.
#include "ground.glsl"
#include "vsm.glsl"

const int PASS_REGIONS_MAX = 64;
const int LOBE_SINGLE = 0;

struct Region {
    vec4 map_rows[3]; // world point -> map u, map v, depth
    vec4 direction;   // towards the light, world
};
layout(std140, binding = 0) uniform Regions
{
    Region regions[PASS_REGIONS_MAX];
};

layout(location = 0) uniform int region_count;
layout(location = 1) uniform vec3 eye;
layout(location = 2) uniform vec2 environment_turn; // cosine and sine of the environment's yaw
layout(location = 3) uniform float pem_scale;       // what the stored radiance is multiplied by
layout(location = 4) uniform int lobe;
layout(location = 5) uniform bool shadowed;
layout(location = 6) uniform vec3 map_limits; // bias, variance floor (both in depth units), bleed reduction
layout(location = 7) uniform vec4 ground_disc;

layout(binding = 0) uniform sampler2D points;
layout(binding = 1) uniform sampler2D normals;
layout(binding = 2) uniform sampler2D diffuses;
layout(binding = 3) uniform sampler2D speculars;
layout(binding = 5) uniform sampler2D lobe_levels;
layout(binding = 6) uniform samplerCubeArray pems;
layout(binding = 7) uniform sampler2DArray maps;

layout(location = 0) out vec4 light;

// World direction -> direction in the environment, which is turned by its yaw about +Y.
vec3 into_environment(vec3 d)
{
    return vec3(environment_turn.x * d.x - environment_turn.y * d.z, d.y,
                environment_turn.y * d.x + environment_turn.x * d.z);
}

float lobe_level(float glossiness)
{
    float steps = float(textureSize(lobe_levels, 0).x);
    return texture(lobe_levels, vec2((glossiness * (steps - 1.0) + 0.5) / steps, 0.5)).r;
}

float visibility(int i, vec3 point)
{
    vec4 p = vec4(point, 1.0);
    vec2 place = vec2(dot(regions[i].map_rows[0], p), dot(regions[i].map_rows[1], p));
    float depth = dot(regions[i].map_rows[2], p) - map_limits.x;
    vec2 moments = textureLod(maps, vec3(place, float(i)), 0.0).xy;
    bool inside = all(greaterThan(place, vec2(0.0))) && all(lessThan(place, vec2(1.0)));
    float vis = inside ? vsm_visibility(moments, depth, map_limits.y, map_limits.z) : 1.0;
    return vis * ground_visibility(ground_disc, point, regions[i].direction.xyz);
}

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 point = texelFetch(points, texel, 0);
    vec4 normal = texelFetch(normals, texel, 0);
    vec3 kd = texelFetch(diffuses, texel, 0).rgb;
    vec3 ks = texelFetch(speculars, texel, 0).rgb;
    vec3 to_eye = eye - point.xyz;
    vec3 v = to_eye * inversesqrt(max(dot(to_eye, to_eye), 1e-30));
    // Where an interpolated normal turns away from the viewer, r passes straight on instead of flipping.
    vec3 r = 2.0 * max(dot(normal.xyz, v), 0.0) * normal.xyz - v;
    float g = normal.w;

    vec3 sum = vec3(0.0);
    if (lobe == LOBE_SINGLE) {
        // One look-up for direction and glossiness [002, section 3.4]; its direction and its colour go from
        // diffuse (n, kd) at g = 0 to mirror (r, F ks) at g = 1. n.r >= 0, so the mean never vanishes.
        vec3 d = into_environment(mix(normal.xyz, r, g));
        float level = lobe_level(g);
        for (int i = 0; i < region_count; i++) {
            vec3 pem = textureLod(pems, vec4(d, float(i)), level).rgb;
            sum += (shadowed ? visibility(i, point.xyz) : 1.0) * pem;
        }
        sum *= mix(kd, ks, g);
    } else {
        vec3 d = into_environment(normal.xyz), m = into_environment(r);
        float diffuse_level = lobe_level(0.0), gloss_level = lobe_level(g);
        for (int i = 0; i < region_count; i++) {
            vec3 pem = kd * textureLod(pems, vec4(d, float(i)), diffuse_level).rgb +
                       ks * textureLod(pems, vec4(m, float(i)), gloss_level).rgb;
            sum += (shadowed ? visibility(i, point.xyz) : 1.0) * pem;
        }
    }
    light = vec4(sum * pem_scale * point.w, 0.0);
}
