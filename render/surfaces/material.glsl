// What a material's maps say at a point: shared by every pass that shades a surface while it draws it. The normal and
// the tangent are those that rasterisation interpolated, as long as they come out.
#include "detail.glsl"
#include "direction.glsl"

vec3 decode(vec3 texel)
{
    return 2.0 * texel - 1.0;
}

// A weave's or height map's slopes, made steeper with its heights.
vec3 steepened(vec3 n)
{
    return vec3(n.xy * detail_range.w, n.z);
}

Bumps own_bumps(vec2 uv)
{
    if (has_detail(DETAIL_OWN_MOMENTS)) // of the normal map, or where there is none of the height map's slopes
        return has_map(MAP_NORMAL) ? detail_bumps(map_texel(detail_own_moments, MAP_NORMAL, uv), material_scalars.y)
                                   : detail_bumps(detail_texel(detail_own_moments, uv), 1.0);
    vec3 n = vec3(0.0, 0.0, 1.0);
    if (has_map(MAP_NORMAL)) {
        n = decode(map_texel(normal_map, MAP_NORMAL, uv).xyz);
        n.xy *= material_scalars.y;
    }
    return Bumps(n, vec2(0.0), 1.0);
}

Bumps weave_bumps(vec2 uv)
{
    if (has_detail(DETAIL_WEAVE_MOMENTS))
        return detail_bumps(weave_texel(detail_weave_moments, uv), detail_range.w);
    return Bumps(steepened(decode(weave_texel(weave_normal, uv).xyz)), vec2(0.0), 1.0);
}

// In tangent space: the file's map and the weave, their slopes added as the heights behind them would be.
Bumps bumps_at(vec2 uv)
{
    Bumps bumps = own_bumps(uv);
    if (has_map(MAP_WEAVE)) {
        Bumps weave = weave_bumps(uv);
        vec3 n = bumps.normal;
        bumps.normal = vec3(n.xy * weave.normal.z + weave.normal.xy * n.z, n.z * weave.normal.z);
        bumps.spread += weave.spread;
        bumps.length *= weave.length;
    }
    return bumps;
}

bool has_bumps(vec4 tangent)
{
    bool has_normals = has_map(MAP_NORMAL) || has_map(MAP_WEAVE) || has_detail(DETAIL_OWN_MOMENTS);
    return has_normals && dot(tangent.xyz, tangent.xyz) > 0.0;
}

// MikkTSpace: the interpolated frame is used as it is, and normalised once at the end.
vec3 bent_normal(vec3 mapped, vec3 normal, vec4 tangent, vec3 smooth_normal)
{
    vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
    return direction_or(mapped.x * tangent.xyz + mapped.y * bitangent + mapped.z * normal, smooth_normal);
}

vec3 shading_normal(vec3 normal, vec4 tangent, vec2 uv, vec3 smooth_normal)
{
    return has_bumps(tangent) ? bent_normal(bumps_at(uv).normal, normal, tangent, smooth_normal) : smooth_normal;
}

float glossiness(vec2 uv)
{
    float g = material_scalars.x;
    if (has_map(MAP_GLOSS))
        g *= map_texel(gloss_map, MAP_GLOSS, uv).r;
    if (has_map(MAP_WEAVE))
        g += weave_texel(weave_gloss, uv).r;
    return clamp(g, 0.0, 1.0);
}

vec3 diffuse(vec3 colour, vec2 uv)
{
    if (has_map(MAP_WEAVE))
        colour *= weave_texel(weave_tint, uv).rgb;
    if (has_map(MAP_OCCLUSION))
        colour *= mix(1.0, map_texel(occlusion_map, MAP_OCCLUSION, uv).r, material_scalars.z);
    return colour;
}

// Reflectance at normal incidence.
vec3 specular_f0(vec2 uv)
{
    vec3 f0 = material_specular;
    if (has_map(MAP_SPECULAR))
        f0 *= map_texel(specular_map, MAP_SPECULAR, uv).rgb;
    return f0;
}

// Schlick's Fresnel term. At grazing angles it goes to one, but for a reflectance below 2 %, which no
// dielectric has and which therefore means "matt", in proportion to zero.
vec3 schlick(vec3 f0, float cosine)
{
    vec3 f90 = min(50.0 * f0, 1.0);
    return f0 + (f90 - f0) * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0);
}
