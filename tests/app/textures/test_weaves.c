/* Weaves are shared while their options and files are the same, and only then; what nobody uses stays within
 * its bound. */
#include "tests/testing.h"

#include "app/textures/weaves.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <fcntl.h>
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>

static struct tl_weave_params plain(void)
{
    return *(const struct tl_weave_params *)tl_weave_options.defaults;
}

static const struct tl_fabric_pictures *take(const struct tl_weave_params *params)
{
    const struct tl_fabric_pictures *weave;
    tl_error error;
    assert_ok(tl_weaves_take(params, &weave, &error), error);
    return weave;
}

static void equal_options_share_a_weave(void **state)
{
    (void)state;
    struct tl_weave_params params = plain(), other = plain();
    other.warp_pitch_mm = 0.5f;
    const struct tl_fabric_pictures *a = take(&params), *b = take(&params), *c = take(&other);
    assert_ptr_equal(a, b);
    assert_ptr_not_equal(a, c);
    assert_int_equal(tl_weaves_unused_bytes(), 0);
    tl_weaves_give(a);
    assert_int_equal(tl_weaves_unused_bytes(), 0);
    assert_true(b->weave.size_m[0] < c->weave.size_m[0]); /* is still there */
    tl_weaves_give(b);
    assert_ptr_equal(take(&params), a); /* was kept */
    tl_weaves_give(a);
    tl_weaves_give(c);
    params.pattern = TL_WEAVE_NONE;
    assert_null(take(&params));
    tl_weaves_give(NULL);
}

static void save(const char *path, uint8_t red, int side)
{
    tl_image picture = tl_image_create(side, side, 3, TL_IMAGE_U8);
    tl_error error;
    for (size_t i = 0; i < (size_t)side * (size_t)side; i++)
        tl_image_bytes(&picture)[3 * i] = red;
    assert_ok(tl_image_save_png(path, &picture, &error), error);
    tl_image_release(&picture);
}

/* The red of its first texel. */
static double red_of(const struct tl_weave_params *params)
{
    const struct tl_fabric_pictures *weave = take(params);
    double red = (double)tl_image_floats(&weave->weave.tint)[0];
    tl_weaves_give(weave);
    return red;
}

static void set_time(const char *path, time_t seconds)
{
    const struct timespec times[2] = {{.tv_sec = seconds}, {.tv_sec = seconds}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static off_t size_of(const char *path)
{
    struct stat found;
    assert_int_equal(stat(path, &found), 0);
    return found.st_size;
}

/* Of another size at the same time, and of the same size at another time. */
static void files_that_change_are_read_again(void **state)
{
    (void)state;
    static const char folder[] = TOILE_SCRATCH_DIR "/weaves",
                      file[] = TOILE_SCRATCH_DIR "/weaves/cloth_basecolor.png";
    struct tl_weave_params params = plain();
    tl_error error;
    assert_ok(tl_folder_make(folder, &error), error);
    params.pictures = folder;
    save(file, 255, 4);
    set_time(file, 1000000);
    set_time(folder, 1000000);
    assert_near(red_of(&params), 1, 1e-6);
    save(file, 100, 64);
    set_time(file, 1000000);
    set_time(folder, 1000000);
    assert_near(red_of(&params), 0.1274, 1e-3);
    off_t size = size_of(file);
    save(file, 60, 64);
    assert_int_equal(size_of(file), size);
    assert_near(red_of(&params), 0.0452, 1e-3);
    remove(file);
    const struct tl_fabric_pictures *weave;
    assert_false(tl_weaves_take(&params, &weave, &error)); /* a kept one does not hide that it is gone */
    assert_null(weave);
}

/* Three of 96 MB, of which two stay, and one in use, which stays whatever the others take. */
static void what_nobody_uses_is_bounded(void **state)
{
    (void)state;
    static const char file[] = TOILE_SCRATCH_DIR "/weaves_height.png";
    struct tl_weave_params params = plain();
    save(file, 128, 2048);
    params.picture = file;
    const struct tl_fabric_pictures *used = take(&params);
    for (int i = 1; i <= 3; i++) {
        params.depth_mm = 0.5f + (float)i;
        tl_weaves_give(take(&params));
        assert_in_range(tl_weaves_unused_bytes(), 1, TL_WEAVES_KEPT_BYTES);
    }
    assert_true(tl_weaves_unused_bytes() > TL_WEAVES_KEPT_BYTES / 2);
    assert_int_equal(used->weave.height.width, 2048);
    assert_near(tl_image_floats(&used->weave.tint)[0], 1, 0);
    tl_weaves_give(used);
    assert_in_range(tl_weaves_unused_bytes(), 1, TL_WEAVES_KEPT_BYTES);
}

static void *take_often(void *failures)
{
    struct tl_weave_params params = plain();
    for (int i = 0; i < 20; i++) {
        const struct tl_fabric_pictures *weave = NULL;
        tl_error error;
        params.crimp_mm = 0.05f + 0.01f * (float)(i % 4);
        *(int *)failures += !tl_weaves_take(&params, &weave, &error) || !weave;
        tl_weaves_give(weave);
    }
    return NULL;
}

/* Equal weaves that are made at the same time are one. */
static void threads_may_take_at_once(void **state)
{
    (void)state;
    pthread_t threads[4];
    int failures[4] = {0};
    size_t before = tl_weaves_unused_bytes();
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, take_often, &failures[i]), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_int_equal(failures[i], 0);
    }
    struct tl_weave_params params = plain();
    const struct tl_fabric_pictures *one = take(&params);
    size_t texels = (size_t)one->weave.height.width * (size_t)one->weave.height.height;
    tl_weaves_give(one);
    assert_in_range(tl_weaves_unused_bytes() - before, 1, (size_t)5 * 23 * texels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_options_share_a_weave),
        cmocka_unit_test(threads_may_take_at_once),
        cmocka_unit_test(files_that_change_are_read_again),
        cmocka_unit_test(what_nobody_uses_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
