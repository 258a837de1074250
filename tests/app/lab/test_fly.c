/* Figures of flights: percentiles and shares of known frames, a comparison of two flights with a known ratio,
 * and records that are read back or refused. */
#include "tests/testing.h"

#include "app/lab/flight/fly_figures.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <string.h>
#include <unistd.h>

static uint32_t state = 1;

/* Uniform in [0, 1). */
static double draw(void)
{
    state = state * 1664525u + 1013904223u;
    return (double)(state >> 8) / 16777216.0;
}

/* Frames of 10 to 14 ms that swell along the way, of which the cloth takes 2 and two jobs the rest; the third
 * job runs in every fourth frame only. */
static struct tl_flight make_flight(int count, uint32_t seed)
{
    struct tl_flight flight = {.budget_ms = 12,
                               .frame_rate = 30,
                               .planned = count,
                               .warm_up = 30,
                               .frames = TL_NEW_ARRAY(struct tl_flight_frame, (size_t)count),
                               .count = count,
                               .job_count = 3,
                               .job_names = {"points", "light", "lobes"}};
    state = seed;
    for (int i = 0; i < count; i++) {
        struct tl_flight_frame *frame = &flight.frames[i];
        *frame = (struct tl_flight_frame)TL_FLIGHT_FRAME_EMPTY;
        frame->memory_bytes = 1000;
        frame->cloth_ms = 2 + 0.1 * draw();
        frame->job_ms[0] = 5 + 3 * sin(0.01 * i) + 0.2 * draw();
        frame->job_ms[1] = 3 + 0.2 * draw();
        frame->job_ms[2] = i % 4 == 0 ? 1 + 0.1 * draw() : 0;
        frame->total_ms = frame->cloth_ms + frame->job_ms[0] + frame->job_ms[1] + frame->job_ms[2];
        frame->cpu_ms = 1.8 * frame->total_ms;
        frame->predicted_ms = 1.02 * frame->total_ms;
        frame->error = 0.01;
        frame->levels.of[TL_CONTROL_SCALE] = (uint8_t)(i % 3);
    }
    return flight;
}

static void percentiles_are_the_nearest_rank(void **unused)
{
    (void)unused;
    double values[100];
    for (int i = 0; i < 100; i++)
        values[i] = (i * 37) % 100 + 1; /* 1 to 100, shuffled */
    assert_near(tl_percentile(values, 100, 0.5), 50, 0);
    assert_near(tl_percentile(values, 100, 0.95), 95, 0);
    assert_near(tl_percentile(values, 100, 0.99), 99, 0);
    assert_near(tl_percentile(values, 100, 1), 100, 0);
    assert_near(tl_percentile(values, 100, 0), 1, 0);
    assert_near(tl_percentile(values, 1, 0.99), values[0], 0);
    assert_true(isnan(tl_percentile(values, 0, 0.5)));
}

static void the_warm_up_does_not_count(void **unused)
{
    (void)unused;
    struct tl_flight flight = make_flight(130, 3);
    for (int i = 0; i < 130; i++)
        flight.frames[i].total_ms = i < 30 ? 1000 : i < 120 ? 10 : i < 125 ? 13 : 20;
    for (int i = 0; i < 130; i++)
        flight.frames[i].predicted_ms = (i % 2 ? 1.1 : 0.9) * flight.frames[i].total_ms;
    flight.frames[40].predicted_ms = NAN;
    flight.frames[50].flip_mean = 0.1;
    flight.frames[50].rel_rmse = 0.2;
    flight.frames[0].flip_mean = 0.3; /* measured, and images have no warm-up */
    flight.frames[0].rel_rmse = 0.4;
    flight.frames[0].garment_flip = 0.05; /* in the other one the garment is out of sight */
    flight.frames[0].garment_flip_worst = 0.25;
    struct tl_flight_figures figures = tl_flight_measure(&flight);
    assert_int_equal(figures.judged, 100);
    assert_near(figures.p50_ms, 10, 0);
    assert_near(figures.p95_ms, 13, 0);
    assert_near(figures.p99_ms, 20, 0);
    assert_near(figures.worst_ms, 20, 0);
    assert_near(figures.mean_ms, 0.9 * 10 + 0.05 * 13 + 0.05 * 20, 1e-12);
    assert_near(figures.within, 0.95, 1e-12); /* 13 <= 1.1 x 12 */
    assert_int_equal(figures.over_budget, 10);
    assert_near(figures.prediction_error, 0.1, 1e-12);
    assert_int_equal(figures.oracle_frames, 2);
    assert_near(figures.flip_mean, 0.2, 1e-12);
    assert_near(figures.rel_rmse, 0.3, 1e-12);
    assert_near(figures.flip_max, 0.3, 0);
    assert_int_equal(figures.garment_frames, 1);
    assert_near(figures.garment_flip, 0.05, 1e-12);
    assert_near(figures.garment_flip_max, 0.05, 0);
    assert_near(figures.garment_flip_worst, 0.25, 1e-12);
    flight.frames[50].garment_flip = 0.15;
    flight.frames[50].garment_flip_worst = 0.35;
    figures = tl_flight_measure(&flight);
    assert_int_equal(figures.garment_frames, 2);
    assert_near(figures.garment_flip, 0.1, 1e-12);
    assert_near(figures.garment_flip_max, 0.15, 0);
    assert_near(figures.garment_flip_worst, 0.3, 1e-12);
    flight.budget_ms = 0;
    figures = tl_flight_measure(&flight);
    assert_true(isnan(figures.within));
    assert_int_equal(figures.over_budget, 0);
    flight.count = 20; /* stopped before the warm-up was over: nothing is known, nothing is made up */
    figures = tl_flight_measure(&flight);
    assert_int_equal(figures.judged, 0);
    assert_true(isnan(figures.p50_ms) && isnan(figures.within) && isnan(figures.mean_ms));
    flight.frames[0].garment_flip = flight.frames[0].garment_flip_worst = NAN;
    figures = tl_flight_measure(&flight);
    assert_int_equal(figures.oracle_frames, 1);
    assert_int_equal(figures.garment_frames, 0);
    assert_true(isnan(figures.garment_flip) && isnan(figures.garment_flip_worst) &&
                isnan(figures.garment_flip_max));
    tl_flight_release(&flight);
}

static void jobs_count_where_they_ran(void **unused)
{
    (void)unused;
    struct tl_flight flight = make_flight(130, 4);
    struct tl_flight_job job = tl_flight_measure_job(&flight, 2);
    assert_int_equal(job.ran, 25);
    assert_near(job.median_ms, 1.05, 0.05);
    assert_near(job.total_ms, 25 * 1.05, 25 * 0.05);
    tl_flight_release(&flight);
}

static const struct tl_flight_ratio *find_ratio(const struct tl_flight_ratio *ratios, int count,
                                                const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(ratios[i].name, name) == 0)
            return &ratios[i];
    fail_msg("no ratio of %s", name);
    return NULL;
}

/* One job made half as long again: it and the frame are named, nothing else is, and the intervals hold the
 * ratios that were put in. */
static void a_slower_job_is_named(void **unused)
{
    (void)unused;
    struct tl_flight before = make_flight(400, 5), after = make_flight(380, 99);
    for (int i = 0; i < after.count; i++) {
        double more_ms = 0.5 * after.frames[i].job_ms[1];
        after.frames[i].job_ms[1] += more_ms;
        after.frames[i].total_ms += more_ms;
        after.frames[i].cpu_ms += 1.5 * more_ms;
    }
    memcpy(after.job_names[0], "light", 6); /* another order of columns */
    memcpy(after.job_names[1], "points", 7);
    for (int i = 0; i < after.count; i++) {
        double light_ms = after.frames[i].job_ms[1];
        after.frames[i].job_ms[1] = after.frames[i].job_ms[0];
        after.frames[i].job_ms[0] = light_ms;
    }
    struct tl_flight_ratio ratios[TL_FLIGHT_RATIOS_MAX];
    int count = tl_flight_compare(&after, &before, ratios);
    assert_int_equal(count, 6);
    assert_string_equal(ratios[0].name, "frame");
    assert_int_equal(find_ratio(ratios, count, "frame (CPU)")->verdict, TL_FLIGHT_SLOWER);
    const struct tl_flight_ratio *light = find_ratio(ratios, count, "light");
    assert_int_equal(light->verdict, TL_FLIGHT_SLOWER);
    assert_true(light->low < 1.5 && light->high > 1.5 && light->low > 1.4 && light->high < 1.6);
    assert_int_equal(ratios[0].verdict, TL_FLIGHT_SLOWER);
    assert_int_equal(find_ratio(ratios, count, "points")->verdict, TL_FLIGHT_ALIKE);
    assert_int_equal(find_ratio(ratios, count, "cloth")->verdict, TL_FLIGHT_ALIKE);
    assert_int_equal(find_ratio(ratios, count, "lobes")->verdict, TL_FLIGHT_ALIKE);
    count = tl_flight_compare(&before, &after, ratios); /* the other way round it is faster */
    assert_int_equal(find_ratio(ratios, count, "light")->verdict, TL_FLIGHT_FASTER);
    tl_flight_release(&before);
    tl_flight_release(&after);
}

/* A machine that was busier: wall times double, CPU time stays. Nothing is called slower then, nor where CPU
 * time is not known. */
static void a_busy_machine_gives_no_verdict(void **unused)
{
    (void)unused;
    struct tl_flight before = make_flight(400, 5), after = make_flight(400, 99);
    struct tl_flight_ratio ratios[TL_FLIGHT_RATIOS_MAX];
    int count = tl_flight_compare(&after, &before, ratios);
    for (int i = 0; i < count; i++)
        assert_int_equal(ratios[i].verdict, TL_FLIGHT_ALIKE);
    for (int i = 0; i < after.count; i++) {
        after.frames[i].total_ms *= 2;
        for (int job = 0; job < after.job_count; job++)
            after.frames[i].job_ms[job] *= 2;
    }
    for (int known = 1; known >= 0; known--) {
        count = tl_flight_compare(&after, &before, ratios);
        assert_int_equal(count, 5 + known);
        for (int i = 0; i < count; i++)
            assert_int_equal(ratios[i].verdict, TL_FLIGHT_UNCLEAR);
        for (int i = 0; i < after.count; i++) /* as a record of an older version is read */
            after.frames[i].cpu_ms = NAN;
    }
    tl_flight_release(&before);
    tl_flight_release(&after);
}

/* Of 60 pairs of flights that differ by noise only, with correlated frames, about 5 % may lie outside a 95 %
 * interval. Blocks of 30 in 370 frames are few, which makes the intervals too narrow: the test allows 15 %.
 */
static void noise_is_seldom_called_slower(void **unused)
{
    (void)unused;
    enum { TRIALS = 60, COUNT = 370 };
    double here[COUNT], there[COUNT];
    int outside = 0;
    state = 77;
    for (int trial = 0; trial < TRIALS; trial++) {
        double drift[2] = {0, 0};
        for (int i = 0; i < COUNT; i++) {
            double swell = 10 + 5 * sin(0.02 * i);
            for (int k = 0; k < 2; k++)
                drift[k] = 0.8 * drift[k] + draw() - 0.5;
            here[i] = swell + 0.3 * drift[0];
            there[i] = swell + 0.3 * drift[1];
        }
        struct tl_flight_ratio ratio = tl_ratio_of_medians(here, there, COUNT, 30);
        assert_true(ratio.low <= ratio.high && ratio.low > 0.8 && ratio.high < 1.25);
        outside += ratio.low > 1 || ratio.high < 1;
    }
    assert_true(outside <= 0.15 * TRIALS);
}

/* -- frames.csv -- */

static void write_flight(const void *flight, const char *file)
{
    FILE *out = fopen(file, "w");
    assert_non_null(out);
    tl_flight_write_csv(flight, out);
    fclose(out);
}

static void records_come_back(void **unused)
{
    (void)unused;
    char file[] = "/tmp/toile_fly_XXXXXX";
    close(mkstemp(file));
    struct tl_flight flight = make_flight(60, 6), back;
    flight.frames[7].hash = 0xfedcba9876543210u;
    flight.frames[7].flip_mean = 0.125;
    flight.frames[7].garment_flip = 0.25;
    flight.frames[7].garment_flip_worst = 0.5;
    flight.frames[0].predicted_ms = NAN;
    tl_error error = {0};
    write_flight(&flight, file);
    assert_ok(tl_flight_read_csv(file, &back, &error), error);
    assert_int_equal(back.count, flight.count);
    assert_int_equal(back.warm_up, flight.warm_up);
    assert_int_equal(back.job_count, 3);
    assert_string_equal(back.job_names[1], "light");
    assert_true(back.frames[7].hash == flight.frames[7].hash && back.frames[8].hash == 0);
    assert_near(back.frames[7].flip_mean, 0.125, 0);
    assert_near(back.frames[7].garment_flip, 0.25, 0);
    assert_near(back.frames[7].garment_flip_worst, 0.5, 0);
    assert_true(isnan(back.frames[8].garment_flip) && isnan(back.frames[8].garment_flip_worst));
    assert_true(isnan(back.frames[0].predicted_ms) && isnan(back.frames[0].flip_mean));
    for (int i = 0; i < flight.count; i++) {
        assert_memory_equal(&back.frames[i].levels, &flight.frames[i].levels, sizeof back.frames[i].levels);
        assert_near(back.frames[i].total_ms, flight.frames[i].total_ms, 0.5e-4); /* four places are written */
        assert_near(back.frames[i].job_ms[2], flight.frames[i].job_ms[2], 0.5e-4);
    }
    unlink(file);
    tl_flight_release(&back);
    tl_flight_release(&flight);
}

#define HEADS                                                                                                \
    "frame,warm_up,total_ms,level_ratio,level_refresh,level_regions,level_relief,level_scale,"               \
    "job_light_ms,new\n"

static void broken_records_are_refused(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"", "empty"},
        {"frame,total_ms\n0,1\n", ":1: lacks a column of levels"},
        {"a,b\n", ":1: has no columns"},
        {HEADS, "holds no frame"},
        {HEADS "0,1,2.5,0,0,0,0,0,1\n", ":2: has fewer cells"},
        {HEADS "0,1,2.5,0,0,0,0,0,1,x,y\n", ":2: has more cells"},
        {HEADS "0,1,nan,0,0,0,0,0,1,x\n", ":2: a cell is no number"},
        {HEADS "0,1,2.5,0,-1,0,0,0,1,x\n", ":2: a cell is no number"},
        {HEADS "0,1,2.5,0,0,0,0,255,1,x\n", ":2: there is no such level"},
        {HEADS "0,1,2.5,0,0,0,0,300,1,x\n", ":2: a cell is too large"},
        {HEADS "0,1,2.5,0,0,0,0,0,1,x\n5,1,2.5,0,0,0,0,1,x\n", ":3: frames do not follow"},
        {HEADS "0,1,2.5ms,0,0,0,0,0,1,x\n", ":2: a cell is no number"},
    };
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        char file[] = "/tmp/toile_fly_XXXXXX";
        FILE *out = fdopen(mkstemp(file), "w");
        fputs(rows[i].text, out);
        fclose(out);
        struct tl_flight flight = {0};
        tl_error error = {0};
        bool read = tl_flight_read_csv(file, &flight, &error);
        if (read || !strstr(error.message, rows[i].says)) {
            print_error("%s-> %s\n", rows[i].text, read ? "read" : error.message);
            fail();
        }
        assert_int_equal(tl_exit_status(error.code), 2);
        unlink(file);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percentiles_are_the_nearest_rank), cmocka_unit_test(the_warm_up_does_not_count),
        cmocka_unit_test(jobs_count_where_they_ran),        cmocka_unit_test(a_slower_job_is_named),
        cmocka_unit_test(noise_is_seldom_called_slower),    cmocka_unit_test(records_come_back),
        cmocka_unit_test(broken_records_are_refused),       cmocka_unit_test(a_busy_machine_gives_no_verdict),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
