// The values of a material's maps at a point: shared by every pass that shades a surface while it draws it. The normal
// and the tangent are those that rasterisation interpolated, as long as they come out.
#include "detail.glsl"
#include "construction.glsl"
#include "vectors.glsl"

// A pass that draws something else than what is seen states which side it draws.
#ifndef SEES_FRONT
#define SEES_FRONT gl_FrontFacing
#endif

vec3 decode(vec3 texel)
{
    return 2.0 * texel - 1.0;
}

// Factors on a weave's slopes along u and v where cloth is stretched (detail_slope_factors); set before bumps_at by who
// has derivatives.
vec2 weave_slopes = vec2(1.0);

// Moments of the normal map, or where there is none of the height map's slopes.
vec2 own_moments(vec2 uv, float layer)
{
    return has_map(MAP_NORMAL) ? map_layer(detail_own_moments, MAP_NORMAL, uv, layer)
                               : detail_layer(detail_own_moments, uv, layer);
}

Bumps own_bumps(vec2 uv)
{
    if (has_detail(DETAIL_OWN_MOMENTS)) {
        vec2 scale = vec2(has_map(MAP_NORMAL) ? material_scalars.y : 1.0);
        float product = DETAIL_MINIFY == DETAIL_LEAN ? own_moments(uv, 2.0).x : 0.0;
        return detail_bumps(own_moments(uv, 0.0), own_moments(uv, 1.0), product, scale);
    }
    vec3 n = vec3(0.0, 0.0, 1.0);
    if (has_map(MAP_NORMAL)) {
        n = decode(map_texel(normal_map, MAP_NORMAL, uv).xyz);
        n.xy *= material_scalars.y;
    }
    return Bumps(n, vec3(0.0), 1.0);
}

Bumps weave_bumps(vec2 uv)
{
    vec2 scale = detail_range.w * weave_slopes; // of slopes
    if (has_detail(DETAIL_WEAVE_MOMENTS)) {
        float product = DETAIL_MINIFY == DETAIL_LEAN ? weave_layer(detail_weave_moments, uv, 2.0).x : 0.0;
        return detail_bumps(weave_layer(detail_weave_moments, uv, 0.0), weave_layer(detail_weave_moments, uv, 1.0),
                            product, scale);
    }
    vec3 n = decode(weave_texel(weave_normal, uv).xyz);
    return Bumps(vec3(scale * n.xy, n.z), vec3(0.0), 1.0);
}

// Slopes add as those of summed heights do.
Bumps bumps_sum(Bumps a, Bumps b)
{
    return Bumps(vec3(a.normal.xy * b.normal.z + b.normal.xy * a.normal.z, a.normal.z * b.normal.z), a.spread + b.spread,
                 a.mean_length * b.mean_length);
}

// In tangent space: the file's map, the weave and what is sewn (sew, called before).
Bumps bumps_at(vec2 uv)
{
    Bumps bumps = own_bumps(uv);
    if (has_map(MAP_WEAVE))
        bumps = bumps_sum(bumps, weave_bumps(uv));
    if (has_map(MAP_SEWN))
        bumps = bumps_sum(bumps, sewn_bumps());
    return bumps;
}

vec3 tangent_space_normal(vec2 uv)
{
    return bumps_at(uv).normal;
}

bool has_bumps(vec4 tangent)
{
    bool has_normals =
        has_map(MAP_NORMAL) || has_map(MAP_WEAVE) || has_map(MAP_SEWN) || has_detail(DETAIL_OWN_MOMENTS);
    return has_normals && dot(tangent.xyz, tangent.xyz) > 0.0;
}

// MikkTSpace: the interpolated frame is used as it is, and normalised once at the end.
vec3 bent_normal(vec3 mapped, vec3 normal, vec4 tangent, vec3 smooth_normal)
{
    vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
    return direction_or(mapped.x * tangent.xyz + mapped.y * bitangent + mapped.z * normal, smooth_normal);
}

vec3 facing_normal(vec3 n, vec3 v)
{
    float lift = detail_facing(dot(n, v));
    return lift > 0.0 ? direction_or(n + lift * v, n) : n;
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

bool shows_back()
{
    return has_map(MAP_BACK) && !SEES_FRONT;
}

#ifndef VERTEX_STAGE
layout(std430, binding = 8) readonly buffer YarnSums
{
    float yarn_sums[];
};

float yarn_sum(float entry)
{
    return yarn_sums[int(entry)];
}

#include "yarn_terms.glsl"

// The factor of yarns that differ from one another along all of the cloth.
float yarns_here(vec2 uv)
{
    if (!has_map(MAP_YARNS))
        return 1.0;
#ifdef DETAIL_SHIFTED
    vec2 across = unmoved_across, down = unmoved_down;
#else
    vec2 across = dFdx(uv), down = dFdy(uv);
#endif
    vec2 wide = yarn_rows.xy * sqrt(across * across + down * down), at = yarn_rows.xy * uv;
    return yarn_factor(yarn_rows.z, yarn_rows.w, at.x, at.y, wide.x, wide.y);
}
#else
float yarns_here(vec2 uv)
{
    return 1.0;
}
#endif

vec3 diffuse(vec3 colour, vec2 uv)
{
    if (has_map(MAP_WEAVE))
        colour *= weave_texel(weave_tint, uv).rgb;
    colour *= yarns_here(uv);
    if (shows_back())
        colour = back_diffuse;
    if (has_map(MAP_OCCLUSION))
        colour *= mix(1.0, map_texel(occlusion_map, MAP_OCCLUSION, uv).r, material_scalars.z);
    return sewn_diffuse(colour);
}

// Reflectance at normal incidence.
vec3 specular_f0(vec2 uv)
{
    vec3 f0 = material_specular;
    if (has_map(MAP_SPECULAR))
        f0 *= map_texel(specular_map, MAP_SPECULAR, uv).rgb;
    f0 *= yarns_here(uv);
    if (shows_back())
        f0 = back_specular;
    return sewn_specular(f0);
}

// Schlick's Fresnel term. At grazing angles it goes to one, but for a reflectance below 2 %, which no
// dielectric has and which therefore means "matt", in proportion to zero.
vec3 schlick(vec3 f0, float cosine)
{
    vec3 f90 = min(50.0 * f0, 1.0);
    return f0 + (f90 - f0) * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0);
}
