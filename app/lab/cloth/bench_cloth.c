/* How fast cloth is solved: particles times substeps per second of CPU, beside the plain loop's in the same
 * run; normals and tangents; and the built-in dress coming to rest. */
#include "app/lab/cloth/bench_cloth.h"
#include "app/cli/json.h"
#include "app/lab/cloth/plain_loop.h"
#include "app/lab/cloth/worn.h"
#include "app/lab/experiments/closed_form.h"
#include "app/measure/cost.h"
#include "cloth/mesh/topology.h"
#include "cloth/tangents/tangent_frames.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

#define ROUNDS         3 /* the fastest counts: other load on the machine only slows a round down */
#define FRAME_SUBSTEPS 64
#define SIDES_MAX      3
#define THREADS_MAX    2
#define DRESSES_MAX    2
#define PLAIN_LOOP     TL_CLOTH_SOLVER_COUNT /* measured after the solvers */
#define RUN_COUNT      (TL_CLOTH_SOLVER_COUNT + 1)

struct plan {
    int sides[SIDES_MAX], side_count;
    int thread_count;
    double turn_ms; /* CPU time of one measurement */
    int dresses[DRESSES_MAX], dress_count;
    bool slow_dress; /* the reference solver too */
};
static const struct plan quick_plan = {{32}, 1, 1, 30, {1000}, 1, false};
static const struct plan plain_plan = {{32, 100, 316}, 3, 2, 400, {10000}, 1, false};
static const struct plan full_plan = {{32, 100, 316}, 3, 2, 400, {10000, 100000}, 2, true};

/* Particle-steps per second. */
struct rate {
    double cpu; /* of one core */
    double wall;
};

struct dress_run {
    int wanted, solver;
    size_t particles;
    struct tl_taken taken;
    bool done, settled;
    tl_error refusal;
};

struct cloth_bench {
    struct plan plan;
    struct rate rates[SIDES_MAX][THREADS_MAX][RUN_COUNT]; /* NaN: refused */
    double frames_ms[SIDES_MAX];
    struct dress_run dresses[DRESSES_MAX * TL_CLOTH_SOLVER_COUNT];
    size_t dress_count;
};

static const char *run_name(int variant)
{
    return variant == PLAIN_LOOP ? "plain loop" : tl_cloth_solver_names[variant];
}

/* ---- Sheets ---- */

static tl_cloth *make_cloth(const tl_garment *garment, int solver, tl_error *error)
{
    struct tl_cloth_fabric fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults;
    struct tl_cloth_params params = *(const struct tl_cloth_params *)tl_cloth_options.defaults;
    params.solver = solver;
    params.frame_rate = 1 / params.dt;
    tl_cloth *cloth = tl_cloth_create(garment, &fabric, &params, error);
    if (!cloth)
        return NULL;
    /* A frame has the same number of substeps for all, so that work done once a frame has equal weight. */
    double substep_s = tl_cloth_measure(cloth, NULL).substep_s;
    params.frame_rate = fmin(fmax(1 / (FRAME_SUBSTEPS * substep_s), params.frame_rate), 1000);
    if (tl_cloth_set(cloth, &fabric, &params, error))
        return cloth;
    tl_cloth_destroy(&cloth);
    return NULL;
}

static double frame_seconds(const tl_cloth *cloth)
{
    return tl_cloth_measure(cloth, NULL).time_s;
}

/* Steps until the turn is over. */
static bool run_cloth(tl_cloth *cloth, double turn_ms, struct rate *out, tl_error *error)
{
    struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    double before_s = frame_seconds(cloth), steps;
    struct tl_stopwatch watch = tl_stopwatch_start();
    struct tl_taken taken;
    do {
        if (!tl_cloth_step(cloth, NULL, error))
            return false;
        taken = tl_stopwatch_read(&watch);
    } while (taken.cpu_ms < turn_ms);
    steps = (double)report.vertex_count * (frame_seconds(cloth) - before_s) / report.substep_s;
    out->cpu = fmax(out->cpu, 1e3 * steps / taken.cpu_ms);
    out->wall = fmax(out->wall, 1e3 * steps / taken.wall_ms);
    return true;
}

static bool run_plain_loop(tl_plain_loop *loop, int side, double turn_ms, struct rate *out, tl_error *error)
{
    double steps = 0;
    struct tl_stopwatch watch = tl_stopwatch_start();
    struct tl_taken taken;
    do {
        for (int i = 0; i < FRAME_SUBSTEPS; i++)
            tl_plain_loop_step(loop);
        steps += FRAME_SUBSTEPS * (double)side * side;
        taken = tl_stopwatch_read(&watch);
    } while (taken.cpu_ms < turn_ms);
    if (!(tl_plain_loop_stretch(loop) < 2)) /* the result is used, so that the compiler keeps the loop */
        return tl_fail(error, TL_UNSTABLE, "bench: the plain loop stretched by %g",
                       tl_plain_loop_stretch(loop));
    out->cpu = fmax(out->cpu, 1e3 * steps / taken.cpu_ms);
    out->wall = fmax(out->wall, 1e3 * steps / taken.wall_ms);
    return true;
}

/* Runs all solvers in turn, round after round, so that other load on the machine affects all alike. */
static bool run_sheet(struct cloth_bench *bench, int size, int threads, tl_error *error)
{
    int side = bench->plan.sides[size];
    double turn_ms = bench->plan.turn_ms;
    struct rate *rates = bench->rates[size][threads - 1];
    tl_garment sheet = tl_sheet_make(side, TL_SHEET_EDGE, false);
    tl_cloth *cloths[TL_CLOTH_SOLVER_COUNT] = {0};
    tl_plain_loop *loop = tl_plain_loop_create(side);
    bool done = true;
    omp_set_num_threads(threads);
    for (int s = 0; done && s < TL_CLOTH_SOLVER_COUNT; s++)
        done = (cloths[s] = make_cloth(&sheet, s, error)) != NULL;
    for (int round = 0; done && round < ROUNDS; round++) {
        for (int s = 0; done && s < TL_CLOTH_SOLVER_COUNT; s++)
            done = run_cloth(cloths[s], turn_ms, &rates[s], error);
        done = done && run_plain_loop(loop, side, turn_ms, &rates[PLAIN_LOOP], error);
    }
    for (int s = 0; s < TL_CLOTH_SOLVER_COUNT; s++)
        tl_cloth_destroy(&cloths[s]);
    tl_plain_loop_destroy(&loop);
    tl_garment_release(&sheet);
    return done;
}

static void run_frames(struct cloth_bench *bench, int size)
{
    tl_garment sheet = tl_sheet_make(bench->plan.sides[size], TL_SHEET_FREE, false);
    const tl_mesh *mesh = &sheet.model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    vec3s *normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    vec4s *tangents = TL_NEW_ARRAY(vec4s, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    tl_tangent_frames *frames = tl_tangent_frames_create(mesh, weld);
    double best = INFINITY, spent = 0;
    omp_set_num_threads(1);
    while (spent < ROUNDS * bench->plan.turn_ms) {
        struct tl_stopwatch watch = tl_stopwatch_start();
        tl_tangent_frames_update(frames, mesh->positions, normals, tangents);
        double taken = tl_stopwatch_read(&watch).cpu_ms;
        best = fmin(best, taken);
        spent += taken;
    }
    bench->frames_ms[size] = best;
    tl_tangent_frames_destroy(&frames);
    free(weld);
    free(normals);
    free(tangents);
    tl_garment_release(&sheet);
}

/* ---- The dress ---- */

static size_t count_particles(const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    free(weld);
    return count;
}

/* Chooses the edge length that gives about `wanted` particles. */
static bool cut_dress(int wanted, tl_garment *out, tl_error *error)
{
    float edge_m = 0.04f;
    for (int i = 0; i < 3; i++) {
        if (!tl_garment_cut("dress", edge_m, out, error))
            return false;
        size_t count = count_particles(out);
        if (i == 2)
            break;
        edge_m *= sqrtf((float)count / (float)wanted);
        tl_garment_release(out);
    }
    return true;
}

static void settle_dress(const tl_garment *dress, struct dress_run *run)
{
    struct tl_cloth_params params = *(const struct tl_cloth_params *)tl_cloth_options.defaults;
    params.solver = run->solver;
    struct tl_worn worn;
    run->done = tl_worn_settle(dress, &params, &worn, &run->refusal);
    run->taken = worn.taken;
    if (worn.cloth) {
        struct tl_cloth_report report = tl_cloth_measure(worn.cloth, NULL);
        run->particles = report.vertex_count;
        run->settled = report.settled;
    }
    tl_worn_release(&worn);
}

static bool run_dresses(struct cloth_bench *bench, tl_error *error)
{
    omp_set_num_threads(omp_get_num_procs());
    for (int d = 0; d < bench->plan.dress_count; d++) {
        tl_garment dress;
        if (!cut_dress(bench->plan.dresses[d], &dress, error))
            return false;
        for (int s = 0; s < TL_CLOTH_SOLVER_COUNT && !tl_interrupted(); s++) {
            struct dress_run *run = &bench->dresses[bench->dress_count];
            if (s == TL_CLOTH_REFERENCE && !(bench->plan.slow_dress && d == 0))
                continue;
            *run = (struct dress_run){.wanted = bench->plan.dresses[d], .solver = s};
            settle_dress(&dress, run);
            bench->dress_count++;
        }
        tl_garment_release(&dress);
    }
    return !tl_interrupted() || tl_fail(error, TL_INTERRUPTED, "bench: stopped");
}

/* ---- Results ---- */

static void print_rates(const struct cloth_bench *bench)
{
    printf(
        "particles x substeps per second of CPU on one core, in millions, and in units of the plain loop in "
        "the same run\n(sheets of 1 m held by an edge, no contact; the best of %d rounds; settle's steps are "
        "of 1/60 s)\n\n",
        ROUNDS);
    printf("%-10s %8s %8s %12s %8s %14s\n", "particles", "threads", "", "M/s/core", "ratio", "wall M/s");
    for (int i = 0; i < bench->plan.side_count; i++)
        for (int t = 0; t < bench->plan.thread_count; t++)
            for (int c = 0; c < RUN_COUNT; c++) {
                const struct rate *rate = &bench->rates[i][t][c];
                printf("%-10d %8d %-12s %8.2f %8.2f %14.2f\n", bench->plan.sides[i] * bench->plan.sides[i],
                       t + 1, run_name(c), 1e-6 * rate->cpu, rate->cpu / bench->rates[i][t][PLAIN_LOOP].cpu,
                       1e-6 * rate->wall);
            }
    printf("\nnormals and tangents on one core:\n");
    for (int i = 0; i < bench->plan.side_count; i++)
        printf("%-10d %8.3f ms\n", bench->plan.sides[i] * bench->plan.sides[i], bench->frames_ms[i]);
}

static void print_dresses(const struct cloth_bench *bench)
{
    printf("\nthe dress comes to rest on the form, from panels:\n%-10s %-12s %8s %8s\n", "particles", "",
           "CPU s", "wall s");
    for (size_t i = 0; i < bench->dress_count; i++) {
        const struct dress_run *run = &bench->dresses[i];
        printf("%-10zu %-12s %8.2f %8.2f  %s\n", run->particles, tl_cloth_solver_names[run->solver],
               1e-3 * run->taken.cpu_ms, 1e-3 * run->taken.wall_ms,
               !run->done     ? run->refusal.message
               : run->settled ? "at rest"
                              : "still moving when its time was over");
    }
}

static void add_runs(const struct cloth_bench *bench, int variant, cJSON *object)
{
    cJSON *runs = cJSON_AddArrayToObject(object, "runs");
    for (int i = 0; i < bench->plan.side_count; i++)
        for (int t = 0; t < bench->plan.thread_count; t++) {
            const struct rate *rate = &bench->rates[i][t][variant];
            cJSON *run = cJSON_CreateObject();
            cJSON_AddNumberToObject(run, "particles", bench->plan.sides[i] * bench->plan.sides[i]);
            cJSON_AddNumberToObject(run, "threads", t + 1);
            cJSON_AddNumberToObject(run, "steps_per_s_core", rate->cpu);
            cJSON_AddNumberToObject(run, "steps_per_s_wall", rate->wall);
            cJSON_AddNumberToObject(run, "ratio", rate->cpu / bench->rates[i][t][PLAIN_LOOP].cpu);
            cJSON_AddItemToArray(runs, run);
        }
}

static void add_dresses(const struct cloth_bench *bench, cJSON *object)
{
    cJSON *dresses = cJSON_AddArrayToObject(object, "dress");
    for (size_t i = 0; i < bench->dress_count; i++) {
        const struct dress_run *run = &bench->dresses[i];
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "solver", tl_cloth_solver_names[run->solver]);
        cJSON_AddNumberToObject(row, "particles", (double)run->particles);
        cJSON_AddNumberToObject(row, "cpu_s", 1e-3 * run->taken.cpu_ms);
        cJSON_AddNumberToObject(row, "wall_s", 1e-3 * run->taken.wall_ms);
        cJSON_AddBoolToObject(row, "settled", run->settled);
        if (!run->done)
            cJSON_AddStringToObject(row, "refused", run->refusal.message);
        cJSON_AddItemToArray(dresses, row);
    }
}

/* Each solver's own figure is that of the sheet of 10k particles (the middle one) on one thread. */
static void print_json(const struct cloth_bench *bench)
{
    cJSON *object = cJSON_CreateObject(), *solvers = cJSON_AddArrayToObject(object, "solvers");
    int middle = bench->plan.side_count / 2;
    for (int c = 0; c < RUN_COUNT; c++) {
        const struct rate *rate = &bench->rates[middle][0][c];
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "name", run_name(c));
        cJSON_AddNumberToObject(row, "steps_per_s_core", rate->cpu);
        cJSON_AddNumberToObject(row, "ratio", rate->cpu / bench->rates[middle][0][PLAIN_LOOP].cpu);
        add_runs(bench, c, row);
        cJSON_AddItemToArray(solvers, row);
    }
    cJSON *frames = cJSON_AddArrayToObject(object, "frames");
    for (int i = 0; i < bench->plan.side_count; i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddNumberToObject(row, "vertices", bench->plan.sides[i] * bench->plan.sides[i]);
        cJSON_AddNumberToObject(row, "ms", bench->frames_ms[i]);
        cJSON_AddItemToArray(frames, row);
    }
    add_dresses(bench, object);
    tl_json_print(object);
}

static bool run(struct cloth_bench *bench, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("measuring cloth");
    int runs = bench->plan.side_count * bench->plan.thread_count;
    bool done = true;
    for (int i = 0; done && i < runs; i++) {
        int size = i / bench->plan.thread_count, threads = 1 + i % bench->plan.thread_count;
        done = run_sheet(bench, size, threads, error);
        if (done && threads == 1)
            run_frames(bench, size);
        tl_progress_update(&progress, i + 1, runs);
    }
    tl_progress_end(&progress);
    return done && run_dresses(bench, error);
}

bool tl_bench_cloth(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count)
        return tl_fail(error, TL_USAGE, "bench: %s: cloth measures sheets of its own: name no scene",
                       arguments->positionals[0]);
    struct cloth_bench *bench = TL_NEW(struct cloth_bench);
    bench->plan = arguments->quick ? quick_plan : arguments->full ? full_plan : plain_plan;
    bool done = run(bench, error);
    bool dressing = !done && bench->dress_count > 0; /* stopped while dresses settled: the rest is whole */
    if (done && arguments->json) {
        print_json(bench);
    } else if (done || dressing) {
        print_rates(bench);
        print_dresses(bench);
    }
    free(bench);
    return done;
}
