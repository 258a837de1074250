/* clang-format off: the table below keeps its lines */
/* The inputs and outputs of each job of a frame. A run function (run_*.c) takes the struct of its job and
 * sees nothing else of the frame.
 *
 * One list for each job yields three things: the fields of the struct, the bits that the plan reasons about,
 * and the wiring from the frame's resources to the fields. A job can therefore neither read nor write a
 * resource that it does not declare.
 *
 *     READS(member)            const field; a change of the member is a reason to run
 *     AFTER(bit)               no field, but a reason to run: a resource that replaces a member of the job,
 *                              or an input after which the light starts again
 *     SEES(member)             const field, no reason to run: it changes only together with a member that
 *                              is read, or does not decide the result
 *     WRITES(member)           the job makes this resource
 *     WRITES_IN(member, bit)   the job makes resource `bit`, which is a part of the member
 *     EXTENDS(member, bit)     the job reads the member and turns it into resource `bit` in place
 *     USES(member)             caches, programs, the GPU: they decide the job's speed, never its result
 *
 * The kinds ..._HANDLE pass the pointer that a member holds instead of the member's address. `const` reaches
 * as deep as C lets it: not through pointers inside of a struct. tests/render/frame/test_jobs.c checks all
 * three. */
/* clang-format on */
#ifndef TOILE_RENDER_FRAME_JOB_IO_H
#define TOILE_RENDER_FRAME_JOB_IO_H

#include "render/frame/resources.h"

#define TL_CUBE_JOB(IO)                                                                                      \
    IO(READS, environment)                                                                                   \
    IO(READS, pem_options)                                                                                      \
    IO(READS, sun_options)                                                                                    \
    IO(WRITES, cube)                                                                                         \
    IO(WRITES, suns)                                                                                         \
    IO(USES, light_cache)                                                                                    \
    IO(USES, prepared)                                                                                       \
    IO(USES, resampling)

#define TL_REGIONS_JOB(IO)                                                                                   \
    IO(READS, cube)                                                                                          \
    IO(READS, cut_options)                                                                                           \
    IO(WRITES, regions)                                                                                      \
    IO(WRITES, regions_revision)                                                                             \
    IO(SEES, light_cache)

#define TL_LOBE_JOB(IO)                                                                                      \
    IO(READS, pem_options)                                                                                      \
    IO(READS, filter_options)                                                                                        \
    IO(WRITES, lobe_levels)                                                                                  \
    IO(USES, gpu)

#define TL_PEMS_JOB(IO)                                                                                      \
    IO(READS, cube)                                                                                          \
    IO(READS, regions)                                                                                       \
    IO(READS, filter_options)                                                                                        \
    IO(READS, storage_options)                                                                                   \
    IO(WRITES, pems)                                                                                         \
    IO(USES, gpu)

#define TL_LOBES_JOB(IO)                                                                                     \
    IO(READS, cube)                                                                                          \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(WRITES, exact)                                                                                        \
    IO(USES, light_cache)                                                                                    \
    IO(USES, gpu)

#define TL_SLICES_JOB(IO)                                                                                    \
    IO(READS, cube)                                                                                          \
    IO(READS, regions)                                                                                       \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(WRITES, slices)                                                                                       \
    IO(USES, gpu)

#define TL_LIGHTS_JOB(IO)                                                                                    \
    IO(READS, regions)                                                                                       \
    IO(READS, exact)                                                                                         \
    IO(READS, light_options)                                                                                 \
    IO(SEES, cut_options)                                                                                            \
    IO(WRITES, lights)                                                                                       \
    IO(USES, light_cache)

#define TL_SURFACES_JOB(IO)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, motion)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(WRITES_HANDLE, surfaces)                                                                              \
    IO(WRITES, casters)                                                                                      \
    IO(WRITES, ground)

#define TL_DETAIL_JOB(IO)                                                                                    \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(READS, ground_input)                                                                                  \
    IO(SEES, detail_steps)                                                                                   \
    IO(WRITES, detail)                                                                                       \
    IO(USES, gpu)

#define TL_MAPS_JOB(IO)                                                                                      \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(READS, regions)                                                                                       \
    IO(READS, regions_revision)                                                                              \
    IO(READS, yaw)                                                                                           \
    IO(READS, shadows)                                                                                \
    IO(READS, storage_options)                                                                                   \
    IO(READS, round)                                                                                         \
    IO(SEES, suns)                                                                                           \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, ground_input)                                                                                   \
    IO(SEES, rays)                                                                                    \
    IO(SEES, motion_state)                                                                                         \
    IO(WRITES_HANDLE, maps)

#define TL_BLUR_JOB(IO)                                                                                      \
    IO(EXTENDS_HANDLE, maps, TL_MADE_MAPS)                                                                   \
    IO(READS, regions)                                                                                       \
    IO(READS, regions_revision)                                                                              \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(SEES, yaw)                                                                                            \
    IO(SEES, shadows)                                                                                 \
    IO(SEES, storage_options)                                                                                    \
    IO(SEES, round)                                                                                          \
    IO(SEES, suns)                                                                                           \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, ground_input)                                                                                   \
    IO(SEES, rays)                                                                                    \
    IO(SEES, motion_state)

#define TL_GBUFFER_JOB(IO)                                                                                   \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, ground)                                                                                        \
    IO(AFTER, TL_MADE_DETAIL)                                                                                \
    IO(READS, shift)                                                                                         \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, ground_input)                                                                                  \
    IO(READS, detail_steps)                                                                                  \
    IO(READS, detail_options)                                                                                \
    IO(READS, lobes_input)                                                                                   \
    IO(SEES, shapes)                                                                                         \
    IO(WRITES, gbuffer)                                                                                      \
    IO(USES, gpu)

#define TL_SAMPLES_JOB(IO)                                                                                   \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, camera)                                                                                        \
    IO(READS, shapes)                                                                                        \
    IO(WRITES, samples)

#define TL_IDS_JOB(IO)                                                                                       \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, ground)                                                                                        \
    IO(READS, shift)                                                                                         \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, ground_input)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(WRITES, ids)                                                                                          \
    IO(WRITES, pixel_ids)                                                                                    \
    IO(USES, gpu)

#define TL_SHADE_MATERIALS_JOB(IO)                                                                           \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(READS, ground_input)                                                                                  \
    IO(READS, light_options)                                                                                 \
    IO(WRITES, shade_materials)

#define TL_TRANSPARENCY_JOB(IO)                                                                              \
    IO(EXTENDS, samples, TL_MADE_TRANSPARENCY)                                                               \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, ground)                                                                                        \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, shift)                                                                                         \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, ground_input)                                                                                  \
    IO(READS, detail_steps)                                                                                  \
    IO(READS, lobes_input)                                                                                   \
    IO(READS, shapes)                                                                                        \
    IO(WRITES, transparency)                                                                                 \
    IO(USES, gpu)

#define TL_TRACE_JOB(IO)                                                                                     \
    IO(READS, shapes)                                                                                        \
    IO(READS, motion)                                                                                        \
    IO(WRITES_HANDLE, trace)

#define TL_MIRRORS_JOB(IO)                                                                                   \
    IO(EXTENDS, samples, TL_MADE_MIRRORS)                                                                    \
    IO(AFTER, TL_MADE_TRANSPARENCY)                                                                          \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, ground)                                                                                        \
    IO(WRITES, mirrors)

#define TL_POINTS_JOB(IO)                                                                                    \
    IO(READS, samples)                                                                                       \
    IO(READS, ids)                                                                                           \
    IO(AFTER, TL_MADE_TRANSPARENCY)                                                                          \
    IO(AFTER, TL_MADE_MIRRORS)                                                                               \
    IO(READS, regions)                                                                                       \
    IO(READS, regions_revision)                                                                              \
    IO(READS, suns)                                                                                          \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, ground)                                                                                        \
    IO(READS, yaw)                                                                                           \
    IO(READS, rays)                                                                                   \
    IO(READS, scene_round)                                                                                   \
    IO(SEES, round)                                                                                          \
    IO(SEES, motion_state)                                                                                         \
    IO(SEES, facts)                                                                                          \
    IO(WRITES_HANDLE, points)                                                                                \
    IO(WRITES, points_are_done)

#define TL_BOUNCE_JOB(IO)                                                                                    \
    IO(READS, samples)                                                                                       \
    IO(READS, ids)                                                                                           \
    IO(AFTER, TL_MADE_TRANSPARENCY)                                                                          \
    IO(READS, cube)                                                                                          \
    IO(READS, suns)                                                                                          \
    IO(READS, lamps)                                                                                         \
    IO(READS, exact)                                                                                         \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, ground)                                                                                        \
    IO(READS, yaw)                                                                                           \
    IO(READS, light_options)                                                                                 \
    IO(READS, scene_round)                                                                                   \
    IO(SEES, environment)                                                                                    \
    IO(SEES, motion_state)                                                                                         \
    IO(SEES, facts)                                                                                          \
    IO(WRITES, bounce)

#define TL_RATIOS_JOB(IO)                                                                                    \
    IO(READS, ids)                                                                                           \
    IO(READS, shade_materials)                                                                               \
    IO(READS_HANDLE, points)                                                                                 \
    IO(READS, bounce)                                                                                        \
    IO(SEES, facts)                                                                                          \
    IO(READS, lights)                                                                                        \
    IO(READS, regions)                                                                                       \
    IO(SEES, regions_revision)                                                                               \
    IO(SEES, environment)                                                                                    \
    IO(READS, exact)                                                                                         \
    IO(READS, yaw)                                                                                           \
    IO(READS, camera)                                                                                        \
    IO(READS, shapes)                                                                                        \
    IO(READS, light_options)                                                                                 \
    IO(WRITES, ratios)

#define TL_SUN_PIXELS_JOB(IO)                                                                                \
    IO(READS, ids)                                                                                           \
    IO(READS, shade_materials)                                                                               \
    IO(READS, suns)                                                                                          \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, yaw)                                                                                           \
    IO(READS, shift)                                                                                         \
    IO(READS, camera)                                                                                        \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(WRITES, pixel_triangles)                                                                              \
    IO(WRITES, sun_pixels)

#define TL_SHADE_JOB(IO)                                                                                     \
    IO(READS, ids)                                                                                           \
    IO(READS, pixel_ids)                                                                                     \
    IO(READS, ratios)                                                                                        \
    IO(READS, pixel_triangles)                                                                               \
    IO(SEES_HANDLE, trace)                                                                                   \
    IO(READS, sun_pixels)                                                                                    \
    IO(READS, shade_materials)                                                                               \
    IO(READS, exact)                                                                                         \
    IO(READS, suns)                                                                                          \
    IO(READS, yaw)                                                                                           \
    IO(READS, shift)                                                                                         \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(AFTER, TL_INPUT_RATIO)                                                                                \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(WRITES, present)

#define TL_LIGHT_JOB(IO)                                                                                     \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, pems)                                                                                          \
    IO(READS, slices)                                                                                        \
    IO(READS, regions)                                                                                       \
    IO(READS, suns)                                                                                          \
    IO(READS, lobe_levels)                                                                                   \
    IO(READS, exact)                                                                                         \
    IO(READS_HANDLE, maps)                                                                                   \
    IO(AFTER, TL_MADE_MAPS)                                                                                  \
    IO(READS, casters)                                                                                       \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, yaw)                                                                                           \
    IO(READS, camera)                                                                                        \
    IO(READS, round)                                                                                         \
    IO(READS, light_options)                                                                                 \
    IO(AFTER, TL_INPUT_LAMPS)                                                                                \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(WRITES, light)                                                                                        \
    IO(USES, lighting)                                                                                       \
    IO(USES, gpu)

#define TL_COMPOSE_JOB(IO)                                                                                   \
    IO(READS, samples)                                                                                       \
    IO(READS, transparency)                                                                                  \
    IO(READS, mirrors)                                                                                       \
    IO(READS_HANDLE, points)                                                                                 \
    IO(READS, bounce)                                                                                        \
    IO(READS, lights)                                                                                        \
    IO(READS, exact)                                                                                         \
    IO(READS, suns)                                                                                          \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, yaw)                                                                                           \
    IO(READS, light_options)                                                                                 \
    IO(READS, camera)                                                                                        \
    IO(READS, lamps)                                                                                         \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(SEES, environment)                                                                                    \
    IO(SEES_HANDLE, trace)                                                                                   \
    IO(SEES, facts)                                                                                          \
    IO(WRITES, light)                                                                                        \
    IO(USES, gpu)

#define TL_INSPECT_JOB(IO)                                                                                   \
    IO(READS, samples)                                                                                       \
    IO(READS_HANDLE, points)                                                                                 \
    IO(READS, regions)                                                                                       \
    IO(READS, shapes)                                                                                        \
    IO(READS, motion)                                                                                        \
    IO(READS, yaw)                                                                                           \
    IO(READS, camera)                                                                                        \
    IO(READS, view_options)                                                                                  \
    IO(WRITES, light)                                                                                        \
    IO(WRITES, strain_range)

#define TL_ENVMAP_LOBES_JOB(IO)                                                                              \
    IO(READS, environment)                                                                                   \
    IO(READS, envmap_input)                                                                                   \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(WRITES, envmap_source)                                                                                 \
    IO(USES, map_resampling)

#define TL_CAPTURE_JOB(IO)                                                                                   \
    IO(READS, capture_options)                                                                               \
    IO(SEES, envmap_source)                                                                                   \
    IO(SEES, yaw)                                                                                            \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, detail_options)                                                                                 \
    IO(SEES, casters)                                                                                        \
    IO(SEES, ground)                                                                                         \
    IO(SEES, ground_input)                                                                                   \
    IO(SEES, lamps)                                                                                          \
    IO(SEES, lighting)                                                                                       \
    IO(USES_HANDLE, surfaces)                                                                                \
    IO(WRITES, capture)                                                                                      \
    IO(USES, gpu)

#define TL_ENVMAP_JOB(IO)                                                                                    \
    IO(READS, envmap_source)                                                                                  \
    IO(EXTENDS, capture, TL_MADE_ENVMAP)                                                                     \
    IO(READS, layout_options)                                                                                        \
    IO(READS, yaw)                                                                                           \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(SEES, envmap_input)                                                                                    \
    IO(SEES, detail_options)                                                                                 \
    IO(SEES, camera)                                                                                         \
    IO(WRITES, envmap)                                                                                       \
    IO(USES, gpu)

#define TL_LIGHT_MAP_JOB(IO)                                                                                 \
    IO(READS, environment)                                                                                   \
    IO(READS, yaw)                                                                                           \
    IO(READS, shapes)                                                                                        \
    IO(READS, motion)                                                                                        \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, reference_options)                                                                             \
    IO(READS, detail_steps)                                                                                  \
    IO(READS, envmap_input)                                                                                   \
    IO(WRITES, light_map)                                                                                    \
    IO(USES, gpu)

#define TL_LOOK_UP_JOB(IO)                                                                                   \
    IO(READS, gbuffer)                                                                                       \
    IO(AFTER, TL_MADE_ENVMAP)                                                                                \
    IO(AFTER, TL_MADE_LIGHT_MAP)                                                                             \
    IO(READS, camera)                                                                                        \
    IO(READS, look_up_options)                                                                                       \
    IO(AFTER, TL_INPUT_LAMPS)                                                                                \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(WRITES, light)                                                                                        \
    IO(USES, envmap)                                                                                         \
    IO(USES, light_map)                                                                                      \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, shift)                                                                                          \
    IO(SEES, lighting)                                                                                       \
    IO(USES, gpu)

#define TL_LAMP_MAPS_JOB(IO)                                                                                 \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(READS, lamps)                                                                                         \
    IO(READS, shadows)                                                                                \
    IO(READS, light_options)                                                                                 \
    IO(READS, motion)                                                                                        \
    IO(WRITES, local)                                                                                        \
    IO(USES, gpu)

#define TL_LAMP_RAYS_JOB(IO)                                                                                 \
    IO(READS, samples)                                                                                       \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, casters)                                                                                       \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, lamps)                                                                                         \
    IO(READS, light_options)                                                                                 \
    IO(WRITES_IN, local, TL_MADE_LAMP_RAYS)                                                                  \
    IO(USES, gpu)

#define TL_LAMPS_JOB(IO)                                                                                     \
    IO(EXTENDS, light, TL_MADE_LAMPLIGHT)                                                                    \
    IO(READS, gbuffer)                                                                                       \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(AFTER, TL_MADE_LAMP_MAPS)                                                                             \
    IO(AFTER, TL_MADE_LAMP_RAYS)                                                                             \
    IO(READS, shift)                                                                                         \
    IO(READS, camera)                                                                                        \
    IO(READS, lamps)                                                                                         \
    IO(READS, light_options)                                                                                 \
    IO(READS, detail_steps)                                                                                  \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, round)                                                                                          \
    IO(SEES, facts)                                                                                          \
    IO(USES, local)                                                                                          \
    IO(USES, gpu)

#define TL_RESOLVE_JOB(IO)                                                                                   \
    IO(READS, light)                                                                                         \
    IO(AFTER, TL_INPUT_RATIO)                                                                                \
    IO(AFTER, TL_MADE_LAMPLIGHT)                                                                             \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, shift)                                                                                         \
    IO(READS, size)                                                                                          \
    IO(WRITES, present)                                                                                      \
    IO(USES, gpu)

#define TL_REFERENCE_JOB(IO)                                                                                 \
    IO(READS, environment)                                                                                   \
    IO(READS, yaw)                                                                                           \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, shapes)                                                                                        \
    IO(READS, motion)                                                                                        \
    IO(READS, ground)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(READS, light_options)                                                                                 \
    IO(READS, lamps)                                                                                         \
    IO(READS, detail_steps)                                                                                  \
    IO(READS, detail_options)                                                                                \
    IO(READS, reference_options)                                                                             \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(WRITES, present)                                                                                      \
    IO(WRITES, standard_error)

#define TL_BACKDROP_JOB(IO)                                                                                  \
    IO(READS, environment)                                                                                   \
    IO(READS, pem_options)                                                                                      \
    IO(READS, cube)                                                                                          \
    IO(READS, filter_options)                                                                                        \
    IO(READS, ground_input)                                                                                  \
    IO(WRITES_IN, present, TL_MADE_BACKDROP)

#define TL_SHOW_JOB(IO)                                                                                      \
    IO(AFTER, TL_MADE_IMAGE)                                                                                 \
    IO(AFTER, TL_MADE_BACKDROP)                                                                              \
    IO(READS, show_options)                                                                                  \
    IO(READS, yaw)                                                                                           \
    IO(READS, camera)                                                                                        \
    IO(SEES, environment)                                                                                    \
    IO(SEES, show_part)                                                                                      \
    IO(WRITES_IN, present, TL_MADE_SHOWN)                                                                    \
    IO(USES, gpu)

/* All jobs: JOB(name, list), in the order of the lists above. */
#define TL_JOBS(JOB)                                                                                         \
    JOB(cube, TL_CUBE_JOB)                                                                                   \
    JOB(regions, TL_REGIONS_JOB)                                                                             \
    JOB(lobe, TL_LOBE_JOB)                                                                                   \
    JOB(pems, TL_PEMS_JOB)                                                                                   \
    JOB(lobes, TL_LOBES_JOB)                                                                                 \
    JOB(slices, TL_SLICES_JOB)                                                                               \
    JOB(lights, TL_LIGHTS_JOB)                                                                               \
    JOB(surfaces, TL_SURFACES_JOB)                                                                           \
    JOB(detail, TL_DETAIL_JOB)                                                                               \
    JOB(maps, TL_MAPS_JOB)                                                                                   \
    JOB(blur, TL_BLUR_JOB)                                                                                   \
    JOB(gbuffer, TL_GBUFFER_JOB)                                                                             \
    JOB(ids, TL_IDS_JOB)                                                                                     \
    JOB(shade_materials, TL_SHADE_MATERIALS_JOB)                                                             \
    JOB(samples, TL_SAMPLES_JOB)                                                                             \
    JOB(transparency, TL_TRANSPARENCY_JOB)                                                                   \
    JOB(trace, TL_TRACE_JOB)                                                                                 \
    JOB(mirrors, TL_MIRRORS_JOB)                                                                             \
    JOB(points, TL_POINTS_JOB)                                                                               \
    JOB(bounce, TL_BOUNCE_JOB)                                                                               \
    JOB(ratios, TL_RATIOS_JOB)                                                                               \
    JOB(sun_pixels, TL_SUN_PIXELS_JOB)                                                                       \
    JOB(shade, TL_SHADE_JOB)                                                                                 \
    JOB(light, TL_LIGHT_JOB)                                                                                 \
    JOB(compose, TL_COMPOSE_JOB)                                                                             \
    JOB(inspect, TL_INSPECT_JOB)                                                                             \
    JOB(envmap_lobes, TL_ENVMAP_LOBES_JOB)                                                                   \
    JOB(capture, TL_CAPTURE_JOB)                                                                             \
    JOB(envmap, TL_ENVMAP_JOB)                                                                               \
    JOB(light_map, TL_LIGHT_MAP_JOB)                                                                         \
    JOB(look_up, TL_LOOK_UP_JOB)                                                                             \
    JOB(lamp_maps, TL_LAMP_MAPS_JOB)                                                                         \
    JOB(lamp_rays, TL_LAMP_RAYS_JOB)                                                                         \
    JOB(lamps, TL_LAMPS_JOB)                                                                                 \
    JOB(resolve, TL_RESOLVE_JOB)                                                                             \
    JOB(reference, TL_REFERENCE_JOB)                                                                         \
    JOB(backdrop, TL_BACKDROP_JOB)                                                                           \
    JOB(show, TL_SHOW_JOB)

/* A field of the struct, for each kind. The argument is the name that a declaration gives, and a name in
 * parentheses is not one: NOLINTBEGIN(bugprone-macro-parentheses) */
#define TL_TYPE_OF(member)            __typeof__(((struct tl_resources *)0)->member)
#define TL_TYPE_AT(member)            __typeof__(*((struct tl_resources *)0)->member)
#define TL_FIELD_READS(member)        const TL_TYPE_OF(member) * member;
#define TL_FIELD_READS_HANDLE(member) const TL_TYPE_AT(member) * member;
#define TL_FIELD_AFTER(bit)
#define TL_FIELD_SEES(member)                TL_FIELD_READS(member)
#define TL_FIELD_SEES_HANDLE(member)         TL_FIELD_READS_HANDLE(member)
#define TL_FIELD_WRITES(member)              TL_TYPE_OF(member) * member;
#define TL_FIELD_WRITES_HANDLE(member)       TL_TYPE_AT(member) * member;
#define TL_FIELD_WRITES_IN(member, bit)      TL_FIELD_WRITES(member)
#define TL_FIELD_EXTENDS(member, bit)        TL_FIELD_WRITES(member)
#define TL_FIELD_EXTENDS_HANDLE(member, bit) TL_FIELD_WRITES_HANDLE(member)
#define TL_FIELD_USES(member)                TL_FIELD_WRITES(member)
#define TL_FIELD_USES_HANDLE(member)         TL_FIELD_WRITES_HANDLE(member)
#define TL_JOB_FIELD(kind, ...)              TL_FIELD_##kind(__VA_ARGS__)
/* NOLINTEND(bugprone-macro-parentheses) */

/* The job's struct and its run function. */
#define TL_DECLARE_JOB(name, LIST)                                                                           \
    struct tl_##name##_job {                                                                                 \
        LIST(TL_JOB_FIELD)                                                                                   \
    };                                                                                                       \
    bool tl_run_##name(const struct tl_##name##_job *job, tl_error *error);

TL_JOBS(TL_DECLARE_JOB)

#undef TL_DECLARE_JOB

#endif
