#include "render/reference/gather.h"

#include "config/base/simd.h"
#include "render/brdf/fuzz.h"
#include "render/reference/lobe_sample.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define GOLDEN                                                                                               \
    0.61803398874989485 /* of a turn: successive angles are evenly spread for any number of samples */

void tl_shading_points_add(struct tl_shading_points *points, const struct tl_shading_point *point)
{
    int i = points->count++;
    for (int c = 0; c < 3; c++) {
        points->point[c][i] = point->point.raw[c];
        points->horizon[c][i] = point->horizon.raw[c];
        points->normal[c][i] = point->normal.raw[c];
        points->axis[c][i] = point->axis.raw[c];
        points->diffuse[c][i] = point->diffuse.raw[c];
        points->glossy[c][i] = point->glossy.raw[c];
    }
    points->exponent[i] = point->exponent;
    points->layered[i] = point->layered;
    if (point->layered) {
        points->any_layered = true;
        points->layers[i] = point->layers;
        points->viewer[i] = point->viewer;
    }
}

/* The state of one call of tl_gather. */
struct gather {
    const struct tl_gather_request *request;
    const struct tl_reference_scene *scene;
    const struct tl_shading_points *points;
    bool diffuse[TL_SHADING_POINTS], glossy[TL_SHADING_POINTS]; /* true if the point has such a lobe */
    double turn[TL_SHADING_POINTS]; /* azimuth of the first lobe sample of a point */
    struct tl_random random;
    float (*light)[TL_SHADING_POINTS];
    size_t rays;
};

/* A batch of shadow rays with the radiance that each contributes to its point if it is not occluded. */
struct ray_batch {
    struct tl_ray_packet packet;
    int index[TL_SHADING_POINTS];
    vec3s light[TL_SHADING_POINTS];
};

/* Starts a batch. Lanes without a ray stay uninitialised. */
static void begin_batch(struct ray_batch *batch, bool coherent)
{
    batch->packet.count = 0;
    batch->packet.from_m = 0;
    batch->packet.to_m = INFINITY;
    batch->packet.coherent = coherent;
}

static void add_ray_from(struct ray_batch *batch, const struct gather *gather, int index, vec3s origin,
                         vec3s direction, vec3s light)
{
    int i = batch->packet.count++;
    batch->packet.origin_x[i] = origin.x;
    batch->packet.origin_y[i] = origin.y;
    batch->packet.origin_z[i] = origin.z;
    batch->packet.direction_x[i] = direction.x;
    batch->packet.direction_y[i] = direction.y;
    batch->packet.direction_z[i] = direction.z;
    batch->index[i] = index;
    batch->light[i] = glms_vec3_scale(light, tl_ground_visibility(gather->scene->ground, origin, direction));
}

static void add_ray(struct ray_batch *batch, const struct gather *gather, int index, vec3s direction,
                    vec3s light)
{
    add_ray_from(batch, gather, index, tl_shading_lane(gather->points->point, index), direction, light);
}

static void add_light(struct gather *gather, int index, vec3s light)
{
    for (int c = 0; c < 3; c++)
        gather->light[c][index] += light.raw[c];
}

/* Traces the batch and adds the light that arrives. */
static void trace_batch(struct gather *gather, struct ray_batch *batch)
{
    if (batch->packet.count == 0)
        return;
    float seen[TL_SHADING_POINTS];
    tl_trace_transmittance_packet(gather->scene->trace, &batch->packet, seen);
    for (int i = 0; i < batch->packet.count; i++)
        add_light(gather, batch->index[i], glms_vec3_scale(batch->light[i], seen[i]));
    gather->rays += (size_t)batch->packet.count;
}

static float kept_finite(float value)
{
    return value < FLT_MAX ? value : FLT_MAX;
}

static vec3s weigh(const struct tl_shading_points *points, int i, vec3s radiance, float diffuse, float glossy)
{
    vec3s light;
    for (int c = 0; c < 3; c++)
        light.raw[c] =
            kept_finite(radiance.raw[c] * (points->diffuse[c][i] * diffuse + points->glossy[c][i] * glossy));
    return light;
}

static bool is_dark(vec3s light)
{
    return !(light.x > 0 || light.y > 0 || light.z > 0);
}

/* Cosines of a direction with the horizon and the normal of every point, and 1 - its cosine with the axis. */
struct angles {
    float horizon[TL_SHADING_POINTS], normal[TL_SHADING_POINTS], off_axis[TL_SHADING_POINTS];
};

TL_CLONES static void measure_angles(const struct tl_shading_points *points, vec3s w, struct angles *out)
{
    for (int i = 0; i < TL_SHADING_POINTS; i++) {
        out->horizon[i] =
            points->horizon[0][i] * w.x + points->horizon[1][i] * w.y + points->horizon[2][i] * w.z;
        out->normal[i] = points->normal[0][i] * w.x + points->normal[1][i] * w.y + points->normal[2][i] * w.z;
        /* Half of the squared distance, which does not cancel where the two directions are close. */
        float x = points->axis[0][i] - w.x, y = points->axis[1][i] - w.y, z = points->axis[2][i] - w.z;
        out->off_axis[i] = 0.5f * (x * x + y * y + z * z);
    }
}

/* 1 - the cosine of two directions, without cancellation where they are close. */
static float off_axis(vec3s axis, vec3s w)
{
    return 0.5f * glms_vec3_norm2(glms_vec3_sub(axis, w));
}

static vec3s finite_product(vec3s radiance, vec3s share)
{
    vec3s light;
    for (int c = 0; c < 3; c++)
        light.raw[c] = share.raw[c] > 0 ? kept_finite(radiance.raw[c] * share.raw[c]) : 0;
    return light;
}

/* The weights of coat, facets and fuzz for a direction from the environment, by the balance heuristic: f /
 * (p_environment + n p_lobe), where `sample_pdf` is the number of environment samples times their pdf. */
static vec3s layered_share(const struct gather *gather, int i, vec3s direction, float sample_pdf)
{
    const struct tl_material_lobes *lobes = &gather->points->layers[i].lobes;
    float count = (float)gather->request->lobe_samples;
    vec3s share = {{0, 0, 0}};
    if (lobes->over.coat > 0) {
        float lobe = tl_lobe_value(lobes->over.coat_exponent, off_axis(lobes->over.coat_axis, direction));
        float coat = lobes->over.coat * lobe / (sample_pdf + count * lobe);
        share = (vec3s){{coat, coat, coat}};
    }
    if (lobes->is_faceted) {
        vec3s viewer = gather->points->viewer[i];
        for (int k = 0; k < lobes->gloss.count; k++) {
            const struct tl_brdf *brdf = &lobes->gloss.items[k];
            vec3s gloss = tl_brdf_gloss(brdf, &lobes->frame, direction, viewer);
            float pdf = tl_brdf_pdf(brdf, &lobes->frame, direction, viewer);
            share =
                glms_vec3_add(share, glms_vec3_scale(gloss, lobes->over.base / (sample_pdf + count * pdf)));
        }
    }
    if (fuzz_strength(lobes->over.fuzz) > 0) { /* broad: the environment's samples are enough */
        float fibres =
            fuzz_value(lobes->over.roughness, lobes->over.fuzz_axis, direction, gather->points->viewer[i]);
        share = glms_vec3_add(share, glms_vec3_scale(lobes->over.fuzz, fibres / sample_pdf));
    }
    return share;
}

/* Adds the light that is transmitted from the other side of sheets. */
static void gather_transmitted(struct gather *gather, const struct tl_sky_sample *sky)
{
    const struct tl_shading_points *points = gather->points;
    float sample_pdf = (float)gather->request->strata * sky->pdf;
    struct ray_batch batch;
    begin_batch(&batch, true);
    for (int i = 0; i < points->count; i++) {
        float below = -glms_vec3_dot(tl_shading_lane(points->normal, i), sky->direction);
        if (!points->layered[i] || !(below > 0) ||
            !(glms_vec3_dot(tl_shading_lane(points->horizon, i), sky->direction) < 0))
            continue;
        vec3s share = glms_vec3_scale(points->layers[i].transmitted, below / (float)M_PI / sample_pdf);
        vec3s light = finite_product(sky->radiance, share);
        if (!is_dark(light))
            add_ray_from(&batch, gather, i, points->layers[i].behind, sky->direction, light);
    }
    trace_batch(gather, &batch);
}

/* Adds one sample of the environment for all points, weighted by the balance heuristic against the lobe
 * samples. */
static void gather_stratum(struct gather *gather, const struct tl_sky_sample *sky)
{
    const struct tl_shading_points *points = gather->points;
    float sample_pdf = (float)gather->request->strata * sky->pdf;
    struct ray_batch batch;
    struct angles angles;
    measure_angles(points, sky->direction, &angles);
    begin_batch(&batch, true);
    for (int i = 0; i < points->count; i++) {
        if (!(angles.horizon[i] > 0))
            continue;
        float diffuse = 0, glossy = 0;
        if (gather->diffuse[i] && angles.normal[i] > 0)
            diffuse = angles.normal[i] / (float)M_PI / sample_pdf;
        if (points->layered[i])
            diffuse *= material_matt(points->layers[i].lobes.over, sky->direction);
        if (gather->glossy[i]) {
            float lobe = tl_lobe_value(points->exponent[i], angles.off_axis[i]);
            glossy = lobe / (sample_pdf + (float)gather->request->lobe_samples * lobe);
        }
        vec3s light = weigh(points, i, sky->radiance, diffuse, glossy);
        if (points->layered[i]) {
            vec3s share = layered_share(gather, i, sky->direction, sample_pdf);
            light = glms_vec3_add(light, finite_product(sky->radiance, share));
        }
        if (!is_dark(light))
            add_ray(&batch, gather, i, sky->direction, light);
    }
    trace_batch(gather, &batch);
}

void tl_gather_sample_sky(const struct tl_sky *sky, int count, int slot, int slots, struct tl_random shared,
                          struct tl_random own, struct tl_sky_sample *out)
{
    for (int i = 0; i < count; i++) {
        int turn = (int)(tl_random_unit(&shared) * slots);
        double within = ((slot + turn) % slots + tl_random_unit(&own)) / slots;
        out[i] = tl_sky_sample_at(sky, (i + within) / count);
    }
}

/* Adds one sample of the cosine lobe of each point. */
static void gather_lobes(struct gather *gather, int sample)
{
    const struct tl_shading_points *points = gather->points;
    const struct tl_gather_request *request = gather->request;
    struct ray_batch batch;
    begin_batch(&batch, false);
    for (int i = 0; i < points->count; i++) {
        double height = (sample + tl_random_unit(&gather->random)) / request->lobe_samples;
        if (!gather->glossy[i])
            continue;
        float off;
        double turn = gather->turn[i] + sample * GOLDEN;
        vec3s axis = tl_shading_lane(points->axis, i);
        vec3s direction =
            tl_lobe_sample(axis, points->exponent[i], fmin(height, 1 - DBL_EPSILON), turn, &off);
        if (!(glms_vec3_dot(tl_shading_lane(points->horizon, i), direction) > 0))
            continue;
        struct tl_sky_sample sky = tl_sky_lookup(&gather->scene->sky, direction);
        float lobe = tl_lobe_value(points->exponent[i], off);
        if (!(lobe > 0))
            continue;
        float glossy = lobe / ((float)request->strata * sky.pdf + (float)request->lobe_samples * lobe);
        vec3s light = weigh(points, i, sky.radiance, 0, glossy);
        if (!is_dark(light))
            add_ray(&batch, gather, i, direction, light);
    }
    trace_batch(gather, &batch);
}

/* Two numbers in [0, 1) for sample `sample` of a lobe: stratified height, golden-ratio azimuth. */
static vec2s lobe_numbers(struct gather *gather, int i, int sample)
{
    double height = (sample + tl_random_unit(&gather->random)) / gather->request->lobe_samples;
    double turn = gather->turn[i] + sample * GOLDEN;
    const float below_one = 1 - 0x1p-24f;
    return (vec2s){{fminf((float)height, below_one), fminf((float)(turn - floor(turn)), below_one)}};
}

/* Adds one sample of the coat of each point. */
static void gather_coats(struct gather *gather, int sample)
{
    const struct tl_gather_request *request = gather->request;
    struct ray_batch batch;
    begin_batch(&batch, false);
    for (int i = 0; i < gather->points->count; i++) {
        const struct tl_material_lobes *lobes = &gather->points->layers[i].lobes;
        if (!gather->points->layered[i] || !(lobes->over.coat > 0))
            continue;
        float off;
        vec2s numbers = lobe_numbers(gather, i, sample);
        vec3s direction = tl_lobe_sample(lobes->over.coat_axis, lobes->over.coat_exponent, (double)numbers.x,
                                         (double)numbers.y, &off);
        float lobe = tl_lobe_value(lobes->over.coat_exponent, off);
        if (!(glms_vec3_dot(tl_shading_lane(gather->points->horizon, i), direction) > 0) || !(lobe > 0))
            continue;
        struct tl_sky_sample sky = tl_sky_lookup(&gather->scene->sky, direction);
        float share = lobes->over.coat * lobe /
                      ((float)request->strata * sky.pdf + (float)request->lobe_samples * lobe);
        vec3s light = finite_product(sky.radiance, (vec3s){{share, share, share}});
        if (!is_dark(light))
            add_ray(&batch, gather, i, direction, light);
    }
    trace_batch(gather, &batch);
}

/* Adds one sample of lobe `lobe` of the facets of each point that has so many. */
static void gather_facets(struct gather *gather, int sample, int lobe)
{
    const struct tl_gather_request *request = gather->request;
    struct ray_batch batch;
    begin_batch(&batch, false);
    for (int i = 0; i < gather->points->count; i++) {
        const struct tl_material_lobes *lobes = &gather->points->layers[i].lobes;
        if (!gather->points->layered[i] || !lobes->is_faceted || lobe >= lobes->gloss.count)
            continue;
        float pdf;
        const struct tl_brdf *brdf = &lobes->gloss.items[lobe];
        vec3s viewer = gather->points->viewer[i];
        vec2s numbers = lobe_numbers(gather, i, sample);
        vec3s direction = tl_brdf_sample(brdf, &lobes->frame, viewer, numbers.x, numbers.y, &pdf);
        if (!(pdf > 0) || !(glms_vec3_dot(tl_shading_lane(gather->points->horizon, i), direction) > 0))
            continue;
        struct tl_sky_sample sky = tl_sky_lookup(&gather->scene->sky, direction);
        vec3s gloss = tl_brdf_gloss(brdf, &lobes->frame, direction, viewer);
        float sample_pdf = (float)request->strata * sky.pdf + (float)request->lobe_samples * pdf;
        vec3s light = finite_product(sky.radiance, glms_vec3_scale(gloss, lobes->over.base / sample_pdf));
        if (!is_dark(light))
            add_ray(&batch, gather, i, direction, light);
    }
    trace_batch(gather, &batch);
}

static void gather_layers(struct gather *gather)
{
    for (int i = 0; i < gather->request->strata; i++)
        gather_transmitted(gather, &gather->request->sky[i]);
    for (int i = 0; i < gather->request->lobe_samples; i++) {
        gather_coats(gather, i);
        for (int lobe = 0; lobe < 1 + TL_THREADS_MAX; lobe++)
            gather_facets(gather, i, lobe);
    }
}

size_t tl_gather(const struct tl_gather_request *request, const struct tl_shading_points *points,
                 float light[3][TL_SHADING_POINTS])
{
    struct gather gather = {.request = request,
                            .scene = request->scene,
                            .points = points,
                            .random = request->random,
                            .light = light};
    bool any_glossy = false;
    for (int i = 0; i < points->count; i++) {
        gather.diffuse[i] =
            points->diffuse[0][i] > 0 || points->diffuse[1][i] > 0 || points->diffuse[2][i] > 0;
        gather.glossy[i] = points->glossy[0][i] > 0 || points->glossy[1][i] > 0 || points->glossy[2][i] > 0;
        gather.turn[i] = tl_random_unit(&gather.random);
        any_glossy |= gather.glossy[i];
    }
    memset(light, 0, 3 * sizeof light[0]);
    for (int i = 0; i < request->strata; i++)
        gather_stratum(&gather, &request->sky[i]);
    for (int i = 0; any_glossy && i < request->lobe_samples; i++)
        gather_lobes(&gather, i);
    if (points->any_layered)
        gather_layers(&gather);
    for (int c = 0; c < 3; c++) /* clamp, because infinity times zero would become NaN later */
        for (int i = 0; i < points->count; i++)
            light[c][i] = kept_finite(light[c][i]);
    return gather.rays;
}
