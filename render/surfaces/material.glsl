// The values of a material's maps at a point: shared by every pass that shades a surface while it draws it. The normal
// and the tangent are those that rasterisation interpolated, as long as they come out.
#include "detail.glsl"
#include "construction.glsl"
#include "facets_terms.glsl"
#include "surface_terms.glsl"

// A pass that draws something else than what is seen states which side it draws.
#ifndef SEES_FRONT
#define SEES_FRONT gl_FrontFacing
#endif

// Factors on a weave's slopes along u and v where cloth is stretched (detail_slope_factors); set before bumps_at by who
// has derivatives.
vec2 weave_slopes = vec2(1.0);

#ifdef DETAIL_OFFSETS
#define bumps_of_means bumps_of_offsets
const bool HAS_SPREAD = DETAIL_MINIFY > 0; // else a map has the two offsets only
#else
#define bumps_of_means bumps_of_moments
const bool HAS_SPREAD = true;
#endif

// Moments of the normal map, or where there is none of the height map's slopes.
vec2 own_moments(vec2 uv, float layer)
{
    return has_map(MAP_NORMAL) ? map_layer(detail_own_moments, MAP_NORMAL, uv, layer)
                               : detail_layer(detail_own_moments, uv, layer);
}

Bumps own_bumps(vec2 uv)
{
    if (has_detail(DETAIL_OWN_MOMENTS)) {
        float scale = has_map(MAP_NORMAL) ? material_scalars.y : 1.0;
        vec2 first = own_moments(uv, 0.0), squares = HAS_SPREAD ? own_moments(uv, 1.0) : first * first;
        float product = DETAIL_MINIFY == MINIFY_LEAN ? own_moments(uv, 2.0).x : 0.0;
        return bumps_of_means(first.x, first.y, squares.x, squares.y, product, scale, scale);
    }
    if (has_map(MAP_NORMAL))
        return bumps_of_texel(map_texel(normal_map, MAP_NORMAL, uv).xyz, material_scalars.y, material_scalars.y);
    return bumps_of_normal(vec3(0.0, 0.0, 1.0));
}

Bumps weave_bumps(vec2 uv)
{
    vec2 scale = detail_range.w * weave_slopes; // of slopes
    if (has_detail(DETAIL_WEAVE_MOMENTS)) {
        vec2 first = weave_layer(detail_weave_moments, uv, 0.0),
             squares = HAS_SPREAD ? weave_layer(detail_weave_moments, uv, 1.0) : first * first;
        float product = DETAIL_MINIFY == MINIFY_LEAN ? weave_layer(detail_weave_moments, uv, 2.0).x : 0.0;
        return bumps_of_means(first.x, first.y, squares.x, squares.y, product, scale.x, scale.y);
    }
    return bumps_of_texel(weave_texel(weave_normal, uv).xyz, scale.x, scale.y);
}

// In tangent space: the file's map, the weave and what is sewn (sew, called before).
Bumps bumps_at(vec2 uv)
{
    Bumps bumps = own_bumps(uv);
    if (has_map(MAP_WEAVE))
        bumps = bumps_add(bumps, weave_bumps(uv));
    if (has_map(MAP_SEWN))
        bumps = bumps_add(bumps, bumps_of_slopes(sewn.slope_x, sewn.slope_y,
                                                 vec3(sewn.spread_x, sewn.spread_y, sewn.spread_xy)));
    return bumps;
}

bool has_bumps(vec4 tangent)
{
    bool has_normals =
        has_map(MAP_NORMAL) || has_map(MAP_WEAVE) || has_map(MAP_SEWN) || has_detail(DETAIL_OWN_MOMENTS);
    return has_normals && dot(tangent.xyz, tangent.xyz) > 0.0;
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

// Colours and glossiness with all maps; `colour`: the material's own, with its map.
SurfaceColours colours_at(vec3 colour, vec2 uv)
{
    SurfaceColours cloth = SurfaceColours(colour, material_specular, material_scalars.x);
    SurfaceTexels texels = surface_texels();
    if (has_map(MAP_SPECULAR))
        cloth.f0 *= map_texel(specular_map, MAP_SPECULAR, uv).rgb;
    if (has_map(MAP_GLOSS))
        cloth.glossiness *= map_texel(gloss_map, MAP_GLOSS, uv).r;
    if (has_map(MAP_WEAVE)) {
        texels.tint = weave_texel(weave_tint, uv).rgb;
        texels.gloss = weave_texel(weave_gloss, uv).r;
    }
    texels.yarns = yarns_here(uv);
    if (has_map(MAP_OCCLUSION))
        texels.occlusion = mix(1.0, map_texel(occlusion_map, MAP_OCCLUSION, uv).r, material_scalars.z);
    texels.thread = sewn.thread;
    texels.shade = sewn.shade;
    return surface_colours(cloth, texels, shows_back(), back_diffuse, back_specular, construction_thread);
}
