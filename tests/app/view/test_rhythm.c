/* The rhythm of a review in motion against what happened in a simulated second: how fast the cloth played,
 * how often the panel was built. */
#include "app/view/window/rhythm.h"

#include "tests/testing.h"

/* Frames of `frame_s` of cloth that are each `late_s` late: so much of real time is played. */
static void the_cloth_plays_as_fast_as_its_frames_come(void **state)
{
    (void)state;
    const double frame_s = 1 / 30.0, lates[] = {0, 0.01, 1 / 30.0, 0.1};
    for (size_t i = 0; i < 4; i++) {
        double played = 0, taken = 0, speed = 1;
        for (int frame = 0; frame < 100; frame++) {
            speed = tl_play_speed(speed, frame_s, lates[i]);
            played += frame_s;
            taken += frame_s + lates[i];
        }
        assert_near(speed, played / taken, 1e-4);
    }
}

/* One slow frame changes it little, a second of them most of the way, and back. */
static void one_slow_frame_changes_little(void **state)
{
    (void)state;
    const double frame_s = 1 / 30.0;
    double speed = tl_play_speed(1, frame_s, 1);
    assert_true(speed < 1 && speed > 0.89);
    assert_near(tl_play_speed(1, frame_s, -1), 1, 1e-12); /* early: it waits */
    for (int frame = 0; frame < 30; frame++)
        speed = tl_play_speed(speed, frame_s, frame_s);
    assert_near(speed, 0.5, 0.03);
    for (int frame = 0; frame < 30; frame++)
        speed = tl_play_speed(speed, frame_s, 0);
    assert_near(speed, 1, 0.03);
}

/* In a second of 60 images, the first of which built the panel. */
static int times_built(bool is_used, bool is_in_motion)
{
    double built_s = 100;
    int count = 0;
    for (int i = 1; i <= 60; i++) {
        double now_s = 100 + i / 60.0;
        if (!tl_panel_is_due(now_s, built_s, is_used, is_in_motion))
            continue;
        built_s = now_s;
        count++;
    }
    return count;
}

static void the_panel_is_built_four_times_a_second_in_motion(void **state)
{
    (void)state;
    assert_true(times_built(false, true) >= 3 && times_built(false, true) <= 4);
    assert_int_equal(times_built(true, true), 60);
    assert_int_equal(times_built(false, false), 60);
}

/* At 30 frames a second, of a motion of 10 frames. */
static void a_motion_keeps_its_rate(void **state)
{
    (void)state;
    const double frame_s = 1.0 / 30;
    assert_int_equal(tl_play_next(3, 9, frame_s, 0, true), 4);
    assert_int_equal(tl_play_next(3, 9, frame_s, -0.01, true), 4);
    assert_int_equal(tl_play_next(3, 9, frame_s, 0.02, true), 4);
    assert_int_equal(tl_play_next(3, 9, frame_s, 0.05, true), 5);  /* one frame was missed */
    assert_int_equal(tl_play_next(3, 9, frame_s, 0.11, false), 7); /* three */
    assert_int_equal(tl_play_next(9, 9, frame_s, 0, true), 0);     /* begins again */
    assert_int_equal(tl_play_next(8, 9, frame_s, 0.08, true), 1);  /* 9, 0, 1 */
    assert_int_equal(tl_play_next(8, 9, frame_s, 100, true), 9);   /* 3009, ten frames a turn */
    assert_int_equal(tl_play_next(8, 9, frame_s, 0.08, false), 9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cloth_plays_as_fast_as_its_frames_come),
        cmocka_unit_test(one_slow_frame_changes_little),
        cmocka_unit_test(the_panel_is_built_four_times_a_second_in_motion),
        cmocka_unit_test(a_motion_keeps_its_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
