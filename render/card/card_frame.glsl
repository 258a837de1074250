// Values that all kernels of a frame read (struct tl_card_frame).
#include "card_bindings.glsl"
#include "vectors.glsl"
#include "lobes_terms.glsl"
#include "terms.glsl"
#include "ground.glsl"
#include "lamp_terms.glsl"
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
    ivec4 counts;        // regions, suns with lamps, probes, triangles
    uvec4 numbers;       // probes with bounced light of their own, 1: light bounces, triangles before the ground's
    vec4 suns[8];        // direction, radius; then lamps: direction or position, -1
    vec4 sun_powers[8];  // w: 1: of a position, at 1 m
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

// A sun, or a lamp, as a point sees it.
struct Sun {
    vec3 towards; // unit
    float radius, way; // rad, m
    vec3 power;
    bool is_lamp;
};

Sun sun_at(int i, vec3 point, vec3 otherwise)
{
    vec4 place = vec4(suns[i].xyz, sun_powers[i].w);
    bool is_near = place.w > 0.0;
    return Sun(towards_lamp(place, point, otherwise), max(suns[i].w, 0.0), is_near ? distance(place.xyz, point) : 1e30,
               sun_powers[i].rgb * lamp_falloff(place, point), suns[i].w < 0.0);
}

// The share that the ground leaves of light that comes so far (tl_ground_visibility_to).
float ground_passes_from(vec3 point, vec3 towards, float way)
{
    return ground_way(disc, point, towards) < way * (1.0 - 1e-6) ? ground_passes(disc, point, towards) : 1.0;
}
