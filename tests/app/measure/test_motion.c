/* The motion that light is measured in: it moves, is the same every time, and a recording shows what was
 * there. */
#include "tests/testing.h"

#include "app/measure/motion.h"

#include <string.h>

#define FRAMES 4

static tl_session *session_of(const char *const *assignments, size_t count)
{
    const struct tl_settings_source source = {
        .scene_file = "review", .assignments = assignments, .assignment_count = count};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

static tl_session *quick_session(void)
{
    static const char *const assignments[] = {"cloth.edge_m=0.08", "cloth.settle_s=0.3", "cloth.substeps=8"};
    return session_of(assignments, 3);
}

/* Turned by 15 degrees a second about the vertical through the target: height, distance and upright stay. */
static void camera_walks_round(void **state)
{
    (void)state;
    const struct tl_camera camera = {
        .eye = {{1, 2, 3}}, .target = {{0, 1, 0}}, .up = {{0, 1, 0}}, .fov_y = 1};
    struct tl_camera turned = tl_motion_camera(&camera, 60, 30);
    vec3s before = glms_vec3_sub(camera.eye, camera.target), after = glms_vec3_sub(turned.eye, turned.target);
    before.y = after.y = 0;
    assert_near(turned.eye.y, 2, 1e-6);
    assert_near(turned.up.y, 1, 1e-6);
    assert_near(glms_vec3_norm(after), glms_vec3_norm(before), 1e-5);
    assert_near(glms_vec3_angle(before, after), 30 * M_PI / 180, 1e-3); /* acos of a float near 1 */
}

static void film_is_the_motion(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_session *session = quick_session();
    tl_recording *recording = tl_motion_record(session, FRAMES, &error);
    assert_ok(recording != NULL, error);
    struct tl_recording_report report = tl_recording_report(recording);
    assert_int_equal(report.frames, FRAMES);
    assert_true(report.mean_step_m > 1e-4 && report.mean_step_m < 0.05);

    assert_ok(tl_session_reset(session, &error), error);
    struct tl_motion motion;
    tl_motion_begin(&motion, session);
    assert_true(motion.pulls);
    uint64_t last_revision = 0;
    for (int number = 0; number < FRAMES; number++) {
        if (number > 0)
            assert_ok(tl_motion_advance(&motion, number, &error), error);
        tl_frame live = tl_session_frame(session), shown = tl_recording_frame(recording, number);
        assert_int_equal(shown.surface_count, live.surface_count);
        for (size_t s = 0; s < live.surface_count; s++)
            assert_memory_equal(shown.surfaces[s].positions, live.surfaces[s].positions,
                                live.surfaces[s].vertex_count * sizeof(vec3s));
        uint64_t revision = shown.surfaces[live.surface_count - 1].motion_revision;
        assert_true(revision != last_revision); /* else a renderer would show the frame before */
        last_revision = revision;
    }
    tl_recording_destroy(&recording);
    tl_session_destroy(&session);
}

/* A swatch of 8 cm is not torn out of the hand by a dress's swing: 16 cm to either side. */
static void a_swatch_swings_by_its_size(void **state)
{
    (void)state;
    static const char name[] = "swatch.obj";
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs("v 0 0.1 0\nv 0.08 0.1 0\nv 0.08 0.18 0\nv 0 0.18 0\nf 1 2 3\nf 1 3 4\n", file);
    fclose(file);
    static const char *const assignments[] = {"scene.garment=swatch.obj", "scene.units=m",
                                              "scene.avatar=none", "cloth.settle_s=0", "cloth.substeps=8"};
    tl_session *sessions[] = {quick_session(), session_of(assignments, 5)};
    struct tl_motion motion;
    tl_motion_begin(&motion, sessions[0]);
    assert_near(motion.swing_m, 0.16, 1e-7);
    tl_motion_begin(&motion, sessions[1]);
    assert_near(motion.swing_m, 0.02, 1e-6); /* a quarter */
    tl_session_destroy(&sessions[0]);
    tl_session_destroy(&sessions[1]);
    remove(name);
}

/* A body that stands still is not news from frame to frame. */
static void form_does_not_move(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_session *session = quick_session();
    uint64_t before = tl_session_frame(session).surfaces[0].motion_revision;
    assert_string_equal(tl_session_frame(session).surfaces[0].name, "avatar");
    assert_ok(tl_session_advance(session, &error), error);
    assert_int_equal(tl_session_frame(session).surfaces[0].motion_revision, before);
    tl_session_destroy(&session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_walks_round),
        cmocka_unit_test(film_is_the_motion),
        cmocka_unit_test(a_swatch_swings_by_its_size),
        cmocka_unit_test(form_does_not_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
