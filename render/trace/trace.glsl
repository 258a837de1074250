// Rays through a tree of boxes (tree.h) that refit.comp has fitted. Both sides of every triangle are hit. What includes
// this may #define TREE_BINDING; two storage buffers are bound from there on (tl_tree_buffers_bind). With HOLES_BINDING
// rays pass through holes.
//
// Edges are those of Embree [Wald et al. 2014]: two triangles compute the same number for the edge that they share, with
// other signs, so that no ray passes between them.
#include "tree_terms.glsl"
#ifdef HOLES_BINDING
#include "holes.glsl"
#endif
#ifndef TREE_BINDING
#define TREE_BINDING 0
#endif
layout(std430, binding = TREE_BINDING) restrict readonly buffer TreeNodes { uvec4 tree_nodes[]; }; // [nodes][5]: see refit.comp
// [places][3]: corners; beside the first the triangle's number, beside the second its openness
layout(std430, binding = TREE_BINDING + 1) restrict readonly buffer TreeTriangles { vec4 tree_triangles[]; };

const uint TREE_NO_TRIANGLE = 0xffffffffu;
struct TreeHit {
    float distance; // in units of the direction's length
    uint triangle;  // TREE_NO_TRIANGLE: none
    float u, v;     // weights of its second and third corner
    bool back;      // its back was hit
    float open;     // what is left of a ray that passes through open triangles
};
const int TREE_NEAREST = 0, TREE_ANY = 1, TREE_THROUGH = 2;

// Positive on one side of the edge, negative on the other. Not contracted: neighbours must round alike.
float tree_edge(vec3 p, vec3 q, vec3 direction)
{
    precise vec3 along = p - q, both = p + q;
    precise vec3 normal = cross(along, both);
    precise float side = dot(normal, direction);
    return side;
}

bool tree_hits_triangle(uint place, vec3 origin, vec3 direction, float from, inout TreeHit hit)
{
    const vec4 first = tree_triangles[3u * place], second = tree_triangles[3u * place + 1u];
    const vec3 a = first.xyz - origin, b = second.xyz - origin, c = tree_triangles[3u * place + 2u].xyz - origin;
    const float u = tree_edge(c, a, direction), v = tree_edge(a, b, direction), w = tree_edge(b, c, direction);
    const float sum = u + v + w, slack = 1.1920929e-7 * abs(sum);
    const vec3 normal = cross(b - a, c - a);
    const float facing = dot(normal, direction), distance = dot(normal, a) / facing;
    const bool is_inside = max(u, max(v, w)) <= slack || min(u, min(v, w)) >= -slack;
    if (!is_inside || facing == 0.0 || !(distance >= from && distance <= hit.distance))
        return false;
#ifdef HOLES_BINDING
    if (is_hole(floatBitsToUint(first.w), vec3(w, u, v) / sum))
        return false;
#endif
    hit.distance = distance;
    hit.triangle = floatBitsToUint(first.w);
    hit.u = u / sum;
    hit.v = v / sum;
    hit.back = facing > 0.0;
    hit.open = second.w;
    return true;
}

// Distances to four planes.
vec4 tree_planes(uint bytes, float a_step, float start)
{
    return vec4(bytes & 255u, bytes >> 8 & 255u, bytes >> 16 & 255u, bytes >> 24) * a_step + start;
}

// The children that a ray meets between two distances, as bits: 24 to 31 nodes by slot, 0 to 23 triangles of leaves.
// Rounding moves a plane by 2^-22 of its distance and by 2^-22 of the node's side at most: the factor makes up for the
// one, the margin of the boxes (refit.comp) for the other.
uint tree_hits_children(uint node, vec3 origin, vec3 inverse, float from, float to)
{
    const uvec4 head = tree_nodes[node], more = tree_nodes[node + 1u];
    const uvec4 low_xy = tree_nodes[node + 2u], low_z_high_x = tree_nodes[node + 3u], high_yz = tree_nodes[node + 4u];
    const vec3 steps = uintBitsToFloat((uvec3(head.w, head.w >> 8, head.w >> 16) & 255u) << 23) * inverse;
    const vec3 start = (uintBitsToFloat(head.xyz) - origin) * inverse;
    const bvec3 turned = lessThan(inverse, vec3(0.0));
    const uvec4 near_xy = uvec4(turned.x ? low_z_high_x.zw : low_xy.xy, turned.y ? high_yz.xy : low_xy.zw);
    const uvec4 far_xy = uvec4(turned.x ? low_xy.xy : low_z_high_x.zw, turned.y ? low_xy.zw : high_yz.xy);
    const uvec4 near_far_z = turned.z ? uvec4(high_yz.zw, low_z_high_x.xy) : uvec4(low_z_high_x.xy, high_yz.zw);
    uint hits = 0u;
    for (int word = 0; word < 2; word++) {
        const vec4 near_x = tree_planes(near_xy[word], steps.x, start.x), far_x = tree_planes(far_xy[word], steps.x, start.x);
        const vec4 near_y = tree_planes(near_xy[2 + word], steps.y, start.y), far_y = tree_planes(far_xy[2 + word], steps.y, start.y);
        const vec4 near_z = tree_planes(near_far_z[word], steps.z, start.z), far_z = tree_planes(near_far_z[2 + word], steps.z, start.z);
        const vec4 near = max(max(near_x, near_y), max(near_z, vec4(from)));
        const vec4 far = min(min(far_x, far_y), min(far_z, vec4(to)));
        const bvec4 is_hit = lessThanEqual(near, far * 1.000001);
        for (int k = 0; k < 4; k++) {
            const uint meta = more[2 + word] >> 8 * k & 255u;
            hits |= is_hit[k] ? (meta >> 5) << (meta & 31u) : 0u;
        }
    }
    return hits;
}

// The slot among `slots` that lies first along the ray: slots are corners of the node.
uint tree_first_slot(uint slots, uint octant)
{
    uint first = 8u;
    for (uint left = slots; left != 0u; left &= left - 1u)
        first = min(first, uint(findLSB(left)) ^ octant);
    return first ^ octant;
}

// TREE_NEAREST: the nearest hit. TREE_ANY: any one. TREE_THROUGH: any one of a closed triangle, and else what the open
// ones leave. `what` is a constant wherever this is called, so that compilers leave out the other ways.
TreeHit tree_walk(uint root, vec3 origin, vec3 direction, float from, float to, int what)
{
    // A direction along an axis: so short a slope leaves each box where it is.
    const vec3 slope_min = vec3(1e-20);
    const vec3 inverse = 1.0 / mix(direction, mix(slope_min, -slope_min, lessThan(direction, vec3(0.0))), lessThan(abs(direction), slope_min));
    const uint octant = uint(direction.x < 0.0) | uint(direction.y < 0.0) << 1 | uint(direction.z < 0.0) << 2;
    TreeHit hit = TreeHit(to, TREE_NO_TRIANGLE, 0.0, 0.0, false, 1.0);
    uvec2 stack[TL_TREE_LEVELS_MAX]; // first child, and its siblings: those to be visited, below all that are nodes
    int height = 0;
    uint first_child = root, slots = 1u, all_slots = 1u; // as if it were an only child
    for (;;) {
        const uint slot = what == TREE_NEAREST ? tree_first_slot(slots, octant) : uint(findLSB(slots));
        slots &= ~(1u << slot);
        if (slots != 0u)
            stack[height++] = uvec2(first_child, slots | all_slots << 8);
        const uint node = 5u * (first_child + uint(bitCount(all_slots & (1u << slot) - 1u)));
        const uint hits = tree_hits_children(node, origin, inverse, from, hit.distance);
        const uvec2 heads = tree_nodes[node + 1u].xy;
        for (uint left = hits & 0xffffffu; left != 0u; left &= left - 1u) {
            const uint place = heads.y + uint(findLSB(left));
            if (what == TREE_NEAREST) {
                tree_hits_triangle(place, origin, direction, from, hit);
            } else {
                TreeHit other = hit;
                if (tree_hits_triangle(place, origin, direction, from, other)) {
                    hit.open *= what == TREE_ANY ? 0.0 : other.open;
                    if (hit.open <= 0.0)
                        return hit;
                }
            }
        }
        first_child = heads.x;
        slots = hits >> 24;
        all_slots = tree_nodes[node].w >> 24;
        if (slots == 0u) {
            if (height == 0)
                return hit;
            height--;
            first_child = stack[height].x;
            slots = stack[height].y & 255u;
            all_slots = stack[height].y >> 8;
        }
    }
    return hit;
}

// Those that cast shadows; and all, as a camera sees them.
TreeHit tree_nearest(vec3 origin, vec3 direction, float from, float to)
{
    return tree_walk(TL_TREE_CASTERS, origin, direction, from, to, TREE_NEAREST);
}
TreeHit tree_seen(vec3 origin, vec3 direction, float from, float to)
{
    return tree_walk(TL_TREE_ALL, origin, direction, from, to, TREE_NEAREST);
}
bool tree_occluded(vec3 origin, vec3 direction, float from, float to)
{
    return tree_walk(TL_TREE_CASTERS, origin, direction, from, to, TREE_ANY).open <= 0.0;
}
// The product of the openness of all casters that are hit, 0 where one is closed.
float tree_transmittance(vec3 origin, vec3 direction, float from, float to)
{
    return tree_walk(TL_TREE_CASTERS, origin, direction, from, to, TREE_THROUGH).open;
}
