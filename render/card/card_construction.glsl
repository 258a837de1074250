// Seams, hems and stitches near a point (render/construction/construction.glsl has the same for the G-buffer).
layout(std430, binding = CARD_BORDER_FIRSTS) restrict readonly buffer BorderFirsts
{
    uint border_firsts[];
};
layout(std430, binding = CARD_BORDER_NEAR) restrict readonly buffer BorderNumbers
{
    uint border_numbers[];
};
layout(std430, binding = CARD_BORDERS) restrict readonly buffer Borders
{
    vec4 borders[];
};
layout(std430, binding = CARD_PROFILES) restrict readonly buffer Profiles
{
    vec4 profiles[];
};
vec4 construction_sizes = vec4(0.0), construction_rows = vec4(0.0); // of the part at hand

#include "construction_near.glsl"
