#include "render/local/shading_bench.h"

#include <epoxy/gl.h>

#include <math.h>

/* Waits for all GL commands. Timer queries of software GL do not measure the time of a draw call; a fence
 * tells when it has finished. */
static void wait_for_gpu(void)
{
    const GLuint64 forever = ~(GLuint64)0 / 2; /* ns */
    GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, forever);
    glDeleteSync(fence);
}

void tl_shading_bench_create(struct tl_shading_bench *out, tl_gpu *gpu)
{
    *out = (struct tl_shading_bench){.gpu = gpu, .surfaces = tl_surfaces_create(gpu)};
}

bool tl_shading_bench_set_scene(struct tl_shading_bench *bench, const tl_surface *surface,
                                const struct tl_camera *camera, const struct tl_lamp *lamp, int width,
                                int height, tl_error *error)
{
    bench->view = tl_view_make(camera, width, height);
    bench->lamp = *lamp;
    if (!tl_casters_measure(surface, 1, &bench->casters, error) ||
        !tl_surfaces_update(bench->surfaces, &surface, 1, error))
        return false;
    const struct tl_gbuffer_request draw = {.view = &bench->view,
                                            .width = width,
                                            .height = height,
                                            .surfaces = bench->surfaces,
                                            .drawn = &surface,
                                            .surface_count = 1};
    if (!tl_gbuffer_draw(&bench->gbuffer, bench->gpu, &draw, error))
        return false;
    tl_light_buffer_begin(&bench->light, bench->gpu, &bench->gbuffer.target, true);
    tl_gpu_reset_state(bench->gpu);
    return true;
}

void tl_shading_bench_release(struct tl_shading_bench *bench)
{
    tl_local_release(&bench->local);
    tl_light_buffer_release(&bench->light);
    tl_gbuffer_release(&bench->gbuffer);
    tl_surfaces_destroy(&bench->surfaces);
}

void tl_shading_bench_clear(struct tl_shading_bench *bench)
{
    const float black[] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(bench->light.target.id, GL_COLOR, 0, black);
    wait_for_gpu();
}

bool tl_shading_bench_draw(struct tl_shading_bench *bench, const struct tl_shading_params *params,
                           tl_error *error)
{
    const struct tl_local_request request = {.gbuffer = &bench->gbuffer,
                                             .light = &bench->light.target,
                                             .view = &bench->view,
                                             .surfaces = bench->surfaces,
                                             .surface_count = 1,
                                             .casters = bench->casters,
                                             .lamps = &bench->lamp,
                                             .lamp_count = 1,
                                             .params = params,
                                             .detail = tl_detail_options.defaults,
                                             .weight = 1};
    bool drawn = tl_local_draw(&bench->local, bench->gpu, &request, error);
    wait_for_gpu();
    return drawn;
}

tl_image tl_shading_bench_read(const struct tl_shading_bench *bench)
{
    const tl_target *target = &bench->light.target;
    tl_image image = tl_image_create(target->width, target->height, 4, TL_IMAGE_F32);
    glGetTextureImage(target->colours[0].id, 0, GL_RGBA, GL_FLOAT,
                      (GLsizei)((size_t)target->width * (size_t)target->height * 4 * sizeof(float)),
                      image.texels);
    return image;
}
