/* The thin GL floor: contexts, texture bytes, programs with includes and true lines. */
#include "render/gpu/gpu.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <epoxy/gl.h>

#include "config/colour/srgb.h"
#include "tests/testing.h"

#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

static int open_gpu(void **state)
{
    tl_error error = {0};
    *state = tl_gpu_create_headless(&error);
    if (!*state)
        print_error("%s\n", error.message);
    return *state ? 0 : -1;
}

static int close_gpu(void **state)
{
    tl_gpu *gpu = *state;
    tl_gpu_destroy(&gpu);
    tl_gpu_destroy(&gpu); /* null is fine */
    return 0;
}

static void test_headless_context(void **state)
{
    tl_gpu *gpu = *state;
    assert_non_null(strstr(tl_gpu_name(gpu), "OpenGL 4."));
    assert_true(tl_gpu_texture_side_max(gpu) >= 16384);
    assert_int_equal(tl_gpu_message_count(gpu), 0);
}

/* A GL error is a message, so that a test can demand none. */
static void test_messages_are_counted(void **state)
{
    tl_gpu *gpu = *state;
    size_t before = tl_gpu_message_count(gpu);
    glEnable(GL_TEXTURE_2D); /* not in the core profile */
    assert_int_equal(tl_gpu_message_count(gpu), before + 1);
    glGetError();
}

/* Hints of drivers are none, whatever they call their severity; what GL leaves undefined is one. */
static void test_hints_are_no_faults(void **state)
{
    tl_gpu *gpu = *state;
    size_t before = tl_gpu_message_count(gpu);
    const GLenum hints[] = {GL_DEBUG_TYPE_PERFORMANCE, GL_DEBUG_TYPE_OTHER, GL_DEBUG_TYPE_MARKER};
    const GLenum found[] = {GL_DEBUG_TYPE_ERROR, GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR, GL_DEBUG_TYPE_PORTABILITY};
    for (size_t i = 0; i < TL_COUNT(hints); i++)
        glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, hints[i], 7, GL_DEBUG_SEVERITY_HIGH, -1, "a hint");
    assert_int_equal(tl_gpu_message_count(gpu), before);
    for (size_t i = 0; i < TL_COUNT(found); i++)
        glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, found[i], 8, GL_DEBUG_SEVERITY_MEDIUM, -1,
                             "a fault");
    assert_int_equal(tl_gpu_message_count(gpu), before + TL_COUNT(found));
}

/* Each device that opens draws; one that is not there is refused. */
static void test_devices(void **state)
{
    tl_gpu *first = *state;
    struct tl_gpu_device devices[TL_GPU_DEVICES_MAX];
    tl_error error = {0};
    int count = tl_gpu_devices(devices, &error);
    assert_true(count >= 0);
    for (int i = 0; i < count; i++) {
        tl_gpu_choose(i + 1);
        tl_gpu *gpu = tl_gpu_create_headless(&error);
        assert_true((gpu != NULL) == devices[i].opens);
        if (gpu)
            assert_string_equal(tl_gpu_name(gpu), devices[i].name);
        tl_gpu_destroy(&gpu);
    }
    tl_gpu_choose(count + 1);
    assert_null(tl_gpu_create_headless(&error));
    assert_non_null(strstr(error.message, "--device: there is no device"));
    tl_gpu_choose(0);
    assert_ok(tl_gpu_bind(first, &error), error);
}

static void test_texture_bytes(void **state)
{
    tl_gpu *gpu = *state;
    assert_int_equal(tl_gpu_bytes(gpu), 0);
    tl_texture flat = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA8, 5, 3, 1, tl_texture_full_levels(5, 3));
    assert_int_equal(flat.levels, 3);
    assert_int_equal(tl_texture_bytes(&flat), 4 * (5 * 3 + 2 * 1 + 1 * 1));
    tl_texture cubes = tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP_ARRAY, GL_RGBA16F, 128, 128, 12 * 6, 8);
    /* 1 + 1/4 + ... + 4^-7 of the base level */
    assert_int_equal(tl_texture_bytes(&cubes), 12 * 6 * 8 * ((4 * 128 * 128 - 1) / 3));
    const unsigned formats[2] = {GL_RGBA32F, GL_RG32F};
    tl_target target = tl_target_create(gpu, 7, 9, formats, 2, true);
    assert_int_equal(tl_target_bytes(&target), 7 * 9 * (16 + 8 + 4));
    assert_int_equal(glCheckNamedFramebufferStatus(target.id, GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    assert_int_equal(tl_gpu_bytes(gpu),
                     tl_texture_bytes(&flat) + tl_texture_bytes(&cubes) + tl_target_bytes(&target));
    tl_texture_destroy(&flat);
    tl_texture_destroy(&cubes);
    tl_target_destroy(&target);
    assert_int_equal(tl_gpu_bytes(gpu), 0);
}

#define FILE_ENTRY(name, text)                                                                               \
    {                                                                                                        \
        name, "render/test/" name, text, sizeof(text) - 1                                                    \
    }

static const struct tl_embedded shaders[] = {
    FILE_ENTRY("plain.vert", "#version 450 core\nvoid main() { gl_Position = vec4(0); }\n"),
    FILE_ENTRY("good.frag", "#version 450 core\n#include \"one.glsl\"\n#include \"two.glsl\"\nout vec4 c;\n"
                            "void main() { c = vec4(one() + two()); }\n"),
    FILE_ENTRY("one.glsl", "float one() { return 1.0; }\n"),
    FILE_ENTRY("two.glsl", "#include \"one.glsl\"\nfloat two() { return 2.0 * one(); }\n"),
    FILE_ENTRY("after.frag",
               "#version 450 core\n#include \"two.glsl\"\nout vec4 c;\n\nvoid main() { c = wrong; }\n"),
    FILE_ENTRY("inside.frag",
               "#version 450 core\n#include \"bad.glsl\"\nout vec4 c;\nvoid main() { c = vec4(0); }\n"),
    FILE_ENTRY("bad.glsl", "// fine\n// fine\nfloat bad() { return missing; }\n"),
    FILE_ENTRY("lost.frag", "#version 450 core\n\n#include \"nowhere.glsl\"\n"),
    {0},
};

static void expect_failure(tl_gpu *gpu, const char *fragment, const char *beginning)
{
    tl_program program;
    tl_error error = {0};
    assert_false(tl_program_create(gpu, shaders, "plain.vert", fragment, &program, &error));
    if (strncmp(error.message, beginning, strlen(beginning)) != 0)
        print_error("%s\n", error.message);
    assert_int_equal(strncmp(error.message, beginning, strlen(beginning)), 0);
}

/* Includes nest, each file comes once, and a compiler's message names the right file and line. */
static void test_includes_keep_lines(void **state)
{
    tl_gpu *gpu = *state;
    tl_program program;
    tl_error error = {0};
    assert_ok(tl_program_create(gpu, shaders, "plain.vert", "good.frag", &program, &error), error);
    tl_program_destroy(&program);
    expect_failure(gpu, "after.frag", "after.frag:5");
    expect_failure(gpu, "inside.frag", "bad.glsl:3");
    expect_failure(gpu, "lost.frag", "lost.frag:3: no shader file is called nowhere.glsl");
    expect_failure(gpu, "absent.frag", "absent.frag: no shader file has this name");
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* TOILE_SHADER_DIR: a file there wins over the embedded one, and an edit is noticed. */
static void test_shaders_from_disk(void **state)
{
    tl_gpu *gpu = *state;
    tl_error error = {0};
    const char *folder = TOILE_SCRATCH_DIR "/shaders", *file = TOILE_SCRATCH_DIR "/shaders/test/one.glsl";
    assert_ok(tl_folder_make(TOILE_SCRATCH_DIR "/shaders/test", &error), error);
    write_file(file, "float one() { return 1.0; }\n");
    assert_int_equal(tl_shaders_stamp(shaders), 0);
    assert_int_equal(setenv("TOILE_SHADER_DIR", folder, 1), 0);
    uint64_t before = tl_shaders_stamp(shaders);
    tl_program program;
    assert_ok(tl_program_create(gpu, shaders, "plain.vert", "good.frag", &program, &error), error);
    unsigned id = program.id;

    write_file(file, "float one() {\n return broken; }\n");
    struct stat status;
    assert_int_equal(stat(file, &status), 0);
    struct timespec times[2] = {status.st_atim, {status.st_mtim.tv_sec + 1, 0}};
    assert_int_equal(utimensat(AT_FDCWD, file, times, 0), 0);
    assert_true(tl_shaders_stamp(shaders) != before);
    assert_false(tl_program_reload(&program, &error));
    assert_int_equal(strncmp(error.message, "one.glsl:2", 10), 0);
    assert_int_equal(program.id, id); /* the old one stays in use */

    tl_program_destroy(&program);
    unsetenv("TOILE_SHADER_DIR");
}

static int encoded(float value, int channel)
{
    return (int)lroundf(255 * (channel < 3 ? tl_srgb_from_linear(value) : value));
}

/* Mip levels of 5 x 3 texels, sides that do not halve: a column of the next level covers two and a half
 * texels, its one row all three. Averages are taken of linear light, not of bytes, and of alpha as stored. */
static void test_levels_are_means_of_light(void **state)
{
    tl_image image = tl_image_create(5, 3, 4, TL_IMAGE_U8);
    for (int i = 0; i < 5 * 3 * 4; i++)
        tl_image_bytes(&image)[i] = (uint8_t)(i * 37 % 256);
    tl_texture texture = tl_texture_create(*state, GL_TEXTURE_2D, GL_SRGB8_ALPHA8, 5, 3, 1, 3);
    tl_texture_fill(&texture, 0, &image, true);
    float means[2][4] = {{0}};
    for (int i = 0; i < 5 * 3; i++)
        for (int c = 0; c < 4; c++) {
            float byte = (float)tl_image_bytes(&image)[4 * i + c] / 255;
            float value = c < 3 ? tl_srgb_to_linear(byte) : byte;
            float left = i % 5 < 2 ? 1 : i % 5 == 2 ? 0.5f : 0;
            means[0][c] += left * value / 7.5f;
            means[1][c] += (1 - left) * value / 7.5f;
        }
    uint8_t given[5 * 3 * 4], half[2 * 4], last[4];
    glGetTextureImage(texture.id, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof given, given);
    assert_memory_equal(given, image.texels, sizeof given);
    glGetTextureImage(texture.id, 1, GL_RGBA, GL_UNSIGNED_BYTE, sizeof half, half);
    glGetTextureImage(texture.id, 2, GL_RGBA, GL_UNSIGNED_BYTE, sizeof last, last);
    for (int c = 0; c < 4; c++) {
        float both = (means[0][c] + means[1][c]) / 2;
        for (int x = 0; x < 2; x++)
            assert_in_range(half[4 * x + c] - encoded(means[x][c], c) + 1, 0, 2);
        assert_in_range(last[c] - encoded(both, c) + 1, 0, 2);
    }
    tl_texture_destroy(&texture);
    tl_image_release(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_headless_context),    cmocka_unit_test(test_messages_are_counted),
        cmocka_unit_test(test_hints_are_no_faults), cmocka_unit_test(test_devices),
        cmocka_unit_test(test_texture_bytes),       cmocka_unit_test(test_includes_keep_lines),
        cmocka_unit_test(test_shaders_from_disk),   cmocka_unit_test(test_levels_are_means_of_light),
    };
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
