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

#include "construction_near.glsl"

ConstructionLook sewn = construction_none();

// Sets `sewn` for a triangle, whose number is counted as sewn_first is. across, down: how UV changes from sample to sample.
void sew(uint number, vec2 uv, vec2 across, vec2 down)
{
    sewn = construction_none();
    if (!has_map(MAP_SEWN))
        return;
    uint triangle = number - sewn_first;
    sewn = construction_near(border_firsts[triangle], border_firsts[triangle + 1u], uv, across, down);
}
