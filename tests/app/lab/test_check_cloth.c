/* Faults of the cloth are named by the invariants that they break. */
#include "tests/app/lab/verdicts.h"
#include "tests/app/quick_session.h"

#include "app/lab/check/check_trials.h"
#include "cloth/state.h"
#include "config/base/log.h"

static struct tl_checked check_cloth(tl_session *session, struct tl_checked_cloth *cloth, tl_frame *frame)
{
    static const struct tl_render_settings unused;
    *frame = tl_session_frame(session);
    cloth->report = tl_session_report(session);
    return (struct tl_checked){.number = 7, .frame = frame, .settings = &unused, .cloth = cloth};
}

static void faults_of_cloth_are_named(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    struct tl_cloth *cloth = tl_session_cloth(session);
    struct tl_checked_cloth watched = {.strain_limit = 0.1,
                                       .weight_n = 2,
                                       .kept_m = 0.003,
                                       .first_strain = 0.1,
                                       .drift_m = NAN,
                                       .min_energy_j = NAN,
                                       .allowed_speed = 20};
    tl_frame frame;
    struct tl_checked checked = check_cloth(session, &watched, &frame);
    assert_clean(&checked);
    double moving = watched.report.kinetic_energy + watched.report.potential_energy;
    watched.min_energy_j = moving - 0.004 * watched.weight_n; /* lifted by 4 mm out of nothing */
    assert_breaks(&checked, "cloth.energy", "garment");
    watched.min_energy_j = moving - 0.002 * watched.weight_n; /* as contacts may */
    watched.drift_m = 1e-6;
    assert_clean(&checked);
    watched.drift_m = 1e-3;
    assert_breaks(&checked, "cloth.momentum", "");

    /* One particle is thrown: its kinetic energy, and its speed. */
    vec3d *velocity = &cloth->particles.v[cloth->particles.count / 2], rest = *velocity;
    velocity->x += 60;
    checked = check_cloth(session, &watched, &frame);
    assert_breaks(&checked, "cloth.energy", "garment");
    assert_breaks(&checked, "cloth.speed", "m/s");
    watched.is_driven = true;
    assert_false(verdict_on(&checked, "cloth.energy").finding.is_measured);
    *velocity = rest;

    /* ... is pushed into the body: the middle of the hips is far below any skin. */
    vec3d *place = &cloth->particles.x[cloth->particles.count / 2], outside = *place;
    *place = (vec3d){0, 1.0, 0};
    checked = check_cloth(session, &watched, &frame);
    assert_breaks(&checked, "cloth.inside", "garment");
    *place = (vec3d){3 * outside.x, outside.y, 3 * outside.z};
    checked = check_cloth(session, &watched, &frame);
    assert_breaks(&checked, "cloth.strain", "garment");
    place->y = NAN;
    checked = check_cloth(session, &watched, &frame);
    assert_breaks(&checked, "cloth.strain", "garment"); /* no number is no pass */
    *place = outside;

    /* ... a seam is open. */
    checked = check_cloth(session, &watched, &frame);
    assert_true(verdict_on(&checked, "cloth.seams").ok);
    watched.report.open_seams = 1;
    assert_breaks(&checked, "cloth.seams", "garment");

    /* ... all of it is drawn apart by an eighth, by which no edge is too long. */
    for (size_t i = 0; i < cloth->particles.count; i++)
        cloth->particles.x[i] = vec3d_scale(cloth->particles.x[i], 1.125);
    checked = check_cloth(session, &watched, &frame);
    assert_true(verdict_on(&checked, "cloth.strain").ok);
    assert_breaks(&checked, "cloth.stretch", "garment");
    tl_session_destroy(&session);
}

/* The session in which the trials were run. */
static tl_session *try_fabric(const struct tl_settings *settings, struct tl_trials *trials)
{
    tl_error error = {0};
    tl_session *session = tl_session_create(settings, &error);
    assert_ok(session != NULL, error);
    assert_ok(tl_trials_run(session, settings, trials, &error), error);
    return session;
}

/* What is known of the fabric's trials beforehand, and that wrong outcomes are named. */
static void trials_are_measured(void **state)
{
    (void)state;
    struct tl_settings settings = quick_settings(NULL);
    struct tl_trials trials;
    tl_session *session = try_fabric(&settings, &trials);
    assert_false(trials.fall.is_measured); /* it was not at rest */
    assert_true(trials.droop.is_measured && trials.slide.is_measured);
    tl_session_destroy(&session);
    settings.cloth.settle_s = 10;
    settings.cloth.edge_m = 0.03f; /* a coarser dress is far from balance */
    session = try_fabric(&settings, &trials);
    assert_true(trials.fall.is_measured && trials.droop.is_measured && trials.slide.is_measured);
    assert_near(trials.fall.expected_m, 9.81 * 0.0526, 0.03); /* less than g t^2 / 2 by what air takes */
    tl_frame frame = tl_session_frame(session);
    static const struct tl_render_settings unused;
    struct tl_checked checked = {.number = 7, .frame = &frame, .settings = &unused, .trials = &trials};
    assert_clean(&checked);
    const struct tl_trials right = trials;
    trials.fall.fallen_m *= 1.03;
    assert_breaks(&checked, "cloth.fall", "garment");
    trials = right;
    trials.fall.sideways_m = 0.02;
    assert_breaks(&checked, "cloth.fall", "sideways");
    trials = right;
    trials.droop.tip_m *= 0.95;
    assert_breaks(&checked, "cloth.droop", "droops");
    trials = right;
    trials.slide.slid_m *= 1.06;
    assert_breaks(&checked, "cloth.slide", "friction");
    tl_session_destroy(&session);
}

/* Every solver passes the trials; a fabric that does not resist bending, and cloth without weight, have none.
 */
static void trials_of_every_solver(void **state)
{
    (void)state;
    struct tl_settings settings = quick_settings(NULL);
    struct tl_trials trials;
    tl_error error = {0};
    tl_session *session = try_fabric(&settings, &trials);
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        settings.cloth.solver = solver;
        assert_ok(tl_trials_run(session, &settings, &trials, &error), error);
        printf("%s: a strip along the %s droops by %.3f of %.3f mm, a sheet slides by %.4f of %.4f m\n",
               tl_cloth_solver_names[solver], trials.droop.along, 1e3 * trials.droop.tip_m,
               1e3 * trials.droop.expected_m, trials.slide.slid_m, trials.slide.expected_m);
        assert_near(trials.droop.tip_m, trials.droop.expected_m, 0.03 * trials.droop.expected_m);
        assert_near(trials.slide.slid_m, trials.slide.expected_m,
                    (0.02 + trials.slide.tolerance) * trials.slide.expected_m);
    }
    settings.fabric.bend_weft = settings.fabric.bend_warp = 0;
    assert_ok(tl_trials_run(session, &settings, &trials, &error), error);
    assert_false(trials.droop.is_measured);
    settings.cloth.gravity = 0;
    assert_ok(tl_trials_run(session, &settings, &trials, &error), error);
    assert_false(trials.slide.is_measured);
    tl_session_destroy(&session);
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faults_of_cloth_are_named),
        cmocka_unit_test(trials_are_measured),
        cmocka_unit_test(trials_of_every_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
