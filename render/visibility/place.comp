#version 450 core
// Places the origin of each listed probe's rays, and notes whether something lies close above it (refresh.c:
// place_members, lift).
#include "card_points.glsl"
#include "visibility_terms.glsl"
#define TREE_BINDING CARD_TREE
#define HOLES_BINDING CARD_HOLES
#include "trace.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = CARD_POSITIONS) restrict readonly buffer Positions { float positions[]; };
layout(std430, binding = CARD_NORMALS) restrict readonly buffer Normals { float normals[]; };
layout(std430, binding = CARD_FACTS) restrict readonly buffer Facts { uint facts[]; };
layout(std430, binding = CARD_PROBES) restrict readonly buffer Probes { uvec2 probes[]; };
layout(std430, binding = CARD_LIST) restrict readonly buffer List { uint list[]; };
layout(std430, binding = CARD_WORK) restrict readonly buffer Work { uint work[]; };
layout(std430, binding = CARD_ORIGINS) restrict writeonly buffer Origins { vec4 origins[]; };
layout(location = 0) uniform float offset;

uint surface_of(TreeHit hit)
{
    return facts[hit.triangle] & ~CARD_TRANSMITS;
}

// Moves a point out of a body that it lies slightly inside: rays both ways then hit the back of the same other surface.
bool lift(inout vec3 origin, vec3 normal, uint surface, float cover)
{
    const TreeHit above = tree_nearest(origin, normal, 0.0, cover);
    if (above.triangle == TREE_NO_TRIANGLE || !above.back || surface_of(above) == surface)
        return false;
    const TreeHit below = tree_nearest(origin - 2.0 * offset * normal, -normal, 0.0, 1e30);
    if (below.triangle == TREE_NO_TRIANGLE || !below.back || surface_of(below) != surface_of(above))
        return false;
    origin += normal * (above.distance + offset);
    return true;
}

void main()
{
    const uint at = gl_GlobalInvocationID.x;
    if (at >= work[CARD_LISTED])
        return;
    const uvec2 probe = probes[list[at]];
    const uint v = 3u * (probe.x & ~CARD_BACK);
    const vec3 outside = vec3(normals[v], normals[v + 1u], normals[v + 2u]);
    const vec3 normal = (probe.x & CARD_BACK) != 0u ? -outside : outside;
    vec3 origin = vec3(positions[v], positions[v + 1u], positions[v + 2u]) + normal * offset;
    const float cover = float(TL_COVER_OFFSETS) * offset;
    // A vertex without a normal has no outside from which to trace.
    bool is_covered = normal == vec3(0.0);
    if (!is_covered && tree_occluded(origin, normal, 0.0, cover))
        is_covered = !lift(origin, normal, probe.y, cover);
    origins[2u * at] = vec4(origin, is_covered ? 1.0 : 0.0);
    origins[2u * at + 1u] = vec4(normal, 0.0);
}
