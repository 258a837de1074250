/* A flight flown again at the same levels shows the same images, whatever the threads and from a session
 * that starts afresh; and the reference judges each image against its own frame. */
#include "tests/testing.h"

#include "app/lab/flight/fly.h"
#include "app/scene/orbit.h"
#include "config/base/memory.h"

#include <omp.h>

#define FRAMES 7

static struct tl_headless open_headless(void)
{
    const char *const assignments[] = {"cloth.edge_m=0.08", "cloth.settle_s=0.3",     "image.width=48",
                                       "image.height=64",   "reference.replicates=2", "scene.preset=draft",
                                       "light.pem_size=16"};
    const struct tl_settings_source source = {.assignments = assignments,
                                              .assignment_count = TL_COUNT(assignments)};
    struct tl_settings settings;
    struct tl_headless headless = {0};
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    assert_ok(tl_headless_open(&headless, &settings, &error), error);
    const tl_frame frame = tl_session_frame(headless.session);
    tl_orbit_take(&headless.settings.camera, &frame.camera);
    return headless;
}

/* A path that turns fast, so that each frame shows something else. */
static struct tl_path make_path(const struct tl_settings *settings)
{
    struct tl_path path = {0};
    struct tl_path_key key = {.camera = settings->camera};
    tl_path_add(&path, &key);
    key.time_s = FRAMES / 30.0;
    key.camera.yaw_deg += 180;
    key.environment_yaw_deg = 90;
    tl_path_add(&path, &key);
    return path;
}

/* Levels of several kinds, among them refresh, which changes what the frames after it show. */
static struct tl_flight make_record(void)
{
    struct tl_flight record = {.frames = TL_NEW_ARRAY(struct tl_flight_frame, FRAMES), .count = FRAMES};
    for (int i = 0; i < FRAMES; i++) {
        record.frames[i].levels.of[TL_CONTROL_REFRESH] = i >= 2 && i < 4;
        record.frames[i].levels.of[TL_CONTROL_REGIONS] = (uint8_t)(i % 2);
        record.frames[i].levels.of[TL_CONTROL_SCALE] = i == 5;
    }
    return record;
}

static struct tl_flight fly(struct tl_headless *headless, const struct tl_flight *record, int oracle_every)
{
    const struct tl_fly_options options = {
        .frames = FRAMES, .hash = true, .oracle_every = oracle_every, .replay = record};
    struct tl_path path = make_path(&headless->settings);
    struct tl_flight flight;
    tl_error error = {0};
    assert_ok(tl_fly(headless, &options, &path, &flight, &error), error);
    assert_int_equal(flight.count, FRAMES);
    return flight;
}

static void assert_same_images(const struct tl_flight *a, const struct tl_flight *b)
{
    for (int i = 0; i < FRAMES; i++) {
        assert_true(a->frames[i].hash != 0);
        assert_true(a->frames[i].hash == b->frames[i].hash);
        for (int k = 0; k < i; k++)
            assert_true(a->frames[i].hash != a->frames[k].hash);
    }
}

static void flown_again_it_shows_the_same(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_flight record = make_record();
    omp_set_num_threads(2);
    struct tl_headless headless = open_headless();
    struct tl_flight first = fly(&headless, &record, 0);

    /* From a new session, by a renderer that has not drawn: as the oracle finds them. */
    assert_ok(tl_session_restart(headless.session, &headless.settings, &error), error);
    tl_renderer_destroy(&headless.renderer);
    headless.renderer = tl_renderer_create(headless.gpu, &error);
    assert_ok(headless.renderer != NULL, error);
    struct tl_flight again = fly(&headless, &record, 0);
    assert_same_images(&first, &again);
    tl_flight_release(&again);
    tl_headless_release(&headless);

    omp_set_num_threads(1);
    headless = open_headless();
    again = fly(&headless, &record, 0);
    assert_same_images(&first, &again);
    omp_set_num_threads(2);

    tl_flight_release(&again);
    tl_flight_release(&first);
    tl_flight_release(&record);
    tl_headless_release(&headless);
}

/* An image against another frame's truth is far off: at least three times as far. */
static void the_oracle_judges_each_image_by_its_own_frame(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_flight record = make_record();
    struct tl_headless headless = open_headless();
    struct tl_flight flight = fly(&headless, &record, 3);
    assert_int_equal(flight.kept_count, 2);
    assert_ok(tl_fly_judge(&headless, &flight, &error), error);
    double right = flight.frames[3].rel_rmse + flight.frames[6].rel_rmse;
    assert_true(isfinite(right) && right > 0);
    assert_true(flight.frames[3].flip_mean > 0 && flight.frames[6].flip_mean < 1);
    assert_true(isnan(flight.frames[0].flip_mean) && isnan(flight.frames[0].garment_flip)); /* at rest */
    assert_true(isnan(flight.frames[1].flip_mean) && isnan(flight.frames[1].rel_rmse));
    assert_true(isnan(flight.frames[1].garment_flip) && isnan(flight.frames[1].garment_flip_worst));
    double garment = flight.frames[3].garment_flip + flight.frames[6].garment_flip;
    assert_true(garment > 0);
    for (int i = 3; i < FRAMES; i += 3)
        assert_true(flight.frames[i].garment_flip_worst > flight.frames[i].garment_flip);

    tl_image first = flight.kept[0].image;
    flight.kept[0].image = flight.kept[1].image;
    flight.kept[1].image = first;
    assert_ok(tl_fly_judge(&headless, &flight, &error), error);
    double wrong = flight.frames[3].rel_rmse + flight.frames[6].rel_rmse;
    assert_true(wrong > 3 * right);
    assert_near(flight.frames[3].garment_flip + flight.frames[6].garment_flip, garment, 0); /* as shown */

    first = flight.kept[0].shown;
    flight.kept[0].shown = flight.kept[1].shown;
    flight.kept[1].shown = first;
    assert_ok(tl_fly_judge(&headless, &flight, &error), error);
    assert_true(flight.frames[3].garment_flip + flight.frames[6].garment_flip > 2 * garment);

    tl_flight_release(&flight);
    tl_flight_release(&record);
    tl_headless_release(&headless);
}

/* Where the garment is after a flight within a budget (0: without one). */
struct flown {
    vec3s *positions;
    size_t count;
    bool is_reduced; /* some frame was at lower levels */
};

static struct flown fly_within(double budget_ms)
{
    struct tl_headless headless = open_headless();
    const struct tl_fly_options options = {.frames = FRAMES, .budget_ms = budget_ms};
    struct tl_path path = make_path(&headless.settings);
    struct tl_flight flight;
    tl_error error = {0};
    assert_ok(tl_fly(&headless, &options, &path, &flight, &error), error);
    assert_int_equal(flight.count, FRAMES);
    struct flown flown = {.count = tl_session_models(headless.session).garment->mesh.vertex_count};
    flown.positions = TL_NEW_ARRAY(vec3s, flown.count);
    tl_cloth_positions(tl_session_cloth(headless.session), flown.positions);
    for (int i = 0; i < FRAMES; i++)
        for (int control = 0; control < TL_CONTROL_COUNT; control++)
            flown.is_reduced = flown.is_reduced || flight.frames[i].levels.of[control] > 0;
    tl_flight_release(&flight);
    tl_headless_release(&headless);
    return flown;
}

/* How a garment falls does not depend on the budget: it is the same to the bit with none, with any, and with
 * one that nothing fits, where the image is at its lowest levels. */
static void no_budget_changes_a_fit(void **state)
{
    (void)state;
    const double budgets[] = {33, 1e-3};
    struct flown without = fly_within(0);
    assert_false(without.is_reduced);
    for (size_t i = 0; i < TL_COUNT(budgets); i++) {
        struct flown within = fly_within(budgets[i]);
        assert_int_equal(within.count, without.count);
        assert_memory_equal(within.positions, without.positions, within.count * sizeof *within.positions);
        assert_true(within.is_reduced || budgets[i] > 1);
        free(within.positions);
    }
    free(without.positions);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flown_again_it_shows_the_same),
        cmocka_unit_test(the_oracle_judges_each_image_by_its_own_frame),
        cmocka_unit_test(no_budget_changes_a_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
