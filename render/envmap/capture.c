#include "render/envmap/capture.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>

#define SAMPLES 2 /* along the side of a texel */

/* The environment is looked up in the layout that is cheapest to fetch from. */
static const struct tl_maps_params around_params = {.layout = TL_LAYOUT_OCTAHEDRAL, .mode = TL_MAPS_SURFACE};

/* The camera of a face. Rows of a GL image run upwards, as t of a face does, so that the up direction of the
 * image is the direction of increasing t and its right is that of increasing s. */
static struct tl_camera camera_of(const struct tl_capture_request *request, int face)
{
    vec3s forward = tl_cube_direction(face, 0.5f, 0.5f);
    return (struct tl_camera){.eye = request->point,
                              .target = glms_vec3_add(request->point, forward),
                              .up = glms_vec3_sub(tl_cube_direction(face, 0.5f, 1), forward),
                              .fov_y = GLM_PI_2f,
                              .near_m = request->near_m,
                              .far_m = request->far_m};
}

static bool box_holds(const tl_surface *surface, vec3s point)
{
    struct tl_box box = tl_box_of(surface->positions, surface->vertex_count);
    for (int axis = 0; axis < 3; axis++)
        if (point.raw[axis] < box.lower.raw[axis] || point.raw[axis] > box.upper.raw[axis])
            return false;
    return surface->vertex_count > 0;
}

/* Hides or shows the surfaces that contain the point. The ground is never hidden: the point may lie in its
 * plane, but not inside of it. */
static void set_hidden(const struct tl_capture_request *request, bool hidden)
{
    const struct tl_triangle_ranges *ranges = request->ranges;
    size_t count = ranges->surface_count - (request->ground ? 1 : 0);
    for (size_t i = 0; i < count; i++)
        tl_surfaces_hide(request->surfaces, i, hidden && box_holds(ranges->surfaces[i], request->point));
}

/* Lamps are shaded exactly, whatever the image's own tables and vectors are. */
static bool add_lamps(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                      const struct tl_view *view, tl_error *error)
{
    const struct tl_local_request local = {.gbuffer = &capture->gbuffer,
                                           .light = &capture->light.target,
                                           .view = view,
                                           .surfaces = request->surfaces,
                                           .surface_count = request->ranges->surface_count,
                                           .ground = request->ground,
                                           .casters = request->casters,
                                           .lamps = request->lamps,
                                           .lamp_count = request->lamp_count,
                                           .params = tl_shading_options.defaults,
                                           .weight = 1};
    return tl_local_draw(&capture->lamps, gpu, &local, error);
}

static bool light_view(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                       const struct tl_view *view, tl_error *error)
{
    const struct tl_envmap_request look_up = {.gbuffer = &capture->gbuffer.target,
                                              .exponent_levels = request->exponent_levels,
                                              .view = view,
                                              .surfaces = request->surfaces,
                                              .surface_count = request->ranges->surface_count,
                                              .params = &around_params};
    bool fine = tl_envmap_draw(&capture->around, gpu, &look_up, &capture->light, error);
    tl_gpu_reset_state(gpu);
    return fine && add_lamps(capture, gpu, request, view, error);
}

/* Averages the samples of a face over the environment. Light is premultiplied by coverage, which is stored
 * with the points of the G-buffer. */
static void average_face(const struct tl_capture_request *request, int face, const float *light,
                         const float *points, tl_cube *cube)
{
    int size = request->size, side = SAMPLES * size;
#pragma omp parallel for
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            float sum[3] = {0, 0, 0}, cover = 0;
            for (int i = 0; i < SAMPLES * SAMPLES; i++) {
                size_t sample =
                    (size_t)(SAMPLES * y + i / SAMPLES) * (size_t)side + (size_t)(SAMPLES * x + i % SAMPLES);
                cover += points[4 * sample + 3] / (SAMPLES * SAMPLES);
                for (int c = 0; c < 3; c++)
                    sum[c] += light[4 * sample + (size_t)c] / (SAMPLES * SAMPLES);
            }
            int texel = (face * size + y) * size + x;
            vec3s behind =
                tl_cube_sample(request->environment, tl_turn_direction(tl_cube_texel_direction(size, texel),
                                                                       -request->environment_yaw));
            for (int c = 0; c < 3; c++)
                cube->texels[3 * (size_t)texel + (size_t)c] = sum[c] + (1 - cover) * behind.raw[c];
        }
}

static bool draw_face(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                      int face, float *staging[2], tl_error *error)
{
    int side = SAMPLES * request->size;
    GLsizei bytes = (GLsizei)(4 * sizeof(float)) * side * side;
    struct tl_camera camera = camera_of(request, face);
    struct tl_view view = tl_view_make(&camera, side, side);
    const struct tl_gbuffer_request draw = {.view = &view,
                                            .width = side,
                                            .height = side,
                                            .surfaces = request->surfaces,
                                            .drawn = request->ranges->surfaces,
                                            .surface_count = request->ranges->surface_count,
                                            .ground = request->ground};
    if (!tl_gbuffer_draw(&capture->gbuffer, gpu, &draw, error) ||
        !light_view(capture, gpu, request, &view, error))
        return false;
    glGetTextureImage(capture->light.target.colours[0].id, 0, GL_RGBA, GL_FLOAT, bytes, staging[0]);
    glGetTextureImage(capture->gbuffer.target.colours[TL_GBUFFER_POINT].id, 0, GL_RGBA, GL_FLOAT, bytes,
                      staging[1]);
    average_face(request, face, staging[0], staging[1], &capture->cube);
    return true;
}

static bool draw_faces(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                       tl_error *error)
{
    size_t texels = (size_t)(SAMPLES * request->size) * (size_t)(SAMPLES * request->size);
    float *staging[2] = {TL_NEW_ARRAY(float, 4 * texels), TL_NEW_ARRAY(float, 4 * texels)};
    bool drawn = true;
    set_hidden(request, true);
    for (int face = 0; drawn && face < 6; face++)
        drawn = draw_face(capture, gpu, request, face, staging, error);
    set_hidden(request, false);
    free(staging[0]);
    free(staging[1]);
    return drawn;
}

bool tl_capture_draw(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                     tl_error *error)
{
    struct tl_maps_params params = around_params;
    params.size = request->size;
    tl_envmap_fill(&capture->around, gpu, &params, request->lobes, request->into_world, NULL);
    tl_envmap_set_parts(&capture->around, gpu, request->ranges, request->ground != NULL);
    tl_cube_release(&capture->cube);
    tl_lobes_release(&capture->lobes);
    capture->cube = tl_cube_create(request->size);
    if (!draw_faces(capture, gpu, request, error))
        return false;
    tl_lobes_make(&capture->lobes, &capture->cube, request->exponents);
    return true;
}

void tl_capture_release(struct tl_capture *capture)
{
    tl_gbuffer_release(&capture->gbuffer);
    tl_light_buffer_release(&capture->light);
    tl_envmap_release(&capture->around);
    tl_local_release(&capture->lamps);
    tl_cube_release(&capture->cube);
    tl_lobes_release(&capture->lobes);
}

bool tl_capture_reload(struct tl_capture *capture, tl_error *error)
{
    tl_local_reload(&capture->lamps);
    return tl_gbuffer_reload(&capture->gbuffer, error) && tl_envmap_reload(&capture->around, error);
}

size_t tl_capture_bytes(const struct tl_capture *capture)
{
    return tl_gbuffer_bytes(&capture->gbuffer) + tl_target_bytes(&capture->light.target) +
           tl_envmap_bytes(&capture->around) + tl_local_bytes(&capture->lamps) +
           tl_lobes_bytes(&capture->lobes);
}
