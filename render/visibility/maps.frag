#version 450 core
// The values that a shadow map keeps of a surface. Variants: MOMENTS, of a variance shadow map [Donnelly and Lauritzen
// 2006], or else its depth alone; MASKED, for parts with holes (apart, because a discard costs the early depth test and
// more than half the speed).
#include "surface.glsl" // its uniforms are set for every program that draws surfaces

#ifdef MASKED
in vec2 uv;
#endif
#ifdef MOMENTS
in float depth;
layout(location = 0) out vec2 moments;
#endif

void main()
{
#ifdef MASKED
    if (surface_cut_away(surface_colour(uv).a))
        discard;
#endif
#ifdef MOMENTS
    moments = vec2(depth, depth * depth);
#endif
}
