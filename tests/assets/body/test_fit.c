/* Girths against circles of known length; garments moved and scaled to such a body. */
#include "tests/testing.h"

#include "assets/body/fit.h"
#include "assets/body/form.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define SIDES 96

/* Open tubes of height 1: radius and centre of each. */
static tl_mesh tubes(const float (*circles)[3], size_t count)
{
    tl_mesh mesh = {.vertex_count = count * SIDES * 2, .index_count = count * SIDES * 6};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, mesh.index_count);
    uint32_t *index = mesh.indices;
    for (size_t t = 0; t < count; t++)
        for (uint32_t i = 0; i < SIDES; i++) {
            float angle = 2 * (float)M_PI * (float)i / SIDES;
            uint32_t base = (uint32_t)t * SIDES * 2, next = (i + 1) % SIDES;
            for (uint32_t level = 0; level < 2; level++)
                mesh.positions[base + 2 * i + level] =
                    (vec3s){{circles[t][1] + circles[t][0] * cosf(angle), (float)level,
                             circles[t][2] + circles[t][0] * sinf(angle)}};
            const uint32_t quad[6] = {2 * i, 2 * i + 1, 2 * next, 2 * next, 2 * i + 1, 2 * next + 1};
            for (int k = 0; k < 6; k++)
                *index++ = base + quad[k];
        }
    return mesh;
}

static void girth_of_a_tube_is_its_circle(void **state)
{
    (void)state;
    const float circles[][3] = {{0.15f, 0.1f, -0.2f}};
    tl_mesh mesh = tubes(circles, 1);
    struct tl_girth girth;
    assert_true(tl_mesh_girth(&mesh, 0.4f, &girth));
    assert_near(girth.length_m, 2 * SIDES * 0.15 * sin(M_PI / SIDES), 1e-5); /* the inscribed polygon */
    assert_near(girth.centre.x, 0.1, 1e-5);
    assert_near(girth.centre.y, -0.2, 1e-5);
    assert_false(tl_mesh_girth(&mesh, 1.5f, &girth));
    tl_mesh_release(&mesh);
}

static void girth_ignores_arms(void **state)
{
    (void)state;
    const float circles[][3] = {{0.05f, -0.3f, 0}, {0.15f, 0, 0}, {0.05f, 0.3f, 0}};
    tl_mesh mesh = tubes(circles, 3);
    struct tl_girth girth;
    assert_true(tl_mesh_girth(&mesh, 0.5f, &girth));
    assert_near(girth.length_m, 2 * SIDES * 0.15 * sin(M_PI / SIDES), 1e-5);
    assert_near(girth.centre.x, 0, 1e-5);
    tl_mesh_release(&mesh);
}

/* Tubes around a tube. */
static void size_is_told_by_girths(void **state)
{
    (void)state;
    const struct {
        float radius;
        const char *told; /* NULL: it fits */
    } cases[] = {{0.17f, "0.85 of the waist of body"},
                 {0.185f, NULL},
                 {0.26f, NULL},
                 {0.28f, "1.40 times as wide as body is anywhere"}};
    const float trunk[][3] = {{0.2f, 0, 0}};
    tl_mesh body = tubes(trunk, 1);
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        const float circle[][3] = {{cases[i].radius, 0, 0}};
        tl_mesh garment = tubes(circle, 1);
        char *line = tl_describe_size("shirt.obj", &garment, "body", &body);
        if (cases[i].told) {
            assert_non_null(line);
            assert_non_null(strstr(line, cases[i].told));
        } else {
            assert_null(line);
        }
        free(line);
        tl_mesh_release(&garment);
    }
    tl_mesh_release(&body);
}

/* By lengths first, which need no girths: of a sheet beside a body. */
static void size_is_told_by_lengths(void **state)
{
    (void)state;
    const float trunk[][3] = {{0.2f, 0, 0}};
    tl_mesh body = tubes(trunk, 1);
    struct tl_box box = tl_box_of(body.positions, body.vertex_count);
    const double body_m = (double)(box.upper.y - box.lower.y);
    const double ratios[] = {0.095, 0.105, 1, 1.2, 1.3, 25.4};
    for (size_t i = 0; i < TL_COUNT(ratios); i++) {
        vec3s corners[] = {{{0, 0, 0}}, {{(float)(ratios[i] * body_m), 0, 0}}, {{0, 0, 0.01f}}};
        const tl_mesh garment = {.vertex_count = 3, .positions = corners};
        char *line = tl_describe_size("sheet.obj", &garment, "body", &body);
        char *expected = tl_format("%.3g times as large as body", ratios[i]);
        bool is_told = ratios[i] < 0.1 || ratios[i] > 1.25;
        assert_int_equal(line != NULL, is_told);
        assert_true(!is_told || strstr(line, expected));
        free(line);
        free(expected);
    }
    tl_mesh_release(&body);
}

/* A body 1.62 m high whose waist is a tube of 1.2 times the form's girth, at (0.02, -0.03): the middle
 * between 0.56 and 0.66 of its height is where the narrowest section is found first. A garment of two points
 * on the form's waist and one 10 cm below is moved there, and only if it is scaled its lengths change. */
static void refit_alters_the_size_and_else_nothing_does(void **state)
{
    (void)state;
    const float radius = 1.2f * (float)tl_form_girth(TL_FORM_WAIST) / (2 * SIDES * sinf((float)M_PI / SIDES));
    const float circle[][3] = {{radius, 0.02f, -0.03f}};
    tl_mesh body = tubes(circle, 1);
    const float form_y = (float)TL_FORM_WAIST;
    struct tl_waist waist;
    assert_true(tl_mesh_waist(&body, &waist));
    for (int scaled = 0; scaled < 2; scaled++) {
        vec3s positions[] = {{{0.1f, form_y, 0}}, {{-0.1f, form_y, 0}}, {{0, form_y - 0.1f, 0.1f}}};
        vec2s pattern[] = {{{0, 0}}, {{0.2f, 0}}, {{0.1f, 0.15f}}},
              uvs[] = {{{0, 0}}, {{0.2f, 0}}, {{0.1f, -0.15f}}};
        tl_garment garment = {
            .model = {.name = "dress", .mesh = {.vertex_count = 3, .positions = positions, .uvs = uvs}},
            .pattern = pattern};
        tl_error error = {0};
        assert_ok(tl_garment_fit(&garment, "body", &body, scaled, &error), error);
        const float scale = scaled ? 1.2f : 1;
        assert_near(positions[0].x, 0.02f + 0.1f * scale, 1e-4);
        assert_near(positions[1].x, 0.02f - 0.1f * scale, 1e-4);
        assert_near(positions[2].z, -0.03f + 0.1f * scale, 1e-4);
        assert_near(positions[0].y, waist.y_m, 1e-5);
        assert_near(positions[2].y, waist.y_m - 0.1f * scale, 1e-4);
        assert_near(pattern[1].x, 0.2f * scale, 1e-4);
        assert_near(uvs[2].y, -0.15f * scale, 1e-4);
    }
    tl_mesh_release(&body);
}

static void another_waist_is_told(void **state)
{
    (void)state;
    const float to_girth = 2 * SIDES * sinf((float)M_PI / SIDES),
                form_m = (float)tl_form_girth(TL_FORM_WAIST);
    const float same[][3] = {{1.02f * form_m / to_girth, 0, 0}},
                wide[][3] = {{1.2f * form_m / to_girth, 0, 0}};
    tl_mesh fits = tubes(same, 1), large = tubes(wide, 1);
    assert_null(tl_describe_waist("dress", "body", &fits));
    char *line = tl_describe_waist("dress", "body", &large);
    assert_non_null(line);
    assert_non_null(strstr(line, "that of body is 0.82 m"));
    assert_non_null(strstr(line, "1.20 times as large"));
    free(line);
    tl_mesh_release(&fits);
    tl_mesh_release(&large);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(girth_of_a_tube_is_its_circle),
        cmocka_unit_test(girth_ignores_arms),
        cmocka_unit_test(size_is_told_by_girths),
        cmocka_unit_test(size_is_told_by_lengths),
        cmocka_unit_test(another_waist_is_told),
        cmocka_unit_test(refit_alters_the_size_and_else_nothing_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
