/* Camera paths: through their keys, between them, smooth, at rest outside; files that come back, and files
 * that do not. */
#include "tests/testing.h"

#include "app/scene/path.h"
#include "config/base/memory.h"

#include <string.h>
#include <unistd.h>

static struct tl_settings scene(void)
{
    const struct tl_settings_source source = {0};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    settings.camera = (struct tl_camera_params){
        .yaw_deg = 25, .pitch_deg = 8, .distance_m = 3.25f, .target = {0.1f, 1.1f, -0.2f}, .fov_deg = 30};
    return settings;
}

/* Rises, stops, falls and turns, in uneven steps of time. */
static struct tl_path awkward_path(void)
{
    static const float rows[][6] = {
        {0, 0, 5, 2, 0, 30},          {0.5f, 10, 5, 2, 90, 30},    {2, 15, 5, 9, 91, 30},
        {2.25f, 200, -40, 9, 92, 60}, {2.5f, 420, -40, 1, 93, 20}, {6.5f, 30, 80, 1, -50, 20},
        {9, 720, 80, 1, -60, 21},
    };
    struct tl_path path = {0};
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        struct tl_path_key key = {.time_s = (double)rows[i][0],
                                  .camera = {.yaw_deg = rows[i][1],
                                             .pitch_deg = rows[i][2],
                                             .distance_m = rows[i][3],
                                             .target = {rows[i][1] * 0.01f, 1, -rows[i][3]},
                                             .fov_deg = rows[i][5]},
                                  .environment_yaw_deg = rows[i][4]};
        tl_path_add(&path, &key);
    }
    return path;
}

#define NUMBERS 8
static void numbers_of(const struct tl_path_key *key, double out[NUMBERS])
{
    const struct tl_camera_params *camera = &key->camera;
    const float all[NUMBERS] = {camera->yaw_deg,   camera->pitch_deg,       camera->distance_m,
                                camera->target[0], camera->target[1],       camera->target[2],
                                camera->fov_deg,   key->environment_yaw_deg};
    for (int i = 0; i < NUMBERS; i++)
        out[i] = (double)all[i];
}

static void it_passes_through_its_keys_and_rests_outside(void **state)
{
    (void)state;
    struct tl_path path = awkward_path();
    double expected[NUMBERS], found[NUMBERS];
    for (size_t i = 0; i < path.count; i++) {
        struct tl_path_key at = tl_path_at(&path, path.keys[i].time_s);
        numbers_of(&path.keys[i], expected);
        numbers_of(&at, found);
        for (int n = 0; n < NUMBERS; n++)
            assert_near(found[n], expected[n], 0);
    }
    const double outside_s[] = {-1e9, -0.1, 9.1, 1e9};
    for (size_t i = 0; i < TL_COUNT(outside_s); i++) {
        struct tl_path_key at = tl_path_at(&path, outside_s[i]);
        numbers_of(&path.keys[outside_s[i] < 0 ? 0 : path.count - 1], expected);
        numbers_of(&at, found);
        for (int n = 0; n < NUMBERS; n++)
            assert_near(found[n], expected[n], 0);
    }
    assert_near(tl_path_length_s(&path), 9, 0);
    path.count = 1; /* a path of one key stands still */
    assert_near(tl_path_at(&path, 5).camera.distance_m, 2, 0);
    tl_path_release(&path);
}

/* Between two keys every number stays between theirs and never turns back. Numbers are rounded to float:
 * half a step of the largest, 720, is 3.1e-5. */
static void it_does_not_overshoot(void **state)
{
    (void)state;
    const double rounding = 3.1e-5;
    struct tl_path path = awkward_path();
    for (size_t i = 0; i + 1 < path.count; i++) {
        double from[NUMBERS], to[NUMBERS], last[NUMBERS], here[NUMBERS];
        numbers_of(&path.keys[i], from);
        numbers_of(&path.keys[i + 1], to);
        memcpy(last, from, sizeof last);
        for (int step = 1; step <= 200; step++) {
            double part = step / 200.0;
            struct tl_path_key at =
                tl_path_at(&path, (1 - part) * path.keys[i].time_s + part * path.keys[i + 1].time_s);
            numbers_of(&at, here);
            for (int n = 0; n < NUMBERS; n++) {
                double way = to[n] > from[n] ? 1 : -1;
                assert_true(way * (here[n] - last[n]) >= -rounding);
                assert_true(way * (to[n] - here[n]) >= -rounding);
                last[n] = here[n];
            }
        }
    }
    tl_path_release(&path);
}

/* Once differentiable everywhere, at keys and at the ends too: slopes on both sides agree. One-sided
 * differences of second order over h = 1/256 s err by h^2 / 3 times a third derivative: of a Hermite cubic of
 * rise R in s seconds with slopes of at most 3 R / s it is at most 12 R / s^3 + 6 (3 + 3) R / s^3, 48 x 220 /
 * 0.25^3 = 6.8e5 for the steepest piece, so h^2 / 3 of it is 3.5; its slopes are up to 2640 deg/s. Rounding
 * to float adds 4 x 3.1e-5 / h = 0.03. */
static void it_is_smooth(void **state)
{
    (void)state;
    const double h = 1.0 / 256, bound = 2 * (3.5 + 0.03);
    struct tl_path path = awkward_path();
    double steepest = 0;
    for (size_t i = 0; i < path.count; i++) {
        double at[5][NUMBERS];
        for (int k = 0; k < 5; k++) {
            struct tl_path_key key = tl_path_at(&path, path.keys[i].time_s + (k - 2) * h);
            numbers_of(&key, at[k]);
        }
        for (int n = 0; n < NUMBERS; n++) {
            double left = (3 * at[2][n] - 4 * at[1][n] + at[0][n]) / (2 * h);
            double right = (-3 * at[2][n] + 4 * at[3][n] - at[4][n]) / (2 * h);
            assert_near(left, right, bound);
            steepest = fmax(steepest, fabs(left));
        }
    }
    assert_true(steepest > 2 * bound); /* else nothing was seen */
    tl_path_release(&path);
}

static void a_straight_line_stays_straight(void **state)
{
    (void)state;
    struct tl_path path = {0};
    for (int i = 0; i < 5; i++)
        tl_path_add(&path, &(struct tl_path_key){.time_s = 2 * i, .camera = {.yaw_deg = 30.0f * (float)i}});
    /* The first and last piece speed up and slow down. 1e-5: rounding of 90 to float. */
    for (int i = 16; i <= 48; i++)
        assert_near(tl_path_at(&path, i / 8.0).camera.yaw_deg, 15 * i / 8.0, 1e-5);
    tl_path_release(&path);
}

static void the_built_in_path_turns_nears_and_turns_the_light(void **state)
{
    (void)state;
    struct tl_settings settings = scene();
    struct tl_path path = tl_path_built_in(&settings);
    float nearest = 1e9f, yaw = 0, light = 0;
    assert_near(tl_path_length_s(&path), TL_PATH_BUILT_IN_S, 0);
    for (int i = 0; i <= 10 * TL_PATH_BUILT_IN_S; i++) {
        struct tl_path_key at = tl_path_at(&path, i / 10.0);
        nearest = fminf(nearest, at.camera.distance_m);
        yaw = fmaxf(yaw, at.camera.yaw_deg);
        light = fmaxf(light, at.environment_yaw_deg);
    }
    assert_true(nearest < 0.5f * settings.camera.distance_m && nearest > 0);
    assert_true(yaw >= settings.camera.yaw_deg + 360 && light >= 350);
    assert_near(tl_path_at(&path, 0).camera.yaw_deg, settings.camera.yaw_deg, 0);
    tl_path_release(&path);

    settings.camera.distance_m = 0; /* framed: it stays so */
    path = tl_path_built_in(&settings);
    for (size_t i = 0; i < path.count; i++)
        assert_near(path.keys[i].camera.distance_m, 0, 0);
    tl_path_release(&path);
}

static void files_come_back_to_the_bit(void **state)
{
    (void)state;
    char name[] = "/tmp/toile_path_XXXXXX";
    int file = mkstemp(name);
    assert_true(file >= 0);
    close(file);
    tl_error error = {0};
    struct tl_settings settings = scene();
    struct tl_path path = awkward_path(), back;
    path.keys[3].time_s = 2.1000000000000001 + 1e-13;
    path.keys[3].camera.target[0] = 1.0f / 3;
    assert_ok(tl_path_save(name, &path, &error), error);
    assert_ok(tl_path_load(name, &settings, &back, &error), error);
    assert_int_equal(back.count, path.count);
    for (size_t i = 0; i < path.count; i++) {
        double expected[NUMBERS], found[NUMBERS];
        numbers_of(&path.keys[i], expected);
        numbers_of(&back.keys[i], found);
        assert_true(back.keys[i].time_s == path.keys[i].time_s);
        assert_memory_equal(found, expected, sizeof found);
    }
    unlink(name);
    tl_path_release(&back);
    tl_path_release(&path);
}

/* Loads a path from text; the error's message is in `error` where it fails. */
static bool load_text(const char *text, struct tl_path *out, tl_error *error)
{
    char name[] = "/tmp/toile_path_XXXXXX";
    int file = mkstemp(name);
    assert_true(file >= 0);
    FILE *stream = fdopen(file, "w");
    fputs(text, stream);
    fclose(stream);
    struct tl_settings settings = scene();
    bool loaded = tl_path_load(name, &settings, out, error);
    unlink(name);
    return loaded;
}

static void what_is_left_out_is_kept(void **state)
{
    (void)state;
    struct tl_path path;
    tl_error error = {0};
    assert_ok(load_text("keys:\n  - {yaw_deg: 4}\n  - time_s: 2\n    target: [1, 2, 3]\n  - {time_s: 3}\n",
                        &path, &error),
              error);
    assert_int_equal(path.count, 3);
    assert_near(path.keys[0].camera.distance_m, 3.25, 0); /* the scene's */
    assert_near(path.keys[0].time_s, 0, 0);
    assert_near(path.keys[2].camera.yaw_deg, 4, 0);
    assert_near(path.keys[2].camera.target[1], 2, 0);
    tl_path_release(&path);
}

/* A target of 0 0 0 stands for the middle of the scene, which nothing can lie beside. */
static void what_has_no_target_has_the_scenes(void **state)
{
    (void)state;
    struct tl_path path;
    tl_error error = {0};
    assert_ok(
        load_text("keys:\n  - {target: [0, 0, 0]}\n  - {time_s: 1, target: [1, 2, 3]}\n", &path, &error),
        error);
    assert_near(path.keys[0].camera.target[1], 1.1f, 0);
    assert_near(path.keys[1].camera.target[1], 2, 0);
    tl_path_release(&path);
}

static void bad_files_are_named_with_line_and_field(void **state)
{
    (void)state;
    static const struct {
        const char *text, *line, *says;
    } rows[] = {
        {"keys:\n  - {time_s: 0}\n  - {time_s: 0}\n", ":3:", "time_s"},
        {"keys:\n  - {time_s: 1, yaw: 0}\n", ":2:", "yaw_deg"},
        {"keys:\n  - {pitch_deg: 95}\n", ":2:", "pitch_deg"},
        {"keys:\n  - {fov_deg: .nan}\n", ":2:", "fov_deg"},
        {"keys:\n  - {target: [1, 2]}\n", ":2:", "target"},
        {"keys:\n  - {target: [1, 2, 3, 4]}\n", ":2:", "target"},
        {"keys:\n  - {yaw_deg: 1, yaw_deg: 2}\n", ":2:", "twice"},
        {"keys:\n  - {distance_m: 2}\n  - {time_s: 1, distance_m: 0}\n", ":3:", "distance_m"},
        {"keys:\n  - [1, 2]\n", ":2:", "expected a key"},
        {"keys: 5\n", ":1:", "list of keys"},
        {"camera: {yaw_deg: 1}\n", ":1:", "no camera path"},
        {"keys:\n  - {time_s: 0}\nkeys:\n  - {time_s: 0}\n", ":3:", "once"},
        {"- 1\n", ":1:", "no camera path"},
        {"keys: []\n", "", "holds no key"},
        {"# nothing\n", "", "holds no key"},
        {"keys:\n  - {time_s: 0\n", ":", "not valid YAML"},
        {"keys:\n  - &a {time_s: 0}\n", ":2:", "anchors"},
        {"keys:\n  - {yaw_deg: {a: 1}}\n", ":2:", "yaw_deg"},
    };
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        struct tl_path path = {0};
        tl_error error = {0};
        bool loaded = load_text(rows[i].text, &path, &error);
        if (loaded || !strstr(error.message, rows[i].line) || !strstr(error.message, rows[i].says)) {
            print_error("%s-> %s\n", rows[i].text, loaded ? "loaded" : error.message);
            fail();
        }
        assert_int_equal(tl_exit_status(error.code), 2);
        assert_null(path.keys);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_passes_through_its_keys_and_rests_outside),
        cmocka_unit_test(it_does_not_overshoot),
        cmocka_unit_test(it_is_smooth),
        cmocka_unit_test(a_straight_line_stays_straight),
        cmocka_unit_test(the_built_in_path_turns_nears_and_turns_the_light),
        cmocka_unit_test(files_come_back_to_the_bit),
        cmocka_unit_test(what_is_left_out_is_kept),
        cmocka_unit_test(what_has_no_target_has_the_scenes),
        cmocka_unit_test(bad_files_are_named_with_line_and_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
