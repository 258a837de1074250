// The environment by its own texels, as the reference samples it (render/reference/sky.h).
#include "directions_terms.glsl"
layout(binding = 6) uniform sampler2D sky_texels; // radiance; pdf, of a cube at the middle of a face
layout(binding = 7) uniform usampler2D sky_curve; // texel; share of those before it along the curve, 1: 2^32
layout(location = 2) uniform bool sky_is_cube;

struct SkySample {
    vec3 direction, radiance; // world
    float pdf;                // per sr
};

SkySample sky_at(int texel, vec3 direction, float stretch)
{
    int width = textureSize(sky_texels, 0).x;
    vec4 sky = texelFetch(sky_texels, ivec2(texel % width, texel / width), 0);
    return SkySample(direction, sky.rgb, sky.a * stretch);
}

uint share_before(int place)
{
    int width = textureSize(sky_curve, 0).x;
    return texelFetch(sky_curve, ivec2(place % width, place / width), 0).g;
}

// The direction where the cumulative distribution is `share`. The curve goes on inside the texels.
SkySample sky_sample(uint share)
{
    ivec2 size = textureSize(sky_texels, 0);
    int low = 0, high = size.x * size.y;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        bool is_after = share_before(middle) <= share;
        low = is_after ? middle : low;
        high = is_after ? high : middle;
    }
    uint before = share_before(low), after = low + 1 < size.x * size.y ? share_before(low + 1) : 0u; // 0: 2^32
    uint bits = uint(min(float(share - before) / float(after - before), 0.9999999) * 4294967296.0);
    vec2 within = vec2(every_second_bit(bits), every_second_bit(bits >> 1));
    int texel = int(texelFetch(sky_curve, ivec2(low % size.x, low / size.x), 0).r);
    vec2 at = vec2(texel % size.x, texel / size.x);
    if (sky_is_cube) {
        vec2 place = (vec2(at.x, texel / size.x % size.x) + within) / float(size.x);
        vec3 on_face = cube_direction(texel / (size.x * size.x), place.x, place.y);
        float square = dot(on_face, on_face);
        return sky_at(texel, out_of_environment(on_face * inversesqrt(square)), cube_stretch(square));
    }
    vec3 d = latlong_direction((at.x + within.x) / float(size.x), texel / size.x, size.y, within.y);
    return sky_at(texel, out_of_environment(d), 1.0);
}

SkySample sky_towards(vec3 direction)
{
    ivec2 size = textureSize(sky_texels, 0);
    vec3 d = into_environment(direction);
    if (sky_is_cube) {
        vec3 m = abs(d);
        float major = max(m.x, max(m.y, m.z)), square = dot(d, d) / (major * major);
        return sky_at(cube_texel(d, size.x), direction, cube_stretch(square));
    }
    vec2 place = latlong_place(d);
    return sky_at(texel_within(place.y, size.y) * size.x + texel_within(place.x, size.x), direction, 1.0);
}
