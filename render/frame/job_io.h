/* What each job of a frame is handed, and nothing else: a run function (run_*.c) takes the struct of its job.
 * One list a job is all three at once: the struct's fields, the bits that the plan reasons about, and the
 * wiring from the frame's resources. So a job cannot read or write what it has not declared, nor declare what
 * it is not handed.
 *
 *     READS(member)          const; a change of it is a reason to run
 *     AFTER(bit)             no field: a reason to run. What was made in place of a member that the job is
 * handed, or an input after which the light has to be begun again SEES(member)           const; no reason to
 * run: it changes only with what is read, or decides nothing WRITES(member)         what the job makes
 *     WRITES_IN(member, bit) ... of which it is a part
 *     EXTENDS(member, bit)   reads the member and makes another resource in its place
 *     USES(member)           what the job works with: caches, programs, the GPU
 *
 * ..._HANDLE hand over what a member points to, not the member. Pointers of `const` structs are as deep as
 * C's const goes. */
#ifndef TOILE_RENDER_FRAME_JOB_IO_H
#define TOILE_RENDER_FRAME_JOB_IO_H

#include "render/frame/resources.h"

#define TL_CUBE_JOB(IO)                                                                                      \
    IO(READS, environment)                                                                                   \
    IO(READS, pem_size)                                                                                      \
    IO(READS, takes_suns)                                                                                    \
    IO(WRITES, cube)                                                                                         \
    IO(WRITES, suns)                                                                                         \
    IO(USES, light_cache)                                                                                    \
    IO(USES, prepared)                                                                                       \
    IO(USES, resampling)

#define TL_REGIONS_JOB(IO)                                                                                   \
    IO(READS, cube)                                                                                          \
    IO(READS, cut)                                                                                           \
    IO(WRITES, regions)                                                                                      \
    IO(WRITES, regions_revision)                                                                             \
    IO(SEES, light_cache)

#define TL_LOBE_JOB(IO)                                                                                      \
    IO(READS, pem_size)                                                                                      \
    IO(READS, filter)                                                                                        \
    IO(WRITES, lobe_levels)                                                                                  \
    IO(USES, gpu)

#define TL_PEMS_JOB(IO)                                                                                      \
    IO(READS, cube)                                                                                          \
    IO(READS, regions)                                                                                       \
    IO(READS, filter)                                                                                        \
    IO(READS, pems_per_pass)                                                                                 \
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
    IO(SEES, cut)                                                                                            \
    IO(WRITES, lights)                                                                                       \
    IO(USES, light_cache)

#define TL_SURFACES_JOB(IO)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, motion)                                                                                        \
    IO(READS, has_ground)                                                                                    \
    IO(WRITES_HANDLE, surfaces)                                                                              \
    IO(WRITES, casters)                                                                                      \
    IO(WRITES, ground)

#define TL_DETAIL_JOB(IO)                                                                                    \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(READS, has_ground)                                                                                    \
    IO(SEES, detail_steps)                                                                                   \
    IO(WRITES, detail)                                                                                       \
    IO(USES, gpu)

#define TL_MAPS_JOB(IO)                                                                                      \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(READS, regions)                                                                                       \
    IO(READS, regions_revision)                                                                              \
    IO(READS, yaw)                                                                                           \
    IO(READS, shadow_options)                                                                                \
    IO(READS, pems_per_pass)                                                                                 \
    IO(READS, round)                                                                                         \
    IO(SEES, suns)                                                                                           \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, has_ground)                                                                                     \
    IO(SEES, ray_options)                                                                                    \
    IO(SEES, moment)                                                                                         \
    IO(WRITES_HANDLE, maps)

#define TL_BLUR_JOB(IO)                                                                                      \
    IO(EXTENDS_HANDLE, maps, TL_MADE_MAPS)                                                                   \
    IO(READS, regions)                                                                                       \
    IO(READS, regions_revision)                                                                              \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(SEES, yaw)                                                                                            \
    IO(SEES, shadow_options)                                                                                 \
    IO(SEES, pems_per_pass)                                                                                  \
    IO(SEES, round)                                                                                          \
    IO(SEES, suns)                                                                                           \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, has_ground)                                                                                     \
    IO(SEES, ray_options)                                                                                    \
    IO(SEES, moment)

#define TL_GBUFFER_JOB(IO)                                                                                   \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, ground)                                                                                        \
    IO(AFTER, TL_MADE_DETAIL)                                                                                \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, has_ground)                                                                                    \
    IO(READS, detail_steps)                                                                                  \
    IO(READS, detail_options)                                                                                \
    IO(SEES, shapes)                                                                                         \
    IO(WRITES, gbuffer)                                                                                      \
    IO(USES, gpu)

#define TL_SAMPLES_JOB(IO)                                                                                   \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, camera)                                                                                        \
    IO(READS, shapes)                                                                                        \
    IO(WRITES, samples)

#define TL_TRANSPARENCY_JOB(IO)                                                                              \
    IO(EXTENDS, samples, TL_MADE_TRANSPARENCY)                                                               \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, ground)                                                                                        \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, camera)                                                                                        \
    IO(READS, size)                                                                                          \
    IO(READS, has_ground)                                                                                    \
    IO(READS, detail_steps)                                                                                  \
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
    IO(READS, has_ground)                                                                                    \
    IO(READS, ground)                                                                                        \
    IO(WRITES, mirrors)

#define TL_POINTS_JOB(IO)                                                                                    \
    IO(READS, samples)                                                                                       \
    IO(AFTER, TL_MADE_TRANSPARENCY)                                                                          \
    IO(AFTER, TL_MADE_MIRRORS)                                                                               \
    IO(READS, regions)                                                                                       \
    IO(READS, regions_revision)                                                                              \
    IO(READS, suns)                                                                                          \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, shapes)                                                                                        \
    IO(READS, has_ground)                                                                                    \
    IO(READS, ground)                                                                                        \
    IO(READS, yaw)                                                                                           \
    IO(READS, ray_options)                                                                                   \
    IO(READS, scene_round)                                                                                   \
    IO(SEES, moment)                                                                                         \
    IO(WRITES_HANDLE, points)                                                                                \
    IO(WRITES, points_are_done)

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
    IO(READS, has_ground)                                                                                    \
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
    IO(READS, lights)                                                                                        \
    IO(READS, exact)                                                                                         \
    IO(READS, suns)                                                                                          \
    IO(READS, gbuffer)                                                                                       \
    IO(READS, shapes)                                                                                        \
    IO(READS, ground)                                                                                        \
    IO(READS, has_ground)                                                                                    \
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
    IO(READS, gbuffer)                                                                                       \
    IO(WRITES, light)                                                                                        \
    IO(WRITES, strain_range)                                                                                 \
    IO(USES, gpu)

#define TL_ENVMAP_LOBES_JOB(IO)                                                                              \
    IO(READS, environment)                                                                                   \
    IO(READS, envmap_size)                                                                                   \
    IO(READS, shapes)                                                                                        \
    IO(READS, detail_options)                                                                                \
    IO(WRITES, surroundings)                                                                                 \
    IO(USES, map_resampling)

#define TL_CAPTURE_JOB(IO)                                                                                   \
    IO(READS, capture_options)                                                                               \
    IO(SEES, surroundings)                                                                                   \
    IO(SEES, yaw)                                                                                            \
    IO(SEES, shapes)                                                                                         \
    IO(SEES, detail_options)                                                                                 \
    IO(SEES, casters)                                                                                        \
    IO(SEES, ground)                                                                                         \
    IO(SEES, has_ground)                                                                                     \
    IO(SEES, lighting)                                                                                       \
    IO(USES_HANDLE, surfaces)                                                                                \
    IO(WRITES, capture)                                                                                      \
    IO(USES, gpu)

#define TL_ENVMAP_JOB(IO)                                                                                    \
    IO(READS, surroundings)                                                                                  \
    IO(EXTENDS, capture, TL_MADE_ENVMAP)                                                                     \
    IO(READS, layout)                                                                                        \
    IO(READS, yaw)                                                                                           \
    IO(READS, shapes)                                                                                        \
    IO(READS, has_ground)                                                                                    \
    IO(SEES, envmap_size)                                                                                    \
    IO(SEES, detail_options)                                                                                 \
    IO(SEES, camera)                                                                                         \
    IO(WRITES, envmap)                                                                                       \
    IO(USES, gpu)

#define TL_LOOK_UP_JOB(IO)                                                                                   \
    IO(READS, gbuffer)                                                                                       \
    IO(AFTER, TL_MADE_ENVMAP)                                                                                \
    IO(READS, camera)                                                                                        \
    IO(READS, look_up)                                                                                       \
    IO(AFTER, TL_INPUT_LAMPS)                                                                                \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(WRITES, light)                                                                                        \
    IO(USES, envmap)                                                                                         \
    IO(SEES, lighting)                                                                                       \
    IO(USES, gpu)

#define TL_LAMP_MAPS_JOB(IO)                                                                                 \
    IO(READS_HANDLE, surfaces)                                                                               \
    IO(READS, casters)                                                                                       \
    IO(READS, lamps)                                                                                         \
    IO(READS, shadow_options)                                                                                \
    IO(READS, light_options)                                                                                 \
    IO(READS, motion)                                                                                        \
    IO(WRITES, local)                                                                                        \
    IO(USES, gpu)

#define TL_LAMP_RAYS_JOB(IO)                                                                                 \
    IO(READS, samples)                                                                                       \
    IO(READS_HANDLE, trace)                                                                                  \
    IO(READS, casters)                                                                                       \
    IO(READS, ground)                                                                                        \
    IO(READS, has_ground)                                                                                    \
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
    IO(READS, has_ground)                                                                                    \
    IO(AFTER, TL_MADE_LAMP_MAPS)                                                                             \
    IO(AFTER, TL_MADE_LAMP_RAYS)                                                                             \
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
    IO(AFTER, TL_MADE_LAMPLIGHT)                                                                             \
    IO(READS, gbuffer)                                                                                       \
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
    IO(READS, has_ground)                                                                                    \
    IO(READS, light_options)                                                                                 \
    IO(READS, lamps)                                                                                         \
    IO(READS, detail_steps)                                                                                  \
    IO(READS, detail_options)                                                                                \
    IO(READS, reference_options)                                                                             \
    IO(AFTER, TL_INPUT_VIEW)                                                                                 \
    IO(WRITES, present)                                                                                      \
    IO(WRITES, standard_error)                                                                               \
    IO(USES, gpu)

#define TL_BACKDROP_JOB(IO)                                                                                  \
    IO(READS, environment)                                                                                   \
    IO(READS, cube)                                                                                          \
    IO(READS, filter)                                                                                        \
    IO(WRITES_IN, present, TL_MADE_BACKDROP)                                                                 \
    IO(USES, gpu)

#define TL_SHOW_JOB(IO)                                                                                      \
    IO(AFTER, TL_MADE_IMAGE)                                                                                 \
    IO(AFTER, TL_MADE_BACKDROP)                                                                              \
    IO(READS, show_options)                                                                                  \
    IO(READS, yaw)                                                                                           \
    IO(READS, camera)                                                                                        \
    IO(SEES, show_target)                                                                                    \
    IO(WRITES_IN, present, TL_MADE_SHOWN)                                                                    \
    IO(USES, gpu)

/* A field. */
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

/* The job's struct and its run function. */
#define TL_DECLARE_JOB(name, LIST)                                                                           \
    struct tl_##name##_job {                                                                                 \
        LIST(TL_JOB_FIELD)                                                                                   \
    };                                                                                                       \
    bool tl_run_##name(const struct tl_##name##_job *job, tl_error *error);

TL_DECLARE_JOB(cube, TL_CUBE_JOB)
TL_DECLARE_JOB(regions, TL_REGIONS_JOB)
TL_DECLARE_JOB(lobe, TL_LOBE_JOB)
TL_DECLARE_JOB(pems, TL_PEMS_JOB)
TL_DECLARE_JOB(lobes, TL_LOBES_JOB)
TL_DECLARE_JOB(slices, TL_SLICES_JOB)
TL_DECLARE_JOB(lights, TL_LIGHTS_JOB)
TL_DECLARE_JOB(surfaces, TL_SURFACES_JOB)
TL_DECLARE_JOB(detail, TL_DETAIL_JOB)
TL_DECLARE_JOB(maps, TL_MAPS_JOB)
TL_DECLARE_JOB(blur, TL_BLUR_JOB)
TL_DECLARE_JOB(gbuffer, TL_GBUFFER_JOB)
TL_DECLARE_JOB(samples, TL_SAMPLES_JOB)
TL_DECLARE_JOB(transparency, TL_TRANSPARENCY_JOB)
TL_DECLARE_JOB(trace, TL_TRACE_JOB)
TL_DECLARE_JOB(mirrors, TL_MIRRORS_JOB)
TL_DECLARE_JOB(points, TL_POINTS_JOB)
TL_DECLARE_JOB(light, TL_LIGHT_JOB)
TL_DECLARE_JOB(compose, TL_COMPOSE_JOB)
TL_DECLARE_JOB(inspect, TL_INSPECT_JOB)
TL_DECLARE_JOB(envmap_lobes, TL_ENVMAP_LOBES_JOB)
TL_DECLARE_JOB(capture, TL_CAPTURE_JOB)
TL_DECLARE_JOB(envmap, TL_ENVMAP_JOB)
TL_DECLARE_JOB(look_up, TL_LOOK_UP_JOB)
TL_DECLARE_JOB(lamp_maps, TL_LAMP_MAPS_JOB)
TL_DECLARE_JOB(lamp_rays, TL_LAMP_RAYS_JOB)
TL_DECLARE_JOB(lamps, TL_LAMPS_JOB)
TL_DECLARE_JOB(resolve, TL_RESOLVE_JOB)
TL_DECLARE_JOB(reference, TL_REFERENCE_JOB)
TL_DECLARE_JOB(backdrop, TL_BACKDROP_JOB)
TL_DECLARE_JOB(show, TL_SHOW_JOB)

#undef TL_DECLARE_JOB

#endif
