/* Reading sewing patterns: geometry against closed forms, refusals by their text. */
#include "assets/pattern/pattern_cut.h"
#include "assets/pattern/pattern_place.h"
#include "config/base/file.h"
#include "tests/assets/hostile.h"

#include <string.h>

/* A file around the members of `pattern` and of `properties`. */
static const char *write_pattern(const char *name, const char *pattern, const char *properties)
{
    static char path[1024], text[8192];
    snprintf(path, sizeof path, "%s", scratch(name));
    int length =
        snprintf(text, sizeof text, "{\"pattern\": {%s}, \"properties\": {%s}}", pattern, properties);
    assert_true(length < (int)sizeof text);
    scratch_write(path, text, (size_t)length);
    return path;
}

#define CM     "\"units_in_meter\": 100"
#define SQUARE "\"vertices\": [[0, 0], [20, 0], [20, 10], [0, 10]]"

/* One panel of 20 by 10 units whose bottom, from (0, 0) to (20, 0), has a curvature. */
static tl_pattern load_curved(const char *curvature, const char *properties)
{
    char text[1024];
    tl_error error = {0};
    tl_pattern pattern;
    snprintf(text, sizeof text,
             "\"panels\": {\"front\": {" SQUARE
             ", \"edges\": [{\"endpoints\": [0, 1]%s%s}, {\"endpoints\": [1, "
             "2]}, {\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}]}}",
             curvature ? ", \"curvature\": " : "", curvature ? curvature : "");
    assert_ok(tl_pattern_load(write_pattern("curved.json", text, properties), &pattern, &error), error);
    return pattern;
}

/* The point of the bottom at half its length. */
static struct tl_point middle_of_bottom(const tl_pattern *pattern)
{
    struct tl_point points[2];
    tl_pattern_edge_divide(&pattern->panels[0].edges[0], 2, points);
    return points[1];
}

static void test_units_scale_lengths(void **state)
{
    (void)state;
    const struct {
        const char *properties;
        double metres;
    } cases[] = {{"\"units_in_meter\": 100", 0.2}, {"\"units_in_meter\": 1000", 0.02}, {"", 0.2}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_pattern pattern = load_curved(NULL, cases[i].properties);
        assert_near(tl_pattern_edge_length(&pattern.panels[0].edges[0]), cases[i].metres, 1e-12);
        assert_near(tl_pattern_panel_area(&pattern.panels[0]), cases[i].metres * cases[i].metres / 2, 1e-12);
        tl_pattern_release(&pattern);
    }
}

/* From (0, 0) to (20, 0) right is -y: SVG's sweep in axes with y up. A radius of 12.5 has its centre 7.5 off
 * the chord, so it bulges by 5 or, the long way round, by 20. */
static void test_arcs_bulge_to_the_side_of_their_flags(void **state)
{
    (void)state;
    const double half = asin(10 / 12.5);
    const struct {
        const char *curvature;
        double y, length;
    } cases[] = {
        {"{\"type\": \"circle\", \"params\": [12.5, 0, 1]}", -0.05, 0.125 * 2 * half},
        {"{\"type\": \"circle\", \"params\": [12.5, 0, 0]}", 0.05, 0.125 * 2 * half},
        {"{\"type\": \"circle\", \"params\": [12.5, true, true]}", -0.2, 0.125 * (2 * M_PI - 2 * half)},
        {"{\"type\": \"circle\", \"params\": [10, 0, 1]}", -0.1, 0.1 * M_PI}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_pattern pattern = load_curved(cases[i].curvature, CM);
        assert_near(middle_of_bottom(&pattern).x, 0.1, 1e-9);
        assert_near(middle_of_bottom(&pattern).y, cases[i].y, 1e-9);
        assert_near(tl_pattern_edge_length(&pattern.panels[0].edges[0]), cases[i].length, 1e-9);
        tl_pattern_release(&pattern);
    }
}

/* Where the panel's point (x, y) hangs. */
static vec3s hung(const struct tl_pattern_panel *panel, double x, double y)
{
    vec3s at;
    for (int k = 0; k < 3; k++)
        at.raw[k] = (float)(panel->origin[k] + x * panel->across[k] + y * panel->up[k]);
    return at;
}

/* Relative control points: along the chord and to its left, in chords. The middle of a symmetric quadratic is
 * half as high as its control point, of a cubic three quarters. */
static void test_curves_follow_their_control_points(void **state)
{
    (void)state;
    const struct {
        const char *curvature, *properties;
        double y; /* where it hangs */
    } cases[] = {
        {"[0.5, 0.1]", CM, 0.01},
        {"{\"type\": \"quadratic\", \"params\": [[0.5, -0.2]]}", CM, -0.02},
        {"{\"type\": \"cubic\", \"params\": [[0.25, -0.2], [0.75, -0.2]]}", CM, -0.03},
        {"[10, -4]", CM ", \"curvature_coords\": \"absolute\"", -0.02},
        {"[10, -4]", CM ", \"curvature_coords\": \"absolute\", \"normalize_panel_translation\": true", -0.02},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_pattern pattern = load_curved(cases[i].curvature, cases[i].properties);
        struct tl_point middle = middle_of_bottom(&pattern);
        assert_near(hung(&pattern.panels[0], middle.x, middle.y).x, 0.1, 1e-7);
        assert_near(hung(&pattern.panels[0], middle.x, middle.y).y, cases[i].y, 1e-7);
        tl_pattern_release(&pattern);
    }
}

/* Rz(90) Ry(0) Rx(90) takes (x, y, 0) first to (x, 0, y), then to (0, x, y). In another order, or turned the
 * other way, a sign or two axes change. */
static void test_panels_are_turned_about_x_then_y_then_z(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_pattern pattern;
    const char *path =
        write_pattern("turned.json",
                      "\"panels\": {\"p\": {" SQUARE
                      ", \"rotation\": [90, 0, 90], \"translation\": [100, 200, 300], \"edges\": "
                      "[{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, "
                      "{\"endpoints\": [3, 0]}]}}",
                      CM);
    assert_ok(tl_pattern_load(path, &pattern, &error), error);
    vec3s at = hung(&pattern.panels[0], 0.2, 0.1);
    assert_near(at.x, 1, 1e-6);
    assert_near(at.y, 2.2, 1e-6);
    assert_near(at.z, 3.1, 1e-6);
    tl_pattern_release(&pattern);
}

/* A panel that is listed clockwise is seen from its inner side: it stays where it hangs, and its triangles
 * turn round. Its edges come in any order, and some run against the others. */
static void test_outer_side_is_that_of_the_loop(void **state)
{
    (void)state;
    const char *const loops[] = {"[0, 1], [1, 2], [2, 3], [3, 0]", "[0, 3], [3, 2], [2, 1], [1, 0]",
                                 "[0, 1], [2, 3], [3, 0], [2, 1]"};
    const double facing[] = {1, -1, 1};
    for (size_t i = 0; i < TL_COUNT(loops); i++) {
        char text[1024];
        tl_error error = {0};
        tl_pattern pattern;
        tl_garment garment;
        int used = snprintf(text, sizeof text, "\"panels\": {\"p\": {" SQUARE ", \"edges\": [");
        for (const char *at = loops[i]; at; at = strchr(at + 1, '['))
            used += snprintf(text + used, sizeof text - (size_t)used, "%s{\"endpoints\": %.6s}",
                             at == loops[i] ? "" : ", ", at);
        snprintf(text + used, sizeof text - (size_t)used, "]}}");
        assert_ok(tl_pattern_load(write_pattern("loop.json", text, CM), &pattern, &error), error);
        assert_ok(tl_pattern_cut(&pattern, 0.02f, &garment, &error), error);
        const tl_mesh *mesh = &garment.model.mesh;
        double area = 0, flat = 0;
        for (size_t t = 0; t < mesh->index_count; t += 3) {
            const vec3s *p = mesh->positions;
            const uint32_t *v = &mesh->indices[t];
            vec3s cross = glms_vec3_cross(glms_vec3_sub(p[v[1]], p[v[0]]), glms_vec3_sub(p[v[2]], p[v[0]]));
            area += (double)cross.z / 2;
            flat += (double)glms_vec2_cross(glms_vec2_sub(garment.pattern[v[1]], garment.pattern[v[0]]),
                                            glms_vec2_sub(garment.pattern[v[2]], garment.pattern[v[0]])) /
                    2;
            assert_true((double)mesh->normals[v[0]].z * facing[i] > 0.99);
        }
        assert_near(area, facing[i] * 0.02, 1e-6);
        assert_near(flat, 0.02, 1e-6);
        struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
        assert_near(box.lower.x, 0, 1e-6);
        assert_near(box.upper.x, 0.2, 1e-6);
        tl_garment_release(&garment);
        tl_pattern_release(&pattern);
    }
}

/* Two panels on the bottoms of which stand 4 and 5 edges of 5 cm; sewn, both have 5. The start of one bottom
 * meets the end of the other, except right side on wrong side. The edge's place in the file is what a stitch
 * names, also where the outline begins elsewhere. */
static void test_seams_run_against_each_other(void **state)
{
    (void)state;
    const char *const kinds[] = {"", ", \"right_wrong\""};
    for (size_t i = 0; i < TL_COUNT(kinds); i++) {
        char text[2048];
        tl_error error = {0};
        tl_pattern pattern;
        tl_garment garment;
        snprintf(
            text, sizeof text,
            "\"panels\": {\"a\": {\"vertices\": [[0, 0], [20, 0], [20, 10], [0, 10]], \"edges\": "
            "[{\"endpoints\": [2, 3]}, {\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [3, "
            "0]}]}, \"b\": {\"translation\": [0, 0, 50], \"vertices\": [[0, 0], [25, 0], [25, 10], [0, 10]], "
            "\"edges\": [{\"endpoints\": [3, 0]}, {\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, "
            "{\"endpoints\": [2, 3]}]}}, \"stitches\": [[{\"panel\": \"a\", \"edge\": 1}, {\"panel\": \"b\", "
            "\"edge\": 1}%s]]",
            kinds[i]);
        assert_ok(tl_pattern_load(write_pattern("sewn.json", text, CM), &pattern, &error), error);
        assert_near(tl_pattern_stitch_ease(&pattern, 0), 0.25, 1e-9);
        assert_ok(tl_pattern_cut(&pattern, 0.05f, &garment, &error), error);
        assert_int_equal(garment.seam_count, 6);
        assert_true(garment.welds_seams_only);
        for (size_t s = 0; s < garment.seam_count; s++) {
            vec3s a = garment.model.mesh.positions[garment.seams[s].a];
            vec3s b = garment.model.mesh.positions[garment.seams[s].b];
            assert_near(a.y, 0, 1e-6);
            assert_near(b.y, 0, 1e-6);
            assert_near(b.z - a.z, 0.5, 1e-6);
            assert_near(b.x / 0.25f, i == 0 ? 1 - a.x / 0.2f : a.x / 0.2f, 1e-5);
        }
        tl_garment_release(&garment);
        tl_pattern_release(&pattern);
    }
}

/* A dart: a notch narrower than an edge, whose legs share their tip. Every outline vertex stays on the
 * outline, the triangles cover the panel's area, and the tip is not sewn to itself. */
/* A square of the name, whose edges are bottom, right, top and left. */
#define SQUARE_PANEL(name)                                                                                   \
    "\"" name "\": {" SQUARE ", \"edges\": [{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, "              \
    "{\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}]}"
#define SIDE(name, edge)         "{\"panel\": \"" name "\", \"edge\": " #edge "}"
#define STITCH(a, i, b, j, more) "[" SIDE(a, i) ", " SIDE(b, j) more "]"
#define RIGHT_WRONG              ", \"right_wrong\""

static bool is_right_wrong(const char *panels, const char *stitches, size_t stitch)
{
    char text[4096];
    tl_error error = {0};
    tl_pattern pattern;
    snprintf(text, sizeof text, "\"panels\": {%s}, \"stitches\": [%s]", panels, stitches);
    assert_ok(tl_pattern_load(write_pattern("twisted.json", text, CM), &pattern, &error), error);
    bool found = pattern.stitches[stitch].right_wrong;
    tl_pattern_release(&pattern);
    return found;
}

/* Front and back of a collar, each sewn to its side of a neck: at the shoulder bottom meets bottom, whatever
 * the file says. The ends of a cuff and of its sleeve are rings, which say nothing. */
static void test_seams_that_close_their_edges_are_turned(void **state)
{
    (void)state;
    const char *collar = SQUARE_PANEL("front") ", " SQUARE_PANEL("back") ", " SQUARE_PANEL(
        "collar_front") ", " SQUARE_PANEL("collar_back");
#define NECK                                                                                                 \
    STITCH("front", 1, "back", 3, "")                                                                        \
    ", " STITCH("front", 2, "collar_front", 0, "") ", " STITCH("back", 2, "collar_back", 0, "") ", "
    assert_false(is_right_wrong(collar, NECK STITCH("collar_front", 1, "collar_back", 3, ""), 3));
    assert_false(is_right_wrong(collar, NECK STITCH("collar_front", 1, "collar_back", 3, RIGHT_WRONG), 3));
    const char *cuff = SQUARE_PANEL("sleeve") ", " SQUARE_PANEL("cuff");
#define ARM STITCH("sleeve", 1, "sleeve", 3, "") ", " STITCH("cuff", 1, "cuff", 3, "") ", "
    assert_false(is_right_wrong(cuff, ARM STITCH("sleeve", 0, "cuff", 2, ""), 2));
    assert_true(is_right_wrong(cuff, ARM STITCH("sleeve", 0, "cuff", 2, RIGHT_WRONG), 2));
}

static void test_darts_are_cut_out(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_pattern pattern;
    tl_garment garment;
    const char *path = write_pattern(
        "dart.json",
        "\"panels\": {\"p\": {\"vertices\": [[0, 0], [30, 0], [30, 20], [15.4, 20], [15, 6], [14.9, "
        "20], [0, 20]], \"edges\": [{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, "
        "{\"endpoints\": [2, 3]}, {\"endpoints\": [3, 4]}, {\"endpoints\": [4, 5]}, {\"endpoints\": "
        "[5, 6]}, {\"endpoints\": [6, 0]}]}}, \"stitches\": [[{\"panel\": \"p\", \"edge\": 3}, "
        "{\"panel\": \"p\", \"edge\": 4}]]",
        CM);
    assert_ok(tl_pattern_load(path, &pattern, &error), error);
    const float edges_m[] = {0.05f, 0.02f, 0.007f};
    for (size_t i = 0; i < TL_COUNT(edges_m); i++) {
        assert_ok(tl_pattern_cut(&pattern, edges_m[i], &garment, &error), error);
        double area = 0;
        for (size_t t = 0; t < garment.model.mesh.index_count; t += 3) {
            const uint32_t *v = &garment.model.mesh.indices[t];
            const vec2s *p = garment.pattern;
            double twice =
                (double)glms_vec2_cross(glms_vec2_sub(p[v[1]], p[v[0]]), glms_vec2_sub(p[v[2]], p[v[0]]));
            assert_true(twice > 0);
            area += twice / 2;
        }
        assert_near(area, 0.3 * 0.2 - 0.005 * 0.14 / 2, 1e-6);
        int segments = (int)ceil(0.14 / (double)edges_m[i] - 0.3);
        assert_true(garment.seam_count >= (size_t)segments);
        for (size_t s = 0; s < garment.seam_count; s++)
            assert_near(glms_vec3_distance(garment.model.mesh.positions[garment.seams[s].a],
                                           garment.model.mesh.positions[garment.seams[s].b]),
                        0, 0.0051);
        tl_garment_release(&garment);
    }
    tl_pattern_release(&pattern);
}

/* A skirt with its top at the waist; a bodice that is sewn to it and a yoke that is sewn to the bodice, which
 * follow until they meet the waist or reach the shoulders; a hood that is sewn to nothing, which stays. */
static void test_panels_at_the_waist_are_raised(void **state)
{
    (void)state;
#define RING(label)                                                                                          \
    "\"edges\": [{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]" label             \
    "}, {\"endpoints\": [3, 0]}]"
    const char *const text = "\"panels\": {\"skirt\": {" SQUARE ", \"translation\": [0, 50, 20], " RING(
        ", \"label\": \"lower_interface\"") "}, "
                                            "\"hood\": {" SQUARE ", \"translation\": [0, 90, 20], " RING(
                                                "") "}, "
                                                    "\"bodice\": {" SQUARE
                                                    ", \"translation\": [0, 80, 20], " RING(
                                                        "") "}, "
                                                            "\"yoke\": {" SQUARE
                                                            ", \"translation\": [0, 95, 20], \"rotation\": "
                                                            "[0, 0, %g], " RING(
                                                                "") "}}, "
                                                                    "\"stitches\": [[{\"panel\": \"bodice\", "
                                                                    "\"edge\": 0}, {\"panel\": \"skirt\", "
                                                                    "\"edge\": 2}], "
                                                                    "[{\"panel\": \"yoke\", \"edge\": 0}, "
                                                                    "{\"panel\": \"bodice\", \"edge\": 2}]]";
    const struct {
        double turn, shoulder, rise;
    } cases[] = {{0, 2, 0.25}, {0, 1.2, 0.1}, {0, 1, 0}, {50, 2, 0}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        char filled[4096];
        tl_error error = {0};
        tl_pattern pattern;
        const struct tl_pattern_levels levels = {.waist = 1.05, .shoulder = cases[i].shoulder};
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        snprintf(filled, sizeof filled, text, cases[i].turn);
#pragma GCC diagnostic pop
        assert_ok(tl_pattern_load(write_pattern("waist.json", filled, CM), &pattern, &error), error);
        assert_true(tl_pattern_raise(&pattern, &levels));
        assert_near(hung(&pattern.panels[0], 0.1, 0.1).y, 1.05, 1e-6);
        assert_near(pattern.panels[0].origin[2], 0.2 - 0.015, 1e-9); /* tucked in, towards -z */
        assert_near(pattern.panels[1].origin[1], 0.9, 1e-9);
        assert_near(pattern.panels[2].origin[1], 0.8 + cases[i].rise, 1e-9);
        assert_near(pattern.panels[3].origin[1], 0.95 + cases[i].rise, 1e-9);
        assert_near(pattern.panels[3].origin[2], 0.2, 1e-9);
        tl_pattern_release(&pattern);
    }
    tl_pattern plain = load_curved(NULL, CM);
    assert_false(tl_pattern_raise(&plain, &(struct tl_pattern_levels){.waist = 1.05, .shoulder = 1.4}));
    tl_pattern_release(&plain);
}

/* A square of 20 by 10 cm whose bottom has a label: which vertices are held, where to, and from which side.
 */
static void test_labelled_edges_are_held(void **state)
{
    (void)state;
    const struct tl_pattern_levels levels = {1.05, 1.4, 1.27, 0.08};
    const struct {
        const char *label;
        double left; /* cm, where the panel's left edge hangs */
        struct tl_hold hold;
        size_t count; /* of the bottom's vertices, 10 cm apart */
    } cases[] = {{"lower_interface", -10, {0, 1, 0, 1.05f}, 3}, {"strapless_top", -10, {0, 1, 0, 1.27f}, 3},
                 {"left_collar", 5, {0, 0, 1, 0.08f}, 3},       {"right_collar", -25, {0, 0, -1, -0.08f}, 3},
                 {"left_collar", 0, {0, 0, 1, 0.08f}, 2},       {"right_collar", -20, {0, 0, -1, -0.08f}, 2},
                 {"left_armhole", 5, {0, 0, 0, 0}, 0}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        char text[1024];
        tl_error error = {0};
        tl_pattern pattern;
        tl_garment garment;
        snprintf(text, sizeof text,
                 "\"panels\": {\"front\": {" SQUARE ", \"translation\": [%g, 120, 0], \"edges\": "
                 "[{\"endpoints\": [0, 1], \"label\": \"%s\"}, {\"endpoints\": [1, 2]}, "
                 "{\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}]}}",
                 cases[i].left, cases[i].label);
        assert_ok(tl_pattern_load(write_pattern("held.json", text, CM), &pattern, &error), error);
        tl_pattern_hold(&pattern, &levels);
        assert_ok(tl_pattern_cut(&pattern, 0.09f, &garment, &error), error);
        assert_int_equal(garment.hold_count, cases[i].count);
        for (size_t k = 0; k < garment.hold_count; k++) {
            const struct tl_hold *hold = &garment.holds[k];
            vec3s at = garment.model.mesh.positions[hold->vertex];
            assert_near(at.y, 1.2, 1e-6);
            assert_true(hold->side == 0 || fabs((double)at.x) > 0.01);
            assert_int_equal(hold->axis, cases[i].hold.axis);
            assert_int_equal(hold->side, cases[i].hold.side);
            assert_near(hold->level_m, cases[i].hold.level_m, 1e-7);
        }
        tl_garment_release(&garment);
        tl_pattern_release(&pattern);
    }
}

static void test_measures_stand_beside_the_body(void **state)
{
    (void)state;
    struct tl_pattern_measures measures;
    const char *good = "body:\n  height: 170\n  head_l: 26\n  waist_line: 37.5\n  armscye_depth: 14\n"
                       "  neck_w: 18\n  list: [1, 2]\n";
    const tl_mesh nobody = {0};
    const char *other = "camera:\n  height: 170\n";
    scratch_write(scratch("body.yaml"), good, strlen(good));
    assert_true(tl_pattern_measures(scratch("body.obj"), &measures));
    const struct tl_pattern_levels levels = tl_pattern_levels(&measures, &nobody);
    assert_near(levels.waist, 1.065, 1e-12);
    assert_near(levels.shoulder, 1.44, 1e-12);
    assert_near(levels.under_arm, 1.3, 1e-12);
    assert_near(levels.neck, 0.08, 1e-12);
    scratch_write(scratch("scene.yaml"), other, strlen(other));
    assert_false(tl_pattern_measures(scratch("scene.obj"), &measures));
    assert_false(tl_pattern_measures(scratch("absent.obj"), &measures));
    assert_near(measures.height, 0, 0);
}

#define EDGES                                                                                                \
    "\"edges\": [{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, "                \
    "{\"endpoints\": [3, 0]}]"
#define PANEL "\"p\": {" SQUARE ", " EDGES "}"

/* Each broken file is refused with one line that names the place. */
static void test_broken_files_are_refused_by_their_place(void **state)
{
    (void)state;
    const struct {
        const char *pattern, *properties, *message;
    } cases[] = {
        {"", CM, "pattern.panels"},
        {"\"panels\": []", CM, "pattern.panels"},
        {"\"panels\": {}", CM, "pattern.panels"},
        {"\"panels\": {" PANEL "}", "\"units_in_meter\": 0", "units_in_meter"},
        {"\"panels\": {" PANEL "}", "\"units_in_meter\": \"cm\"", "units_in_meter"},
        {"\"panels\": {" PANEL "}", "\"curvature_coords\": \"polar\"", "curvature_coords"},
        {"\"panels\": {\"p\": {" EDGES "}}", CM, "panel \"p\": vertices"},
        {"\"panels\": {\"p\": {" SQUARE "}}", CM, "panel \"p\": edges"},
        {"\"panels\": {\"p\": {\"vertices\": [[0, 0], [1], [1, 1], [0, 1]], " EDGES "}}", CM, "vertex 1"},
        {"\"panels\": {\"p\": {\"vertices\": [[0, 0], [1e9, 0], [1, 1], [0, 1]], " EDGES "}}", CM,
         "vertex 1"},
        {"\"panels\": {\"p\": {\"vertices\": [[0, 0], [1, 0], [1, 1]], " EDGES "}}", CM, "edge 2: endpoints"},
        {"\"panels\": {\"p\": {\"vertices\": [[0, 0], [0, 0], [1, 1], [0, 1]], " EDGES "}}", CM,
         "edge 0: begins"},
        {"\"panels\": {\"p\": {\"vertices\": [[0, 0], [1, 0], [2, 0], [3, 0]], " EDGES "}}", CM, "no area"},
        {"\"panels\": {\"p\": {" SQUARE ", \"edges\": [{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}]}}",
         CM, "closed loop"},
        {"\"panels\": {\"p\": {" SQUARE ", \"rotation\": [0, 0], " EDGES "}}", CM, "rotation"},
        {"\"panels\": {\"p\": {" SQUARE ", \"translation\": [0, 0, 1e7], " EDGES "}}", CM, "translation"},
        {"\"panels\": {" PANEL ", " PANEL "}", CM, "two panels"},
        {"\"panels\": {\"p\": {" SQUARE ", \"edges\": [{\"endpoints\": [0, 1], \"curvature\": {\"type\": "
         "\"spline\", \"params\": []}}, {\"endpoints\": [1, 0]}]}}",
         CM, "edge 0: curvature"},
        {"\"panels\": {\"p\": {" SQUARE ", \"edges\": [{\"endpoints\": [0, 1], \"curvature\": {\"type\": "
         "\"circle\", \"params\": [5, 0, 1]}}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 0]}]}}",
         CM, "edge 0: an arc of radius 5"},
        {"\"panels\": {" PANEL
         "}, \"stitches\": [[{\"panel\": \"q\", \"edge\": 0}, {\"panel\": \"p\", \"edge\": "
         "1}]]",
         CM, "stitch 0: panel: \"q\""},
        {"\"panels\": {" PANEL
         "}, \"stitches\": [[{\"panel\": \"p\", \"edge\": 4}, {\"panel\": \"p\", \"edge\": "
         "1}]]",
         CM, "stitch 0: edge"},
        {"\"panels\": {" PANEL
         "}, \"stitches\": [[{\"panel\": \"p\", \"edge\": 1}, {\"panel\": \"p\", \"edge\": "
         "1}]]",
         CM, "to itself"},
        {"\"panels\": {" PANEL "}, \"stitches\": [[{\"panel\": \"p\", \"edge\": 1}]]", CM,
         "stitch 0: expected"},
        {"\"panels\": {" PANEL
         "}, \"stitches\": [[{\"panel\": \"p\", \"edge\": 1}, {\"panel\": \"p\", \"edge\": "
         "2}, \"glue\"]]",
         CM, "stitch 0: expected"},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_error error = {0};
        tl_pattern pattern;
        const char *path = write_pattern("broken.json", cases[i].pattern, cases[i].properties);
        assert_false(tl_pattern_load(path, &pattern, &error));
        assert_int_equal(error.code, TL_INPUT);
        assert_int_equal(pattern.panel_count, 0);
        if (!strstr(error.message, cases[i].message) || !strstr(error.message, "broken.json") ||
            strchr(error.message, '\n')) {
            print_error("case %zu: expected \"%s\" in \"%s\"\n", i, cases[i].message, error.message);
            fail();
        }
    }
}

static void test_a_line_that_is_no_json_is_named(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_pattern pattern;
    const char *text = "{\n\"pattern\": {\n\"panels\": oops\n}}";
    scratch_write(scratch("text.json"), text, strlen(text));
    assert_false(tl_pattern_load(scratch("text.json"), &pattern, &error));
    assert_non_null(strstr(error.message, "text.json:3:"));
}

/* A bow tie crosses itself however finely it is divided; edges of a micrometre are too many. */
static void test_what_cannot_be_cut_is_refused(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_pattern pattern;
    tl_garment garment;
    const char *path = write_pattern(
        "tie.json", "\"panels\": {\"tie\": {\"vertices\": [[0, 0], [30, 21], [30, 0], [0, 20]], " EDGES "}}",
        CM);
    assert_ok(tl_pattern_load(path, &pattern, &error), error);
    assert_false(tl_pattern_cut(&pattern, 0.02f, &garment, &error));
    assert_int_equal(error.code, TL_INPUT);
    assert_non_null(strstr(error.message, "panel \"tie\""));
    assert_null(garment.model.mesh.positions);
    tl_pattern_release(&pattern);
    pattern = load_curved(NULL, CM);
    assert_false(tl_pattern_cut(&pattern, 1e-6f, &garment, &error));
    assert_int_equal(error.code, TL_USAGE);
    tl_pattern_release(&pattern);
}

/* Cut short anywhere, a real file is refused or read, never crashed on. */
static void test_files_cut_short(void **state)
{
    (void)state;
    const char *real = test_data("patterns/dress_pencil_specification.json");
    tl_error error = {0};
    struct outcome outcome = {0};
    char *data;
    size_t size;
    assert_ok(tl_file_read(real, &data, &size, &error), error);
    for (size_t i = 1; i < 64; i++) {
        tl_pattern pattern;
        scratch_write(scratch("short.json"), data, size * i / 64);
        bool loaded = tl_pattern_load(scratch("short.json"), &pattern, &error);
        count_outcome(&outcome, scratch("short.json"), loaded, &error);
        if (loaded)
            tl_pattern_release(&pattern);
    }
    assert_int_equal(outcome.loaded, 0);
    free(data);
}

/* The real patterns: their numbers, counted by hand in the files, and every panel's area kept by its
 * triangles. */
static void test_real_patterns(void **state)
{
    (void)state;
    const struct {
        const char *file;
        size_t panels, stitches;
    } cases[] = {{"patterns/shirt_mean_specification.json", 8, 18},
                 {"patterns/dress_pencil_specification.json", 6, 23}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_error error = {0};
        tl_pattern pattern;
        tl_garment garment;
        assert_ok(tl_pattern_load(test_data(cases[i].file), &pattern, &error), error);
        assert_int_equal(pattern.panel_count, cases[i].panels);
        assert_int_equal(pattern.stitch_count, cases[i].stitches);
        assert_ok(tl_pattern_cut(&pattern, 0.02f, &garment, &error), error);
        const tl_mesh *mesh = &garment.model.mesh;
        for (size_t p = 0; p < pattern.panel_count; p++) {
            double area = 0, exact = tl_pattern_panel_area(&pattern.panels[p]);
            for (size_t t = mesh->parts[p].first_index;
                 t < mesh->parts[p].first_index + mesh->parts[p].index_count; t += 3) {
                const uint32_t *v = &mesh->indices[t];
                area += (double)glms_vec2_cross(glms_vec2_sub(garment.pattern[v[1]], garment.pattern[v[0]]),
                                                glms_vec2_sub(garment.pattern[v[2]], garment.pattern[v[0]])) /
                        2;
            }
            assert_near(area, exact, 0.005 * exact); /* chords of 2 cm cut off less of a curve */
        }
        tl_garment_release(&garment);
        tl_pattern_release(&pattern);
    }
}

int main(void)
{
    mkdir(SCRATCH, 0777);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_units_scale_lengths),
        cmocka_unit_test(test_arcs_bulge_to_the_side_of_their_flags),
        cmocka_unit_test(test_curves_follow_their_control_points),
        cmocka_unit_test(test_panels_are_turned_about_x_then_y_then_z),
        cmocka_unit_test(test_outer_side_is_that_of_the_loop),
        cmocka_unit_test(test_seams_run_against_each_other),
        cmocka_unit_test(test_seams_that_close_their_edges_are_turned),
        cmocka_unit_test(test_darts_are_cut_out),
        cmocka_unit_test(test_panels_at_the_waist_are_raised),
        cmocka_unit_test(test_labelled_edges_are_held),
        cmocka_unit_test(test_measures_stand_beside_the_body),
        cmocka_unit_test(test_broken_files_are_refused_by_their_place),
        cmocka_unit_test(test_a_line_that_is_no_json_is_named),
        cmocka_unit_test(test_what_cannot_be_cut_is_refused),
        cmocka_unit_test(test_files_cut_short),
        cmocka_unit_test(test_real_patterns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
