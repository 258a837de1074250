/* Queries about the last frame (inspection, legend, AOVs, memory), and the exchange of prepared environments
 * with a worker thread. */
#include "render/frame/jobs.h"
#include "render/frame/memory.h"
#include "render/inside.h"
#include "render/renderer_internal.h"

const struct tl_resources *tl_renderer_frame_resources(const tl_renderer *renderer)
{
    return &renderer->resources;
}

struct tl_render_memory tl_renderer_memory(const tl_renderer *renderer)
{
    return tl_resources_memory(&renderer->resources);
}

size_t tl_renderer_resources(const tl_renderer *renderer, struct tl_resource_memory out[TL_RESOURCES_MAX])
{
    return tl_resources_list(&renderer->resources, out);
}

void tl_renderer_job_bytes(const tl_renderer *renderer, size_t out[TL_JOBS_MAX])
{
    size_t bytes[TL_RESOURCE_COUNT];
    tl_resources_count(&renderer->resources, bytes);
    for (int i = 0; i < TL_JOBS_MAX; i++) {
        out[i] = 0;
        for (int bit = 0; i < tl_frame_job_count && bit < TL_RESOURCE_COUNT; bit++)
            out[i] += tl_frame_jobs[i].writes & TL_BIT(bit) ? bytes[bit] : 0;
    }
}

static bool has(const tl_renderer *renderer, enum tl_resource resource)
{
    return renderer->resources.valid & TL_BIT(resource);
}

static struct tl_inspect_request inspect_request(const tl_renderer *renderer)
{
    const struct tl_resources *resources = &renderer->resources;
    return (struct tl_inspect_request){.image = &renderer->settings.image,
                                       .strain_range = resources->strain_range,
                                       .samples = &resources->samples,
                                       .ranges = &resources->shapes.ranges,
                                       .regions = has(renderer, TL_MADE_REGIONS) ? &resources->regions : NULL,
                                       .points = has(renderer, TL_MADE_POINTS) ? resources->points : NULL,
                                       .view = &resources->camera.view,
                                       .environment_yaw = resources->yaw};
}

bool tl_renderer_inspect(const tl_renderer *renderer, int x, int y, struct tl_inspection *out)
{
    const struct tl_image_params *image = &renderer->settings.image;
    const struct tl_inspect_request request = inspect_request(renderer);
    *out = (struct tl_inspection){.strongest_region = -1};
    if (!has(renderer, TL_MADE_IMAGE) || x < 0 || y < 0 || x >= image->width || y >= image->height)
        return false;
    if (!has(renderer, TL_MADE_SAMPLES))
        return tl_inspect_ray(&request, image->width, image->height, x, y, out);
    size_t number = tl_inspect_find(request.samples, image->width, image->height, x, y);
    if (number == request.samples->primary_count)
        return false;
    tl_inspect_sample(&request, number, out);
    return true;
}

void tl_renderer_legend(const tl_renderer *renderer, struct tl_legend *out)
{
    const struct tl_inspect_request request = inspect_request(renderer);
    tl_inspect_legend(&request, out);
}

static bool has_strains(const struct tl_shapes_input *shapes)
{
    for (size_t i = 0; i < shapes->drawn_count; i++)
        if (shapes->drawn[i]->strains)
            return true;
    return false;
}

static bool check_layers(const tl_renderer *renderer, tl_error *error)
{
    return has(renderer, TL_MADE_SAMPLES) ||
           tl_fail(error, TL_USAGE,
                   "renderer: the last frame kept no layers: set aovs of the frame before drawing it");
}

bool tl_renderer_read_aovs(const tl_renderer *renderer, struct tl_aovs *out, tl_error *error)
{
    *out = (struct tl_aovs){0};
    if (!check_layers(renderer, error))
        return false;
    const struct tl_inspect_request request = inspect_request(renderer);
    tl_aovs_make(&request, has_strains(&renderer->resources.shapes), out);
    if (tl_gpu_check(renderer->resources.gpu, error))
        return true;
    tl_aovs_release(out);
    return false;
}

bool tl_renderer_read_garment(const tl_renderer *renderer, tl_image *out, tl_error *error)
{
    *out = (tl_image){0};
    if (!check_layers(renderer, error))
        return false;
    const struct tl_inspect_request request = inspect_request(renderer);
    *out = tl_aovs_make_garment(&request);
    if (tl_gpu_check(renderer->resources.gpu, error))
        return true;
    tl_image_release(out);
    return false;
}

uint32_t tl_renderer_exponents(const tl_renderer *renderer)
{
    return renderer->resources.light_cache.exponents;
}

/* The cube belongs to the last frame that was lit: an image without light does not remake it. */
tl_prepared *tl_renderer_copy_prepared(const tl_renderer *renderer)
{
    const struct tl_resources *resources = &renderer->resources;
    if (!has(renderer, TL_MADE_CUBE))
        return NULL;
    return tl_prepared_copy_cache(&resources->light_cache, &resources->cube, &resources->suns,
                                  &renderer->settings.light);
}

void tl_renderer_take_prepared(tl_renderer *renderer, tl_prepared **prepared, uint64_t environment_revision)
{
    struct tl_resources *resources = &renderer->resources;
    const struct tl_light_params *light = &renderer->settings.light;
    tl_prepared_destroy(&resources->prepared);
    tl_prepared_set_revision(*prepared, environment_revision);
    if (has(renderer, TL_MADE_CUBE) &&
        tl_prepared_fits(*prepared, renderer->frame.environment_revision, light->pem_size, light->sun)) {
        tl_prepared_give_lights(*prepared, &resources->light_cache);
        tl_prepared_destroy(prepared);
        return;
    }
    resources->prepared = *prepared;
    *prepared = NULL;
}
