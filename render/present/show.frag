#version 450 core
// The image for a screen: over its background, exposed, tone mapped, sRGB-encoded. No dither: the same image
// gives the same bytes.
const int BACKGROUND_ENVIRONMENT = 0, BACKGROUND_BLURRED = 1;
const float GREY = 0.18;
const float DARK = 0.03;
const float BLUR_LEVEL = 3.0;
const float PI = 3.14159265358979;

layout(location = 0) uniform float exposure;
layout(location = 1) uniform int background;
layout(location = 2) uniform vec2 environment_turn; // cosine and sine of the environment's yaw
layout(location = 3) uniform mat3 view;             // columns: right and up to the image's edge, forward
layout(location = 6) uniform bool latlong;
layout(location = 7) uniform float blurred_scale;
layout(location = 8) uniform bool as_it_is; // colours that stand for numbers: neither exposed nor mapped

layout(binding = 0) uniform sampler2D image;
layout(binding = 1) uniform sampler2D latlong_map;
layout(binding = 2) uniform samplerCube cube_map;
layout(binding = 3) uniform samplerCube blurred_map;

in vec2 uv;

layout(location = 0) out vec4 shown;

vec3 backdrop(vec3 world)
{
    vec3 d = vec3(environment_turn.x * world.x - environment_turn.y * world.z, world.y,
                  environment_turn.y * world.x + environment_turn.x * world.z);
    if (background == BACKGROUND_BLURRED)
        return textureLod(blurred_map, d, BLUR_LEVEL).rgb * blurred_scale;
    if (!latlong)
        return textureLod(cube_map, d, 0.0).rgb;
    d = normalize(d);
    return textureLod(latlong_map, vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI), acos(clamp(d.y, -1.0, 1.0)) / PI), 0.0)
        .rgb;
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

vec3 srgb(vec3 linear)
{
    linear = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

void main()
{
    vec4 figure = texture(image, uv);
    if (as_it_is) {
        shown = vec4(srgb(figure.rgb + (1.0 - clamp(figure.a, 0.0, 1.0)) * vec3(DARK)), 1.0);
        return;
    }
    vec3 behind = vec3(GREY);
    if (background == BACKGROUND_ENVIRONMENT || background == BACKGROUND_BLURRED)
        behind = exposure * backdrop(view * vec3(2.0 * uv - 1.0, 1.0));
    vec3 colour = exposure * figure.rgb + (1.0 - clamp(figure.a, 0.0, 1.0)) * behind;
    // Beyond 1e6 the tone mapper has long been at white; the bound keeps its arithmetic finite.
    shown = vec4(srgb(tone_map(clamp(colour, 0.0, 1e6))), 1.0);
}
