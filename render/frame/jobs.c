#include "render/frame/frame.h"

#include "config/memory.h"

#include <stdlib.h>

const char *const tl_resource_names[] = {
    [TL_INPUT_ENVIRONMENT] = "environment",
    [TL_INPUT_YAW] = "environment yaw",
    [TL_INPUT_SHAPES] = "shapes and materials",
    [TL_INPUT_MOTION] = "motion",
    [TL_INPUT_CAMERA] = "camera",
    [TL_INPUT_SIZE] = "image size",
    [TL_INPUT_GROUND] = "ground option",
    [TL_INPUT_PEM_SIZE] = "PEM size",
    [TL_INPUT_FILTER] = "filter option",
    [TL_INPUT_REGIONS] = "number of regions",
    [TL_INPUT_PASSES] = "PEMs per pass",
    [TL_INPUT_MAPS] = "shadow map options",
    [TL_INPUT_LIGHT] = "light options",
    [TL_INPUT_SHOW] = "exposure and background",
    [TL_MADE_CUBE] = "cube",
    [TL_MADE_REGIONS] = "regions",
    [TL_MADE_LOBE] = "lobe table",
    [TL_MADE_PEMS] = "PEMs",
    [TL_MADE_SURFACES] = "surfaces",
    [TL_MADE_DEPTHS] = "depths",
    [TL_MADE_MAPS] = "shadow maps",
    [TL_MADE_GBUFFER] = "G-buffer",
    [TL_MADE_LIGHT] = "light",
    [TL_MADE_IMAGE] = "image",
    [TL_MADE_BACKDROP] = "backdrop",
    [TL_MADE_SHOWN] = "shown image",
    NULL,
};

const char *const tl_scene_fact_names[] = {[TL_SCENE_SHADOWED] = "shadows", NULL};

static const struct tl_ground *ground_of(const tl_renderer *renderer)
{
    return renderer->settings.image.ground ? &renderer->ground : NULL;
}

static bool run_cube(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_cube_release(&renderer->cube);
    renderer->cube = tl_cube_from_environment(renderer->frame.environment, renderer->settings.light.pem_size);
    return true;
}

static bool run_regions(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_regions_cut(&renderer->cube, renderer->settings.light.regions, &renderer->regions);
    return true;
}

static bool run_lobe(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_lobe_table table;
    tl_lobe_calibrate(renderer->settings.light.pem_size,
                      (enum tl_chain_filter)renderer->settings.light.filter, &table);
    tl_lighting_set_lobe(&renderer->lighting, renderer->gpu, &table);
    return true;
}

static bool run_pems(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_pems_build(&renderer->pems, renderer->gpu, &renderer->cube, &renderer->regions,
                  renderer->settings.light.filter, renderer->settings.light.pems_per_pass);
    return true;
}

static bool run_surfaces(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const tl_frame *frame = &renderer->frame;
    if (!tl_casters_measure(frame->surfaces, frame->surface_count, &renderer->casters, error))
        return false;
    tl_ground_make(&renderer->casters, &renderer->ground);
    const tl_surface **items = TL_NEW_ARRAY(const tl_surface *, frame->surface_count + 1);
    for (size_t i = 0; i < frame->surface_count; i++)
        items[i] = &frame->surfaces[i];
    items[frame->surface_count] = &renderer->ground.surface;
    renderer->surface_count = frame->surface_count + (renderer->settings.image.ground ? 1 : 0);
    bool fine = tl_surfaces_update(renderer->surfaces, items, renderer->surface_count, error);
    free(items);
    return fine;
}

static struct tl_shadow_request shadow_request(const tl_renderer *renderer)
{
    const struct tl_light_params *light = &renderer->settings.light;
    return (struct tl_shadow_request){
        .regions = &renderer->regions,
        .environment_yaw = renderer->frame.environment_yaw,
        .casters = renderer->casters,
        .surfaces = renderer->surfaces,
        .surface_count = renderer->surface_count,
        .ground_index = renderer->settings.image.ground ? (int)renderer->surface_count - 1 : -1,
        .map_size = light->map_size,
        .maps_per_array = light->pems_per_pass,
        .blur_m = light->blur_m};
}

static bool run_maps(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_shadow_request request = shadow_request(renderer);
    tl_shadow_maps_draw(renderer->maps, &request);
    return true;
}

static bool run_blur(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_shadow_request request = shadow_request(renderer);
    tl_shadow_maps_blur(renderer->maps, &request);
    return true;
}

static bool run_gbuffer(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_image_params *image = &renderer->settings.image;
    tl_gbuffer_draw(&renderer->gbuffer, renderer->gpu, &renderer->view, image->width * image->supersample,
                    image->height * image->supersample, renderer->surfaces, renderer->surface_count,
                    ground_of(renderer));
    return true;
}

static bool run_light(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_light_request request = {.gbuffer = &renderer->gbuffer,
                                             .pems = &renderer->pems,
                                             .regions = &renderer->regions,
                                             .maps = renderer->maps,
                                             .casters = renderer->casters,
                                             .ground = ground_of(renderer),
                                             .environment_yaw = renderer->frame.environment_yaw,
                                             .eye = renderer->view.eye,
                                             .params = &renderer->settings.light};
    tl_lighting_draw(&renderer->lighting, renderer->gpu, &request);
    return true;
}

static bool run_resolve(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_image_params *image = &renderer->settings.image;
    tl_present_resolve(&renderer->present, renderer->gpu, &renderer->lighting.target.colours[0],
                       &renderer->gbuffer.target.colours[TL_GBUFFER_POINT], image->width, image->height,
                       image->supersample);
    return true;
}

static bool run_backdrop(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    return tl_present_set_backdrop(&renderer->present, renderer->gpu, renderer->frame.environment,
                                   &renderer->cube, renderer->settings.light.filter, error);
}

static bool run_show(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_show_request request = {.view = renderer->view,
                                            .environment_yaw = renderer->frame.environment_yaw,
                                            .params = &renderer->settings.image,
                                            .framebuffer = renderer->show_framebuffer,
                                            .width = renderer->show_width,
                                            .height = renderer->show_height};
    tl_present_show(&renderer->present, renderer->gpu, &request);
    return true;
}

#define BITS2(a, b)             (TL_BIT(a) | TL_BIT(b))
#define BITS3(a, b, c)          (BITS2(a, b) | TL_BIT(c))
#define BITS4(a, b, c, d)       (BITS2(a, b) | BITS2(c, d))
#define BITS6(a, b, c, d, e, f) (BITS4(a, b, c, d) | BITS2(e, f))
#define LEVELS_ONE                                                                                           \
    {                                                                                                        \
        "paper"                                                                                              \
    }

const tl_job tl_frame_jobs[] = {
    {.name = "cube",
     .what = "environment to a cube map",
     .reads = BITS2(TL_INPUT_ENVIRONMENT, TL_INPUT_PEM_SIZE),
     .writes = TL_BIT(TL_MADE_CUBE),
     .levels = LEVELS_ONE,
     .run = run_cube},
    {.name = "regions",
     .what = "median cut of the cube's six faces",
     .reads = BITS2(TL_MADE_CUBE, TL_INPUT_REGIONS),
     .writes = TL_BIT(TL_MADE_REGIONS),
     .levels = LEVELS_ONE,
     .run = run_regions},
    {.name = "lobe",
     .what = "calibration of glossiness to chain level",
     .reads = BITS2(TL_INPUT_PEM_SIZE, TL_INPUT_FILTER),
     .writes = TL_BIT(TL_MADE_LOBE),
     .levels = LEVELS_ONE,
     .run = run_lobe},
    {.name = "pems",
     .what = "a filtered copy of the cube for each region",
     .reads = BITS4(TL_MADE_CUBE, TL_MADE_REGIONS, TL_INPUT_FILTER, TL_INPUT_PASSES),
     .writes = TL_BIT(TL_MADE_PEMS),
     .levels = LEVELS_ONE,
     .run = run_pems},
    {.name = "surfaces",
     .what = "vertices and maps to the GPU",
     .reads = BITS3(TL_INPUT_SHAPES, TL_INPUT_MOTION, TL_INPUT_GROUND),
     .writes = TL_BIT(TL_MADE_SURFACES),
     .levels = LEVELS_ONE,
     .run = run_surfaces},
    {.name = "maps",
     .what = "a variance shadow map for each region",
     .reads = BITS2(TL_MADE_SURFACES, TL_MADE_REGIONS) | BITS3(TL_INPUT_YAW, TL_INPUT_MAPS, TL_INPUT_PASSES),
     .writes = TL_BIT(TL_MADE_DEPTHS),
     .requires_scene = TL_BIT(TL_SCENE_SHADOWED),
     .levels = LEVELS_ONE,
     .run = run_maps},
    {.name = "blur",
     .what = "shadow maps blurred by the size of their regions",
     .reads = BITS3(TL_MADE_DEPTHS, TL_MADE_REGIONS, TL_MADE_SURFACES),
     .writes = TL_BIT(TL_MADE_MAPS),
     .requires_scene = TL_BIT(TL_SCENE_SHADOWED),
     .levels = LEVELS_ONE,
     .run = run_blur},
    {.name = "gbuffer",
     .what = "nearest point, normal and material of every sample",
     .reads = BITS4(TL_MADE_SURFACES, TL_INPUT_CAMERA, TL_INPUT_SIZE, TL_INPUT_GROUND),
     .writes = TL_BIT(TL_MADE_GBUFFER),
     .levels = LEVELS_ONE,
     .run = run_gbuffer},
    {.name = "light",
     .what = "visibility times PEM, summed over the regions",
     .reads =
         BITS6(TL_MADE_GBUFFER, TL_MADE_PEMS, TL_MADE_REGIONS, TL_MADE_LOBE, TL_MADE_MAPS, TL_MADE_SURFACES) |
         BITS4(TL_INPUT_YAW, TL_INPUT_CAMERA, TL_INPUT_LIGHT, TL_INPUT_GROUND),
     .writes = TL_BIT(TL_MADE_LIGHT),
     .levels = LEVELS_ONE,
     .run = run_light},
    {.name = "resolve",
     .what = "samples to pixels",
     .reads = BITS3(TL_MADE_LIGHT, TL_MADE_GBUFFER, TL_INPUT_SIZE),
     .writes = TL_BIT(TL_MADE_IMAGE),
     .levels = LEVELS_ONE,
     .run = run_resolve},
    {.name = "backdrop",
     .what = "the environment as it is seen behind",
     .reads = BITS3(TL_INPUT_ENVIRONMENT, TL_MADE_CUBE, TL_INPUT_FILTER),
     .writes = TL_BIT(TL_MADE_BACKDROP),
     .levels = LEVELS_ONE,
     .run = run_backdrop},
    {.name = "show",
     .what = "background, exposure, tone mapping",
     .reads = BITS2(TL_MADE_IMAGE, TL_MADE_BACKDROP) | BITS3(TL_INPUT_SHOW, TL_INPUT_YAW, TL_INPUT_CAMERA),
     .writes = TL_BIT(TL_MADE_SHOWN),
     .levels = LEVELS_ONE,
     .run = run_show},
};
const int tl_frame_job_count = (int)TL_COUNT(tl_frame_jobs);
