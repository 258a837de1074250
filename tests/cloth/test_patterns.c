/* Real sewing patterns on the body that they were drafted for: all seams closed, nothing inside the body or
 * through itself, no more strain than worn cloth has, and not slid off. */
#include "assets/avatar.h"
#include "assets/pattern/pattern_worn.h"
#include "cloth/state.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

/* How many particles are in the body, and the highest one's height. */
static size_t count_inside(const tl_cloth *cloth, const tl_collider *collider, double *top)
{
    const double reach_m = 0.05;
    size_t inside = 0;
    *top = -INFINITY;
    for (size_t i = 0; i < cloth->particles.count; i++) {
        const double point[3] = {cloth->particles.x[i].x, cloth->particles.x[i].y, cloth->particles.x[i].z};
        struct tl_contact contact;
        inside += tl_collider_query(collider, point, reach_m, &contact) && contact.distance_m < 0;
        *top = fmax(*top, point[1]);
    }
    return inside;
}

static void wear(const char *pattern, float edge_m)
{
    const double shoulder_m = 1.457; /* mean_all.yaml: height - head_l */
    const char *body = test_data("avatars/mean_all.obj"), *path = test_data(pattern);
    tl_error error = {0};
    tl_avatar avatar;
    tl_garment garment;
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    assert_ok(tl_avatar_load(body, &avatar, &error), error);
    const struct tl_pattern_wearer wearer = {body, &avatar.model.mesh};
    assert_ok(tl_pattern_worn(path, &wearer, edge_m, &garment, &error), error);
    tl_collider *collider = tl_collider_create(&avatar.model.mesh, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    assert_ok(tl_cloth_settle(cloth, collider, &error), error);
    struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
    double top;
    assert_int_equal(count_inside(cloth, collider, &top), 0);
    assert_int_equal(report.open_seams, 0);
    assert_int_equal(report.piece_count, 1);
    assert_int_equal(report.crossing_count, 0);
    assert_true(tl_cloth_is_still(cloth));
    assert_true(report.rms_strain < 0.03); /* what app/scene/drape calls stretched */
    assert_true(top > shoulder_m - 0.05);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_garment_release(&garment);
    tl_avatar_release(&avatar);
}

static void test_shirt(void **state)
{
    (void)state;
    wear("patterns/shirt_mean_specification.json", params_defaults().edge_m);
}

static void test_dress(void **state)
{
    (void)state;
    wear("patterns/dress_pencil_specification.json", 0.027f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shirt),
        cmocka_unit_test(test_dress),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
