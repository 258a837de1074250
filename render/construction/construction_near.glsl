// Finds what lies near a point of a cloth's construction. The pass provides border_numbers, borders and profiles, and the vectors of
// construction_terms.glsl, which has the formulas.
#include "construction_terms.glsl"

ConstructionProfile construction_profile(float kind, float d)
{
    float place = clamp(d / CONSTRUCTION_STEP, 0.0, float(CONSTRUCTION_LAST) - 0.001);
    int entry = int(kind) * (CONSTRUCTION_LAST + 1) + int(place);
    vec4 v = mix(profiles[entry], profiles[entry + 1], fract(place));
    return ConstructionProfile(v.x, v.y, v.z, v.w);
}

// The nearest seam, hem and dart among the borders with numbers `k` to `last` - 1. across, down: how UV changes from sample
// to sample.
ConstructionLook construction_near(uint k, uint last, vec2 uv, vec2 across, vec2 down)
{
    ConstructionLook sum = construction_none();
    ConstructionPlace seam = construction_far(CONSTRUCTION_REACH), hem = seam, dart = seam;
    float scale = 0.0;
    for (; k < last; k++) {
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
        sum = construction_add(sum, seam, dx.x, dx.y, dy.x, dy.y);
    if (hem.near > 0.0)
        sum = construction_add(sum, hem, dx.x, dx.y, dy.x, dy.y);
    if (dart.near > 0.0)
        sum = construction_add(sum, dart, dx.x, dx.y, dy.x, dy.y);
    return sum;
}
