// What a material's maps say at a point: shared by every pass that shades a surface while it draws it. The normal and
// the tangent are those that rasterisation interpolated, as long as they come out.
#include "surface.glsl"
#include "direction.glsl"

vec3 decode(vec3 texel)
{
    return 2.0 * texel - 1.0;
}

// Tangent-space normal: the file's map and the weave, their slopes added as the heights behind them would be.
vec3 tangent_space_normal(vec2 uv)
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

bool has_bumps(vec4 tangent)
{
    return (has_map(MAP_NORMAL) || has_map(MAP_WEAVE)) && dot(tangent.xyz, tangent.xyz) > 0.0;
}

// MikkTSpace: the interpolated frame is used as it is, and normalised once at the end.
vec3 shading_normal(vec3 normal, vec4 tangent, vec2 uv, vec3 smooth_normal)
{
    vec3 n = smooth_normal;
    if (has_bumps(tangent)) {
        vec3 mapped = tangent_space_normal(uv);
        vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
        n = direction_or(mapped.x * tangent.xyz + mapped.y * bitangent + mapped.z * normal, smooth_normal);
    }
    return n;
}

float glossiness(vec2 uv)
{
    float g = material_scalars.x;
    if (has_map(MAP_GLOSS))
        g *= texture(gloss_map, map_uv(MAP_GLOSS, uv)).r;
    if (has_map(MAP_WEAVE))
        g += texture(weave_gloss, uv * weave_scale).r;
    return clamp(g, 0.0, 1.0);
}

vec3 diffuse(vec3 colour, vec2 uv)
{
    if (has_map(MAP_WEAVE))
        colour *= texture(weave_tint, uv * weave_scale).rgb;
    if (has_map(MAP_OCCLUSION))
        colour *= mix(1.0, texture(occlusion_map, map_uv(MAP_OCCLUSION, uv)).r, material_scalars.z);
    return colour;
}

// Reflectance at normal incidence.
vec3 specular_f0(vec2 uv)
{
    vec3 f0 = material_specular;
    if (has_map(MAP_SPECULAR))
        f0 *= texture(specular_map, map_uv(MAP_SPECULAR, uv)).rgb;
    return f0;
}

// Schlick's Fresnel term. At grazing angles it goes to one, but for a reflectance below 2 %, which no
// dielectric has and which therefore means "matt", in proportion to zero.
vec3 schlick(vec3 f0, float cosine)
{
    vec3 f90 = min(50.0 * f0, 1.0);
    return f0 + (f90 - f0) * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0);
}
