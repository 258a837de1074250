#version 450 core
// The image for a screen: over its background, exposed, tone mapped, sRGB-encoded. No dither: the same image
// gives the same bytes.
//
// One of ON_GREY, ON_BLURRED, ON_LATLONG, ON_CUBE and AS_IT_IS is defined: software GL carries out both sides of a branch.
// SAME_SIZE: the screen has as many pixels as the image.
#include "directions_terms.glsl"
#include "lobes_terms.glsl"
#include "tone.glsl"


layout(location = 0) uniform vec3 exposure; // factors of red, green and blue
layout(location = 1) uniform vec2 environment_turn; // cosine and sine of the environment's yaw
layout(location = 2) uniform mat3 view;             // columns: right and up to the image's edge, forward

layout(binding = 0) uniform sampler2D image;
#if defined(ON_LATLONG)
layout(binding = 1) uniform sampler2D backdrop;
#else
layout(binding = 1) uniform samplerCube backdrop;
#endif

in vec2 uv;

layout(location = 0) out vec4 shown;

#if !defined(AS_IT_IS)
vec3 behind()
{
#if defined(ON_GREY)
    return vec3(SHOWN_GREY);
#else
    vec3 world = view * vec3(2.0 * uv - 1.0, 1.0);
    vec3 d = turned_direction(environment_turn.x, environment_turn.y, world);
#if defined(ON_LATLONG)
    return exposure * textureLod(backdrop, latlong_place(d), 0.0).rgb;
#else
    return exposure * textureLod(backdrop, d, 0.0).rgb;
#endif
#endif
}

vec3 mapped(vec3 colour)
{
    vec3 rest = colour - tone_offset(min(colour.r, min(colour.g, colour.b)));
    float peak = max(rest.r, max(rest.g, rest.b));
    if (peak < TONE_START)
        return rest;
    return vec3(tone_compress(rest.r, peak), tone_compress(rest.g, peak), tone_compress(rest.b, peak));
}
#endif

vec3 encoded(vec3 colour)
{
    return vec3(srgb_encode(colour.r), srgb_encode(colour.g), srgb_encode(colour.b));
}

void main()
{
#if defined(SAME_SIZE)
    vec4 figure = texelFetch(image, ivec2(gl_FragCoord.xy), 0);
#else
    vec4 figure = texture(image, uv);
#endif
    float open = 1.0 - clamp(figure.a, 0.0, 1.0);
#if defined(AS_IT_IS) // colours that stand for numbers: neither exposed nor mapped
    shown = vec4(encoded(figure.rgb + open * vec3(SHOWN_DARK)), 1.0);
#else
    vec3 colour = exposure * figure.rgb + open * behind();
    shown = vec4(encoded(mapped(vec3(tone_bound(colour.r), tone_bound(colour.g), tone_bound(colour.b)))), 1.0);
#endif
}
