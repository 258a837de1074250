#version 450 core
// What the light passes need of the nearest surface: point, shading normal, and the two colours of its material.
#include "surface.glsl"
#include "ground.glsl"

layout(location = 17) uniform vec3 eye;
layout(location = 18) uniform vec4 fading_disc; // centre and radius of the ground, while the ground is drawn

in vec3 point;
in vec3 normal;
in vec4 tangent;
in vec2 uv;

layout(location = 0) out vec4 out_point;    // world, metres; coverage
layout(location = 1) out vec4 out_normal;   // world, unit, towards the viewer's side; 1 - glossiness
layout(location = 2) out vec4 out_diffuse;  // kd with occlusion; octahedral x of the smooth normal
layout(location = 3) out vec4 out_specular; // F ks, or F0 of facets where FRAMES; octahedral y of the smooth normal
layout(location = 4) out uint out_triangle; // 1 + its number, and TRIANGLE_BACK
#ifdef FRAMES
layout(location = 5) out vec4 out_tangent; // world, along u, not yet at right angles to the normal; handedness
#endif
#ifdef BEHIND
layout(binding = 15) uniform sampler2D passed; // depth of what is nearer than what is wanted

const float DEPTH_ROUNDING = 1.2e-7;
#endif

const uint TRIANGLE_BACK = 0x80000000u;

// A direction that is never NaN: vectors too short to have one become `fallback`.
vec3 direction_or(vec3 v, vec3 fallback)
{
    float square = dot(v, v);
    return square > 1e-30 ? v * inversesqrt(square) : fallback;
}

vec3 decode(vec3 texel)
{
    return 2.0 * texel - 1.0;
}

// Tangent-space normal: the file's map and the weave, their slopes added as the heights behind them would be.
vec3 tangent_space_normal()
{
    vec3 n = vec3(0.0, 0.0, 1.0);
    if (has_map(MAP_NORMAL)) {
        n = decode(texture(normal_map, map_uv(MAP_NORMAL, uv)).xyz);
        n.xy *= material_scalars.y;
    }
    if (has_map(MAP_WEAVE)) {
        vec3 weave = decode(texture(weave_normal, uv * weave_scale).xyz);
        n = vec3(n.xy * weave.z + weave.xy * n.z, n.z * weave.z);
    }
    return n;
}

// MikkTSpace: the interpolated frame is used as it is, and normalised once at the end.
vec3 shading_normal(vec3 smooth_normal)
{
    vec3 n = smooth_normal;
    if ((has_map(MAP_NORMAL) || has_map(MAP_WEAVE)) && dot(tangent.xyz, tangent.xyz) > 0.0) {
        vec3 mapped = tangent_space_normal();
        vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
        n = direction_or(mapped.x * tangent.xyz + mapped.y * bitangent + mapped.z * normal, smooth_normal);
    }
    return n;
}

// A unit vector on the octahedron, unfolded into [-1, 1]^2 [Meyer et al. 2010].
vec2 octahedral(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 away = vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * away;
}

float glossiness()
{
    float g = material_scalars.x;
    if (has_map(MAP_GLOSS))
        g *= texture(gloss_map, map_uv(MAP_GLOSS, uv)).r;
    if (has_map(MAP_WEAVE))
        g += texture(weave_gloss, uv * weave_scale).r;
    return clamp(g, 0.0, 1.0);
}

vec3 diffuse(vec3 colour)
{
    if (has_map(MAP_WEAVE))
        colour *= texture(weave_tint, uv * weave_scale).rgb;
    if (has_map(MAP_OCCLUSION))
        colour *= mix(1.0, texture(occlusion_map, map_uv(MAP_OCCLUSION, uv)).r, material_scalars.z);
    return colour;
}

// Schlick's Fresnel term. At grazing angles it goes to one, but for a reflectance below 2 %, which no
// dielectric has and which therefore means "matt", in proportion to zero.
vec3 specular(float n_dot_v)
{
    vec3 f0 = material_specular;
    if (has_map(MAP_SPECULAR))
        f0 *= texture(specular_map, map_uv(MAP_SPECULAR, uv)).rgb;
    vec3 f90 = min(50.0 * f0, 1.0);
    return f0 + (f90 - f0) * pow(1.0 - clamp(n_dot_v, 0.0, 1.0), 5.0);
}

void main()
{
#ifdef BEHIND
    if (gl_FragCoord.z <= texelFetch(passed, ivec2(gl_FragCoord.xy), 0).r + DEPTH_ROUNDING)
        discard;
#endif
    vec3 facet = direction_or(cross(dFdx(point), dFdy(point)), vec3(0.0, 1.0, 0.0));
    vec4 colour = surface_colour(uv);
    if (material_scalars.w > 0.0 && surface_cut_away(colour.a))
        discard;
    float cover = fading_disc.w > 0.0 ? ground_cover(fading_disc, point.xz) : 1.0;
    if (cover <= 0.0)
        discard;
    float side = gl_FrontFacing ? 1.0 : -1.0; // a back is a surface of its own: the whole frame turns over
    vec3 smooth_normal = direction_or(normal, facet);
    vec3 n = side * shading_normal(smooth_normal);
    vec2 horizon = octahedral(side * smooth_normal);
    vec3 v = direction_or(eye - point, n);
    out_point = vec4(point, cover);
    out_normal = vec4(n, 1.0 - glossiness());
    out_diffuse = vec4(diffuse(colour.rgb), horizon.x);
    float facing = dot(n, v);
#ifdef FRAMES
    if ((map_flags & FLAG_FACETED) != 0)
        facing = 1.0; // a facet's Fresnel term is not the normal's
    out_tangent = vec4(direction_or(tangent.xyz, vec3(0.0)), tangent.w * side);
#endif
    out_specular = vec4(specular(facing), horizon.y);
    out_triangle = (first_triangle + uint(gl_PrimitiveID) + 1u) | (gl_FrontFacing ? 0u : TRIANGLE_BACK);
}
