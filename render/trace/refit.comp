#version 450 core
// Fits one level of a tree (tree.h) to the positions of a mesh, the levels below being fitted: eight threads a node,
// one a child. Writes nodes of 80 bytes [Ylitie et al. 2017, 3] and the corners of triangles.
//
// A node's words: 0 to 2 its low corner, floats; 3 the exponents of its steps along the axes in bytes, and the mask of
// the slots that hold nodes; 4 the first of these; 5 the first place of its triangles; 6, 7 a byte a child: a unary
// count above the five bits of its place among the node's triangles, or, of a node, 1 above 24 + its slot; 8 to 19 a
// byte a child: low x, y, z and high x, y, z, in steps.
#include "tree_terms.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) restrict readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) restrict readonly buffer Corners { uint corners[]; };   // [triangles][3]
layout(std430, binding = 2) restrict readonly buffer Children { uint children[]; }; // [nodes][8]
layout(std430, binding = 3) restrict readonly buffer Heads { uint heads[]; };       // [nodes][2]
layout(std430, binding = 4) restrict readonly buffer Order { uvec2 order[]; };      // triangle, its openness
layout(std430, binding = 5) restrict buffer Boxes { vec4 boxes[]; };                // [nodes][low, high]
layout(std430, binding = 6) restrict writeonly buffer Nodes { uvec4 nodes[]; };     // [nodes][5]
layout(std430, binding = 7) restrict writeonly buffer Triangles { vec4 triangles[]; }; // [places][3]: see trace.glsl
layout(location = 0) uniform uvec2 level; // its first node, and how many

const uint WORDS = 20u; // of a node
const float NOWHERE = 3e38;
// Steps of a node's side; less than a byte has, so that what is rounded up has a place.
const float STEPS = 254.0;
// Boxes are larger by this share of a step: trace.glsl rounds 2^-22 of a node's side, 6e-5 of a step.
const float MARGIN = 0.001;

shared vec3 lows[64], highs[64];
shared uint words[8u * WORDS];

vec3 corner(uint triangle, uint k)
{
    const uint v = 3u * corners[3u * triangle + k];
    return vec3(positions[v], positions[v + 1u], positions[v + 2u]);
}

void fit_leaf(uint place, uint count, inout vec3 low, inout vec3 high)
{
    for (uint i = place; i < place + count; i++) {
        const vec3 a = corner(order[i].x, 0u), b = corner(order[i].x, 1u), c = corner(order[i].x, 2u);
        triangles[3u * i] = vec4(a, uintBitsToFloat(order[i].x));
        triangles[3u * i + 1u] = vec4(b, uintBitsToFloat(order[i].y));
        triangles[3u * i + 2u] = vec4(c, 0.0);
        low = min(low, min(a, min(b, c)));
        high = max(high, max(a, max(b, c)));
    }
}

// The exponent, with GL's bias, of the smallest power of two that is larger than each.
uvec3 exponents_above(vec3 steps)
{
    return (floatBitsToUint(steps) >> 23) + 1u;
}

void put_byte(uint word, uint slot, float value)
{
    atomicOr(words[word + (slot >> 2)], uint(clamp(value, 0.0, 255.0)) << 8u * (slot & 3u));
}

void main()
{
    const uint thread = gl_LocalInvocationID.x, slot = thread % 8u, first_thread = thread - slot;
    const uint base = first_thread / 8u * WORDS;
    const uint index = gl_WorkGroupID.x * 8u + first_thread / 8u, node = level.x + index;
    const bool is_node = index < level.y;
    const uint child = is_node ? children[8u * node + slot] : TL_TREE_NO_CHILD;
    const bool is_leaf = child != TL_TREE_NO_CHILD && (child & TL_TREE_LEAF) != 0u;
    const bool is_inner = child != TL_TREE_NO_CHILD && !is_leaf;
    const uint place = child & TL_TREE_PLACE, count = (child & ~TL_TREE_LEAF) >> TL_TREE_COUNT_SHIFT;
    const uint first_place = is_node ? heads[2u * node + 1u] : 0u;
    vec3 low = vec3(NOWHERE), high = vec3(-NOWHERE);
    if (is_leaf) {
        fit_leaf(place, count, low, high);
    } else if (is_inner) {
        low = boxes[2u * child].xyz;
        high = boxes[2u * child + 1u].xyz;
    }
    lows[thread] = low;
    highs[thread] = high;
    for (uint i = thread; i < 8u * WORDS; i += 64u)
        words[i] = 0u;
    barrier();

    vec3 node_low = vec3(NOWHERE), node_high = vec3(-NOWHERE);
    for (uint i = first_thread; i < first_thread + 8u; i++) {
        node_low = min(node_low, lows[i]);
        node_high = max(node_high, highs[i]);
    }
    const uvec3 exponents = exponents_above(max(node_high - node_low, vec3(1e-20)) / STEPS);
    if (is_leaf || is_inner) {
        const vec3 a_step = uintBitsToFloat((254u - exponents) << 23); // steps of a metre
        const vec3 from = floor((low - node_low) * a_step - MARGIN), to = ceil((high - node_low) * a_step + MARGIN);
        put_byte(base + 6u, slot, is_leaf ? float(((1u << count) - 1u) << 5 | place - first_place) : float(32u | 24u + slot));
        for (uint axis = 0u; axis < 3u; axis++) {
            put_byte(base + 8u + 2u * axis, slot, from[axis]);
            put_byte(base + 14u + 2u * axis, slot, to[axis]);
        }
        if (is_inner)
            atomicOr(words[base + 3u], 1u << 24u + slot);
    }
    if (slot == 0u && is_node) {
        for (uint axis = 0u; axis < 3u; axis++) {
            words[base + axis] = floatBitsToUint(node_low[axis]);
            atomicOr(words[base + 3u], exponents[axis] << 8u * axis);
        }
        words[base + 4u] = heads[2u * node];
        words[base + 5u] = first_place;
        boxes[2u * node] = vec4(node_low, 0.0);
        boxes[2u * node + 1u] = vec4(node_high, 0.0);
    }
    barrier();
    if (slot < 5u && is_node) {
        const uint word = base + 4u * slot;
        nodes[5u * node + slot] = uvec4(words[word], words[word + 1u], words[word + 2u], words[word + 3u]);
    }
}
