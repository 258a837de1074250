/* The resources that the jobs of a frame read and write, and the caches that they use. The lists name the
 * inputs of a frame first, then the results of jobs, each with its bit in the plan (resource.h). No job sees
 * the whole struct: job_io.h lists the members that each one gets.
 *
 * Lifetime: tl_resources_release frees what the members own. Inputs borrow from the frame (inputs.h).
 * Threads: the renderer's. Errors: none. */
#ifndef TOILE_RENDER_FRAME_RESOURCES_H
#define TOILE_RENDER_FRAME_RESOURCES_H

#include "render/bounce/bounce.h"
#include "render/card/card.h"
#include "render/detail/maps.h"
#include "render/env/resample.h"
#include "render/env/sun.h"
#include "render/envmap/capture.h"
#include "render/envmap/envmap.h"
#include "render/envmap/light_map.h"
#include "render/frame/inputs.h"
#include "render/frame/prepared.h"
#include "render/light/light.h"
#include "render/light/lobe_sums.h"
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
    uint64_t revision;            /* of the cube that they are of */
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

/* clang-format off */
/* The members of struct tl_resources, by who owns their memory:
 *
 *     VALUE(member, bit, type)                     has no memory of its own
 *     OWNED(member, bit, type, bytes, release)     size_t bytes(const type *); void release(type *)
 *     HANDLE(member, bit, type, bytes, destroy)    a pointer, which a job gets as it is; destroy(type **)
 *
 * Functions without a prefix are those of memory.c. Several members may have one bit. Results that are made
 * in place of another one (TL_MADE_MAPS, blurred where the depths were; TL_MADE_LAMPLIGHT, added to the light
 * ...) have no member of their own. */
#define TL_INPUT_RESOURCES(VALUE)                                                                            \
    VALUE(environment, TL_INPUT_ENVIRONMENT, struct tl_environment_input)                                    \
    VALUE(yaw, TL_INPUT_YAW, float) /* rad */                                                                \
    VALUE(shapes, TL_INPUT_SHAPES, struct tl_shapes_input)                                                   \
    VALUE(motion, TL_INPUT_MOTION, struct tl_motion_input)                                                   \
    VALUE(camera, TL_INPUT_CAMERA, struct tl_camera_input)                                                   \
    VALUE(size, TL_INPUT_SIZE, struct tl_size_input)                                                         \
    VALUE(ground_input, TL_INPUT_GROUND, struct tl_ground_input)                                             \
    VALUE(lobes_input, TL_INPUT_LOBES, struct tl_lobes_input)                                                \
    VALUE(pem_options, TL_INPUT_PEM_SIZE, struct tl_light_params)                                            \
    VALUE(filter_options, TL_INPUT_FILTER, struct tl_light_params)                                           \
    VALUE(sun_options, TL_INPUT_SUN, struct tl_light_params)                                                 \
    VALUE(cut_options, TL_INPUT_REGIONS, struct tl_light_params)                                             \
    VALUE(storage_options, TL_INPUT_PASSES, struct tl_light_params)                                          \
    VALUE(shadows, TL_INPUT_MAPS, struct tl_shadow_input)                                                    \
    VALUE(rays, TL_INPUT_RAYS, struct tl_rays_input)                                                         \
    VALUE(round, TL_INPUT_ROUND, int)                                                                        \
    VALUE(scene_round, TL_INPUT_SCENE_ROUND, int)                                                            \
    VALUE(shift, TL_INPUT_SHIFT, struct tl_shift_input)                                                      \
    VALUE(light_options, TL_INPUT_LIGHT, struct tl_light_params)                                             \
    VALUE(lamps, TL_INPUT_LAMPS, struct tl_lamps_input)                                                      \
    VALUE(reference_options, TL_INPUT_REFERENCE, struct tl_reference_params)                                 \
    VALUE(detail_steps, TL_INPUT_DETAIL, struct tl_detail_params)                                            \
    VALUE(detail_options, TL_INPUT_DETAIL_MAPS, struct tl_detail_params)                                     \
    VALUE(show_options, TL_INPUT_SHOW, struct tl_image_params)                                               \
    VALUE(envmap_input, TL_INPUT_ENVMAP, struct tl_envmap_input)                                             \
    VALUE(layout_options, TL_INPUT_LAYOUT, struct tl_maps_params)                                            \
    VALUE(look_up_options, TL_INPUT_LOOK_UP, struct tl_maps_params)                                          \
    VALUE(capture_options, TL_INPUT_CAPTURE, struct tl_maps_params)                                          \
    VALUE(view_options, TL_INPUT_VIEW, struct tl_image_params)                                               \
    VALUE(ratio_options, TL_INPUT_RATIO, struct tl_light_params)

#define TL_MADE_RESOURCES(VALUE, OWNED, HANDLE)                                                              \
    OWNED(cube, TL_MADE_CUBE, tl_cube, cube_bytes, tl_cube_release) /* without the suns */                   \
    VALUE(suns, TL_MADE_CUBE, struct tl_suns) /* that were taken from it */                                  \
    OWNED(regions, TL_MADE_REGIONS, struct tl_regions, regions_bytes, tl_regions_release)                    \
    VALUE(regions_revision, TL_MADE_REGIONS, uint64_t)                                                       \
    OWNED(lobe_levels, TL_MADE_LOBE, tl_texture, tl_texture_bytes, tl_texture_destroy)                       \
    OWNED(pems, TL_MADE_PEMS, struct tl_pems, tl_pems_bytes, tl_pems_release)                                \
    VALUE(exact, TL_MADE_LOBES, struct tl_exact_light)                                                       \
    OWNED(slices, TL_MADE_SLICES, struct tl_region_slices, region_slices_bytes, region_slices_release)       \
    VALUE(lights, TL_MADE_LIGHTS, const struct tl_region_lights *) /* among those of the cache */            \
    HANDLE(surfaces, TL_MADE_SURFACES, tl_surfaces, tl_surfaces_bytes, tl_surfaces_destroy)                  \
    VALUE(casters, TL_MADE_SURFACES, struct tl_casters)                                                      \
    VALUE(ground, TL_MADE_SURFACES, struct tl_ground)                                                        \
    OWNED(detail, TL_MADE_DETAIL, struct tl_detail_maps, tl_detail_maps_bytes, tl_detail_maps_release)       \
    HANDLE(maps, TL_MADE_DEPTHS, tl_shadow_maps, tl_shadow_maps_bytes, tl_shadow_maps_destroy)               \
    OWNED(gbuffer, TL_MADE_GBUFFER, struct tl_gbuffer, tl_gbuffer_bytes, tl_gbuffer_release)                 \
    OWNED(ids, TL_MADE_IDS, struct tl_id_buffer, tl_ids_bytes, tl_ids_release)                               \
    OWNED(pixel_ids, TL_MADE_IDS, struct tl_id_buffer,                                                       \
          tl_ids_bytes, tl_ids_release) /* of every pixel, where samples are fewer */                        \
    OWNED(shade_materials, TL_MADE_SHADE_MATERIALS, struct tl_shade_materials,                               \
          tl_shade_materials_bytes, tl_shade_materials_release)                                              \
    OWNED(ratios, TL_MADE_RATIOS, struct tl_vertex_ratios, tl_ratios_bytes, tl_ratios_release)               \
    OWNED(pixel_triangles, TL_MADE_SUN_PIXELS, struct tl_pixel_triangles,                                    \
          pixel_triangles_bytes, tl_pixel_triangles_release)                                                 \
    OWNED(sun_pixels, TL_MADE_SUN_PIXELS, struct tl_sun_pixels, tl_sun_pixels_bytes, tl_sun_pixels_release)  \
    OWNED(samples, TL_MADE_SAMPLES, struct tl_samples, samples_bytes, tl_samples_release)                    \
    OWNED(lobe_sums, TL_MADE_LOBE_SUMS, struct tl_lobe_sums, tl_lobe_sums_bytes, tl_lobe_sums_release)       \
    OWNED(transparency, TL_MADE_TRANSPARENCY, struct tl_transparency,                                        \
          tl_transparency_bytes, tl_transparency_release)                                                    \
    OWNED(mirrors, TL_MADE_MIRRORS, struct tl_mirrors, no_bytes, tl_mirrors_release)                         \
    HANDLE(trace, TL_MADE_TRACE, tl_trace, tl_trace_bytes, tl_trace_destroy)                                 \
    HANDLE(points, TL_MADE_POINTS, tl_points, tl_points_bytes, tl_points_destroy)                            \
    HANDLE(card, TL_MADE_CARD_SURFACES, tl_graphics_card, tl_card_bytes, tl_card_destroy)                             \
    OWNED(bounce, TL_MADE_BOUNCE, struct tl_bounce, tl_bounce_bytes, tl_bounce_release)                      \
    VALUE(points_are_done, TL_MADE_POINTS, bool) /* another round would change nothing */                    \
    OWNED(envmap_source, TL_MADE_ENVMAP_LOBES, struct tl_envmap_source,                                      \
          envmap_source_bytes, envmap_source_release)                                                        \
    OWNED(capture, TL_MADE_CAPTURE, struct tl_capture, tl_capture_bytes, tl_capture_release)                 \
    OWNED(envmap, TL_MADE_ENVMAP, struct tl_envmap, tl_envmap_bytes, tl_envmap_release)                      \
    OWNED(light_map, TL_MADE_LIGHT_MAP, struct tl_light_map, tl_light_map_bytes, tl_light_map_release)       \
    OWNED(light, TL_MADE_LIGHT, struct tl_light_buffer, tl_light_buffer_bytes, tl_light_buffer_release)      \
    VALUE(strain_range, TL_MADE_LIGHT, float) /* share of 1 at the ends of the legend */                     \
    OWNED(local, TL_MADE_LAMP_MAPS, struct tl_local, no_bytes, tl_local_release)                             \
    OWNED(present, TL_MADE_IMAGE, struct tl_present, tl_present_bytes, tl_present_release)                   \
    VALUE(standard_error, TL_MADE_IMAGE, double) /* of the last reference */

/* ... and what is neither an input nor made: it has no bit, so no job can READ it. */
#define TL_OTHER_RESOURCES(VALUE, OWNED, HANDLE)                                                             \
    /* Devices and caches: they decide the jobs' speed, never their results. */                              \
    HANDLE(gpu, 0, tl_gpu, no_bytes, borrowed) /* outlives the renderer */                                   \
    OWNED(lighting, 0, struct tl_lighting, no_bytes, tl_lighting_release)                                    \
    OWNED(light_cache, 0, struct tl_light_cache, no_bytes, tl_light_cache_release)                           \
    /* Prepared for the environment to come; NULL: nothing. */                                               \
    OWNED(prepared, 0, tl_prepared *, no_bytes, tl_prepared_destroy)                                         \
    /* Resampling from environments of one size to the cube, and to the size of environment maps. */         \
    OWNED(resampling, 0, struct tl_resampling, no_bytes, tl_resampling_release)                              \
    OWNED(map_resampling, 0, struct tl_resampling, no_bytes, tl_resampling_release)                          \
    /* Values of the frame whose change is no reason to run. */                                              \
    VALUE(facts, 0, tl_bits) /* of its scene: bits of enum tl_scene_fact */                                  \
    VALUE(motion_state, 0, struct tl_motion_state)                                                           \
    VALUE(show_part, 0, struct tl_picture_part) /* what of the image is shown */
/* clang-format on */

struct tl_resources {
#define TL_VALUE_MEMBER(member, bit, type)       type member;
#define TL_OWNED_MEMBER(member, bit, type, ...)  type member;
#define TL_HANDLE_MEMBER(member, bit, type, ...) type *member;
    TL_INPUT_RESOURCES(TL_VALUE_MEMBER)
    TL_MADE_RESOURCES(TL_VALUE_MEMBER, TL_OWNED_MEMBER, TL_HANDLE_MEMBER)
    TL_OTHER_RESOURCES(TL_VALUE_MEMBER, TL_OWNED_MEMBER, TL_HANDLE_MEMBER)
    tl_bits valid; /* resources that hold what their inputs call for */
};

/* Access to a member as a job gets it: a HANDLE itself, the address of any other. */
/* NOLINTBEGIN(bugprone-macro-parentheses): a name in parentheses is not one */
#define TL_ACCESS(member, bit, type, ...)                                                                    \
    static inline __typeof__(type) *tl_resource_##member(struct tl_resources *all)                           \
    {                                                                                                        \
        return &all->member;                                                                                 \
    }
#define TL_ACCESS_HANDLE(member, bit, type, ...)                                                             \
    static inline type *tl_resource_##member(struct tl_resources *all)                                       \
    {                                                                                                        \
        return all->member;                                                                                  \
    }
TL_INPUT_RESOURCES(TL_ACCESS)
TL_MADE_RESOURCES(TL_ACCESS, TL_ACCESS, TL_ACCESS_HANDLE)
TL_OTHER_RESOURCES(TL_ACCESS, TL_ACCESS, TL_ACCESS_HANDLE)

/* A member's bit: TL_RESOURCE_OF_cube is TL_MADE_CUBE. */
enum {
#define TL_RESOURCE_BIT(member, bit, ...) TL_RESOURCE_OF_##member = bit,
    TL_INPUT_RESOURCES(TL_RESOURCE_BIT) TL_MADE_RESOURCES(TL_RESOURCE_BIT, TL_RESOURCE_BIT, TL_RESOURCE_BIT)
};
/* NOLINTEND(bugprone-macro-parentheses) */

/* The ground's disc; NULL: none is drawn. */
static inline const struct tl_ground *tl_ground_drawn(const struct tl_resources *resources)
{
    return resources->ground_input.is_drawn ? &resources->ground : NULL;
}

#endif
