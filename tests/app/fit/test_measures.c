/* Measures of cloth whose strains, borders and girths are known, and girths of bodies against their tape
 * measures. */
#include "app/fit/girths.h"
#include "app/fit/measures.h"
#include "assets/avatar.h"
#include "assets/body/form.h"
#include "assets/model.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <string.h>

enum { AROUND = 40, ROWS = 25, TUBE_VERTICES = (AROUND + 1) * (ROWS + 1) };

/* Adds a tube around a vertical line at x, from y = 0.8 to 1.2, cut along its back unless `open` parts it
 * there; its pattern is that of an unstretched one, `weft` and `warp` times as small. Outside is
 * counter-clockwise. */
static void add_tube(tl_garment *garment, double x, double radius, double weft, double warp, bool open)
{
    tl_mesh *mesh = &garment->model.mesh;
    uint32_t first = (uint32_t)mesh->vertex_count, next = (uint32_t)mesh->index_count;
    double chord = 2 * radius * sin(M_PI / AROUND);
    mesh->vertex_count += TUBE_VERTICES;
    mesh->index_count += (size_t)6 * AROUND * ROWS;
    mesh->positions = tl_resize(mesh->positions, mesh->vertex_count, sizeof *mesh->positions);
    mesh->uvs = tl_resize(mesh->uvs, mesh->vertex_count, sizeof *mesh->uvs);
    garment->pattern = tl_resize(garment->pattern, mesh->vertex_count, sizeof *garment->pattern);
    mesh->indices = tl_resize(mesh->indices, mesh->index_count, sizeof *mesh->indices);
    for (uint32_t row = 0; row <= ROWS; row++)
        for (uint32_t column = 0; column <= AROUND; column++) {
            uint32_t v = first + row * (AROUND + 1) + column;
            double angle = 2 * M_PI * (column % AROUND) / AROUND + M_PI,
                   gap = open && column == AROUND ? 1e-4 : 0;
            double y = 0.8 + 0.4 * row / ROWS;
            mesh->positions[v] =
                (vec3s){{(float)(x + radius * sin(angle) + gap), (float)y, (float)(radius * cos(angle))}};
            garment->pattern[v] = (vec2s){{(float)(column * chord / weft), (float)(y / warp)}};
            mesh->uvs[v] = (vec2s){{garment->pattern[v].x + (float)first, -garment->pattern[v].y}};
        }
    for (uint32_t row = 0; row < ROWS; row++)
        for (uint32_t column = 0; column < AROUND; column++) {
            uint32_t a = first + row * (AROUND + 1) + column, d = a + AROUND + 1;
            const uint32_t two[6] = {a, a + 1, d + 1, a, d + 1, d};
            memcpy(&mesh->indices[next], two, sizeof two);
            next += 6;
        }
}

/* Gives all triangles one material each half, by their order. */
static void add_parts(tl_garment *garment, const char *one, const char *other)
{
    tl_model *model = &garment->model;
    uint32_t half = (uint32_t)model->mesh.index_count / 6 * 3;
    model->name = tl_copy_string("tubes");
    model->material_count = model->mesh.part_count = 2;
    model->materials = TL_NEW_ARRAY(tl_material, 2);
    model->materials[0] = tl_material_default(one);
    model->materials[1] = tl_material_default(other);
    model->mesh.parts = TL_NEW_ARRAY(struct tl_mesh_part, 2);
    model->mesh.parts[0] = (struct tl_mesh_part){.index_count = half};
    model->mesh.parts[1] = (struct tl_mesh_part){
        .first_index = half, .index_count = (uint32_t)model->mesh.index_count - half, .material = 1};
}

static struct tl_measures take(const tl_garment *garment, const tl_mesh *body)
{
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    const struct tl_measures_source source = {garment, mesh->positions, weld, body};
    struct tl_measures measures = tl_measures_take(&source);
    free(weld);
    return measures;
}

/* Float coordinates near 1 m over sides of 2 cm. */
#define ROUNDING 2e-5

static void check_spread(const struct tl_spread *spread, double mean, double p95, double max)
{
    assert_near(spread->mean, mean, ROUNDING);
    assert_near(spread->p95, p95, ROUNDING);
    assert_near(spread->max, max, ROUNDING);
}

/* Two tubes: one 10 % longer along the warp, one 4 % along the weft and 2 % shorter along the warp. */
static void strains_by_panel(void **state)
{
    (void)state;
    tl_garment garment = {0};
    add_tube(&garment, 0, 0.2, 1, 1.1, false);
    add_tube(&garment, 0.6, 0.1, 1.04, 0.98, false);
    add_parts(&garment, "body", "sleeve");
    struct tl_measures measures = take(&garment, NULL);
    assert_true(measures.has_pattern);
    assert_int_equal(measures.panel_count, 2);
    const struct tl_panel_measures *body = &measures.panels[0], *sleeve = &measures.panels[1];
    assert_string_equal(body->name, "body");
    assert_string_equal(sleeve->name, "sleeve");
    check_spread(&body->warp, 0.1, 0.1, 0.1);
    check_spread(&body->weft, 0, 0, 0);
    check_spread(&body->shear, 0, 0, 0);
    check_spread(&sleeve->warp, -0.02, -0.02, -0.02);
    check_spread(&sleeve->weft, 0.04, 0.04, 0.04);
    double around[2] = {2 * AROUND * 0.2 * sin(M_PI / AROUND), 2 * AROUND * 0.1 * sin(M_PI / AROUND)};
    assert_near(body->worn_m2, around[0] * 0.4, 1e-6);
    assert_near(body->rest_m2, around[0] * 0.4 / 1.1, 1e-6);
    assert_near(sleeve->rest_m2, around[1] * 0.4 / 1.04 / 0.98, 1e-6);
    double shares[2] = {body->rest_m2, sleeve->rest_m2}, total = shares[0] + shares[1];
    assert_near(measures.whole.worn_m2, body->worn_m2 + sleeve->worn_m2, 1e-9);
    check_spread(&measures.whole.warp, (0.1 * shares[0] - 0.02 * shares[1]) / total, 0.1, 0.1);
    check_spread(&measures.whole.weft, 0.04 * shares[1] / total, 0.04, 0.04);

    assert_int_equal(measures.opening_count, 4);
    for (int i = 0; i < 4; i++) { /* of each height the one on +X first */
        const struct tl_opening_measures *opening = &measures.openings[i];
        bool is_sleeve = i % 2 == 0;
        assert_near(opening->worn_m, around[is_sleeve], 1e-6);
        assert_near(opening->rest_m, around[is_sleeve] / (is_sleeve ? 1.04 : 1), 1e-5);
        assert_near(opening->height_m, i < 2 ? 1.2 : 0.8, 1e-6);
    }
    assert_true(measures.girths[TL_GIRTH_WAIST].height_m == 0); /* there is no body */
    tl_measures_release(&measures);
    garment.model.mesh.parts[1].material = 0;
    measures = take(&garment, NULL);
    assert_string_equal(measures.panels[0].name, "body 1");
    assert_string_equal(measures.panels[1].name, "body 2");
    tl_measures_release(&measures);

    free(garment.pattern); /* without a pattern: parts are panels, and nothing is strained */
    garment.pattern = NULL;
    measures = take(&garment, NULL);
    assert_false(measures.has_pattern);
    assert_int_equal(measures.panel_count, 2);
    check_spread(&measures.panels[0].warp, 0, 0, 0);
    tl_measures_release(&measures);
    tl_garment_release(&garment);
}

/* One row of 25 is longer: 4 % of the area. Twice that moves the percentile. */
static void percentiles_are_of_area(void **state)
{
    (void)state;
    for (int rows = 1; rows <= 2; rows++) {
        tl_garment garment = {0};
        add_tube(&garment, 0, 0.2, 1, 1, false);
        add_parts(&garment, "cloth", "cloth");
        garment.model.mesh.part_count = 1;
        garment.model.mesh.parts[0].index_count = (uint32_t)garment.model.mesh.index_count;
        for (uint32_t i = 0; i < TUBE_VERTICES; i++)
            if ((int)(i / (AROUND + 1)) > ROWS - rows)
                garment.model.mesh.positions[i].y +=
                    0.3f * 0.4f / ROWS * (float)((int)(i / (AROUND + 1)) - ROWS + rows);
        struct tl_measures measures = take(&garment, NULL);
        assert_int_equal(measures.panel_count, 1);
        assert_string_equal(measures.panels[0].name, "cloth");
        check_spread(&measures.panels[0].warp, 0.3 * rows / ROWS, rows == 1 ? 0 : 0.3, 0.3);
        tl_measures_release(&measures);
        tl_garment_release(&garment);
    }
}

/* On the figure: a tube around its trunk, stretched by 6 % along the weft, sleeves beside it, a cut one
 * outside. */
static void cloth_around_the_body(void **state)
{
    (void)state;
    tl_avatar figure = tl_avatar_figure();
    const tl_mesh *body = &figure.model.mesh;
    tl_garment garment = {0};
    add_tube(&garment, 0, 0.25, 1.06, 1, false);
    for (size_t v = 0; v < TUBE_VERTICES; v++) /* cut wider towards its top */
        garment.pattern[v].x *= 1 + 0.5f * (garment.model.mesh.positions[v].y - 0.8f);
    add_tube(&garment, 0.6, 0.3, 1, 1, false);
    add_tube(&garment, -0.6, 0.3, 1, 1, false);
    add_tube(&garment, 0, 0.5, 1, 1, true);
    add_parts(&garment, "a", "b");
    struct tl_measures measures = take(&garment, body);
    double around = 2 * AROUND * 0.25 * sin(M_PI / AROUND);
    for (int i = 0; i < TL_GIRTHS; i++) {
        const struct tl_girth_measures *girth = &measures.girths[i];
        bool reaches = girth->height_m > 0.8 && girth->height_m < 1.2;
        assert_true(girth->body_m > 0.6);
        assert_true(reaches || i != TL_GIRTH_WAIST);
        assert_near(girth->worn_m, reaches ? around : 0, 1e-5);
        assert_near(girth->rest_m, reaches ? around / 1.06 * (1 + 0.5 * (girth->height_m - 0.8)) : 0, 1e-5);
    }
    tl_measures_release(&measures);
    tl_garment_release(&garment);
    tl_avatar_release(&figure);
}

static void check_body(const char *name, const tl_mesh *body, const double girths[TL_GIRTHS],
                       double tolerance)
{
    struct tl_girth_measures found[TL_GIRTHS];
    tl_girths_of_body(body, found);
    for (int i = 0; i < TL_GIRTHS; i++) {
        printf("%s: %s %.3f m at %.2f m, by tape %.3f m\n", name, tl_girth_names[i], found[i].body_m,
               found[i].height_m, girths[i]);
        assert_near(found[i].body_m / girths[i], 1, tolerance);
    }
}

/* The form by its own sections; a body by the measures that come with it. Its tape slopes around the bust. */
static void bodies(void **state)
{
    (void)state;
    const double of_form[TL_GIRTHS] = {tl_form_girth(TL_FORM_BUST), tl_form_girth(TL_FORM_WAIST),
                                       tl_form_girth(TL_FORM_HIP)};
    tl_avatar form = tl_avatar_form();
    check_body("form", &form.model.mesh, of_form, 0.01);
    tl_avatar_release(&form);

    const double of_body[TL_GIRTHS] = {0.998407, 0.843338, 1.03478}; /* mean_all.yaml */
    tl_model model;
    tl_error error = {0};
    assert_ok(tl_model_load(test_data("avatars/mean_all.obj"), &model, &error), error);
    check_body("mean_all", &model.mesh, of_body, 0.01);
    tl_model_release(&model);

    const vec3s corners[3] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}}; /* a body that is flat has none */
    const uint32_t indices[3] = {0, 1, 2};
    const tl_mesh flat = {
        .vertex_count = 3, .positions = (vec3s *)corners, .index_count = 3, .indices = (uint32_t *)indices};
    struct tl_girth_measures none[TL_GIRTHS];
    tl_girths_of_body(&flat, none);
    for (int i = 0; i < TL_GIRTHS; i++)
        assert_true(none[i].height_m == 0 && none[i].body_m == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strains_by_panel),
        cmocka_unit_test(percentiles_are_of_area),
        cmocka_unit_test(cloth_around_the_body),
        cmocka_unit_test(bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
