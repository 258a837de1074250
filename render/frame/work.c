/* Estimates the work of each job of a frame to come from the last frame's counts, at other settings. Costs
 * are CPU ms on a machine with two cores (the built-in scene, preset draft, 128 x 128 to 1024 x 1024 samples,
 * best of twelve frames); only their ratios within a job matter, the rest is learned. */
#include "render/frame/work.h"

#include "render/frame/facts.h"
#include "render/frame/job_io.h"
#include "render/inspect/legend.h"
#include "render/visibility/refresh.h"

#include <math.h>
#include <string.h>

/* The assumed share of covered samples while no frame has been drawn. */
#define COVERED_AT_FIRST 0.5

static double texels_of(const struct tl_image_params *image)
{
    int width, height;
    tl_image_samples(image, &width, &height);
    return (double)width * height;
}

/* Samples fall on points at random: with few of them some points are not seen. `points` were, by so many
 * samples. */
static double points_seen(double points, double samples_then, double samples)
{
    return points * (1 - exp(-samples / points)) / (1 - exp(-samples_then / points));
}

/* Before the first frame: of every vertex one side. */
static double points_seen_at_first(double vertices, double samples)
{
    return vertices > 0 ? points_seen(vertices, INFINITY, samples) : 0;
}

static double refreshed(const struct tl_light_params *light)
{
    int regions = light->regions;
    return light->rays * (light->refresh > 0 && light->refresh < regions ? light->refresh : regions);
}

/* While the scene rests a frame traces more rays than in motion, or fewer where the camera moves over ratios
 * at vertices, and none once every region has its rounds. */
static double rays_of_rest(const struct tl_resources *resources, bool at_vertices)
{
    if (resources->scene_round == 0)
        return 1;
    if (resources->points_are_done)
        return 0;
    return at_vertices && resources->round == 0 ? 0.5 : TL_REST_RAY_FACTOR;
}

static bool is_glossy(const tl_material *material)
{
    return glms_vec3_max(material->specular) > 0 || material->specular_map.image;
}

static bool is_bumpy(const tl_material *material)
{
    return material->weave || material->normal_map.image;
}

struct tl_work_counts tl_work_count(const tl_frame *frame, const struct tl_render_settings *settings,
                                    tl_bits facts, uint32_t exponents)
{
    const tl_surface *surfaces = frame->surfaces;
    size_t count = frame->surface_count;
    struct tl_lamp lamps[TL_LAMPS_MAX];
    struct tl_work_counts counts = {.lamps = (int)tl_lamps_lit(frame, lamps),
                                    .is_glossy = tl_materials_have(surfaces, count, is_glossy),
                                    .is_bumpy = tl_materials_have(surfaces, count, is_bumpy),
                                    .is_faceted = tl_materials_have(surfaces, count, tl_material_is_faceted),
                                    .fits_vertices = facts & TL_BIT(TL_SCENE_FITS_VERTICES)};
    for (size_t i = 0; i < count; i++) {
        counts.triangles += (double)surfaces[i].index_count / 3;
        counts.vertices += (double)surfaces[i].vertex_count;
    }
    counts.exponents = exponents ? exponents : tl_exponents_of(surfaces, count, &settings->detail);
    return counts;
}

/* A matt lobe, a glossy lobe, those of a multi-lobe fit. */
static double lobes_of(const struct tl_work_counts *counts, const struct tl_light_params *light)
{
    return 1 + (counts->is_glossy ? 1 : 0) + (counts->is_faceted ? light->lobes : 0);
}

struct tl_work_sizes tl_work_estimate_sizes(const struct tl_resources *resources,
                                            const struct tl_work_counts *counts,
                                            const struct tl_render_settings *settings)
{
    const struct tl_samples *samples = &resources->samples;
    const struct tl_id_buffer *ids = &resources->ids;
    const struct tl_light_params *light = &settings->light;
    bool were_ids = resources->facts & TL_BIT(TL_SCENE_RATIOS);
    double then = were_ids ? (double)ids->width * ids->height : (double)samples->width * samples->height;
    double covered_then = were_ids ? (double)ids->covered : (double)tl_samples_seen(samples);
    double now = texels_of(&settings->image);
    bool at_vertices = counts->fits_vertices && light->ratio_at == TL_RATIO_AT_VERTICES;
    double covered = then > 0 ? covered_then / then * now : COVERED_AT_FIRST * now;
    double visible = (double)tl_points_visible(resources->points);
    bool shadowed = light->method != TL_METHOD_UNSHADOWED;
    return (struct tl_work_sizes){
        .settings = settings,
        .texels = now,
        .covered = covered,
        .points = visible > 0 && covered_then > 0 ? points_seen(visible, covered_then, covered)
                                                  : points_seen_at_first(counts->vertices, covered),
        .lobes = lobes_of(counts, light),
        .groups = shadowed ? ceil(light->regions / (double)TL_LANES) : 0,
        .refreshed = refreshed(light) * rays_of_rest(resources, at_vertices),
        .at_vertices = at_vertices,
        .is_bumpy = counts->is_bumpy,
        .suns = shadowed ? resources->suns.count : 0,
        .lamps = counts->lamps,
        .triangles = counts->triangles,
        .new_regions = tl_light_cache_has(&resources->light_cache, light) ? 0 : light->regions,
        .lobe_texels = (double)tl_lobes_texels(counts->exponents)};
}

/* Pixels that have ids beside those of the samples; 0 where there are as many samples. */
static double outlined(const struct tl_work_sizes *sizes)
{
    const struct tl_image_params *image = &sizes->settings->image;
    return image->scale * (float)image->supersample < 1 ? (double)image->width * image->height : 0;
}

/* Steps from cone to cone through the heights of a bumpy material, and constant work beside them. */
static double detail_steps(const struct tl_work_sizes *sizes)
{
    const struct tl_detail_params *detail = &sizes->settings->detail;
    const double enough = 24; /* for most rays */
    if (!sizes->is_bumpy)
        return 0;
    return detail->mode == TL_DETAIL_RELIEF ? 5 + fmin(detail->steps, enough) : 5;
}

void tl_work_estimate(const struct tl_work_sizes *s, struct tl_work out[TL_JOB_COUNT])
{
    const struct tl_light_params *light = &s->settings->light;
    const struct tl_image_params *image = &s->settings->image;
    const double outline = outlined(s), draws = outline > 0 ? 2 : 1, side = light->map_size;
    const double pixels = (double)image->width * image->height;
    const double inspected = tl_view_is_visibility(image->view) ? s->groups : 0;
    const struct tl_work sample_rays = {{1e-4 * s->triangles, 1e-4 * s->covered}};
    const struct tl_work shadow_maps = {
        {1e-4 * s->refreshed * s->triangles, 1e-5 * s->refreshed * side * side}};
    const struct tl_work table[TL_JOB_COUNT] = {
#define ROW(job, ...) [TL_JOB_NUMBER_##job] = { {__VA_ARGS__} }
        ROW(lights, 1e-3, 2e-3 * s->new_regions, 1.6e-6 * s->new_regions * s->lobe_texels),
        [TL_JOB_NUMBER_maps] = shadow_maps,
        [TL_JOB_NUMBER_blur] = shadow_maps,
        ROW(gbuffer, 0.5, 0.039 * sqrt(s->texels), 2e-6 * s->texels, 2e-5 * detail_steps(s) * s->covered),
        ROW(ids, 0.3 * draws, 5e-5 * draws * s->triangles, 1.5e-6 * (s->texels + outline),
            1.5e-6 * s->covered),
        ROW(samples, 1e-5 * s->texels, 4e-5 * s->covered),
        ROW(lobe_sums, 2e-4 * s->covered, 3e-6 * s->texels * s->lobes),
        [TL_JOB_NUMBER_transparency] = sample_rays,
        ROW(trace, 1e-4 * s->triangles),
        [TL_JOB_NUMBER_mirrors] = sample_rays,
        ROW(points, 1e-4 * s->triangles, s->at_vertices ? 0 : (4e-5 + 1e-4 * s->suns) * s->covered,
            2e-4 * s->points, 8e-5 * s->points * s->refreshed),
        ROW(bounce, 3e-5 * s->triangles, 4e-3 * s->points / light->bounce_shares),
        ROW(ratios, 0.5, 1e-5 * s->triangles, 1e-5 * s->groups * s->lobes * s->points),
        ROW(sun_pixels, 0.1, 1e-5 * s->triangles, (1e-5 * s->suns) * s->covered,
            0.02 * s->suns * sqrt(s->covered)),
        ROW(shade, 0.5, 2e-6 * s->texels, 2e-5 * (4 + s->lobes) * s->covered, 1.2e-5 * outline),
        ROW(light, 1e-4 * s->texels, 5e-5 * light->regions * s->covered),
        ROW(compose, 3e-6 * s->texels, 2e-4 * s->covered, 1e-5 * s->groups * s->lobes * s->covered),
        ROW(inspect, 3e-6 * s->texels, 1e-4 * s->covered, 3e-5 * inspected * s->covered),
        ROW(lamp_maps, 5, 1e-4 * s->lamps * s->triangles),
        [TL_JOB_NUMBER_lamp_rays] = sample_rays,
        ROW(lamps, 5, 1e-4 * (s->lamps + 1) * s->covered),
        ROW(resolve, 1e-5 * s->texels, 1e-5 * pixels, image->scale < 1 ? 2e-5 * pixels : 0),
#undef ROW
    };
    memcpy(out, table, sizeof table);
}
