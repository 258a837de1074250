/* The ground: its disc, what it hides, and the mesh that stands for it. */
#include "render/surfaces/ground.h"

#include "tests/testing.h"

static struct tl_ground ground;

static int make_ground(void **state)
{
    (void)state;
    tl_ground_make(&(struct tl_casters){{{0.2f, 0.9f, -0.1f}}, 0.9f}, TL_GROUND_GREY, &ground);
    return 0;
}

/* The mesh goes round the disc and nothing of it is seen twice: its area is that of the polygon about the
 * disc, with every triangle facing up. */
static void test_mesh_covers_the_disc(void **state)
{
    (void)state;
    double area = 0;
    for (size_t i = 0; i < ground.surface.index_count; i += 3) {
        vec3s p[3];
        for (size_t c = 0; c < 3; c++)
            p[c] = ground.positions[ground.indices[i + c]];
        vec3s across = glms_vec3_cross(glms_vec3_sub(p[1], p[0]), glms_vec3_sub(p[2], p[0]));
        assert_true(across.y > 0);
        area += (double)across.y / 2;
    }
    double sides = TL_GROUND_SEGMENTS, radius = (double)ground.radius;
    assert_near(area, sides * tan(M_PI / sides) * radius * radius, 1e-5 * area);
}

/* Under the figure, here 1.8 m tall, rings are 2 to 3 cm apart. */
static void test_rings_are_close_under_the_figure(void **state)
{
    (void)state;
    float last = 0;
    for (int ring = 1; ring <= 8; ring++) {
        float radius = ground.radius * ground.uvs[1 + (ring - 1) * TL_GROUND_SEGMENTS].x;
        assert_true(radius - last > 0.02f && radius - last < 0.04f);
        last = radius;
    }
}

/* Whole to half its radius, half gone at three quarters (smoothstep), nothing at the rim. */
static void test_cover(void **state)
{
    (void)state;
    float x = ground.centre.x, z = ground.centre.z, r = ground.radius;
    assert_near(tl_ground_cover(&ground, x + 0.3f * r, z - 0.3f * r), 1, 0);
    assert_near(tl_ground_cover(&ground, x, z + 0.75f * r), 0.5, 1e-6);
    assert_near(tl_ground_cover(&ground, x + 0.6f * r, z + 0.8f * r), 0, 1e-6);
    assert_near(tl_ground_cover(NULL, x, z), 0, 0);
}

static void test_visibility(void **state)
{
    (void)state;
    vec3s above = {{ground.centre.x, 1, ground.centre.z}}, below = {{above.x, -1, above.z}};
    float slope = 1 / (0.75f * ground.radius); /* meets the plane at three quarters of the radius */
    vec3s slanting = glms_vec3_normalize((vec3s){{1, -slope, 0}});
    assert_near(tl_ground_visibility(&ground, above, (vec3s){{0, -1, 0}}), 0, 0);
    assert_near(tl_ground_visibility(&ground, above, slanting), 0.5, 1e-5);
    assert_near(tl_ground_visibility(&ground, above, (vec3s){{0.6f, 0.8f, 0}}), 1, 0);
    assert_near(tl_ground_visibility(&ground, below, (vec3s){{0, -1, 0}}), 1, 0);
    assert_near(tl_ground_visibility(NULL, above, (vec3s){{0, -1, 0}}), 1, 0);
}

/* What a ray from above meets, all around and far out, is where the weights of its triangle put it. */
static void test_meets_its_triangles(void **state)
{
    (void)state;
    for (int i = 0; i < 4000; i++) {
        const float far = 0.99f * ground.radius * powf((float)i / 4000, 2), turn = 2.4f * (float)i;
        const vec3s from = {{ground.centre.x + far * cosf(turn), 1, ground.centre.z + far * sinf(turn)}};
        vec3s point, sum = {{0, 0, 0}};
        uint32_t triangle;
        float weights[3];
        assert_true(tl_ground_meet(&ground, from, (vec3s){{0, -1, 0}}, &point, &triangle, weights));
        for (int k = 0; k < 3; k++)
            sum = glms_vec3_add(
                sum,
                glms_vec3_scale(ground.positions[ground.indices[3 * triangle + (uint32_t)k]], weights[k]));
        assert_near(glms_vec3_distance(sum, point), 0, 2e-4 * (double)ground.radius);
    }
}

/* Lengths of shadow maps are the options' own for garments, and a constant share of what is smaller. */
static void test_scale(void **state)
{
    (void)state;
    assert_near(tl_casters_scale(&(struct tl_casters){.radius = 100}), 1, 0);
    assert_near(tl_casters_scale(&(struct tl_casters){.radius = 0.9f}), 1, 0);
    assert_near(tl_casters_scale(&(struct tl_casters){.radius = 1e-3f}), 2e-3, 1e-9);
    assert_near(tl_casters_scale(&(struct tl_casters){.radius = 1e-2f}), 2e-2, 1e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mesh_covers_the_disc),
        cmocka_unit_test(test_rings_are_close_under_the_figure),
        cmocka_unit_test(test_cover),
        cmocka_unit_test(test_visibility),
        cmocka_unit_test(test_meets_its_triangles),
        cmocka_unit_test(test_scale),
    };
    return cmocka_run_group_tests(tests, make_ground, NULL);
}
