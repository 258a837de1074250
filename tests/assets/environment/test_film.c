/* Films as light: every frame of a lossless film is, to the bit, the frame of the same number in a sequence
 * of EXR files, in any order, and is due when its film says so. The bytes, their linear values and the times
 * are this file's own. */
#include "tests/testing.h"

#include "assets/environment/environment_sequence.h"
#include "assets/image/exr.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#define FOLDER TOILE_SCRATCH_DIR "/film"

enum { WIDTH = 16, HEIGHT = 8, FRAMES = 5, BYTES = WIDTH * HEIGHT * 3 };

static bool has_ffmpeg(void)
{
    return system("ffmpeg -version >/dev/null 2>&1") == 0;
}

static uint8_t byte_of(int frame, int at)
{
    return (uint8_t)((frame * 61 + at * 37 + at / 48 * 11) % 256);
}

/* The definition of sRGB, not the program's table. */
static float linear_of(uint8_t byte)
{
    double value = byte / 255.0;
    return (float)(value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4));
}

static void write_frames(void)
{
    static const char *const channels[] = {"R", "G", "B"};
    tl_error error = {0};
    tl_image image = tl_image_create(WIDTH, HEIGHT, 3, TL_IMAGE_F32);
    FILE *raw = fopen(FOLDER "/frames.rgb", "wb");
    assert_non_null(raw);
    for (int frame = 0; frame < FRAMES; frame++) {
        for (int i = 0; i < BYTES; i++) {
            fputc(byte_of(frame, i), raw);
            tl_image_floats(&image)[i] = linear_of(byte_of(frame, i));
        }
        char *path = tl_format(FOLDER "/sky.%d.exr", frame);
        const struct tl_exr_layer layer = {channels, &image};
        assert_ok(tl_exr_save(path, &layer, 1, &error), error);
        free(path);
    }
    fclose(raw);
    tl_image_release(&image);
}

static void make_film(void)
{
    assert_int_equal(
        system("ffmpeg -nostdin -y -loglevel error -f rawvideo -pix_fmt rgb24 -s 16x8 -r 25 -i " FOLDER
               "/frames.rgb -c:v ffv1 -pix_fmt bgr0 " FOLDER "/sky.mkv"),
        0);
}

static void test_frames_are_those_of_files(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_environment_sequence film, files;
    const int order[] = {0, 1, 3, 4, 0, 2, 1, 1};
    assert_true(tl_environment_is_sequence(FOLDER "/sky.mkv"));
    assert_ok(tl_environment_sequence_open(FOLDER "/sky.mkv", &film, &error), error);
    assert_ok(tl_environment_sequence_open(FOLDER "/sky.#.exr", &files, &error), error);
    assert_int_equal(film.count, FRAMES);
    for (size_t i = 0; i < TL_COUNT(order); i++) {
        tl_environment a, b;
        assert_ok(tl_environment_sequence_load(&film, order[i], &a, &error), error);
        assert_ok(tl_environment_sequence_load(&files, order[i], &b, &error), error);
        assert_int_equal(a.image.width, WIDTH);
        assert_int_equal(a.image.height, HEIGHT);
        assert_string_equal(a.name, "sky.mkv");
        assert_int_equal(a.layout, b.layout);
        for (int k = 0; k < BYTES; k++)
            assert_near(tl_image_floats(&a.image)[k], tl_image_floats(&b.image)[k], 1e-6);
        assert_near(a.peak, b.peak, 1e-6);
        assert_near(a.shown.x, b.shown.x, 1e-4 * (double)b.shown.x);
        tl_environment_release(&a);
        tl_environment_release(&b);
    }
    tl_environment_sequence_release(&film);
    tl_environment_sequence_release(&files);
}

static void refuse(const char *path, const char *expected)
{
    tl_error error = {0};
    tl_environment_sequence film;
    assert_false(tl_environment_sequence_open(path, &film, &error));
    assert_int_equal(error.code, TL_INPUT);
    assert_null(strchr(error.message, '\n'));
    if (!strstr(error.message, expected)) {
        print_error("%s: expected %s\n", error.message, expected);
        fail();
    }
}

/* Copies the first `size` bytes of the film. */
static void cut(const char *to, size_t size)
{
    char *data;
    size_t whole;
    tl_error error = {0};
    assert_ok(tl_file_read(FOLDER "/sky.mkv", &data, &whole, &error), error);
    FILE *stream = fopen(to, "wb");
    assert_non_null(stream);
    fwrite(data, 1, size < whole ? size : whole, stream);
    fclose(stream);
    free(data);
}

static void test_bad_films(void **state)
{
    (void)state;
    FILE *stream = fopen(FOLDER "/words.mp4", "w");
    assert_non_null(stream);
    fputs("no film\n", stream);
    fclose(stream);
    cut(FOLDER "/cut.mkv", 200);
    refuse(FOLDER "/words.mp4", "words.mp4: is no film that can be read: ffmpeg:");
    refuse(FOLDER "/cut.mkv", "cut.mkv: is no film");
    refuse(FOLDER "/nowhere.mp4", "nowhere.mp4: no such file");
}

static void make(const char *how)
{
    char *command =
        tl_format("ffmpeg -nostdin -y -loglevel error -f rawvideo -pix_fmt rgb24 -s 16x8 -r 25 -i " FOLDER
                  "/frames.rgb %s",
                  how);
    assert_int_equal(system(command), 0);
    free(command);
}

/* Frame n of a flight at 60 images a second shows frame floor(25 n / 60) of a film at 25, in a loop; so does
 * one whose frames are stored in another order than shown. A film of uneven times keeps them: n^2 / 25 s. */
static void test_times(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_environment_sequence even, swapped, uneven, files;
    make("-c:v mpeg4 -bf 2 -b_strategy 0 " FOLDER "/swapped.mp4");
    make("-vf setpts=N*N/25/TB -vsync vfr -c:v ffv1 -pix_fmt bgr0 " FOLDER "/uneven.mkv");
    assert_ok(tl_environment_sequence_open(FOLDER "/sky.mkv", &even, &error), error);
    assert_ok(tl_environment_sequence_open(FOLDER "/swapped.mp4", &swapped, &error), error);
    assert_ok(tl_environment_sequence_open(FOLDER "/uneven.mkv", &uneven, &error), error);
    assert_ok(tl_environment_sequence_open(FOLDER "/sky.#.exr", &files, &error), error);
    for (int n = 0; n < 200; n++) {
        assert_int_equal(tl_environment_sequence_at(&even, n / 60.0, -1), 25 * n / 60 % FRAMES);
        assert_int_equal(tl_environment_sequence_at(&swapped, n / 60.0, -1), 25 * n / 60 % FRAMES);
        assert_int_equal(tl_environment_sequence_at(&even, n / 60.0, 60), n % FRAMES);
        assert_int_equal(tl_environment_sequence_at(&files, n / 60.0, -1), n / 2 % FRAMES);
        assert_int_equal(tl_environment_sequence_at(&even, n / 60.0, 0), 0);
    }
    for (int n = 0; n < 16; n++) {
        int shown = 0;
        while ((shown + 1) * (shown + 1) <= n)
            shown++;
        assert_int_equal(tl_environment_sequence_at(&uneven, (n + 0.5) / 25, -1), shown);
    }
    tl_environment_sequence_release(&even);
    tl_environment_sequence_release(&swapped);
    tl_environment_sequence_release(&uneven);
    tl_environment_sequence_release(&files);
}

/* A film on stdin: its newest frame is shown, the last one when all have come, and it is opened once. */
static void test_live(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_environment_sequence film;
    tl_environment last;
    int stream = open(FOLDER "/sky.mkv", O_RDONLY), kept = dup(STDIN_FILENO), newest = 0;
    assert_true(stream >= 0 && dup2(stream, STDIN_FILENO) == STDIN_FILENO);
    assert_true(tl_environment_is_sequence("-"));
    assert_ok(tl_environment_sequence_open("-", &film, &error), error);
    while (newest < FRAMES - 1) {
        int now = tl_environment_sequence_at(&film, 0, -1);
        assert_in_range(now, newest, FRAMES - 1);
        newest = now;
        usleep(1000);
    }
    assert_ok(tl_environment_sequence_load(&film, newest, &last, &error), error);
    for (int k = 0; k < BYTES; k++)
        assert_near(tl_image_floats(&last.image)[k], linear_of(byte_of(FRAMES - 1, k)), 1e-6);
    tl_environment_release(&last);
    refuse("-", "can be opened once");
    tl_environment_sequence_release(&film);
    dup2(kept, STDIN_FILENO);
    close(kept);
    close(stream);
}

/* Without ffmpeg the message names what to install. */
static void test_no_ffmpeg(void **state)
{
    (void)state;
    char *path = tl_copy_string(getenv("PATH"));
    setenv("PATH", FOLDER, 1);
    refuse(FOLDER "/sky.mkv", "install the package ffmpeg");
    setenv("PATH", path, 1);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames_are_those_of_files),
        cmocka_unit_test(test_times),
        cmocka_unit_test(test_bad_films),
        cmocka_unit_test(test_live),
        cmocka_unit_test(test_no_ffmpeg),
    };
    tl_error error = {0};
    if (!has_ffmpeg()) {
        printf("skipped: films: there is no ffmpeg\n");
        return 0;
    }
    if (!tl_folder_make(FOLDER, &error))
        return 1;
    write_frames();
    make_film();
    return cmocka_run_group_tests_name("film", tests, NULL, NULL);
}
