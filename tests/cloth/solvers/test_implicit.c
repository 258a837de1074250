/* `settle`: its matrix against finite differences, its steps against backward Euler's closed forms, its
 * contact against statics, and its bounds. */
#include "cloth/state.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/hash.h"
#include "config/base/log.h"

#include <omp.h>

/* ---- The matrix ---- */

static vec3s stretched(double u, double v)
{
    return (vec3s){{(float)(1.1 * u), (float)(0.1 * sin(5 * u) + 0.05 * v), (float)(-1.2 * v)}};
}

static double noise(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0 - 0.5;
}

static tl_cloth *make_cloth(const tl_garment *garment, const struct tl_cloth_fabric *fabric,
                            const struct tl_cloth_params *params)
{
    tl_error error = {0};
    tl_cloth *cloth = tl_cloth_create(garment, fabric, params, &error);
    assert_ok(cloth, error);
    return cloth;
}

/* Under tension and without shear the matrix neglects no term: it equals the derivative of the forces. */
static void test_matrix_is_derivative(void **state)
{
    (void)state;
    const struct sheet_shape shape = {6, 5, 0.3, 0.25};
    tl_garment garment = sheet_make(&shape, stretched);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.shear = 0;
    fabric.bend_weft = 1e-2;
    tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
    const struct tl_springs none = {0};
    size_t count = cloth->particles.count;
    struct tl_stiffness stiffness = tl_stiffness_build(&cloth->energy, &fabric, &none, count);
    tl_stiffness_assemble(&stiffness, &cloth->energy, &fabric, &none, cloth->particles.x);
    vec3d *p = TL_NEW_ARRAY(vec3d, count + 1), *x = TL_NEW_ARRAY(vec3d, count + 1);
    vec3d *plus = TL_NEW_ARRAY(vec3d, count), *minus = TL_NEW_ARRAY(vec3d, count);
    uint32_t seed = 7;
    const double e = 1e-5;
    for (size_t i = 0; i < count; i++)
        p[i] = (vec3d){noise(&seed), noise(&seed), noise(&seed)};
    for (size_t i = 0; i < count; i++)
        x[i] = vec3d_muladd(cloth->particles.x[i], p[i], e);
    tl_energy_evaluate(&cloth->energy, &fabric, count, x, plus);
    for (size_t i = 0; i < count; i++)
        x[i] = vec3d_muladd(cloth->particles.x[i], p[i], -e);
    tl_energy_evaluate(&cloth->energy, &fabric, count, x, minus);
    double worst = 0, largest = 0;
    for (size_t i = 0; i < count; i++) {
        vec3d slope = vec3d_scale(vec3d_sub(minus[i], plus[i]), 0.5 / e);
        largest = fmax(largest, vec3d_norm(slope));
        worst = fmax(worst, vec3d_distance(slope, tl_stiffness_row(&stiffness, i, p)));
    }
    assert_true(worst < 1e-5 * largest); /* second order in e over an edge of 5 cm: 4e-8, times its factor */
    free(p), free(x), free(plus), free(minus);
    tl_stiffness_release(&stiffness);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* In any shape the matrix is symmetric and positive semidefinite: no motion gains energy from it. */
static void test_matrix_is_semidefinite(void **state)
{
    (void)state;
    const struct sheet_shape shape = {6, 5, 0.3, 0.25};
    tl_garment garment = sheet_make(&shape, NULL);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
    const struct tl_springs none = {0};
    size_t count = cloth->particles.count;
    struct tl_stiffness stiffness = tl_stiffness_build(&cloth->energy, &fabric, &none, count);
    vec3d *p = TL_NEW_ARRAY(vec3d, count + 1), *q = TL_NEW_ARRAY(vec3d, count + 1);
    uint32_t seed = 3;
    for (int trial = 0; trial < 20; trial++) {
        double pp = 0, pq = 0, qp = 0, size = 0;
        for (size_t i = 0; i < count; i++) {
            cloth->particles.x[i] = (vec3d){noise(&seed), noise(&seed), noise(&seed)};
            p[i] = (vec3d){noise(&seed), noise(&seed), noise(&seed)};
            q[i] = (vec3d){noise(&seed), noise(&seed), noise(&seed)};
        }
        tl_stiffness_assemble(&stiffness, &cloth->energy, &fabric, &none, cloth->particles.x);
        for (size_t i = 0; i < count; i++) {
            vec3d kp = tl_stiffness_row(&stiffness, i, p), kq = tl_stiffness_row(&stiffness, i, q);
            pp += vec3d_dot(p[i], kp);
            qp += vec3d_dot(q[i], kp);
            pq += vec3d_dot(p[i], kq);
            size += vec3d_norm(kp);
        }
        assert_true(pp > 0);
        assert_true(fabs(pq - qp) < 1e-12 * size);
    }
    free(p), free(q);
    tl_stiffness_release(&stiffness);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* ---- Sheets ---- */

static vec3s lying(double u, double v)
{
    return (vec3s){{(float)u, 1.0f, (float)-v}};
}

static struct tl_cloth_params settle_params(void)
{
    struct tl_cloth_params params = params_defaults();
    params.solver = TL_CLOTH_SETTLE;
    params.self_contact = false; /* the solve alone */
    return params;
}

/* A stretched sheet is released: total energy never rises. */
static void test_energy_falls(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {16, 12, 0.4, 0.3};
    tl_garment garment = sheet_make(&shape, stretched);
    sheet_pin(&garment, 0);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = settle_params();
    fabric.damping = 0;
    params.frame_rate = 60;
    const double stiffnesses[] = {10, 1e3, 1e6};
    for (size_t s = 0; s < TL_COUNT(stiffnesses); s++) {
        fabric.stretch_weft = fabric.stretch_warp = stiffnesses[s];
        tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
        struct tl_cloth_report first = tl_cloth_measure(cloth, NULL);
        double before = first.elastic_energy + first.potential_energy;
        for (int frame = 0; frame < 120; frame++) {
            assert_ok(tl_cloth_step(cloth, NULL, &error), error);
            struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
            double total = report.kinetic_energy + report.elastic_energy + report.potential_energy;
            assert_true(total <= before + 1e-8 * first.elastic_energy);
            before = total;
        }
        tl_cloth_destroy(&cloth);
    }
    sheet_free(&garment);
}

/* ---- Threads and bounds ---- */

static uint64_t drape_hash(int threads)
{
    tl_error error = {0};
    const struct sheet_shape shape = {40, 40, 0.8, 0.8};
    tl_garment garment = sheet_make(&shape, lying);
    tl_mesh sphere = body_sphere((vec3s){{0.4f, 0.7f, -0.4f}}, 0.25, 16);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = settle_params();
    tl_collider *collider = tl_collider_create(&sphere, true, &error);
    int usual = omp_get_max_threads();
    omp_set_num_threads(threads);
    tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
    for (int frame = 0; frame < 10; frame++)
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
    omp_set_num_threads(usual);
    uint64_t hash = tl_hash(TL_HASH_START, cloth->particles.x, cloth->particles.count * sizeof(vec3d));
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
    return hash;
}

static void test_threads(void **state)
{
    (void)state;
    uint64_t one = drape_hash(1);
    assert_int_equal(drape_hash(2), one);
    assert_int_equal(drape_hash(3), one);
    assert_int_equal(drape_hash(8), one);
}

/* One iteration per step is far too few: this is reported, and the motion stays bounded. */
static void test_cut_short(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {20, 20, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, lying);
    sheet_pin(&garment, 0);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = settle_params();
    params.cg_iterations = 1;
    params.cg_tolerance = 1e-6;
    tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
    for (int frame = 0; frame < 60; frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    assert_true(report.unconverged_steps > 0);
    assert_true(report.max_strain < 1);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_matrix_is_derivative),
        cmocka_unit_test(test_matrix_is_semidefinite),
        cmocka_unit_test(test_energy_falls),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_cut_short),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
