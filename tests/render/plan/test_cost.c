#include "render/plan/cost.h"

#include "tests/testing.h"

static double noise(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (double)((word >> 22) ^ word) / 4294967296.0;
}

/* A job with a fixed part, one that goes with samples and one with regions, on a machine that is four times
 * as fast as the table's, and whose parts are up to 1.6 times wrong in it. */
static struct tl_work work_at(double samples, double regions)
{
    return (struct tl_work){{6, 40 * samples, 20 * samples * regions}};
}
static const double truth[TL_WORK_PARTS] = {0.35, 0.2, 0.3};

static double true_ms(const struct tl_work *work)
{
    double ms = 0;
    for (int i = 0; i < TL_WORK_PARTS; i++)
        ms += truth[i] * work->ms[i];
    return ms;
}

static void unseen_levels_are_foretold(void **state)
{
    (void)state;
    struct tl_cost_job job = {0};
    uint32_t seed = 3;
    const double seen[][2] = {{1, 1}, {0.7, 1}, {0.5, 1}, {0.5, 0.5}};
    for (int i = 0; i < 80; i++) {
        struct tl_work work = work_at(seen[i / 20][0], seen[i / 20][1]);
        double hitch = i % 17 == 16 ? 3 : 1, wobble = 1 + 0.05 * (2 * noise(&seed) - 1);
        tl_cost_learn(&job, &work, 1, hitch * wobble * true_ms(&work));
    }
    const double unseen[][2] = {{0.25, 0.25}, {1, 0.5}, {0.35, 1}, {0.7, 0.25}};
    for (size_t i = 0; i < sizeof unseen / sizeof *unseen; i++) {
        struct tl_work work = work_at(unseen[i][0], unseen[i][1]);
        assert_near(tl_cost_predict(&job, &work, 1) / true_ms(&work), 1, 0.1);
        assert_near(tl_cost_predict(&job, &work, 2), 2 * tl_cost_predict(&job, &work, 1), 1e-12);
    }
}

/* The table is believed until something ran; then its scale is not, its ratios are. */
static void one_level_tells_the_machine(void **state)
{
    (void)state;
    struct tl_cost_job job = {0};
    struct tl_work whole = work_at(1, 1), half = work_at(0.5, 1), nothing = {{0}};
    assert_near(tl_cost_predict(&job, &whole, 1), 66, 1e-12);
    assert_true(isnan(tl_cost_predict(&job, &nothing, 1)));
    tl_cost_learn(&job, &whole, 1, 500); /* the first run makes what is made once */
    for (int i = 0; i < 5; i++)
        tl_cost_learn(&job, &whole, 1, 3 * 66);
    assert_near(tl_cost_predict(&job, &whole, 1), 3 * 66, 3);
    assert_near(tl_cost_predict(&job, &half, 1), 3 * 36, 0.1 * 3 * 36);

    int runs = job.runs;
    tl_cost_learn(&job, &whole, 1, (double)NAN);
    tl_cost_learn(&job, &whole, 1, -1);
    assert_int_equal(job.runs, runs);

    struct tl_cost_job plain = {0}; /* always the same work, of which the table says nothing */
    for (int i = 0; i < 5; i++)
        tl_cost_learn(&plain, &nothing, 1, 7);
    assert_near(tl_cost_predict(&plain, &nothing, 1), 7, 0.2);
}

/* A permanent change of cost is learned, and the former cost is forgotten. */
static void a_change_is_followed(void **state)
{
    (void)state;
    struct tl_cost_job job = {0};
    struct tl_work work = work_at(1, 1);
    for (int i = 0; i < 400; i++)
        tl_cost_learn(&job, &work, 1, 20);
    for (int i = 0; i < 60; i++)
        tl_cost_learn(&job, &work, 1, 30);
    assert_near(tl_cost_predict(&job, &work, 1), 30, 3);
}

/* The machine takes `factor` times as long as it should. */
static void follow(struct tl_machine_load *load, double factor)
{
    tl_machine_load_follow(load, 10 * tl_machine_load_factor(load), 10 * factor);
}

static void a_load_comes_fast_and_goes_slower(void **state)
{
    (void)state;
    struct tl_machine_load load = {0};
    int frames = 0;
    for (; tl_machine_load_factor(&load) < 1.8 && frames < 100; frames++)
        follow(&load, 2);
    assert_in_range(frames, 2, 5);
    for (int i = 0; i < 100; i++)
        follow(&load, 2);
    assert_near(tl_machine_load_factor(&load), 2, 0.15);
    for (frames = 0; tl_machine_load_factor(&load) > 1.1 && frames < 200; frames++)
        follow(&load, 1);
    assert_in_range(frames, 6, 40);
}

static void what_says_nothing_is_no_load(void **state)
{
    (void)state;
    struct tl_machine_load load = {0};
    tl_machine_load_follow(&load, 0, 10);
    assert_near(tl_machine_load_factor(&load), 1, 0);
    tl_machine_load_follow(&load, 10, (double)NAN);
    assert_near(tl_machine_load_factor(&load), 1, 0);
    for (int i = 0; i < 5; i++) { /* hitches of single frames */
        follow(&load, 3);
        assert_near(tl_machine_load_factor(&load), 1, 0);
        follow(&load, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unseen_levels_are_foretold),   cmocka_unit_test(one_level_tells_the_machine),
        cmocka_unit_test(a_change_is_followed),         cmocka_unit_test(a_load_comes_fast_and_goes_slower),
        cmocka_unit_test(what_says_nothing_is_no_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
