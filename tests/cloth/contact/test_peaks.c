/* Skin that comes through cloth between the cloth's vertices: where it is found, and that contact keeps it
 * below. */
#include "cloth/contact/peaks.h"
#include "cloth/measure.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/solvers.h"
#include "tests/testing.h"

#define RADIUS 0.2
#define RINGS  48
#define SPIKE  0.01

/* A sphere whose upper pole is drawn out by SPIKE. */
static tl_mesh make_spike(void)
{
    tl_mesh mesh = body_sphere((vec3s){{0, 0, 0}}, RADIUS, RINGS);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        if (mesh.positions[i].y >= (float)RADIUS)
            mesh.positions[i].y = (float)(RADIUS + SPIKE);
    return mesh;
}

/* A triangle of the cloth above the pole, and its weights there, to which the pole is 3, 1 and 4 eighths. */
static void test_finds(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh body = make_spike();
    tl_collider *collider = tl_collider_create(&body, false, &error);
    assert_non_null(collider);
    const double weights[3] = {3 / 8.0, 1 / 8.0, 4 / 8.0};
    const vec2s corners[3] = {{{-0.008f, -0.01f}}, {{-0.008f, 0.014f}}, {{0.008f, 0.004f}}};
    const float heights[] = {-0.002f, 0.001f, 0.004f};
    for (size_t h = 0; h < TL_COUNT(heights); h++) {
        vec3s corner[3];
        vec3d x[3];
        for (int i = 0; i < 3; i++) {
            corner[i] = (vec3s){{corners[i].x, (float)(RADIUS + SPIKE) + heights[h], corners[i].y}};
            x[i] = vec3d_from(corner[i]);
        }
        const uint32_t indices[3] = {0, 1, 2}, weld[3] = {0, 1, 2};
        struct tl_topology topology = tl_topology_build(indices, 3, weld, 3, 3);
        struct tl_skin_grid skin = tl_skin_grid_create(collider, 1, 0.25);
        const bool far[3] = {false};
        struct tl_peak *peaks, *none;
        assert_int_equal(skin.count, 1);
        const size_t count = tl_peaks_find(&skin, &topology, x, NULL, 0.002, &peaks);
        assert_int_equal(tl_peaks_find(&skin, &topology, x, far, 0.002, &none), 0);
        assert_int_equal(count, heights[h] < 0.002f);
        for (int i = 0; i < 3 && count == 1; i++)
            assert_near(peaks[0].at.weights[i], weights[i], 1e-6);
        if (count == 1)
            assert_near(peaks[0].beyond_m, -(double)heights[h], 1e-7);
        free(peaks);
        free(none);
        tl_skin_grid_release(&skin);
        tl_topology_release(&topology);
    }
    tl_collider_destroy(&collider);
    tl_mesh_release(&body);
}

/* With the pole in the middle of a triangle. */
static vec3s above_spike(double u, double v)
{
    return (vec3s){{(float)(u - 0.257), (float)(RADIUS + SPIKE + 0.005), (float)(0.243 - v)}};
}

/* A sheet lies on the spike, and settles and moves there: the skin stays half a thickness below it. */
static void test_keeps_below(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh body = make_spike();
    const struct sheet_shape shape = {24, 24, 0.5, 0.5};
    tl_garment garment = sheet_make(&shape, above_spike);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&body, false, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    assert_ok(tl_cloth_settle(cloth, collider, &error), error);
    for (int frame = 0; frame <= 30; frame += 10) {
        struct tl_skin_grid skin = tl_skin_grid_create(collider, 1, 0.25);
        struct tl_peak *peaks;
        const size_t count =
            tl_peaks_find(&skin, &cloth->topology, cloth->particles.x, NULL, fabric.thickness_m, &peaks);
        assert_true(count > 0);
        for (size_t i = 0; i < count; i++)
            assert_true(peaks[i].beyond_m < -0.45 * fabric.thickness_m);
        free(peaks);
        tl_skin_grid_release(&skin);
        assert_int_equal(tl_cloth_measure(cloth, collider).skin_count, 0);
        cloth_run(cloth, collider, 10 / params.frame_rate);
    }
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&body);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds),
        cmocka_unit_test(test_keeps_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
