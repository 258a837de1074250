#version 450 core
// The image for a screen: over its background, exposed, tone mapped, sRGB-encoded. No dither: the same image
// gives the same bytes.
//
// One of ON_GREY, ON_BLURRED, ON_LATLONG, ON_CUBE and AS_IT_IS is defined: software GL carries out both sides of a branch.
// SAME_SIZE: the screen has as many pixels as the image.
const float GREY = 0.18;
const float DARK = 0.03;
const float BLUR_LEVEL = 3.0;
const float PI = 3.14159265358979;

layout(location = 0) uniform float exposure;
layout(location = 1) uniform vec2 environment_turn; // cosine and sine of the environment's yaw
layout(location = 2) uniform mat3 view;             // columns: right and up to the image's edge, forward
layout(location = 5) uniform float blurred_scale;

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
    return vec3(GREY);
#else
    vec3 world = view * vec3(2.0 * uv - 1.0, 1.0);
    vec3 d = vec3(environment_turn.x * world.x - environment_turn.y * world.z, world.y,
                  environment_turn.y * world.x + environment_turn.x * world.z);
#if defined(ON_BLURRED)
    return exposure * blurred_scale * textureLod(backdrop, d, BLUR_LEVEL).rgb;
#elif defined(ON_CUBE)
    return exposure * textureLod(backdrop, d, 0.0).rgb;
#else
    d = normalize(d);
    vec2 place = vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI), acos(clamp(d.y, -1.0, 1.0)) / PI);
    return exposure * textureLod(backdrop, place, 0.0).rgb;
#endif
#endif
}

// Khronos PBR Neutral tone mapper: keeps base colours as they are up to 0.8, compresses and desaturates above.
vec3 tone_map(vec3 colour)
{
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float least = min(colour.r, min(colour.g, colour.b));
    colour -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(colour.r, max(colour.g, colour.b));
    if (peak < start)
        return colour;
    float d = 1.0 - start;
    float new_peak = 1.0 - d * d / (peak + d - start);
    colour *= new_peak / peak;
    float grey = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(colour, vec3(new_peak), grey);
}
#endif

vec3 srgb(vec3 linear)
{
    linear = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
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
    shown = vec4(srgb(figure.rgb + open * vec3(DARK)), 1.0);
#else
    vec3 colour = exposure * figure.rgb + open * behind();
    // Beyond 1e6 the tone mapper has long been at white; the bound keeps its arithmetic finite.
    shown = vec4(srgb(tone_map(clamp(colour, 0.0, 1e6))), 1.0);
#endif
}
