#include "render/gpu/clocks.h"

#include "config/base/log.h"
#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#include <math.h>

#define SIDE        512 /* samples */
#define PASSES      8
#define AGREE       0.25 /* relative */
#define SIDE_FACTOR 2    /* samples a pixel side, summed up by resolve.frag */

static void work(tl_gpu *gpu, const tl_program *program, const tl_texture *from, const tl_target *to,
                 int passes)
{
    glBindFramebuffer(GL_FRAMEBUFFER, to->id);
    glViewport(0, 0, to->width, to->height);
    glUseProgram(program->id);
    glUniform1i(0, SIDE_FACTOR);
    glBindTextureUnit(0, from->id);
    glBindTextureUnit(1, from->id);
    for (int i = 0; i < passes; i++)
        tl_gpu_draw_fullscreen(gpu);
}

static bool measure(tl_gpu *gpu, const tl_program *program, const tl_texture *from, const tl_target *to,
                    int passes, struct tl_gpu_clocks *out)
{
    GLuint query;
    GLuint64 nanoseconds = 0;
    glGenQueries(1, &query);
    glFinish();
    double started_s = tl_clock_s();
    glBeginQuery(GL_TIME_ELAPSED, query);
    work(gpu, program, from, to, passes);
    glEndQuery(GL_TIME_ELAPSED);
    glFinish();
    out->cpu_ms = 1000 * (tl_clock_s() - started_s);
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    glDeleteQueries(1, &query);
    out->timer_ms = 1e-6 * (double)nanoseconds;
    return fabs(out->timer_ms - out->cpu_ms) <= AGREE * out->cpu_ms;
}

bool tl_gpu_compare_clocks(tl_gpu *gpu, struct tl_gpu_clocks *out, tl_error *error)
{
    const unsigned format = GL_RGBA32F;
    const float grey[] = {0.5f, 0.5f, 0.5f, 1};
    tl_program program = {0};
    if (!tl_program_create(gpu, tl_embedded_shaders, "fullscreen.vert", "resolve.frag", &program, error))
        return false;
    tl_texture from = tl_texture_create(gpu, GL_TEXTURE_2D, format, SIDE, SIDE, 1, 1);
    tl_target to = tl_target_create(gpu, SIDE / SIDE_FACTOR, SIDE / SIDE_FACTOR, &format, 1, false);
    glClearTexImage(from.id, 0, GL_RGBA, GL_FLOAT, grey);
    tl_gpu_reset_state(gpu);
    work(gpu, &program, &from, &to, 1); /* the first one compiles */
    bool part_agrees = measure(gpu, &program, &from, &to, PASSES / 4, out);
    out->timer_is_trusted = measure(gpu, &program, &from, &to, PASSES, out) && part_agrees;
    tl_gpu_reset_state(gpu);
    tl_target_destroy(&to);
    tl_texture_destroy(&from);
    tl_program_destroy(&program);
    return true;
}
