#version 450 core
// The light of one lamp on what the G-buffer sees, to be added to the rest.
#include "gloss.glsl"
#include "ground.glsl"
#include "terms.glsl"

layout(location = 73) uniform mat4 lamp_view; // SHADOW_MAP: world -> clip space of the lamp's map
layout(location = 74) uniform float lamp_bias; // metres
layout(location = 75) uniform int lamp_layer;
layout(location = 76) uniform vec4 lamp_ground; // the ground's disc, if it can stop this lamp's light

layout(binding = 16) uniform usampler2D seen_triangle;
layout(binding = 17) uniform sampler2D seen_point; // w: coverage
#if defined(SHADOW_RAYS)
layout(binding = 18) uniform sampler2DArray lamp_visibility;
#elif defined(SHADOW_MAP)
layout(binding = 18) uniform sampler2DArrayShadow lamp_depths;
#endif
#ifdef NORMALISE_CUBE
layout(binding = 19) uniform samplerCube normalising; // unit vectors, 0 to 1 standing for -1 to 1
#endif

#ifdef PASS_LAST
layout(binding = 24) uniform sampler2D product; // of all tables, multiplied in earlier passes
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
in float cosine_lamp;
#elif defined(VECTORS)
in vec3 to_lamp, to_eye, halfway;
#endif

layout(location = 0) out vec4 out_light; // premultiplied by coverage

const uint TRIANGLE_BACK = 0x80000000u;

// How an interpolated vector becomes unit again. What is exact is nearly never far from it.
vec3 made_unit(vec3 v, vec3 fallback)
{
#if defined(NORMALISE_NONE)
    return v;
#elif defined(NORMALISE_CUBE)
    return 2.0 * texture(normalising, v).xyz - 1.0;
#elif defined(NORMALISE_NEWTON)
    return v * (1.5 - 0.5 * dot(v, v));
#else
    return direction_or(v, fallback);
#endif
}

float visibility(vec3 l)
{
#if defined(SHADOW_RAYS)
    return texelFetch(lamp_visibility, ivec3(gl_FragCoord.xy, lamp_layer), 0).r;
#elif defined(SHADOW_MAP)
    float shown = ground_visibility(lamp_ground, point, l);
    vec4 place = lamp_view * vec4(point + lamp_bias * l, 1.0);
    if (place.w <= 0.0) // behind a lamp that shines on something else
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

// Where detail shows the surface, 1 - g there, and what is left of a matt surface's light where bumps are averaged.
vec2 seen_uv = vec2(0.0);
float seen_rough = 1.0, seen_share = 1.0;

// The share of the lamp's light that the surface's own bumps let through.
float find_detail(float side, vec3 smooth_normal)
{
    vec2 across = dFdx(uv), down = dFdy(uv);
#ifdef DETAIL_SHIFTED
    unmoved_across = across;
    unmoved_down = down;
#endif
    mat3 frame = detail_frame(smooth_normal, tangent);
    vec3 view = direction_or(eye - point, smooth_normal) * frame;
    DetailPlace place = detail_place(uv, view, side);
    seen_uv = place.uv;
    seen_rough = 1.0 - glossiness(seen_uv);
    seen_share = 1.0;
    if (has_bumps(tangent)) {
        Bumps bumps = bumps_at(seen_uv);
        seen_rough = detail_rough(seen_rough, bumps, view);
        seen_share = bumps.length; // the mean of the normals, not its direction, meets the light
    }
    return detail_shadow(place, towards_lamp(point, smooth_normal) * frame, side, across, down);
}

#ifndef GOURAUD
// The normal with its bumps, as long as interpolation and the map leave it.
vec3 bumped_normal()
{
    if (!has_bumps(tangent))
        return normal;
    vec3 mapped = tangent_space_normal(seen_uv);
#if DETAIL_MODE == DETAIL_BLINN
    if (detail_range.z > 0.0)
        return detail_blinn(mapped, direction_or(normal, vec3(0.0)), point, uv);
#endif
    return mapped.x * tangent.xyz + mapped.y * tangent.w * cross(normal, tangent.xyz) + mapped.z * normal;
}

// `facing`: cosine of the light and the normal without bumps.
Cosines cosines_here(float side, vec3 smooth_normal, out float facing)
{
#if defined(COSINES)
    facing = side * cosines_normal.x;
    return cosines_from(cosines_normal * vec4(side, side, side, 1.0), cosines_plane, cosine_lamp);
#elif defined(TANGENT_SPACE)
    vec3 up = vec3(0.0, 0.0, 1.0);
    vec3 l = made_unit(to_lamp, up), v = made_unit(to_eye, up), h = made_unit(halfway, up);
    vec3 n = side * (has_bumps(tangent) ? made_unit(tangent_space_normal(seen_uv), up) : up);
    facing = side * l.z;
    return cosines_near(frame_of(n, vec3(1.0, 0.0, 0.0), side * (tangent.w < 0.0 ? -1.0 : 1.0)), l, v, h);
#elif defined(VECTORS) || defined(MATRIX)
    vec3 n = side * made_unit(bumped_normal(), smooth_normal);
#ifdef MATRIX
    vec3 l = constant_lamp, v = constant_eye, h = direction_or(l + v, l);
#else
    vec3 l = made_unit(to_lamp, n), v = made_unit(to_eye, n), h = made_unit(halfway, n);
#endif
    facing = side * dot(smooth_normal, l);
    return cosines_near(frame_of(n, tangent.xyz, side), l, v, h);
#else
    vec3 n = side * direction_or(bumped_normal(), smooth_normal);
    vec3 l = towards_lamp(point, n), v = direction_or(eye - point, n);
    facing = side * dot(smooth_normal, l);
    return cosines_of(frame_of(n, tangent.xyz, side), l, v, direction_or(l + v, l));
#endif
}
#endif

// The light sent to the eye for each irradiance, unshadowed.
vec3 reflected(float side, vec3 smooth_normal)
{
    vec3 kd = seen_share * diffuse(surface_colour(seen_uv).rgb, seen_uv);
#ifdef GOURAUD
    vec4 lit = side > 0.0 ? lit_front : lit_back;
    return kd * lit.w + lit.rgb;
#else
    float facing;
    Cosines c = cosines_here(side, smooth_normal, facing);
    float shown = self_shadow(facing);
#ifdef PASS_LAST
    vec3 shine = tables_gloss(c, texelFetch(product, ivec2(gl_FragCoord.xy), 0).rgb);
#else
    vec3 shine = gloss(c, specular_f0(seen_uv), lobe_exponent(1.0 - seen_rough));
#endif
    vec3 light = kd * (max(c.a, 0.0) / PI) + shine;
    return shown > 0.0 ? shown * light : vec3(0.0);
#endif
}

void main()
{
    vec3 facet = direction_or(cross(dFdx(point), dFdy(point)), vec3(0.0, 1.0, 0.0));
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uint triangle = (first_triangle + uint(gl_PrimitiveID) + 1u) | (gl_FrontFacing ? 0u : TRIANGLE_BACK);
    if (texelFetch(seen_triangle, texel, 0).r != triangle)
        discard;
    float side = gl_FrontFacing ? 1.0 : -1.0;
    vec3 smooth_normal = direction_or(normal, facet);
    float lit = find_detail(side, smooth_normal);
#ifdef PASS_PRODUCT
    float facing;
    out_light = vec4(tables_product(cosines_here(side, smooth_normal, facing)), 1.0);
#else
    float shown = lit * texelFetch(seen_point, texel, 0).w * visibility(towards_lamp(point, side * smooth_normal));
    out_light = vec4(shown * irradiance_at(point) * reflected(side, smooth_normal), 0.0);
#endif
}
