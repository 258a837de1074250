/* Charts against surfaces whose maps from the plane are known: bent, stretched, unwrapped; and the rest
 * shapes and strains that follow from them. */
#include "assets/model.h"
#include "assets/sewing/charts.h"
#include "assets/sewing/rest.h"
#include "cloth/energy/strain.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <string.h>

/* Panels of CELLS x CELLS squares, each cut in two. */
enum { CELLS = 24, PANEL_VERTICES = (CELLS + 1) * (CELLS + 1), PANEL_INDICES = 6 * CELLS * CELLS };

typedef vec3s (*shape)(double x, double y); /* of the point (x, y) of the flat panel, metres */
typedef vec2s (*mapping)(double x, double y);

static vec3s make3(double x, double y, double z)
{
    return (vec3s){{(float)x, (float)y, (float)z}};
}

static vec2s make2(double u, double v)
{
    return (vec2s){{(float)u, (float)v}};
}

/* Chords are shorter than the arc of a cell by (0.4 / 24 / 0.2)^2 / 24, which is 3e-4. */
#define CHORD 5e-4

static vec3s flat(double x, double y)
{
    return make3(x, y, 0);
}
static vec3s cylinder(double x, double y)
{
    return make3(0.2 * sin(x / 0.2), y, 0.2 * cos(x / 0.2));
}
/* A developed cone: the flat point's polar angle shrinks to half, around an apex that is 0.5 m off. */
static vec3s cone(double x, double y)
{
    double radius = hypot(x, y + 0.5), angle = 2 * atan2(x, y + 0.5);
    return make3(radius / 2 * sin(angle), -radius * sqrt(0.75), radius / 2 * cos(angle));
}
static vec3s stretched(double x, double y) /* bent, and 10 % longer along the warp */
{
    vec3s at = cylinder(x, y);
    at.y *= 1.1f;
    return at;
}
static vec3s part_stretched(double x, double y) /* 15 % along the weft in two fifths, as over a body */
{
    return flat(x > 0.25 ? 0.25 + 1.15 * (x - 0.25) : x, y);
}
/* By up to 12 % along weft and warp, over three fifths of each. */
static double grown(double x)
{
    return x > 0.16 ? x + 0.06 * (x - 0.16) * (x - 0.16) / 0.24 : x;
}
static vec3s bulging(double x, double y)
{
    return flat(grown(x), grown(y));
}
static vec3s sheared(double x, double y)
{
    return flat(x + 0.05 * y, y);
}
static vec3s sphere(double x, double y) /* longitude and latitude */
{
    double around = x * 2 * M_PI / 0.4, up = (y / 0.4 - 0.5) * M_PI;
    return make3(0.3 * cos(up) * sin(around), 0.3 * sin(up), 0.3 * cos(up) * cos(around));
}

static vec2s in_metres(double x, double y) /* v runs downwards */
{
    return make2(x, -y);
}
static vec2s in_atlas(double x, double y)
{
    return make2(0.1 + x / 2, 0.9 - y / 2);
}
static vec2s squeezed(double x, double y) /* GarmentCode's: u and v fill [0, 1] apart */
{
    return make2(0.1 + x / 2, 0.9 - y / 0.8);
}
static vec2s turned(double x, double y)
{
    return make2(3 * y, 3 * x);
}
static vec2s mirrored(double x, double y)
{
    return make2(5 - x, -y);
}
static vec2s askew(double x, double y) /* turned by 0.5 rad */
{
    return make2(cos(0.5) * x - sin(0.5) * y, -sin(0.5) * x - cos(0.5) * y);
}
static vec2s small(double x, double y)
{
    return make2(x / 4, -y / 4);
}
static vec2s folded(double x, double y)
{
    return make2(fabs(x - 0.2), -y);
}
static vec2s nothing(double x, double y)
{
    (void)x, (void)y;
    return make2(0, 0);
}
static vec2s on_a_line(double x, double y)
{
    return make2(x + y, x + y);
}
static vec2s far_away(double x, double y)
{
    return make2(1e30 * x, -1e30 * y);
}

/* A panel of 0.4 x 0.4 m, or `size` times as large. */
static void add_panel_of(tl_garment *garment, double size, shape place, mapping map)
{
    tl_mesh *mesh = &garment->model.mesh;
    size_t first = mesh->vertex_count;
    mesh->positions = tl_resize(mesh->positions, first + PANEL_VERTICES, sizeof *mesh->positions);
    mesh->uvs = tl_resize(mesh->uvs, first + PANEL_VERTICES, sizeof *mesh->uvs);
    mesh->indices = tl_resize(mesh->indices, mesh->index_count + PANEL_INDICES, sizeof *mesh->indices);
    for (int row = 0; row <= CELLS; row++)
        for (int column = 0; column <= CELLS; column++) {
            double x = size * 0.4 * column / CELLS, y = size * 0.4 * row / CELLS;
            vec3s at = place(x, y);
            at.z += (float)(first / PANEL_VERTICES); /* panels do not touch */
            mesh->positions[mesh->vertex_count] = at;
            mesh->uvs[mesh->vertex_count++] = map(x, y);
        }
    for (uint32_t row = 0; row < CELLS; row++)
        for (uint32_t column = 0; column < CELLS; column++) {
            uint32_t a = (uint32_t)first + row * (CELLS + 1) + column, b = a + 1, c = b + CELLS + 1,
                     d = c - 1;
            const uint32_t two[6] = {a, b, c, a, c, d};
            memcpy(&mesh->indices[mesh->index_count], two, sizeof two);
            mesh->index_count += 6;
        }
}

static void add_panel(tl_garment *garment, shape place, mapping map)
{
    add_panel_of(garment, 1, place, map);
}

static tl_garment make_panel(shape place, mapping map)
{
    tl_garment garment = {.model = {.name = tl_copy_string("panel")}};
    add_panel(&garment, place, map);
    return garment;
}

static struct tl_charts charts_of(const tl_garment *garment, enum tl_chart_verdict verdict, size_t count)
{
    struct tl_charts charts = tl_charts_find(&garment->model.mesh);
    assert_int_equal(charts.whole.verdict, verdict);
    assert_int_equal(charts.count, count);
    return charts;
}

/* Takes the rest shape, and expects the same strains everywhere. */
static void expect_strains(tl_garment *garment, const struct tl_charts *charts, double warp, double weft,
                           double shear, double tolerance)
{
    const tl_mesh *mesh = &garment->model.mesh;
    tl_error error = {0};
    vec3s *strains = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    assert_ok(tl_rest_take(TL_REST_AUTO, charts, garment, &error), error);
    tl_strains *rest = tl_strains_create(garment);
    tl_strains_update(rest, mesh->positions, strains);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        assert_near(strains[i].x, warp, tolerance);
        assert_near(strains[i].y, weft, tolerance);
        assert_near(strains[i].z, shear, tolerance);
    }
    tl_strains_destroy(&rest);
    free(strains);
}

static void check_sheared(shape place, mapping map, double metres_per_unit, double warp, double weft,
                          double shear)
{
    tl_garment garment = make_panel(place, map);
    struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 1);
    assert_near(charts.metres_per_unit[0] / metres_per_unit, 1, CHORD);
    assert_near(charts.metres_per_unit[1] / metres_per_unit, 1, CHORD);
    expect_strains(&garment, &charts, warp, weft, shear, 3 * CHORD);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

static void check_pattern(shape place, mapping map, double metres_per_unit, double warp, double weft)
{
    check_sheared(place, map, metres_per_unit, warp, weft, 0);
}

static void bent_cloth_is_not_strained(void **state)
{
    (void)state;
    check_pattern(flat, in_metres, 1, 0, 0);
    check_pattern(cylinder, in_metres, 1, 0, 0);
    check_pattern(cone, in_metres, 1, 0, 0);
    check_pattern(cylinder, small, 4, 0, 0);
    check_pattern(cylinder, in_atlas, 2, 0, 0);
    check_pattern(cylinder, turned, 1 / 3.0, 0, 0);
    check_pattern(cylinder, mirrored, 1, 0, 0);
    check_pattern(cone, askew, 1, 0, 0);
}

static void stretch_is_read_along_the_threads(void **state)
{
    (void)state;
    check_pattern(stretched, in_metres, 1, 0.1, 0);
    check_pattern(stretched, small, 4, 0.1, 0);
    check_pattern(stretched, mirrored, 1, 0.1, 0);
    check_pattern(stretched, turned, 1 / 3.0, 0, 0.1); /* the warp lies along x */
    /* Principal stretches of 1 + 0.025 and 1 - 0.025: the scale is the lower one. */
    double lower = sqrt(1 + 0.05 * 0.05 / 4) - 0.05 / 2, slant = hypot(1, 0.05);
    check_sheared(sheared, in_metres, lower, slant / lower - 1, 1 / lower - 1, 0.05 / slant);
}

/* Principal strains of 0 and 10 % at any angle: the same residual, ln 1.1 / sqrt 2. */
static void residuals_do_not_depend_on_the_grain(void **state)
{
    (void)state;
    const mapping maps[] = {in_metres, small, turned, mirrored, askew};
    for (size_t i = 0; i < TL_COUNT(maps); i++) {
        tl_garment garment = make_panel(stretched, maps[i]);
        struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 1);
        assert_near(charts.whole.residual, log(1.1) / sqrt(2), CHORD);
        assert_near(charts.pattern_residual, charts.whole.residual, 1e-12);
        assert_near(charts.whole.log_scale, log(1.1) / 2, CHORD);
        assert_int_equal(charts.mirrored_count, maps[i] == mirrored);
        tl_charts_release(&charts);
        tl_garment_release(&garment);
    }
}

/* A body that stretches a part of the cloth does not change its scale. */
static void scale_is_that_of_most_cloth(void **state)
{
    (void)state;
    tl_garment garment = make_panel(part_stretched, in_metres);
    add_panel(&garment, cylinder, in_metres);
    struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 2);
    assert_near(charts.metres_per_unit[0], 1, CHORD);
    assert_near(charts.items[0].stretched_share, 1.15 * 0.15 / (0.25 + 1.15 * 0.15),
                1e-6); /* of its area in space */
    assert_near(charts.items[1].stretched_share, 0, 0);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
    garment = make_panel(bulging, in_metres);
    charts = charts_of(&garment, TL_CHART_IS_PATTERN, 1);
    assert_near(charts.metres_per_unit[0], 1, 0.005); /* what a mode of values from 1 on resolves */
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

static void charts_may_overlap_and_be_mirrored(void **state)
{
    (void)state;
    tl_garment garment = make_panel(cylinder, in_metres);
    add_panel(&garment, cone, in_metres);
    add_panel(&garment, flat, mirrored);
    struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 3);
    assert_int_equal(charts.mirrored_count, 1);
    assert_true(charts.items[2].mirrored);
    assert_int_equal(charts.pattern_count, 3);
    for (size_t t = 0; t < charts.triangle_count; t++)
        assert_int_equal(charts.of_triangle[t], t / (PANEL_INDICES / 3));
    expect_strains(&garment, &charts, 0, 0, 0, 3 * CHORD);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

/* Vertices that only normals split belong together; panels whose UVs differ do not. */
static void charts_end_where_uvs_do(void **state)
{
    (void)state;
    tl_garment garment = make_panel(flat, in_metres);
    tl_mesh *mesh = &garment.model.mesh;
    tl_garment split = {.model = {.name = tl_copy_string("split")}};
    tl_mesh *corners = &split.model.mesh;
    corners->vertex_count = corners->index_count = mesh->index_count;
    corners->positions = TL_NEW_ARRAY(vec3s, mesh->index_count);
    corners->uvs = TL_NEW_ARRAY(vec2s, mesh->index_count);
    corners->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    for (size_t i = 0; i < mesh->index_count; i++) {
        corners->positions[i] = mesh->positions[mesh->indices[i]];
        corners->uvs[i] = mesh->uvs[mesh->indices[i]];
        corners->indices[i] = (uint32_t)i;
    }
    struct tl_charts charts = charts_of(&split, TL_CHART_IS_PATTERN, 1);
    tl_charts_release(&charts);
    for (size_t i = 0; i < mesh->index_count; i++) /* cut at the middle row, and moved apart */
        corners->uvs[i].x += i < mesh->index_count / 2 ? 0 : 7;
    charts = charts_of(&split, TL_CHART_IS_PATTERN, 2);
    tl_charts_release(&charts);
    tl_garment_release(&split);
    tl_garment_release(&garment);
}

/* u and v of GarmentCode's atlases have scales of their own: 2 and 0.8 m per unit. UVs in metres never have,
 * and nearly equal ones do not either: their difference is strain. */
static void an_atlas_may_be_squeezed(void **state)
{
    (void)state;
    tl_garment garment = make_panel(flat, squeezed);
    struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 1);
    assert_near(charts.metres_per_unit[0], 2, 1e-6);
    assert_near(charts.metres_per_unit[1], 0.8, 1e-6);
    expect_strains(&garment, &charts, 0, 0, 0, 3 * CHORD);
    char *line = tl_rest_describe("panel", &charts);
    assert_non_null(strstr(line, "2000 x 800 mm per unit"));
    free(line);
    tl_charts_release(&charts);
    for (size_t i = 0; i < garment.model.mesh.vertex_count; i++)
        garment.model.mesh.uvs[i].x += 3; /* it is no atlas any more */
    charts = charts_of(&garment, TL_CHART_IS_RESCALED, 1);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

/* Buttons and zippers have UVs of other kinds: they keep their shape, the cloth has its pattern. */
static void trims_keep_their_shape(void **state)
{
    (void)state;
    tl_garment garment = make_panel(stretched, in_metres);
    add_panel_of(&garment, 0.1, flat, small);
    struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 2);
    assert_int_equal(charts.pattern_count, 1);
    assert_int_equal(charts.items[1].verdict, TL_CHART_IS_RESCALED);
    assert_near(charts.pattern_share, 1.1 / 1.11, 1e-3);
    tl_error error = {0};
    assert_ok(tl_rest_take(TL_REST_AUTO, &charts, &garment, &error), error);
    const tl_mesh *mesh = &garment.model.mesh;
    vec3s *strains = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    tl_strains *rest = tl_strains_create(&garment);
    tl_strains_update(rest, mesh->positions, strains);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        assert_near(strains[i].x, i < PANEL_VERTICES ? 0.1 : 0, 3 * CHORD);
    char *line = tl_rest_describe("panel", &charts);
    assert_non_null(strstr(line, "1 of 2 charts"));
    free(line);
    tl_strains_destroy(&rest);
    free(strains);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

/* The garment keeps the shape of its mesh unless it is told otherwise, and the reason is given. */
static struct tl_charts check_refused(tl_garment *garment, enum tl_chart_verdict verdict, size_t count,
                                      const char *words)
{
    struct tl_charts charts = charts_of(garment, verdict, count);
    tl_error error = {0};
    assert_ok(tl_rest_take(TL_REST_AUTO, &charts, garment, &error), error);
    assert_null(garment->pattern);
    char *line = tl_rest_describe("panel", &charts);
    assert_non_null(strstr(line, "that of its mesh"));
    assert_non_null(strstr(line, words));
    free(line);
    assert_ok(tl_rest_take(TL_REST_UV, &charts, garment, &error), error);
    assert_non_null(garment->pattern);
    assert_false(garment->modelled[0]);
    return charts;
}

/* Of a sphere of latitudes b, with 2 cos b of longitudes' stretch for 1 of latitudes': the root mean square
 * over its area. */
static double sphere_residual(void)
{
    enum { STEPS = 100000 };
    double squares = 0, area = 0;
    for (int i = 0; i < STEPS; i++) {
        double cosine = cos(((i + 0.5) / STEPS - 0.5) * M_PI);
        double log_stretch = fmax(log(2 * cosine), -log(2));
        squares += cosine * log_stretch * log_stretch / 2;
        area += cosine;
    }
    return sqrt(squares / area);
}

static void unwrapped_shapes_are_refused(void **state)
{
    (void)state;
    tl_garment garment = make_panel(sphere, in_metres);
    struct tl_charts charts = check_refused(&garment, TL_CHART_IS_RESCALED, 1, "scales of their own");
    assert_near(charts.whole.residual, sphere_residual(), 0.01);
    assert_near(charts.metres_per_unit[0], 0.3 * M_PI / 0.4, 0.02);
    tl_charts_release(&charts);
    tl_garment_release(&garment);

    garment = make_panel(flat, in_metres);
    add_panel(&garment, flat, small);
    add_panel(&garment, flat, turned);
    charts = check_refused(&garment, TL_CHART_IS_RESCALED, 3, "scales of their own");
    tl_charts_release(&charts);
    tl_garment_release(&garment);

    garment = make_panel(flat, folded);
    charts = check_refused(&garment, TL_CHART_IS_FOLDED, 1, "upon themselves");
    assert_near(charts.whole.folded_share, 0.5, 1e-6);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

/* Nothing to measure: no UVs, UVs on a line, no triangles; and far too large ones. */
static void meshes_without_charts(void **state)
{
    (void)state;
    const mapping maps[] = {nothing, on_a_line};
    tl_error error = {0};
    for (size_t i = 0; i < TL_COUNT(maps); i++) {
        tl_garment garment = make_panel(flat, maps[i]);
        struct tl_charts charts = charts_of(&garment, TL_CHART_IS_UNMAPPED, 1);
        assert_true(charts.metres_per_unit[0] == 0);
        assert_false(tl_rest_take(TL_REST_UV, &charts, &garment, &error));
        assert_int_equal(error.code, TL_USAGE);
        char *line = tl_rest_describe("panel", &charts);
        assert_non_null(strstr(line, "no UVs on 100 %"));
        free(line);
        tl_charts_release(&charts);
        tl_garment_release(&garment);
    }
    tl_garment empty = {.model = {.name = tl_copy_string("empty")}};
    struct tl_charts charts = charts_of(&empty, TL_CHART_IS_UNMAPPED, 0);
    tl_charts_release(&charts);
    tl_garment_release(&empty);
    check_pattern(flat, far_away, 1e-30, 0, 0);
}

static void mesh_is_a_choice(void **state)
{
    (void)state;
    tl_garment garment = make_panel(cylinder, in_metres);
    struct tl_charts charts = charts_of(&garment, TL_CHART_IS_PATTERN, 1);
    tl_error error = {0};
    assert_ok(tl_rest_take(TL_REST_MESH, &charts, &garment, &error), error);
    assert_null(garment.pattern);
    tl_charts_release(&charts);
    tl_garment_release(&garment);
}

static void check_file(const char *file, enum tl_chart_verdict verdict, size_t pattern_count, double residual)
{
    tl_model model;
    tl_error error = {0};
    assert_ok(tl_model_load(test_data(file), &model, &error), error);
    struct tl_charts charts = tl_charts_find(&model.mesh);
    char *line = tl_rest_describe(model.name, &charts);
    printf("%s\n", line);
    free(line);
    assert_int_equal(charts.whole.verdict, verdict);
    assert_int_equal(charts.pattern_count, pattern_count);
    assert_near(charts.whole.residual, residual, 0.005);
    tl_charts_release(&charts);
    tl_model_release(&model);
}

/* The staged panels are flat copies of their UVs; the others' verdicts and residuals are what came out, and
 * say which kind each file is. */
static void real_files(void **state)
{
    (void)state;
    check_file("garments/cipc_dress_knife_stage.obj", TL_CHART_IS_PATTERN, 14, 0);
    check_file("garments/mh_female_sportsuit01.glb", TL_CHART_IS_STRETCHED, 0, 0.222);
    check_file("garments/mh_male_casualsuit06.glb", TL_CHART_IS_STRETCHED, 2, 0.079);
    check_file("garments/bjs_clothFolds.glb", TL_CHART_IS_STRETCHED, 0, 0.183);
    check_file("garments/diffcloth_tshirt1000-tri.obj", TL_CHART_IS_RESCALED, 0, 0.598);
    check_file("garments/diffcloth_skirt3448.obj", TL_CHART_IS_UNMAPPED, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bent_cloth_is_not_strained),
        cmocka_unit_test(stretch_is_read_along_the_threads),
        cmocka_unit_test(residuals_do_not_depend_on_the_grain),
        cmocka_unit_test(scale_is_that_of_most_cloth),
        cmocka_unit_test(charts_may_overlap_and_be_mirrored),
        cmocka_unit_test(charts_end_where_uvs_do),
        cmocka_unit_test(an_atlas_may_be_squeezed),
        cmocka_unit_test(trims_keep_their_shape),
        cmocka_unit_test(unwrapped_shapes_are_refused),
        cmocka_unit_test(meshes_without_charts),
        cmocka_unit_test(mesh_is_a_choice),
        cmocka_unit_test(real_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
