/* clang-format off */
/* The jobs of a frame: what each one reads and writes. A run function (run_*.c) gets the struct of its job
 * and sees nothing else of the frame, so that it can neither read nor write what its list does not name:
 * another member does not compile, and a member that is read is const.
 *
 * Example: the job `lobe` calibrates the filter chain of PEMs. Its list and its row in TL_JOBS,
 *
 *     #define TL_JOB_lobe(IO)
 *         IO(READS, pem_options) IO(READS, filter_options) IO(WRITES, lobe_levels) IO(USES, gpu)
 *     JOB(lobe, TL_FACT(CHAINS), "calibration of glossiness to chain level")
 *
 * become what the plan needs (the job is dropped unless the scene needs chains, and runs again when the size
 * of PEMs or the filter has changed), this struct, and the declaration of this function, which
 * run_environment.c defines:
 *
 *     struct tl_lobe_job {
 *         const struct tl_light_params *pem_options;
 *         const struct tl_light_params *filter_options;
 *         tl_texture *lobe_levels;
 *         tl_gpu *gpu;
 *     };
 *     bool tl_run_lobe(const struct tl_lobe_job *job, tl_error *error);
 *
 * A new job is a list, a row, and a function; a new result is a row of TL_MADE_BITS (resource.h) and one of
 * TL_MADE_RESOURCES (resources.h). The seven kinds of entries:
 *
 *     READS(member)           the job reads the member, and runs again when it has changed
 *     AFTER(bit)              no field: the job runs again when the resource has changed. For what replaces a
 *                             member of the job in place, and for inputs after which the light starts again
 *     SEES(member)            the job reads the member, but does not run because of it: it changes only
 *                             together with one that is read, or does not decide the result
 *     WRITES(member)          the job makes the resource
 *     WRITES_IN(member, bit)  the job makes the resource `bit`, which is a part of the member
 *     EXTENDS(member, bit)    the job reads the member and turns it into the resource `bit` in place
 *     USES(member)            a cache, a program, the GPU: it decides the job's speed, never its result
 *
 * `const` reaches as deep as C lets it: not through pointers inside of a struct.
 * tests/render/frame/test_jobs.c checks every entry. Threads, errors: as the run functions', which run on the
 * renderer's thread and fail with `error` set. */
#ifndef TOILE_RENDER_FRAME_JOB_IO_H
#define TOILE_RENDER_FRAME_JOB_IO_H

#include "render/frame/resources.h"

/* All jobs in the order in which they run: JOB(name, facts, what). A job is dropped unless all of its facts
 * (TL_SCENE_FACTS in resource.h) hold of the scene. */
#define TL_FACT(fact) TL_BIT(TL_SCENE_##fact)
#define TL_JOBS(JOB)                                                                                         \
    JOB(cube, 0, "environment to a cube map; its suns taken out")                                            \
    JOB(regions, 0, "the cube cut into regions")                                                             \
    JOB(lobe, TL_FACT(CHAINS), "calibration of glossiness to chain level")                                   \
    JOB(pems, TL_FACT(CHAINS), "a filtered copy of the cube for each region")                                \
    JOB(lobes, TL_FACT(EXACT), "the whole environment through exact lobes")                                  \
    JOB(slices, TL_FACT(SLICES), "the regions through exact lobes")                                          \
    JOB(lights, TL_FACT(REGION_LIGHTS), "the regions as lights that add up to the exact light")    \
    JOB(surfaces, 0, "vertices and maps to the GPU")                                                         \
    JOB(detail, TL_FACT(DETAIL), "heights, cones, horizons and spread of normals of the fabrics")            \
    JOB(maps, TL_FACT(MAPS), "a shadow map for each region and sun")                                         \
    JOB(blur, TL_FACT(MAPS) | TL_FACT(BLUR), "shadow maps blurred by the size of their regions")             \
    JOB(gbuffer, 0, "nearest point, normal and material of every sample")                                    \
    JOB(ids, TL_FACT(RATIOS), "the number of the nearest triangle at every pixel")                           \
    JOB(shade_materials, TL_FACT(PIXELS), "materials, their maps and fits to the CPU")                       \
    JOB(samples, TL_FACT(SAMPLES), "the covered samples to the CPU")                                         \
    JOB(lobe_sums, TL_FACT(LOBE_SUMS), "gloss of facets as sums of cosine lobes")                            \
    JOB(transparency, TL_FACT(TRANSPARENCY), "rays: what lies behind open cloth and shines through it")      \
    JOB(trace, 0, "surfaces to what rays are traced in")                                                     \
    JOB(mirrors, TL_FACT(MIRRORS), "rays: what near mirrors show")                                           \
    JOB(points, TL_FACT(RAYS) | TL_FACT(SHADOWS), "rays: visibility of the regions, kept at vertices")       \
    JOB(bounce, TL_FACT(BOUNCE), "rays: light that surfaces send on to each other, kept at vertices")        \
    JOB(ratios, TL_FACT(RATIOS), "ratio of seen to exact light, at vertices")                                \
    JOB(sun_pixels, TL_FACT(RATIOS), "rays: what every pixel sees of suns and lamps")                        \
    JOB(shade, TL_FACT(RATIOS), "exact light times the interpolated ratio, pixel by pixel")                  \
    JOB(card_surfaces, TL_FACT(CARD), "vertices to the card, its tree of rays fitted to them")               \
    JOB(card_ids, TL_FACT(CARD_RATIOS), "the nearest triangle at every pixel; vertices that are seen")    \
    JOB(card_points, TL_FACT(CARD_RATIOS), "rays: what vertices see of the regions")                         \
    JOB(card_bounce, TL_FACT(CARD_BOUNCE), "rays: light that surfaces send on to each other")                \
    JOB(card_ratios, TL_FACT(CARD_RATIOS), "ratio of seen to exact light, at vertices")                      \
    JOB(card_suns, TL_FACT(CARD_RATIOS), "rays: what every pixel sees of suns and lamps")                     \
    JOB(card_shade, TL_FACT(CARD_RATIOS), "exact light times the interpolated ratio, pixel by pixel")        \
    JOB(card_rest, TL_FACT(CARD_REST), "paths of light from every pixel, a round a frame")                   \
    JOB(light, TL_FACT(PASSES), "visibility times PEM, summed over the regions")                             \
    JOB(compose, TL_FACT(COMPOSED), "exact light times the share of it that is seen")                        \
    JOB(inspect, TL_FACT(INSPECT), "what a view shows in place of light")                                    \
    JOB(envmap_lobes, TL_FACT(ENVMAP), "all light through exact lobes, for environment maps")                \
    JOB(capture, TL_FACT(ENVMAP) | TL_FACT(CAPTURE), "the scene seen from a point, through exact lobes")     \
    JOB(envmap, TL_FACT(ENVMAP), "lobes resampled to environment maps of a layout")                          \
    JOB(light_map, TL_FACT(LIGHT_MAP), "diffuse light with shadows, baked over UVs")                         \
    JOB(look_up, TL_FACT(ENVMAP), "environment maps looked up for every sample")                             \
    JOB(lamp_maps, TL_FACT(LAMP_MAPS), "a shadow map for each lamp")                                         \
    JOB(lamp_rays, TL_FACT(LAMP_RAYS), "rays: what is seen of each lamp")                                    \
    JOB(lamps, TL_FACT(LAMPS), "light of the lamps, added")                                                  \
    JOB(resolve, TL_FACT(RASTER), "samples to pixels")                                                       \
    JOB(reference, TL_FACT(REFERENCE), "the image, ray traced")                                              \
    JOB(backdrop, 0, "the environment as it is seen behind")                                                 \
    JOB(show, 0, "background, exposure, tone mapping")

#define TL_JOB_cube(IO)                                                                                      \
    IO(READS, environment) IO(READS, pem_options) IO(READS, sun_options) IO(WRITES, cube)                    \
    IO(WRITES, suns) IO(USES, light_cache) IO(USES, prepared) IO(USES, resampling)

#define TL_JOB_regions(IO)                                                                                   \
    IO(READS, cube) IO(READS, cut_options) IO(SEES, light_cache) IO(WRITES, regions)                         \
    IO(WRITES, regions_revision)

#define TL_JOB_lobe(IO)                                                                                      \
    IO(READS, pem_options) IO(READS, filter_options) IO(WRITES, lobe_levels) IO(USES, gpu)

#define TL_JOB_pems(IO)                                                                                      \
    IO(READS, cube) IO(READS, regions) IO(READS, filter_options) IO(READS, storage_options)                  \
    IO(WRITES, pems) IO(USES, gpu)

#define TL_JOB_lobes(IO)                                                                                     \
    IO(READS, cube) IO(READS, shapes) IO(READS, detail_options) IO(WRITES, exact)                            \
    IO(USES, light_cache)

#define TL_JOB_slices(IO)                                                                                    \
    IO(READS, cube) IO(READS, regions) IO(READS, shapes) IO(READS, detail_options)                           \
    IO(WRITES, slices) IO(USES, gpu)

#define TL_JOB_lights(IO)                                                                                    \
    IO(READS, regions) IO(READS, exact) IO(READS, light_options) IO(SEES, cut_options)                       \
    IO(WRITES, lights) IO(USES, light_cache)

#define TL_JOB_surfaces(IO)                                                                                  \
    IO(READS, shapes) IO(READS, motion) IO(READS, ground_input) IO(READS, detail_options)                    \
    IO(WRITES, surfaces) IO(WRITES, casters) IO(WRITES, ground)

#define TL_JOB_detail(IO)                                                                                    \
    IO(READS, shapes) IO(READS, detail_options) IO(READS, ground_input) IO(SEES, detail_steps)               \
    IO(WRITES, detail) IO(USES, gpu)

#define TL_JOB_maps(IO)                                                                                      \
    IO(READS, surfaces) IO(READS, casters) IO(READS, regions) IO(READS, regions_revision)                    \
    IO(READS, yaw) IO(READS, shadows) IO(READS, storage_options) IO(READS, round)                            \
    IO(SEES, suns) IO(SEES, shapes) IO(SEES, ground_input) IO(SEES, rays)                                    \
    IO(SEES, motion_state) IO(WRITES, maps)

#define TL_JOB_blur(IO)                                                                                      \
    IO(EXTENDS, maps, TL_MADE_MAPS) IO(READS, regions) IO(READS, regions_revision) IO(READS, surfaces)       \
    IO(READS, casters) IO(SEES, yaw) IO(SEES, shadows) IO(SEES, storage_options)                             \
    IO(SEES, round) IO(SEES, suns) IO(SEES, shapes) IO(SEES, ground_input)                                   \
    IO(SEES, rays) IO(SEES, motion_state)

#define TL_JOB_gbuffer(IO)                                                                                   \
    IO(READS, surfaces) IO(READS, ground) IO(READS, shift) IO(READS, camera)                                 \
    IO(READS, size) IO(READS, ground_input) IO(READS, detail_steps) IO(READS, detail_options)                \
    IO(READS, lobes_input) IO(AFTER, TL_MADE_DETAIL) IO(SEES, shapes) IO(WRITES, gbuffer)                    \
    IO(USES, gpu)

#define TL_JOB_ids(IO)                                                                                       \
    IO(READS, surfaces) IO(READS, ground) IO(READS, shift) IO(READS, camera)                                 \
    IO(READS, size) IO(READS, ground_input) IO(READS, shapes) IO(WRITES, ids)                                \
    IO(WRITES, pixel_ids) IO(USES, gpu)

#define TL_JOB_shade_materials(IO)                                                                           \
    IO(READS, shapes) IO(READS, detail_options) IO(READS, ground_input) IO(READS, light_options)             \
    IO(WRITES, shade_materials)

#define TL_JOB_samples(IO)                                                                                   \
    IO(READS, gbuffer) IO(READS, camera) IO(READS, shapes) IO(WRITES, samples)

#define TL_JOB_transparency(IO)                                                                              \
    IO(EXTENDS, samples, TL_MADE_TRANSPARENCY) IO(READS, surfaces) IO(READS, ground) IO(READS, gbuffer)      \
    IO(READS, shift) IO(READS, camera) IO(READS, size) IO(READS, ground_input)                               \
    IO(READS, detail_steps) IO(READS, lobes_input) IO(READS, shapes) IO(WRITES, transparency)                \
    IO(USES, gpu)

#define TL_JOB_trace(IO)                                                                                     \
    IO(READS, shapes) IO(READS, motion) IO(WRITES, trace)

#define TL_JOB_mirrors(IO)                                                                                   \
    IO(EXTENDS, samples, TL_MADE_MIRRORS) IO(READS, trace) IO(READS, shapes) IO(READS, ground_input)         \
    IO(READS, ground) IO(AFTER, TL_MADE_TRANSPARENCY) IO(WRITES, mirrors)

#define TL_JOB_points(IO)                                                                                    \
    IO(READS, samples) IO(READS, ids) IO(READS, regions) IO(READS, regions_revision)                         \
    IO(READS, suns) IO(READS, trace) IO(READS, shapes) IO(READS, ground_input)                               \
    IO(READS, ground) IO(READS, yaw) IO(READS, rays) IO(READS, scene_round)                                  \
    IO(AFTER, TL_MADE_TRANSPARENCY) IO(AFTER, TL_MADE_MIRRORS) IO(SEES, round) IO(SEES, motion_state)        \
    IO(SEES, facts) IO(WRITES, points) IO(WRITES, points_are_done)

#define TL_JOB_bounce(IO)                                                                                    \
    IO(READS, samples) IO(READS, ids) IO(READS, cube) IO(READS, suns)                                        \
    IO(READS, lamps) IO(READS, exact) IO(READS, trace) IO(READS, shapes)                                     \
    IO(READS, ground_input) IO(READS, ground) IO(READS, yaw) IO(READS, light_options)                        \
    IO(READS, scene_round) IO(AFTER, TL_MADE_TRANSPARENCY) IO(SEES, environment) IO(SEES, motion_state)      \
    IO(SEES, facts) IO(WRITES, bounce)

#define TL_JOB_ratios(IO)                                                                                    \
    IO(READS, ids) IO(READS, shade_materials) IO(READS, points) IO(READS, bounce)                            \
    IO(READS, lights) IO(READS, regions) IO(READS, exact) IO(READS, yaw)                                     \
    IO(READS, camera) IO(READS, shapes) IO(READS, light_options) IO(SEES, facts)                             \
    IO(SEES, regions_revision) IO(SEES, environment) IO(WRITES, ratios)

#define TL_JOB_sun_pixels(IO)                                                                                \
    IO(READS, ids) IO(READS, shade_materials) IO(READS, suns) IO(READS, lamps) IO(READS, trace)              \
    IO(READS, yaw) IO(READS, shift) IO(READS, camera) IO(READS, shapes)                                      \
    IO(READS, ground) IO(READS, ground_input) IO(WRITES, pixel_triangles) IO(WRITES, sun_pixels)

#define TL_JOB_shade(IO)                                                                                     \
    IO(READS, ids) IO(READS, pixel_ids) IO(READS, ratios) IO(READS, pixel_triangles)                         \
    IO(READS, sun_pixels) IO(READS, shade_materials) IO(READS, exact) IO(READS, suns) IO(READS, lamps)       \
    IO(READS, yaw) IO(READS, shift) IO(READS, camera) IO(READS, size)                                        \
    IO(READS, shapes) IO(READS, ground) IO(READS, ground_input) IO(AFTER, TL_INPUT_RATIO)                    \
    IO(AFTER, TL_INPUT_DEVICE) IO(AFTER, TL_INPUT_VIEW) IO(SEES, trace) IO(WRITES, present)

#define TL_JOB_card_surfaces(IO)                                                                             \
    IO(READS, shapes) IO(READS, motion) IO(READS, ground) IO(READS, ground_input)                            \
    IO(READS, shade_materials) IO(WRITES, card)

/* Rounds at rest leave other IDs. */
#define TL_JOB_card_ids(IO)                                                                                  \
    IO(EXTENDS, card, TL_MADE_CARD_IDS) IO(READS, shift) IO(READS, camera) IO(READS, size)                   \
    IO(AFTER, TL_INPUT_RATIO)

#define TL_JOB_card_points(IO)                                                                               \
    IO(EXTENDS, card, TL_MADE_CARD_POINTS) IO(AFTER, TL_MADE_CARD_IDS) IO(READS, regions)                    \
    IO(READS, regions_revision) IO(READS, suns) IO(READS, exact) IO(READS, lights)                           \
    IO(READS, yaw) IO(READS, rays) IO(READS, light_options) IO(READS, ground) IO(READS, lamps)               \
    IO(READS, ground_input) IO(SEES, environment) IO(SEES, shapes)

#define TL_JOB_card_bounce(IO)                                                                               \
    IO(EXTENDS, card, TL_MADE_CARD_BOUNCE) IO(AFTER, TL_MADE_CARD_POINTS) IO(READS, cube)                    \
    IO(READS, light_options) IO(SEES, environment)

#define TL_JOB_card_ratios(IO)                                                                               \
    IO(EXTENDS, card, TL_MADE_CARD_RATIOS) IO(AFTER, TL_MADE_CARD_POINTS) IO(AFTER, TL_MADE_CARD_BOUNCE)     \
    IO(SEES, facts)

#define TL_JOB_card_suns(IO)                                                                                 \
    IO(EXTENDS, card, TL_MADE_CARD_SUNS) IO(AFTER, TL_MADE_CARD_IDS) IO(AFTER, TL_MADE_CARD_POINTS)

#define TL_JOB_card_shade(IO)                                                                                \
    IO(READS, size) IO(READS, shift) IO(AFTER, TL_MADE_CARD_RATIOS) IO(AFTER, TL_MADE_CARD_SUNS)             \
    IO(AFTER, TL_INPUT_VIEW) IO(AFTER, TL_INPUT_DEVICE) IO(USES, card) IO(USES, gpu)                         \
    IO(WRITES, present)

#define TL_JOB_card_rest(IO)                                                                                 \
    IO(READS, environment) IO(READS, yaw) IO(READS, lamps) IO(READS, shift) IO(READS, camera)                \
    IO(READS, size) IO(READS, light_options) IO(READS, reference_options) IO(AFTER, TL_MADE_CARD_SURFACES)   \
    IO(AFTER, TL_INPUT_VIEW) IO(AFTER, TL_INPUT_RATIO) IO(AFTER, TL_INPUT_DEVICE) IO(USES, card)             \
    IO(USES, gpu) IO(WRITES, present)

#define TL_JOB_lobe_sums(IO)                                                                                 \
    IO(READS, samples) IO(READS, shapes) IO(READS, camera) IO(READS, light_options) IO(WRITES, lobe_sums)    \
    IO(USES, gpu)

#define TL_JOB_light(IO)                                                                                     \
    IO(READS, gbuffer) IO(READS, pems) IO(READS, slices) IO(READS, regions)                                  \
    IO(READS, suns) IO(READS, lobe_levels) IO(READS, exact) IO(READS, maps) IO(READS, lobe_sums)             \
    IO(READS, casters) IO(READS, ground) IO(READS, ground_input) IO(READS, yaw) IO(SEES, facts)              \
    IO(READS, camera) IO(READS, round) IO(READS, light_options) IO(AFTER, TL_MADE_MAPS)                      \
    IO(AFTER, TL_INPUT_LAMPS) IO(AFTER, TL_INPUT_VIEW) IO(WRITES, light) IO(USES, lighting)                  \
    IO(USES, gpu)

#define TL_JOB_compose(IO)                                                                                   \
    IO(READS, samples) IO(READS, transparency) IO(READS, mirrors) IO(READS, points)                          \
    IO(READS, bounce) IO(READS, lights) IO(READS, exact) IO(READS, suns)                                     \
    IO(READS, gbuffer) IO(READS, shapes) IO(READS, ground) IO(READS, ground_input)                           \
    IO(READS, yaw) IO(READS, light_options) IO(READS, camera) IO(READS, lamps)                               \
    IO(AFTER, TL_INPUT_VIEW) IO(SEES, environment) IO(SEES, trace) IO(SEES, facts)                           \
    IO(WRITES, light) IO(USES, gpu)

#define TL_JOB_inspect(IO)                                                                                   \
    IO(READS, samples) IO(READS, points) IO(READS, regions) IO(READS, shapes)                                \
    IO(READS, motion) IO(READS, yaw) IO(READS, camera) IO(READS, view_options)                               \
    IO(WRITES, light) IO(WRITES, strain_range)

#define TL_JOB_envmap_lobes(IO)                                                                              \
    IO(READS, environment) IO(READS, envmap_input) IO(READS, shapes) IO(READS, detail_options)               \
    IO(WRITES, envmap_source) IO(USES, map_resampling)

/* The scene that it draws is no reason to run: changes wait until the next capture is due. */
#define TL_JOB_capture(IO)                                                                                   \
    IO(READS, capture_options) IO(SEES, envmap_source) IO(SEES, yaw) IO(SEES, shapes)                        \
    IO(SEES, detail_options) IO(SEES, casters) IO(SEES, ground) IO(SEES, ground_input)                       \
    IO(SEES, lamps) IO(SEES, lighting) IO(WRITES, capture) IO(USES, surfaces)                                \
    IO(USES, gpu)

#define TL_JOB_envmap(IO)                                                                                    \
    IO(EXTENDS, capture, TL_MADE_ENVMAP) IO(READS, envmap_source) IO(READS, layout_options) IO(READS, yaw)   \
    IO(READS, shapes) IO(READS, ground_input) IO(SEES, envmap_input) IO(SEES, detail_options)                \
    IO(SEES, camera) IO(WRITES, envmap) IO(USES, gpu)

#define TL_JOB_light_map(IO)                                                                                 \
    IO(READS, environment) IO(READS, yaw) IO(READS, shapes) IO(READS, motion)                                \
    IO(READS, ground) IO(READS, ground_input) IO(READS, reference_options) IO(READS, detail_steps)           \
    IO(READS, envmap_input) IO(WRITES, light_map) IO(USES, gpu)

#define TL_JOB_look_up(IO)                                                                                   \
    IO(READS, gbuffer) IO(READS, camera) IO(READS, look_up_options) IO(READS, surfaces)                      \
    IO(AFTER, TL_MADE_ENVMAP) IO(AFTER, TL_MADE_LIGHT_MAP) IO(AFTER, TL_INPUT_LAMPS)                         \
    IO(AFTER, TL_INPUT_VIEW) IO(SEES, shapes) IO(SEES, shift) IO(SEES, lighting)                             \
    IO(WRITES, light) IO(USES, envmap) IO(USES, light_map) IO(USES, gpu)

/* Lamps are added to the light in place, so the light is recomputed whenever they change. */
#define TL_JOB_lamp_maps(IO)                                                                                 \
    IO(READS, surfaces) IO(READS, casters) IO(READS, lamps) IO(READS, shadows)                               \
    IO(READS, light_options) IO(READS, motion) IO(WRITES, local) IO(USES, gpu)

#define TL_JOB_lamp_rays(IO)                                                                                 \
    IO(READS, samples) IO(READS, trace) IO(READS, casters) IO(READS, ground)                                 \
    IO(READS, ground_input) IO(READS, shapes) IO(READS, lamps) IO(READS, light_options)                      \
    IO(WRITES_IN, local, TL_MADE_LAMP_RAYS) IO(USES, gpu)

#define TL_JOB_lamps(IO)                                                                                     \
    IO(EXTENDS, light, TL_MADE_LAMPLIGHT) IO(READS, gbuffer) IO(READS, surfaces) IO(READS, casters)          \
    IO(READS, ground) IO(READS, ground_input) IO(READS, shift) IO(READS, camera)                             \
    IO(READS, lamps) IO(READS, light_options) IO(READS, detail_steps) IO(AFTER, TL_MADE_LAMP_MAPS)           \
    IO(AFTER, TL_MADE_LAMP_RAYS) IO(SEES, shapes) IO(SEES, round) IO(SEES, facts)                            \
    IO(USES, local) IO(USES, gpu)

#define TL_JOB_resolve(IO)                                                                                   \
    IO(READS, light) IO(READS, gbuffer) IO(READS, shift) IO(READS, size)                                     \
    IO(AFTER, TL_INPUT_RATIO) IO(AFTER, TL_INPUT_DEVICE) IO(AFTER, TL_MADE_LAMPLIGHT)                        \
    IO(WRITES, present) IO(USES, gpu)

#define TL_JOB_reference(IO)                                                                                 \
    IO(READS, environment) IO(READS, yaw) IO(READS, camera) IO(READS, size)                                  \
    IO(READS, shapes) IO(READS, motion) IO(READS, ground) IO(READS, ground_input)                            \
    IO(READS, light_options) IO(READS, lamps) IO(READS, detail_steps) IO(READS, detail_options)              \
    IO(READS, reference_options) IO(AFTER, TL_INPUT_VIEW) IO(WRITES, present) IO(WRITES, standard_error)

#define TL_JOB_backdrop(IO)                                                                                  \
    IO(READS, environment) IO(READS, pem_options) IO(READS, cube) IO(READS, filter_options)                  \
    IO(READS, ground_input) IO(WRITES_IN, present, TL_MADE_BACKDROP)

#define TL_JOB_show(IO)                                                                                      \
    IO(READS, show_options) IO(READS, yaw) IO(READS, camera) IO(AFTER, TL_MADE_IMAGE)                        \
    IO(AFTER, TL_MADE_BACKDROP) IO(SEES, environment) IO(SEES, show_part)                                    \
    IO(WRITES_IN, present, TL_MADE_SHOWN) IO(USES, gpu)
/* clang-format on */

/* ---- How lists become structs; not needed to read or to add a job ---- */

/* The meaning of a kind: EMIT(field, member, bits read, bits written); a field is CONST, MUTABLE or NONE. */
#define TL_IO_READS(EMIT, member)          EMIT(CONST, member, TL_BIT(TL_RESOURCE_OF_##member), 0)
#define TL_IO_AFTER(EMIT, bit)             EMIT(NONE, bit, TL_BIT(bit), 0)
#define TL_IO_SEES(EMIT, member)           EMIT(CONST, member, 0, 0)
#define TL_IO_WRITES(EMIT, member)         EMIT(MUTABLE, member, 0, TL_BIT(TL_RESOURCE_OF_##member))
#define TL_IO_WRITES_IN(EMIT, member, bit) EMIT(MUTABLE, member, 0, TL_BIT(bit))
#define TL_IO_EXTENDS(EMIT, member, bit)   EMIT(MUTABLE, member, TL_BIT(TL_RESOURCE_OF_##member), TL_BIT(bit))
#define TL_IO_USES(EMIT, member)           EMIT(MUTABLE, member, 0, 0)

/* A field of the struct. NOLINTBEGIN(bugprone-macro-parentheses): a name in parentheses declares nothing */
#define TL_FIELD_MUTABLE(member) __typeof__(*tl_resource_##member(NULL)) *member;
#define TL_FIELD_CONST(member)   const TL_FIELD_MUTABLE(member)
#define TL_FIELD_NONE(bit)
/* NOLINTEND(bugprone-macro-parentheses) */
#define TL_EMIT_FIELD(field, member, read, written) TL_FIELD_##field(member)
#define TL_FIELD(kind, ...)                         TL_IO_##kind(TL_EMIT_FIELD, __VA_ARGS__)

#define TL_DECLARE_JOB(name, facts, what)                                                                    \
    struct tl_##name##_job {                                                                                 \
        TL_JOB_##name(TL_FIELD)                                                                              \
    };                                                                                                       \
    bool tl_run_##name(const struct tl_##name##_job *job, tl_error *error);
TL_JOBS(TL_DECLARE_JOB)
#undef TL_DECLARE_JOB

/* The number of a job in the table: TL_JOB_NUMBER_cube is 0. */
enum tl_job_number {
#define TL_NUMBER_JOB(name, facts, what) TL_JOB_NUMBER_##name,
    TL_JOBS(TL_NUMBER_JOB) TL_JOB_COUNT
#undef TL_NUMBER_JOB
};

#endif
