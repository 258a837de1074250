// The heights that seams, hems and stitches add to a sample, from the borders near its triangle (assets/topology/borders.h). The pass sets
// `sewn` before it reads the material; construction_terms.glsl has the formulas.
#include "surface.glsl"

layout(std430, binding = 4) readonly buffer BorderFirsts
{
    uint border_firsts[];
};
layout(std430, binding = 5) readonly buffer BorderNumbers
{
    uint border_numbers[];
};
layout(std430, binding = 6) readonly buffer Borders
{
    vec4 borders[]; // two of each: from, to; length at from, metres of a UV unit, widest hem, kind
};
layout(std430, binding = 7) readonly buffer Profiles
{
    vec4 profiles[];
};

#include "construction_terms.glsl"

ConstructionProfile construction_profile(float kind, float d)
{
    float place = clamp(d / CONSTRUCTION_STEP, 0.0, float(CONSTRUCTION_LAST) - 0.001);
    int entry = int(kind) * (CONSTRUCTION_LAST + 1) + int(place);
    vec4 v = mix(profiles[entry], profiles[entry + 1], fract(place));
    return ConstructionProfile(v.x, v.y, v.z, v.w);
}

ConstructionLook sewn = construction_none();

// Finds the nearest seam, hem and dart of a triangle, whose number is counted as sewn_first is, and sets `sewn`.
// across, down: how UV changes from sample to sample.
void sew(uint number, vec2 uv, vec2 across, vec2 down)
{
    sewn = construction_none();
    if (!has_map(MAP_SEWN))
        return;
    ConstructionPlace seam = construction_far(CONSTRUCTION_REACH), hem = seam, dart = seam;
    float scale = 0.0;
    uint triangle = number - sewn_first, last = border_firsts[triangle + 1u];
    for (uint k = border_firsts[triangle]; k < last; k++) {
        vec4 ends = borders[2u * border_numbers[k]], more = borders[2u * border_numbers[k] + 1u];
        scale = more.y;
        vec2 at = scale * vec2(uv.x, -uv.y), from = scale * vec2(ends.x, -ends.y), to = scale * vec2(ends.z, -ends.w);
        if (more.w == CONSTRUCTION_HEM)
            hem = construction_nearer(hem, at.x, at.y, from.x, from.y, to.x, to.y, more.x, more.z, more.w);
        else if (more.w == CONSTRUCTION_DART)
            dart = construction_nearer(dart, at.x, at.y, from.x, from.y, to.x, to.y, more.x, more.z, more.w);
        else
            seam = construction_nearer(seam, at.x, at.y, from.x, from.y, to.x, to.y, more.x, more.z, more.w);
    }
    vec2 dx = scale * vec2(across.x, -across.y), dy = scale * vec2(down.x, -down.y);
    if (seam.near > 0.0)
        sewn = construction_add(sewn, seam, dx.x, dx.y, dy.x, dy.y);
    if (hem.near > 0.0)
        sewn = construction_add(sewn, hem, dx.x, dx.y, dy.x, dy.y);
    if (dart.near > 0.0)
        sewn = construction_add(sewn, dart, dx.x, dx.y, dy.x, dy.y);
}
