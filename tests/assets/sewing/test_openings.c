/* Names of openings: on shapes whose openings are known, on every built-in cut, and on real garments. */
#include "assets/base/placing.h"
#include "assets/garment.h"
#include "assets/model.h"
#include "assets/sewing/openings.h"
#include "assets/topology/sets.h"
#include "cloth/mesh/topology.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <string.h>

/* A mesh of tubes, welded. */
struct shape {
    size_t vertex_count, triangle_count;
    vec3s *positions;
    uint32_t (*triangles)[3];
};

static void release(struct shape *shape)
{
    free(shape->positions);
    free(shape->triangles);
    *shape = (struct shape){0};
}

enum { AROUND = 24, RINGS = 9 };

/* A tube around the line from `from` to `to`, of radii that are interpolated; both ends are open. */
static void add_tube(struct shape *shape, vec3s from, vec3s to, const double *radii)
{
    uint32_t first = (uint32_t)shape->vertex_count;
    vec3s axis = glms_vec3_normalize(glms_vec3_sub(to, from));
    vec3s across = glms_vec3_normalize(glms_vec3_cross(axis, (vec3s){{0.1f, 0.2f, 1}}));
    vec3s onward = glms_vec3_cross(axis, across);
    shape->positions =
        tl_resize(shape->positions, shape->vertex_count + AROUND * RINGS, sizeof *shape->positions);
    shape->triangles = tl_resize(shape->triangles, shape->triangle_count + 2 * AROUND * (RINGS - 1),
                                 sizeof *shape->triangles);
    for (int ring = 0; ring < RINGS; ring++)
        for (int k = 0; k < AROUND; k++) {
            double angle = 2 * M_PI * k / AROUND;
            vec3s at = glms_vec3_lerp(from, to, (float)ring / (RINGS - 1));
            at = glms_vec3_add(at, glms_vec3_scale(across, (float)(radii[ring] * cos(angle))));
            shape->positions[shape->vertex_count++] =
                glms_vec3_add(at, glms_vec3_scale(onward, (float)(radii[ring] * sin(angle))));
        }
    for (uint32_t ring = 0; ring + 1 < RINGS; ring++)
        for (uint32_t k = 0; k < AROUND; k++) {
            uint32_t a = first + ring * AROUND + k, b = first + ring * AROUND + (k + 1) % AROUND;
            const uint32_t two[2][3] = {{a, b, b + AROUND}, {a, b + AROUND, a + AROUND}};
            memcpy(shape->triangles[shape->triangle_count], two, sizeof two);
            shape->triangle_count += 2;
        }
}

static struct tl_openings find(const struct shape *shape)
{
    const struct tl_opening_mesh mesh = {shape->vertex_count, shape->triangle_count, shape->positions,
                                         (const uint32_t(*)[3])shape->triangles};
    struct tl_openings openings;
    assert_true(tl_openings_find(&mesh, &openings));
    return openings;
}

/* Names in order, with commas between them. */
static void expect_names(const char *what, const struct tl_openings *openings, const char *names)
{
    char found[1024] = "";
    for (size_t i = 0; i < openings->count; i++) {
        size_t length = strlen(found);
        snprintf(found + length, sizeof found - length, "%s%s", i > 0 ? ", " : "", openings->items[i].name);
    }
    if (strcmp(found, names) != 0)
        print_error("%s: %s\n", what, found);
    assert_string_equal(found, names);
}

static void tubes(void **state)
{
    (void)state;
    const double skirt[RINGS] = {0.13, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19, 0.2, 0.21};
    const double strapless[RINGS] = {0.15, 0.14, 0.12, 0.12, 0.14, 0.15, 0.16, 0.17, 0.18};
    const vec3s top = {{0, 1, 0}}, bottom = {{0, 0.5f, 0}};
    struct shape shape = {0};
    add_tube(&shape, top, bottom, skirt);
    struct tl_openings openings = find(&shape);
    expect_names("skirt", &openings, "waist, hem");
    const struct tl_opening *waist = tl_openings_named(&openings, "waist");
    assert_non_null(waist);
    assert_null(tl_openings_named(&openings, "neck"));
    double side = 2 * sin(M_PI / AROUND); /* a chord of the unit circle */
    assert_near(waist->length, AROUND * side * 0.13, 1e-6);
    assert_near(tl_opening_length(waist, shape.positions), waist->length, 0);
    assert_near(waist->centre.y, 1, 1e-6);
    assert_near(waist->normal.y, 1, 1e-6);
    assert_int_equal(waist->side_count, AROUND);
    for (size_t i = 0; i < shape.vertex_count; i++) /* stretched to twice the size */
        shape.positions[i] = glms_vec3_scale(shape.positions[i], 2);
    assert_near(tl_opening_length(waist, shape.positions), 2 * waist->length, 1e-6);
    tl_openings_release(&openings);
    release(&shape);

    add_tube(&shape, top, bottom, strapless);
    add_tube(&shape, (vec3s){{0, 0.9f, 0}}, bottom, skirt); /* a petticoat, in no touch with it */
    openings = find(&shape);
    expect_names("strapless dress", &openings, "top, waist, hem, hem 2");
    tl_openings_release(&openings);
    release(&shape);

    add_tube(&shape, (vec3s){{-0.3f, 1, 0}}, (vec3s){{0.3f, 1, 0}}, skirt); /* a muff, on no body */
    openings = find(&shape);
    expect_names("muff", &openings, "opening 1, opening 2");
    tl_openings_release(&openings);
    release(&shape);
}

/* Joins vertices at one place, and those that a seam joins, as sewing does. */
static struct shape weld(const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *sets = tl_sets_create(mesh->vertex_count), *places = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    uint32_t *firsts = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, places);
    for (uint32_t i = (uint32_t)mesh->vertex_count; i-- > 0;)
        firsts[places[i]] = i;
    for (uint32_t i = 0; i < mesh->vertex_count && garment->seam_count == 0; i++)
        tl_sets_join(sets, i, firsts[places[i]]);
    for (size_t i = 0; i < garment->seam_count; i++)
        tl_sets_join(sets, garment->seams[i].a, garment->seams[i].b);
    struct shape shape = {.vertex_count = mesh->vertex_count};
    shape.positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    shape.triangles = tl_alloc(mesh->index_count / 3, sizeof *shape.triangles);
    memcpy(shape.positions, mesh->positions, mesh->vertex_count * sizeof *mesh->positions);
    for (size_t t = 0; t < mesh->index_count / 3; t++) {
        uint32_t *v = shape.triangles[shape.triangle_count];
        for (size_t k = 0; k < 3; k++)
            v[k] = tl_sets_find(sets, mesh->indices[3 * t + k]);
        shape.triangle_count += v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
    }
    free(firsts);
    free(places);
    free(sets);
    return shape;
}

static void check_cut(const char *name, const char *names)
{
    tl_garment garment;
    tl_error error = {0};
    assert_ok(tl_garment_cut(name, 0.04f, &garment, &error), error);
    struct shape shape = weld(&garment);
    struct tl_openings openings = find(&shape);
    expect_names(name, &openings, names);
    tl_openings_release(&openings);
    release(&shape);
    tl_garment_release(&garment);
}

static void built_in_cuts(void **state)
{
    (void)state;
    check_cut("dress", "neck, left armhole, right armhole, hem");
    check_cut("skirt", "waist, hem");
    check_cut("trousers", "waist, left leg hem, right leg hem");
    check_cut("shirt", "neck, left cuff, right cuff, hem");
}

static void check_file(const char *file, const char *names)
{
    tl_garment garment = {0};
    tl_error error = {0};
    assert_ok(tl_model_load(test_data(file), &garment.model, &error), error);
    const struct tl_placing placing = {.z_up = garment.model.units.z_up, .scale = 1};
    tl_placing_apply(&placing, &garment.model.mesh);
    struct shape shape = weld(&garment);
    struct tl_openings openings = find(&shape);
    expect_names(file, &openings, names);
    tl_openings_release(&openings);
    release(&shape);
    tl_garment_release(&garment);
}

static void real_garments(void **state)
{
    (void)state;
    check_file("garments/diffcloth_tshirt1000-tri.obj", "neck, left cuff, right cuff, hem");
    check_file("sequences/tshirt_iter0/000.obj", "neck, left cuff, right cuff, hem");
    check_file("garments/diffcloth_skirt3448.obj", "waist, hem");
    check_file("garments/diffcloth_dress-v5k-f10k.obj",
               "neck, opening 1, left cuff, right cuff, hem, opening 2");
    check_file("garments/diffcloth_dress-handsup-drape.obj", "waist, hem, opening 1, opening 2");
    check_file("garments/mh_female_sportsuit01.glb",
               "neck, left cuff, right cuff, hem, waist, left leg hem, right leg hem");
    check_file("garments/mh_male_casualsuit06.glb",
               "neck, left cuff, right cuff, waist, hem, left leg hem, right leg hem");
    /* Blown over by wind: what opens to the side has no sure name. */
    check_file("sequences/tshirt_iter0/120.obj", "opening 1, opening 2, opening 3, opening 4");
    check_file("garments/bjs_clothFolds.glb", "outline 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tubes), cmocka_unit_test(built_in_cuts),
                                       cmocka_unit_test(real_garments)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
