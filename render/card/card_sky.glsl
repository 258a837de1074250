// The environment by its own texels, as the reference samples it (render/reference/sky.h).
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

float every_second_bit(uint bits)
{
    bits &= 0x55555555u;
    bits = (bits | bits >> 1) & 0x33333333u;
    bits = (bits | bits >> 2) & 0x0f0f0f0fu;
    bits = (bits | bits >> 4) & 0x00ff00ffu;
    bits = (bits | bits >> 8) & 0x0000ffffu;
    return (float(bits) + 0.5) / 65536.0;
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
        return sky_at(texel, out_of_environment(on_face * inversesqrt(square)), square * sqrt(square));
    }
    float upper = cos(PI * at.y / float(size.y)), lower = cos(PI * (at.y + 1.0) / float(size.y));
    float height = mix(upper, lower, within.y), radius = sqrt(max(1.0 - height * height, 0.0));
    float phi = 2.0 * PI * ((at.x + within.x) / float(size.x) - 0.5);
    return sky_at(texel, out_of_environment(vec3(radius * sin(phi), height, -radius * cos(phi))), 1.0);
}

SkySample sky_towards(vec3 direction)
{
    ivec2 size = textureSize(sky_texels, 0);
    vec3 d = into_environment(direction);
    if (sky_is_cube) {
        vec3 m = abs(d);
        float major = max(m.x, max(m.y, m.z)), square = dot(d, d) / (major * major);
        return sky_at(cube_texel(d, size.x), direction, square * sqrt(square));
    }
    vec2 place = vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI), acos(clamp(d.y, -1.0, 1.0)) / PI);
    ivec2 at = clamp(ivec2(place * vec2(size)), ivec2(0), size - 1);
    return sky_at(at.y * size.x + at.x, direction, 1.0);
}
