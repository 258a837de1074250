/* The extremes: every run ends finite, or fails with TL_UNSTABLE and leaves the last good state. */
#include "cloth/measure.h"
#include "cloth/state.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

static bool all_finite(const tl_cloth *cloth)
{
    for (size_t i = 0; i < cloth->particles.count; i++)
        if (!vec3d_finite(cloth->particles.x[i]) || !vec3d_finite(cloth->particles.v[i]))
            return false;
    return true;
}

static vec3s above(double u, double v)
{
    return (vec3s){{(float)(u - 0.2), 0.71f, (float)(0.2 - v)}};
}

struct extreme {
    double stiffness, bending, density, dt;
    int substeps;
    int solver;
    int cells; /* a side of the sheet */
};

/* A sheet held at one corner falls on a sphere. Returns whether the solver refused. */
static bool run_refuses(const struct extreme *extreme)
{
    tl_error error = {0};
    const struct sheet_shape shape = {extreme->cells, extreme->cells, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, above);
    sheet_pin(&garment, 0);
    tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.2, 12);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.stretch_weft = fabric.stretch_warp = fabric.shear = extreme->stiffness;
    fabric.bend_weft = fabric.bend_warp = extreme->bending;
    fabric.areal_density = extreme->density;
    params.strain_limit = 0; /* the physical stretch decides the expected result */
    params.dt = extreme->dt;
    params.substeps = extreme->substeps;
    params.solver = extreme->solver;
    params.frame_rate = fmin(fmax(1 / (extreme->dt * 40), 10), 1000); /* 40 steps a frame when dt is small */
    tl_collider *collider = tl_collider_create(&sphere, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    bool good = true;
    for (int frame = 0; good && frame < 30; frame++) {
        good = tl_cloth_step(cloth, collider, &error);
        assert_true(good || error.code == TL_UNSTABLE);
        assert_true(all_finite(cloth));
        assert_true(tl_cloth_max_strain(cloth) <= 10);
    }
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
    return !good;
}

/* The hanging sheet weighs 0.2 N. Below 0.1 N/m it physically stretches by more than 10 and must be refused;
 * from 1 N/m on it does not, and must be solved. What stretches far has the finer sheet: its strain decides.
 */
static void test_stiffness_and_step(void **state)
{
    (void)state;
    const double stiffnesses[] = {0, 1e-2, 1, 1e3, 1e6, 1e9}, steps[] = {1e-5, 1e-3, 1.0 / 60, 0.1};
    for (size_t k = 0; k < TL_COUNT(stiffnesses); k++)
        for (size_t d = 0; d < TL_COUNT(steps); d++) {
            const int cells = stiffnesses[k] < 1e3 ? 12 : 8;
            bool refused = run_refuses(
                &(struct extreme){stiffnesses[k], 1e-5, 0.15, steps[d], 10, TL_CLOTH_PREVIEW, cells});
            bool long_enough = steps[d] > 1e-4; /* 12 ms of fall cause no stretch yet */
            assert_int_equal(refused, stiffnesses[k] < 0.1 && long_enough);
        }
}

static void test_bending_and_mass(void **state)
{
    (void)state;
    const double bendings[] = {0, 1e-9, 1e-3, 1e3}, densities[] = {1e-4, 1, 100};
    for (size_t b = 0; b < TL_COUNT(bendings); b++)
        for (size_t m = 0; m < TL_COUNT(densities); m++)
            assert_false(run_refuses(
                &(struct extreme){1e3, bendings[b], densities[m], 1.0 / 60, 10, TL_CLOTH_PREVIEW, 8}));
}

/* Every vertex at random in a cube of 1 m, or all at one point: the sheet recovers to strain below 1. */
static void test_scrambled_and_collapsed(void **state)
{
    (void)state;
    tl_error error = {0};
    for (int collapsed = 0; collapsed < 2; collapsed++) {
        const struct sheet_shape shape = {8, 8, 0.4, 0.4};
        tl_garment garment = sheet_make(&shape, above);
        struct tl_cloth_fabric fabric = fabric_defaults();
        struct tl_cloth_params params = params_defaults();
        params.gravity = 0;
        fabric.damping = 2;
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
        uint32_t noise = 1;
        for (size_t i = 0; i < cloth->particles.count; i++) {
            double *x = &cloth->particles.x[i].x;
            for (int k = 0; k < 3; k++) {
                noise = noise * 1664525u + 1013904223u;
                x[k] = collapsed ? 1e-7 * (noise >> 8) / 16777216.0 : (noise >> 8) / 16777216.0;
            }
        }
        bool refused = false; /* the first frame may still exceed the limits, and then reports so */
        for (int frame = 0; frame < 120; frame++) {
            refused = !tl_cloth_step(cloth, NULL, &error);
            assert_true(!refused || error.code == TL_UNSTABLE);
            assert_true(all_finite(cloth));
        }
        assert_false(refused);
        assert_true(tl_cloth_max_strain(cloth) < 1);
        tl_cloth_destroy(&cloth);
        sheet_free(&garment);
    }
}

/* Needles, slivers, collapsed and repeated triangles, a third triangle on an edge, an unused vertex. */
static void test_bad_triangles(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {12, 12, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, above);
    tl_mesh *mesh = &garment.model.mesh;
    mesh->positions[30] = mesh->positions[31];
    garment.pattern[30] = garment.pattern[31];
    mesh->positions[60].x = mesh->positions[61].x - 1e-6f;
    garment.pattern[60].x = garment.pattern[61].x - 1e-6f;
    memmove(mesh->indices + 300, mesh->indices + 303, 3 * sizeof(uint32_t));
    const uint32_t fin[] = {14, 28, 100, 5, 5, 9};
    memcpy(mesh->indices + 60, fin, sizeof fin);
    for (size_t i = 0; i < mesh->index_count; i++)
        if (mesh->indices[i] == 168)
            mesh->indices[i] = 167;
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.2, 12);
    tl_collider *collider = tl_collider_create(&sphere, true, &error);
    for (int patterned = 1; patterned >= 0; patterned--) {
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
        assert_non_null(cloth);
        for (int frame = 0; frame < 30; frame++) {
            assert_ok(tl_cloth_step(cloth, collider, &error), error);
            assert_true(all_finite(cloth));
        }
        assert_true(tl_cloth_max_strain(cloth) < 1);
        tl_cloth_destroy(&cloth);
        free(garment.pattern);
        garment.pattern = NULL;
    }
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
}

/* An avatar that jumps by a metre in one frame. */
static void test_teleporting_avatar(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {16, 16, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, above);
    tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.2, 16);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&sphere, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    vec3s *moved = TL_NEW_ARRAY(vec3s, sphere.vertex_count);
    for (int frame = 0; frame < 60; frame++) {
        for (size_t i = 0; i < sphere.vertex_count; i++)
            moved[i] = glms_vec3_add(sphere.positions[i], (vec3s){{frame % 20 >= 10 ? 1.0f : 0.0f, 0, 0}});
        tl_collider_move(collider, moved);
        bool good = tl_cloth_step(cloth, collider, &error);
        assert_true(good || error.code == TL_UNSTABLE);
        assert_true(all_finite(cloth));
    }
    free(moved);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
}

static void test_bad_input_is_refused(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {2, 2, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, above);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.shear = NAN;
    assert_null(tl_cloth_create(&garment, &fabric, &params, &error));
    assert_non_null(strstr(error.message, "fabric.shear"));
    fabric = fabric_defaults();
    params.dt = 0;
    assert_null(tl_cloth_create(&garment, &fabric, &params, &error));
    assert_non_null(strstr(error.message, "cloth.dt"));
    params = params_defaults();
    params.substeps = -1;
    assert_null(tl_cloth_create(&garment, &fabric, &params, &error));
    assert_non_null(strstr(error.message, "cloth.substeps"));
    params = params_defaults();
    garment.model.mesh.positions[4].y = INFINITY;
    assert_null(tl_cloth_create(&garment, &fabric, &params, &error));
    assert_int_equal(error.code, TL_INPUT);
    garment.model.mesh.positions[4].y = 0;
    sheet_seam(&garment, 0, 77);
    assert_null(tl_cloth_create(&garment, &fabric, &params, &error));
    assert_non_null(strstr(error.message, "seam"));
    garment.seam_count = 0;
    garment.model.mesh.index_count = 0;
    assert_null(tl_cloth_create(&garment, &fabric, &params, &error));
    garment.model.mesh.index_count = 3;
    sheet_free(&garment);
}

/* A state with NaN or infinite values is rolled back, and reported. */
static void test_roll_back(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {4, 4, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, above);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    vec3d good = cloth->particles.x[12];
    cloth->particles.v[12].y = 1e300;
    assert_false(tl_cloth_step(cloth, NULL, &error));
    assert_int_equal(error.code, TL_UNSTABLE);
    assert_memory_equal(&cloth->particles.x[12], &good, sizeof good);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

static vec3s buried(double u, double v)
{
    return (vec3s){{(float)u, (float)(v - 1), 0}};
}

/* Needles 20 cm long and 5 mm wide start 1 m below the ground. The ground lifts them out without adding
 * energy. */
static void ground_lifts_without_energy(void **state)
{
    (void)state;
    const struct sheet_shape shape = {1, 80, 0.2, 0.4};
    tl_garment garment = sheet_make(&shape, buried);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_error error = {0};
    tl_collider *collider = tl_collider_create(NULL, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    double before = tl_cloth_energies(cloth).potential;
    for (int frame = 0; frame < 20; frame++)
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
    assert_true(tl_cloth_energies(cloth).potential > before);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ground_lifts_without_energy), cmocka_unit_test(test_stiffness_and_step),
        cmocka_unit_test(test_bending_and_mass),       cmocka_unit_test(test_scrambled_and_collapsed),
        cmocka_unit_test(test_bad_triangles),          cmocka_unit_test(test_teleporting_avatar),
        cmocka_unit_test(test_bad_input_is_refused),   cmocka_unit_test(test_roll_back),
    };
    tl_log_set_level(TL_LOG_QUIET);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
