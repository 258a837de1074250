/* Point caches: what was written is read back, formats agree, times are right. */
#include "assets/model.h"
#include "assets/motion/point_cache.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>
#include <sys/stat.h>

#define SCRATCH TOILE_SCRATCH_DIR "/point_cache"

enum { POINTS = 5, SAMPLES = 4 };

/* Quadratic in time, so that straight lines between samples differ from it. */
static vec3s true_point(size_t point, double sample)
{
    float t = (float)sample;
    return (vec3s){{(float)point + t * t, 0.1f * t, -(float)point * t}};
}

static const char *write_cache(const char *name)
{
    static char path[1024];
    tl_error error = {0};
    mkdir(SCRATCH, 0777);
    snprintf(path, sizeof path, SCRATCH "/%s", name);
    tl_point_cache_writer *writer = tl_point_cache_create(path, POINTS, SAMPLES, 7, 24, &error);
    assert_ok(writer != NULL, error);
    for (size_t s = 0; s < SAMPLES; s++) {
        vec3s points[POINTS];
        for (size_t i = 0; i < POINTS; i++)
            points[i] = true_point(i, (double)s);
        tl_point_cache_add(writer, points);
    }
    assert_ok(tl_point_cache_commit(&writer, &error), error);
    return path;
}

static void write_sequence(const int *numbers, size_t count)
{
    mkdir(SCRATCH, 0777);
    for (size_t s = 0; s < count; s++) {
        char path[1024];
        snprintf(path, sizeof path, SCRATCH "/frame.%03d.obj", numbers[s]);
        FILE *stream = fopen(path, "w");
        assert_non_null(stream);
        for (size_t i = 0; i < POINTS; i++) {
            vec3s point = true_point(i, (double)s);
            fprintf(stream, "v %.9g %.9g %.9g\n", (double)point.x, (double)point.y, (double)point.z);
        }
        fclose(stream);
    }
}

static tl_point_cache *open_cache(const char *name, double metres)
{
    tl_error error = {0};
    tl_point_cache *cache = tl_point_cache_open(name, metres, &error);
    assert_ok(cache != NULL, error);
    return cache;
}

static void check_samples(tl_point_cache *cache, float metres)
{
    static const double positions[] = {0, 1, 2, 3, 0.5, 2.25, 0, 2.75, 1};
    tl_error error = {0};
    assert_int_equal(tl_point_cache_facts(cache)->point_count, POINTS);
    assert_int_equal(tl_point_cache_facts(cache)->sample_count, SAMPLES);
    for (size_t k = 0; k < TL_COUNT(positions); k++) {
        vec3s points[POINTS];
        double whole = floor(positions[k]), part = positions[k] - whole;
        assert_ok(tl_point_cache_read(cache, positions[k], points, &error), error);
        for (size_t i = 0; i < POINTS; i++) {
            vec3s from = true_point(i, whole), to = true_point(i, whole + (part > 0));
            for (int c = 0; c < 3; c++)
                assert_near(points[i].raw[c],
                            metres * ((1 - part) * (double)from.raw[c] + part * (double)to.raw[c]),
                            part > 0 || metres != 1 ? 1e-5 : 0); /* samples are exact to the bit */
        }
    }
}

static void written_caches_are_read_back(void **state)
{
    (void)state;
    static const int numbers[] = {1, 2, 3, 4};
    tl_point_cache *pc2 = open_cache(write_cache("a.pc2"), 1);
    tl_point_cache *mdd = open_cache(write_cache("a.mdd"), 1);
    write_sequence(numbers, SAMPLES);
    tl_point_cache *sequence = open_cache(SCRATCH "/frame.###.obj", 1);
    check_samples(pc2, 1);
    check_samples(mdd, 1);
    check_samples(sequence, 1);
    assert_near(tl_point_cache_facts(pc2)->first, 7, 0);
    assert_near(tl_point_cache_facts(pc2)->last, 10, 0);
    assert_near(tl_point_cache_facts(mdd)->first, 7.0 / 24, 1e-7);
    assert_near(tl_point_cache_facts(mdd)->step, 1.0 / 24, 1e-7);
    assert_near(tl_point_cache_facts(pc2)->box.upper.x, POINTS - 1 + 9, 0);
    assert_near(tl_point_cache_facts(pc2)->box.lower.z, -12, 0);
    tl_point_cache_destroy(&sequence);
    tl_point_cache_destroy(&mdd);
    tl_point_cache_destroy(&pc2);
    pc2 = open_cache(write_cache("a.pc2"), 0.0254);
    check_samples(pc2, 0.0254f);
    tl_point_cache_destroy(&pc2);
}

/* PC2: one sample a frame of the animation (30 a second here), or as many a second as are asked for. MDD: its
 * own seconds. */
static void times_map_to_samples(void **state)
{
    (void)state;
    tl_point_cache *pc2 = open_cache(write_cache("a.pc2"), 1);
    tl_point_cache *mdd = open_cache(write_cache("a.mdd"), 1);
    static const struct {
        double time_s, own_rate, pc2, mdd;
    } rows[] = {
        {0, 0, 0, 0},          {-1, 0, 0, 0},       {1 / 30.0, 0, 1, 0.8}, {1 / 24.0, 0, 1.25, 1},
        {2.5 / 24, 0, 3, 2.5}, {100, 0, 3, 3},      {0.02, 50, 1, 1},      {0.5, 4, 2, 2},
        {0.55, 4, 2.2, 2.2},   {0.05, 0, 1.5, 1.2}, {1e9, 1e5, 3, 3},
    };
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        assert_near(tl_point_cache_position(pc2, rows[i].time_s, 30, rows[i].own_rate), rows[i].pc2, 1e-5);
        assert_near(tl_point_cache_position(mdd, rows[i].time_s, 30, rows[i].own_rate), rows[i].mdd, 1e-5);
    }
    for (int frame = 0; frame < SAMPLES; frame++) /* a whole sample despite rounding */
        for (int rate = 1; rate < 121; rate++)
            assert_true(tl_point_cache_position(pc2, frame / (double)rate, rate, 0) == frame);
    tl_point_cache_destroy(&mdd);
    tl_point_cache_destroy(&pc2);
}

/* The numbers of a sequence are its frames, also across missing ones. */
static void missing_frames_keep_the_timing(void **state)
{
    (void)state;
    static const int numbers[] = {10, 12, 20, 21};
    assert_int_equal(system("rm -rf " SCRATCH "/frame.*.obj"), 0);
    write_sequence(numbers, SAMPLES);
    tl_point_cache *cache = open_cache(SCRATCH "/frame.###.obj", 1);
    check_samples(cache, 1);
    assert_near(tl_point_cache_facts(cache)->step, 0, 0);
    assert_near(tl_point_cache_position(cache, 2 / 30.0, 30, 0), 1, 0);
    assert_near(tl_point_cache_position(cache, 6 / 30.0, 30, 0), 1.5, 1e-9);
    assert_near(tl_point_cache_position(cache, 10 / 30.0, 30, 0), 2, 0);
    assert_near(tl_point_cache_position(cache, 1, 30, 0), 3, 0);
    tl_point_cache_destroy(&cache);
    assert_int_equal(system("rm -rf " SCRATCH "/frame.*.obj"), 0);
}

/* The rate of a PC2 is frames from sample to sample. */
static void pc2_rate_counts_frames(void **state)
{
    (void)state;
    const char *path = write_cache("rate.pc2");
    FILE *stream = fopen(path, "rb+");
    const float half = 0.5f;
    assert_int_equal(fseek(stream, 24, SEEK_SET), 0);
    assert_int_equal(fwrite(&half, sizeof half, 1, stream), 1);
    fclose(stream);
    tl_point_cache *cache = open_cache(path, 1);
    assert_near(tl_point_cache_position(cache, 1 / 30.0, 30, 0), 2, 1e-9);
    assert_near(tl_point_cache_facts(cache)->last, 8.5, 0);
    tl_point_cache_destroy(&cache);
}

/* ---- The same T-shirt as PC2 (251 samples), MDD (every fifth, 90 frames a second) and OBJ (three) ---- */

#define FOLDER "sequences/tshirt_iter0/"

static double largest_difference(const vec3s *a, const vec3s *b, size_t count)
{
    double largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, (double)glms_vec3_distance(a[i], b[i]));
    return largest;
}

static void real_caches_agree(void **state)
{
    (void)state;
    const double source_rate = 90, agreed_m = 1e-6;
    char sequence_name[1024];
    tl_error error = {0};
    tl_model shirt;
    assert_ok(tl_model_load(test_data(FOLDER "000.obj"), &shirt, &error), error);
    double metres = tl_units_metres(shirt.units.units);
    size_t count = tl_model_point_count(&shirt);
    snprintf(sequence_name, sizeof sequence_name, "%.*s###.obj",
             (int)(strlen(test_data(FOLDER "000.obj")) - strlen("000.obj")), test_data(FOLDER "000.obj"));
    tl_point_cache *pc2 = open_cache(test_data(FOLDER "tshirt.pc2"), metres);
    tl_point_cache *mdd = open_cache(test_data(FOLDER "tshirt.mdd"), metres);
    tl_point_cache *sequence = open_cache(sequence_name, metres);
    assert_int_equal(tl_point_cache_facts(pc2)->point_count, count);
    assert_int_equal(tl_point_cache_facts(mdd)->point_count, count);
    assert_int_equal(tl_point_cache_facts(sequence)->point_count, count);
    assert_int_equal(tl_point_cache_facts(pc2)->sample_count, 251);
    assert_int_equal(tl_point_cache_facts(mdd)->sample_count, 51);
    assert_int_equal(tl_point_cache_facts(sequence)->sample_count, 3);
    vec3s *a = TL_NEW_ARRAY(vec3s, count), *b = TL_NEW_ARRAY(vec3s, count);
    double worst_mdd = 0, worst_obj = 0;
    for (int number = 0; number <= 250; number += 5) {
        double time_s = number / source_rate;
        assert_ok(tl_point_cache_read(pc2, tl_point_cache_position(pc2, time_s, 30, source_rate), a, &error),
                  error);
        assert_ok(tl_point_cache_read(mdd, tl_point_cache_position(mdd, time_s, 30, 0), b, &error), error);
        worst_mdd = fmax(worst_mdd, largest_difference(a, b, count));
        if (number != 0 && number != 120 && number != 250)
            continue;
        assert_ok(tl_point_cache_read(sequence, tl_point_cache_position(sequence, time_s, 30, source_rate), b,
                                      &error),
                  error);
        worst_obj = fmax(worst_obj, largest_difference(a, b, count));
    }
    printf("MDD within %.2g m, OBJ within %.2g m of PC2\n", worst_mdd, worst_obj);
    assert_true(worst_mdd <= agreed_m && worst_obj <= agreed_m);
    free(a);
    free(b);
    tl_point_cache_destroy(&sequence);
    tl_point_cache_destroy(&mdd);
    tl_point_cache_destroy(&pc2);
    tl_model_release(&shirt);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_caches_are_read_back),
        cmocka_unit_test(times_map_to_samples),
        cmocka_unit_test(missing_frames_keep_the_timing),
        cmocka_unit_test(pc2_rate_counts_frames),
        cmocka_unit_test(real_caches_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
