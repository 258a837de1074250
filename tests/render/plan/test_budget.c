#include "render/plan/budget.h"
#include "render/plan/cost.h"

#include "tests/testing.h"

#include <string.h>

/* A fixed sequence of numbers in [0, 1) [PCG's output step; any would do]. */
static double noise(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (double)((word >> 22) ^ word) / 4294967296.0;
}

/* A model of a frame: a fixed cost, and for each control a part of the cost that its levels scale. The search
 * must work for any table, so costs need not be additive: controls multiply one another's, as samples and
 * regions do. */
struct table {
    int controls;
    double fixed, part[TL_BUDGET_CONTROLS_MAX], left[TL_BUDGET_CONTROLS_MAX][TL_BUDGET_LEVELS_MAX];
    double error[TL_BUDGET_CONTROLS_MAX][TL_BUDGET_LEVELS_MAX];
    double factor; /* on all of it: the machine's */
    double change; /* of the first control's level, ms */
    const uint8_t *now;
};

static double table_cost(const void *context, const uint8_t *levels)
{
    const struct table *table = context;
    double sum = table->fixed, product = 1;
    for (int k = 0; k < table->controls; k++) {
        product *= table->left[k][levels[k]];
        sum += table->part[k] * product;
    }
    return table->factor * sum;
}

static double table_change(const void *context, const uint8_t *levels)
{
    const struct table *table = context;
    return levels[0] != table->now[0] ? table->change : 0;
}

static double table_error(const void *context, const uint8_t *levels)
{
    const struct table *table = context;
    double square = 0;
    for (int k = 0; k < table->controls; k++)
        square += pow(table->error[k][levels[k]], 2);
    return sqrt(square);
}

static struct tl_budget make_budget(struct table *table, int controls, uint32_t seed)
{
    struct tl_budget budget = {.control_count = controls,
                               .cost = table_cost,
                               .change = table_change,
                               .error = table_error,
                               .context = table};
    static const uint8_t any[TL_BUDGET_CONTROLS_MAX];
    *table = (struct table){.controls = controls, .fixed = 5 * noise(&seed), .factor = 1, .now = any};
    for (int k = 0; k < controls; k++) {
        table->part[k] = 10 + 40 * noise(&seed);
        table->left[k][0] = 1;
        budget.level_counts[k] = 1 + (int)(4 * noise(&seed)) + k;
        for (int level = 1; level < budget.level_counts[k]; level++) {
            table->left[k][level] = table->left[k][level - 1] * (0.5 + 0.45 * noise(&seed));
            table->error[k][level] = table->error[k][level - 1] + 0.001 + 0.02 * noise(&seed);
        }
    }
    return budget;
}

/* The definition, level by level: the least error of all within the limit, and the least cost of all. */
static void search(const struct tl_budget *budget, int control, double limit, uint8_t *levels, double *error,
                   double *cost)
{
    if (control < budget->control_count) {
        for (int level = 0; level < budget->level_counts[control]; level++) {
            levels[control] = (uint8_t)level;
            search(budget, control + 1, limit, levels, error, cost);
        }
        return;
    }
    double ms = budget->cost(budget->context, levels);
    if (ms <= limit)
        *error = fmin(*error, budget->error(budget->context, levels));
    *cost = fmin(*cost, ms);
}

static void the_best_of_all_is_found(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 40; seed++) {
        struct table table;
        struct tl_budget budget = make_budget(&table, 1 + (int)(seed % 4), seed);
        for (int step = 0; step < 18; step++) {
            double limit = 2 * pow(1.3, step); /* up to 173 */
            uint8_t found[TL_BUDGET_CONTROLS_MAX], tried[TL_BUDGET_CONTROLS_MAX] = {0};
            double error = INFINITY, cost = INFINITY;
            search(&budget, 0, 0, tried, &error, &cost);
            double allowed = fmax(limit, TL_BUDGET_SLACK * cost);
            search(&budget, 0, allowed, tried, &error, &cost);
            bool fits = tl_budget_best(&budget, limit, INFINITY, found);
            assert_int_equal(fits, cost <= limit);
            assert_true(table_cost(&table, found) <= allowed);
            assert_near(table_error(&table, found), error, 1e-15);
        }
    }
}

static void more_budget_never_errs_more(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 40; seed++) {
        struct table table;
        struct tl_budget budget = make_budget(&table, 4, seed);
        double before = INFINITY;
        for (int step = 0; step < 103; step++) { /* and, the same, dearer frames never err less */
            double limit = 2 * pow(1.05, step);  /* up to 290 */
            uint8_t found[TL_BUDGET_CONTROLS_MAX];
            if (!tl_budget_best(&budget, limit, INFINITY, found))
                continue;
            double error = table_error(&table, found);
            assert_true(error <= before);
            before = error;
        }
        assert_near(before, 0, 0); /* there is a budget for everything */
    }
}

/* Five hundred frames and more of a governor that is told what the frame cost, with a load that is learned
 * late. */
struct run {
    double budget, deviation;     /* of the noise, relative, even within +- sqrt(3) of it */
    int spike_begins, spike_ends; /* frames at twice the cost */
    int frames, changes, first_change, late_changes, over, over_late, back;
    double error_before, shortest_wait;
};

static void run_frames(struct run *run, struct table *table, const struct tl_budget *budget)
{
    const int settled = 60, absorbed = 10;
    struct tl_governor governor = {0};
    uint32_t seed = 7;
    struct tl_machine_load load = {0};
    double waited = INFINITY;
    run->shortest_wait = INFINITY;
    for (int frame = 0; frame < run->frames; frame++) {
        bool spike = frame >= run->spike_begins && frame < run->spike_ends;
        table->factor = tl_machine_load_factor(&load);
        uint8_t before[TL_BUDGET_CONTROLS_MAX];
        memcpy(before, governor.levels, sizeof before);
        enum tl_governed how = tl_governor_choose(&governor, budget, run->budget);
        double predicted = table_cost(table, governor.levels);
        table->factor = (spike ? 2 : 1) * (1 + run->deviation * sqrt(3) * (2 * noise(&seed) - 1));
        double took = table_cost(table, governor.levels);
        tl_governor_learn(&governor, run->budget, took);
        tl_machine_load_follow(&load, predicted, took);

        waited = how == TL_GOVERNED_KEPT ? waited + 1 : 0;
        if (how == TL_GOVERNED_UP) {
            run->shortest_wait = fmin(run->shortest_wait, waited);
        }
        run->changes += how != TL_GOVERNED_KEPT;
        run->late_changes += frame > settled && how != TL_GOVERNED_KEPT;
        bool is_over = took > 1.1 * run->budget;
        run->over += frame >= 30 && is_over; /* after the first second */
        run->over_late += is_over && frame >= run->spike_begins + absorbed && frame < run->spike_ends;
        if (frame == run->spike_begins - 1)
            run->error_before = table_error(table, governor.levels);
        if (frame >= run->spike_ends && run->back == 0 &&
            table_error(table, governor.levels) <= 1.1 * run->error_before)
            run->back = frame - run->spike_ends + 1;
    }
}

static void noise_makes_no_pumping(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++)
        for (int step = 0; step < 5; step++) {
            double budget_ms = 30 * pow(1.4, step); /* up to 115 */
            struct table table;
            struct tl_budget budget = make_budget(&table, 4, seed);
            struct run run = {.budget = budget_ms, .deviation = 0.05, .frames = 630, .spike_begins = 10000};
            run_frames(&run, &table, &budget);
            table.factor = 1.2; /* a plan within the budget, with room for the noise, exists */
            uint8_t found[TL_BUDGET_CONTROLS_MAX];
            if (!tl_budget_best(&budget, budget_ms, INFINITY, found))
                continue;
            assert_in_range(run.over, 0, 6);         /* 99 of 100 frames */
            assert_in_range(run.late_changes, 0, 6); /* one in a hundred frames */
        }
}

static void a_spike_is_absorbed_and_given_back(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++) {
        struct table table;
        struct tl_budget budget = make_budget(&table, 4, seed);
        struct run run = {
            .budget = 60, .deviation = 0.03, .frames = 630, .spike_begins = 200, .spike_ends = 350};
        run_frames(&run, &table, &budget);
        table.factor = 2.3;
        uint8_t found[TL_BUDGET_CONTROLS_MAX];
        if (!tl_budget_best(&budget, run.budget, INFINITY, found))
            continue;
        assert_in_range(run.over_late, 0, 1);
        assert_in_range(run.back, 1, 60);
        assert_true(run.error_before < INFINITY);
    }
}

/* Down at once; up by a margin, and after eight frames at least once the governor is not new. */
static void steps_down_do_not_wait(void **state)
{
    (void)state;
    struct table table;
    struct tl_budget budget = make_budget(&table, 4, 3);
    struct tl_governor governor = {0};
    const uint8_t best[TL_BUDGET_CONTROLS_MAX] = {0};
    double whole_ms = table_cost(&table, best), budget_ms = 1.2 * whole_ms;
    for (int frame = 0; frame < 12; frame++)
        tl_governor_choose(&governor, &budget, budget_ms);
    assert_near(table_error(&table, governor.levels), 0, 0);

    table.factor = 2;
    assert_int_equal(tl_governor_choose(&governor, &budget, budget_ms), TL_GOVERNED_DOWN);
    assert_true(table_cost(&table, governor.levels) <= budget_ms);

    table.factor = 1;
    int waited = 1;
    while (tl_governor_choose(&governor, &budget, budget_ms) == TL_GOVERNED_KEPT && waited < 100)
        waited++;
    assert_in_range(waited, 8, 40);
    assert_near(table_error(&table, governor.levels), 0, 0);

    /* The removal of a control's levels takes effect at once. */
    governor.levels[3] = (uint8_t)(budget.level_counts[3] - 1);
    budget.level_counts[3] = 1;
    tl_governor_choose(&governor, &budget, budget_ms);
    assert_int_equal(governor.levels[3], 0);
}

/* A change that alone makes a frame late is not made to reduce the error, but is made when the present levels
 * exceed the budget. */
static void a_dear_change_waits(void **state)
{
    (void)state;
    struct table table = {
        .controls = 1, .part = {40}, .left = {{1, 0.5}}, .error = {{0, 0.1}}, .factor = 1, .change = 20};
    struct tl_budget budget = {.control_count = 1,
                               .level_counts = {2},
                               .cost = table_cost,
                               .change = table_change,
                               .error = table_error,
                               .context = &table};
    struct tl_governor governor = {0};
    table.now = governor.levels;
    const double budget_ms = 50;
    tl_governor_choose(&governor, &budget, budget_ms);
    assert_int_equal(governor.levels[0], 0);
    table.factor = 2;
    assert_int_equal(tl_governor_choose(&governor, &budget, budget_ms), TL_GOVERNED_DOWN);
    table.factor = 1;
    for (int frame = 0; frame < 100; frame++)
        assert_int_equal(tl_governor_choose(&governor, &budget, budget_ms), TL_GOVERNED_KEPT);
    table.change = 10;
    assert_int_equal(tl_governor_choose(&governor, &budget, budget_ms), TL_GOVERNED_UP);
}

/* Others' work takes 9.5 ms of every 95th frame: more than one in a hundred would be late, were they not
 * thought of from the start, and again when the budget changes. */
static void what_is_not_foreseen_has_room(void **state)
{
    (void)state;
    const uint8_t any[TL_BUDGET_CONTROLS_MAX] = {0};
    struct table table = {.controls = 1, .part = {100}, .factor = 1, .now = any};
    struct tl_budget budget = {.control_count = 1,
                               .level_counts = {TL_BUDGET_LEVELS_MAX},
                               .cost = table_cost,
                               .change = table_change,
                               .error = table_error,
                               .context = &table};
    for (int level = 0; level < TL_BUDGET_LEVELS_MAX; level++) {
        table.left[0][level] = pow(0.88, level);
        table.error[0][level] = 0.01 * level;
    }
    struct tl_governor governor = {0};
    for (int frame = 0; frame < 1200; frame++) {
        double budget_ms = frame < 600 ? 100 : 33;
        tl_governor_choose(&governor, &budget, budget_ms);
        double took = table_cost(&table, governor.levels) + (frame % 95 == 94 ? 9.5 : 0);
        assert_true(took <= 1.1 * budget_ms);
        tl_governor_learn(&governor, budget_ms, took);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_of_all_is_found),      cmocka_unit_test(more_budget_never_errs_more),
        cmocka_unit_test(noise_makes_no_pumping),        cmocka_unit_test(a_spike_is_absorbed_and_given_back),
        cmocka_unit_test(steps_down_do_not_wait),        cmocka_unit_test(a_dear_change_waits),
        cmocka_unit_test(what_is_not_foreseen_has_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
