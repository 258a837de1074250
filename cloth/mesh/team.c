#include "cloth/mesh/team.h"

#include "cloth/mesh/denormals.h"

#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <time.h>

#define MOST_THREADS 64
/* Looks at what is waited for, before the core is offered to others: about 5 us. */
#define SPINS 100
/* Offers of the core before a thread without work sleeps: about 0.2 ms if no other process uses them. */
#define YIELDS 400

/* A process that does not yield may use the cores too. At each barrier, a thread of the team can then wait
 * for a time slice: beside two such processes, frames of 66 ms on one thread needed 1 s on two. So a wait
 * longer than PATIENCE is a stall. After it the caller works on one thread for FIRST_ALONE, and for twice as
 * long after each further stall, until the team has worked for CALM without one. */
#define PATIENCE_NS        1000000
#define PATIENCE_VERTEX_NS 50 /* more for each vertex: threads of a large work end less evenly */
#define FIRST_ALONE_NS     10000000
#define MOST_ALONE_NS      2000000000
#define CALM_NS            50000000

/* One number identifies the present work, so that threads that have no part in it need not read the rest,
 * which the next work may be changing: how many works there were before, and how many threads it has. */
#define THREADS_BITS 8
#define THREADS_MASK ((1u << THREADS_BITS) - 1)
_Static_assert(MOST_THREADS <= THREADS_MASK, "a work's number holds its threads");

static struct {
    pthread_mutex_t taken; /* by the caller that has the team */
    size_t made;           /* threads made so far, without the caller's */
    void (*work)(void *context);
    void *context;
    _Atomic uint64_t number;          /* of the present work */
    _Atomic unsigned arrived, passed; /* at the barrier; barriers so far */
    pthread_mutex_t bed;              /* what sleepers wait on */
    pthread_cond_t woken;
    _Atomic unsigned sleepers;
    _Atomic int64_t patience_ns;           /* of the present work */
    atomic_bool stalled;                   /* in the present work */
    int64_t alone_until_ns, next_alone_ns; /* after the last stall; for how long after the next one */
    int64_t calm_since_ns;
} team = {.next_alone_ns = FIRST_ALONE_NS,
          .taken = PTHREAD_MUTEX_INITIALIZER,
          .bed = PTHREAD_MUTEX_INITIALIZER,
          .woken = PTHREAD_COND_INITIALIZER};

/* The calling thread's place in the work that it does. */
static _Thread_local struct {
    size_t thread, threads;
} mine = {0, 1};

static void pause_or_yield(unsigned polls)
{
    if (polls >= SPINS)
        sched_yield();
#if defined __x86_64__ || defined __i386__
    else
        __builtin_ia32_pause();
#endif
}

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void wait_for_others(unsigned before)
{
    int64_t began_ns = 0;
    for (unsigned polls = 0; atomic_load_explicit(&team.passed, memory_order_acquire) == before; polls++) {
        pause_or_yield(polls);
        if (polls == SPINS)
            began_ns = now_ns();
        else if (polls > SPINS && now_ns() - began_ns > team.patience_ns)
            atomic_store(&team.stalled, true);
    }
}

void tl_team_barrier(void)
{
    if (mine.threads == 1)
        return;
    unsigned before = atomic_load(&team.passed);
    if (atomic_fetch_add(&team.arrived, 1) + 1 == mine.threads) {
        atomic_store(&team.arrived, 0);
        atomic_store(&team.passed, before + 1);
        return;
    }
    wait_for_others(before);
}

static void sleep_until_other(uint64_t number)
{
    pthread_mutex_lock(&team.bed);
    atomic_fetch_add(&team.sleepers, 1);
    while (atomic_load(&team.number) == number)
        pthread_cond_wait(&team.woken, &team.bed);
    atomic_fetch_sub(&team.sleepers, 1);
    pthread_mutex_unlock(&team.bed);
}

static uint64_t wait_for_other(uint64_t number)
{
    for (unsigned polls = 0; polls < SPINS + YIELDS; polls++) {
        uint64_t now = atomic_load_explicit(&team.number, memory_order_acquire);
        if (now != number)
            return now;
        pause_or_yield(polls);
    }
    sleep_until_other(number);
    return atomic_load(&team.number);
}

static void *serve(void *argument)
{
    uint64_t number = 0;
    (void)tl_denormals_off();
    const size_t thread = (size_t)(uintptr_t)argument;
    for (;;) {
        number = wait_for_other(number);
        mine.thread = thread;
        mine.threads = number & THREADS_MASK;
        if (thread >= mine.threads)
            continue;
        team.work(team.context);
        tl_team_barrier();
    }
    return NULL;
}

/* Makes the threads that are missing; returns how many there are, the caller's included. */
static size_t make_threads(size_t wanted)
{
    pthread_attr_t attributes;
    if (team.made + 1 < wanted && pthread_attr_init(&attributes) == 0) {
        pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
        pthread_t thread;
        while (team.made + 1 < wanted &&
               pthread_create(&thread, &attributes, serve, (void *)(uintptr_t)(team.made + 1)) == 0)
            team.made++;
        pthread_attr_destroy(&attributes);
    }
    return team.made + 1 < wanted ? team.made + 1 : wanted;
}

/* Decides after a work of the team how the next ones are done. */
static void note_stall(void)
{
    if (atomic_exchange(&team.stalled, false)) {
        team.alone_until_ns = team.calm_since_ns = now_ns() + team.next_alone_ns;
        team.next_alone_ns = 2 * team.next_alone_ns < MOST_ALONE_NS ? 2 * team.next_alone_ns : MOST_ALONE_NS;
    } else if (team.next_alone_ns > FIRST_ALONE_NS && now_ns() - team.calm_since_ns > CALM_NS)
        team.next_alone_ns = FIRST_ALONE_NS;
}

static void begin(size_t threads, void (*work)(void *context), void *context)
{
    uint64_t works = atomic_load(&team.number) >> THREADS_BITS;
    team.work = work;
    team.context = context;
    atomic_store(&team.number, (works + 1) << THREADS_BITS | threads);
    if (atomic_load(&team.sleepers) == 0)
        return;
    pthread_mutex_lock(&team.bed);
    pthread_cond_broadcast(&team.woken);
    pthread_mutex_unlock(&team.bed);
}

size_t tl_team_size(size_t vertex_count)
{
    size_t most = (size_t)omp_get_max_threads(), wanted = vertex_count / TL_VERTICES_PER_THREAD;
    most = most < MOST_THREADS ? most : MOST_THREADS;
    wanted = wanted < most ? wanted : most;
    return wanted > 1 && !omp_in_parallel() && mine.threads == 1 ? wanted : 1;
}

void tl_team_run(size_t vertex_count, void (*work)(void *context), void *context)
{
    size_t wanted = tl_team_size(vertex_count);
    bool has_team = wanted > 1 && pthread_mutex_trylock(&team.taken) == 0;
    bool alone = has_team && team.alone_until_ns > 0 && now_ns() < team.alone_until_ns;
    size_t threads = has_team && !alone ? make_threads(wanted) : 1;
    if (threads > 1) {
        team.patience_ns = PATIENCE_NS + PATIENCE_VERTEX_NS * (int64_t)vertex_count;
        begin(threads, work, context);
    }
    const size_t thread = mine.thread, of = mine.threads;
    mine.thread = 0;
    mine.threads = threads;
    unsigned denormals = tl_denormals_off();
    work(context);
    tl_team_barrier();
    tl_denormals_restore(denormals);
    mine.thread = thread;
    mine.threads = of;
    if (threads > 1)
        note_stall();
    if (has_team)
        pthread_mutex_unlock(&team.taken);
}

size_t tl_team_thread(void)
{
    return mine.thread;
}

struct tl_range tl_team_range(size_t count, size_t unit)
{
    size_t units = (count + unit - 1) / unit;
    size_t from = mine.thread * units / mine.threads * unit,
           to = (mine.thread + 1) * units / mine.threads * unit;
    return (struct tl_range){from < count ? from : count, to < count ? to : count};
}
