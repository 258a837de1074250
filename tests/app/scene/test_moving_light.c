/* A sequence of environments plays with the session's frames: in time, round and round, the same every time;
 * what goes wrong leaves what was. */
#include "tests/testing.h"

#include "app/scene/session.h"
#include "assets/environment/environment.h"
#include "assets/image/exr.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <string.h>

#define FOLDER  TOILE_SCRATCH_DIR "/light"
#define PATTERN FOLDER "/sky.##.exr"
#define FRAMES  5

/* Frame i, numbered from 1: 8 x 4 texels, radiance i + 1 in all but the first. */
static void write_sequence(void)
{
    static const char *const channels[] = {"R", "G", "B"};
    tl_error error = {0};
    assert_ok(tl_folder_make(FOLDER, &error), error);
    for (int i = 0; i < FRAMES; i++) {
        tl_image image = tl_image_create(8, 4, 3, TL_IMAGE_F32);
        for (int k = 3; k < 96; k++)
            tl_image_floats(&image)[k] = (float)(i + 1);
        const struct tl_exr_layer layer = {channels, &image};
        char *path = tl_format(FOLDER "/sky.%02d.exr", i + 1);
        assert_ok(tl_exr_save(path, &layer, 1, &error), error);
        free(path);
        tl_image_release(&image);
    }
}

static void break_frame(int number)
{
    char *path = tl_format(FOLDER "/sky.%02d.exr", number);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs("no picture\n", stream);
    fclose(stream);
    free(path);
}

/* A dress form alone: nothing but the light moves. */
static struct tl_settings light_settings(const char *rate)
{
    char *assignments[] = {tl_copy_string("scene.garment=none"), tl_copy_string("cloth.frame_rate=30"),
                           tl_copy_string("scene.environment=" PATTERN),
                           tl_format("scene.environment_rate=%s", rate)};
    const struct tl_settings_source source = {.assignments = (const char *const *)assignments,
                                              .assignment_count = TL_COUNT(assignments)};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    for (size_t i = 0; i < TL_COUNT(assignments); i++)
        free(assignments[i]);
    return settings;
}

static tl_session *open_session(const char *rate)
{
    struct tl_settings settings = light_settings(rate);
    tl_error error = {0};
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

/* The frame of the sequence that is shown, from 1. */
static int shown(tl_session *session)
{
    return (int)tl_image_floats(&tl_session_frame(session).environment->image)[3];
}

static uint64_t revision(tl_session *session)
{
    return tl_session_frame(session).environment_revision;
}

static void frames_follow_their_rate(void **state)
{
    (void)state;
    const struct {
        const char *rate;
        double per_frame;
    } cases[] = {{"30", 1}, {"10", 1.0 / 3}, {"60", 2}, {"24", 0.8}, {"0", 0}};
    write_sequence();
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_session *session = open_session(cases[i].rate);
        uint64_t seen = revision(session);
        int before = 1;
        assert_int_equal(shown(session), 1);
        for (int frame = 1; frame <= 70; frame++) {
            tl_error error = {0};
            assert_ok(tl_session_advance(session, &error), error);
            int due = (int)floor(frame * cases[i].per_frame + 1e-9) % FRAMES + 1;
            assert_int_equal(shown(session), due);
            /* A new revision with every change, and no other. */
            seen += due != before;
            assert_int_equal(revision(session), seen);
            before = due;
        }
        tl_session_destroy(&session);
    }
}

static void replays_are_the_same(void **state)
{
    (void)state;
    write_sequence();
    tl_session *session = open_session("30");
    tl_error error = {0};
    assert_ok(tl_session_go_to(session, 7, &error), error);
    assert_int_equal(shown(session), 3);
    uint64_t before = revision(session);
    assert_ok(tl_session_go_to(session, 2, &error), error);
    assert_int_equal(shown(session), 3); /* the same light: what was prepared for it still serves */
    assert_int_equal(revision(session), before);
    assert_ok(tl_session_go_to(session, 1, &error), error);
    assert_int_equal(shown(session), 2);
    assert_true(revision(session) > before);
    assert_ok(tl_session_reset(session, &error), error);
    assert_int_equal(shown(session), 1);
    tl_session_destroy(&session);
}

/* The factors of pictures and the ground are those of the first frame in every frame, also where the
 * sequence is opened at a later one. Frames differ in brightness, and would be shown alike. */
static void frames_are_shown_like_the_first(void **state)
{
    (void)state;
    write_sequence();
    tl_session *session = open_session("30");
    tl_error error = {0};
    const vec3s factors = tl_session_frame(session).environment->shown;
    const vec3s ground = tl_session_frame(session).environment->ground;
    assert_true(factors.g > 0 && ground.g > 0);
    assert_ok(tl_session_advance(session, &error), error);
    for (int opened = 0; opened < 2; opened++) {
        const tl_environment *later = tl_session_frame(session).environment;
        tl_environment own;
        assert_int_equal(shown(session), 2);
        assert_true(glms_vec3_eqv(later->shown, factors) && glms_vec3_eqv(later->ground, ground));
        assert_ok(tl_environment_load(FOLDER "/sky.02.exr", &own, &error), error);
        assert_true(own.shown.g < 0.7f * factors.g); /* another one, by itself */
        tl_environment_release(&own);
        struct tl_settings settings = *tl_session_settings(session);
        settings.scene.environment = "studio";
        assert_ok(tl_session_apply(session, &settings, &error), error);
        settings.scene.environment = PATTERN;
        assert_ok(tl_session_apply(session, &settings, &error), error);
    }
    tl_session_destroy(&session);
}

static void settings_change_in_place(void **state)
{
    (void)state;
    write_sequence();
    tl_session *session = open_session("30");
    tl_error error = {0};
    assert_ok(tl_session_go_to(session, 3, &error), error);
    struct tl_settings settings = *tl_session_settings(session);
    settings.scene.environment_rate = 10;
    uint64_t before = revision(session);
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_int_equal(shown(session), 2);
    assert_true(revision(session) > before);
    before = revision(session);
    settings.scene.environment = "studio";
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_true(revision(session) > before);
    assert_ok(tl_session_advance(session, &error), error); /* what stands still stands still */
    assert_int_equal(revision(session), before + 1);
    settings.scene.environment = PATTERN;
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_int_equal(tl_session_frame_number(session), 4);
    assert_int_equal(shown(session), 2);
    tl_session_destroy(&session);
}

static void a_broken_frame_is_named_and_nothing_is_lost(void **state)
{
    (void)state;
    write_sequence();
    break_frame(3);
    tl_session *session = open_session("30");
    tl_error error = {0};
    assert_ok(tl_session_advance(session, &error), error);
    uint64_t before = revision(session);
    assert_false(tl_session_advance(session, &error));
    assert_int_equal(error.code, TL_INPUT);
    assert_non_null(strstr(error.message, "sky.03.exr"));
    assert_int_equal(tl_session_frame_number(session), 1);
    assert_int_equal(shown(session), 2);
    assert_int_equal(revision(session), before);
    write_sequence(); /* repaired: it continues */
    assert_ok(tl_session_advance(session, &error), error);
    assert_int_equal(shown(session), 3);
    tl_session_destroy(&session);
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_follow_their_rate),
        cmocka_unit_test(replays_are_the_same),
        cmocka_unit_test(frames_are_shown_like_the_first),
        cmocka_unit_test(settings_change_in_place),
        cmocka_unit_test(a_broken_frame_is_named_and_nothing_is_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
