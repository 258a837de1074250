// Material of the part being drawn, as tl_surfaces_draw sets it (surfaces.h has the same numbers).
const int MAP_DIFFUSE = 0, MAP_NORMAL = 1, MAP_GLOSS = 2, MAP_SPECULAR = 3, MAP_OCCLUSION = 4, MAP_WEAVE = 5;
const int MAP_SEWN = 6, MAP_BACK = 7, MAP_YARNS = 8; // no maps: borders near by, a back of its own, yarns that differ

layout(location = 0) uniform vec3 material_diffuse;
layout(location = 1) uniform vec3 material_specular;
layout(location = 2) uniform vec4 material_scalars; // glossiness, normal scale, occlusion strength, alpha cutoff
layout(location = 3) uniform int map_flags;
layout(location = 4) uniform vec2 weave_scale; // repeats per UV unit
layout(location = 5) uniform vec3 uv_rows[10];
layout(location = 15) uniform uint first_triangle; // of this draw, counted through all that there are
// Of detail.glsl, whose maps come at bindings 8 to 12.
layout(location = 20) uniform int detail_flags;
layout(location = 21) uniform vec4 detail_range;   // lowest, highest (m), metres of a UV unit, factor on heights
layout(location = 22) uniform vec3 detail_rows[2]; // from UV to repeats of the height field
layout(location = 24) uniform ivec2 detail_steps;  // of relief: steps, halvings
layout(location = 25) uniform mat3 into_eye_space; // a turn
// Of construction.glsl.
layout(location = 110) uniform uint sewn_first; // number of the surface's first triangle
layout(location = 111) uniform vec4 construction_sizes;
layout(location = 112) uniform vec4 construction_rows;
layout(location = 113) uniform vec3 construction_thread; // colour
layout(location = 114) uniform vec3 back_diffuse;
layout(location = 115) uniform vec3 back_specular;
layout(location = 116) uniform vec4 yarn_rows; // yarns per UV unit along u and v; how many there are in each table

layout(location = 117) uniform vec3 thread_gain; // for who draws no lobes of threads: on the diffuse colour

layout(binding = 0) uniform sampler2D diffuse_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D gloss_map;
layout(binding = 3) uniform sampler2D specular_map;
layout(binding = 4) uniform sampler2D occlusion_map;
layout(binding = 5) uniform sampler2D weave_normal;
layout(binding = 6) uniform sampler2D weave_gloss;
layout(binding = 7) uniform sampler2D weave_tint;

const int FLAG_FACETED = 1 << 30;

bool has_map(int map)
{
    return (map_flags & (1 << map)) != 0;
}

vec2 map_uv(int map, vec2 uv)
{
    vec3 point = vec3(uv, 1.0);
    return vec2(dot(uv_rows[2 * map], point), dot(uv_rows[2 * map + 1], point));
}

// Yarns are regular, and trilinear filtering lets their moire through: with the spread of normals at hand (DETAIL_MINIFY)
// they are read a level coarser, for what is lost is not lost.
#if defined(DETAIL_MINIFY) && DETAIL_MINIFY > 0
const float WEAVE_BIAS = 1.0;
#else
const float WEAVE_BIAS = 0.0;
#endif

// Maps at their level of detail: by the UV's own derivatives where detail has moved it, for its jumps are no scale.
#ifdef DETAIL_SHIFTED
vec2 unmoved_across = vec2(0.0), unmoved_down = vec2(0.0); // how UV changes from sample to sample; set by who moves it

vec4 map_texel(sampler2D map, int use, vec2 uv)
{
    mat2 turned = transpose(mat2(uv_rows[2 * use].xy, uv_rows[2 * use + 1].xy));
    return textureGrad(map, map_uv(use, uv), turned * unmoved_across, turned * unmoved_down);
}

vec4 weave_texel(sampler2D map, vec2 uv)
{
    vec2 scale = exp2(WEAVE_BIAS) * weave_scale;
    return textureGrad(map, uv * weave_scale, unmoved_across * scale, unmoved_down * scale);
}

vec2 map_layer(sampler2DArray map, int use, vec2 uv, float layer)
{
    mat2 turned = transpose(mat2(uv_rows[2 * use].xy, uv_rows[2 * use + 1].xy));
    return textureGrad(map, vec3(map_uv(use, uv), layer), turned * unmoved_across, turned * unmoved_down).xy;
}

vec2 weave_layer(sampler2DArray map, vec2 uv, float layer)
{
    vec2 scale = exp2(WEAVE_BIAS) * weave_scale;
    return textureGrad(map, vec3(uv * weave_scale, layer), unmoved_across * scale, unmoved_down * scale).xy;
}
#else
vec4 map_texel(sampler2D map, int use, vec2 uv)
{
    return texture(map, map_uv(use, uv));
}

vec4 weave_texel(sampler2D map, vec2 uv)
{
    return texture(map, uv * weave_scale, WEAVE_BIAS);
}

vec2 map_layer(sampler2DArray map, int use, vec2 uv, float layer)
{
    return texture(map, vec3(map_uv(use, uv), layer)).xy;
}

vec2 weave_layer(sampler2DArray map, vec2 uv, float layer)
{
    return texture(map, vec3(uv * weave_scale, layer), WEAVE_BIAS).xy;
}
#endif

// The material's colour and alpha, without the weave.
vec4 surface_colour(vec2 uv)
{
    vec4 colour = vec4(material_diffuse, 1.0);
    if (has_map(MAP_DIFFUSE))
        colour *= map_texel(diffuse_map, MAP_DIFFUSE, uv);
    return colour;
}

bool surface_cut_away(float alpha)
{
    return alpha < material_scalars.w;
}
