/* Holds: particles are drawn to their plane by a bounded speed, from the sides and in the phase that the hold
 * names. */
#include "cloth/drive/holds.h"
#include "tests/testing.h"

#include "config/base/memory.h"

#define H 0.01 /* s: a hold moves 5 mm */

/* A particle that was at `before` and is predicted at `after`, along an axis, under one hold; where the hold
 * leaves it. Render vertex 1 is particle 0. */
static double held(struct tl_hold hold, bool hanging, double before, double after, double w)
{
    const uint32_t weld[2] = {1, 0};
    struct tl_particles particles = tl_particles_create(2);
    vec3d *at[] = {&particles.previous[0], &particles.x[0]};
    const double values[] = {before, after};
    for (int i = 0; i < 2; i++)
        *at[i] = hold.axis == 0 ? (vec3d){values[i], 7, 7} : (vec3d){7, values[i], 7};
    particles.x[1] = particles.previous[1] = (vec3d){0.1, 0.1, 0.1};
    particles.w[0] = w;
    particles.w[1] = 1;
    hold.vertex = 1;
    tl_holds_draw(&hold, 1, weld, hanging, H, &particles);
    double result = hold.axis == 0 ? particles.x[0].x : particles.x[0].y;
    assert_near(hold.axis == 0 ? particles.x[0].y : particles.x[0].x, 7, 0);
    assert_near(particles.x[0].z, 7, 0);
    assert_near(particles.x[1].x, 0.1, 0);
    tl_particles_release(&particles);
    return result;
}

static void test_a_waist_is_drawn_to_its_height(void **state)
{
    (void)state;
    const struct tl_hold waist = {.axis = 1, .level_m = 1.25f};
    const double step = TL_HOLD_SPEED * H;
    assert_near(held(waist, true, 1.0, 0.99, 1), 1 + step, 1e-12); /* falling: raised by the step */
    assert_near(held(waist, true, 1.5, 1.52, 1), 1.5 - step, 1e-12);
    assert_near(held(waist, true, 1.25, 1.24, 1), 1.25, 1e-12);  /* there: does not fall */
    assert_near(held(waist, true, 1.249, 1.24, 1), 1.25, 1e-12); /* nearly there: no farther */
    assert_near(held(waist, true, 1.0, 1.1, 1), 1.1, 1e-12);     /* comes by itself, and faster */
    assert_near(held(waist, true, 1.0, 0.99, 0), 0.99, 0);       /* pinned */
    assert_near(held(waist, false, 1.0, 0.99, 1), 0.99, 0);      /* while it is sewn: free */
}

static void test_neck_lines_are_drawn_outwards_only(void **state)
{
    (void)state;
    const struct tl_hold left = {.axis = 0, .side = 1, .level_m = 0.125f};
    const struct tl_hold right = {.axis = 0, .side = -1, .level_m = -0.125f};
    const double step = TL_HOLD_SPEED * H;
    assert_near(held(left, false, 0.05, 0.05, 1), 0.05 + step, 1e-12);
    assert_near(held(left, false, 0.2, 0.19, 1), 0.19, 0);
    assert_near(held(left, false, 0.2, 0.12, 1), 0.125, 1e-12); /* was outside, and stays */
    assert_near(held(right, false, -0.05, -0.05, 1), -0.05 - step, 1e-12);
    assert_near(held(right, false, -0.2, -0.19, 1), -0.19, 0);
    assert_near(held(left, true, 0.05, 0.05, 1), 0.05, 0); /* while it hangs: free */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_waist_is_drawn_to_its_height),
        cmocka_unit_test(test_neck_lines_are_drawn_outwards_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
