#version 450 core
// Traces the light that bounces to a probe (render/bounce/bounce_rays.c): sixteen rays over its hemisphere, eight towards bright
// parts of the sky, one to each sun and lamp; two probes a group, thirty-two threads each. Every N-th probe with light of its
// own in a frame.
#include "card_frame.glsl"
#include "card_geometry.glsl"
#define TREE_BINDING CARD_NODES
#define HOLES_BINDING CARD_HOLES
#include "trace.glsl"
#include "card_lobes.glsl"
#include "bounced_terms.glsl"
#include "spread_terms.glsl"
#include "directions_terms.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = CARD_TANGENTS) restrict readonly buffer Tangents
{
    vec4 tangents[];
};
layout(std430, binding = CARD_OWN) restrict readonly buffer Own
{
    uint own[];
};
layout(std430, binding = CARD_PROBES) restrict readonly buffer Probes
{
    uvec2 probes[];
};
layout(std430, binding = CARD_TRIANGLE_PROBES) restrict readonly buffer TriangleProbes
{
    uint triangle_probes[];
};
layout(std430, binding = CARD_FOUND) restrict writeonly buffer Found
{
    vec4 found[];
};
layout(std430, binding = CARD_SENT) restrict readonly buffer Sent
{
    vec4 sent[];
};
layout(std430, binding = CARD_SENT_NOW) restrict writeonly buffer SentNow
{
    vec4 sent_now[];
};
layout(std430, binding = CARD_VERTEX_PARTS) restrict readonly buffer VertexParts
{
    uint vertex_parts[];
};
layout(std430, binding = CARD_ALBEDOS) restrict readonly buffer Albedos
{
    vec4 albedos[];
};
layout(std430, binding = CARD_SKY) restrict readonly buffer Sky
{
    vec4 sky[];
};
layout(location = 0) uniform uvec3 due; // first, step, count of `own`

const uint RAYS = 16u, SKY_RAYS = 8u; // TL_BOUNCE_RAYS, TL_BOUNCE_SKY_RAYS
const int SKY_SIZE = 32, SKY_COUNT = 6 * SKY_SIZE * SKY_SIZE;

// Results of each thread's ray: what comes by it times its weight, its direction, whether what it met is known, the sky by the
// cosine as it is seen and all of it, and the sun's light.
shared vec3 light_of[64], way_of[64], open_of[64], all_of[64], sun_of[64];
shared float cosine_of[64];
shared uint known_of[64];

// ---- The sky (render/bounce/bounce_sky.c) ----

float sky_sum(int i)
{
    return i > 0 ? sky[i - 1].w : 0.0;
}

// The light of the sky from a direction in its frame by the weight of both ways in which rays are chosen.
vec3 weighted_sky(vec3 d, float cosine)
{
    vec3 colour = sky[cube_texel(d, SKY_SIZE)].rgb;
    float pdf = dot(colour, vec3(0.2126, 0.7152, 0.0722)) / max(sky_sum(SKY_COUNT), 1e-20);
    return colour * (cosine / (float(RAYS) * bounce_pdf(cosine) + float(SKY_RAYS) * pdf));
}

bool sky_sample(vec2 at, out vec3 d)
{
    float all = sky_sum(SKY_COUNT), wanted = at.x * all;
    int low = 0, high = SKY_COUNT;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        low = sky_sum(middle) <= wanted ? middle : low;
        high = low == middle ? high : middle;
    }
    float along = (wanted - sky_sum(low)) / max(sky_sum(low + 1) - sky_sum(low), 1e-20);
    d = normalize(cube_direction(low / (SKY_SIZE * SKY_SIZE), (float(low % SKY_SIZE) + along) / float(SKY_SIZE),
                                 (float(low / SKY_SIZE % SKY_SIZE) + at.y) / float(SKY_SIZE)));
    return all > 0.0;
}

// ---- Hits ----

// Radiance that a place of the ground's mesh sends: between two rings and two segments.
vec3 sent_by_ground(vec3 point)
{
    vec2 at = ground_place(disc, point.x, point.z);
    uint r = uint(min(at.x, 30.999)), s = uint(at.y) % 48u, next = (s + 1u) % 48u, first = numbers.x;
    float across = fract(at.y);
    vec3 inner = sent[own[first]].rgb, outer = mix(sent[own[first + 1u + r * 48u + s]].rgb, sent[own[first + 1u + r * 48u + next]].rgb, across);
    if (r > 0u)
        inner = mix(sent[own[first + 1u + (r - 1u) * 48u + s]].rgb, sent[own[first + 1u + (r - 1u) * 48u + next]].rgb, across);
    return mix(inner, outer, min(at.x - float(r), 1.0));
}

struct Arrival {
    vec3 light; // by the ray, over its pdf
    float open; // the share of the sky that is seen by it
    bool is_known;
};

Arrival follow(vec3 o, vec3 d, float cosine)
{
    float way = ground_way(disc, o, d), to = way >= 0.0 && disc.w > 0.0 ? way : 1e30;
    Arrival found = Arrival(vec3(0.0), 1.0, true);
    float from = 0.0;
    for (int layer = 0; layer <= 4 && found.open > 0.0; layer++) { // TL_TRANSPARENCY_LAYERS
        TreeHit hit = tree_nearest(o, d, from, to);
        if (hit.triangle == TREE_NO_TRIANGLE)
            break;
        float share = layer < 4 ? hit.open : 0.0;
        uint side = 3u * (2u * hit.triangle + (hit.back ? 1u : 0u));
        vec4 sum = (1.0 - hit.u - hit.v) * sent[triangle_probes[side]] + hit.u * sent[triangle_probes[side + 1u]] +
                   hit.v * sent[triangle_probes[side + 2u]];
        bool is_known = sum.w > 0.1;
        found.is_known = found.is_known && is_known;
        found.light += is_known ? found.open * (1.0 - share) * sum.rgb / (sum.w * bounce_pdf(cosine)) : vec3(0.0);
        found.open *= share;
        from = hit.distance + eye.w;
    }
    if (found.open > 0.0 && to < 1e29) {
        vec3 point = o + d * to;
        float cover = ground_opacity(disc, point.x, point.z);
        if (cover > 0.0)
            found.light += sent_by_ground(point) * (found.open * cover / bounce_pdf(cosine));
        found.open *= 1.0 - cover;
    }
    return found;
}

void trace(uint at, uint vertex, uint ray, vec3 n, vec3 o)
{
    uint thread = gl_LocalInvocationID.x;
    vec3 d = n;
    light_of[thread] = open_of[thread] = all_of[thread] = sun_of[thread] = vec3(0.0);
    cosine_of[thread] = 1.0;
    known_of[thread] = 0u;
    if (ray < RAYS) {
        vec2 place = spread_place(at, ray);
        d = bounce_direction(n, tangents[vertex].xyz, place.x, place.y);
        float cosine = dot(n, d);
        Arrival found = follow(o, d, cosine);
        vec3 sky_light = weighted_sky(into_environment(d), cosine);
        light_of[thread] = found.light;
        all_of[thread] = sky_light;
        open_of[thread] = found.is_known ? sky_light * found.open : vec3(0.0);
        cosine_of[thread] = cosine;
        known_of[thread] = found.is_known ? 1u : 0u;
    } else if (ray < RAYS + SKY_RAYS) {
        vec2 place = spread_place(~at, ray - RAYS);
        vec3 in_sky;
        place.x = (float(ray - RAYS) + place.x) / float(SKY_RAYS);
        if (sky_sample(place, in_sky)) {
            d = out_of_environment(in_sky);
            float cosine = dot(n, d);
            if (cosine > 0.0) {
                float share = ground_passes(disc, o, d);
                all_of[thread] = weighted_sky(in_sky, cosine);
                open_of[thread] = share > 0.0 ? all_of[thread] * share * tree_transmittance(o, d, 0.0, 1e30) : vec3(0.0);
            }
        }
    } else if (ray < RAYS + SKY_RAYS + uint(counts.y)) {
        Sun sun = sun_at(int(ray - RAYS - SKY_RAYS), o, n);
        d = sun.towards;
        float cosine = dot(n, d), share = cosine > 0.0 ? ground_passes_from(o, d, sun.way) : 0.0;
        if (share > 0.0)
            sun_of[thread] = sun.power * (share * tree_transmittance(o, d, 0.0, sun.way) * cosine / PI);
    }
    way_of[thread] = d;
}

// ---- Sums ----

// One term of the harmonics of what arrives.
vec3 sum_term(uint first, uint term, float mean)
{
    vec3 sum = vec3(0.0);
    for (uint k = first; k < first + RAYS; k++) {
        float basis[BOUNCED_TERMS], b = 0.0;
        bounced_basis(way_of[k], basis);
        for (int i = 0; i < BOUNCED_TERMS; i++)
            b = i == int(term) ? basis[i] : b;
        sum += light_of[k] * b;
    }
    return sum * mean;
}

// Sums up all that arrives, and what the probe sends on.
void sum_up(uint probe, uint vertex, bool back, uint first, float mean, vec3 n)
{
    vec3 arrives = vec3(0.0), open = vec3(0.0), all = vec3(0.0), sunlight = vec3(0.0);
    for (uint k = first; k < first + RAYS; k++)
        arrives += light_of[k] * (cosine_of[k] / PI);
    for (uint k = first; k < first + RAYS + SKY_RAYS; k++) {
        open += open_of[k];
        all += all_of[k];
    }
    for (uint k = first + RAYS + SKY_RAYS; k < first + RAYS + SKY_RAYS + uint(counts.y); k++)
        sunlight += sun_of[k];
    arrives *= mean;
    vec3 lit = exact_diffuse(into_environment(n)) * share_of(open, all);
    uint part = 5u * vertex_parts[vertex], albedo = part + (back ? 2u : 0u);
    vec3 emission = vec3(albedos[part].w, albedos[part + 1u].w, albedos[part + 2u].w);
    found[17u * probe] = vec4(arrives, 1.0);
    sent_now[uint(counts.z) + probe] = vec4(lit + arrives + sunlight, 1.0);
    sent_now[probe] = vec4(albedos[albedo].rgb * (lit + arrives) + albedos[albedo + 1u].rgb * sunlight + emission, 1.0);
}

void main()
{
    uint thread = gl_LocalInvocationID.x, ray = thread & 31u, item = gl_WorkGroupID.x * 2u + (thread >> 5), first = thread & 32u;
    bool is_there = item < due.z;
    uint probe = own[is_there ? due.x + item * due.y : due.x], vertex = probes[probe].x & 0x7fffffffu;
    bool back = (probes[probe].x >> 31) != 0u;
    vec3 n = normal_of(vertex) * (back ? -1.0 : 1.0);
    trace(2u * vertex + (back ? 1u : 0u), vertex, ray, n, position_of(vertex) + n * eye.w);
    barrier();
    if (!is_there)
        return;
    uint count = 0u;
    for (uint k = first; k < first + RAYS; k++)
        count += known_of[k];
    float mean = 1.0 / max(float(count), 1.0);
    if (ray < RAYS)
        found[17u * probe + 1u + ray] = vec4(sum_term(first, ray, mean), 0.0);
    else if (ray == RAYS)
        sum_up(probe, vertex, back, first, mean, n);
}
