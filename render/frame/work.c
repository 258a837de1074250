/* Estimates the work of each job of a frame to come from the last frame's counts, at other settings. Costs
 * are CPU ms on a machine with two cores (the built-in scene, preset draft, 128 x 128 to 1024 x 1024 samples,
 * best of twelve frames); only their ratios within a job matter, the rest is learned. */
#include "render/frame/work.h"

#include "render/frame/facts.h"
#include "render/inspect/legend.h"
#include "render/visibility/refresh.h"

#include <math.h>

/* The assumed share of covered samples while no frame has been drawn. */
#define COVERED_AT_FIRST 0.5

static double texels_of(const struct tl_image_params *image)
{
    int width, height;
    tl_image_samples(image, &width, &height);
    return (double)width * height;
}

/* Samples fall on points at random: with few of them some points are not seen. */
static double points_seen(double points, double samples_then, double samples)
{
    if (!(points > 0) || !(samples_then > 0))
        return samples;
    return points * (1 - exp(-samples / points)) / (1 - exp(-samples_then / points));
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

struct tl_work_counts tl_work_count(const tl_frame *frame, tl_bits facts)
{
    const tl_surface *surfaces = frame->surfaces;
    size_t count = frame->surface_count;
    struct tl_lamp lamps[TL_LAMPS_MAX];
    struct tl_work_counts counts = {.lamps = (int)tl_lamps_lit(frame, lamps),
                                    .is_glossy = tl_materials_have(surfaces, count, is_glossy),
                                    .is_bumpy = tl_materials_have(surfaces, count, is_bumpy),
                                    .is_faceted = tl_materials_have(surfaces, count, tl_material_is_faceted),
                                    .fits_vertices = facts & TL_BIT(TL_SCENE_FITS_VERTICES)};
    for (size_t i = 0; i < count; i++)
        counts.triangles += (double)surfaces[i].index_count / 3;
    return counts;
}

/* A matt lobe, a glossy lobe, those of a multi-lobe fit. */
static double lobes_of(const struct tl_work_counts *counts, const struct tl_light_params *light)
{
    return 1 + (counts->is_glossy ? 1 : 0) + (counts->is_faceted ? light->fan : 0);
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
    bool shadowed = light->method != TL_METHOD_UNSHADOWED;
    return (struct tl_work_sizes){
        .settings = settings,
        .texels = now,
        .covered = covered,
        .points = points_seen((double)tl_points_visible(resources->points), covered_then, covered),
        .lobes = lobes_of(counts, light),
        .groups = shadowed ? ceil(light->regions / (double)TL_LANES) : 0,
        .refreshed = refreshed(light) * rays_of_rest(resources, at_vertices),
        .at_vertices = at_vertices,
        .is_bumpy = counts->is_bumpy,
        .suns = shadowed ? resources->suns.count : 0,
        .lamps = counts->lamps,
        .triangles = counts->triangles,
        .new_regions = tl_light_cache_has(&resources->light_cache, light) ? 0 : light->regions};
}

struct tl_work tl_lights_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{1e-3, sizes->new_regions > 0 ? 40 : 0, 2 * sizes->new_regions}};
}

struct tl_work tl_gbuffer_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    const struct tl_detail_params *detail = &sizes->settings->detail;
    const double enough = 24; /* steps from cone to cone, for most rays */
    double steps = !sizes->is_bumpy                   ? 0
                   : detail->mode == TL_DETAIL_RELIEF ? 5 + fmin(detail->steps, enough)
                                                      : 5;
    return (struct tl_work){
        {0.5, 0.039 * sqrt(sizes->texels), 2e-6 * sizes->texels, 2e-5 * steps * sizes->covered}};
}

struct tl_work tl_samples_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{1e-5 * sizes->texels, 4e-5 * sizes->covered}};
}

/* Pixels that have ids beside those of the samples; 0 where there are as many samples. */
static double outlined(const struct tl_work_sizes *sizes)
{
    const struct tl_image_params *image = &sizes->settings->image;
    return image->scale * (float)image->supersample < 1 ? (double)image->width * image->height : 0;
}

struct tl_work tl_ids_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    double pixels = outlined(sizes), draws = pixels > 0 ? 2 : 1;
    return (struct tl_work){{0.3 * draws, 5e-5 * draws * sizes->triangles, 1.5e-6 * (sizes->texels + pixels),
                             1.5e-6 * sizes->covered}};
}

struct tl_work tl_ratios_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){
        {0.5, 1e-5 * sizes->triangles, 1e-5 * sizes->groups * sizes->lobes * sizes->points}};
}

struct tl_work tl_sun_pixels_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{0.1, 1e-5 * sizes->triangles, (1e-5 * sizes->suns) * sizes->covered,
                             0.02 * sizes->suns * sqrt(sizes->covered)}};
}

struct tl_work tl_shade_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){
        {0.5, 2e-6 * sizes->texels, 2e-5 * (4 + sizes->lobes) * sizes->covered, 1.2e-5 * outlined(sizes)}};
}

struct tl_work tl_trace_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{1e-4 * sizes->triangles}};
}

struct tl_work tl_points_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    double samples = sizes->at_vertices ? 0 : (4e-5 + 1e-4 * sizes->suns) * sizes->covered;
    return (struct tl_work){
        {1e-4 * sizes->triangles, samples, 2e-4 * sizes->points, 8e-5 * sizes->points * sizes->refreshed}};
}

struct tl_work tl_bounce_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    const double shares = sizes->settings->light.bounce_shares;
    return (struct tl_work){{3e-5 * sizes->triangles, 4e-3 * sizes->points / shares}};
}

struct tl_work tl_compose_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){
        {3e-6 * sizes->texels, 2e-4 * sizes->covered, 1e-5 * sizes->groups * sizes->lobes * sizes->covered}};
}

struct tl_work tl_inspect_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    double groups = tl_view_is_visibility(sizes->settings->image.view) ? sizes->groups : 0;
    return (struct tl_work){{3e-6 * sizes->texels, 1e-4 * sizes->covered, 3e-5 * groups * sizes->covered}};
}

struct tl_work tl_passes_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{1e-4 * sizes->texels, 5e-5 * sizes->settings->light.regions * sizes->covered}};
}

struct tl_work tl_maps_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    double maps = sizes->refreshed, side = sizes->settings->light.map_size;
    return (struct tl_work){{1e-4 * maps * sizes->triangles, 1e-5 * maps * side * side}};
}

struct tl_work tl_resolve_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    const struct tl_image_params *image = &sizes->settings->image;
    double pixels = (double)image->width * image->height;
    bool is_resampled = image->scale < 1;
    return (struct tl_work){{1e-5 * sizes->texels, 1e-5 * pixels, is_resampled ? 2e-5 * pixels : 0}};
}

struct tl_work tl_lamps_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{5, 1e-4 * (sizes->lamps + 1) * sizes->covered}};
}

struct tl_work tl_lamp_maps_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{5, 1e-4 * sizes->lamps * sizes->triangles}};
}

struct tl_work tl_sample_rays_work(const void *context)
{
    const struct tl_work_sizes *sizes = context;
    return (struct tl_work){{1e-4 * sizes->triangles, 1e-4 * sizes->covered}};
}
