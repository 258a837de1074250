#version 450 core
// Outputs for the light passes, of the nearest surface: point, shading normal, and the two colours of its material.
#include "depth_terms.glsl"
#include "material.glsl"
#include "ground.glsl"

layout(location = 17) uniform vec3 eye;
layout(binding = 14) uniform usamplerBuffer numbers; // of the triangles that are drawn
layout(location = 19) uniform bool blends_lobes;
layout(location = 18) uniform vec4 fading_disc; // centre and radius of the ground, while the ground is drawn

in vec2 uv;

#ifdef ONLY_TRIANGLE
layout(location = 0) out uint out_triangle; // 1 + its number, and TRIANGLE_BACK
#else
in vec3 point;
in vec3 normal;
in vec4 tangent;

layout(location = 0) out vec4 out_point;    // world, metres; coverage
layout(location = 1) out vec4 out_normal;   // world, unit, towards the viewer's side; 1 - glossiness
layout(location = 2) out vec4 out_diffuse;  // kd with occlusion; octahedral x of the smooth normal
layout(location = 3) out vec4 out_specular; // F ks, or F0 of facets where FRAMES; octahedral y of the smooth normal
layout(location = 4) out uint out_triangle; // 1 + its number, and TRIANGLE_BACK
#endif
layout(depth_greater) out float gl_FragDepth;
#ifdef FRAMES
layout(location = 5) out vec4 out_widening; // added to squared widths of facets along u and v, and to their product
#endif
#ifdef BEHIND
layout(binding = 15) uniform sampler2D passed; // depth of what is nearer than what is wanted


bool is_passed()
{
    return gl_FragDepth <= texelFetch(passed, ivec2(gl_FragCoord.xy), 0).r + DEPTH_ROUNDING;
}
#endif

const uint TRIANGLE_BACK = 0x80000000u;

// A unit vector on the octahedron, unfolded into [-1, 1]^2 [Meyer et al. 2010].
vec2 octahedral(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 away = vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * away;
}

// `place`: among those that are drawn.
uint with_side(uint place)
{
    return (place + 1u) | (gl_FrontFacing ? 0u : TRIANGLE_BACK);
}

#ifdef ONLY_TRIANGLE
void main()
{
    gl_FragDepth = gl_FragCoord.z + (gl_FrontFacing ? 0.0 : DEPTH_OF_BACKS);
#ifdef BEHIND
    if (is_passed())
        discard;
#endif
#ifdef MASKED
    if (surface_cut_away(surface_colour(uv).a))
        discard;
#endif
    out_triangle = with_side(first_triangle + uint(gl_PrimitiveID)); // the CPU looks its number up (ids.c)
}
#else
void main()
{
    gl_FragDepth = gl_FragCoord.z + (gl_FrontFacing ? 0.0 : DEPTH_OF_BACKS);
#ifdef BEHIND
    if (is_passed())
        discard;
#endif
    vec3 facet = direction_or(cross(dFdx(point), dFdy(point)), vec3(0.0, 1.0, 0.0));
    float side = gl_FrontFacing ? 1.0 : -1.0; // a back is a surface of its own: the whole frame turns over
    vec3 smooth_normal = direction_or(normal, facet);
    vec2 across = dFdx(uv), down = dFdy(uv);
#ifdef DETAIL_SHIFTED
    unmoved_across = across;
    unmoved_down = down;
#endif
#ifdef DETAIL_CURVED
    vec3 to_eye = direction_or(eye - point, smooth_normal);
    unmoved_across *= detail_shortened(dFdx(point), to_eye);
    unmoved_down *= detail_shortened(dFdy(point), to_eye);
#endif
#if !DETAIL_DERIVED
    if (has_map(MAP_WEAVE))
        weave_slopes = detail_slope_factors(point, uv);
#endif
    mat3 frame = detail_frame(smooth_normal, tangent);
    vec3 view = direction_or(eye - point, smooth_normal) * frame;
    DetailPlace place = detail_place(uv, view, side, detail_bend(point, normal, frame, view, eye));
    vec3 base_normal = normal;
#ifdef DETAIL_CURVED
    base_normal = smooth_normal = detail_turned(frame, smooth_normal, place);
    frame = detail_frame(smooth_normal, tangent);
    view = direction_or(eye - point, smooth_normal) * frame;
#endif
    vec4 colour = surface_colour(place.uv);
    if (place.outside || (material_scalars.w > 0.0 && surface_cut_away(colour.a)))
        discard;
    float cover = fading_disc.w > 0.0 ? ground_opacity(fading_disc, point.x, point.z) : 1.0;
    if (cover <= 0.0)
        discard;
    uint number = texelFetch(numbers, int(first_triangle) + gl_PrimitiveID).r;
    sew(number, place.uv, across, down);
    SurfaceColours colours = colours_at(colour.rgb, place.uv);
    vec3 kd = colours.diffuse;
#ifndef FRAMES
    vec3 of_threads = min(kd * (thread_gain - 1.0), 1.0 - kd);
    kd += of_threads;
#endif
    float wider = detail_widening(1.0 - material_scalars.x, 1.0 - colours.glossiness, 0.0);
    SurfaceShape shape = SurfaceShape(side * smooth_normal, colours.glossiness, vec3(wider, wider, 0.0), 1.0);
    if (has_bumps(tangent)) {
        Bumps bumps = bumps_at(place.uv);
        shape = surface_shape(DETAIL_MINIFY, bumps, base_normal, smooth_normal, tangent.xyz, tangent.w, side,
                              direction_or(eye - point, smooth_normal), material_scalars.x, colours.glossiness);
#if DETAIL_DERIVED
        if (detail_range.z > 0.0)
            shape.normal = side * detail_derived(bumps.normal, smooth_normal, point, uv);
#endif
        kd *= shape.open;
    }
#ifdef FRAMES
    out_widening = vec4(shape.widening, 0.0);
#endif
    float rough = 1.0 - shape.glossiness;
    vec2 horizon = octahedral(side * smooth_normal);
    vec3 v = direction_or(eye - point, shape.normal), n = facing_normal(shape.normal, v);
    // The mean normal's Fresnel term: facets that turn away reflect more, but what lies below the surface's horizon.
    vec3 ks = schlick_colour(colours.f0, dot(n, v));
#ifdef FRAMES
    if ((map_flags & FLAG_FACETED) != 0)
        ks = colours.f0; // a facet's Fresnel term is not the normal's
#else
    if (blends_lobes)
        ks = min(ks + of_threads, vec3(1.0)); // the light of threads is their colour all the way to the mirror
#endif
#if DETAIL_SHADOW != 0
    if (has_detail(DETAIL_HORIZONS)) {
        DetailHorizon sky = detail_horizon(detail_lookup(place.uv, side, across, down));
        vec3 seen_side = vec3(1.0, 1.0, side);
        kd *= detail_ambient(sky, n * frame * seen_side);
        ks *= detail_gloss_seen(sky, reflect(-v, n) * frame * seen_side, rough);
    }
#endif
    out_point = vec4(point, cover);
    out_normal = vec4(n, rough);
    out_diffuse = vec4(kd, horizon.x);
    out_specular = vec4(ks, horizon.y);
    out_triangle = with_side(number);
}
#endif
