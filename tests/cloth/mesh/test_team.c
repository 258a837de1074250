/* The team: every element once, barriers in order, work after sleep, and callers that come at once. */
#include "cloth/mesh/team.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <omp.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define MAX_THREADS 8
#define VERTICES    (MAX_THREADS * TL_VERTICES_PER_THREAD)
#define COUNT       1003 /* elements: no multiple of anything */
#define UNIT        8
#define ROUNDS      500
#define MAX_S       60 /* for which a team is waited for: beside other processes the caller works alone */

struct counted {
    atomic_int visits[COUNT];
    atomic_int members;    /* threads that took part */
    atomic_size_t longest; /* range of a team's first thread */
};

static void visit(void *context)
{
    struct counted *counted = context;
    struct tl_range range = tl_team_range(COUNT, UNIT);
    assert_true(range.from % UNIT == 0 && (range.to % UNIT == 0 || range.to == COUNT));
    for (size_t i = range.from; i < range.to; i++)
        atomic_fetch_add(&counted->visits[i], 1);
    atomic_fetch_add(&counted->members, 1);
    if (tl_team_thread() == 0)
        counted->longest = range.to - range.from;
}

static void assert_visited(const struct counted *counted, int times)
{
    for (size_t i = 0; i < COUNT; i++)
        assert_int_equal(counted->visits[i], times);
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Runs works until one has had so many threads. */
static void run_with_all(int threads, size_t vertex_count, struct counted *counted)
{
    int works = 0, before = 0;
    const double end_s = now_s() + MAX_S;
    for (; now_s() < end_s && counted->members - before != threads; works++) {
        before = counted->members;
        tl_team_run(vertex_count, visit, counted);
        assert_true(counted->members - before == threads || counted->members - before == 1);
    }
    assert_visited(counted, works);
    assert_int_equal(counted->members - before, threads);
}

static void test_ranges(void **state)
{
    (void)state;
    const int threads[] = {1, 2, 3, MAX_THREADS, 2};
    int before = omp_get_max_threads();
    for (size_t t = 0; t < TL_COUNT(threads); t++) {
        struct counted counted = {0};
        omp_set_num_threads(threads[t]);
        assert_int_equal(tl_team_size(VERTICES), threads[t]);
        run_with_all(threads[t], VERTICES, &counted);
        assert_true(counted.longest <= (size_t)(COUNT / threads[t]) + UNIT);
    }
    omp_set_num_threads(before);
}

/* A thread for so many vertices each. */
static void test_small_cloth(void **state)
{
    (void)state;
    int before = omp_get_max_threads();
    omp_set_num_threads(MAX_THREADS);
    assert_int_equal(tl_team_size(0), 1);
    assert_int_equal(tl_team_size(2 * TL_VERTICES_PER_THREAD - 1), 1);
    assert_int_equal(tl_team_size(3 * TL_VERTICES_PER_THREAD), 3);
    struct counted counted = {0};
    run_with_all(3, 3 * TL_VERTICES_PER_THREAD, &counted);
    omp_set_num_threads(before);
}

/* Each round reads what another thread wrote in the round before: without a barrier between, some thread
 * would read an old number, or one too new. */
struct rounds {
    int numbers[2][MAX_THREADS]; /* [round % 2] */
    atomic_int members, wrong;
};

static void pass_on(void *context)
{
    struct rounds *rounds = context;
    atomic_fetch_add(&rounds->members, 1);
    tl_team_barrier();
    size_t me = tl_team_thread(), next = (me + 1) % (size_t)rounds->members;
    for (int round = 1; round <= ROUNDS; round++) {
        rounds->numbers[round % 2][me] = round;
        tl_team_barrier();
        if (rounds->numbers[round % 2][next] != round)
            atomic_fetch_add(&rounds->wrong, 1);
    }
}

static void test_barriers(void **state)
{
    (void)state;
    int before = omp_get_max_threads();
    for (int threads = 1; threads <= 4; threads++) {
        struct rounds rounds = {0};
        const double end_s = now_s() + MAX_S;
        omp_set_num_threads(threads);
        for (int together = 0; now_s() < end_s && together < 5;) {
            rounds.members = 0;
            tl_team_run(VERTICES, pass_on, &rounds);
            together += rounds.members == threads;
        }
        assert_int_equal(rounds.wrong, 0);
        assert_int_equal(rounds.members, threads);
    }
    omp_set_num_threads(before);
}

/* Works that follow at once, after a moment, and after the threads have gone to sleep. */
static void test_sleep(void **state)
{
    (void)state;
    const unsigned pauses_us[] = {0, 50, 200, 300, 5000};
    struct counted counted = {0};
    int before = omp_get_max_threads(), works = 0;
    omp_set_num_threads(3);
    for (size_t i = 0; i < TL_COUNT(pauses_us); i++)
        for (int k = 0; k < 50; k++, works++) {
            tl_team_run(VERTICES, visit, &counted);
            if (pauses_us[i] > 0)
                usleep(pauses_us[i]);
        }
    assert_visited(&counted, works);
    omp_set_num_threads(before);
}

/* A thread that is late, as one is whose core another process has. */
static void be_late(void *context)
{
    atomic_int *members = context;
    atomic_fetch_add(members, 1);
    if (tl_team_thread() == 1)
        usleep(50000);
}

/* After a stall the caller works alone, and the team comes back. */
static void test_stall(void **state)
{
    (void)state;
    int before = omp_get_max_threads();
    atomic_int members = 0;
    omp_set_num_threads(2);
    for (double end_s = now_s() + MAX_S; now_s() < end_s && members != 2;) {
        members = 0;
        tl_team_run(VERTICES, be_late, &members);
    }
    assert_int_equal(members, 2);
    struct counted counted = {0};
    tl_team_run(VERTICES, visit, &counted);
    assert_int_equal(counted.members, 1);
    memset(&counted, 0, sizeof counted);
    run_with_all(2, VERTICES, &counted);
    omp_set_num_threads(before);
}

/* ---- Callers at once ---- */

static void visit_within(void *context)
{
    struct counted *counted = context;
    tl_team_run(VERTICES, visit, counted);
}

/* Work that is begun within work is done by each thread alone, and its place in the team comes back. */
static void test_within(void **state)
{
    (void)state;
    struct counted counted = {0};
    int before = omp_get_max_threads();
    omp_set_num_threads(2);
    for (double end_s = now_s() + MAX_S; now_s() < end_s && counted.members < 2;) {
        memset(&counted, 0, sizeof counted);
        tl_team_run(VERTICES, visit_within, &counted);
    }
    assert_visited(&counted, 2);
    assert_int_equal(tl_team_thread(), 0);
    assert_int_equal(tl_team_range(COUNT, 1).to, COUNT);
    omp_set_num_threads(before);
}

static void *call_often(void *context)
{
    for (int k = 0; k < ROUNDS; k++)
        tl_team_run(VERTICES, visit, context);
    return NULL;
}

static void test_two_callers(void **state)
{
    (void)state;
    static struct counted counted[2];
    pthread_t other;
    int before = omp_get_max_threads();
    omp_set_num_threads(2);
    assert_int_equal(pthread_create(&other, NULL, call_often, &counted[1]), 0);
    call_often(&counted[0]);
    pthread_join(other, NULL);
    for (int caller = 0; caller < 2; caller++)
        assert_visited(&counted[caller], ROUNDS);
    omp_set_num_threads(before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ranges), cmocka_unit_test(test_small_cloth), cmocka_unit_test(test_barriers),
        cmocka_unit_test(test_sleep),  cmocka_unit_test(test_within),      cmocka_unit_test(test_two_callers),
        cmocka_unit_test(test_stall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
