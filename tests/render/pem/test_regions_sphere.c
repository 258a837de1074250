/* The cut of the whole sphere: a partition and a tree that divides no light; and directions sampled from
 * it. */
#include "render/env/from_environment.h"
#include "render/pem/regions.h"

#include "assets/environment/environment.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <omp.h>
#include <string.h>

static const int counts[] = {6, 24, 96, 192, 384};

static vec3s texel_direction(int size, int texel, float u, float v)
{
    int x = texel % size, line = texel / size;
    return glms_vec3_normalize(tl_cube_direction(line / size, ((float)x + u) / (float)size,
                                                 ((float)(line % size) + v) / (float)size));
}

static double solid_angle_of(int size, int texel)
{
    return (double)tl_cube_solid_angle(size, texel % size, texel / size % size);
}

/* `radiance` by direction, grey. */
static tl_cube cube_of(int size, float (*radiance)(vec3s))
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        float value = radiance(texel_direction(size, i, 0.5f, 0.5f));
        for (int c = 0; c < 3; c++)
            cube.texels[3 * i + c] = value;
    }
    return cube;
}

static float smooth(vec3s d)
{
    return 2 + d.x + d.y / 2 + d.z / 3;
}

static float constant(vec3s d)
{
    (void)d;
    return 3;
}

static float black(vec3s d)
{
    (void)d;
    return 0;
}

static float grey_of(const tl_cube *cube, int texel)
{
    return cube->texels[3 * (size_t)texel];
}

static const vec3s blob_centre = {{0.62f, 0.75f, 0.23f}};

/* A sky, and a disc of 2 degrees that holds as much light as it: 3283 times as bright. */
static float blob(vec3s d)
{
    return glms_vec3_dot(d, glms_vec3_normalize(blob_centre)) > cosf(2 * (float)M_PI / 180) ? 3283 : 1;
}

/* Grey noise over five orders of magnitude, from an integer hash. */
static tl_cube noise_cube(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 18 * size * size; i++) {
        uint32_t hash = (uint32_t)i * 2654435761u;
        hash = (hash ^ (hash >> 15)) * 2246822519u;
        cube.texels[i] = powf(10, (float)(hash >> 8) / (float)(1 << 24) * 5 - 3);
    }
    return cube;
}

/* Every texel once, in the region that its label names; the items' numbers as direct sums give them. */
static void check_partition(const tl_cube *cube, const struct tl_regions *regions)
{
    int texel_count = 6 * cube->size * cube->size;
    unsigned char *owners = calloc((size_t)texel_count, 1);
    assert_int_equal(regions->size, cube->size);
    assert_int_equal(regions->first[0], 0);
    assert_int_equal(regions->first[regions->count], texel_count);
    for (int i = 0; i < regions->count; i++) {
        const struct tl_region *region = &regions->items[i];
        double power[3] = {0}, solid_angle = 0;
        assert_true(regions->first[i] < regions->first[i + 1]);
        for (uint32_t k = regions->first[i]; k < regions->first[i + 1]; k++) {
            int texel = (int)regions->texels[k];
            owners[texel]++;
            assert_int_equal(regions->labels[texel], i);
            assert_true(regions->cumulative[k] >= (k > regions->first[i] ? regions->cumulative[k - 1] : 0));
            solid_angle += solid_angle_of(cube->size, texel);
            for (int c = 0; c < 3; c++)
                power[c] += solid_angle_of(cube->size, texel) * (double)cube->texels[3 * texel + c];
        }
        double importance = 0.2126 * power[0] + 0.7152 * power[1] + 0.0722 * power[2];
        assert_near(regions->cumulative[regions->first[i + 1] - 1], 1, 0);
        assert_near(region->solid_angle, solid_angle, 2e-6 * solid_angle);
        assert_near(region->importance, importance, 2e-6 * importance);
        for (int c = 0; c < 3; c++)
            assert_near(region->power.raw[c], power[c], 2e-6 * power[c]);
        assert_near(glms_vec3_norm(region->direction), 1, 1e-6);
        assert_true(isfinite(region->spread) && region->spread > 0 && isfinite(region->cone));
    }
    for (int i = 0; i < texel_count; i++)
        assert_int_equal(owners[i], 1);
    free(owners);
}

/* One root, every other node the child of its parent, children behind parents, each region one leaf, ranks 0
 * to count - 2 and none before its parent's. */
static void check_tree(const struct tl_regions *regions)
{
    int leaves[TL_REGIONS_MAX] = {0}, ranks[TL_REGIONS_MAX] = {0};
    assert_int_equal(regions->node_count, 2 * regions->count - 1);
    for (int i = 0; i < regions->node_count; i++) {
        const struct tl_region_node *node = &regions->nodes[i];
        assert_true((node->parent < 0) == (i == 0) && node->parent < i);
        if (i > 0) {
            const struct tl_region_node *parent = &regions->nodes[node->parent];
            assert_true((parent->children[0] == i) != (parent->children[1] == i));
        }
        if (node->children[0] < 0) {
            assert_in_range(node->region, 0, regions->count - 1);
            leaves[node->region]++;
            continue;
        }
        assert_int_equal(node->region, -1);
        assert_in_range(node->rank, 0, regions->count - 2);
        assert_true(i == 0 ? node->rank == 0 : node->rank > regions->nodes[node->parent].rank);
        ranks[node->rank]++;
    }
    for (int i = 0; i < regions->count; i++)
        assert_true(leaves[i] == 1 && (i == regions->count - 1 || ranks[i] == 1));
}

static void cuts_are_partitions_and_trees(void **state)
{
    (void)state;
    float (*const skies[])(vec3s) = {smooth, constant, black, blob};
    for (size_t s = 0; s < TL_COUNT(skies); s++) {
        tl_cube cube = cube_of(32, skies[s]);
        struct tl_regions regions = {0};
        for (int count = 1; count <= 384; count = count < 6 ? count + 1 : 4 * count) {
            tl_regions_cut_sphere(&cube, count, &regions);
            assert_int_equal(regions.count, count);
            check_partition(&cube, &regions);
            check_tree(&regions);
        }
        tl_regions_release(&regions);
        tl_cube_release(&cube);
    }
}

/* A cut at the least variance of an even measure halves it, to the width of a texel row. The cells of a
 * sphere so cut repeatedly differ by at most one cut that has not yet been made (2), times the unevenness of
 * near-halves; the mixed measure is half that of `smooth`, whose radiance varies by 3.6. */
static void regions_of_even_light_are_even(void **state)
{
    (void)state;
    tl_cube cube = cube_of(64, smooth);
    struct tl_regions regions = {0};
    for (size_t i = 0; i < TL_COUNT(counts); i++) {
        tl_regions_cut_sphere(&cube, counts[i], &regions);
        double total = 0, low = 1, high = 0;
        for (int k = 0; k < regions.count; k++)
            total += (double)regions.items[k].importance;
        for (int k = 0; k < regions.count; k++) {
            double mixed = 0.5 * ((double)regions.items[k].importance / total +
                                  (double)regions.items[k].solid_angle / (4 * M_PI));
            low = fmin(low, mixed * regions.count);
            high = fmax(high, mixed * regions.count);
        }
        printf("N = %3d: mixed measure %.2f to %.2f of an even share\n", counts[i], low, high);
        assert_true(low > 1.0 / 3 && high < 3);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* A light smaller than the regions lies in one of them, at every count, wherever it is: its variance is less
 * than that of a region of sky, 2 deg / sqrt(2) at half the measure against 4 pi / N sr of 1 / 2N. */
static void compact_light_is_never_cut(void **state)
{
    (void)state;
    tl_cube cube = cube_of(128, blob);
    struct tl_regions regions = {0};
    for (int count = 6; count <= 48; count++) {
        int owner = -1;
        tl_regions_cut_sphere(&cube, count, &regions);
        for (int i = 0; i < 6 * 128 * 128; i++) {
            if (grey_of(&cube, i) < 1000)
                continue;
            if (owner < 0)
                owner = regions.labels[i];
            assert_int_equal(regions.labels[i], owner);
        }
        if (count >= 24) /* and no more else than in other regions, which differ by a cut more or less */
            assert_true(regions.items[owner].solid_angle < 2 * 4 * (float)M_PI / (float)count);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

static void expect_same(const struct tl_regions *a, const struct tl_regions *b)
{
    size_t texel_count = 6 * (size_t)a->size * (size_t)a->size;
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->labels, b->labels, texel_count * sizeof *a->labels);
    assert_memory_equal(a->texels, b->texels, texel_count * sizeof *a->texels);
    assert_memory_equal(a->cumulative, b->cumulative, texel_count * sizeof *a->cumulative);
    assert_memory_equal(a->first, b->first, sizeof(uint32_t) * (size_t)(a->count + 1));
    assert_int_equal(a->node_count, b->node_count);
    assert_memory_equal(a->nodes, b->nodes, sizeof *a->nodes * (size_t)a->node_count);
    for (int i = 0; i < a->count; i++) {
        struct tl_region first = a->items[i], second = b->items[i];
        for (int c = 0; c < 3; c++) /* a sum of float sums against a sum of texels */
            assert_near(first.power.raw[c], second.power.raw[c], 1e-5 * (double)second.power.raw[c]);
        first.power = second.power;
        assert_memory_equal(&first, &second, sizeof first);
    }
}

static void extremes_are_cut(void **state)
{
    (void)state;
    struct tl_regions regions = {0};
    tl_cube one = tl_cube_create(1); /* six texels: six regions at most */
    tl_regions_cut_sphere(&one, 384, &regions);
    assert_int_equal(regions.count, 6);
    check_partition(&one, &regions);
    check_tree(&regions);
    tl_cube_release(&one);

    const float peaks[] = {1e-30f, 1e6f, 1e37f}; /* one texel of light on black */
    for (size_t i = 0; i < TL_COUNT(peaks); i++) {
        tl_cube cube = tl_cube_create(32);
        int lit = (2 * 32 + 7) * 32 + 20;
        for (int c = 0; c < 3; c++)
            cube.texels[3 * lit + c] = peaks[i];
        tl_regions_cut_sphere(&cube, 96, &regions);
        check_partition(&cube, &regions);
        check_tree(&regions);
        int owner = regions.labels[lit];
        assert_true(glms_vec3_dot(regions.items[owner].direction, texel_direction(32, lit, 0.5f, 0.5f)) >
                    0.99999f);
        vec3s drawn = tl_region_direction(&regions, owner, 0.3f, 0.8f); /* all light is there */
        assert_true(glms_vec3_distance(drawn, texel_direction(32, lit, 0.3f, 0.8f)) < 1e-5f);
        tl_cube_release(&cube);
    }
    tl_regions_release(&regions);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    tl_cube cube = noise_cube(64);
    struct tl_regions one = {0}, four = {0};
    int usual = omp_get_max_threads();
    omp_set_num_threads(1);
    tl_regions_cut_sphere(&cube, 384, &one);
    omp_set_num_threads(4);
    tl_regions_cut_sphere(&cube, 384, &four);
    omp_set_num_threads(usual);
    expect_same(&one, &four);
    assert_memory_equal(one.items, four.items, sizeof one.items);
    tl_regions_release(&one);
    tl_regions_release(&four);
    tl_cube_release(&cube);
}

/* Spread against brute force: 8 x 8 points in each texel. The texel's own part is taken for a flat square's;
 * at 16 texels a face that errs by less than 1 % of the smallest region's spread. */
static void spread_is_the_mean_square_angle(void **state)
{
    (void)state;
    tl_cube cube = cube_of(16, smooth);
    struct tl_regions regions = {0};
    tl_regions_cut_sphere(&cube, 96, &regions);
    for (int i = 0; i < regions.count; i++) {
        double sum = 0, weights = 0;
        for (uint32_t k = regions.first[i]; k < regions.first[i + 1]; k++) {
            int texel = (int)regions.texels[k];
            double weight = solid_angle_of(16, texel) * (double)grey_of(&cube, texel);
            for (int p = 0; p < 64; p++) {
                vec3s d =
                    texel_direction(16, texel, ((float)(p % 8) + 0.5f) / 8, ((float)(p >> 3) + 0.5f) / 8);
                double angle = acos(fmin((double)glms_vec3_dot(d, regions.items[i].direction), 1));
                sum += weight / 64 * angle * angle;
            }
            weights += weight;
        }
        assert_near(regions.items[i].spread, sqrt(sum / weights), 0.01 * sqrt(sum / weights));
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* 2^16 jittered directions of a region against its texels' shares, in groups of at least 40 expected: chi
 * square of stratified draws stays below that of free ones, whose 99.9 % quantile is k + 3.1 sqrt(2 k) + 6.
 * With a hash for draws it must also not be far below, or the draws would not be draws. */
static double chi_square(const struct tl_regions *regions, const tl_cube *cube, int region, int *groups)
{
    enum { DRAWS = 1 << 16 };
    int *hits = TL_NEW_ARRAY(int, 6 * (size_t)cube->size * (size_t)cube->size);
    for (uint32_t n = 0; n < DRAWS; n++) {
        uint32_t hash = (n + 1) * 2654435761u;
        hash = (hash ^ (hash >> 16)) * 2246822519u;
        hash = (hash ^ (hash >> 13)) * 3266489917u;
        hash ^= hash >> 16;
        float u = (float)(hash >> 8) / (float)(1 << 24), v = (float)(n % 64) / 64;
        int face;
        float s, t;
        tl_cube_locate(tl_region_direction(regions, region, u, v), &face, &s, &t);
        int x = (int)(s * (float)cube->size), y = (int)(t * (float)cube->size);
        hits[(face * cube->size + y) * cube->size + x]++;
    }
    double square = 0, expected = 0, total = 0;
    int found = 0;
    *groups = 0;
    for (uint32_t k = regions->first[region]; k < regions->first[region + 1]; k++)
        total += solid_angle_of(cube->size, (int)regions->texels[k]) *
                 (double)grey_of(cube, (int)regions->texels[k]);
    int outside = DRAWS;
    for (uint32_t k = regions->first[region]; k < regions->first[region + 1]; k++) {
        int texel = (int)regions->texels[k];
        expected += DRAWS * solid_angle_of(cube->size, texel) * (double)grey_of(cube, texel) / total;
        found += hits[texel];
        outside -= hits[texel];
        if (expected >= 40 || k + 1 == regions->first[region + 1]) {
            square += expected > 0 ? (found - expected) * (found - expected) / expected : 0;
            expected = found = 0;
            (*groups)++;
        }
    }
    /* v = 0 lies on a texel's edge, where rounding may take it to the neighbour. */
    assert_true(outside <= DRAWS / 64);
    free(hits);
    return square;
}

static void directions_are_sampled_by_luminance(void **state)
{
    (void)state;
    tl_cube cube = cube_of(64, smooth);
    for (int i = 0; i < 3 * 6 * 64 * 64; i++) /* texels of very different light side by side */
        cube.texels[i] *= 1 + (float)(i / 3 * 7 % 13);
    struct tl_regions regions = {0};
    tl_regions_cut_sphere(&cube, 96, &regions);
    for (int i = 0; i < 96; i += 19) {
        int groups;
        double square = chi_square(&regions, &cube, i, &groups), free_draws = groups - 1;
        printf("region %2d: chi square %.0f of %d groups\n", i, square, groups);
        assert_true(square < free_draws + 3.1 * sqrt(2 * free_draws) + 6);
        assert_true(square > 0);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* Both cuts, on both: sixteen even u lie closer to the region's centroid together than sixteen free ones
 * would, because neighbouring u are neighbouring texels. */
static void stratified_samples_cover_evenly(void **state)
{
    (void)state;
    tl_cube cube = cube_of(64, smooth);
    for (int sphere = 0; sphere < 2; sphere++) {
        struct tl_regions regions = {0};
        if (sphere)
            tl_regions_cut_sphere(&cube, 96, &regions);
        else
            tl_regions_cut(&cube, 96, &regions);
        double misses = 0, spreads = 0;
        for (int i = 0; i < 96; i++) {
            vec3s mean = {{0, 0, 0}};
            for (int n = 0; n < 16; n++) {
                vec3s drawn = tl_region_direction(&regions, i, ((float)n + 0.5f) / 16, 0.5f);
                mean = glms_vec3_add(mean, glms_vec3_scale(drawn, 1.0f / 16));
            }
            misses += (double)glms_vec3_distance2(glms_vec3_normalize(mean), regions.items[i].direction);
            spreads += (double)(regions.items[i].spread * regions.items[i].spread);
        }
        double ratio = sqrt(misses / spreads); /* free draws: 1 / sqrt(16) */
        printf("%s: 16 even draws miss the centroid by %.3f of the spread\n", sphere ? "sphere" : "faces",
               ratio);
        assert_true(ratio < 0.125);
        tl_regions_release(&regions);
    }
    tl_cube_release(&cube);
}

/* The share of region i's light in the texels before the one in this direction. */
static float place_in_region(const struct tl_regions *regions, int i, vec3s direction)
{
    const uint32_t texel = (uint32_t)tl_cube_texel(regions->size, direction);
    for (uint32_t k = regions->first[i]; k < regions->first[i + 1]; k++)
        if (regions->texels[k] == texel)
            return k > regions->first[i] ? regions->cumulative[k - 1] : 0;
    fail_msg("a direction outside of its region");
    return 0;
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Of any n terms in turn of the golden ratio's sequence the largest gap is less than 1.9 / n, beside a
 * texel's share. (Of 16 of the plastic number's: 0.2.) */
static void sequences_are_even(void **state)
{
    (void)state;
    enum { TERMS = 16 };
    tl_cube cube = cube_of(64, smooth);
    struct tl_regions regions = {0};
    tl_regions_cut_sphere(&cube, 24, &regions);
    for (int i = 0; i < 24; i++)
        for (uint32_t first = 0; first < 200; first += 7) {
            float places[TERMS + 1];
            for (uint32_t n = 0; n < TERMS; n++)
                places[n] = place_in_region(&regions, i, tl_region_sample(&regions, i, first + n));
            qsort(places, TERMS, sizeof *places, compare_floats);
            places[TERMS] = places[0] + 1;
            for (int n = 0; n < TERMS; n++)
                assert_true(places[n + 1] - places[n] < 1.9f / TERMS + 0.01f);
        }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* Root mean square angle between a texel's direction and the centroid of its region, in degrees, weighted by
 * luminance and by solid angle: what one number for each region loses. */
static void measure_quantisation(const struct tl_regions *regions, double degrees[2])
{
    double squares[2] = {0}, totals[2] = {0};
    for (int i = 0; i < regions->count; i++) {
        double sums[2][4] = {{0}};
        for (uint32_t k = regions->first[i]; k < regions->first[i + 1]; k++) {
            int texel = (int)regions->texels[k];
            const double weights[2] = {(double)regions->importance[texel],
                                       solid_angle_of(regions->size, texel)};
            vec3s direction = texel_direction(regions->size, texel, 0.5f, 0.5f);
            for (int m = 0; m < 2; m++) {
                for (int c = 0; c < 3; c++)
                    sums[m][c] += weights[m] * (double)direction.raw[c];
                sums[m][3] += weights[m];
            }
        }
        for (int m = 0; m < 2; m++) {
            const double *s = sums[m];
            if (s[3] > 0)
                squares[m] += s[3] - (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / s[3];
            totals[m] += s[3];
        }
    }
    for (int m = 0; m < 2; m++)
        degrees[m] = sqrt(squares[m] / totals[m]) * 180 / M_PI;
}

/* Below 24 regions the faces, which are even by construction, may be the better start. */
static void the_sphere_loses_less_than_the_faces(void **state)
{
    (void)state;
    const char *const names[] = {"envmaps/exr/brown_photostudio_02_1k_half_piz_rgba.exr",
                                 "envmaps/exr/kloppenheim_05_1k_float_zip.exr",
                                 "envmaps/exr/pmndrs_apartment_512.exr"};
    const char *paths[TL_COUNT(names)];
    for (size_t n = 0; n < TL_COUNT(names); n++)
        paths[n] = test_data(names[n]);
    for (size_t n = 0; n < TL_COUNT(names); n++) {
        tl_environment environment;
        tl_error error = {0};
        assert_ok(tl_environment_load(paths[n], &environment, &error), error);
        tl_cube cube = tl_cube_from_environment(&environment, 64);
        struct tl_regions sphere = {0}, faces = {0};
        printf("%s: degrees from the centroid by luminance, by solid angle\n", names[n]);
        for (size_t i = 0; i < TL_COUNT(counts); i++) {
            double of_sphere[2], of_faces[2];
            tl_regions_cut_sphere(&cube, counts[i], &sphere);
            tl_regions_cut(&cube, counts[i], &faces);
            measure_quantisation(&sphere, of_sphere);
            measure_quantisation(&faces, of_faces);
            printf("  N = %3d: sphere %5.2f %5.2f, faces %5.2f %5.2f\n", counts[i], of_sphere[0],
                   of_sphere[1], of_faces[0], of_faces[1]);
            assert_true(counts[i] < 24 ||
                        hypot(of_sphere[0], of_sphere[1]) < hypot(of_faces[0], of_faces[1]));
        }
        tl_regions_release(&sphere);
        tl_regions_release(&faces);
        tl_cube_release(&cube);
        tl_environment_release(&environment);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cuts_are_partitions_and_trees),
        cmocka_unit_test(regions_of_even_light_are_even),
        cmocka_unit_test(compact_light_is_never_cut),
        cmocka_unit_test(extremes_are_cut),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(spread_is_the_mean_square_angle),
        cmocka_unit_test(directions_are_sampled_by_luminance),
        cmocka_unit_test(stratified_samples_cover_evenly),
        cmocka_unit_test(sequences_are_even),
        cmocka_unit_test(the_sphere_loses_less_than_the_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
