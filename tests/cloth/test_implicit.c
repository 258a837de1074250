/* `settle`: its matrix against finite differences, its steps against backward Euler's closed forms, its
 * contact against statics, and its bounds. */
#include "bodies.h"
#include "cloth/state.h"
#include "sheets.h"
#include "testing.h"

#include "config/log.h"

#include <omp.h>

/* ---- Springs, without a sheet ---- */

/* A link between a held particle and one that is free, along x. */
struct oscillator {
    struct tl_link link;
    struct tl_energy energy;
    struct tl_cloth_fabric fabric;
    struct tl_contacts contacts; /* of no particle near anything */
    struct tl_particles particles;
};

static void make_oscillator(struct oscillator *o, double stiffness, double mass, double stretch)
{
    *o = (struct oscillator){.link = {.a = 0, .b = 1, .rest = 1}, .particles = tl_particles_create(2)};
    o->energy = (struct tl_energy){.link_count = 1, .links = &o->link};
    uint32_t edge[1][2] = {{0, 1}};
    const struct tl_topology topology = {.vertex_count = 2, .edge_count = 1, .edges = edge};
    o->energy.pulls = tl_pulls_build(&topology, &o->energy);
    o->fabric = (struct tl_cloth_fabric){.stretch_warp = stiffness};
    o->particles.w[1] = 1 / mass;
    o->particles.x[1].x = 1 + stretch;
}

static struct tl_implicit_problem oscillator_problem(struct oscillator *o, double h)
{
    return (struct tl_implicit_problem){.energy = &o->energy,
                                        .fabric = &o->fabric,
                                        .hand = {.particle = TL_NONE},
                                        .contacts = &o->contacts,
                                        .h = h,
                                        .tolerance = 1e-10,
                                        .most_iterations = 10};
}

static void step_particles(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                           struct tl_particles *particles)
{
    struct tl_implicit_tally tally = {0};
    memcpy(particles->previous, particles->x, particles->count * sizeof *particles->x);
    tl_implicit_step(implicit, problem, particles, &tally);
    tl_particles_finish(particles, problem->h);
    assert_int_equal(tally.unconverged, 0);
    assert_int_equal(tally.shortened, 0);
}

/* x_n + i y_n turns by atan(w h) and shrinks by (1 + w^2 h^2)^-1/2 each step. */
static void test_oscillator(void **state)
{
    (void)state;
    const double mass = 0.02, steps[] = {1e-4, 1e-2, 0.1};
    for (size_t s = 0; s < TL_COUNT(steps); s++) {
        struct oscillator o;
        const double stiffness = 50, stretch = 0.1, h = steps[s], w = sqrt(stiffness / mass);
        make_oscillator(&o, stiffness, mass, stretch);
        const struct tl_implicit_problem problem = oscillator_problem(&o, h);
        tl_implicit *implicit = tl_implicit_create(&problem, &o.particles);
        double shrink = 1 / sqrt(1 + w * w * h * h), turn = atan(w * h);
        for (int n = 1; n <= 50; n++) {
            step_particles(implicit, &problem, &o.particles);
            /* at rest at first: x = a cos(turn n) shrink^n (1 + ...): from x_1 = a shrink^2 */
            double expected = stretch * pow(shrink, n) * cos(turn * n);
            double at_rest = stretch * pow(shrink, n) * sin(turn * n) / w; /* v_0 = 0 exactly, so no phase */
            assert_true(fabs(o.particles.x[1].x - 1 - expected) < 1e-9 * stretch);
            assert_true(fabs(o.particles.v[1].x + at_rest * w * w) < 1e-9 * stretch * w);
        }
        tl_implicit_destroy(&implicit);
        tl_pulls_release(&o.energy.pulls);
        tl_particles_release(&o.particles);
    }
}

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

/* Under tension, without shear, what the matrix leaves out is nothing: it is the forces' derivative. */
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
    tl_energy_forces(&cloth->energy, &fabric, count, x, plus);
    for (size_t i = 0; i < count; i++)
        x[i] = vec3d_muladd(cloth->particles.x[i], p[i], -e);
    tl_energy_forces(&cloth->energy, &fabric, count, x, minus);
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

/* In any shape it is symmetric, and no motion is pushed along by it. */
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
    return params;
}

/* y = -g/2 t (t + h), at any stiffness. */
static void test_free_fall(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {9, 7, 0.4, 0.3};
    tl_garment garment = sheet_make(&shape, lying);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = settle_params();
    fabric.damping = 0;
    const double stiffnesses[] = {1e-2, 1e3, 1e6};
    for (size_t s = 0; s < TL_COUNT(stiffnesses); s++) {
        fabric.stretch_weft = fabric.stretch_warp = fabric.shear = stiffnesses[s];
        tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
        vec3d *start = TL_NEW_ARRAY(vec3d, cloth->particles.count);
        memcpy(start, cloth->particles.x, cloth->particles.count * sizeof *start);
        for (int frame = 0; frame < 15; frame++)
            assert_ok(tl_cloth_step(cloth, NULL, &error), error);
        double t = 0.5, h = tl_cloth_substep(cloth);
        vec3d fall = {0, -params.gravity / 2 * t * (t + h), 0};
        for (size_t i = 0; i < cloth->particles.count; i++) {
            vec3d fallen = vec3d_sub(cloth->particles.x[i], start[i]);
            assert_true(vec3d_distance(fallen, fall) < 1e-9 * -fall.y);
        }
        free(start);
        tl_cloth_destroy(&cloth);
    }
    sheet_free(&garment);
}

/* A stretched sheet let go: total energy never rises. */
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

/* Where the middle of a hanging sheet's lower edge is after a quarter of a second's swing. */
static double swing(int solver, double dt)
{
    tl_error error = {0};
    const struct sheet_shape shape = {8, 8, 0.4, 0.4};
    tl_garment garment = sheet_make(&shape, lying);
    for (int column = 0; column <= shape.columns; column++)
        sheet_pin(&garment, sheet_vertex(&shape, column, shape.rows));
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = settle_params();
    fabric.damping = 0;
    params.solver = solver;
    params.dt = dt;
    params.frame_rate = 20;
    params.cg_tolerance = 1e-8;
    params.cg_iterations = 10000;
    tl_cloth *cloth = make_cloth(&garment, &fabric, &params);
    for (int frame = 0; frame < 5; frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    double y = cloth->particles.x[sheet_vertex(&shape, 4, 0)].y;
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return y;
}

static void test_first_order(void **state)
{
    (void)state;
    double exact = swing(TL_CLOTH_REFERENCE, 1e-3), errors[3];
    for (int i = 0; i < 3; i++)
        errors[i] = fabs(swing(TL_CLOTH_SETTLE, 0.0025 / (1 << i)) - exact);
    print_message("swing: errors %.3g %.3g %.3g m at h, h/2, h/4\n", errors[0], errors[1], errors[2]);
    for (int i = 0; i < 2; i++) {
        double order = log2(errors[i] / errors[i + 1]);
        assert_true(order > 0.8 && order < 1.2);
    }
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
    uint64_t hash = 14695981039346656037u; /* FNV-1a */
    const unsigned char *bytes = (const unsigned char *)cloth->particles.x;
    for (size_t i = 0; i < cloth->particles.count * sizeof(vec3d); i++)
        hash = (hash ^ bytes[i]) * 1099511628211u;
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

/* One iteration a step is far too few: said, and still bounded. */
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
        cmocka_unit_test(test_oscillator),
        cmocka_unit_test(test_matrix_is_derivative),
        cmocka_unit_test(test_matrix_is_semidefinite),
        cmocka_unit_test(test_free_fall),
        cmocka_unit_test(test_energy_falls),
        cmocka_unit_test(test_first_order),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_cut_short),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
