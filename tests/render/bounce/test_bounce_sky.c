/* The sky that rays of bounced light go to: its means, its directions by luminance, and their density. */
#include "render/bounce/bounce_internal.h"

#include "config/colour/luminance.h"

#include "tests/testing.h"

/* Bright to the upper left, with texels of very different light side by side. */
static tl_cube cube_of(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        const vec3s direction = tl_cube_texel_direction(size, i);
        const float light = expf(4 * (direction.y - direction.x)) * (1 + (float)(i * 7 % 13));
        for (int c = 0; c < 3; c++)
            cube.texels[3 * i + c] = light * (1 + (float)c * direction.z);
    }
    return cube;
}

static vec3s sum_of(const tl_cube *cube)
{
    double sums[3] = {0};
    for (int i = 0; i < 6 * cube->size * cube->size; i++)
        for (int c = 0; c < 3; c++)
            sums[c] += (double)cube->texels[3 * i + c] *
                       (double)tl_cube_solid_angle(cube->size, i % cube->size, i / cube->size % cube->size);
    return (vec3s){{(float)sums[0], (float)sums[1], (float)sums[2]}};
}

static void test_means(void **state)
{
    (void)state;
    for (int size = 16; size <= 128; size *= 2) {
        struct tl_bounce_sky sky = {0};
        tl_cube cube = cube_of(size);
        tl_bounce_sky_follow(&sky, &cube, 1);
        const vec3s given = sum_of(&cube), kept = sum_of(&sky.cube);
        const double maximum =
            size < sky.cube.size ? 0.02 : 1e-4; /* texels that are repeated keep no angle */
        for (int c = 0; c < 3; c++)
            assert_near((double)(kept.raw[c] / given.raw[c]), 1, maximum);
        tl_bounce_sky_release(&sky);
        tl_cube_release(&cube);
    }
}

/* Directions of points that fill the unit square: their shares of each of eight octants are the light's. */
static void test_directions(void **state)
{
    (void)state;
    enum { DRAWS = 1 << 18 };
    struct tl_bounce_sky sky = {0};
    tl_cube cube = cube_of(64);
    tl_bounce_sky_follow(&sky, &cube, 1);
    const tl_cube *kept = &sky.cube;
    double light[8] = {0}, drawn[8] = {0}, density = 0, all = 0;
    for (int i = 0; i < 6 * kept->size * kept->size; i++) {
        const vec3s direction = tl_cube_texel_direction(kept->size, i);
        const double angle =
            (double)tl_cube_solid_angle(kept->size, i % kept->size, i / kept->size % kept->size);
        const int octant = (direction.x > 0) + 2 * (direction.y > 0) + 4 * (direction.z > 0);
        float pdf;
        const vec3s colour = tl_bounce_sky_colour(&sky, direction, &pdf);
        light[octant] += angle * (double)tl_luminance(colour.raw);
        all += angle * (double)tl_luminance(colour.raw);
        density += angle * (double)pdf;
    }
    assert_near(density, 1, 1e-5);
    for (int i = 0; i < DRAWS; i++) {
        const vec2s at = {{((float)i + 0.5f) / DRAWS, ((float)(i * 3 % 256) + 0.5f) / 256}};
        vec3s direction;
        assert_true(tl_bounce_sky_sample(&sky, at, &direction));
        assert_near((double)glms_vec3_norm(direction), 1, 1e-5);
        drawn[(direction.x > 0) + 2 * (direction.y > 0) + 4 * (direction.z > 0)] += 1.0 / DRAWS;
    }
    for (int octant = 0; octant < 8; octant++) {
        printf("octant %d: %.4f of the light, %.4f of the directions\n", octant, light[octant] / all,
               drawn[octant]);
        assert_near(drawn[octant], light[octant] / all, 2e-4);
    }
    tl_bounce_sky_release(&sky);
    tl_cube_release(&cube);
}

static void test_follows(void **state)
{
    (void)state;
    struct tl_bounce_sky sky = {0};
    tl_cube bright = cube_of(32), black = tl_cube_create(32);
    vec3s direction;
    float pdf;
    tl_bounce_sky_follow(&sky, &black, 1);
    assert_false(tl_bounce_sky_sample(&sky, (vec2s){{0.5f, 0.5f}}, &direction));
    assert_true(tl_bounce_sky_colour(&sky, (vec3s){{0, 1, 0}}, &pdf).x == 0 && pdf == 0);
    tl_bounce_sky_follow(&sky, &bright, 1);
    assert_false(tl_bounce_sky_sample(&sky, (vec2s){{0.5f, 0.5f}}, &direction));
    tl_bounce_sky_follow(&sky, &bright, 2);
    assert_true(tl_bounce_sky_sample(&sky, (vec2s){{0.5f, 0.5f}}, &direction));
    assert_true(tl_bounce_sky_colour(&sky, (vec3s){{0, 1, 0}}, &pdf).x > 0 && pdf > 0);
    tl_bounce_sky_release(&sky);
    tl_cube_release(&bright);
    tl_cube_release(&black);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_means), cmocka_unit_test(test_directions),
                                       cmocka_unit_test(test_follows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
