// Starts of rays, and their directions from one item after the other, update after update, for GLSL and C (spread.h).
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// The way of a point of a triangle to the tangent plane of a corner, where that lies outside, times the corner's weight: the
// smooth surface is off by the sum of three [Hanika 2021].
TERM vec3 smooth_shift(vec3 point, vec3 corner, vec3 normal, float weight)
{
    return vec3_scale(normal, -weight * min(dot(vec3_subtract(point, corner), normal), 0.0f));
}

// Number i of a sequence that fills the unit square evenly [the R2 sequence of Roberts 2018], begun elsewhere for every
// item. Fixed point: exact at any i.
TERM vec2 spread_place(uint item, uint i)
{
    uint hash = (item + 1u) * 0x9e3779b1u;
    hash = (hash ^ hash >> 15) * 0x85ebca77u;
    uint x = hash + i * 3242174889u, y = (hash ^ hash >> 13) * 0xc2b2ae3du + i * 2447445414u;
    return vec2(float(x >> 8) / 16777216.0f, float(y >> 8) / 16777216.0f);
}
