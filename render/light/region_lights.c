#include "render/light/region_lights.h"

#include "config/cache/cache.h"
#include "render/light/version.h"

#include <math.h>

static void fill_lane(struct tl_region_group *group, int lane, const struct tl_region *region,
                      enum tl_region_weight weight)
{
    /* A disc whose mean square angle is spread^2 has the radius sqrt(2) spread. */
    float spread = weight == TL_WEIGHT_POINT ? 0 : region->spread;
    group->x[lane] = region->direction.x;
    group->y[lane] = region->direction.y;
    group->z[lane] = region->direction.z;
    group->sine[lane] = fmaxf(sinf(fminf(sqrtf(2) * spread, 1.5f)), 1e-3f);
    group->inverse_sine[lane] = 1 / group->sine[lane];
    group->spread[lane] = spread;
    for (int c = 0; c < 3; c++)
        group->power[c][lane] = weight == TL_WEIGHT_WHITE ? region->solid_angle : region->power.raw[c];
}

/* Lanes beyond the last region have no power, and must not divide by 0. */
static void fill_group(struct tl_region_group *group, const struct tl_region *regions, int count,
                       enum tl_region_weight weight)
{
    vec3s sum = {{0, 0, 0}};
    for (int lane = 0; lane < TL_LANES; lane++)
        group->sine[lane] = group->inverse_sine[lane] = 1;
    for (int lane = 0; lane < count; lane++) {
        fill_lane(group, lane, &regions[lane], weight);
        sum = glms_vec3_add(sum, regions[lane].direction);
    }
    group->axis = glms_vec3_normalize(sum);
    float reach = 0;
    for (int lane = 0; lane < count; lane++) {
        float cosine = fminf(fmaxf(glms_vec3_dot(group->axis, regions[lane].direction), -1), 1);
        reach = fmaxf(reach, acosf(cosine) + asinf(group->sine[lane]));
    }
    group->reach_sine = reach < GLM_PI_2f ? sinf(reach) : 2;
    group->reach_cosine = reach < GLM_PI_2f ? cosf(reach) : -2;
}

/* The sum that the exact light is divided by; see tl_lobe_map_function. `diffuse` is constant where it is
 * called: a branch in the loop would keep it from being done in vectors. */
TL_INLINE void sum_lobes(const struct tl_region_lights *lights, vec3s d, float s, bool diffuse, float sum[3])
{
    float lanes[3][TL_LANES] = {{0}};
    for (int g = 0; g < lights->group_count; g++) {
        const struct tl_region_group *group = &lights->groups[g];
        float lobe[TL_LANES];
        for (int lane = 0; lane < TL_LANES; lane++) {
            float cosine = group->x[lane] * d.x + group->y[lane] * d.y + group->z[lane] * d.z;
            float exponent = lobe_broadened_exponent(s, group->spread[lane]);
            lobe[lane] = diffuse
                             ? region_lobe_diffuse(cosine, group->sine[lane], group->inverse_sine[lane])
                             : region_lobe(cosine, group->sine[lane], group->inverse_sine[lane], exponent);
        }
        for (int c = 0; c < 3; c++)
            for (int lane = 0; lane < TL_LANES; lane++)
                lanes[c][lane] += group->power[c][lane] * lobe[lane];
    }
    for (int c = 0; c < 3; c++)
        sum[c] = tl_sum_lanes(lanes[c]);
}

TL_CLONES static void sum_gloss(const struct tl_region_lights *lights, vec3s d, float s, float sum[3])
{
    sum_lobes(lights, d, s, false, sum);
}

TL_CLONES static void sum_diffuse(const struct tl_region_lights *lights, vec3s d, float sum[3])
{
    sum_lobes(lights, d, 1, true, sum);
}

/* Divides channel by channel; 1 where no region has light. */
static vec3s divide(vec3s light, const float sum[3])
{
    vec3s gain;
    for (int c = 0; c < 3; c++)
        gain.raw[c] = sum[c] > 1e-20f ? light.raw[c] / sum[c] : 1;
    return gain;
}

static vec3s gain_of(vec3s direction, float exponent, vec3s light, const void *context)
{
    float sum[3];
    sum_gloss(context, direction, tl_minf(exponent, TL_REGION_LOBE_MAX), sum);
    return divide(light, sum);
}

static vec3s diffuse_gain_of(vec3s direction, float exponent, vec3s light, const void *context)
{
    float sum[3];
    (void)exponent;
    sum_diffuse(context, direction, sum);
    return divide(light, sum);
}

void tl_region_lights_begin(struct tl_region_lights *lights, const struct tl_regions *regions,
                            enum tl_region_weight weight)
{
    tl_region_lights_release(lights);
    lights->group_count = (regions->count + TL_LANES - 1) / TL_LANES;
    for (int g = 0; g < lights->group_count; g++) {
        int first = g * TL_LANES, left = regions->count - first;
        fill_group(&lights->groups[g], &regions->items[first], left < TL_LANES ? left : TL_LANES, weight);
        for (int lane = 0; lane < TL_LANES; lane++)
            lights->spread_max = fmaxf(lights->spread_max, lights->groups[g].spread[lane]);
    }
    lights->is_exact = weight == TL_WEIGHT_POWER;
}

/* A hash of all that gains depend on but for the lobes. */
static struct tl_cache_key key_of(const struct tl_region_lights *lights, bool diffuse)
{
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, TL_LIGHTS_VERSION, sizeof TL_LIGHTS_VERSION);
    tl_cache_key_add(&key, &diffuse, sizeof diffuse);
    tl_cache_key_add(&key, lights->groups, (size_t)lights->group_count * sizeof *lights->groups);
    return key;
}

void tl_region_lights_add(struct tl_region_lights *lights, const struct tl_lobes *lobes, uint32_t exponents)
{
    if (!lights->is_exact)
        return;
    const struct tl_cache_key key = key_of(lights, false), diffuse_key = key_of(lights, true);
    struct tl_lobes gain = tl_lobes_map(lobes, exponents & ~lights->gain.made, gain_of, lights, &key);
    tl_lobes_merge(&lights->gain, &gain);
    struct tl_lobes diffuse =
        tl_lobes_map(lobes, 1u & ~lights->diffuse_gain.made, diffuse_gain_of, lights, &diffuse_key);
    tl_lobes_merge(&lights->diffuse_gain, &diffuse);
}

bool tl_region_lights_have(const struct tl_region_lights *lights, uint32_t exponents)
{
    return !lights->is_exact || !(exponents & ~lights->gain.made);
}

void tl_region_lights_release(struct tl_region_lights *lights)
{
    tl_lobes_release(&lights->gain);
    tl_lobes_release(&lights->diffuse_gain);
    *lights = (struct tl_region_lights){0};
}
