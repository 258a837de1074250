/* Panels of an OBJ file and the stitches that sew them. The oracle of a seam is counting: sewn to one mesh,
 * two panels have no border left along it, no triangle has lost an edge, and their area is what it was. */
#include "assets/sewing/stitches.h"

#include "assets/garment.h"
#include "assets/topology/sets.h"
#include "config/base/memory.h"
#include "tests/assets/hostile.h"
#include "tests/testing.h"

#include <string.h>

/* A panel of 1 x 1 m in two columns, its right side (x = 1) divided into `rows`. Vertices in rows of three.
 */
static void put_panel(FILE *out, int rows, float x, uint32_t first, bool turned_over)
{
    for (int j = 0; j <= rows; j++)
        for (int i = 0; i < 3; i++)
            fprintf(out, "v %g %g 0\nvt %g %g\n", (double)(x + 0.5f * (float)i), (double)j / (double)rows,
                    (double)(x + 0.5f * (float)i), (double)j / (double)rows);
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < 2; i++) {
            uint32_t a = first + (uint32_t)(3 * j + i) + 1, b = a + 1, c = b + 3, d = a + 3;
            if (turned_over)
                fprintf(out, "f %u/%u %u/%u %u/%u %u/%u\n", a, a, d, d, c, c, b, b);
            else
                fprintf(out, "f %u/%u %u/%u %u/%u %u/%u\n", a, a, b, b, c, c, d, d);
        }
}

/* Sews every vertex of the first panel's right side to the second one's left side, by heights. */
static void put_stitches(FILE *out, int rows_a, int rows_b)
{
    uint32_t first_b = 3 * (uint32_t)(rows_a + 1);
    for (int j = 0; j <= rows_a; j++) {
        float height = (float)j / (float)rows_a * (float)rows_b;
        int below = height >= (float)rows_b ? rows_b - 1 : (int)height;
        fprintf(out, "stitch %d %u %u %e\n", 3 * j + 2, first_b + 3 * (uint32_t)below,
                first_b + 3 * (uint32_t)(below + 1), (double)(height - (float)below));
    }
}

struct panels {
    int rows_a, rows_b;
    bool turned_over; /* the second one */
};

static tl_garment load_panels(const struct panels *panels, const char *name)
{
    const char *path = scratch(name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    put_panel(out, panels->rows_a, 0, 0, false);
    put_panel(out, panels->rows_b, 1.5f, 3 * (uint32_t)(panels->rows_a + 1), panels->turned_over);
    put_stitches(out, panels->rows_a, panels->rows_b);
    assert_int_equal(fclose(out), 0);
    tl_garment garment;
    tl_error error = {0};
    assert_ok(tl_garment_load_in(path, TL_UNITS_M, &garment, &error), error);
    assert_true(garment.model.stitch_count > 0);
    return garment;
}

static double area_of(const tl_mesh *mesh)
{
    double area = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *v = &mesh->indices[i];
        vec2s side = glms_vec2_sub(mesh->uvs[v[1]], mesh->uvs[v[0]]);
        vec2s other = glms_vec2_sub(mesh->uvs[v[2]], mesh->uvs[v[0]]);
        area += 0.5 * fabs((double)glms_vec2_cross(side, other));
    }
    return area;
}

struct counts {
    size_t border, shut; /* sides of one triangle only; triangles with two corners in one place */
};

static size_t sides_between(const tl_mesh *mesh, uint32_t *sets, uint32_t a, uint32_t b)
{
    size_t count = 0;
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t p = tl_sets_find(sets, mesh->indices[i]);
        uint32_t q = tl_sets_find(sets, mesh->indices[i % 3 == 2 ? i - 2 : i + 1]);
        count += (p == a && q == b) || (p == b && q == a);
    }
    return count;
}

static struct counts count_sewn(const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    struct counts counts = {0};
    uint32_t *sets = tl_sets_create(mesh->vertex_count);
    for (size_t i = 0; i < garment->seam_count; i++) {
        assert_true(garment->seams[i].a < mesh->vertex_count && garment->seams[i].b < mesh->vertex_count);
        tl_sets_join(sets, garment->seams[i].a, garment->seams[i].b);
    }
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t a = tl_sets_find(sets, mesh->indices[i]);
        uint32_t b = tl_sets_find(sets, mesh->indices[i % 3 == 2 ? i - 2 : i + 1]);
        counts.shut += a == b;
        counts.border += a != b && sides_between(mesh, sets, a, b) == 1;
    }
    free(sets);
    return counts;
}

static void check_closed(const struct panels *panels, size_t added)
{
    tl_garment garment = load_panels(panels, "panels.obj");
    size_t vertex_count = garment.model.mesh.vertex_count;
    struct tl_stitches_report report = tl_stitches_sew(&garment);
    struct counts counts = count_sewn(&garment);
    printf("%d and %d rows: %zu pairs, %zu vertices added\n", panels->rows_a, panels->rows_b, report.sewn,
           report.added);
    assert_int_equal(report.added, added);
    assert_int_equal(garment.model.mesh.vertex_count, vertex_count + added);
    assert_int_equal(counts.shut, 0);
    /* What is left: top and bottom of both, and the two outer sides. */
    assert_int_equal(counts.border, 4 * 2 + panels->rows_a + panels->rows_b);
    assert_near(area_of(&garment.model.mesh), 2, 1e-5);
    assert_int_equal(garment.model.mesh.parts[0].index_count, garment.model.mesh.index_count);
    assert_true(garment.welds_seams_only);
    tl_garment_release(&garment);
}

static void sides_alike(void **state)
{
    (void)state;
    check_closed(&(struct panels){6, 6, false}, 0);
    check_closed(&(struct panels){6, 6, true}, 0);
}

static void second_side_finer(void **state)
{
    (void)state;
    check_closed(&(struct panels){6, 7, false}, 1);
    check_closed(&(struct panels){6, 7, true}, 1);
    check_closed(&(struct panels){4, 12, false}, 8);
}

/* Two stitches go to the same end of an edge: one of them is dropped, and its vertex gets a partner in the
 * edge instead. */
static void first_side_finer(void **state)
{
    (void)state;
    check_closed(&(struct panels){7, 6, false}, 1);
    check_closed(&(struct panels){12, 4, false}, 8);
}

/* A stitch at a third of an edge goes to the nearer end, which is the first. */
static void goes_to_the_nearer_end(void **state)
{
    (void)state;
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 2 1 0\nf 1 2 3\nf 4 5 6\n"
                               "stitch 1 3 5 0.333\nstitch 2 3 5 6.67e-001\n";
    const char *path = scratch("ends.obj");
    scratch_write(path, text, sizeof text - 1);
    tl_garment garment;
    tl_error error = {0};
    assert_ok(tl_garment_load_in(path, TL_UNITS_M, &garment, &error), error);
    tl_stitches_sew(&garment);
    assert_int_equal(garment.seam_count, 2);
    assert_int_equal(garment.seams[0].a, 1);
    assert_int_equal(garment.seams[0].b, 3);
    assert_int_equal(garment.seams[1].a, 2);
    assert_int_equal(garment.seams[1].b, 5);
    tl_garment_release(&garment);
}

/* Vertices that a file splits at its texture coordinates stay one, though nothing is welded by its place. */
static void joins_what_texture_coordinates_split(void **state)
{
    (void)state;
    static const char text[] =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt "
        "1 1\nvt 0 1\nvt 5 5\nvt 5 6\nvt 6 6\n"
        "f 1/1 2/2 3/3\nf 1/5 3/6 4/7\nf 5/1 6/2 7/3\nstitch 1 4 5 0\n";
    const char *path = scratch("split.obj");
    scratch_write(path, text, sizeof text - 1);
    tl_garment garment;
    tl_error error = {0};
    assert_ok(tl_garment_load_in(path, TL_UNITS_M, &garment, &error), error);
    assert_int_equal(garment.model.mesh.vertex_count, 9);
    tl_stitches_sew(&garment);
    assert_int_equal(garment.seam_count, 3); /* two splits and a stitch */
    assert_int_equal(count_sewn(&garment).border, 4 + 3);
    tl_garment_release(&garment);
}

static void refuses_what_is_no_stitch(void **state)
{
    (void)state;
    static const struct {
        const char *stitch, *message;
    } cases[] = {{"stitch 0 1 9 0", "stitch 1 has a vertex out of range: there are 3"},
                 {"stitch 0 1 2", "line 5: place on a stitch's edge"},
                 {"stitch 0 -1 2 0", "\"-1\" is no vertex"},
                 {"stitch 0 1.5 2 0", "\"1.5\" is no vertex"},
                 {"stitch 0 1 4294967297 0", "\"4294967297\" is no vertex"},
                 {"stitch 0 1 2 nan", "line 5: place on a stitch's edge"}};
    const char *path = scratch("broken.obj");
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        char text[256];
        int length = snprintf(text, sizeof text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n%s\n", cases[i].stitch);
        scratch_write(path, text, (size_t)length);
        tl_garment garment;
        tl_error error = {0};
        assert_false(tl_garment_load_in(path, TL_UNITS_M, &garment, &error));
        if (error.code != TL_INPUT || !strstr(error.message, cases[i].message)) {
            print_error("%s: \"%s\"\n", cases[i].stitch, error.message);
            fail();
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_alike),
        cmocka_unit_test(second_side_finer),
        cmocka_unit_test(first_side_finer),
        cmocka_unit_test(goes_to_the_nearer_end),
        cmocka_unit_test(joins_what_texture_coordinates_split),
        cmocka_unit_test(refuses_what_is_no_stitch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
