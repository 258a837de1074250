// A sample of the G-buffer as the light passes see it.
#include "lobes_terms.glsl"

layout(location = 1) uniform vec3 eye;
layout(location = 2) uniform vec2 environment_turn; // cosine and sine of the environment's yaw

layout(binding = 0) uniform sampler2D points;
layout(binding = 1) uniform sampler2D normals;
layout(binding = 2) uniform sampler2D diffuses;
layout(binding = 3) uniform sampler2D speculars;

struct Sample {
    vec3 point;
    float cover;
    vec3 normal;
    float glossiness;
    vec3 smooth_normal; // without maps: the horizon's
    vec3 mirror;        // r: the view vector reflected
    vec3 kd, ks;
};

vec3 into_environment(vec3 d)
{
    return turned_direction(environment_turn.x, environment_turn.y, d);
}

// The octahedron of gbuffer.frag, folded.
vec3 from_octahedral(vec2 p)
{
    vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    vec2 away = vec2(d.x >= 0.0 ? 1.0 : -1.0, d.y >= 0.0 ? 1.0 : -1.0);
    d.xy = d.z >= 0.0 ? d.xy : (1.0 - abs(d.yx)) * away;
    return normalize(d);
}

Sample read_sample(ivec2 texel)
{
    vec4 point = texelFetch(points, texel, 0);
    vec4 normal = texelFetch(normals, texel, 0);
    vec4 diffuse = texelFetch(diffuses, texel, 0);
    vec4 specular = texelFetch(speculars, texel, 0);
    vec3 to_eye = eye - point.xyz;
    vec3 v = to_eye * inversesqrt(max(dot(to_eye, to_eye), 1e-30));
    return Sample(point.xyz, point.w, normal.xyz, 1.0 - normal.w, from_octahedral(vec2(diffuse.a, specular.a)),
                  mirrored_viewer(normal.xyz, v), diffuse.rgb,
                  specular.rgb);
}
