#include "render/pem/regions.h"

#include "tests/testing.h"

#include <string.h>

static const int counts[] = {6, 12, 24, 36, 48, 96, 384};

static double luminance(const tl_cube *cube, int i)
{
    const float *texel = cube->texels + 3 * (size_t)i;
    return 0.2126 * (double)texel[0] + 0.7152 * (double)texel[1] + 0.0722 * (double)texel[2];
}

/* Radiance 2 + x + y/2 + z/3 of the direction: at most 3.3 times brighter in one place than in another. */
static tl_cube smooth_cube(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        vec3s direction =
            glms_vec3_normalize(tl_cube_direction(i / (size * size), ((float)(i % size) + 0.5f) / (float)size,
                                                  ((float)(i / size % size) + 0.5f) / (float)size));
        float radiance = 2 + direction.x + direction.y / 2 + direction.z / 3;
        for (int c = 0; c < 3; c++)
            cube.texels[3 * i + c] = radiance * (float)(c + 1);
    }
    return cube;
}

/* Every texel in one region and none twice, none empty, and the numbers of each as a direct sum gives them.
 */
static void check_partition(const tl_cube *cube, const struct tl_regions *regions, int count)
{
    int size = cube->size;
    unsigned char *owners = calloc(6 * (size_t)size * (size_t)size, 1);
    assert_int_equal(regions->count, count);
    for (int i = 0; i < count; i++) {
        const struct tl_region *region = &regions->items[i];
        double importance = 0, solid_angle = 0;
        assert_true(region->face >= 0 && region->face < 6);
        assert_true(region->x0 >= 0 && region->x0 < region->x1 && region->x1 <= size);
        assert_true(region->y0 >= 0 && region->y0 < region->y1 && region->y1 <= size);
        for (int y = region->y0; y < region->y1; y++) {
            for (int x = region->x0; x < region->x1; x++) {
                int texel = (region->face * size + y) * size + x;
                double weight = (double)tl_cube_solid_angle(size, x, y);
                owners[texel]++;
                importance += weight * luminance(cube, texel);
                solid_angle += weight;
            }
        }
        assert_near(region->importance, importance, 1e-6 * importance);
        assert_near(region->solid_angle, solid_angle, 1e-6 * solid_angle);
        assert_near(2 * M_PI * (1 - cos((double)region->cone)), solid_angle, 1e-5);
        assert_near(glms_vec3_norm(region->direction), 1, 1e-6);
    }
    for (int i = 0; i < 6 * size * size; i++)
        assert_int_equal(owners[i], 1);
    free(owners);
}

static void partitions_are_exact(void **state)
{
    (void)state;
    tl_cube cube = smooth_cube(64);
    struct tl_regions regions = {0};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        tl_regions_cut(&cube, counts[i], &regions);
        check_partition(&cube, &regions, counts[i]);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* One cut of w texels misses the wanted share by at most half a slice, 1 / 2w of what it cuts; the regions of
 * a face of 128 are 16 texels wide at N = 384, after cuts of 128, 64, 32 twice: 2 (1/256 + 1/128 + 1/64) =
 * 5.5 % of a third, radiance varying by less than two inside them: 1.25 leaves room for both. */
static void importances_of_a_smooth_environment_are_equal(void **state)
{
    (void)state;
    tl_cube cube = smooth_cube(128);
    struct tl_regions regions = {0};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        tl_regions_cut(&cube, counts[i], &regions);
        double worst = 1;
        for (int face = 0; face < 6; face++) {
            float low = INFINITY, high = 0;
            for (int k = 0; k < counts[i] / 6; k++) {
                float importance = regions.items[face * counts[i] / 6 + k].importance;
                low = fminf(low, importance);
                high = fmaxf(high, importance);
            }
            worst = fmax(worst, (double)(high / low));
        }
        printf("N = %3d: largest over smallest importance of a face %.3f\n", counts[i], worst);
        assert_true(worst < 1.25);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* The direction is where a luminance-weighted sum says, here over one whole face by brute force. */
static void directions_are_centroids(void **state)
{
    (void)state;
    tl_cube cube = smooth_cube(32);
    struct tl_regions regions = {0};
    tl_regions_cut(&cube, 6, &regions);
    for (int face = 0; face < 6; face++) {
        double sum[3] = {0};
        for (int i = 0; i < 32 * 32; i++) {
            int x = i % 32, y = i / 32;
            vec3s direction =
                glms_vec3_normalize(tl_cube_direction(face, ((float)x + 0.5f) / 32, ((float)y + 0.5f) / 32));
            double weight = luminance(&cube, face * 1024 + i) * (double)tl_cube_solid_angle(32, x, y);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (double)direction.raw[c];
        }
        double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        for (int c = 0; c < 3; c++)
            assert_near(regions.items[face].direction.raw[c], sum[c] / length, 1e-6);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* In the dark the cuts are geometric: no region's solid angle is more than twice another's, and directions
 * lie inside their regions. */
static void black_is_cut_by_solid_angle(void **state)
{
    (void)state;
    tl_cube cube = tl_cube_create(64);
    struct tl_regions regions = {0};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        tl_regions_cut(&cube, counts[i], &regions);
        check_partition(&cube, &regions, counts[i]);
        for (int k = 0; k < counts[i]; k++) {
            const struct tl_region *region = &regions.items[k];
            double share = (double)region->solid_angle * counts[i] / (4 * M_PI);
            assert_true(share > 0.7 && share < 1.4);
            int face;
            float s, t;
            tl_cube_locate(region->direction, &face, &s, &t);
            assert_int_equal(face, region->face);
            assert_true(s * 64 > (float)region->x0 && s * 64 < (float)region->x1);
            assert_true(t * 64 > (float)region->y0 && t * 64 < (float)region->y1);
        }
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* A sun of one texel, with and without a sky: still a partition without empty regions, and one region holds
 * the sun and looks at it. */
static void a_sun_is_cut_out(void **state)
{
    (void)state;
    for (int sky = 0; sky < 2; sky++) {
        tl_cube cube = tl_cube_create(64);
        for (int i = 0; i < 18 * 64 * 64; i++)
            cube.texels[i] = (float)sky;
        int x = 41, y = 7;
        for (int c = 0; c < 3; c++)
            cube.texels[3 * ((2 * 64 + y) * 64 + x) + c] = 1e6f;
        struct tl_regions regions = {0};
        tl_regions_cut(&cube, 96, &regions);
        check_partition(&cube, &regions, 96);
        for (int i = 0; i < 96; i++) {
            const struct tl_region *region = &regions.items[i];
            if (region->face != 2 || x < region->x0 || x >= region->x1 || y < region->y0 || y >= region->y1)
                continue;
            vec3s sun = glms_vec3_normalize(tl_cube_direction(2, 41.5f / 64, 7.5f / 64));
            assert_true(glms_vec3_dot(sun, region->direction) > 0.9999f);
            assert_true(region->cone < 0.25f);
        }
        tl_regions_release(&regions);
        tl_cube_release(&cube);
    }
}

/* As many regions as texels, and a number of both that does not halve evenly. */
static void small_faces_are_shared_out(void **state)
{
    (void)state;
    tl_cube cube = smooth_cube(3);
    struct tl_regions regions = {0};
    tl_regions_cut(&cube, 54, &regions);
    check_partition(&cube, &regions, 54);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
    cube = smooth_cube(8);
    tl_regions_cut(&cube, 384, &regions);
    check_partition(&cube, &regions, 384);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* More regions than texels: the surplus regions are empty and still have a direction. */
static void surplus_regions_are_empty(void **state)
{
    (void)state;
    tl_cube cube = smooth_cube(1);
    struct tl_regions regions = {0};
    tl_regions_cut(&cube, 24, &regions);
    double solid_angle = 0;
    for (int i = 0; i < 24; i++) {
        solid_angle += (double)regions.items[i].solid_angle;
        assert_near(glms_vec3_norm(regions.items[i].direction), 1, 1e-6);
        assert_int_equal(regions.items[i].face, i / 4);
        assert_true((regions.items[i].importance > 0) == (i % 4 == 0));
    }
    assert_near(solid_angle, 4 * M_PI, 1e-5);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(partitions_are_exact),
        cmocka_unit_test(importances_of_a_smooth_environment_are_equal),
        cmocka_unit_test(directions_are_centroids),
        cmocka_unit_test(black_is_cut_by_solid_angle),
        cmocka_unit_test(a_sun_is_cut_out),
        cmocka_unit_test(small_faces_are_shared_out),
        cmocka_unit_test(surplus_regions_are_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
