#include "render/plan/plan.h"

#include "tests/testing.h"

#include <string.h>

/* A renderer in small: inputs of the frame, then what jobs make. */
enum { ENVIRONMENT, SURFACES, CAMERA, REGIONS, PEMS, SLICES, MAPS, IMAGE, CHART };
#define BIT(name) ((tl_bits)1 << (name))
static const char *const resources[] = {"environment", "surfaces", "camera", "regions", "PEMs",
                                        "slices",      "maps",     "image",  "chart"};
enum { GLOSSY, OPEN_SKY };
static const char *const facts[] = {"glossy material", "open sky"};

static const tl_job jobs[] = {
    {"regions", "cut", BIT(ENVIRONMENT), BIT(REGIONS), 0, {"only"}, NULL},
    {"pems", "filter", BIT(ENVIRONMENT) | BIT(REGIONS), BIT(PEMS), 0, {"only"}, NULL},
    {"slices", "glossy slices", BIT(ENVIRONMENT), BIT(SLICES), BIT(GLOSSY), {"only"}, NULL},
    {"maps", "shadow maps", BIT(REGIONS) | BIT(SURFACES), BIT(MAPS), 0, {"128", "256", "512"}, NULL},
    {"light",
     "sum",
     BIT(PEMS) | BIT(SLICES) | BIT(MAPS) | BIT(SURFACES) | BIT(CAMERA),
     BIT(IMAGE),
     0,
     {"only"},
     NULL},
    {"chart", "for people", BIT(IMAGE), BIT(CHART), 0, {"only"}, NULL},
};
#define JOBS ((int)(sizeof jobs / sizeof *jobs))
#define ALL  (BIT(REGIONS) | BIT(PEMS) | BIT(SLICES) | BIT(MAPS) | BIT(IMAGE))

#define R TL_JOB_RUN
#define U TL_JOB_REUSE
#define D TL_JOB_DROP

struct plan_case {
    const char *name;
    tl_bits changed, valid, scene, wanted;
    enum tl_job_action expected[JOBS]; /* regions pems slices maps light chart */
    int reason_of;                     /* a job and its reason in full */
    const char *reason;
};

static const struct plan_case cases[] = {
    {"first frame",
     BIT(ENVIRONMENT) | BIT(SURFACES) | BIT(CAMERA),
     0,
     BIT(GLOSSY),
     BIT(IMAGE),
     {R, R, R, R, R, D},
     1,
     "not made yet: PEMs"},
    {"nothing is shown", BIT(ENVIRONMENT), 0, BIT(GLOSSY), 0, {D, D, D, D, D, D}, 4, "nothing reads image"},
    {"nothing changed", 0, ALL, BIT(GLOSSY), BIT(IMAGE), {U, U, U, U, U, D}, 0, "as before: environment"},
    {"the camera moved", BIT(CAMERA), ALL, BIT(GLOSSY), BIT(IMAGE), {U, U, U, U, R, D}, 4, "changed: camera"},
    {"the cloth moved",
     BIT(SURFACES),
     ALL,
     BIT(GLOSSY),
     BIT(IMAGE),
     {U, U, U, R, R, D},
     4,
     "changed: surfaces, maps"},
    {"the light changed",
     BIT(ENVIRONMENT),
     ALL,
     BIT(GLOSSY),
     BIT(IMAGE),
     {R, R, R, R, R, D},
     3,
     "changed: regions"},
    {"nothing is glossy",
     BIT(ENVIRONMENT),
     ALL & ~BIT(SLICES),
     0,
     BIT(IMAGE),
     {R, R, D, R, R, D},
     2,
     "no glossy material here"},
    {"only maps are read",
     BIT(ENVIRONMENT),
     ALL,
     BIT(GLOSSY),
     BIT(MAPS),
     {R, D, D, R, D, D},
     1,
     "nothing reads PEMs"},
    {"the chart is read", 0, ALL, BIT(GLOSSY), BIT(CHART), {U, U, U, U, U, R}, 5, "not made yet: chart"},
    {"an earlier result was lost",
     0,
     ALL & ~BIT(REGIONS),
     BIT(GLOSSY),
     BIT(IMAGE),
     {R, R, U, R, R, D},
     0,
     "not made yet: regions"},
};

static void plans_follow_the_table(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct plan_case *c = &cases[i];
        struct tl_plan_input input = {c->changed, c->valid, c->scene, c->wanted, facts, resources};
        tl_plan plan;
        tl_plan_make(jobs, JOBS, &input, NULL, &plan);
        assert_int_equal(plan.count, JOBS);
        for (int k = 0; k < JOBS; k++) {
            if (plan.rows[k].action != c->expected[k])
                print_error("%s: %s: %s (%s), expected %s\n", c->name, jobs[k].name,
                            tl_job_action_names[plan.rows[k].action], plan.rows[k].reason,
                            tl_job_action_names[c->expected[k]]);
            assert_int_equal(plan.rows[k].action, c->expected[k]);
            assert_string_equal(plan.rows[k].name, jobs[k].name);
            assert_true(plan.rows[k].reason[0] != '\0');
        }
        assert_string_equal(plan.rows[c->reason_of].reason, c->reason);
    }
}

/* Frames in a row: what was dropped while its input changed is stale when it is wanted again. */
static void stale_results_are_made_again(void **state)
{
    (void)state;
    struct tl_plan_input input = {0, ALL, BIT(GLOSSY), BIT(IMAGE), facts, resources};
    tl_plan plan;

    input.wanted = BIT(REGIONS); /* PEMs, slices, maps and the image go stale, regions do not */
    input.changed = BIT(ENVIRONMENT);
    tl_plan_make(jobs, JOBS, &input, NULL, &plan);
    assert_int_equal(tl_plan_valid_after(jobs, JOBS, &input, &plan), BIT(REGIONS));

    input.valid = tl_plan_valid_after(jobs, JOBS, &input, &plan);
    input.wanted = BIT(IMAGE);
    input.changed = 0;
    tl_plan_make(jobs, JOBS, &input, NULL, &plan);
    assert_int_equal(plan.rows[0].action, TL_JOB_REUSE);
    for (int i = 1; i <= 4; i++)
        assert_int_equal(plan.rows[i].action, TL_JOB_RUN);
    assert_int_equal(tl_plan_valid_after(jobs, JOBS, &input, &plan), ALL);

    input.valid = ALL; /* what the scene does not require goes stale alone */
    input.scene = 0;
    input.changed = BIT(ENVIRONMENT);
    tl_plan_make(jobs, JOBS, &input, NULL, &plan);
    assert_int_equal(tl_plan_valid_after(jobs, JOBS, &input, &plan), ALL & ~BIT(SLICES));
}

static void levels_are_the_most_exact(void **state)
{
    (void)state;
    struct tl_plan_input input = {0, 0, 0, BIT(IMAGE), facts, resources};
    tl_plan plan;
    tl_plan_make(jobs, JOBS, &input, NULL, &plan);
    assert_int_equal(plan.rows[3].level, 2);
    assert_int_equal(plan.rows[4].level, 0);
}

static void predictions_are_of_what_runs(void **state)
{
    (void)state;
    struct tl_plan_input input = {BIT(SURFACES), ALL, BIT(GLOSSY), BIT(IMAGE), facts, resources};
    tl_plan plan;
    const double predicted_ms[JOBS] = {1, 2, 3, 5, (double)NAN, 6};
    tl_plan_make(jobs, JOBS, &input, predicted_ms, &plan);
    assert_near(plan.rows[3].predicted_ms, 5, 0);
    assert_true(isnan(plan.rows[4].predicted_ms)); /* runs, nothing is known */
    assert_near(plan.rows[0].predicted_ms, 0, 0);  /* reused */
    tl_plan_make(jobs, JOBS, &input, NULL, &plan);
    assert_true(isnan(plan.rows[3].predicted_ms));
}

static void tables_out_of_order_are_refused(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_ok(tl_jobs_check(jobs, JOBS, &error), error);
    const tl_job swapped[] = {jobs[1], jobs[0]};
    assert_false(tl_jobs_check(swapped, 2, &error));
    assert_non_null(strstr(error.message, "pems"));
    assert_non_null(strstr(error.message, "regions"));

    /* its own result of the last frame, and a second writer that comes before, are fine */
    const tl_job history[] = {{"accumulate", "", BIT(IMAGE), BIT(IMAGE), 0, {"only"}, NULL}, jobs[4]};
    assert_ok(tl_jobs_check(history, 2, &error), error);
    const tl_job unlevelled[] = {{"bare", "", 0, BIT(IMAGE), 0, {NULL}, NULL}};
    assert_false(tl_jobs_check(unlevelled, 1, &error));
    assert_false(tl_jobs_check(jobs, TL_JOBS_MAX + 1, &error));
}

/* Sixty-four long names do not fit in a reason: it is cut between names and stays whole. */
static void long_reasons_are_cut(void **state)
{
    (void)state;
    const char *names[64];
    for (int i = 0; i < 64; i++)
        names[i] = "a resource of quite some name";
    const tl_job greedy[] = {{"greedy", "", 0x7fffffffffffffff, (tl_bits)1 << 63, 0, {"only"}, NULL}};
    struct tl_plan_input input = {0x7fffffffffffffff, (tl_bits)1 << 63, 0, (tl_bits)1 << 63, NULL, names};
    tl_plan plan;
    tl_plan_make(greedy, 1, &input, NULL, &plan);
    assert_string_equal(plan.rows[0].reason,
                        "changed: a resource of quite some name, a resource of quite some name");
}

/* The last bit of a set has a name, too. */
static void every_bit_is_named(void **state)
{
    enum { LAST = 8 * sizeof(tl_bits) - 1 };
    (void)state;
    const char *names[LAST + 1] = {[LAST] = "the last"};
    const tl_job maker[] = {{"maker", "", 0, BIT(LAST), 0, {"only"}, NULL}};
    const struct tl_plan_input input = {.wanted = BIT(LAST), .resource_names = names};
    tl_plan plan;
    tl_plan_make(maker, 1, &input, NULL, &plan);
    assert_string_equal(plan.rows[0].reason, "not made yet: the last");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plans_follow_the_table),
        cmocka_unit_test(stale_results_are_made_again),
        cmocka_unit_test(levels_are_the_most_exact),
        cmocka_unit_test(predictions_are_of_what_runs),
        cmocka_unit_test(tables_out_of_order_are_refused),
        cmocka_unit_test(long_reasons_are_cut),
        cmocka_unit_test(every_bit_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
