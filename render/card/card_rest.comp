#version 450 core
// At rest: a round of light of every pixel by the real reflectance, as the reference computes it (render/reference). Paths
// [Kajiya 1986] whose places each take light from the environment in two ways, by its texels and by lobes, weighed by the
// balance heuristic [Veach 1997]. A dispatch lights the places of one class of materials after so many bounces.
#include "card_frame.glsl"
#define TREE_BINDING CARD_NODES
#define HOLES_BINDING CARD_HOLES
#include "trace.glsl"
#include "sample_terms.glsl"
#include "spread_terms.glsl"
#include "card_sky.glsl"
#include "card_see.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(location = 0) uniform ivec4 kind; // class, bounces before, bounces at largest, round
layout(location = 1) uniform vec2 more;  // side of what a pixel shows, in pixels; number of the ground's first triangle
layout(location = 3) uniform int layers; // 1: no cloth is open
layout(rgba32f, binding = 0) restrict uniform image2D light_image;
layout(r32ui, binding = 1) restrict readonly uniform uimage2D behind[4]; // IDs of the layers behind the nearest
layout(std430, binding = CARD_TRIANGLE_PARTS) restrict readonly buffer TriangleParts
{
    uint triangle_parts[];
};
struct Path {
    vec4 way;     // direction; weight of the second corner, on the ground x
    vec4 through; // what it carries to the pixel; weight of the third corner, on the ground z
    uint triangle;
    uint due;     // class of what it meets, bounces << 8
};
layout(std430, binding = CARD_PATHS) restrict buffer Paths
{
    Path paths[]; // by sample
};
const uint BACK = 0x80000000u, NOWHERE = 0xffffffffu;
const int LAYERS_BEHIND = 4;  // TL_TRANSPARENCY_LAYERS: the last counts as closed
const float FOLLOWED = 0.25; // paths that carry less are followed by chance [Arvo and Kirk 1990]

uint mixed(uint a, uint b)
{
    uint x = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca77u;
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

// ---- Places ----

Place hit_place(Path path, uint triangle, bool back)
{
    Place p;
    p.triangle = triangle;
    p.back = back;
    p.corners = corners_of(triangle);
    p.weights = vec3(1.0 - path.way.w - path.through.w, path.way.w, path.through.w);
    for (int i = 0; i < 3; i++)
        p.points[i] = position_of(p.corners[i]);
    if (triangle == uint(more.y)) { // the ground is a disc: any of its triangles stands for it
        p.weights = vec3(1.0 / 3.0);
        for (int i = 0; i < 3; i++)
            p.points[i] = vec3(path.way.w, disc.y, path.through.w);
    }
    p.at_x = p.at_y = vec3(0.0);
    p.ray = path.way.xyz;
    return p;
}

// ---- Reflectance ----

// A place, and what its coat and its fibres take from the rest.
struct Lobes {
    Seen s;
    vec3 normal; // on the viewer's side
    MaterialLayers over;
    vec3 through; // the share of light that a thin sheet scatters through from the other side
    bool has_facets, transmits;
    int glosses; // lobes that directions are chosen by, beside the hemisphere
};

Lobes lobes_of_place(Seen s)
{
    Lobes l;
    l.s = s;
    l.normal = s.side * s.surface.smooth_normal;
#ifdef RICH
    l.over = layers_over(s);
#else
    l.over = material_layers(vec4(0.0), 0.0, 1.0, vec3(0.0), 0.5, 0.0, l.normal, l.normal, vec3(0.0), s.viewer);
#endif
    l.transmits = (s.part.flags.x & TRANSMITS) != 0u;
    l.through = l.transmits ? l.over.base * s.part.transmission.rgb : vec3(0.0);
    l.has_facets = s.is_faceted && s.facets.viewer.z > 0.0;
    l.glosses = l.has_facets ? 1 + int(s.part.flags.w) : !s.is_faceted && (s.part.flags.x & IS_GLOSSY) != 0u ? 1 : 0;
    l.glosses += l.over.coat > 0.0 ? 1 : 0;
    return l;
}

// f cos for light from a direction; from below it is what comes through.
vec3 sent(Lobes l, vec3 d)
{
    if (!(dot(d, l.normal) > 0.0))
        return l.through * (max(-dot(d, l.s.surface.shown), 0.0) / PI);
    vec3 f = l.s.surface.diffuse * (max(dot(d, l.s.surface.shown), 0.0) / PI) * material_matt(l.over, d);
    if (l.s.is_faceted ? l.has_facets && dot(d, l.s.facets.frame[2]) > 0.0 : l.glosses > 0)
        f += gloss_under(l.s, d, 0.0);
    return material_over(l.over, f, d, 0.0);
}

// Whether light from a direction is sent to the viewer, and from where its ray starts.
bool is_lit_from(Lobes l, vec3 d)
{
    return l.transmits || dot(d, l.normal) > 0.0;
}

vec3 start_towards(Lobes l, vec3 d)
{
    bool is_above = dot(d, l.normal) > 0.0;
    Place p = l.s.p;
    p.back = p.back == is_above;
    return ray_start(p, is_above ? l.normal : -l.normal);
}

vec3 emitted(Lobes l)
{
#ifdef RICH
    return l.s.emitted * l.over.base;
#else
    return vec3(0.0);
#endif
}

// ---- Directions ----

// Facets by normal slopes, whose squared widths along weft and warp, and product, these are. Lobes about the mirror
// direction are as wide as slopes of half their angles.
vec3 slopes_of(Seen s, int gloss)
{
#ifdef RICH
    if (gloss > 0 || (s.part.flags.x & HAS_TABLE) == 0u)
        return widths_of(s.part, gloss, s.surface.widening, s.tangent.w);
    int model = int(s.part.table_first.w & 15u);
    float wider = detail_facet_square(1.0 - s.surface.glossiness) - detail_facet_square(1.0 - s.part.diffuse.a);
    float square = model == TORRANCE_SPARROW ? facet_square(s.part.ward[0].x, wider) : 0.5 / lobe_exponent(s.surface.glossiness);
    return vec3(square, square, 0.0);
#else
    return vec3(1.0, 1.0, 0.0);
#endif
}

vec3 facet_direction(Seen s, vec3 squares, vec2 at)
{
    vec3 h = normalize(vec3(facet_slope(squares, at.x, at.y), 1.0)), v = s.facets.viewer;
    return s.facets.frame * (2.0 * dot(h, v) * h - v);
}

float facet_pdf(Seen s, vec3 squares, vec3 d)
{
    vec3 world = direction_or(d + s.viewer, d), h = world * s.facets.frame;
    float towards = dot(world, s.viewer);
    return h.z > 1e-4 && towards > 1e-4 ? facet_slope_pdf(squares, h) / (4.0 * towards) : 0.0;
}

float hemisphere_exponent(Lobes l)
{
    return fuzz_strength(l.over.fuzz) > 0.0 ? 0.0 : 1.0; // fibres do not follow the cosine
}

// Half of the directions above are chosen by the hemisphere, the others by one lobe like the other.
float above_pdf(Lobes l, vec3 d)
{
    float cosine = dot(d, l.s.surface.shown), sum = 0.0;
    float pdf = cosine > 0.0 ? lobe_cosine(hemisphere_exponent(l), cosine) : 0.0;
    if (l.glosses == 0)
        return pdf;
    int facets = l.has_facets ? 1 + int(l.s.part.flags.w) : 0;
    for (int k = 0; k < facets; k++)
        sum += facet_pdf(l.s, slopes_of(l.s, k), d);
    if (!l.s.is_faceted && (l.s.part.flags.x & IS_GLOSSY) != 0u)
        sum += lobe_cosine(l.s.exponent, dot(d, l.s.mirror));
    if (l.over.coat > 0.0)
        sum += lobe_cosine(l.over.coat_exponent, dot(d, l.over.coat_axis));
    return 0.5 * (pdf + sum / float(l.glosses));
}

// A thin sheet chooses half of them on its other side.
float direction_pdf(Lobes l, vec3 d)
{
    return l.transmits ? 0.5 * (above_pdf(l, d) + lobe_cosine(1.0, -dot(d, l.s.surface.shown))) : above_pdf(l, d);
}

vec3 choose_direction(Lobes l, uint choice, vec2 at)
{
    if (l.transmits) {
        if ((choice & 1u) != 0u)
            return lobe_direction(-l.s.surface.shown, lobe_off_axis(1.0, at.x), at.y);
        choice >>= 1;
    }
    int lobe = l.glosses == 0 ? -1 : int(choice % uint(2 * l.glosses)) - l.glosses;
    if (lobe < 0)
        return lobe_direction(l.s.surface.shown, lobe_off_axis(hemisphere_exponent(l), at.x), at.y);
    if (l.over.coat > 0.0 && lobe == l.glosses - 1)
        return lobe_direction(l.over.coat_axis, lobe_off_axis(l.over.coat_exponent, at.x), at.y);
    return l.has_facets ? facet_direction(l.s, slopes_of(l.s, lobe), at)
                        : lobe_direction(l.s.mirror, lobe_off_axis(l.s.exponent, at.x), at.y);
}

// ---- Light ----

// Numbers of the first place follow a sequence through the rounds; those of others are independent.
vec2 numbers_of(uint item, int bounces, int round)
{
    return bounces == 0 ? spread_place(item, uint(round)) : spread_place(mixed(item, uint(round)), 0u);
}

vec3 from_texels(Lobes l, uint item, uint bits)
{
    vec3 light = vec3(0.0);
    for (uint i = 0u; i < 1u << bits; i++) {
        uint within = uint(numbers_of(mixed(item, i), kind.y, kind.w).x * 16777216.0) << 8;
        SkySample sky = sky_sample(i << (32u - bits) | within >> bits);
        if (!is_lit_from(l, sky.direction))
            continue;
        vec3 f = sent(l, sky.direction) * sky.radiance, start = start_towards(l, sky.direction);
        float share = ground_passes(disc, start, sky.direction);
        if (f.r + f.g + f.b > 0.0 && share > 0.0)
            light += f * (share * tree_transmittance(start, sky.direction, 0.0, 1e30) /
                          (float(1u << bits) * sky.pdf + direction_pdf(l, sky.direction)));
    }
    return light;
}

// Suns are in the environment's texels.
vec3 from_lamps(Lobes l)
{
    vec3 light = vec3(0.0);
    for (int i = 0; i < counts.y; i++) {
        Sun lamp = sun_at(i, point_of(l.s.p), l.normal);
        if (!is_lit_from(l, lamp.towards))
            continue;
        vec3 start = start_towards(l, lamp.towards);
        float share = ground_passes_from(start, lamp.towards, lamp.way);
        if (share > 0.0)
            light += sent(l, lamp.towards) * lamp.power * (share * tree_transmittance(start, lamp.towards, 0.0, lamp.way));
    }
    return light;
}

// Chance, as a number of its own for each layer of open cloth.
float chance_at(uint item, int layer)
{
    return numbers_of(mixed(item, uint(layer)), 1, kind.w).x;
}

// The first triangle that a ray does not pass through by chance.
TreeHit hit_by_chance(vec3 start, vec3 d, float to, uint item)
{
    TreeHit hit;
    float from = 0.0;
    for (int layer = 0;; layer++) {
        hit = tree_nearest(start, d, from, to);
        if (hit.triangle == TREE_NO_TRIANGLE || layer == LAYERS_BEHIND || chance_at(item, layer) >= hit.open)
            return hit;
        from = hit.distance + eye.w;
    }
}

// Follows a direction; what does not meet anything takes light from the sky, and what does goes on.
vec3 follow(Lobes l, vec3 through, uint item, uint bits, inout Path path)
{
    uint choice = kind.y == 0 ? item + uint(kind.w) : mixed(item, uint(kind.w));
    vec3 d = choose_direction(l, choice, numbers_of(item, kind.y, kind.w));
    float pdf = direction_pdf(l, d);
    if (!(is_lit_from(l, d) && pdf > 0.0))
        return vec3(0.0);
    vec3 f = sent(l, d), start = start_towards(l, d);
    float way = ground_way(disc, start, d);
    vec3 point = start + d * way;
    float cover = way >= 0.0 ? ground_opacity(disc, point.x, point.z) : 0.0, open = 1.0 - cover;
    TreeHit hit = hit_by_chance(start, d, cover > 0.0 ? way : 1e30, mixed(item, 3u));
    path.way = vec4(d, point.x);
    path.through.w = point.z;
    path.triangle = uint(more.y);
    if (hit.triangle != TREE_NO_TRIANGLE) {
        path.way.w = hit.u;
        path.through.w = hit.v;
        path.triangle = hit.triangle | (hit.back ? BACK : 0u);
        cover = 1.0;
        open = 0.0;
    }
    path.through.rgb = through * f * (cover / pdf);
    float largest = max(path.through.r, max(path.through.g, path.through.b)), chance = min(largest / FOLLOWED, 1.0);
    if (kind.y < kind.z && largest > 0.0 && (kind.y == 0 || numbers_of(item ^ 0x5bd1e995u, 1, kind.w).x < chance)) {
        path.through.rgb /= kind.y == 0 ? 1.0 : chance;
        path.due = (triangle_parts[path.triangle & ~BACK] >> 16 & 15u) | uint(kind.y + 1) << 8;
    }
    SkySample sky = sky_towards(d);
    return open > 0.0 ? f * sky.radiance * (open / (float(1u << bits) * sky.pdf + pdf)) : vec3(0.0);
}

// Constants index the images: software GL reads the wrong one where only some pixels read.
uint id_behind(int layer, ivec2 pixel)
{
    if (layer < 2)
        return layer == 0 ? imageLoad(behind[0], pixel).r : imageLoad(behind[1], pixel).r;
    return layer == 2 ? imageLoad(behind[2], pixel).r : imageLoad(behind[3], pixel).r;
}

// The ID of the nearest layer at a pixel, or of one behind, by a number that is even over rounds, and over those among
// them that share a direction's side.
uint seen_id(ivec2 pixel, uint item)
{
    float number = float((item + uint(kind.w) * 2654435769u) >> 8) / 16777216.0; // steps of the golden section
    uint id = texelFetch(ids, pixel, 0).r;
    for (int layer = 0; layer < layers - 1 && id != 0u; layer++) {
        uint part = triangle_parts[(id & ~BACK) - 1u];
        float open = (part & CARD_IS_OPEN) != 0u ? parts[part & 0xfffu].transmission.w : 0.0;
        if (number >= open)
            break;
        number /= open;
        id = id_behind(layer, pixel);
    }
    return id;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size.xy)))
        return;
    uint at = uint(pixel.y * size.x + pixel.x), bits = kind.y == 0 ? 5u : 2u;
    Place p;
    vec3 through = vec3(1.0);
    if (kind.y == 0) {
        uint id = seen_id(pixel, mixed(at, 4u));
        if (id == 0u && kind.x == 0) {
            paths[at].due = NOWHERE;
            imageStore(light_image, pixel, vec4(0.0));
        }
        if (id == 0u || (triangle_parts[(id & ~BACK) - 1u] >> 16 & 15u) != uint(kind.x))
            return;
        p = place_of(id, pixel);
        p.at_x *= more.x;
        p.at_y *= more.x;
    } else {
        if (paths[at].due != uint(kind.x | kind.y << 8))
            return;
        p = hit_place(paths[at], paths[at].triangle & ~BACK, (paths[at].triangle & BACK) != 0u);
        through = paths[at].through.rgb;
    }
    Lobes l = lobes_of_place(see_place(p, triangle_parts[p.triangle] & 0xfffu));
    Path path = Path(vec4(0.0), vec4(0.0), 0u, NOWHERE);
    uint item = mixed(at, uint(kind.y));
    float cover = kind.y == 0 ? l.s.cover : 1.0;
    through *= cover;
    vec3 light = emitted(l) + from_texels(l, mixed(item, 1u), bits) + from_lamps(l);
    light += follow(l, through, mixed(item, 2u), bits, path);
    paths[at] = path;
    vec4 before = kind.y == 0 ? vec4(vec3(0.0), cover) : imageLoad(light_image, pixel);
    imageStore(light_image, pixel, before + vec4(through * light, 0.0));
}
