/* Pins by height, by hand and from a file, inside and outside the avatar; and the strain limit of cloth that
 * hangs from pins. */
#include "cloth/state.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

#include <stdio.h>
#include <unistd.h>

static const struct sheet_shape shape = {10, 25, 0.2, 0.5};

static vec3s hanging(double u, double v)
{
    return (vec3s){{(float)u, (float)(1 + v), 0}};
}

static tl_cloth *make(tl_garment *garment, const struct tl_cloth_fabric *fabric,
                      const struct tl_cloth_params *params)
{
    tl_error error = {0};
    *garment = sheet_make(&shape, hanging);
    tl_cloth *cloth = tl_cloth_create(garment, fabric, params, &error);
    assert_non_null(cloth);
    return cloth;
}

static void run(tl_cloth *cloth, int frames)
{
    tl_error error = {0};
    for (int frame = 0; frame < frames; frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
}

/* Vertices above the height stay in place, to the bit. The others fall when the pins are removed. */
static void test_by_height(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment;
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.pin_above_m = 1.45;
    tl_cloth *cloth = make(&garment, &fabric, &params);
    assert_int_equal(cloth->pin_count, 3 * (shape.columns + 1)); /* rows at 1.46, 1.48 and 1.5 m */
    run(cloth, 30);
    for (size_t i = 0; i < cloth->particles.count; i++)
        if (garment.model.mesh.positions[i].y > 1.45f)
            assert_near(vec3d_distance(cloth->particles.x[i], vec3d_from(garment.model.mesh.positions[i])), 0,
                        0);
    assert_true(cloth->particles.x[0].y > 0.9);
    params.pin_above_m = 0;
    assert_ok(tl_cloth_set(cloth, &fabric, &params, &error), error);
    assert_int_equal(cloth->pin_count, 0);
    run(cloth, 30);
    assert_true(cloth->particles.x[cloth->particles.count - 1].y < 0);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* A pin by hand holds one vertex until it is removed or the cloth is reset. */
static void test_by_hand(void **state)
{
    (void)state;
    tl_garment garment;
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = make(&garment, &fabric, &params);
    const uint32_t corner = sheet_vertex(&shape, 0, shape.rows);
    run(cloth, 3);
    vec3d held = cloth->particles.x[corner];
    tl_cloth_pin(cloth, corner);
    tl_cloth_pin(cloth, UINT32_MAX); /* no such vertex: no effect */
    run(cloth, 30);
    assert_near(vec3d_distance(cloth->particles.x[corner], held), 0, 0);
    assert_int_equal(tl_cloth_unpin(cloth), 1);
    assert_int_equal(tl_cloth_unpin(cloth), 0);
    run(cloth, 10);
    assert_true(cloth->particles.x[corner].y < held.y - 0.1);
    tl_cloth_mark_start(cloth);
    tl_cloth_pin(cloth, corner);
    tl_cloth_reset(cloth);
    assert_int_equal(cloth->pin_count, 0);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* A pin that starts inside the avatar is held outside, and moves with the avatar. */
static void test_in_avatar(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment = sheet_make(&shape, hanging);
    sheet_pin(&garment, sheet_vertex(&shape, 5, shape.rows));
    tl_mesh sphere = body_sphere((vec3s){{0.1f, 1.42f, 0}}, 0.1, 24); /* its top is 2 cm above the pin */
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&sphere, false, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(tl_cloth_step(cloth, collider, &error), error);
    vec3d top = cloth->particles.x[cloth->pins[0].particle];
    assert_near(vec3d_distance(top, (vec3d){0.1, 1.42, 0}), 0.1 + fabric.thickness_m, 5e-4); /* facets */
    for (size_t i = 0; i < sphere.vertex_count; i++)
        sphere.positions[i].x += 0.1f;
    tl_collider_move(collider, sphere.positions);
    assert_ok(tl_cloth_step(cloth, collider, &error), error);
    vec3d moved = vec3d_sub(cloth->particles.x[cloth->pins[0].particle], top);
    assert_near(vec3d_distance(moved, (vec3d){0.1, 0, 0}), 0, 1e-6);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* A square whose upper two corners are pinned by the attribute _PIN, and whose third corner is red. */
static tl_garment load_painted(void)
{
    static const struct {
        float positions[4][3], pins[4];
        uint8_t colours[4][4];
        uint16_t indices[6];
    } binary = {{{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}},
                {1, 0.75f, 0.25f, 0},
                {{255, 255, 255, 255}, {255, 200, 0, 255}, {200, 10, 10, 255}, {0, 0, 0, 255}},
                {0, 2, 1, 0, 3, 2}};
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"_PIN\":1,\"COLOR_0\":2},\"indices\":"
        "3}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,"
        "0],"
        "\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":16}"
        ","
        "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":16},{\"buffer\":0,\"byteOffset\":80,\"byteLength\":"
        "12}],"
        "\"buffers\":[{\"byteLength\":92,\"uri\":\"square.bin\"}]}";
    char folder[] = "/tmp/toile_pins_XXXXXX", model[64], data[64];
    assert_non_null(mkdtemp(folder));
    snprintf(model, sizeof model, "%s/square.gltf", folder);
    snprintf(data, sizeof data, "%s/square.bin", folder);
    write_file(model, json, sizeof json - 1);
    write_file(data, &binary, sizeof binary);
    tl_garment garment;
    tl_error error = {0};
    assert_ok(tl_garment_load(model, &garment, &error), error);
    remove(model);
    remove(data);
    rmdir(folder);
    return garment;
}

/* Vertices pinned by the file stay in place, to the bit. Its vertex colours pin only if that option is set.
 */
static void test_from_file(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment = load_painted();
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(cloth != NULL, error);
    assert_int_equal(cloth->pin_count, 2);
    run(cloth, 10);
    for (size_t i = 0; i < 2; i++)
        assert_near(vec3d_distance(cloth->particles.x[i], vec3d_from(garment.model.mesh.positions[i])), 0, 0);
    const struct {
        int colour;
        size_t pins;
    } expected[] = {{TL_PIN_RED, 3}, {TL_PIN_GREEN, 2}, {TL_PIN_BLUE, 2}, {TL_PIN_NO_COLOUR, 2}};
    for (size_t i = 0; i < TL_COUNT(expected); i++) {
        params.pin_colour = expected[i].colour;
        assert_ok(tl_cloth_set(cloth, &fabric, &params, &error), error);
        assert_int_equal(cloth->pin_count, expected[i].pins);
    }
    tl_cloth_destroy(&cloth);
    tl_garment_release(&garment);
}

/* A strip of length L stretches at its top by rho g L / k. Preview stops at the strain limit, within the
 * error of one sweep; without a limit it exceeds it. */
static void test_strain_limit(void **state)
{
    (void)state;
    const double strain = 0.9, limit = 0.1, length = 0.48; /* below the pins */
    for (int limited = 0; limited < 2; limited++) {
        tl_garment garment;
        struct tl_cloth_fabric fabric = fabric_defaults();
        struct tl_cloth_params params = params_defaults();
        params.pin_above_m = 1.49;
        params.strain_limit = limited ? limit : 0;
        fabric.areal_density = 2;
        fabric.stretch_weft = fabric.stretch_warp = fabric.areal_density * params.gravity * length / strain;
        fabric.damping = 3;
        tl_cloth *cloth = make(&garment, &fabric, &params);
        double max_strain = 0;
        for (int frame = 0; frame < 60; frame++) {
            run(cloth, 1);
            for (size_t e = 0; e < cloth->limits.count; e++) {
                const struct tl_limited_edge *edge = &cloth->limits.edges[e];
                double now =
                    vec3d_distance(cloth->particles.x[edge->ends[0]], cloth->particles.x[edge->ends[1]]);
                max_strain = fmax(max_strain, now / edge->rest - 1);
            }
        }
        printf("strain limit: %.3f with the limit at %g\n", max_strain, params.strain_limit);
        assert_true(limited ? max_strain < limit + 0.02 : max_strain > 0.7 * strain);
        tl_cloth_destroy(&cloth);
        sheet_free(&garment);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_by_height),    cmocka_unit_test(test_by_hand),
        cmocka_unit_test(test_in_avatar),    cmocka_unit_test(test_from_file),
        cmocka_unit_test(test_strain_limit),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
