/* Maps baked from a finer mesh: heights and normals in closed form on a plane, mirrored UVs, what is refused;
 * and a coarse ball with maps against the finer ball, both ray traced. Row C11. */
#include "render/detail/bake.h"
#include "render/detail/transfer.h"

#include "tests/render/scenes.h"
#include "tests/testing.h"

#include <string.h>

#define HALF   0.5f
#define BUMP_M 0.01
#define WAVES  3

/* A height over u, v in [0, 1] and its derivatives. */
static double bump(double u, double v, double *du, double *dv)
{
    double k = 2 * M_PI * WAVES;
    *du = BUMP_M * k * cos(k * u) * sin(k * v + 0.5);
    *dv = BUMP_M * k * sin(k * u) * cos(k * v + 0.5);
    return BUMP_M * sin(k * u) * sin(k * v + 0.5);
}

static struct test_shape plane(int cells)
{
    return test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, HALF, cells);
}

/* The plane with bumps along z: u runs along x, v along -y. */
static struct test_shape bumped_plane(int cells)
{
    struct test_shape shape = plane(cells);
    for (size_t i = 0; i < shape.mesh.vertex_count; i++) {
        double du, dv;
        vec2s uv = shape.mesh.uvs[i];
        shape.mesh.positions[i].z = (float)bump((double)uv.x, (double)uv.y, &du, &dv);
        shape.mesh.normals[i] = glms_vec3_normalize(
            (vec3s){{(float)(-du / (2 * (double)HALF)), (float)(dv / (2 * (double)HALF)), 1}});
    }
    test_shape_refresh(&shape);
    return shape;
}

struct off {
    double height_m, normal; /* largest */
};

static struct off off_of(const struct tl_transfer *maps, bool is_mirrored)
{
    struct off off = {0, 0};
    int side = maps->heights.width;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double du, dv, u = (x + 0.5) / side, v = (y + 0.5) / side;
            double h = bump(is_mirrored ? 1 - u : u, v, &du, &dv);
            const float *normal = tl_image_floats(&maps->normals) + 3 * (y * side + x);
            double wanted[3] = {(is_mirrored ? du : -du) / (2 * (double)HALF), dv / (2 * (double)HALF), 1};
            double length = sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1] + 1);
            off.height_m =
                fmax(off.height_m, fabs((double)tl_image_floats(&maps->heights)[y * side + x] - h));
            for (int c = 0; c < 3; c++)
                off.normal = fmax(off.normal, fabs((double)normal[c] - wanted[c] / length));
        }
    return off;
}

/* On a plane rays are vertical, so each texel has the finer mesh's own value: what is off is that of its
 * triangles against the closed form, h'' d^2 / 8 in height for cells of d and of the order of its slope in
 * the normals; four times less for half of d. With mirrored UVs the same, mirrored. */
static void planes_have_the_closed_form(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        double before = 1;
        for (int cells = 64; cells <= 256; cells *= 2) {
            struct test_shape coarse = plane(3), fine = bumped_plane(cells);
            for (size_t i = 0; mirrored && i < coarse.mesh.vertex_count; i++) {
                coarse.mesh.uvs[i].x = 1 - coarse.mesh.uvs[i].x;
                coarse.mesh.tangents[i] = (vec4s){{-1, 0, 0, -1}};
            }
            test_shape_refresh(&coarse);
            test_shape_refresh(&fine);
            struct tl_transfer maps;
            tl_error error = {0};
            const struct tl_transfer_params params = {100, 100, 0.05f};
            assert_ok(tl_transfer_make(&coarse.surface, &fine.surface, &params, &maps, &error), error);
            struct off off = off_of(&maps, mirrored);
            double bend = BUMP_M * pow(2 * M_PI * WAVES / cells, 2) / 4; /* of both directions */
            print_message("cells of 1/%d%s: heights off by %.1e m (bound %.1e), normals by %.1e\n", cells,
                          mirrored ? ", mirrored" : "", off.height_m, bend, off.normal);
            assert_int_equal(maps.covered, 10000);
            assert_int_equal(maps.missed, 0);
            assert_int_equal(maps.shared, 0);
            assert_true(off.height_m < bend + 1e-6 && off.normal < before / 3);
            before = off.normal;
            tl_transfer_release(&maps);
            test_shape_release(&coarse);
            test_shape_release(&fine);
        }
        assert_true(before < 1e-3);
    }
}

/* Rays that end short of the finer mesh miss; beside the mesh's hole texels are filled from its border. */
static void reach_and_gaps(void **state)
{
    (void)state;
    struct test_shape coarse = plane(4), fine = bumped_plane(64);
    struct tl_transfer maps;
    tl_error error = {0};
    test_shape_refresh(&coarse);
    test_shape_refresh(&fine);
    struct tl_transfer_params params = {64, 64, 0.5f * (float)BUMP_M};
    assert_ok(tl_transfer_make(&coarse.surface, &fine.surface, &params, &maps, &error), error);
    print_message("half of the bumps' height within reach: %zu of %zu missed\n", maps.missed, maps.covered);
    assert_true(maps.missed > maps.covered / 10 && maps.missed < maps.covered / 2);
    for (int i = 0; i < 64 * 64; i++) {
        assert_true(fabsf(tl_image_floats(&maps.heights)[i]) <= params.reach_m * 1.001f);
        assert_near(glms_vec3_norm((vec3s){{tl_image_floats(&maps.normals)[3 * i],
                                            tl_image_floats(&maps.normals)[3 * i + 1],
                                            tl_image_floats(&maps.normals)[3 * i + 2]}}),
                    1, 1e-5);
    }
    tl_transfer_release(&maps);
    test_shape_release(&coarse);
    coarse = plane(4); /* UVs that fill a quarter: the rest is a margin, then flat */
    for (size_t i = 0; i < coarse.mesh.vertex_count; i++)
        coarse.mesh.uvs[i] = glms_vec2_scale(coarse.mesh.uvs[i], 0.5f);
    test_shape_refresh(&coarse);
    params.reach_m = 1;
    assert_ok(tl_transfer_make(&coarse.surface, &fine.surface, &params, &maps, &error), error);
    assert_int_equal(maps.covered, 32 * 32);
    float border = tl_image_floats(&maps.heights)[10 * 64 + 31],
          beside = tl_image_floats(&maps.heights)[10 * 64 + 33];
    assert_true(fabsf(border) > 1e-3f);
    assert_near(beside, border, 0.3 * (double)fabsf(border));
    assert_near(tl_image_floats(&maps.heights)[10 * 64 + 31 + TL_TRANSFER_MARGIN + 1], 0, 0);
    tl_transfer_release(&maps);
    test_shape_release(&coarse);
    test_shape_release(&fine);
}

static void refusals(void **state)
{
    (void)state;
    struct test_shape coarse = plane(2), fine = bumped_plane(8);
    struct tl_transfer maps;
    tl_error error = {0};
    const struct tl_transfer_params params = {16, 16, 0.05f};
    for (int kind = 0; kind < 4; kind++) { /* the last: the finer mesh's back */
        static const char *const words[] = {"leave the unit square", "has no texture coordinates",
                                            "nowhere within reach", "nowhere within reach"};
        for (size_t i = 0; i < coarse.mesh.vertex_count; i++) {
            if (kind == 0 && i == 3)
                coarse.mesh.uvs[i].x = 1.5f;
            if (kind == 1)
                coarse.mesh.uvs[i] = (vec2s){{0, 0}};
            coarse.mesh.positions[i].z = kind == 2 ? 1 : 0;
        }
        for (size_t i = 0; kind == 3 && i < fine.mesh.vertex_count; i++)
            fine.mesh.normals[i] = glms_vec3_negate(fine.mesh.normals[i]);
        test_shape_refresh(&coarse);
        test_shape_refresh(&fine);
        assert_false(tl_transfer_make(&coarse.surface, &fine.surface, &params, &maps, &error));
        print_message("%s\n", error.message);
        assert_non_null(strstr(error.message, words[kind]));
        assert_null(maps.normals.texels);
        test_shape_release(&coarse);
        coarse = plane(2);
    }
    test_shape_release(&coarse);
    test_shape_release(&fine);
}

/* A ball with bumps along its radius; normals by differences of its own parametrisation. */
static vec3s ball_point(double u, double v)
{
    double du, dv, r = 0.6 + bump(u, v, &du, &dv) * sin(M_PI * v), phi = 2 * M_PI * u, theta = M_PI * v;
    return (vec3s){
        {(float)(r * sin(theta) * sin(phi)), (float)(r * cos(theta)), (float)(r * sin(theta) * cos(phi))}};
}

static struct test_shape bumped_ball(int segments)
{
    struct test_shape shape = test_sphere((vec3s){{0, 0, 0}}, 0.6f, segments);
    for (size_t i = 0; i < shape.mesh.vertex_count; i++) {
        vec3s n = shape.mesh.normals[i];
        double u = atan2((double)n.x, (double)n.z) / (2 * M_PI),
               v = acos(fmin(fmax((double)n.y, -1), 1)) / M_PI, d = 1e-3;
        shape.mesh.positions[i] = ball_point(u, v);
        vec3s across = glms_vec3_sub(ball_point(u + d, v), ball_point(u - d, v));
        vec3s down = glms_vec3_sub(ball_point(u, v + d), ball_point(u, v - d));
        vec3s normal = glms_vec3_cross(down, across);
        if (glms_vec3_norm(normal) > 1e-12f && fabs((double)n.y) < 0.999)
            shape.mesh.normals[i] = glms_vec3_normalize(normal);
    }
    test_shape_refresh(&shape);
    return shape;
}

/* Ray traced under one lamp: the coarse ball of 16 segments with a normal map against the finer ball. The
 * error falls with the map's size, to what the coarse ball's own shape leaves (its points lie up to 3 mm
 * beside the finer ball's, which the map does not move); plain, the coarse ball is several times farther off.
 */
static void maps_stand_for_the_finer_mesh(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    struct test_shape fine = bumped_ball(256);
    fine.material.diffuse = (vec3s){{0.5f, 0.5f, 0.5f}};
    fine.material.specular = (vec3s){{0, 0, 0}};
    test_scene_open_lamplit(&scene, fine, 128, 128);
    scene.settings.light.method = TL_METHOD_REFERENCE;
    scene.settings.image.supersample = 2;
    tl_image wanted = test_scene_draw(&scene, device->renderer);
    struct test_scene other;
    struct test_shape coarse = test_sphere((vec3s){{0, 0, 0}}, 0.6f, 16);
    coarse.material = fine.material;
    test_scene_open_lamplit(&other, coarse, 128, 128);
    other.settings = scene.settings;
    double plain = test_scene_error(&other, device->renderer, &wanted).rel_rmse, before = plain;
    print_message("coarse ball: rel. RMSE %.4f without maps\n", plain);
    for (int side = 8; side <= 32; side *= 2) {
        struct tl_transfer maps;
        tl_error error = {0};
        const struct tl_transfer_params params = {2 * side, side, 0.1f};
        assert_ok(
            tl_transfer_make(&other.shapes[0].surface, &scene.shapes[0].surface, &params, &maps, &error),
            error);
        tl_image encoded = tl_bake_encoded(&maps.normals);
        other.shapes[0].material.normal_map.image = &encoded;
        test_scene_refresh(&other);
        double off = test_scene_error(&other, device->renderer, &wanted).rel_rmse;
        other.settings.light.method = TL_METHOD_UNSHADOWED;
        double drawn = test_scene_error(&other, device->renderer, &wanted).rel_rmse;
        other.settings.light.method = TL_METHOD_REFERENCE;
        print_message("map of %d x %d: traced %.4f, drawn %.4f; %zu of %zu rays missed\n", 2 * side, side,
                      off, drawn, maps.missed, maps.covered);
        assert_true(off < before);
        before = off;
        tl_image_release(&encoded);
        tl_transfer_release(&maps);
        other.shapes[0].material.normal_map.image = NULL;
        test_scene_refresh(&other);
    }
    assert_true(before < plain / 3);
    tl_image_release(&wanted);
    test_scene_close(&scene);
    test_scene_close(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_have_the_closed_form),
        cmocka_unit_test(reach_and_gaps),
        cmocka_unit_test(refusals),
        cmocka_unit_test(maps_stand_for_the_finer_mesh),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
