#include "render/env/layout.h"

#include "config/base/memory.h"

#include "tests/testing.h"

static struct tl_sphere_map map_of(enum tl_layout layout, int size)
{
    int64_t width, height;
    tl_layout_extent(layout, size, &width, &height);
    return (struct tl_sphere_map){layout, (int)width, (int)height};
}

/* A fixed sequence that fills the unit square evenly: multiples of the plastic number's powers. */
static vec3s direction_number(int i)
{
    double a = fmod(0.5 + i * 0.7548776662466927, 1), b = fmod(0.5 + i * 0.5698402909980532, 1);
    double z = 2 * a - 1, radius = sqrt(1 - z * z), phi = 2 * M_PI * b;
    return (vec3s){{(float)(radius * cos(phi)), (float)(radius * sin(phi)), (float)z}};
}

/* Directions are floats: 6e-8 of each component. At the rim of the ball the point is ill-conditioned in the
 * direction. The loss is in the point; the direction is recovered exactly. */
static void check_round_trip(const struct tl_sphere_map *map, vec3s direction)
{
    double x, y;
    tl_layout_locate(map, direction, &x, &y);
    assert_true(x >= 0 && x <= map->width && y >= 0 && y <= map->height);
    vec3s back = tl_layout_direction(map, x, y);
    assert_true(glms_vec3_distance(glms_vec3_normalize(direction), back) < 2e-6f);
}

static void directions_return(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_sphere_map map = map_of((enum tl_layout)layout, 100);
        for (int i = 0; i < 20000; i++)
            check_round_trip(&map, direction_number(i));
        /* axes (poles, centres of the discs, the singular -Z of the ball), edges and corners of the cube, and
         * directions near them */
        for (int i = 0; i < 27; i++)
            for (int step = -1; step <= 1 && i != 13; step++) {
                float beside = 1e-4f * (float)step;
                int layer = i / 9 - 1;
                vec3s at = {{(float)(i % 3 - 1) + beside, (float)(i / 3 % 3 - 1) - beside, (float)layer}};
                check_round_trip(&map, glms_vec3_normalize(at));
            }
    }
}

static void texels_return(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_sphere_map map = map_of((enum tl_layout)layout, 37);
        for (int y = 0; y < map.height; y++)
            for (int x = 0; x < map.width; x++) {
                if (!tl_layout_contains(&map, x + 0.5, y + 0.5))
                    continue;
                double back_x, back_y;
                vec3s direction = tl_layout_direction(&map, x + 0.5, y + 0.5);
                tl_layout_locate(&map, direction, &back_x, &back_y);
                assert_near(back_x, x + 0.5, 1e-3);
                assert_near(back_y, y + 0.5, 1e-3);
                assert_int_equal(tl_layout_texel(&map, direction), y * map.width + x);
            }
    }
}

/* docs/inside.md, conventions: u = 0.5 + atan2(x, -z) / 2pi, v = acos(y) / pi. */
static void latlong_is_the_convention(void **state)
{
    (void)state;
    struct tl_sphere_map map = map_of(TL_LAYOUT_LATLONG, 50);
    for (int i = 0; i < 1000; i++) {
        vec3s direction = direction_number(i);
        double x, y;
        tl_layout_locate(&map, direction, &x, &y);
        assert_near(x, 100 * (0.5 + atan2((double)direction.x, -(double)direction.z) / (2 * M_PI)), 1e-9);
        assert_near(y, 50 * acos((double)direction.y) / M_PI, 1e-3); /* acos of a float, near a pole */
    }
}

/* The direction that an orthographic camera, looking along `side` -Z, sees in a mirror with this normal. */
static vec3s reflected(double x, double y, double z, double side)
{
    double scale = 2 * z / (x * x + y * y + z * z);
    return (vec3s){{(float)(side * scale * x), (float)(scale * y), (float)(side * (scale * z - 1))}};
}

/* A sphere's normal is (x, y, sqrt(1 - x^2 - y^2)), the paraboloid's (x, y, 1) [Heidrich and Seidel
 * 1999, 4.1]. */
static void discs_are_mirrors(void **state)
{
    (void)state;
    struct tl_sphere_map ball = map_of(TL_LAYOUT_SPHERE, 200), bowls = map_of(TL_LAYOUT_PARABOLOID, 200);
    for (int i = 0; i < 2000; i++) {
        vec3s normal = direction_number(i);
        double x = (double)normal.x, y = (double)normal.y, z = sqrt(fmax(1 - x * x - y * y, 0));
        vec3s seen = tl_layout_direction(&ball, 100 * (1 + x), 100 * (1 - y));
        assert_true(glms_vec3_distance(seen, reflected(x, y, z, 1)) < 1e-6f);
        vec3s front = tl_layout_direction(&bowls, 100 * (1 + x), 100 * (1 - y));
        assert_true(glms_vec3_distance(front, reflected(x, y, 1, 1)) < 1e-6f);
        vec3s back = tl_layout_direction(&bowls, 200 + 100 * (1 + x), 100 * (1 - y));
        assert_true(glms_vec3_distance(back, reflected(x, y, 1, -1)) < 1e-6f);
    }
}

static void solid_angles_sum_to_the_sphere(void **state)
{
    (void)state;
    const int sizes[] = {1, 2, 3, 17, 128};
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++)
        for (size_t i = 0; i < TL_COUNT(sizes); i++) {
            struct tl_sphere_map map = map_of((enum tl_layout)layout, sizes[i]);
            double sum = 0;
            for (int y = 0; y < map.height; y++)
                for (int x = 0; x < map.width; x++)
                    sum += tl_layout_solid_angle(&map, x, y);
            assert_near(sum, 4 * M_PI, 1e-11); /* closed forms in double */
        }
}

/* Solid angle of the parallelogram of a small cell on the sphere, from directions within it only. */
static double spanned(const struct tl_sphere_map *map, double x, double y, double step)
{
    vec3s left = tl_layout_direction(map, x - step / 4, y), right = tl_layout_direction(map, x + step / 4, y);
    vec3s top = tl_layout_direction(map, x, y - step / 4), bottom = tl_layout_direction(map, x, y + step / 4);
    return 4 *
           (double)glms_vec3_norm(glms_vec3_cross(glms_vec3_sub(right, left), glms_vec3_sub(bottom, top)));
}

/* Texels against midpoint sums over 16 x 16 cells: off by 1 / (24 * 16^2) of what curves in a texel, and at a
 * rim by the cells that it cuts, about 22 of 256, each by a random half at most. Density goes with it. */
static void solid_angle_of_a_texel(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_sphere_map map = map_of((enum tl_layout)layout, 8);
        double largest = 0;
        for (int i = 0; i < map.width * map.height; i++)
            largest = fmax(largest, tl_layout_solid_angle(&map, i % map.width, i / map.width));
        double factor = tl_layout_solid_angle(&map, 4, 4) / tl_layout_density(&map, 4.5, 4.5);
        for (int i = 0; i < map.width * map.height; i++) {
            int x = i % map.width, y = i / map.width;
            double sum = 0, middle = spanned(&map, x + 0.5, y + 0.5, 1 / 16.0) * 256;
            bool whole = true;
            for (int k = 0; k < 256; k++) {
                int column = k % 16, row = k / 16;
                double at_x = x + (column + 0.5) / 16, at_y = y + (row + 0.5) / 16;
                if (tl_layout_contains(&map, at_x, at_y))
                    sum += spanned(&map, at_x, at_y, 1 / 16.0);
                else
                    whole = false;
            }
            assert_near(tl_layout_solid_angle(&map, x, y), sum, (whole ? 0.005 : 0.045) * largest);
            if (whole) /* the texel's middle against the first texel's mean, which differ by its curvature */
                assert_near(factor * tl_layout_density(&map, x + 0.5, y + 0.5), middle, 0.05 * largest);
        }
    }
}

/* Ratio of the largest to the smallest solid angle of texels wholly on the sphere. */
static double spread(enum tl_layout layout)
{
    struct tl_sphere_map map = map_of(layout, 256);
    double minimum = INFINITY, maximum = 0;
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            bool whole = true;
            for (int i = 0; i < 4; i++)
                whole = whole &&
                        tl_layout_contains(&map, x + (i & 1 ? 0.999 : 0.001), y + (i & 2 ? 0.999 : 0.001));
            double solid_angle = tl_layout_solid_angle(&map, x, y);
            minimum = whole ? fmin(minimum, solid_angle) : minimum;
            maximum = whole ? fmax(maximum, solid_angle) : maximum;
        }
    return maximum / minimum;
}

/* Spreads of [Heidrich and Seidel 1999, 4.1]: 3 sqrt(3) for the cube, 4 for the paraboloid. The ball's texels
 * all have the same solid angle (the paper speaks of its rim, where they are drawn out into slivers).
 * Outermost texels are 1/256 of a face away from where the extremes are: 1.2 % of (1 + u^2 + v^2)^1.5, less
 * of the others. */
static void sampling_spreads(void **state)
{
    (void)state;
    double cube = spread(TL_LAYOUT_CUBE), paraboloid = spread(TL_LAYOUT_PARABOLOID),
           ball = spread(TL_LAYOUT_SPHERE), octahedral = spread(TL_LAYOUT_OCTAHEDRAL);
    print_message("spread: cube %.4f, paraboloid %.4f, sphere %.6f, octahedral %.4f, latlong %.1f\n", cube,
                  paraboloid, ball, octahedral, spread(TL_LAYOUT_LATLONG));
    assert_near(cube, 3 * sqrt(3), 0.012 * 3 * sqrt(3));
    assert_near(paraboloid, 4, 0.012 * 4);
    assert_near(ball, 1, 1e-9);
    assert_near(octahedral, 3 * sqrt(3), 0.03 * 3 * sqrt(3)); /* |p|^-3; corners of faces of half the side */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_return),
        cmocka_unit_test(texels_return),
        cmocka_unit_test(latlong_is_the_convention),
        cmocka_unit_test(discs_are_mirrors),
        cmocka_unit_test(solid_angles_sum_to_the_sphere),
        cmocka_unit_test(solid_angle_of_a_texel),
        cmocka_unit_test(sampling_spreads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
