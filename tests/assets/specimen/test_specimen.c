/* Specimens: their surfaces against the closed forms, closed where they should be, in metric UV. */
#include "tests/testing.h"

#include "assets/specimen/cusick.h"
#include "assets/specimen/specimen.h"
#include "config/base/memory.h"

#include <math.h>

static tl_garment make(const char *name, float edge_m)
{
    tl_garment garment;
    assert_true(tl_specimen_make(name, edge_m, &garment));
    return garment;
}

static void drop(tl_garment *garment)
{
    tl_garment_release(garment);
}

/* Signed volume, by the divergence theorem: positive only if triangles face outwards. */
static double volume(const tl_mesh *mesh)
{
    double sum = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        vec3s a = mesh->positions[mesh->indices[i]], b = mesh->positions[mesh->indices[i + 1]];
        sum += (double)glms_vec3_dot(a, glms_vec3_cross(b, mesh->positions[mesh->indices[i + 2]])) / 6;
    }
    return sum;
}

/* Inscribed polygons of n and m edges fall short of the circles by (2 pi^2 / 3) / n^2 each. */
static void test_volumes(void **state)
{
    (void)state;
    const double expected[] = {4.0 / 3 * M_PI * pow(0.15, 3), 2 * M_PI * M_PI * 0.12 * 0.055 * 0.055};
    const char *const names[] = {"sphere", "torus"};
    for (int i = 0; i < 2; i++) {
        tl_garment solid = make(names[i], 0.006f);
        assert_true(solid.solid);
        double short_by = 1 - volume(&solid.model.mesh) / expected[i];
        double edges = 2 * M_PI * 0.055 / 0.006; /* of the smaller circle, rounded down */
        double bound = 2 * M_PI * M_PI / (edges * edges);
        assert_near(short_by, bound / 2, bound / 2);
        drop(&solid);
    }
}

static void test_sphere_normals_point_from_its_centre(void **state)
{
    (void)state;
    tl_garment sphere = make("sphere", 0.02f);
    const tl_mesh *mesh = &sphere.model.mesh;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        vec3s out = glms_vec3_scale(glms_vec3_sub(mesh->positions[v], (vec3s){{0, 0.2f, 0}}), 1 / 0.15f);
        assert_near(glms_vec3_distance(out, mesh->normals[v]), 0, 1e-5);
    }
    drop(&sphere);
}

/* A flat disc whose weft runs in circles: u turns about its middle, as its tangents do. */
static void test_plate(void **state)
{
    (void)state;
    const vec3s middle = {{0, 0.2f, 0}};
    tl_garment plate = make("plate", 0.006f);
    const tl_mesh *mesh = &plate.model.mesh;
    double area = 0;
    assert_true(plate.solid);
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        vec3s p[3];
        for (int k = 0; k < 3; k++)
            p[k] = mesh->positions[mesh->indices[i + (size_t)k]];
        const vec3s across = glms_vec3_cross(glms_vec3_sub(p[1], p[0]), glms_vec3_sub(p[2], p[0]));
        assert_true(glms_vec3_dot(across, mesh->normals[0]) > 0);
        area += (double)glms_vec3_norm(across) / 2;
    }
    const double corners = 2 * M_PI * 0.15 / 0.006, circle = M_PI * 0.15 * 0.15;
    assert_near(area, circle * (1 - 2 * M_PI * M_PI / 3 / (corners * corners)), 1e-4 * circle);
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        const vec3s out = glms_vec3_sub(mesh->positions[v], middle);
        assert_near(glms_vec3_dot(out, mesh->normals[v]), 0, 1e-6);
        assert_near(glms_vec3_norm(out), mesh->uvs[v].y, 1e-6);
    }
    drop(&plate);
}

/* The flat sheet's UVs are its pattern. */
static void test_uvs_are_metric(void **state)
{
    (void)state;
    tl_garment sheet = make("sheet", 0.02f);
    assert_false(sheet.solid);
    assert_near(sheet.model.mesh.parts[0].uv_metres, 1, 1e-4);
    double area = 0;
    const tl_mesh *mesh = &sheet.model.mesh;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        vec3s a = mesh->positions[mesh->indices[i]];
        vec3s side = glms_vec3_sub(mesh->positions[mesh->indices[i + 1]], a);
        vec3s across = glms_vec3_cross(side, glms_vec3_sub(mesh->positions[mesh->indices[i + 2]], a));
        assert_true(across.y > 0);
        area += 0.5 * (double)glms_vec3_norm(across);
    }
    assert_near(area, 0.25, 1e-5);
    drop(&sheet);
}

/* A regular polygon of n corners is short of its circle by 2 pi^2 / 3 n^2 of it; curves add 0.06 %. */
static void test_disc(void **state)
{
    (void)state;
    const double radius = 0.15, plate = 0.09, edge = 0.01;
    tl_garment disc = make("disc", (float)edge);
    const tl_mesh *mesh = &disc.model.mesh;
    double area = 0, corners = 2 * M_PI * radius / edge;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        vec3s a = mesh->positions[mesh->indices[i]];
        vec3s side = glms_vec3_sub(mesh->positions[mesh->indices[i + 1]], a);
        vec3s across = glms_vec3_cross(side, glms_vec3_sub(mesh->positions[mesh->indices[i + 2]], a));
        area += 0.5 * (double)across.y; /* level, facing up */
    }
    double whole = M_PI * radius * radius, share = area / whole;
    assert_near(share, 1 - 2 * M_PI * M_PI / (3 * corners * corners), 1e-3);
    size_t inside = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        inside += hypot((double)mesh->positions[v].x, (double)mesh->positions[v].z) <= plate;
    assert_int_equal(disc.pin_count, inside);
    assert_true(inside > 100 && inside < mesh->vertex_count);
    drop(&disc);
}

static void test_unknown(void **state)
{
    (void)state;
    tl_garment garment;
    assert_false(tl_specimen_make("cube", 0.02f, &garment));
}

/* The disc's ring bent down by `angle` along the plate's edge, with `folds` waves of 1 mm: a cone. */
static double drape_of(double angle, int folds, int *found)
{
    tl_garment disc = make("disc", 0.004f);
    const tl_mesh *mesh = &disc.model.mesh;
    vec3s *bent = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        double x = (double)mesh->positions[i].x, z = (double)mesh->positions[i].z;
        double out = fmax(hypot(x, z) - TL_CUSICK_PLATE_M, 0);
        double share = out > 0 ? (TL_CUSICK_PLATE_M + out * cos(angle)) / hypot(x, z) : 1;
        double y = TL_CUSICK_HEIGHT_M - out * sin(angle) + 1e-3 * cos(folds * atan2(z, x));
        bent[i] = (vec3s){{(float)(share * x), (float)y, (float)(share * z)}};
    }
    tl_image shadow = tl_cusick_shadow(&disc, bent);
    double coefficient = tl_cusick_coefficient(&shadow);
    *found = tl_cusick_folds(&disc, bent);
    tl_image_release(&shadow);
    free(bent);
    drop(&disc);
    return coefficient;
}

/* The shadow of a cone is a disc. The outline has 59 edges a quarter, short by 2e-4 of its area; a texel is
 * half a millimetre, of which the outline takes in or leaves out half at random. */
static void test_drape_of_a_cone(void **state)
{
    (void)state;
    const double disc = TL_CUSICK_DISC_M, plate = TL_CUSICK_PLATE_M;
    for (int step = 0; step <= 4; step++) {
        int found;
        double angle = step * M_PI / 8, radius = plate + (disc - plate) * cos(angle);
        double expected = (radius * radius - plate * plate) / (disc * disc - plate * plate);
        assert_near(drape_of(angle, 3 + 2 * step, &found), expected, 0.004);
        assert_int_equal(found, 3 + 2 * step);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_volumes),        cmocka_unit_test(test_sphere_normals_point_from_its_centre),
        cmocka_unit_test(test_plate),          cmocka_unit_test(test_drape_of_a_cone),
        cmocka_unit_test(test_uvs_are_metric), cmocka_unit_test(test_disc),
        cmocka_unit_test(test_unknown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
