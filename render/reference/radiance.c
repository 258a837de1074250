#include "render/reference/radiance.h"

#include "render/brdf/fuzz.h"
#include "render/light/options.h"
#include "render/reference/lamps.h"
#include "render/reference/lobe_sample.h"

#include <float.h>
#include <math.h>

/* Samples of the environment at points that paths hit, at most: few, because there are many such points, and
 * fewer at those that are hit from them. */
#define HIT_STRATA       64
#define FURTHER_STRATA   16
#define HIT_LOBE_SAMPLES 1

/* Paths that carry less than this are followed by chance, with as much more
 * weight: lobes of a few per cent would multiply the paths from bounce to bounce. */
#define FOLLOWED_WEIGHT 0.25f

/* Points that paths hit, and what each sends on to the point that its path comes from. */
struct path_hits {
    struct tl_shading_points points;
    int owner[TL_SHADING_POINTS];
    vec3s weight[TL_SHADING_POINTS];
    vec3s lamplight[TL_SHADING_POINTS];
};

struct paths {
    const struct tl_radiance_request *request;
    const struct tl_reference_scene *scene;
    const struct tl_shading_points *points;
    int samples; /* paths of a lobe */
    struct tl_random random;
    float (*light)[TL_SHADING_POINTS];
    struct path_hits hits;
    size_t rays;
};

static double share_of_sample(struct paths *paths, int sample)
{
    return (sample + tl_random_unit(&paths->random)) / paths->samples;
}

/* Lights the hits and sends their light on. */
static void light_hits(struct paths *paths)
{
    struct path_hits *hits = &paths->hits;
    if (hits->points.count == 0)
        return;
    struct tl_sky_sample sky[HIT_STRATA];
    const int maximum = paths->samples > 1 ? HIT_STRATA : FURTHER_STRATA;
    const int strata = paths->request->direct.strata < maximum ? paths->request->direct.strata : maximum;
    struct tl_random own = {tl_random_bits(&paths->random)};
    tl_gather_sample_sky(&paths->scene->sky, strata, 0, 1, tl_random_begin(own.state, 1), own, sky);
    const struct tl_radiance_request inner = {
        .direct = {.scene = paths->scene,
                   .strata = strata,
                   .sky = sky,
                   .lobe_samples = HIT_LOBE_SAMPLES,
                   .random = tl_random_begin(own.state, 2)},
        .bounces = paths->request->bounces > 0 ? paths->request->bounces - 1 : 0,
        .bounce_samples = 1};
    float light[3][TL_SHADING_POINTS];
    paths->rays += tl_radiance(&inner, &hits->points, light);
    for (int h = 0; h < hits->points.count; h++)
        for (int c = 0; c < 3; c++) {
            float *sum = &paths->light[c][hits->owner[h]];
            float sent = hits->weight[h].raw[c] * (light[c][h] + hits->lamplight[h].raw[c]);
            *sum = fminf(*sum + (sent > 0 ? sent : 0), FLT_MAX);
        }
    hits->points.count = 0;
    hits->points.any_layered = false;
}

static void add_hit(struct paths *paths, int owner, const struct tl_shading_point *hit, vec3s weight)
{
    struct path_hits *hits = &paths->hits;
    const int h = hits->points.count;
    tl_shading_points_add(&hits->points, hit);
    hits->owner[h] = owner;
    hits->weight[h] = weight;
    hits->lamplight[h] = tl_reference_lamps(paths->scene, hit, &paths->rays);
    if (hits->points.count == TL_SHADING_POINTS)
        light_hits(paths);
}

/* Follows a path from a point to what it hits. Where it is one of many, it sends light back from every open
 * sheet that it meets; a path that stands alone ends at one of them, chosen by chance, or its light would
 * multiply with every bounce. The last layer counts as closed, as for rays from the camera. */
static void follow(struct paths *paths, int owner, vec3s origin, vec3s direction, vec3s weight)
{
    const bool is_alone = paths->samples == 1;
    struct tl_ray_differential ray = {.origin = origin, .direction = direction, .to_m = INFINITY};
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS && glms_vec3_max(weight) > 0; layer++) {
        struct tl_shading_point hit = tl_shading_point_find(paths->scene, &ray);
        paths->rays++;
        if (!(hit.cover > 0))
            return;
        float openness = hit.layered && layer < TL_TRANSPARENCY_LAYERS ? hit.layers.openness : 0;
        if (is_alone && openness > 0) /* 1: it passes */
            openness = tl_random_unit(&paths->random) < (double)openness ? 1 : 0;
        if (openness < 1)
            add_hit(paths, owner, &hit, glms_vec3_scale(weight, hit.cover * (1 - openness)));
        weight = glms_vec3_scale(weight, openness);
        ray.from_m = hit.distance_m + paths->scene->offset_m;
    }
}

/* Russian roulette [Arvo and Kirk 1990]. False: the path ends. */
static bool goes_on(struct paths *paths, vec3s *weight)
{
    float maximum = glms_vec3_max(*weight);
    if (paths->samples > 1 || !(maximum < FOLLOWED_WEIGHT))
        return true;
    if (FOLLOWED_WEIGHT * (float)tl_random_unit(&paths->random) >= maximum)
        return false;
    *weight = glms_vec3_scale(*weight, FOLLOWED_WEIGHT / maximum);
    return true;
}

static void follow_above(struct paths *paths, int i, vec3s direction, vec3s weight)
{
    if (glms_vec3_dot(tl_shading_lane(paths->points->horizon, i), direction) > 0 && goes_on(paths, &weight))
        follow(paths, i, tl_shading_lane(paths->points->point, i), direction, weight);
}

/* The diffuse lobe, K_1. */
static void follow_diffuse(struct paths *paths, int i, int sample)
{
    float off;
    double height = share_of_sample(paths, sample), turn = tl_random_unit(&paths->random);
    vec3s weight = glms_vec3_divs(tl_shading_lane(paths->points->diffuse, i), (float)paths->samples);
    vec3s direction = tl_lobe_sample(tl_shading_lane(paths->points->normal, i), 1, height, turn, &off);
    if (paths->points->layered[i])
        weight = glms_vec3_scale(weight, material_matt(paths->points->layers[i].lobes.over, direction));
    if (glms_vec3_max(weight) > 0)
        follow_above(paths, i, direction, weight);
}

static void follow_glossy(struct paths *paths, int i, int sample)
{
    float off;
    double height = share_of_sample(paths, sample), turn = tl_random_unit(&paths->random);
    vec3s weight = glms_vec3_divs(tl_shading_lane(paths->points->glossy, i), (float)paths->samples);
    if (!(glms_vec3_max(weight) > 0))
        return;
    vec3s direction = tl_lobe_sample(tl_shading_lane(paths->points->axis, i), paths->points->exponent[i],
                                     height, turn, &off);
    follow_above(paths, i, direction, weight);
}

static void follow_transmitted(struct paths *paths, int i, int sample)
{
    const struct tl_shading_layers *layers = &paths->points->layers[i];
    float off;
    double height = share_of_sample(paths, sample), turn = tl_random_unit(&paths->random);
    vec3s behind = glms_vec3_negate(tl_shading_lane(paths->points->normal, i));
    vec3s direction = tl_lobe_sample(behind, 1, height, turn, &off);
    vec3s weight = glms_vec3_divs(layers->transmitted, (float)paths->samples);
    if (glms_vec3_max(weight) > 0 && glms_vec3_dot(tl_shading_lane(paths->points->horizon, i), direction) < 0)
        follow(paths, i, layers->behind, direction, weight);
}

static void follow_coat(struct paths *paths, int i, int sample)
{
    const struct tl_material_lobes *lobes = &paths->points->layers[i].lobes;
    float off, weight = lobes->over.coat / (float)paths->samples;
    double height = share_of_sample(paths, sample), turn = tl_random_unit(&paths->random);
    if (weight > 0)
        follow_above(paths, i,
                     tl_lobe_sample(lobes->over.coat_axis, lobes->over.coat_exponent, height, turn, &off),
                     (vec3s){{weight, weight, weight}});
}

/* Each lobe of the gloss by directions of its own. */
static void follow_facets(struct paths *paths, int i, int sample, int lobe)
{
    const struct tl_material_lobes *lobes = &paths->points->layers[i].lobes;
    const float below_one = 1 - 0x1p-24f;
    float height = fminf((float)share_of_sample(paths, sample), below_one), pdf;
    float turn = fminf((float)tl_random_unit(&paths->random), below_one);
    if (!lobes->is_faceted || lobe >= lobes->gloss.count)
        return;
    const struct tl_brdf *brdf = &lobes->gloss.items[lobe];
    vec3s viewer = paths->points->viewer[i];
    vec3s direction = tl_brdf_sample(brdf, &lobes->frame, viewer, height, turn, &pdf);
    if (!(pdf > 0))
        return;
    vec3s gloss = tl_brdf_gloss(brdf, &lobes->frame, direction, viewer);
    follow_above(paths, i, direction, glms_vec3_scale(gloss, lobes->over.base / pdf / (float)paths->samples));
}

/* Directions are uniform above the smooth surface, because fuzz does not follow the cosine. */
static void follow_fuzz(struct paths *paths, int i, int sample)
{
    const struct tl_material_lobes *lobes = &paths->points->layers[i].lobes;
    float off;
    double height = share_of_sample(paths, sample), turn = tl_random_unit(&paths->random);
    if (!(fuzz_strength(lobes->over.fuzz) > 0))
        return;
    vec3s direction = tl_lobe_sample(lobes->over.fuzz_axis, 0, height, turn, &off);
    float fibres =
        fuzz_value(lobes->over.roughness, lobes->over.fuzz_axis, direction, paths->points->viewer[i]);
    follow_above(paths, i, direction,
                 glms_vec3_scale(lobes->over.fuzz, fibres * 2 * (float)M_PI / (float)paths->samples));
}

static void follow_paths(struct paths *paths, int i, int sample)
{
    bool all = paths->request->bounces > 0;
    bool mirror = paths->request->reflect && paths->points->exponent[i] >= TL_MIRROR_EXPONENT;
    if (all)
        follow_diffuse(paths, i, sample);
    if (all || mirror)
        follow_glossy(paths, i, sample);
    if (!all || !paths->points->layered[i])
        return;
    follow_transmitted(paths, i, sample);
    follow_coat(paths, i, sample);
    for (int lobe = 0; lobe < 1 + TL_THREADS_MAX; lobe++)
        follow_facets(paths, i, sample, lobe);
    follow_fuzz(paths, i, sample);
}

size_t tl_radiance(const struct tl_radiance_request *request, const struct tl_shading_points *points,
                   float light[3][TL_SHADING_POINTS])
{
    size_t rays = tl_gather(&request->direct, points, light);
    if (request->bounces == 0 && !request->reflect)
        return rays;
    struct paths paths = {.request = request,
                          .scene = request->direct.scene,
                          .points = points,
                          .samples =
                              request->bounces > 0 ? request->bounce_samples : request->direct.lobe_samples,
                          .random = tl_random_begin(request->direct.random.state, 3),
                          .light = light};
    for (int sample = 0; sample < paths.samples; sample++)
        for (int i = 0; i < points->count; i++)
            follow_paths(&paths, i, sample);
    light_hits(&paths);
    return rays + paths.rays;
}
