/* With self_contact no two triangles of the cloth cross, in any frame of settling and of a second in which
 * the wearer's shoulders turn against his feet: built-in garments on the form, real ones on their bodies, a
 * file that comes crossed from its first frame on. The same bits follow at any number of threads.
 * TOILE_FRAMES sets the length of the motion, TOILE_BRUTE=1 counts every frame by brute force too. */
#include "assets/avatar.h"
#include "cloth/step/advance.h"
#include "tests/cloth/crossing_oracle.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/twist.h"
#include "tests/testing.h"

#include "config/base/hash.h"
#include "config/base/log.h"

#include <omp.h>

#define SETTLING 20 /* frames: the garments have nearly come to rest */

struct worn {
    tl_garment garment;
    tl_avatar avatar;
    tl_collider *collider;
    tl_cloth *cloth;
    vec3s *pose;
};

static int motion_frames(void)
{
    const char *wanted = getenv("TOILE_FRAMES");
    return wanted ? atoi(wanted) : 20;
}

static void put_on(struct worn *worn, double bending)
{
    tl_error error = {0};
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.self_contact = true;
    fabric.bend_weft *= bending;
    fabric.bend_warp *= bending;
    worn->pose = TL_NEW_ARRAY(vec3s, worn->avatar.model.mesh.vertex_count);
    worn->collider = tl_collider_create(&worn->avatar.model.mesh, true, &error);
    worn->cloth = tl_cloth_create(&worn->garment, &fabric, &params, &error);
    assert_non_null(worn->cloth);
}

static void take_off(struct worn *worn)
{
    tl_cloth_destroy(&worn->cloth);
    tl_collider_destroy(&worn->collider);
    tl_garment_release(&worn->garment);
    tl_avatar_release(&worn->avatar);
    free(worn->pose);
}

static void twist(struct worn *worn, int frame)
{
    const tl_mesh *mesh = &worn->avatar.model.mesh;
    twist_pose(mesh, frame, worn->pose);
    tl_collider_move(worn->collider, worn->pose);
}

/* Plays settling and twist; returns a hash of all positions. Every frame is measured by the product's
 * counter, the middle of both phases by brute force too. */
static uint64_t play(struct worn *worn, const char *name, int settling, int motion)
{
    tl_error error = {0};
    uint64_t hash = TL_HASH_START;
    double strain = 0, deepest = 0;
    for (int frame = 0; frame < settling + motion; frame++) {
        struct tl_advance_params advance = {.drag = 5};
        if (frame >= settling) {
            advance.drag = 0;
            twist(worn, frame - settling + 1);
        }
        assert_ok(tl_cloth_advance(worn->cloth, worn->collider, &advance, &error), error);
        struct tl_cloth_report report = tl_cloth_measure(worn->cloth, worn->collider);
        assert_int_equal(report.crossing_count, 0);
        if (getenv("TOILE_BRUTE") || frame == settling / 2 || frame == settling + motion / 2)
            assert_int_equal(oracle_crossings(&worn->cloth->topology, worn->cloth->particles.x), 0);
        if (frame >= settling) {
            strain = fmax(strain, report.max_strain);
            deepest = fmax(deepest, report.deepest_m);
        }
        hash = tl_hash(hash, worn->cloth->particles.x, worn->cloth->particles.count * sizeof(vec3d));
    }
    printf("%s: no crossing in %d frames, strain in motion %.2f, %zu windows and %zu lists\n", name,
           settling + motion, strain, worn->cloth->self_contact.windows, worn->cloth->self_contact.lists);
    assert_true(strain < 1);
    assert_near(deepest, 0, 1e-6);
    return hash;
}

static void test_built_in(void **state)
{
    (void)state;
    tl_error error = {0};
    const char *const names[] = {"dress", "skirt"};
    for (size_t i = 0; i < TL_COUNT(names); i++) {
        struct worn worn = {.avatar = tl_avatar_form()};
        assert_ok(tl_garment_cut(names[i], params_defaults().edge_m, &worn.garment, &error), error);
        put_on(&worn, 1);
        play(&worn, names[i], SETTLING, motion_frames());
        take_off(&worn);
    }
}

/* As limp as satin: folds are sharper. */
static void test_limp(void **state)
{
    (void)state;
    tl_error error = {0};
    struct worn worn = {.avatar = tl_avatar_form()};
    assert_ok(tl_garment_cut("dress", params_defaults().edge_m, &worn.garment, &error), error);
    put_on(&worn, 0.3);
    play(&worn, "dress, limp", SETTLING, motion_frames());
    take_off(&worn);
}

static void load(struct worn *worn, const char *garment, const char *avatar)
{
    tl_error error = {0};
    const char *garment_path = test_data(garment), *avatar_path = test_data(avatar);
    assert_ok(tl_garment_load(garment_path, &worn->garment, &error), error);
    assert_ok(tl_avatar_load(avatar_path, &worn->avatar, &error), error);
    put_on(worn, 1);
}

static void test_sports_suit(void **state)
{
    (void)state;
    struct worn worn = {0};
    load(&worn, "garments/mh_female_sportsuit01.glb", "avatars/mh_female_body.glb");
    play(&worn, "sports suit", SETTLING, motion_frames());
    take_off(&worn);
}

/* The shirt comes through the trousers: 170 pairs cross in the file. */
static void test_casual_suit(void **state)
{
    (void)state;
    struct worn worn = {0};
    load(&worn, "garments/mh_male_casualsuit06.glb", "avatars/mh_male_body.glb");
    assert_true(tl_cloth_measure(worn.cloth, NULL).crossing_count > 100);
    play(&worn, "casual suit", SETTLING, motion_frames());
    take_off(&worn);
}

/* From a crossed start, in which untangling, lists and windows all run. */
static void test_threads(void **state)
{
    (void)state;
    uint64_t hashes[2];
    for (int threads = 1; threads <= 3; threads += 2) {
        struct worn worn = {0};
        omp_set_num_threads(threads);
        load(&worn, "garments/mh_male_casualsuit06.glb", "avatars/mh_male_body.glb");
        hashes[threads / 2] = play(&worn, "casual suit", 3, 3);
        take_off(&worn);
    }
    assert_true(hashes[0] == hashes[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_built_in),    cmocka_unit_test(test_limp),
        cmocka_unit_test(test_sports_suit), cmocka_unit_test(test_casual_suit),
        cmocka_unit_test(test_threads),
    };
    tl_log_set_level(TL_LOG_WARN);
    cmocka_set_test_filter(getenv("TOILE_TESTS")); /* NULL: all */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
