// Linear filters of graphics cards: their weights have steps of 1/256, where GL in software has floats. GL does not state
// how precise they are. These functions replace those of GLSL in every shader (shaders.cmake).
vec2 hardware_place(vec2 p, vec2 size)
{
    size = max(size, vec2(1.0)); // of a map that is not bound
    return (floor((p * size - 0.5) * 256.0 + 0.5) / 256.0 + 0.5) / size;
}

vec2 hardware_at(sampler2D map, vec2 p, int level)
{
    return hardware_place(p, vec2(textureSize(map, level)));
}

vec3 hardware_at(sampler2DArray map, vec3 p, int level)
{
    return vec3(hardware_place(p.xy, vec2(textureSize(map, level).xy)), p.z);
}

vec3 hardware_face(vec3 direction, float size)
{
    vec3 sides = abs(direction);
    float longest = max(sides.x, max(sides.y, sides.z));
    vec3 at = direction / longest;
    vec3 placed = 2.0 * (floor(((0.5 * at + 0.5) * size - 0.5) * 256.0 + 0.5) / 256.0 + 0.5) / size - 1.0;
    return mix(placed, at, equal(sides, vec3(longest)));
}

vec3 hardware_at(samplerCube map, vec3 p, int level)
{
    return hardware_face(p, float(textureSize(map, level).x));
}

vec4 hardware_at(samplerCubeArray map, vec4 p, int level)
{
    return vec4(hardware_face(p.xyz, float(textureSize(map, level).x)), p.w);
}

#define HARDWARE_LEVELS(SAMPLER, PLACE) \
    vec4 hardware_lod(SAMPLER map, PLACE p, float lod) \
    { \
        float last = float(textureQueryLevels(map) - 1), at = clamp(lod, 0.0, last), low = floor(at); \
        float high = min(low + 1.0, last), weight = floor((at - low) * 256.0 + 0.5) / 256.0; \
        return mix(textureLod(map, hardware_at(map, p, int(low)), low), \
                   textureLod(map, hardware_at(map, p, int(high)), high), weight); \
    }
HARDWARE_LEVELS(sampler2D, vec2)
HARDWARE_LEVELS(sampler2DArray, vec3)
HARDWARE_LEVELS(samplerCube, vec3)
HARDWARE_LEVELS(samplerCubeArray, vec4)

// Levels that differ by the derivatives are left to GL.
#define HARDWARE_GRAD(SAMPLER, PLACE, CHANGE) \
    vec4 hardware_grad(SAMPLER map, PLACE p, CHANGE across, CHANGE down) \
    { \
        return textureGrad(map, hardware_at(map, p, 0), across, down); \
    }
HARDWARE_GRAD(sampler2D, vec2, vec2)
HARDWARE_GRAD(sampler2DArray, vec3, vec2)
HARDWARE_GRAD(samplerCube, vec3, vec3)
HARDWARE_GRAD(samplerCubeArray, vec4, vec3)

#ifdef HARDWARE_FRAGMENT
#define HARDWARE_IMPLICIT(SAMPLER, PLACE, OF) \
    vec4 hardware_texture(SAMPLER map, PLACE p, float bias) \
    { \
        return textureGrad(map, hardware_at(map, p, 0), exp2(bias) * dFdx(p OF), exp2(bias) * dFdy(p OF)); \
    } \
    vec4 hardware_texture(SAMPLER map, PLACE p) \
    { \
        return hardware_texture(map, p, 0.0); \
    }
HARDWARE_IMPLICIT(sampler2D, vec2, .xy)
HARDWARE_IMPLICIT(sampler2DArray, vec3, .xy)
HARDWARE_IMPLICIT(samplerCube, vec3, .xyz)
HARDWARE_IMPLICIT(samplerCubeArray, vec4, .xyz)

float hardware_texture(sampler2DArrayShadow map, vec4 p)
{
    vec2 place = hardware_place(p.xy, vec2(textureSize(map, 0).xy));
    return textureGrad(map, vec4(place, p.zw), dFdx(p.xy), dFdy(p.xy));
}
#define texture hardware_texture
#endif
#define textureLod  hardware_lod
#define textureGrad hardware_grad
