#include "render/frame/jobs.h"

#include "config/base/memory.h"
#include "render/frame/job_io.h"
#include "render/frame/work.h"

/* The bits of a job's list (job_io.h) that it reads. */
#define BIT_OF(member)            TL_BIT(TL_RESOURCE_OF_##member) |
#define READ_READS(member)        BIT_OF(member)
#define READ_READS_HANDLE(member) BIT_OF(member)
#define READ_AFTER(bit)           TL_BIT(bit) |
#define READ_SEES(member)
#define READ_SEES_HANDLE(member)
#define READ_WRITES(member)
#define READ_WRITES_HANDLE(member)
#define READ_WRITES_IN(member, bit)
#define READ_EXTENDS(member, bit)        BIT_OF(member)
#define READ_EXTENDS_HANDLE(member, bit) BIT_OF(member)
#define READ_USES(member)
#define READ_USES_HANDLE(member)
#define READ(kind, ...) READ_##kind(__VA_ARGS__)

/* ... and those that it writes. */
#define WRITTEN_READS(member)
#define WRITTEN_READS_HANDLE(member)
#define WRITTEN_AFTER(bit)
#define WRITTEN_SEES(member)
#define WRITTEN_SEES_HANDLE(member)
#define WRITTEN_WRITES(member)              BIT_OF(member)
#define WRITTEN_WRITES_HANDLE(member)       BIT_OF(member)
#define WRITTEN_WRITES_IN(member, bit)      TL_BIT(bit) |
#define WRITTEN_EXTENDS(member, bit)        TL_BIT(bit) |
#define WRITTEN_EXTENDS_HANDLE(member, bit) TL_BIT(bit) |
#define WRITTEN_USES(member)
#define WRITTEN_USES_HANDLE(member)
#define WRITTEN(kind, ...) WRITTEN_##kind(__VA_ARGS__)

/* The wiring: what the job's fields point to. */
#define ADDRESS(member)           .member = &all->member,
#define HANDLE(member)            .member = all->member,
#define WIRE_READS(member)        ADDRESS(member)
#define WIRE_READS_HANDLE(member) HANDLE(member)
#define WIRE_AFTER(bit)
#define WIRE_SEES(member)                ADDRESS(member)
#define WIRE_SEES_HANDLE(member)         HANDLE(member)
#define WIRE_WRITES(member)              ADDRESS(member)
#define WIRE_WRITES_HANDLE(member)       HANDLE(member)
#define WIRE_WRITES_IN(member, bit)      ADDRESS(member)
#define WIRE_EXTENDS(member, bit)        ADDRESS(member)
#define WIRE_EXTENDS_HANDLE(member, bit) HANDLE(member)
#define WIRE_USES(member)                ADDRESS(member)
#define WIRE_USES_HANDLE(member)         HANDLE(member)
#define WIRE(kind, ...)                  WIRE_##kind(__VA_ARGS__)

#define RUN(name, LIST)                                                                                      \
    static bool run_##name(void *context, int level, tl_error *error)                                        \
    {                                                                                                        \
        struct tl_resources *all = context;                                                                  \
        const struct tl_##name##_job job = {LIST(WIRE)};                                                     \
        (void)level;                                                                                         \
        return tl_run_##name(&job, error);                                                                   \
    }
TL_JOBS(RUN)

#define IO(name, LIST) .reads = LIST(READ) 0, .writes = LIST(WRITTEN) 0, .run = run_##name
#define LEVELS_ONE                                                                                           \
    {                                                                                                        \
        "only"                                                                                               \
    }

const tl_job tl_frame_jobs[] = {
    {.name = "cube",
     .what = "environment to a cube map; its suns taken out",
     IO(cube, TL_CUBE_JOB),
     .levels = LEVELS_ONE},
    {.name = "regions",
     .what = "the cube cut into regions",
     IO(regions, TL_REGIONS_JOB),
     .levels = LEVELS_ONE},
    {.name = "lobe",
     .what = "calibration of glossiness to chain level",
     IO(lobe, TL_LOBE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_CHAINS),
     .levels = LEVELS_ONE},
    {.name = "pems",
     .what = "a filtered copy of the cube for each region",
     IO(pems, TL_PEMS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_CHAINS),
     .levels = LEVELS_ONE},
    {.name = "lobes",
     .what = "the whole environment through exact lobes",
     IO(lobes, TL_LOBES_JOB),
     .requires_scene = TL_BIT(TL_SCENE_EXACT),
     .levels = LEVELS_ONE},
    {.name = "slices",
     .what = "the regions through exact lobes",
     IO(slices, TL_SLICES_JOB),
     .requires_scene = TL_BIT(TL_SCENE_SLICES),
     .levels = LEVELS_ONE},
    {.name = "lights",
     .what = "the regions as lights that add up to the exact light",
     IO(lights, TL_LIGHTS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RAYS) | TL_BIT(TL_SCENE_SHADOWS),
     .levels = LEVELS_ONE,
     .work = tl_lights_work},
    {.name = "surfaces",
     .what = "vertices and maps to the GPU",
     IO(surfaces, TL_SURFACES_JOB),
     .levels = LEVELS_ONE},
    {.name = "detail",
     .what = "heights, cones, horizons and spread of normals of the fabrics",
     IO(detail, TL_DETAIL_JOB),
     .requires_scene = TL_BIT(TL_SCENE_DETAIL),
     .levels = LEVELS_ONE},
    {.name = "maps",
     .what = "a shadow map for each region and sun",
     IO(maps, TL_MAPS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_MAPS),
     .levels = LEVELS_ONE,
     .work = tl_maps_work},
    {.name = "blur",
     .what = "shadow maps blurred by the size of their regions",
     IO(blur, TL_BLUR_JOB),
     .requires_scene = TL_BIT(TL_SCENE_MAPS) | TL_BIT(TL_SCENE_BLUR),
     .levels = LEVELS_ONE,
     .work = tl_maps_work},
    {.name = "gbuffer",
     .what = "nearest point, normal and material of every sample",
     IO(gbuffer, TL_GBUFFER_JOB),
     .levels = LEVELS_ONE,
     .work = tl_gbuffer_work},
    {.name = "ids",
     .what = "the number of the nearest triangle at every pixel",
     IO(ids, TL_IDS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RATIOS),
     .levels = LEVELS_ONE,
     .work = tl_ids_work},
    {.name = "shade_materials",
     .what = "materials, their maps and fits to the CPU",
     IO(shade_materials, TL_SHADE_MATERIALS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RATIOS),
     .levels = LEVELS_ONE},
    {.name = "samples",
     .what = "the covered samples to the CPU",
     IO(samples, TL_SAMPLES_JOB),
     .requires_scene = TL_BIT(TL_SCENE_SAMPLES),
     .levels = LEVELS_ONE,
     .work = tl_samples_work},
    {.name = "transparency",
     .what = "rays: what lies behind open cloth and shines through it",
     IO(transparency, TL_TRANSPARENCY_JOB),
     .requires_scene = TL_BIT(TL_SCENE_TRANSPARENCY),
     .levels = LEVELS_ONE,
     .work = tl_sample_rays_work},
    {.name = "trace",
     .what = "surfaces to what rays are traced in",
     IO(trace, TL_TRACE_JOB),
     .levels = LEVELS_ONE,
     .work = tl_trace_work},
    {.name = "mirrors",
     .what = "rays: what near mirrors show",
     IO(mirrors, TL_MIRRORS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_MIRRORS),
     .levels = LEVELS_ONE,
     .work = tl_sample_rays_work},
    {.name = "points",
     .what = "rays: visibility of the regions, kept at vertices",
     IO(points, TL_POINTS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RAYS) | TL_BIT(TL_SCENE_SHADOWS),
     .levels = LEVELS_ONE,
     .work = tl_points_work},
    {.name = "bounce",
     .what = "rays: light that surfaces send on to each other, kept at vertices",
     IO(bounce, TL_BOUNCE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_BOUNCE),
     .levels = LEVELS_ONE,
     .work = tl_bounce_work},
    {.name = "ratios",
     .what = "ratio of seen to exact light, at vertices",
     IO(ratios, TL_RATIOS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RATIOS),
     .levels = LEVELS_ONE,
     .work = tl_ratios_work},
    {.name = "sun_pixels",
     .what = "rays: what every pixel sees of the suns",
     IO(sun_pixels, TL_SUN_PIXELS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RATIOS),
     .levels = LEVELS_ONE,
     .work = tl_sun_pixels_work},
    {.name = "shade",
     .what = "exact light times the interpolated ratio, pixel by pixel",
     IO(shade, TL_SHADE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RATIOS),
     .levels = LEVELS_ONE,
     .work = tl_shade_work},
    {.name = "light",
     .what = "visibility times PEM, summed over the regions",
     IO(light, TL_LIGHT_JOB),
     .requires_scene = TL_BIT(TL_SCENE_PASSES),
     .levels = LEVELS_ONE,
     .work = tl_passes_work},
    {.name = "compose",
     .what = "exact light times the share of it that is seen",
     IO(compose, TL_COMPOSE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_COMPOSED),
     .levels = LEVELS_ONE,
     .work = tl_compose_work},
    {.name = "inspect",
     .what = "what a view shows in place of light",
     IO(inspect, TL_INSPECT_JOB),
     .requires_scene = TL_BIT(TL_SCENE_INSPECT),
     .levels = LEVELS_ONE,
     .work = tl_inspect_work},
    {.name = "envmap_lobes",
     .what = "all light through exact lobes, for environment maps",
     IO(envmap_lobes, TL_ENVMAP_LOBES_JOB),
     .requires_scene = TL_BIT(TL_SCENE_ENVMAP),
     .levels = LEVELS_ONE},
    /* The scene that it draws is no reason to run: changes wait until the next capture is due. */
    {.name = "capture",
     .what = "the scene seen from a point, through exact lobes",
     IO(capture, TL_CAPTURE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_ENVMAP) | TL_BIT(TL_SCENE_CAPTURE),
     .levels = LEVELS_ONE},
    {.name = "envmap",
     .what = "lobes resampled to environment maps of a layout",
     IO(envmap, TL_ENVMAP_JOB),
     .requires_scene = TL_BIT(TL_SCENE_ENVMAP),
     .levels = LEVELS_ONE},
    {.name = "light_map",
     .what = "diffuse light with shadows, baked over UVs",
     IO(light_map, TL_LIGHT_MAP_JOB),
     .requires_scene = TL_BIT(TL_SCENE_LIGHT_MAP),
     .levels = LEVELS_ONE},
    {.name = "look_up",
     .what = "environment maps looked up for every sample",
     IO(look_up, TL_LOOK_UP_JOB),
     .requires_scene = TL_BIT(TL_SCENE_ENVMAP),
     .levels = LEVELS_ONE},
    /* Lamps are added to the light in place, so the light is recomputed whenever they change. */
    {.name = "lamp_maps",
     .what = "a shadow map for each lamp",
     IO(lamp_maps, TL_LAMP_MAPS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_LAMP_MAPS),
     .levels = LEVELS_ONE,
     .work = tl_lamp_maps_work},
    {.name = "lamp_rays",
     .what = "rays: what is seen of each lamp",
     IO(lamp_rays, TL_LAMP_RAYS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_LAMP_RAYS),
     .levels = LEVELS_ONE,
     .work = tl_sample_rays_work},
    {.name = "lamps",
     .what = "light of the lamps, added",
     IO(lamps, TL_LAMPS_JOB),
     .requires_scene = TL_BIT(TL_SCENE_LAMPS),
     .levels = LEVELS_ONE,
     .work = tl_lamps_work},
    {.name = "resolve",
     .what = "samples to pixels",
     IO(resolve, TL_RESOLVE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_RASTER),
     .levels = LEVELS_ONE,
     .work = tl_resolve_work},
    {.name = "reference",
     .what = "the image, ray traced",
     IO(reference, TL_REFERENCE_JOB),
     .requires_scene = TL_BIT(TL_SCENE_REFERENCE),
     .levels = LEVELS_ONE},
    {.name = "backdrop",
     .what = "the environment as it is seen behind",
     IO(backdrop, TL_BACKDROP_JOB),
     .levels = LEVELS_ONE},
    {.name = "show",
     .what = "background, exposure, tone mapping",
     IO(show, TL_SHOW_JOB),
     .levels = LEVELS_ONE},
};
const int tl_frame_job_count = (int)TL_COUNT(tl_frame_jobs);
