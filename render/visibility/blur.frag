#version 450 core
// One direction of a separable Gaussian over a shadow map.
const int RADIUS_MAX = 64;

layout(location = 0) uniform int layer;
layout(location = 1) uniform ivec2 direction;
layout(location = 2) uniform int radius;
layout(location = 3) uniform float weights[RADIUS_MAX + 1]; // of the centre and of one side; all taps sum to 1

layout(binding = 0) uniform sampler2DArray source;

layout(location = 0) out vec2 moments;

void main()
{
    ivec2 last = textureSize(source, 0).xy - 1;
    ivec2 centre = ivec2(gl_FragCoord.xy);
    vec2 sum = weights[0] * texelFetch(source, ivec3(centre, layer), 0).xy;
    for (int i = 1; i <= radius; i++) {
        // The map's margin is empty, so clamping repeats what lies beyond it.
        ivec2 before = max(centre - i * direction, ivec2(0)), after = min(centre + i * direction, last);
        sum += weights[i] * (texelFetch(source, ivec3(before, layer), 0).xy +
                             texelFetch(source, ivec3(after, layer), 0).xy);
    }
    moments = sum;
}
