#version 450 core
// Box filter from samples to pixels, in linear light; alpha is coverage.
layout(location = 0) uniform int side; // samples per pixel side

layout(binding = 0) uniform sampler2D lights; // premultiplied by coverage; w: what of it is looked through
layout(binding = 1) uniform sampler2D points; // coverage in w

layout(location = 0) out vec4 image;

void main()
{
    ivec2 first = ivec2(gl_FragCoord.xy) * side;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            ivec2 texel = first + ivec2(x, y);
            vec4 light = texelFetch(lights, texel, 0);
            sum += vec4(light.rgb, texelFetch(points, texel, 0).w - light.a);
        }
    image = sum / float(side * side);
}
