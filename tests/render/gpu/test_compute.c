/* Compute shaders on the thin GL floor: storage buffers, dispatches, limits and times. */
#include "render/gpu/compute.h"

#include "config/base/memory.h"
#include "render/gpu/timer.h"
#include "tests/render/bindings.h"

#include <epoxy/gl.h>

#include "tests/testing.h"

#include <string.h>

static int open_gpu(void **state)
{
    tl_error error = {0};
    *state = tl_gpu_create_headless(&error);
    if (!*state)
        print_error("%s\n", error.message);
    test_bindings_watch();
    return *state ? 0 : -1;
}

static int close_gpu(void **state)
{
    tl_gpu *gpu = *state;
    const size_t messages = tl_gpu_message_count(gpu), bytes = tl_gpu_bytes(gpu),
                 bindings = test_bindings_take_faults();
    if (messages || bytes || bindings)
        print_error("%zu GL messages, %zu bytes left, %zu bindings that cannot be read\n", messages, bytes,
                    bindings);
    tl_gpu_destroy(&gpu);
    return messages || bytes || bindings ? -1 : 0;
}

#define FILE_ENTRY(name, text)                                                                               \
    {                                                                                                        \
        name, "render/test/" name, text, sizeof(text) - 1                                                    \
    }

/* Adds STEP to each number, and one to the first number of `groups`. */
static const struct tl_embedded shaders[] = {
    FILE_ENTRY("add.comp", "#version 450 core\n#include \"numbers.glsl\"\nlayout(local_size_x = 64) in;\n"
                           "layout(std430, binding = 1) restrict buffer Groups { uint groups[]; };\n"
                           "layout(location = 0) uniform uint count;\n"
                           "void main() {\n uint i = gl_GlobalInvocationID.x;\n"
                           " if (gl_LocalInvocationID.x == 0u) atomicAdd(groups[0], 1u);\n"
                           " if (i < count) numbers[i] += STEP;\n}\n"),
    FILE_ENTRY("numbers.glsl", "layout(std430, binding = 0) restrict buffer Numbers { uint numbers[]; };\n"),
    FILE_ENTRY("bad.comp", "#version 450 core\nlayout(local_size_x = 1) in;\n\nvoid main() { wrong = 1; }\n"),
    {0},
};

static void test_buffers(void **state)
{
    tl_gpu *gpu = *state;
    const size_t before = tl_gpu_bytes(gpu);
    const uint32_t given[3] = {1, 2, 3};
    uint32_t read[5] = {9, 9, 9, 9, 9};
    tl_error error = {0};
    tl_buffer buffer = {0};
    assert_ok(tl_buffer_fill(&buffer, gpu, given, sizeof given, &error), error);
    assert_int_equal(tl_gpu_bytes(gpu), before + sizeof given);
    const unsigned id = buffer.id;
    assert_ok(tl_buffer_reserve(&buffer, gpu, 4, &error), error); /* it is large enough */
    assert_int_equal(buffer.id, id);
    tl_buffer_write(&buffer, 4, &given[2], 4);
    tl_buffer_read(&buffer, 0, read, sizeof given);
    assert_memory_equal(read, ((uint32_t[]){1, 3, 3}), sizeof given);

    assert_ok(tl_buffer_reserve(&buffer, gpu, sizeof read, &error), error);
    assert_int_equal(tl_gpu_bytes(gpu), before + sizeof read);
    tl_buffer_read(&buffer, 0, read, sizeof read);
    assert_memory_equal(read, ((uint32_t[5]){0}), sizeof read);
    tl_buffer_write(&buffer, 0, given, sizeof given);
    tl_buffer_clear(&buffer);
    tl_buffer_read(&buffer, 0, read, sizeof read);
    assert_memory_equal(read, ((uint32_t[5]){0}), sizeof read);

    const size_t too_many = tl_gpu_compute_limits(gpu).storage_bytes + 1;
    assert_false(tl_buffer_reserve(&buffer, gpu, too_many, &error));
    assert_non_null(strstr(error.message, "a storage buffer of"));
    tl_buffer_destroy(&buffer);
    tl_buffer_destroy(&buffer); /* none is fine */
    assert_int_equal(tl_gpu_bytes(gpu), before);
}

/* Runs a variant in so many groups, directly or with the numbers in a buffer. */
static void run(tl_gpu *gpu, const char *defines, const tl_buffer *numbers, const tl_buffer *groups,
                uint32_t count, const tl_buffer *indirect)
{
    tl_program program;
    tl_error error = {0};
    assert_ok(tl_program_create_compute(gpu, shaders, "add.comp", defines, &program, &error), error);
    assert_ok(tl_program_reload(&program, &error), error);
    glUseProgram(program.id);
    glUniform1ui(0, count);
    tl_buffer_bind(numbers, 0);
    tl_buffer_bind(groups, 1);
    if (indirect)
        tl_gpu_dispatch_indirect(indirect, 4);
    else
        tl_gpu_dispatch(tl_gpu_groups(count, 64), 1, 1);
    tl_gpu_barrier();
    tl_program_destroy(&program);
}

static void test_dispatches(void **state)
{
    enum { COUNT = 200 };
    tl_gpu *gpu = *state;
    tl_error error = {0};
    tl_buffer numbers = {0}, groups = {0}, indirect = {0};
    uint32_t read[COUNT], group_count, given[4] = {99, 2, 1, 1};
    for (uint32_t i = 0; i < COUNT; i++)
        read[i] = i;
    assert_ok(tl_buffer_fill(&numbers, gpu, read, sizeof read, &error), error);
    assert_ok(tl_buffer_reserve(&groups, gpu, 4, &error), error);
    assert_ok(tl_buffer_fill(&indirect, gpu, given, sizeof given, &error), error);
    run(gpu, "#define STEP 1000u\n", &numbers, &groups, COUNT, NULL);   /* four groups: all of them */
    run(gpu, "#define STEP 7u\n", &numbers, &groups, COUNT, &indirect); /* two groups: 128 */
    run(gpu, "#define STEP 50u\n", &numbers, &groups, 0, NULL);         /* none */
    tl_buffer_read(&numbers, 0, read, sizeof read);
    tl_buffer_read(&groups, 0, &group_count, sizeof group_count);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(read[i], i + 1000 + (i < 128 ? 7 : 0));
    assert_int_equal(group_count, 6);
    tl_buffer_destroy(&numbers);
    tl_buffer_destroy(&groups);
    tl_buffer_destroy(&indirect);
}

/* In a context of its own: GL reports the error as a message, too. */
static void test_program_errors(void **state)
{
    tl_program program;
    tl_error error = {0};
    tl_gpu *gpu = tl_gpu_create_headless(&error);
    assert_non_null(gpu);
    assert_false(tl_program_create_compute(gpu, shaders, "bad.comp", NULL, &program, &error));
    assert_int_equal(strncmp(error.message, "bad.comp:4", 10), 0);
    assert_int_equal(program.id, 0);
    tl_gpu_destroy(&gpu);
    assert_ok(tl_gpu_bind(*state, &error), error);
}

/* The watch of bindings names a dispatch whose storage block has no buffer. */
static void test_unbound_storage_is_named(void **state)
{
    tl_program program;
    tl_error error = {0};
    tl_buffer buffer = {0};
    assert_ok(tl_buffer_reserve(&buffer, *state, 4, &error), error);
    assert_ok(tl_program_create_compute(*state, shaders, "add.comp", "#define STEP 1u\n", &program, &error),
              error);
    glUseProgram(program.id);
    glUniform1ui(0, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, 0);
    tl_buffer_bind(&buffer, 1);
    tl_gpu_dispatch(1, 1, 1);
    assert_int_equal(test_bindings_take_faults(), 1);
    tl_program_destroy(&program);
    tl_buffer_destroy(&buffer);
}

static void test_limits(void **state)
{
    const struct tl_compute_limits here = tl_gpu_compute_limits(*state);
    tl_error error = {0};
    assert_ok(tl_compute_limits_check(&here, &error), error);
    struct tl_compute_limits few = here;
    few.buffers = 8; /* the minimum that GL demands */
    assert_false(tl_compute_limits_check(&few, &error));
    assert_non_null(strstr(error.message, "storage buffers of a program: compute shaders have 8 here"));
    few = here;
    few.shared_bytes = TL_GROUP_SHARED_BYTES - 1;
    assert_false(tl_compute_limits_check(&few, &error));
    assert_non_null(strstr(error.message, "shared memory"));
}

/* Frames come out in their order, each with its marks; those that nobody takes go, the oldest first. */
static void expect_order(bool waits)
{
    tl_timer *timer = tl_timer_create(waits);
    struct tl_timer_times times;
    assert_false(tl_timer_take(timer, &times));
    for (uint64_t frame = 10; frame < 16; frame++) {
        tl_timer_begin(timer, frame);
        for (int mark = 0; mark <= (int)frame % 2; mark++)
            tl_timer_mark(timer, 5 * mark);
    }
    glFinish();
    for (uint64_t frame = 12; frame < 16; frame++) {
        assert_true(tl_timer_take(timer, &times));
        assert_int_equal(times.frame, frame);
        assert_int_equal(times.count, 1 + frame % 2);
        assert_int_equal(times.marks[frame % 2].part, 5 * (frame % 2));
        assert_true(times.marks[0].ms >= 0);
    }
    assert_false(tl_timer_take(timer, &times));
    tl_timer_destroy(&timer);
    tl_timer_destroy(&timer); /* null is fine */
}

static void test_timers(void **state)
{
    (void)state;
    expect_order(true);
    expect_order(false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_buffers),        cmocka_unit_test(test_dispatches),
        cmocka_unit_test(test_program_errors), cmocka_unit_test(test_unbound_storage_is_named),
        cmocka_unit_test(test_limits),         cmocka_unit_test(test_timers),
    };
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
