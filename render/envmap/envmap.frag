#version 450 core
// The light of every sample of the G-buffer by look-ups in an environment map (envmap.h). MODE and COMPOSITION are
// #defined as the numbers below. GROUND: the ground is drawn, always as SURFACE. MINIFY: mirrors read mip levels.
// LAYERED: some surfaces have coats or transmit light. PASS: this draw is one of several passes (passes.c).
// VERTEX_VECTORS: directions come from vertices (vectors.frag). BAKED: diffuse light comes from light maps
// (light_map.frag).
#include "directions_terms.glsl"
#include "exponents.glsl"
#include "facets_terms.glsl"
#include "lobes_terms.glsl"
#include "look_up.glsl"
#include "sample.glsl"

const int SURFACE = 0, MIRROR = 1, REFRACTION = 2, DIFFUSE = 3, GLOSSY = 4, TRANSMISSION = 5;
const int OFF = 0, ADDITIVE = 1, COAT = 2;
const int WHOLE = 0, SHARE = 1, OVER = 2, UNDER = 3, COATING = 4, THROUGH = 5, SUM = 6; // PASS
#ifdef PASS
layout(location = 42) uniform int channel; // of the share that alpha holds
layout(location = 43) uniform float pass_scale; // from radiance to values of the target; SUM: back
layout(binding = 8) uniform sampler2D passed; // SUM: what the passes left
#else
const int PASS = WHOLE, channel = 0;
const float pass_scale = 1.0;
#endif
const int ENVIRONMENT = 31; // index after the last exponent
const uint TRIANGLE_BACK = 0x80000000u;

layout(location = 4) uniform int part_count;
layout(location = 6) uniform int slots[32];
layout(location = 3) uniform float texel_reach; // square root of the mean solid angle of a texel

layout(binding = 4) uniform usampler2D triangles;
layout(binding = 7) uniform sampler2D fresnel; // F over the cosine, one row per part

struct Part {
    uint first_triangle; // counted over all surfaces, from 0
    float index;         // of refraction
    uint is_ground;
    float coat, coat_glossiness;
    vec3 transmission;
};
layout(std430, binding = 1) readonly buffer Parts
{
    Part parts[];
};

layout(location = 0) out vec4 light;

#ifdef VERTEX_VECTORS
layout(binding = 9) uniform sampler2D over_vectors; // the reflected view vector; n . v
layout(binding = 10) uniform sampler2D under_vectors; // the direction of the light below

vec4 vertex_vector(sampler2D vectors)
{
    return texelFetch(vectors, ivec2(gl_FragCoord.xy), 0);
}
#endif

#ifdef BAKED
layout(binding = 11) uniform sampler2D baked; // diffuse light of every sample
#endif

// The part of a triangle, by binary search; parts are sorted by their first triangle.
int part_of(uint triangle)
{
    int low = 0, high = part_count - 1;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (parts[middle].first_triangle <= triangle)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

// The mip level of the footprint of a pixel, from the differences of a direction to those of the pixel's neighbours.
// At the border of two surfaces one of the two differences is meaningless, so the smaller one is used.
float level_of(vec3 across, vec3 down)
{
    float square = min(dot(across, across), dot(down, down));
    return 0.5 * log2(max(square / (texel_reach * texel_reach), 1.0));
}

vec3 mirrored(vec3 mirror)
{
#ifdef MINIFY
    return look_up(mirror, slots[ENVIRONMENT], level_of(dFdx(mirror), dFdy(mirror)));
#else
    return look_up(mirror, slots[ENVIRONMENT], 0.0);
#endif
}

vec3 irradiance(vec3 d)
{
    return look_up(d, slots[0], 0.0);
}

// E(d, s), interpolated between two exponents.
vec3 lobe_light(vec3 d, float glossiness)
{
    float level = exponent_level(1.0 / max(1.0 - glossiness, 1e-6));
    int exponent = clamp(int(level), 0, ENVIRONMENT - 1);
    float weight = level - float(exponent);
    vec3 lower = look_up(d, slots[exponent], 0.0);
    return weight > 0.0 ? mix(lower, look_up(d, slots[exponent + 1], 0.0), min(weight, 1.0)) : lower;
}

// The refracted view vector by Snell's law. `ratio` is the index on the side of the viewer over that on the other side.
vec3 refracted(vec3 v, vec3 n, vec3 mirror, float ratio)
{
    float cosine = clamp(dot(n, v), 0.0, 1.0), square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    return square < 0.0 ? mirror : normalize((ratio * cosine - sqrt(square)) * n - ratio * v);
}

// The light along the refracted view vector. A neighbour beyond the edge of a triangle is computed for derivatives only
// and reads zeros from buffers, such as the one that holds `ratio`. So the differences are taken of the vectors, which
// come from textures, and the neighbours' are refracted here, with the ratio of this pixel.
vec3 refraction(vec3 v, vec3 n, vec3 mirror, float ratio)
{
#ifdef VERTEX_VECTORS
    return mirrored(vertex_vector(under_vectors).xyz);
#else
    vec3 d = refracted(v, n, mirror, ratio);
#ifdef MINIFY
    vec3 across = refracted(v + dFdx(v), n + dFdx(n), mirror + dFdx(mirror), ratio) - d;
    vec3 down = refracted(v + dFdy(v), n + dFdy(n), mirror + dFdy(mirror), ratio) - d;
    return look_up(d, slots[ENVIRONMENT], level_of(across, down));
#else
    return look_up(d, slots[ENVIRONMENT], 0.0);
#endif
#endif
}

vec3 reflectance(int part, float cosine)
{
    ivec2 size = textureSize(fresnel, 0);
    float row = (float(min(part, size.y - 1)) + 0.5) / float(size.y);
    return textureLod(fresnel, vec2((cosine * float(size.x - 1) + 0.5) / float(size.x), row), 0.0).rgb;
}

// Lm: the light that a mirror reflects.
vec3 over_light(int mode, Sample place)
{
    if (mode == MIRROR || mode == REFRACTION)
        return mirrored(place.mirror);
    return mode == DIFFUSE ? vec3(0.0) : lobe_light(place.mirror, place.glossiness);
}

// Ld: the light below it.
vec3 under_light(int mode, Sample place, vec3 v, float ratio)
{
    if (mode == REFRACTION)
        return refraction(v, place.normal, place.mirror, ratio);
    if (mode == GLOSSY)
        return vec3(0.0);
#ifdef VERTEX_VECTORS
    vec3 d = vertex_vector(under_vectors).xyz;
#else
    vec3 d = mode == TRANSMISSION ? -v : place.normal;
#endif
#ifdef BAKED
    if (mode != TRANSMISSION)
        return place.kd * texelFetch(baked, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
    return place.kd * (mode == TRANSMISSION ? lobe_light(d, place.glossiness) : irradiance(d));
}

vec3 light_of(int mode, Sample place, vec3 v, float ratio)
{
    switch (mode) {
    case MIRROR:
        return over_light(mode, place);
    case REFRACTION:
    case TRANSMISSION:
    case DIFFUSE:
        return under_light(mode, place, v, ratio);
    default:
        return place.ks * over_light(mode, place) + under_light(mode, place, v, ratio);
    }
}

#ifdef LAYERED
// The share of the coat, which lies on the smooth surface.
float coat_over(Part part, Sample place, vec3 v)
{
#ifdef VERTEX_VECTORS
    float cosine = vertex_vector(over_vectors).w;
#else
    float cosine = dot(place.smooth_normal, v);
#endif
    return coat_share(part.coat, cosine);
}

vec3 coat_light(Part part, Sample place, vec3 v)
{
#ifdef VERTEX_VECTORS
    vec3 mirror = place.mirror;
#else
    vec3 mirror = mirrored_viewer(place.smooth_normal, v);
#endif
    return lobe_light(mirror, part.coat_glossiness);
}

// The light that a thin sheet transmits.
vec3 through_light(Part part, Sample place)
{
#ifdef VERTEX_VECTORS
    return part.transmission * irradiance(-vertex_vector(under_vectors).xyz);
#else
    return part.transmission * irradiance(-place.normal);
#endif
}

vec3 layered(Part part, Sample place, vec3 v, vec3 light)
{
    float coat = coat_over(part, place, v);
    vec3 over = coat > 0.0 ? coat * coat_light(part, place, v) : vec3(0.0);
    return (1.0 - coat) * (light + through_light(part, place)) + over;
}
#endif

// Everything in one pass.
vec3 whole_light(Part part, int number, Sample place, vec3 v, float cosine, float ratio)
{
    if (COMPOSITION == OFF) {
        vec3 colour = light_of(MODE, place, v, ratio);
#ifdef LAYERED
        colour = layered(part, place, v, colour);
#endif
        return colour;
    }
    vec3 f = reflectance(number, cosine);
    return f * over_light(MODE, place) + (COMPOSITION == COAT ? 1.0 - f : vec3(1.0)) * under_light(MODE, place, v, ratio);
}

// The content of alpha: the share of the mirror, or of the coat.
vec3 share_over(Part part, int number, Sample place, vec3 v, float cosine)
{
#ifdef LAYERED
    return vec3(coat_over(part, place, v));
#else
    return reflectance(number, cosine);
#endif
}

// The light that one of several passes adds.
vec3 pass_light(Part part, Sample place, vec3 v, float ratio)
{
#ifdef LAYERED
    if (PASS == COATING)
        return coat_light(part, place, v);
    if (PASS == THROUGH)
        return through_light(part, place);
#endif
    if (PASS == UNDER)
        return under_light(MODE, place, v, ratio);
    return (COMPOSITION == OFF && MODE != MIRROR ? place.ks : vec3(1.0)) * over_light(MODE, place);
}

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Sample place = read_sample(texel);
#ifdef PASS
    if (PASS == SUM) {
        light = vec4(texelFetch(passed, texel, 0).rgb * pass_scale * place.cover, 0.0);
        return;
    }
#endif
    uint triangle = texelFetch(triangles, texel, 0).r;
    int number = part_of((triangle & ~TRIANGLE_BACK) - 1u);
    Part part = parts[number];
    float ratio = (triangle & TRIANGLE_BACK) != 0u ? part.index : 1.0 / part.index;
    vec3 to_eye = eye - place.point;
    vec3 v = to_eye * inversesqrt(max(dot(to_eye, to_eye), 1e-30));
#ifdef VERTEX_VECTORS
    vec4 over = vertex_vector(over_vectors);
    place.mirror = over.xyz;
    float cosine = clamp(over.w, 0.0, 1.0);
#else
    float cosine = clamp(dot(place.normal, v), 0.0, 1.0);
#endif
    if (PASS == SHARE) {
        light = vec4(0.0, 0.0, 0.0, share_over(part, number, place, v, cosine)[channel]);
        return;
    }
    vec3 colour = PASS == WHOLE ? whole_light(part, number, place, v, cosine, ratio) : pass_light(part, place, v, ratio);
#ifdef GROUND // its specular colour and its share are 0: of several passes the one of the light below draws it
    if (part.is_ground != 0u && (PASS == WHOLE || (COMPOSITION == OFF ? MODE != SURFACE : PASS == UNDER)))
        colour = light_of(SURFACE, place, v, ratio);
#endif
    light = PASS == WHOLE ? vec4(colour * place.cover, 0.0) : vec4(colour * pass_scale, 0.0);
}
