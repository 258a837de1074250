#version 450 core
// One additive pass over some of the regions, their light from filter chains [Knuth et al. 2014, eq. 5]: c += VIS_i
// PEM_i; or, after the exact light, what is missing: c += (VIS_i - 1) PEM_i. PARABOLOIDS: these are cropped paraboloid
// maps. LOBE_SUMS: gloss of facets is a sum of lobes, each looked up in the PEMs [op. cit., 6].
#ifdef PARABOLOIDS
#include "paraboloids.glsl"
#endif
#include "sample.glsl"
#include "visibility.glsl"

const int LOBE_SINGLE = 0;

layout(location = 0) uniform ivec2 region_range;   // the first one's number, and how many
layout(location = 3) uniform float pem_scale;      // what the stored radiance is multiplied by
layout(location = 4) uniform int lobe;
layout(location = 5) uniform float already_there;  // 0, or 1 after the exact light

layout(binding = 5) uniform sampler2D lobe_levels;
layout(binding = 6) uniform samplerCubeArray pems;

#ifdef LOBE_SUMS
const int SUM_MAX = 16;                     // TL_LOBE_SUMS_MAX
layout(location = 9) uniform int sum_count; // lobes of a sample at most
// Two layers a lobe: direction and 1 / exponent; weight, and 1 where there is a lobe.
layout(binding = 10) uniform sampler2DArray lobe_sums;
#endif

layout(location = 0) out vec4 light;

float lobe_level(float glossiness)
{
    float steps = float(textureSize(lobe_levels, 0).x);
    return texture(lobe_levels, vec2((glossiness * (steps - 1.0) + 0.5) / steps, 0.5)).r;
}

// A direction as PEMs are looked up by it, and the light of the region in layer i through the lobe of a level about it.
#ifdef PARABOLOIDS
#define PLACE ParaboloidPoint
PLACE pem_place(vec3 d)
{
    return paraboloid_project(normalize(d));
}
vec3 pem(int i, PLACE at, float level)
{
    return paraboloid_fetch(region_range.x + i, at, level);
}
#else
#define PLACE vec3
PLACE pem_place(vec3 d)
{
    return d;
}
vec3 pem(int i, PLACE at, float level)
{
    return textureLod(pems, vec4(at, float(i)), level).rgb;
}
#endif

float share(int i, Sample place)
{
    Region region = regions[region_range.x + i];
    return visibility(i, region, place.point, place.smooth_normal) - already_there;
}

void main()
{
    Sample place = read_sample(ivec2(gl_FragCoord.xy));
    vec3 sum = vec3(0.0);
    if (lobe == LOBE_SINGLE) {
        // One look-up for direction and glossiness [Knuth et al. 2014, 3.2]. The paper does not state how they mix;
        // here they go from diffuse (n, kd) at g = 0 to mirror (r, F ks) at g = 1. n.r >= 0, so the mean never
        // vanishes.
        PLACE d = pem_place(into_environment(mix(place.normal, place.mirror, place.glossiness)));
        float level = lobe_level(place.glossiness);
        for (int i = 0; i < region_range.y; i++)
            sum += share(i, place) * pem(i, d, level);
        sum *= mix(place.kd, place.ks, place.glossiness);
    } else {
        PLACE d = pem_place(into_environment(place.normal)), m = pem_place(into_environment(place.mirror));
        float diffuse_level = lobe_level(0.0), gloss_level = lobe_level(place.glossiness);
#ifdef LOBE_SUMS
        PLACE at[SUM_MAX];
        float levels[SUM_MAX];
        vec3 weights[SUM_MAX];
        int count = 0;
        for (int k = 0; k < sum_count; k++) {
            ivec2 texel = ivec2(gl_FragCoord.xy);
            vec4 axis = texelFetch(lobe_sums, ivec3(texel, 2 * k), 0);
            vec4 weight = texelFetch(lobe_sums, ivec3(texel, 2 * k + 1), 0);
            if (weight.a == 0.0)
                break;
            at[count] = pem_place(into_environment(axis.xyz));
            levels[count] = lobe_level(1.0 - axis.w);
            weights[count++] = weight.rgb;
        }
        for (int i = 0; i < region_range.y; i++) {
            vec3 both = place.kd * pem(i, d, diffuse_level);
            if (count == 0)
                both += place.ks * pem(i, m, gloss_level);
            for (int k = 0; k < count; k++)
                both += weights[k] * pem(i, at[k], levels[k]);
            sum += share(i, place) * both;
        }
#else
        for (int i = 0; i < region_range.y; i++) {
            vec3 both = place.kd * pem(i, d, diffuse_level) + place.ks * pem(i, m, gloss_level);
            sum += share(i, place) * both;
        }
#endif
    }
    light = vec4(sum * pem_scale * place.cover, 0.0);
}
