/* The terms that GLSL and C share, evaluated by both from the same inputs: the same digits, but for what GLSL
 * leaves to a driver. Its powers of two and logarithms may err by some units of the last place, its sines by
 * 2^-11 [OpenGL 4.5, GLSL 4.7.1]; differences grow where a term subtracts. */
#include "render/bounce/bounced.h"
#include "render/brdf/angles.h"
#include "render/brdf/material_lobes.h"
#include "render/brdf/normalise.h"
#include "render/env/cube.h"
#include "render/env/lobes_fetch.h"
#include "render/gpu/gpu.h"
#include "render/gpu/shaders.h"
#include "render/light/terms.h"
#include "render/scene/lamp.h"
#include "render/surfaces/surface_terms.h"
#include "render/trace/spread.h"

#include <epoxy/gl.h>

#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Cosines Cosines;
typedef struct Frame Frame;

#include "render/gpu/terms_begin.h"
#define power tl_cosine_power

#include "render/brdf/models_terms.glsl"

#include "render/brdf/sample_terms.glsl"

#include "render/surfaces/ground.glsl"

#include "tests/render/gpu/one_text.glsl"

#undef power
#include "render/gpu/terms_end.h"

/* Relative to the larger of the two and 1. */
#define TOLERANCE 2e-5f
/* Lobes are counted, and places rounded, in whole numbers: a trial whose number lies on the edge of one may
 * differ. */
#define EDGES 2

extern const struct tl_embedded tl_embedded_one_text[];

static struct tl_embedded *both_lists(void)
{
    size_t count = 0, more = 0;
    while (tl_embedded_shaders[count].name)
        count++;
    while (tl_embedded_one_text[more].name)
        more++;
    struct tl_embedded *all = TL_NEW_ARRAY(struct tl_embedded, count + more + 1);
    memcpy(all, tl_embedded_shaders, count * sizeof *all);
    memcpy(all + count, tl_embedded_one_text, (more + 1) * sizeof *all);
    return all;
}

static void draw(tl_gpu *gpu, float values[ONE_TEXT_TRIALS][ONE_TEXT_NUMBERS])
{
    tl_error error = {0};
    struct tl_embedded *shaders = both_lists();
    tl_program program;
    assert_ok(tl_program_create(gpu, shaders, "fullscreen.vert", "one_text.frag", &program, &error), error);
    const unsigned format = GL_R32F;
    tl_target target = tl_target_create(gpu, ONE_TEXT_NUMBERS, ONE_TEXT_TRIALS, &format, 1, false);
    glBindFramebuffer(GL_FRAMEBUFFER, target.id);
    glViewport(0, 0, target.width, target.height);
    glUseProgram(program.id);
    tl_gpu_draw_fullscreen(gpu);
    glGetTextureImage(target.colours[0].id, 0, GL_RED, GL_FLOAT,
                      ONE_TEXT_TRIALS * ONE_TEXT_NUMBERS * (int)sizeof(float), values);
    tl_target_destroy(&target);
    tl_program_destroy(&program);
    free(shaders);
}

static void test_both_languages_agree(void **state)
{
    (void)state;
    static float drawn[ONE_TEXT_TRIALS][ONE_TEXT_NUMBERS];
    tl_error error = {0};
    tl_gpu *gpu = tl_gpu_create_headless(&error);
    assert_ok(gpu, error);
    draw(gpu, drawn);
    for (int number = 0; number < ONE_TEXT_NUMBERS; number++) {
        int edges = 0;
        float worst = 0;
        for (uint32_t trial = 0; trial < ONE_TEXT_TRIALS; trial++) {
            const float here = one_text(number, trial), there = drawn[trial][number];
            assert_true(isfinite(here) && isfinite(there));
            const float apart = fabsf(here - there) / fmaxf(fmaxf(fabsf(here), fabsf(there)), 1);
            edges += apart > TOLERANCE;
            worst = fmaxf(worst, apart);
        }
        if (edges > EDGES)
            print_error("number %d differs at %d trials, by up to %g\n", number, edges, (double)worst);
        assert_true(edges <= EDGES);
    }
    assert_int_equal(tl_gpu_message_count(gpu), 0);
    tl_gpu_destroy(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_both_languages_agree)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
