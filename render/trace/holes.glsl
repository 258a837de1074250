// Holes that alpha cuts (cutout.h), from the words of holes.h. What includes this has #defined HOLES_BINDING.
layout(std430, binding = HOLES_BINDING) restrict readonly buffer Holes
{
    uint holes[];
};

float hole_alpha(uint image, ivec2 at)
{
    ivec2 size = ivec2(holes[image], holes[image + 1u]);
    ivec2 turned = at - size * ivec2(floor(vec2(at) / vec2(size)));
    ivec2 place = clamp(ivec2((holes[image + 2u] & 1u) != 0u ? at.x : turned.x, (holes[image + 2u] & 2u) != 0u ? at.y : turned.y),
                        ivec2(0), size - 1);
    uint texel = uint(place.y * size.x + place.x);
    return float(holes[image + 3u + texel / 4u] >> 8u * (texel & 3u) & 255u) / 255.0;
}

// Whether there is a hole at a place of a triangle, by the weights of its corners.
bool is_hole(uint triangle, vec3 weights)
{
    uint record = holes[0] != 0u ? holes[1u + triangle] : 0u;
    if (record == 0u)
        return false;
    uint image = holes[record];
    vec2 at = vec2(0.0);
    for (uint k = 0u; k < 3u; k++)
        at += weights[k] * uintBitsToFloat(uvec2(holes[record + 2u + 2u * k], holes[record + 3u + 2u * k]));
    vec2 low = floor(at), share = at - low;
    vec2 upper = vec2(hole_alpha(image, ivec2(low)), hole_alpha(image, ivec2(low) + ivec2(1, 0)));
    vec2 lower = vec2(hole_alpha(image, ivec2(low) + ivec2(0, 1)), hole_alpha(image, ivec2(low) + 1));
    vec2 both = mix(upper, lower, share.y);
    return mix(both.x, both.y, share.x) < uintBitsToFloat(holes[record + 1u]);
}
