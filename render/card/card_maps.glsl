// The maps of a class of materials at a pixel.
layout(std430, binding = CARD_UVS) restrict readonly buffer Uvs
{
    vec2 uvs[];
};
layout(std430, binding = CARD_YARNS) restrict readonly buffer Yarns
{
    float yarn_sums[];
};
layout(binding = 10) uniform sampler2D maps[6]; // by enum tl_map_use; then the mixed moments of the normal map
const int MAP_DIFFUSE = 0, MAP_NORMAL = 1, MAP_GLOSS = 2, MAP_SPECULAR = 3, MAP_OCCLUSION = 4, MAP_MIXED = 5, MAP_EMISSION = 5;
layout(binding = 1) uniform sampler2D weave_tint;
layout(binding = 2) uniform sampler2D weave_bumps;
layout(binding = 3) uniform sampler2D weave_mixed;
layout(binding = 5) uniform sampler2D emission_map; // in place of the gain's, which a pixel does not read

float yarn_sum(float entry)
{
    return yarn_sums[int(entry)];
}
#include "yarn_terms.glsl"

// UV at a pixel and its changes, and how far the surface is stretched there.
struct Uv {
    vec2 at, across, up, slopes;
};

Uv uv_of(Place p, float uv_metres)
{
    vec2 a = uvs[p.corners.x], b = uvs[p.corners.y], c = uvs[p.corners.z];
    Uv uv;
    uv.at = p.weights.x * a + p.weights.y * b + p.weights.z * c;
    uv.across = p.at_x.x * a + p.at_x.y * b + p.at_x.z * c;
    uv.up = p.at_y.x * a + p.at_y.y * b + p.at_y.z * c;
    uv.slopes = vec2(1.0);
    vec3 e = p.points[1] - p.points[0], f = p.points[2] - p.points[0];
    b -= a;
    c -= a;
    float determinant = b.x * c.y - b.y * c.x;
    if (abs(determinant) > 1e-20)
        uv.slopes = vec2(detail_slope_factor(length(e * c.y - f * b.y) / abs(determinant), uv_metres),
                         detail_slope_factor(length(f * b.x - e * c.x) / abs(determinant), uv_metres));
    return uv;
}

// Map `use`, as the part's rows place it; `from` is read there.
vec4 read_map(Part part, int use, sampler2D from, Uv uv)
{
    vec4 u = part.map_rows[2 * use], v = part.map_rows[2 * use + 1];
    vec2 side = vec2(textureSize(from, 0));
    vec2 at = vec2(dot(u.xy, uv.at) + u.z, dot(v.xy, uv.at) + v.z);
    vec2 across = side * vec2(dot(u.xy, uv.across), dot(v.xy, uv.across)), up = side * vec2(dot(u.xy, uv.up), dot(v.xy, uv.up));
    return textureLod(from, at, texel_level(dot(across, across), dot(up, up)));
}

Texels texels_of(Part part, Uv uv, ConstructionLook sewn)
{
    Texels t = Texels(SurfaceColours(part.diffuse.rgb, part.specular.rgb, part.diffuse.a), surface_texels(), bumps_of_normal(vec3(0.0, 0.0, 1.0)));
    vec4 own = vec4(0.0), woven = vec4(0.0);
    float own_mixed = 0.0, woven_mixed = 0.0;
    if ((part.flags.z & 1u << MAP_DIFFUSE) != 0u)
        t.cloth.diffuse *= read_map(part, MAP_DIFFUSE, maps[MAP_DIFFUSE], uv).rgb;
    if ((part.flags.z & 1u << MAP_SPECULAR) != 0u)
        t.cloth.f0 *= read_map(part, MAP_SPECULAR, maps[MAP_SPECULAR], uv).rgb;
    if ((part.flags.z & 1u << MAP_GLOSS) != 0u)
        t.cloth.glossiness *= read_map(part, MAP_GLOSS, maps[MAP_GLOSS], uv).r;
    if ((part.flags.z & 1u << MAP_OCCLUSION) != 0u)
        t.more.occlusion = mix(1.0, read_map(part, MAP_OCCLUSION, maps[MAP_OCCLUSION], uv).r, part.back_diffuse.w);
    if ((part.flags.x & HAS_OWN_BUMPS) != 0u)
        own = read_map(part, MAP_NORMAL, maps[MAP_NORMAL], uv);
    if ((part.flags.x & OWN_ARE_MOMENTS) != 0u)
        own_mixed = read_map(part, MAP_NORMAL, maps[MAP_MIXED], uv).r;
    if ((part.flags.x & IS_WOVEN) != 0u) {
        vec2 side = part.weave.z * vec2(textureSize(weave_tint, 0)) * part.weave.xy, at = uv.at * part.weave.xy;
        vec2 across = uv.across * side, up = uv.up * side;
        float level = texel_level(dot(across, across), dot(up, up));
        vec4 tint = textureLod(weave_tint, at, level);
        t.more.tint = tint.rgb;
        t.more.gloss = tint.a;
        woven = textureLod(weave_bumps, at, level);
        woven_mixed = textureLod(weave_mixed, at, level).r;
    }
    if ((part.flags.x & HAS_YARNS) != 0u) {
        vec2 at = part.yarns.xy * uv.at, wide = part.yarns.xy * sqrt(uv.across * uv.across + uv.up * uv.up);
        t.more.yarns = yarn_factor(part.yarns.z, part.yarns.w, at.x, at.y, wide.x, wide.y);
    }
    t.bumps = layers_of(part, own, own_mixed, woven, woven_mixed, uv.slopes);
    t.bumps = bumps_add(t.bumps, bumps_of_slopes(sewn.slope_x, sewn.slope_y, vec3(sewn.spread_x, sewn.spread_y, sewn.spread_xy)));
    t.more.thread = sewn.thread;
    t.more.shade = sewn.shade;
    return t;
}
