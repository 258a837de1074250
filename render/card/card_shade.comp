#version 450 core
// The light of one class of materials, tile by tile: exact light times the interpolated ratio, and suns (render/shade).
#include "card_frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(location = 0) uniform ivec3 kind; // class, first tile of its list, layer
layout(rgba16f, binding = 0) restrict uniform image2D light_image;
layout(std430, binding = CARD_TILES) restrict readonly buffer Tiles
{
    uint tiles[];
};
#include "card_see.glsl"
#include "card_exact.glsl"
#ifndef NOTHING
layout(std430, binding = CARD_TRIANGLE_PARTS) restrict readonly buffer TriangleParts
{
    uint triangle_parts[];
};
layout(std430, binding = CARD_TRIANGLE_PROBES) restrict readonly buffer TriangleProbes
{
    uint triangle_probes[];
};
layout(std430, binding = CARD_RATIOS) restrict readonly buffer Ratios
{
    vec4 ratios[];
};
layout(binding = 6) uniform sampler2DArray sun_seen;

// The light that the pixel sends to the viewer.
vec3 light_of(Seen s, ivec2 pixel)
{
    uint corner = 3u * (2u * s.p.triangle + (s.p.back ? 1u : 0u));
    uvec3 at = 4u * uvec3(triangle_probes[corner], triangle_probes[corner + 1u], triangle_probes[corner + 2u]);
    vec4 gloss[3] = vec4[3](ratios[at.x + 1u], ratios[at.y + 1u], ratios[at.z + 1u]);
    vec3 w = s.p.weights, covered = vec3(gloss[0].w, gloss[1].w, gloss[2].w);
    float all = covered.x + covered.y + covered.z;
    if (all > 0.0 && all < 3.0 && kind.z == 0) { // corners that are covered do not count: the nearest layer is not
        w = (w + 1e-6) * (1.0 - covered);
        w /= w.x + w.y + w.z;
    }
    vec3 matt = s.surface.diffuse;
#ifdef RICH
    MaterialLayers over = layers_over(s);
    matt *= over.matt_albedo;
#endif
    vec3 light = matt * exact_diffuse(into_environment(s.surface.shown)) *
                     (w.x * ratios[at.x].rgb + w.y * ratios[at.y].rgb + w.z * ratios[at.z].rgb) +
                 exact_gloss(s) * (w.x * gloss[0].rgb + w.y * gloss[1].rgb + w.z * gloss[2].rgb);
#ifdef RICH
    if ((s.part.flags.x & TRANSMITS) != 0u) {
        corner = 3u * (2u * s.p.triangle + (s.p.back ? 0u : 1u));
        vec3 ratio = vec3(0.0);
        for (int k = 0; k < 3; k++)
            ratio += s.p.weights[k] * ratios[4u * triangle_probes[corner + uint(k)]].rgb;
        light += s.part.transmission.rgb * exact_diffuse(into_environment(-s.surface.shown)) * ratio;
    }
    light = (light + s.emitted) * over.base;
    if (fuzz_strength(over.fuzz) > 0.0)
        light += over.fuzz * exact_fibres(over, s.viewer) *
                 (w.x * ratios[at.x + 2u].rgb + w.y * ratios[at.y + 2u].rgb + w.z * ratios[at.z + 2u].rgb);
    if (over.coat > 0.0)
        light += over.coat * fetch_lobe(lobe_atlas, into_environment(over.coat_axis), log2(over.coat_exponent)) *
                 (w.x * ratios[at.x + 3u].rgb + w.y * ratios[at.y + 3u].rgb + w.z * ratios[at.z + 3u].rgb);
#endif
    vec3 point = point_of(s.p);
    for (int i = 0; i < counts.y; i++) {
        Sun sun = sun_at(i, point, s.surface.shown);
        float facing = s.side * dot(sun.towards, s.surface.smooth_normal);
        float shown = texelFetch(sun_seen, ivec3(pixel, i), 0).r, seen = shown * light_above(sun.is_lamp, sun.radius, facing);
#ifdef RICH
        if ((s.part.flags.x & TRANSMITS) != 0u && facing < 0.0) {
            float through = shown * light_above(sun.is_lamp, sun.radius, -facing) * max(-dot(sun.towards, s.surface.shown), 0.0) / PI;
            light += over.base * through * sun.power * s.part.transmission.rgb;
        }
#endif
        if (!(seen > 0.0))
            continue;
        float cosine = max(dot(sun.towards, s.surface.shown), 0.0);
        vec3 sent = s.surface.diffuse * (cosine / PI), shine = gloss_under(s, sun.towards, sun.radius);
#ifdef RICH
        sent *= material_matt(over, sun.towards);
        light += seen * sun.power * material_over(over, sent + shine, sun.towards, sun.radius);
#else
        light += seen * sun.power * (sent + shine);
#endif
    }
    return light;
}
#endif

void main()
{
    uint tile = tiles[uint(kind.y) + gl_WorkGroupID.x];
    ivec2 pixel = ivec2(tile & 0xffffu, tile >> 16) * 8 + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size.xy)))
        return;
    uint id = texelFetch(ids, pixel, 0).r;
#ifdef NOTHING
    if (id == 0u)
        imageStore(light_image, pixel, vec4(0.0));
#else
    uint part = id != 0u ? triangle_parts[(id & 0x7fffffffu) - 1u] : 0u;
    if ((part >> 16 & 15u) != uint(kind.x))
        return;
    Seen s = see(id, part & 0xfffu, pixel);
    // Nearer layers leave what they do not cover.
    float cover = s.cover * (1.0 - s.part.transmission.w);
    vec4 nearer = kind.z > 0 ? imageLoad(light_image, pixel) : vec4(0.0);
    imageStore(light_image, pixel, nearer + (1.0 - nearer.a) * cover * vec4(light_of(s, pixel), 1.0));
#endif
}
