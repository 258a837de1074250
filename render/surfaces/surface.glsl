// Material of the part being drawn, as tl_surfaces_draw sets it (surfaces.h has the same numbers).
const int MAP_DIFFUSE = 0, MAP_NORMAL = 1, MAP_GLOSS = 2, MAP_SPECULAR = 3, MAP_OCCLUSION = 4, MAP_WEAVE = 5;

layout(location = 0) uniform vec3 material_diffuse;
layout(location = 1) uniform vec3 material_specular;
layout(location = 2) uniform vec4 material_scalars; // glossiness, normal scale, occlusion strength, alpha cutoff
layout(location = 3) uniform int map_flags;
layout(location = 4) uniform vec2 weave_scale; // repeats per UV unit
layout(location = 5) uniform vec3 uv_rows[10];
layout(location = 15) uniform uint first_triangle; // of this draw, counted through all surfaces

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

// The material's colour and alpha, without the weave.
vec4 surface_colour(vec2 uv)
{
    vec4 colour = vec4(material_diffuse, 1.0);
    if (has_map(MAP_DIFFUSE))
        colour *= texture(diffuse_map, map_uv(MAP_DIFFUSE, uv));
    return colour;
}

bool surface_cut_away(float alpha)
{
    return alpha < material_scalars.w;
}
