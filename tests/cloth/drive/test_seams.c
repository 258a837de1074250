/* Seams: two panels on either side of a body are pulled together around it and become one cloth. */
#include "cloth/build.h"
#include "cloth/state.h"
#include "cloth/timestep.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

#define COLUMNS 24
#define ROWS    16
static const struct sheet_shape panel = {COLUMNS, ROWS, 0.6, 0.4};

/* Two panels in one mesh, `gap` metres apart, in front of and behind the origin, 0.3 to 0.7 m high. Their
 * sides and half of their tops are sewn. */
static tl_garment two_panels(double gap)
{
    tl_garment front = sheet_make(&panel, NULL), back = sheet_make(&panel, NULL);
    tl_mesh *mesh = &front.model.mesh;
    const uint32_t count = (uint32_t)mesh->vertex_count;
    mesh->positions = tl_resize(mesh->positions, (size_t)2 * count, sizeof(vec3s));
    mesh->uvs = tl_resize(mesh->uvs, (size_t)2 * count, sizeof(vec2s));
    mesh->indices = tl_resize(mesh->indices, 2 * mesh->index_count, sizeof(uint32_t));
    front.pattern = tl_resize(front.pattern, (size_t)2 * count, sizeof(vec2s));
    for (uint32_t i = 0; i < count; i++) {
        vec3s p = mesh->positions[i];
        mesh->positions[i] = (vec3s){{p.x - 0.3f, p.y + 0.3f, (float)(gap / 2)}};
        mesh->positions[count + i] = (vec3s){{p.x - 0.3f, p.y + 0.3f, (float)(-gap / 2)}};
        mesh->uvs[count + i] = mesh->uvs[i];
        front.pattern[count + i] = front.pattern[i];
    }
    for (size_t i = 0; i < mesh->index_count; i++)
        mesh->indices[mesh->index_count + i] = back.model.mesh.indices[i] + count;
    mesh->index_count *= 2;
    mesh->vertex_count *= 2;
    sheet_free(&back);
    for (int row = 0; row <= ROWS; row++) {
        uint32_t left = sheet_vertex(&panel, 0, row), right = sheet_vertex(&panel, COLUMNS, row);
        sheet_seam(&front, left, left + count);
        sheet_seam(&front, right, right + count);
    }
    for (int column = 0; column <= COLUMNS; column++)
        if (column < 8 || column > COLUMNS - 8) {
            uint32_t top = sheet_vertex(&panel, column, ROWS);
            sheet_seam(&front, top, top + count);
        }
    return front;
}

/* The gap is 30 cm; the sphere between the panels is as wide. */
static void test_panels_close_around_a_body(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment = two_panels(0.3);
    tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.13, 24);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&sphere, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    struct tl_cloth_report before = tl_cloth_measure(cloth, collider);
    assert_int_equal(before.open_seams, 2 * (ROWS + 1) + 2 * 8 - 2);
    assert_int_equal(before.vertex_count, 2 * (COLUMNS + 1) * (ROWS + 1));
    assert_ok(tl_cloth_settle(cloth, collider, &error), error);
    struct tl_cloth_report after = tl_cloth_measure(cloth, collider);
    assert_int_equal(after.open_seams, 0);
    assert_int_equal(after.vertex_count, before.vertex_count - before.open_seams);
    /* In one upper corner a triangle has all three corners on seams: its two layers become one. */
    assert_int_equal(after.triangle_count, before.triangle_count - 1);
    assert_near(after.deepest_m, 0, 0);
    assert_true(after.max_strain < 0.2);
    assert_near(after.time_s, 0, 0);
    const uint32_t *weld = tl_cloth_weld(cloth);
    for (size_t i = 0; i < garment.seam_count; i++)
        assert_int_equal(weld[garment.seams[i].a], weld[garment.seams[i].b]);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
}

/* Seam vertices that a wall keeps apart remain separate and linked, and the motion stays bounded. */
static void test_held_apart(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment = two_panels(0.1);
    tl_mesh wall = body_box((vec3s){{0, 0.5f, 0}}, (vec3s){{2, 2, 0.02f}}, 0);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.settle_s = 1;
    tl_collider *collider = tl_collider_create(&wall, false, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(tl_cloth_settle(cloth, collider, &error), error);
    struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
    assert_int_equal(report.open_seams, 2 * (ROWS + 1) + 2 * 8 - 2);
    assert_true(report.max_strain < 0.5);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&wall);
    sheet_free(&garment);
}

/* Two particles 1 m apart, held for a second while the winch draws: released, they come nearer by its speed
 * in one substep and no more, because a thread that was held stores nothing. */
static void test_a_held_thread_stores_nothing(void **state)
{
    (void)state;
    const struct tl_seam_pair pair = {0, 1};
    const uint32_t weld[] = {0, 1};
    const double h = 1.0 / 1800;
    struct tl_seams seams = tl_seams_create(&pair, 1, weld);
    struct tl_particles particles = tl_particles_create(2);
    for (int i = 0; i < 2; i++) {
        particles.x[i] = particles.previous[i] = (vec3d){i, 0, 0};
        particles.w[i] = 1;
    }
    for (int substep = 0; substep < 1800; substep++) {
        tl_seams_solve(&seams, &particles, h);
        memcpy(particles.x, particles.previous, 2 * sizeof *particles.x);
    }
    tl_seams_solve(&seams, &particles, h);
    double nearer = 1 - vec3d_distance(particles.x[0], particles.x[1]);
    assert_near(nearer, 0.6 * h, 1e-9); /* 0.33 mm */
    tl_particles_release(&particles);
    tl_seams_release(&seams);
}

/* A beam lies between two panels. `end` 1: their tops are sewn, 2 cm below its middle; threads that run
 * straight pass nearer to its lower side, but the tops point up, so the seam closes above it. `end` -1: their
 * bottoms are sewn, 2 cm above the middle of a beam, and the seam closes below it. */
static void test_seams_close_where_the_panels_end(void **state)
{
    (void)state;
    for (int end = -1; end <= 1; end += 2) {
        tl_error error = {0};
        tl_garment garment = two_panels(0.3);
        const double middle = end > 0 ? 0.72 : 0.28;
        tl_mesh beam = body_box((vec3s){{0, (float)middle, 0}}, (vec3s){{2, 0.06f, 0.06f}}, 0);
        struct tl_cloth_fabric fabric = fabric_defaults();
        struct tl_cloth_params params = params_defaults();
        params.gravity = 0;
        params.settle_s = 0.1;
        tl_collider *collider = tl_collider_create(&beam, false, &error);
        garment.seam_count = 0;
        for (int column = 0; column <= COLUMNS; column++) {
            uint32_t edge = sheet_vertex(&panel, column, end > 0 ? ROWS : 0);
            sheet_seam(&garment, edge, edge + (uint32_t)garment.model.mesh.vertex_count / 2);
        }
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
        assert_non_null(cloth);
        assert_ok(tl_cloth_settle(cloth, collider, &error), error);
        assert_int_equal(tl_cloth_measure(cloth, collider).open_seams, 0);
        for (size_t i = 0; i < garment.seam_count; i++)
            assert_true(end * (cloth->particles.x[tl_cloth_weld(cloth)[garment.seams[i].a]].y - middle) >
                        0.06);
        tl_cloth_destroy(&cloth);
        tl_collider_destroy(&collider);
        tl_mesh_release(&beam);
        sheet_free(&garment);
    }
}

/* Two panels of 10 mm edges, for which cloth.substeps=0 takes more than 30: sewing takes 30, and is then bit
 * by bit what it is where 30 were asked for. Afterwards constants are those of the cloth's own substep, as
 * when they are made again. */
static void test_fine_panels_are_sewn_as_coarse_ones(void **state)
{
    (void)state;
    const float scale = 0.4f;
    const int asked[] = {0, 30};
    vec3d *sewn[2] = {NULL};
    size_t counts[2] = {0};
    for (int run = 0; run < 2; run++) {
        tl_error error = {0};
        tl_garment garment = two_panels(0.1);
        for (size_t i = 0; i < garment.model.mesh.vertex_count; i++) {
            garment.model.mesh.positions[i] = glms_vec3_scale(garment.model.mesh.positions[i], scale);
            garment.pattern[i] = glms_vec2_scale(garment.pattern[i], scale);
        }
        struct tl_cloth_fabric fabric = fabric_defaults();
        struct tl_cloth_params params = params_defaults();
        params.substeps = asked[run];
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
        assert_non_null(cloth);
        assert_true(run == 1 || tl_cloth_substeps_per_step(cloth) > 30);
        assert_ok(tl_cloth_sew(cloth, NULL, &error), error);
        assert_int_equal(tl_cloth_measure(cloth, NULL).open_seams, 0);
        const struct tl_preview_membrane left = cloth->energy.previewed[0];
        tl_cloth_set_constants(cloth);
        assert_memory_equal(left.weft, cloth->energy.previewed[0].weft, sizeof left.weft);
        assert_memory_equal(left.shear, cloth->energy.previewed[0].shear, sizeof left.shear);
        counts[run] = cloth->particles.count;
        sewn[run] = TL_NEW_ARRAY(vec3d, counts[run]);
        memcpy(sewn[run], cloth->particles.x, counts[run] * sizeof(vec3d));
        tl_cloth_destroy(&cloth);
        sheet_free(&garment);
    }
    assert_int_equal(counts[0], counts[1]);
    assert_memory_equal(sewn[0], sewn[1], counts[0] * sizeof(vec3d));
    free(sewn[0]);
    free(sewn[1]);
}

/* Joining keeps mass, momentum and the centre of mass. */
static void test_joining_keeps_momentum(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment = two_panels(0.001);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    size_t count = cloth->particles.count, half = count / 2;
    uint32_t *joined = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++)
        joined[i] = (uint32_t)(i % half);
    vec3d sums[2][2] = {0}; /* momentum, and mass times position; before, after */
    double masses[2] = {0};
    for (int after = 0; after < 2; after++) {
        for (size_t i = 0; i < cloth->particles.count; i++) {
            double mass = 1 / cloth->particles.w[i];
            if (!after)
                cloth->particles.v[i] = (vec3d){sin((double)i), cos(3 * (double)i), 1};
            masses[after] += mass;
            sums[after][0] = vec3d_muladd(sums[after][0], cloth->particles.v[i], mass);
            sums[after][1] = vec3d_muladd(sums[after][1], cloth->particles.x[i], mass);
        }
        if (!after)
            tl_cloth_join(cloth, joined, half);
    }
    /* Both panels are the same triangles: as one cloth they weigh half, and move and lie at the mean. */
    assert_near(masses[1], masses[0] / 2, 1e-12);
    for (int k = 0; k < 2; k++)
        assert_near(vec3d_distance(vec3d_scale(sums[0][k], 0.5), sums[1][k]), 0, 1e-12);
    free(joined);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_panels_close_around_a_body),
        cmocka_unit_test(test_held_apart),
        cmocka_unit_test(test_a_held_thread_stores_nothing),
        cmocka_unit_test(test_seams_close_where_the_panels_end),
        cmocka_unit_test(test_fine_panels_are_sewn_as_coarse_ones),
        cmocka_unit_test(test_joining_keeps_momentum),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
