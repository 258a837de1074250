// Values that all kernels of a frame read (struct tl_card_frame).
#include "card_bindings.glsl"
#include "vectors.glsl"
#include "lobes_terms.glsl"
#include "terms.glsl"
#include "ground.glsl"
layout(std140, binding = 0) uniform FrameValues
{
    mat4 view_projection;
    vec4 eye;            // w: where rays start above a surface, m
    vec4 ray_first;      // the ray through pixel (0, 0), not unit
    vec4 ray_across;     // its change to the pixel on the right
    vec4 ray_up;         // ... and above
    vec4 disc;           // of the ground: centre, radius; 0: none
    vec4 turn;           // cosine and sine of the environment's yaw
    ivec4 size;          // width, height, tiles across, tiles up
    ivec4 counts;        // regions, suns, probes, triangles
    uvec4 numbers;       // probes with bounced light of their own, 1: light bounces
    vec4 suns[4];        // direction, radius
    vec4 sun_powers[4];
    vec4 sun_places[64]; // [4][16] directions of places of each, those farthest apart first
    vec4 lobe_maps[33];  // first texel in the atlases, side
};

const float PI = 3.14159265;

// A world direction in the environment's frame, and back.
vec3 into_environment(vec3 d)
{
    return turned_direction(turn.x, turn.y, d);
}

vec3 out_of_environment(vec3 d)
{
    return turned_direction(turn.x, -turn.y, d);
}

// a / b by channel; 1 where there is no light at all.
vec3 share_of(vec3 part, vec3 all)
{
    return mix(vec3(1.0), part / max(all, 1e-30), greaterThan(all, vec3(0.0)));
}
