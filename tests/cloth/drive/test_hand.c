/* A hand pulls at a vertex. It moves at constant speed within a frame, so that cloth of any resolution can
 * follow. */
#include "tests/cloth/solvers.h"

#include "cloth/drive/hand.h"
#include "cloth/measure.h"
#include "config/base/log.h"

#include <stdio.h>

/* The hand moves a quarter of a sheet with edges of 0.5 mm per frame: six edges. It yields if it strains an
 * edge by more than TL_HAND_STRAIN; the next edges may strain as much. The cloth has to follow all the same,
 * as fast as one sweep per substep passes the pull on (measured: 31 to 45 mm of 50 during the motion, then
 * oscillating about the hand). */
static void fine_cloth_follows_the_hand(void **state)
{
    (void)state;
    const struct sheet_shape shape = {24, 24, 0.012, 0.012};
    const int moving = 15, waiting = 45;
    const float way_m = 0.05f;
    tl_error error = {0};
    tl_garment garment = sheet_make(&shape, NULL);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.gravity = 0;
    fabric.damping = 3;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(cloth != NULL, error);
    uint32_t corner = sheet_vertex(&shape, shape.columns, 0);
    vec3s home = garment.model.mesh.positions[corner];
    double max_strain = 0;
    for (int frame = 1; frame <= moving + waiting; frame++) {
        vec3s hand = home;
        hand.x += way_m * (float)(frame < moving ? frame : moving) / (float)moving;
        tl_cloth_grab(cloth, corner, hand);
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
        max_strain = fmax(max_strain, tl_cloth_max_strain(cloth));
    }
    double behind = (double)(home.x + way_m) - cloth->particles.x[corner].x;
    printf("strain %.3f, %.2f mm behind the hand\n", max_strain, 1e3 * behind);
    assert_true(max_strain < 2 * TL_HAND_STRAIN);
    assert_true(behind < 0.5 * (double)way_m);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fine_cloth_follows_the_hand),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
