#version 450 core
// Means of the samples of each pixel, averaged with the images before this one.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D samples;
layout(rgba32f, binding = 0) restrict uniform image2D image;
layout(location = 0) uniform int side;   // samples of a pixel along each side
layout(location = 1) uniform int before; // images

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(image))))
        return;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            sum += texelFetch(samples, pixel * side + ivec2(x, y), 0);
    sum /= float(side * side);
    if (before > 0)
        sum = mix(imageLoad(image, pixel), sum, 1.0 / float(before + 1));
    imageStore(image, pixel, sum);
}
