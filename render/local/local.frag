#version 450 core
// The light of one lamp on the surfaces of the G-buffer, added to the light target. TEXELS: on the texels of a part,
// without its shadows, to be mapped to it by LIT (lit_texture.h). NORMALS: the normals of these texels instead, for
// OBJECT_SPACE (object_map.h).
#if defined(TEXELS) || defined(LIT) || defined(OBJECT_SPACE)
layout(location = 99) uniform vec4 chart; // offset, factor on UV
layout(location = 100) uniform float lit_scale; // of the gloss that texels hold
layout(location = 101) uniform float texel_side; // TEXELS: -1 for the back
#endif
#ifdef TEXELS
#define SEES_FRONT (texel_side > 0.0)
#endif
#include "fuzz_terms.glsl"
#include "gloss.glsl"
#include "ground.glsl"
#include "material.glsl"
#include "terms.glsl"
#ifdef NORMALISE_SLERP
#include "slerp.glsl"
#endif

layout(location = 73) uniform mat4 lamp_view; // SHADOW_MAP: world to clip space of the lamp's map
layout(location = 74) uniform float lamp_bias; // metres
layout(location = 75) uniform int lamp_layer;
layout(location = 76) uniform vec4 lamp_ground; // disc of the ground, if it can block the light of this lamp

layout(location = 106) uniform float lamp_ambient; // share of the irradiance
layout(location = 77) uniform vec3 lamp_layers; // coverage of the coat, exponent of its lobe, 1 - openness

#ifdef FUZZ
layout(location = 87) uniform vec4 lamp_fuzz; // colour, roughness
layout(location = 93) uniform float lamp_fuzz_follow;
#endif

#ifdef MEASURED
layout(location = 98) uniform vec3 measured_diffuse;
#endif

#ifdef EMISSION
layout(location = 84) uniform vec3 emission;
#ifdef EMISSION_MAP
layout(location = 85) uniform vec3 emission_rows[2]; // of the UV transform
layout(binding = 25) uniform sampler2D emission_map;
#endif
#endif

layout(binding = 16) uniform usampler2D seen_triangle;
layout(binding = 17) uniform sampler2D seen_point; // w: coverage
#if defined(SHADOW_RAYS)
layout(binding = 18) uniform sampler2DArray lamp_visibility;
#elif defined(SHADOW_MAP)
layout(binding = 18) uniform sampler2DArrayShadow lamp_depths;
#endif
#ifdef NORMALISE_CUBE
layout(binding = 19) uniform samplerCube normalising; // unit vectors, with 0 to 1 standing for -1 to 1
#endif

#ifdef OBJECT_SPACE
layout(location = 103) uniform mat3 object_turn;
#endif
#if defined(LIT) || defined(OBJECT_SPACE)
// gloss / lit_scale, cosine of the lamp; of OBJECT_SPACE (normal + 1) / 2, cover
layout(binding = 27) uniform sampler2DArray lit_light;
layout(binding = 28) uniform sampler2DArray lit_cover;
#endif

#ifdef PASS_LAST
layout(binding = 24) uniform sampler2D product; // product of all tables from earlier passes
#endif

in vec3 point;
in vec3 normal;
in vec4 tangent;
in vec2 uv;
#if defined(GOURAUD)
in vec4 lit_front, lit_back;
#elif defined(COSINES)
in vec4 cosines_normal;
in vec4 cosines_plane;
in vec2 cosines_across;
in float cosine_lamp;
#elif defined(VECTORS)
in vec3 to_lamp, to_eye, halfway;
#endif

layout(location = 0) out vec4 out_light; // premultiplied by coverage
#ifdef TEXELS
layout(location = 1) out float out_cover;
#endif

const uint TRIANGLE_BACK = 0x80000000u;

// Renormalises an interpolated vector. The fallback is used for zero vectors only.
vec3 made_unit(vec3 v, vec3 fallback)
{
#if defined(NORMALISE_NONE)
    return v;
#elif defined(NORMALISE_CUBE)
    return 2.0 * texture(normalising, v).xyz - 1.0;
#elif defined(NORMALISE_SERIES)
    return v * unit_series(dot(v, v), NORMALISE_SERIES);
#elif defined(NORMALISE_NEWTON8)
    return register_newton_vector(v);
#else
    return direction_or(v, fallback);
#endif
}

float visibility(vec3 l)
{
#if defined(SHADOW_RAYS)
    return texelFetch(lamp_visibility, ivec3(gl_FragCoord.xy, lamp_layer), 0).r;
#elif defined(SHADOW_MAP)
    float shown = ground_passes(lamp_ground, point, l);
    vec4 place = lamp_view * vec4(point + lamp_bias * l, 1.0);
    if (place.w <= 0.0) // behind the lamp
        return shown;
    vec3 texel = 0.5 * place.xyz / place.w + 0.5;
    return shown * texture(lamp_depths, vec4(texel.xy, float(lamp_layer), min(texel.z, 1.0)));
#else
    return 1.0;
#endif
}

float self_shadow(float facing)
{
#ifdef STEP
    return facing > 0.0 ? 1.0 : 0.0;
#else
    return self_shadow_ramp(facing);
#endif
}

// Fabric detail of the sample; set first by find_detail.
SurfaceColours colours;
bool bumpy;
Bumps bumps;
DetailPlace place;
vec3 view; // towards the eye, in tangent space
vec3 base_normal; // the interpolated normal below the visible point; set before find_detail

void find_detail(inout mat3 frame, float side, inout vec3 smooth_normal)
{
#ifdef DETAIL_SHIFTED
    unmoved_across = dFdx(uv);
    unmoved_down = dFdy(uv);
#endif
#if defined(DETAIL_CURVED) && !defined(TEXELS)
    vec3 eyewards = direction_or(eye - point, smooth_normal);
    unmoved_across *= detail_shortened(dFdx(point), eyewards);
    unmoved_down *= detail_shortened(dFdy(point), eyewards);
#endif
#if !DETAIL_DERIVED
    if (has_map(MAP_WEAVE))
        weave_slopes = detail_slope_factors(point, uv);
#endif
    view = direction_or(eye - point, smooth_normal) * frame;
#ifdef TEXELS
    place = DetailPlace(uv, 0.0, false, vec2(0.0));
#else
    place = detail_place(uv, view, side, detail_bend(point, normal, frame, view, eye));
#ifdef DETAIL_CURVED
    base_normal = smooth_normal = detail_turned(frame, smooth_normal, place);
    frame = detail_frame(smooth_normal, tangent);
    view = direction_or(eye - point, smooth_normal) * frame;
#endif
#endif
    sew(first_triangle + uint(gl_PrimitiveID), place.uv, dFdx(uv), dFdy(uv));
    colours = colours_at(surface_colour(place.uv).rgb, place.uv);
    bumpy = has_bumps(tangent);
    if (bumpy)
        bumps = bumps_at(place.uv);
}

// On which side of u the second axis of Cosines.half_plane lies: 1 where it is the bitangent of the surface.
float plane_side(float side)
{
    float handed = tangent.w < 0.0 ? -1.0 : 1.0;
#if defined(COSINES)
    return handed;
#elif defined(TANGENT_SPACE)
    return side;
#else
    return side * handed;
#endif
}

#if defined(LIT) || defined(OBJECT_SPACE)
// A texture over the UVs of the part; layer 0 is the front.
vec4 charted(sampler2DArray map, float layer)
{
    vec3 at = vec3(chart.xy + place.uv * chart.zw, layer);
#ifdef DETAIL_SHIFTED
    return textureGrad(map, at, unmoved_across * chart.zw, unmoved_down * chart.zw);
#else
    return texture(map, at);
#endif
}
#endif

#ifndef GOURAUD
// The normal with bumps, not normalised after interpolation and map.
vec3 bumped_normal(vec3 smooth_normal)
{
    if (!bumpy)
        return base_normal;
#ifdef OBJECT_SPACE
    vec4 held = charted(lit_light, 0.0);
    return object_turn * (2.0 * held.rgb - held.a);
#endif
#if DETAIL_DERIVED
    if (detail_range.z > 0.0)
        return detail_derived(bumps.normal, smooth_normal, point, uv);
#endif
    vec3 mapped = bumps.normal;
    return mapped.x * tangent.xyz + mapped.y * tangent.w * cross(base_normal, tangent.xyz) + mapped.z * base_normal;
}

// `facing` is the cosine of the light with the normal without bumps.
Cosines cosines_here(float side, vec3 smooth_normal, out float facing)
{
#if defined(COSINES)
    facing = side * cosines_normal.x;
    return cosines_from(cosines_normal * vec4(side, side, side, 1.0), cosines_plane, cosines_across, cosine_lamp);
#elif defined(TANGENT_SPACE)
    vec3 up = vec3(0.0, 0.0, 1.0);
    vec3 l = made_unit(to_lamp, up), v = made_unit(to_eye, up), h = made_unit(halfway, up);
    vec3 n = facing_normal(side * (bumpy ? made_unit(bumps.normal, up) : up), v);
    facing = side * l.z;
    return cosines_near(frame_of(n, vec3(1.0, 0.0, 0.0), side * (tangent.w < 0.0 ? -1.0 : 1.0)), l, v, h);
#elif defined(VECTORS) || defined(MATRIX) || defined(NORMALISE_SLERP)
    vec3 n = side * made_unit(bumped_normal(smooth_normal), smooth_normal);
#ifdef MATRIX
    vec3 l = constant_lamp, v = constant_eye, h = direction_or(l + v, l);
#elif defined(NORMALISE_SLERP)
    vec3 l, v, h;
    slerped_vectors(point, l, v, h);
#else
    vec3 l = made_unit(to_lamp, n), v = made_unit(to_eye, n), h = made_unit(halfway, n);
#endif
    facing = held(side * dot(smooth_normal, l));
    return cosines_near(frame_of(n, tangent.xyz, side), l, v, h);
#else
    vec3 n = side * direction_or(bumped_normal(smooth_normal), smooth_normal);
    vec3 l = towards_lamp(lamp, point, n), v = direction_or(eye - point, n);
    n = facing_normal(n, v);
    facing = side * dot(smooth_normal, l);
    return cosines_of(frame_of(n, tangent.xyz, side), l, v, direction_or(l + v, l));
#endif
}
#endif

// The sum of maps and bumps in squared widths along weft and warp, and to their product.
vec3 thread_widening_here(float side)
{
    float own_rough = 1.0 - material_scalars.x;
    float yarn_rough = 1.0 - colours.glossiness;
    vec3 wider = bumpy ? bumps_widening(DETAIL_MINIFY, own_rough, yarn_rough, bumps)
                       : vec3(vec2(detail_widening(own_rough, yarn_rough, 0.0)), 0.0);
    FacetWidening threads =
        facet_widening(gloss_widths.z, gloss_widths.w, tangent.w, wider.x, wider.y, wider.z);
    return vec3(threads.weft, threads.warp, plane_side(side) * threads.product);
}

// The same for the model's facets; `rough` is the roughness of all lobes that are round.
vec3 widening_here(float rough, float side)
{
    return MODEL == WARD ? thread_widening_here(side)
                         : vec3(vec2(detail_widening(1.0 - material_scalars.x, rough, 0.0)), 0.0);
}

#ifndef GOURAUD
// The gloss and the factor on the diffuse colour, self-shadowed.
vec4 lit_here(float side, vec3 smooth_normal, vec3 kd)
{
    float facing;
    Cosines c = cosines_here(side, smooth_normal, facing);
    c.hand = plane_side(side);
    float shown = self_shadow(facing);
#ifdef PASS_LAST
    vec3 shine = tables_gloss(c, texelFetch(product, ivec2(gl_FragCoord.xy), 0).rgb);
#else
    float rough = 1.0 - colours.glossiness;
    if (bumpy)
        rough = bumps_roughness(DETAIL_MINIFY, rough, bumps, view);
    vec3 shine = gloss(c, colours.f0, lobe_exponent(1.0 - rough), widening_here(rough, side));
#endif
#ifdef THREADS
    shine += inside_threads(c, colours.f0, kd, thread_widening_here(side));
#endif
    return shown > 0.0 ? shown * vec4(shine, matt(c)) : vec4(0.0);
}
#endif

#ifdef LIT
// The same from the texture.
vec4 lit_texel(float side)
{
    float layer = side > 0.0 ? 0.0 : 1.0;
    vec4 light = charted(lit_light, layer);
    float cover = charted(lit_cover, layer).r;
    return cover > 0.0 ? light * vec4(vec3(lit_scale), 1.0 / PI) / cover : vec4(0.0);
}
#endif

vec3 diffuse_here()
{
#ifdef MEASURED
    return measured_diffuse;
#else
    return colours.diffuse;
#endif
}

// Unshadowed reflected light divided by the irradiance.
vec3 reflected(float side, vec3 smooth_normal)
{
    vec3 kd = diffuse_here();
#ifdef LIT
    vec4 lit = lit_texel(side);
#else
    if (bumpy)
        kd *= bumps.mean_length; // the mean normal, which is shorter than 1, receives the light
#ifdef GOURAUD
    vec4 lit = side > 0.0 ? lit_front : lit_back;
#else
    vec4 lit = lit_here(side, smooth_normal, kd);
#endif
#endif
    return kd * lit.w + lit.rgb;
}

// Adds the coat. It is smooth and always evaluated exactly; the light below is multiplied by 1 - its reflectance.
vec3 under_coat(vec3 light, vec3 l, vec3 n)
{
#ifdef COAT
    vec3 v = direction_or(eye - point, n);
    float reflected = coat_share(lamp_layers.x, dot(n, v));
    vec3 axis = mirror_direction(n, v), across = cross(axis, l);
    float lobe = exact_power(dot(axis, l), dot(across, across), lamp_layers.y);
    light *= 1.0 - reflected;
    light += reflected * self_shadow(dot(n, l)) * (lamp_layers.y + 1.0) / (2.0 * PI) * lobe;
#endif
    return light;
}

#ifdef FUZZ
// The direction in which fibres stand.
vec3 fibre_axis(float side, vec3 smooth_normal)
{
#ifndef GOURAUD
    vec3 shown = side * direction_or(bumped_normal(smooth_normal), smooth_normal);
    shown = facing_normal(shown, direction_or(eye - point, shown));
    return fuzz_axis(lamp_fuzz_follow, side * smooth_normal, shown);
#else
    return side * smooth_normal;
#endif
}
#endif

// Adds the fibres that stand on everything else, which keeps what they leave.
vec3 under_fuzz(vec3 light, vec3 l, float side, vec3 smooth_normal)
{
#ifdef FUZZ
    vec3 n = fibre_axis(side, smooth_normal), v = direction_or(eye - point, n);
    light *= fuzz_under(lamp_fuzz.rgb, lamp_fuzz.w, dot(n, v));
    light += self_shadow(side * dot(smooth_normal, l)) * fuzz_value(lamp_fuzz.w, n, l, v) * lamp_fuzz.rgb;
#endif
    return light;
}

// Light that leaves in all directions below the coat and the fibres.
vec3 under_layers(vec3 sent, float side, vec3 smooth_normal)
{
#ifdef COAT
    vec3 n = side * smooth_normal;
    sent *= 1.0 - coat_share(lamp_layers.x, dot(n, direction_or(eye - point, n)));
#endif
#ifdef FUZZ
    vec3 up = fibre_axis(side, smooth_normal);
    sent *= fuzz_under(lamp_fuzz.rgb, lamp_fuzz.w, dot(up, direction_or(eye - point, up)));
#endif
    return sent;
}

void main()
{
    vec3 facet = direction_or(cross(dFdx(point), dFdy(point)), vec3(0.0, 1.0, 0.0));
    vec2 across = dFdx(uv), down = dFdy(uv);
    float side = SEES_FRONT ? 1.0 : -1.0;
#ifdef NORMALISE_SLERP
    base_normal = slerped_normal(point);
#else
    base_normal = normal;
#endif
    vec3 smooth_normal = direction_or(base_normal, facet);
    mat3 frame = detail_frame(smooth_normal, tangent);
    find_detail(frame, side, smooth_normal);
#ifdef NORMALS
    out_light = vec4(0.5 * direction_or(bumped_normal(smooth_normal), smooth_normal) + 0.5, 1.0);
    out_cover = 1.0;
#elif defined(TEXELS)
    float open = bumpy ? bumps.mean_length : 1.0; // as in reflected
    vec4 lit = lit_here(side, smooth_normal, diffuse_here() * open);
    out_light = lit * vec4(vec3(1.0 / lit_scale), PI * open);
    out_cover = 1.0;
#else
#ifdef EMISSION
    vec3 sent = emission;
#ifdef EMISSION_MAP
    vec3 at = vec3(place.uv, 1.0);
    sent *= texture(emission_map, vec2(dot(emission_rows[0], at), dot(emission_rows[1], at))).rgb;
#endif
#endif
    vec3 l = towards_lamp(lamp, point, side * smooth_normal);
    float own_shadow = detail_shadow(place, l * frame, side, across, down); // before discard, because it needs derivatives
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uint triangle = (first_triangle + uint(gl_PrimitiveID) + 1u) | (gl_FrontFacing ? 0u : TRIANGLE_BACK);
    if (texelFetch(seen_triangle, texel, 0).r != triangle)
        discard;
#ifdef PASS_PRODUCT
    float facing;
    Cosines c = cosines_here(side, smooth_normal, facing);
    c.hand = plane_side(side);
    out_light = vec4(tables_product(c), 1.0);
#elif defined(EMISSION)
    out_light = vec4(texelFetch(seen_point, texel, 0).w * lamp_layers.z * under_layers(sent, side, smooth_normal), 0.0);
#else
    float shown = texelFetch(seen_point, texel, 0).w * lamp_layers.z * visibility(l) * own_shadow;
    vec3 light = under_coat(reflected(side, smooth_normal), l, side * smooth_normal);
    light = under_fuzz(light, l, side, smooth_normal);
    out_light = vec4(shown * lamp_irradiance * lamp_falloff(lamp, point) * light, 0.0);
#ifdef AMBIENT
    vec3 even = lamp_ambient / PI * diffuse_here();
#ifdef THREADS
    even *= thread_gain;
#endif
    out_light.rgb += texelFetch(seen_point, texel, 0).w * lamp_layers.z * lamp_irradiance * lamp_falloff(lamp, point) *
                     under_layers(even, side, smooth_normal);
#endif
#endif
#endif
}
