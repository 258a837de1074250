/* The resources that the jobs of a frame read and write, and the caches that they use. The lists name the
 * inputs of a frame first, then the results of jobs, each with its bit in the plan (resource.h). No job sees
 * the whole struct: job_io.h lists the members that each one gets. */
#ifndef TOILE_RENDER_FRAME_RESOURCES_H
#define TOILE_RENDER_FRAME_RESOURCES_H

#include "render/bounce/bounce.h"
#include "render/detail/maps.h"
#include "render/env/resample.h"
#include "render/env/sun.h"
#include "render/envmap/capture.h"
#include "render/envmap/envmap.h"
#include "render/envmap/light_map.h"
#include "render/frame/inputs.h"
#include "render/frame/prepared.h"
#include "render/light/light.h"
#include "render/light/mirrors.h"
#include "render/light/transparency.h"
#include "render/local/local.h"
#include "render/present/present.h"
#include "render/shade/pixels.h"
#include "render/shade/sun_pixels.h"
#include "render/trace/trace.h"
#include "render/visibility/maps.h"
#include "render/visibility/points.h"

/* The exact light of the whole environment. */
struct tl_exact_light {
    const struct tl_lobes *lobes; /* those of the cache; NULL: none */
    struct tl_exact_maps maps;    /* ... on the GPU */
    uint32_t sent;                /* exponents that are there, of the cube of this revision: */
    uint64_t sent_revision;
};

/* Exact light of the regions, and the same on the GPU. */
struct tl_region_slices {
    struct tl_slices slices;
    struct tl_slice_maps maps;
};

/* The light that environment maps are made from: all of it, suns included. */
struct tl_envmap_source {
    tl_cube cube;
    struct tl_lobes lobes;
};

/* RESOURCE(member, bit, type). Resources that are made in place of another one (TL_MADE_MAPS, blurred where
 * the depths were; TL_MADE_LAMPLIGHT, added to the light ...) have no member of their own. */
#define TL_INPUT_RESOURCES(RESOURCE)                                                                         \
    RESOURCE(environment, TL_INPUT_ENVIRONMENT, struct tl_environment_input)                                 \
    RESOURCE(yaw, TL_INPUT_YAW, float) /* rad */                                                             \
    RESOURCE(shapes, TL_INPUT_SHAPES, struct tl_shapes_input)                                                \
    RESOURCE(motion, TL_INPUT_MOTION, struct tl_motion_input)                                                \
    RESOURCE(camera, TL_INPUT_CAMERA, struct tl_camera_input)                                                \
    RESOURCE(size, TL_INPUT_SIZE, struct tl_size_input)                                                      \
    RESOURCE(ground_input, TL_INPUT_GROUND, struct tl_ground_input)                                          \
    RESOURCE(lobes_input, TL_INPUT_LOBES, struct tl_lobes_input)                                             \
    RESOURCE(pem_options, TL_INPUT_PEM_SIZE, struct tl_light_params)                                         \
    RESOURCE(filter_options, TL_INPUT_FILTER, struct tl_light_params)                                        \
    RESOURCE(sun_options, TL_INPUT_SUN, struct tl_light_params)                                              \
    RESOURCE(cut_options, TL_INPUT_REGIONS, struct tl_light_params)                                          \
    RESOURCE(storage_options, TL_INPUT_PASSES, struct tl_light_params)                                       \
    RESOURCE(shadows, TL_INPUT_MAPS, struct tl_shadow_input)                                                 \
    RESOURCE(rays, TL_INPUT_RAYS, struct tl_rays_input)                                                      \
    RESOURCE(round, TL_INPUT_ROUND, int)                                                                     \
    RESOURCE(scene_round, TL_INPUT_SCENE_ROUND, int)                                                         \
    RESOURCE(shift, TL_INPUT_SHIFT, struct tl_shift_input)                                                   \
    RESOURCE(light_options, TL_INPUT_LIGHT, struct tl_light_params)                                          \
    RESOURCE(lamps, TL_INPUT_LAMPS, struct tl_lamps_input)                                                   \
    RESOURCE(reference_options, TL_INPUT_REFERENCE, struct tl_reference_params)                              \
    RESOURCE(detail_steps, TL_INPUT_DETAIL, struct tl_detail_params)                                         \
    RESOURCE(detail_options, TL_INPUT_DETAIL_MAPS, struct tl_detail_params)                                  \
    RESOURCE(show_options, TL_INPUT_SHOW, struct tl_image_params)                                            \
    RESOURCE(envmap_input, TL_INPUT_ENVMAP, struct tl_envmap_input)                                          \
    RESOURCE(layout_options, TL_INPUT_LAYOUT, struct tl_maps_params)                                         \
    RESOURCE(look_up_options, TL_INPUT_LOOK_UP, struct tl_maps_params)                                       \
    RESOURCE(capture_options, TL_INPUT_CAPTURE, struct tl_maps_params)                                       \
    RESOURCE(view_options, TL_INPUT_VIEW, struct tl_image_params)                                            \
    RESOURCE(ratio_options, TL_INPUT_RATIO, struct tl_light_params)

#define TL_MADE_RESOURCES(RESOURCE)                                                                          \
    RESOURCE(cube, TL_MADE_CUBE, tl_cube)        /* without the suns */                                      \
    RESOURCE(suns, TL_MADE_CUBE, struct tl_suns) /* that were taken from it */                               \
    RESOURCE(regions, TL_MADE_REGIONS, struct tl_regions)                                                    \
    RESOURCE(regions_revision, TL_MADE_REGIONS, uint64_t)                                                    \
    RESOURCE(lobe_levels, TL_MADE_LOBE, tl_texture)                                                          \
    RESOURCE(pems, TL_MADE_PEMS, struct tl_pems)                                                             \
    RESOURCE(exact, TL_MADE_LOBES, struct tl_exact_light)                                                    \
    RESOURCE(slices, TL_MADE_SLICES, struct tl_region_slices)                                                \
    RESOURCE(lights, TL_MADE_LIGHTS, const struct tl_region_lights *) /* among those of the cache */         \
    RESOURCE(surfaces, TL_MADE_SURFACES, tl_surfaces *)                                                      \
    RESOURCE(casters, TL_MADE_SURFACES, struct tl_casters)                                                   \
    RESOURCE(ground, TL_MADE_SURFACES, struct tl_ground)                                                     \
    RESOURCE(detail, TL_MADE_DETAIL, struct tl_detail_maps)                                                  \
    RESOURCE(maps, TL_MADE_DEPTHS, tl_shadow_maps *)                                                         \
    RESOURCE(gbuffer, TL_MADE_GBUFFER, struct tl_gbuffer)                                                    \
    RESOURCE(ids, TL_MADE_IDS, struct tl_id_buffer)                                                          \
    RESOURCE(pixel_ids, TL_MADE_IDS, struct tl_id_buffer) /* of every pixel, where samples are fewer */      \
    RESOURCE(shade_materials, TL_MADE_SHADE_MATERIALS, struct tl_shade_materials)                            \
    RESOURCE(ratios, TL_MADE_RATIOS, struct tl_vertex_ratios)                                                \
    RESOURCE(pixel_triangles, TL_MADE_SUN_PIXELS, struct tl_pixel_triangles)                                 \
    RESOURCE(sun_pixels, TL_MADE_SUN_PIXELS, struct tl_sun_pixels)                                           \
    RESOURCE(samples, TL_MADE_SAMPLES, struct tl_samples)                                                    \
    RESOURCE(transparency, TL_MADE_TRANSPARENCY, struct tl_transparency)                                     \
    RESOURCE(mirrors, TL_MADE_MIRRORS, struct tl_mirrors)                                                    \
    RESOURCE(trace, TL_MADE_TRACE, tl_trace *)                                                               \
    RESOURCE(points, TL_MADE_POINTS, tl_points *)                                                            \
    RESOURCE(bounce, TL_MADE_BOUNCE, struct tl_bounce)                                                       \
    RESOURCE(points_are_done, TL_MADE_POINTS, bool) /* another round would change nothing */                 \
    RESOURCE(envmap_source, TL_MADE_ENVMAP_LOBES, struct tl_envmap_source)                                   \
    RESOURCE(capture, TL_MADE_CAPTURE, struct tl_capture)                                                    \
    RESOURCE(envmap, TL_MADE_ENVMAP, struct tl_envmap)                                                       \
    RESOURCE(light_map, TL_MADE_LIGHT_MAP, struct tl_light_map)                                              \
    RESOURCE(light, TL_MADE_LIGHT, struct tl_light_buffer)                                                   \
    RESOURCE(strain_range, TL_MADE_LIGHT, float) /* share of 1 at the ends of the legend */                  \
    RESOURCE(local, TL_MADE_LAMP_MAPS, struct tl_local)                                                      \
    RESOURCE(present, TL_MADE_IMAGE, struct tl_present)                                                      \
    RESOURCE(standard_error, TL_MADE_IMAGE, double) /* of the last reference */

struct tl_resources {
#define TL_RESOURCE_MEMBER(member, bit, type) type member;
    TL_INPUT_RESOURCES(TL_RESOURCE_MEMBER)
    TL_MADE_RESOURCES(TL_RESOURCE_MEMBER)
#undef TL_RESOURCE_MEMBER
    tl_bits valid; /* which of them hold what their inputs call for */

    /* Devices and caches of the jobs: they decide the jobs' speed, never their results. */
    tl_gpu *gpu;
    struct tl_lighting lighting;
    struct tl_light_cache light_cache;
    tl_prepared *prepared;               /* for the environment to come; NULL: nothing */
    struct tl_resampling resampling;     /* from environments of one size to the cube */
    struct tl_resampling map_resampling; /* ... to the size of environment maps */

    /* Further values of the frame that jobs read. A change of one is no reason to run. */
    tl_bits facts; /* of its scene */
    struct tl_motion_state motion_state;
    struct tl_picture_part show_part; /* what of the image is shown */
};

/* A member's bit: TL_RESOURCE_OF_cube is TL_MADE_CUBE. */
enum {
/* NOLINTNEXTLINE(bugprone-macro-parentheses): the bit is one name */
#define TL_RESOURCE_BIT(member, bit, type) TL_RESOURCE_OF_##member = bit,
    TL_INPUT_RESOURCES(TL_RESOURCE_BIT) TL_MADE_RESOURCES(TL_RESOURCE_BIT)
#undef TL_RESOURCE_BIT
};

/* The ground's disc; NULL: none is drawn. */
static inline const struct tl_ground *tl_ground_drawn(const struct tl_resources *resources)
{
    return resources->ground_input.is_drawn ? &resources->ground : NULL;
}

#endif
