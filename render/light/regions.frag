#version 450 core
// All regions and suns in one pass. Two sums a lobe of the material are kept: the light of all regions, and that part
// of it which is seen. What they are made of depends on the source:
//
//     SLICES  P_i(d, s), exactly filtered
//     LOBES   power_i K_s(d, d_i), the lobe broadened by the region's spread
//     EXACT   nothing: unshadowed light alone
//
// and the light that comes of them on `composition` (light.h).
#include "exact.glsl"
#include "sample.glsl"
#ifdef SLICES
#include "slices.glsl"
#endif
#include "visibility.glsl"

const int LOBE_SINGLE = 0;
const int SUM = 0, DIFFERENCE = 1, RATIO = 2, OCCLUSION = 3, OCCLUSION_COLOUR = 4, UNSHADOWED = 5;

layout(location = 0) uniform ivec2 counts; // regions, suns: these come after them
layout(location = 4) uniform int lobe;
layout(location = 5) uniform int composition;

layout(binding = 9) uniform sampler2DArrayShadow sun_maps;

layout(location = 0) out vec4 light;

struct Lobe {
    vec3 direction; // world
    float exponent;
};

// Light that arrives through the diffuse and the glossy lobe.
struct Light {
    vec3 diffuse, glossy;
};

Light lobe_light(Region region, vec3 normal, Lobe gloss)
{
    float sine = region.centre.w, exponent = lobe_broadened_exponent(gloss.exponent, region.power.w);
    float facing = disc_cosine(dot(normal, region.centre.xyz), sine);
    float shining = disc_cosine(dot(gloss.direction, region.centre.xyz), sine);
    return Light(0.31830989 * facing * region.power.rgb, lobe_cosine(exponent, shining) * region.power.rgb);
}

// Nothing is shadowed where nothing shines.
vec3 share_seen(vec3 seen, vec3 all)
{
    return mix(vec3(1.0), seen / max(all, vec3(1e-30)), greaterThan(all, vec3(1e-30)));
}

// The regions' light, composed; and their exact light, unshadowed.
Light compose(Light seen, Light all, Light exact)
{
    if (composition == SUM)
        return seen;
    if (composition == DIFFERENCE)
        return Light(max(exact.diffuse - (all.diffuse - seen.diffuse), vec3(0.0)),
                     max(exact.glossy - (all.glossy - seen.glossy), vec3(0.0)));
    return Light(exact.diffuse * share_seen(seen.diffuse, all.diffuse),
                 exact.glossy * share_seen(seen.glossy, all.glossy));
}

void main()
{
    Sample place = read_sample(ivec2(gl_FragCoord.xy));
    Lobe gloss = Lobe(place.mirror, 1.0 / max(1.0 - place.glossiness, 1e-6));
    if (lobe == LOBE_SINGLE) // the two lobes as one, its direction and colour between diffuse and mirror
        gloss.direction = normalize(mix(place.normal, place.mirror, place.glossiness));
    float level = exponent_level(gloss.exponent);
    vec3 d = into_environment(place.normal), m = into_environment(gloss.direction);
    Light exact = Light(exact_light(d, 0.0), exact_light(m, level));

    Light all = Light(vec3(0.0), vec3(0.0)), seen = all;
#ifndef EXACT
    for (int i = 0; i < counts.x; i++) {
        Region region = regions[i];
        float vis = visibility(i, region, place.point, place.smooth_normal);
#ifdef SLICES
        Light part = Light(slice_fetch(i, d, 0.0), slice_fetch(i, m, level));
#else
        Light part = lobe_light(region, place.normal, gloss);
#endif
        all.diffuse += part.diffuse;
        all.glossy += part.glossy;
        // A part's own mean over the region holds its share below the horizon already, as visibility does again. Rounds
        // know better: what is seen along this direction is weighed by its own cosine.
        float facing = 0.31830989 * max(dot(place.normal, region.direction.xyz), 0.0);
        seen.diffuse += vis * mix(part.diffuse, facing * region.power.rgb, region.direction.w);
        seen.glossy += vis * part.glossy;
    }
#endif
    Light unshadowed = exact, shadowed = exact;
    if (composition != UNSHADOWED)
        shadowed = compose(seen, all, exact);
    for (int i = 0; i < counts.y; i++) {
        Region sun = regions[counts.x + i];
        Light part = lobe_light(sun, place.normal, gloss);
        float vis = composition == UNSHADOWED
                        ? 1.0
                        : depth_visibility(sun_maps, i, sun, place.point, place.smooth_normal);
        unshadowed = Light(unshadowed.diffuse + part.diffuse, unshadowed.glossy + part.glossy);
        shadowed = Light(shadowed.diffuse + vis * part.diffuse, shadowed.glossy + vis * part.glossy);
    }
    if (composition == OCCLUSION || composition == OCCLUSION_COLOUR) {
        vec3 share = composition == OCCLUSION ? share_seen(seen.diffuse, all.diffuse)
                                              : share_seen(shadowed.diffuse, unshadowed.diffuse);
        shadowed = Light(share * unshadowed.diffuse, share * unshadowed.glossy);
    }
    vec3 colour = lobe == LOBE_SINGLE ? mix(place.kd, place.ks, place.glossiness) * shadowed.glossy
                                      : place.kd * shadowed.diffuse + place.ks * shadowed.glossy;
    light = vec4(colour * place.cover, 0.0);
}
