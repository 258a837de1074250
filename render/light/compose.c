#include "render/light/compose.h"

#include "config/simd.h"
#include "render/pem/lobe.h"
#include "render/visibility/maps.h"

#include <math.h>

#define GROUPS_MAX (TL_REGIONS_MAX / TL_LANES)

/* Sixteen regions, one a lane. */
struct group {
    float x[TL_LANES], y[TL_LANES], z[TL_LANES]; /* towards the region, world */
    float sine[TL_LANES];          /* of the half-angle over which the region's light is spread */
    float spread_square[TL_LANES]; /* rad^2 */
    float power[3][TL_LANES];
};

struct regions {
    int group_count;
    struct group groups[GROUPS_MAX];
};

/* One lobe of a sample: about a direction, with an exponent. */
struct lobe {
    vec3s direction;
    float exponent;
};

/* sum w_i and sum v_i w_i by channel, of the diffuse and of the glossy lobe. */
struct sums {
    float all[2][3], seen[2][3];
};
enum { DIFFUSE, GLOSSY };

static void fill_group(struct group *group, int lane, const struct tl_region *region, float yaw, int method)
{
    vec3s direction = tl_turn_direction(region->direction, yaw);
    bool is_point = method == TL_METHOD_LIGHTS, is_white = method == TL_METHOD_AO;
    /* A disc whose mean square angle is spread^2 has the radius sqrt(2) spread. */
    float spread = is_point ? 0 : region->spread;
    group->x[lane] = direction.x;
    group->y[lane] = direction.y;
    group->z[lane] = direction.z;
    group->sine[lane] = fmaxf(sinf(fminf(sqrtf(2) * spread, 1.5f)), 1e-3f);
    group->spread_square[lane] = spread * spread;
    for (int c = 0; c < 3; c++)
        group->power[c][lane] = is_white ? region->solid_angle : region->power.raw[c];
}

static void regions_make(const struct tl_compose_request *request, struct regions *out)
{
    *out = (struct regions){.group_count = (request->regions->count + TL_LANES - 1) / TL_LANES};
    for (int g = 0; g < out->group_count; g++)
        for (int lane = 0; lane < TL_LANES; lane++)
            out->groups[g].sine[lane] = 1; /* beyond the last region: no power, and no division by 0 */
    for (int i = 0; i < request->regions->count; i++)
        fill_group(&out->groups[i / TL_LANES], i % TL_LANES, &request->regions->items[i],
                   request->environment_yaw, request->params->method);
}

/* The part of a disc above the horizon, whose centre is x of its radii above it: the cubic that is nearest to
 * the circle's own share (within 0.02). */
TL_INLINE float share_above(float x)
{
    float t = tl_lesser(tl_greater(0.5f + 0.5f * x, 0), 1);
    return t * t * (3.0f - 2.0f * t);
}

/* The mean of max(0, cosine) over a disc, x as above: cosine itself above the horizon, 0 below, and a
 * parabola that joins both smoothly while the disc sets. */
TL_INLINE float mean_cosine(float cosine, float x, float sine)
{
    float risen = tl_lesser(tl_greater(x + 1.0f, 0), 2);
    return tl_greater(cosine, 0.25f * sine * risen * risen);
}

/* Visibility of group g at a sample. */
TL_INLINE void read_visibility(const uint16_t *values, size_t stride, const struct tl_taps *taps, int g,
                               float visibility[TL_LANES])
{
    const uint16_t *rows[TL_TAPS];
    float weights[TL_TAPS];
    for (int t = 0; t < TL_TAPS; t++) {
        rows[t] = values + taps->point[t] * stride + (size_t)g * TL_LANES;
        weights[t] = taps->weight[t] / TL_VISIBILITY_ONE;
    }
    for (int lane = 0; lane < TL_LANES; lane++)
        visibility[lane] = weights[0] * (float)rows[0][lane] + weights[1] * (float)rows[1][lane] +
                           weights[2] * (float)rows[2][lane] + weights[3] * (float)rows[3][lane];
}

struct accumulator {
    float all[2][3][TL_LANES], seen[2][3][TL_LANES];
};

TL_INLINE void add_weights(float all[TL_LANES], float seen[TL_LANES], const float power[TL_LANES],
                           const float lobe[TL_LANES], const float part[TL_LANES])
{
    for (int lane = 0; lane < TL_LANES; lane++) {
        float weight = power[lane] * lobe[lane];
        all[lane] += weight;
        seen[lane] += weight * part[lane];
    }
}

/* Light below the plane of the smooth normal does not arrive, even where a map turns the shading normal
 * towards it. A diffuse lobe about the smooth normal ends there by itself. */
TL_INLINE void add_group(struct accumulator *sums, const struct group *group, const tl_sample *sample,
                         const struct lobe *gloss, const float visibility[TL_LANES])
{
    const vec3s smooth = sample->smooth, normal = sample->normal, mirror = gloss->direction;
    float diffuse[TL_LANES], diffuse_part[TL_LANES], glossy[TL_LANES], glossy_part[TL_LANES];
    for (int lane = 0; lane < TL_LANES; lane++) {
        float x = group->x[lane], y = group->y[lane], z = group->z[lane], sine = group->sine[lane];
        float inverse = 1.0f / sine;
        float above = share_above((x * smooth.x + y * smooth.y + z * smooth.z) * inverse);
        float cosine = x * normal.x + y * normal.y + z * normal.z;
        float facing = share_above(cosine * inverse);
        diffuse[lane] = mean_cosine(cosine, cosine * inverse, sine);
        diffuse_part[lane] = tl_lesser(above / tl_greater(facing, 1e-6f), 1) * visibility[lane];

        float gloss_cosine = x * mirror.x + y * mirror.y + z * mirror.z;
        float exponent = gloss->exponent / (1.0f + gloss->exponent * group->spread_square[lane]);
        float base = mean_cosine(gloss_cosine, gloss_cosine * inverse, sine);
        glossy[lane] = (exponent + 1.0f) * tl_power(base, exponent);
        glossy_part[lane] = above * visibility[lane];
    }
    for (int c = 0; c < 3; c++) {
        add_weights(sums->all[DIFFUSE][c], sums->seen[DIFFUSE][c], group->power[c], diffuse, diffuse_part);
        add_weights(sums->all[GLOSSY][c], sums->seen[GLOSSY][c], group->power[c], glossy, glossy_part);
    }
}

TL_INLINE struct sums sum_groups(const struct regions *regions, const tl_sample *sample,
                                 const struct lobe *gloss, const uint16_t *values, size_t stride,
                                 const struct tl_taps *taps)
{
    struct accumulator lanes = {0};
    for (int g = 0; g < regions->group_count; g++) {
        float visibility[TL_LANES];
        read_visibility(values, stride, taps, g, visibility);
        add_group(&lanes, &regions->groups[g], sample, gloss, visibility);
    }
    struct sums sums;
    for (int kind = 0; kind < 2; kind++)
        for (int c = 0; c < 3; c++) {
            sums.all[kind][c] = tl_sum_lanes(lanes.all[kind][c]);
            sums.seen[kind][c] = tl_sum_lanes(lanes.seen[kind][c]);
        }
    return sums;
}

/* Where nothing shines there is nothing to shadow. */
static vec3s ratio(const struct sums *sums, int kind)
{
    vec3s share;
    for (int c = 0; c < 3; c++)
        share.raw[c] = sums->all[kind][c] > 0 ? sums->seen[kind][c] / sums->all[kind][c] : 1;
    return share;
}

/* World direction -> direction in the environment, which is turned by its yaw about +Y. */
static vec3s into_environment(vec3s d, float yaw)
{
    return tl_turn_direction(d, -yaw);
}

/* What a sample receives through its two lobes, unshadowed and shadowed, before the material's colours. */
struct received {
    vec3s unshadowed[2], shadowed[2];
};

static void add_suns(const struct tl_compose_request *request, size_t index, const struct lobe *gloss,
                     struct received *light)
{
    const tl_sample *sample = &request->samples->items[index];
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        const float *visibility =
            request->params->method == TL_METHOD_UNSHADOWED ? NULL : tl_points_sun(request->points, i);
        vec3s direction = tl_turn_direction(sun->direction, request->environment_yaw);
        float above = share_above(glms_vec3_dot(direction, sample->smooth) / fmaxf(sun->radius, 1e-3f));
        float exponent = gloss->exponent / (1 + 0.5f * gloss->exponent * sun->radius * sun->radius);
        float lobes[2] = {tl_lobe_cosine(1, glms_vec3_dot(direction, sample->normal)),
                          tl_lobe_cosine(exponent, glms_vec3_dot(direction, gloss->direction))};
        for (int kind = 0; kind < 2; kind++) {
            vec3s arriving = glms_vec3_scale(sun->power, lobes[kind]);
            light->unshadowed[kind] = glms_vec3_add(light->unshadowed[kind], arriving);
            light->shadowed[kind] = glms_vec3_add(
                light->shadowed[kind], glms_vec3_scale(arriving, visibility ? above * visibility[index] : 1));
        }
    }
}

/* The two lobes of the material as one [002, section 3.4], its direction and colour between diffuse and
 * mirror. */
static struct lobe gloss_lobe(const tl_sample *sample, int lobe)
{
    vec3s direction = sample->mirror;
    if (lobe == TL_LOBE_SINGLE)
        direction = glms_vec3_normalize(glms_vec3_lerp(sample->normal, sample->mirror, sample->glossiness));
    return (struct lobe){direction, tl_lobe_exponent(sample->glossiness)};
}

static vec3s colour_of(const tl_sample *sample, int lobe, const vec3s light[2])
{
    if (lobe == TL_LOBE_SINGLE)
        return glms_vec3_mul(glms_vec3_lerp(sample->diffuse, sample->specular, sample->glossiness),
                             light[GLOSSY]);
    return glms_vec3_add(glms_vec3_mul(sample->diffuse, light[DIFFUSE]),
                         glms_vec3_mul(sample->specular, light[GLOSSY]));
}

static struct received receive(const struct tl_compose_request *request, const tl_sample *sample,
                               const struct lobe *gloss, const struct sums *sums)
{
    struct received light;
    if (request->params->method == TL_METHOD_LIGHTS) {
        /* A cosine is K_1 times pi; (s + 1) cos^s is K_s times 2 pi. */
        const float scales[2] = {GLM_1_PIf, 0.5f * GLM_1_PIf};
        for (int kind = 0; kind < 2; kind++)
            for (int c = 0; c < 3; c++) {
                light.unshadowed[kind].raw[c] = scales[kind] * sums->all[kind][c];
                light.shadowed[kind].raw[c] = scales[kind] * sums->seen[kind][c];
            }
        return light;
    }
    const float yaw = request->environment_yaw;
    light.unshadowed[DIFFUSE] = tl_lobes_fetch(request->lobes, into_environment(sample->normal, yaw),
                                               (struct tl_exponent_blend){.index = 0});
    light.unshadowed[GLOSSY] = tl_lobes_fetch(request->lobes, into_environment(gloss->direction, yaw),
                                              tl_exponent_blend(gloss->exponent));
    for (int kind = 0; kind < 2; kind++)
        light.shadowed[kind] = glms_vec3_mul(light.unshadowed[kind], ratio(sums, kind));
    return light;
}

/* Ambient occlusion knows one share for all light. */
static void replace_by_occlusion(const struct sums *sums, int method, struct received *light)
{
    vec3s share = ratio(sums, DIFFUSE);
    if (method == TL_METHOD_AO_COLOUR)
        for (int c = 0; c < 3; c++)
            share.raw[c] = light->unshadowed[DIFFUSE].raw[c] > 0
                               ? light->shadowed[DIFFUSE].raw[c] / light->unshadowed[DIFFUSE].raw[c]
                               : 1;
    for (int kind = 0; kind < 2; kind++)
        light->shadowed[kind] = glms_vec3_mul(light->unshadowed[kind], share);
}

static void compose_sample(const struct tl_compose_request *request, size_t index, const struct sums *sums,
                           const struct lobe *gloss, float *light)
{
    const tl_sample *sample = &request->samples->items[index];
    int method = request->params->method;
    struct received received = receive(request, sample, gloss, sums);
    add_suns(request, index, gloss, &received);
    if (method == TL_METHOD_AO || method == TL_METHOD_AO_COLOUR)
        replace_by_occlusion(sums, method, &received);
    const vec3s *arriving = method == TL_METHOD_UNSHADOWED ? received.unshadowed : received.shadowed;
    vec3s colour = colour_of(sample, request->params->lobe, arriving);
    float *texel = light + 4 * (size_t)sample->texel;
    for (int c = 0; c < 3; c++)
        texel[c] = colour.raw[c] * sample->cover;
    texel[3] = 0;
}

#define BLOCK 256 /* samples that a thread takes at a time */

TL_CLONES static void sum_block(const struct tl_compose_request *request, const struct regions *regions,
                                const uint16_t *values, size_t stride, const struct tl_taps *taps,
                                size_t first, size_t count, struct sums *sums)
{
    for (size_t i = 0; i < count; i++) {
        const tl_sample *sample = &request->samples->items[first + i];
        struct lobe gloss = gloss_lobe(sample, request->params->lobe);
        sums[i] = sum_groups(regions, sample, &gloss, values, stride, &taps[first + i]);
    }
}

void tl_compose(const struct tl_compose_request *request, float *light)
{
    struct regions regions;
    regions_make(request, &regions);
    size_t stride = 0, sample_count = request->samples->count;
    bool shadowed = request->params->method != TL_METHOD_UNSHADOWED;
    const uint16_t *values = shadowed ? tl_points_values(request->points, &stride) : NULL;
    const struct tl_taps *taps = shadowed ? tl_points_taps(request->points) : NULL;
#pragma omp parallel for schedule(dynamic)
    for (size_t first = 0; first < sample_count; first += BLOCK) {
        struct sums sums[BLOCK] = {0};
        size_t count = sample_count - first < BLOCK ? sample_count - first : BLOCK;
        if (shadowed)
            sum_block(request, &regions, values, stride, taps, first, count, sums);
        for (size_t i = 0; i < count; i++) {
            struct lobe gloss = gloss_lobe(&request->samples->items[first + i], request->params->lobe);
            compose_sample(request, first + i, &sums[i], &gloss, light);
        }
    }
}
