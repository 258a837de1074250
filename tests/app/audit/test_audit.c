/* The findings of an audit. Each test writes a small file with one fault in it, and states the code, the
 * place and the number of findings that follow from how it was made; all other codes must be absent. The
 * sheet without a fault is the control: whatever is found in it is a false alarm. */
#include "app/audit/audit_json.h"
#include "app/fit/sewn.h"
#include "assets/model.h"
#include "assets/sewing/stitches.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A sheet of SIDE x SIDE squares of 100 mm in the plane z = 0, two triangles each: that of the square (i, j)
 * below its diagonal is triangle 2 (SIDE j + i). */
#define SIDE 4
#define ROW  (SIDE + 1)

struct sheet {
    double places[64][3]; /* metres */
    int place_count;
    int triangles[80][3];
    int triangle_count;
    bool has_uvs; /* as cut: metres */
    const char *material;
};

static int square(int i, int j)
{
    return 2 * (SIDE * j + i);
}

static int add_place(struct sheet *sheet, double x, double y, double z)
{
    double *place = sheet->places[sheet->place_count];
    place[0] = x;
    place[1] = y;
    place[2] = z;
    return sheet->place_count++;
}

static void add_triangle(struct sheet *sheet, int a, int b, int c)
{
    int *triangle = sheet->triangles[sheet->triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

static struct sheet plain_sheet(void)
{
    struct sheet sheet = {.has_uvs = true};
    for (int j = 0; j < ROW; j++)
        for (int i = 0; i < ROW; i++)
            add_place(&sheet, 0.1 * i, 0.1 * j, 0);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            int corner = ROW * j + i;
            add_triangle(&sheet, corner, corner + 1, corner + ROW + 1);
            add_triangle(&sheet, corner, corner + ROW + 1, corner + ROW);
        }
    return sheet;
}

static void write_text(const char *name, const char *text)
{
    FILE *stream = fopen(name, "w");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
}

/* Stitches count points from 0. */
static void write_sheet(const char *path, const struct sheet *sheet, const char *more)
{
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    if (sheet->material)
        fprintf(stream, "mtllib audit.mtl\n");
    for (int i = 0; i < sheet->place_count; i++) {
        const double *place = sheet->places[i];
        fprintf(stream, "v %.9g %.9g %.9g\n", place[0], place[1], place[2]);
        if (sheet->has_uvs)
            fprintf(stream, "vt %.9g %.9g\n", place[0], place[1]);
    }
    if (sheet->material)
        fprintf(stream, "usemtl %s\n", sheet->material);
    for (int t = 0; t < sheet->triangle_count; t++) {
        const int *corners = sheet->triangles[t];
        for (int k = 0; k < 3; k++)
            fprintf(stream, sheet->has_uvs ? "%s%d/%d" : "%s%d", k ? " " : "f ", corners[k] + 1,
                    corners[k] + 1);
        fprintf(stream, "\n");
    }
    fputs(more, stream);
    assert_int_equal(fclose(stream), 0);
}

/* Reads a file and audits it, in metres: who gives no unit gets units-guessed. */
static tl_audit audit_file(const char *path, enum tl_units units)
{
    tl_audit audit = {0};
    tl_error error = {0};
    tl_garment garment = {0};
    assert_ok(tl_model_load_in(path, units, &garment.model, &error), error);
    tl_stitches_sew(&garment);
    tl_audit_garment(&audit, &garment);
    tl_garment_release(&garment);
    return audit;
}

static tl_audit audit_sheet(const struct sheet *sheet)
{
    write_sheet("audit.obj", sheet, "");
    return audit_file("audit.obj", TL_UNITS_M);
}

/* Exactly `count` findings, all of one code; returns the first. */
static const struct tl_audit_finding *expect(const tl_audit *audit, enum tl_audit_code code, size_t count)
{
    for (size_t i = 0; i < audit->finding_count; i++)
        printf("%s: triangle %" PRId64 ": %s\n", tl_audit_kinds[audit->findings[i].code].code,
               audit->findings[i].place.triangle, audit->findings[i].message);
    for (int other = 0; other < TL_AUDIT_CODES; other++)
        assert_int_equal(audit->counts[other], other == (int)code ? count : 0);
    return audit->findings;
}

static void expect_clean(tl_audit *audit)
{
    expect(audit, TL_AUDIT_CODES, 0);
    assert_int_equal(tl_audit_count(audit, true) + tl_audit_count(audit, false), 0);
    tl_audit_release(audit);
}

static void a_clean_file_has_no_findings(void **state)
{
    (void)state;
    struct sheet sheet = plain_sheet();
    tl_audit audit = audit_sheet(&sheet);
    expect_clean(&audit);
    /* Rolled into a tube whose ends have the same positions, though not the same points. */
    for (int i = 0; i < sheet.place_count; i++) {
        double turn = 2 * M_PI * (i % ROW % SIDE) / SIDE;
        sheet.places[i][0] = 0.2 * cos(turn);
        sheet.places[i][2] = -0.2 * sin(turn);
    }
    sheet.has_uvs = false;
    audit = audit_sheet(&sheet);
    expect_clean(&audit);
}

static void triangles(void **state)
{
    (void)state;
    /* Turned over: its neighbours disagree on all three sides, and its UVs turn with it. */
    struct sheet sheet = plain_sheet();
    int *corners = sheet.triangles[square(2, 1)], first = corners[0];
    corners[0] = corners[1];
    corners[1] = first;
    tl_audit audit = audit_sheet(&sheet);
    const struct tl_audit_finding *finding = expect(&audit, TL_AUDIT_TRIANGLE_FLIPPED, 1);
    assert_int_equal(finding->place.triangle, square(2, 1));
    assert_int_equal(finding->place.points[1], ROW + 2);
    assert_near(finding->place.position_mm[0], 800.0 / 3, 1e-3); /* corners (200 100) (300 100) (300 200) */
    assert_near(finding->place.position_mm[1], 400.0 / 3, 1e-3);
    tl_audit_release(&audit);

    /* Two neighbours turned over are one patch, two apart are two. */
    for (int separate = 0; separate < 2; separate++) {
        sheet = plain_sheet();
        for (int n = 0; n < 2; n++) {
            corners = sheet.triangles[n == 0 ? square(0, 0) : separate ? square(3, 3) : square(0, 0) + 1];
            first = corners[0];
            corners[0] = corners[1];
            corners[1] = first;
        }
        audit = audit_sheet(&sheet);
        expect(&audit, TL_AUDIT_TRIANGLE_FLIPPED, separate ? 2 : 1);
        tl_audit_release(&audit);
    }

    /* On a line; with a point twice. */
    sheet = plain_sheet();
    add_triangle(&sheet, 0, 1, 2);
    audit = audit_sheet(&sheet);
    finding = expect(&audit, TL_AUDIT_TRIANGLE_DEGENERATE, 1);
    assert_int_equal(finding->place.triangle, 2 * SIDE * SIDE);
    assert_non_null(strstr(finding->message, "on a line"));
    tl_audit_release(&audit);
    /* Lower than a ten-thousandth of its longest side, or higher. */
    for (int higher = 0; higher < 2; higher++) {
        sheet = plain_sheet();
        int tip = add_place(&sheet, 0.1, higher ? -4e-5 : -1e-5, 0);
        add_triangle(&sheet, 0, tip, 2);
        sheet.has_uvs = false;
        audit = audit_sheet(&sheet);
        audit.counts[TL_AUDIT_SEAM_OPEN] = 0; /* its long side lies along two of the sheet's */
        expect(&audit, TL_AUDIT_TRIANGLE_DEGENERATE, !higher);
        tl_audit_release(&audit);
    }
    sheet = plain_sheet();
    add_triangle(&sheet, 7, 7, 8);
    audit = audit_sheet(&sheet);
    assert_non_null(strstr(expect(&audit, TL_AUDIT_TRIANGLE_DEGENERATE, 1)->message, "at one place"));
    tl_audit_release(&audit);

    /* The same corners again. */
    sheet = plain_sheet();
    corners = sheet.triangles[5];
    add_triangle(&sheet, corners[1], corners[2], corners[0]);
    audit = audit_sheet(&sheet);
    assert_int_equal(expect(&audit, TL_AUDIT_TRIANGLE_REPEATED, 1)->place.triangle, 2 * SIDE * SIDE);
    tl_audit_release(&audit);

    /* A flap on an edge within the sheet. */
    sheet = plain_sheet();
    add_triangle(&sheet, ROW + 1, ROW + 2, add_place(&sheet, 0.15, 0.1, 0.05));
    audit = audit_sheet(&sheet);
    expect(&audit, TL_AUDIT_EDGE_CROWDED, 1);
    tl_audit_release(&audit);
    add_triangle(&sheet, 3 * ROW + 2, 3 * ROW + 3, add_place(&sheet, 0.25, 0.3, 0.05)); /* another, apart */
    audit = audit_sheet(&sheet);
    expect(&audit, TL_AUDIT_EDGE_CROWDED, 2);
    tl_audit_release(&audit);
}

/* A strip of squares whose ends are joined after half a turn. */
static void a_one_sided_strip(void **state)
{
    (void)state;
    enum { SQUARES = 12 };
    struct sheet sheet = {0};
    for (int i = 0; i < SQUARES; i++)
        for (int side = -1; side < 2; side += 2) {
            double turn = 2 * M_PI * i / SQUARES, radius = 0.3 + 0.05 * side * cos(turn / 2);
            add_place(&sheet, radius * cos(turn), radius * sin(turn), 0.05 * side * sin(turn / 2));
        }
    for (int i = 0; i < SQUARES; i++) {
        bool last = i == SQUARES - 1;
        int a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
        add_triangle(&sheet, a, c, d);
        add_triangle(&sheet, a, d, b);
    }
    tl_audit audit = audit_sheet(&sheet);
    expect(&audit, TL_AUDIT_SURFACE_ONE_SIDED, 1);
    tl_audit_release(&audit);
}

static void crossings(void **state)
{
    (void)state;
    /* A triangle of its own through the lower triangle of a square. */
    struct sheet sheet = plain_sheet();
    int a = add_place(&sheet, 0.16, 0.12, -0.02), b = add_place(&sheet, 0.18, 0.12, -0.02),
        c = add_place(&sheet, 0.17, 0.12, 0.02);
    add_triangle(&sheet, a, b, c);
    sheet.has_uvs = false;
    tl_audit audit = audit_sheet(&sheet);
    const struct tl_audit_finding *finding = expect(&audit, TL_AUDIT_CROSSING, 1);
    assert_int_equal(audit.crossing_count, 1);
    bool is_either =
        finding->place.triangle == square(1, 1) || finding->place.triangle == (int64_t)2 * SIDE * SIDE;
    assert_true(is_either);
    tl_audit_release(&audit);
}

/* Cuts the sheet along the row of points above the first squares, and moves the upper part by `gap` along y,
 * and by `lift` along z. */
static struct sheet cut_sheet(double gap, double lift)
{
    struct sheet sheet = plain_sheet();
    int twins[ROW];
    for (int i = 0; i < ROW; i++)
        twins[i] = add_place(&sheet, 0.1 * i, 0.1 + gap, lift);
    for (int i = 2 * ROW; i < ROW * ROW; i++) {
        sheet.places[i][1] += gap;
        sheet.places[i][2] += lift;
    }
    for (int t = square(0, 1); t < sheet.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (sheet.triangles[t][k] / ROW == 1)
                sheet.triangles[t][k] = twins[sheet.triangles[t][k] % ROW];
    return sheet;
}

static void open_seams(void **state)
{
    (void)state;
    /* As wide as the sheet, 0.05 mm open; one finding for both borders. */
    struct sheet sheet = cut_sheet(5e-5, 0);
    tl_audit audit = audit_sheet(&sheet);
    const struct tl_audit_finding *finding = expect(&audit, TL_AUDIT_SEAM_OPEN, 1);
    double length_mm, gap_mm;
    assert_int_equal(sscanf(finding->message, "open along %lf mm, up to %lf mm wide", &length_mm, &gap_mm),
                     2);
    assert_near(length_mm, 400, 0.1);
    assert_near(gap_mm, 0.05, 1e-3);
    assert_true(finding->place.triangle < square(0, 2)); /* on either side */
    tl_audit_release(&audit);

    /* Without a gap it is joined by its positions; wider than a millimetre it is meant. */
    sheet = cut_sheet(0, 0);
    audit = audit_sheet(&sheet);
    expect_clean(&audit);
    sheet = cut_sheet(1.2e-3, 0);
    audit = audit_sheet(&sheet);
    expect_clean(&audit);

    /* A border that is divided more finely than the other: its points lie on the other's sides, gap 0. */
    sheet = cut_sheet(0, 0);
    int middle = add_place(&sheet, 0.25, 0.1, 0);
    int *corners = sheet.triangles[square(2, 1)], far = corners[2], start = corners[0];
    corners[0] = middle;
    add_triangle(&sheet, start, middle, far);
    audit = audit_sheet(&sheet);
    assert_int_equal(sscanf(expect(&audit, TL_AUDIT_SEAM_OPEN, 1)->message, "open along %lf mm", &length_mm),
                     1);
    assert_near(length_mm, 100, 0.1);
    tl_audit_release(&audit);

    /* A lining 0.2 mm behind the sheet, wound the other way: its borders run along the sheet's, and are hems.
     */
    sheet = plain_sheet();
    for (int i = 0; i < ROW * ROW; i++)
        add_place(&sheet, sheet.places[i][0], sheet.places[i][1], -2e-4);
    for (int t = 0; t < 2 * SIDE * SIDE; t++)
        add_triangle(&sheet, sheet.triangles[t][1] + ROW * ROW, sheet.triangles[t][0] + ROW * ROW,
                     sheet.triangles[t][2] + ROW * ROW);
    sheet.has_uvs = false;
    audit = audit_sheet(&sheet);
    expect_clean(&audit);
}

/* A file whose panels are joined by stitches alone: the seam that lacks them is open. */
static void stitches(void **state)
{
    (void)state;
    struct sheet sheet = cut_sheet(5e-5, 0);
    char more[512] = "";
    for (int i = 0; i < ROW; i++) {
        size_t length = strlen(more);
        snprintf(more + length, sizeof more - length, "stitch %d %d %d 0\n", ROW + i, ROW * ROW + i,
                 ROW * ROW + (i == SIDE ? i - 1 : i + 1));
    }
    write_sheet("audit.obj", &sheet, more);
    tl_audit audit = audit_file("audit.obj", TL_UNITS_M);
    expect_clean(&audit);
    write_sheet("audit.obj", &sheet, "stitch 5 25 26 0\n");
    audit = audit_file("audit.obj", TL_UNITS_M);
    expect(&audit, TL_AUDIT_SEAM_OPEN, 1);
    tl_audit_release(&audit);
}

static void a_folded_pattern(void **state)
{
    (void)state;
    /* A point 2 mm within the side of a triangle; in the pattern it lies 2 mm beyond that side. */
    struct sheet sheet = plain_sheet();
    int inner = add_place(&sheet, 0.05, 0.002, 0);
    sheet.triangles[0][2] = inner;
    add_triangle(&sheet, 1, ROW + 1, inner);
    add_triangle(&sheet, ROW + 1, 0, inner);
    /* Turned over in space and in the pattern, it is one fault, not two. */
    struct sheet turned = sheet;
    turned.triangles[0][0] = sheet.triangles[0][1];
    turned.triangles[0][1] = sheet.triangles[0][0];
    tl_audit of_turned = audit_sheet(&turned);
    expect(&of_turned, TL_AUDIT_TRIANGLE_FLIPPED, 1);
    tl_audit_release(&of_turned);
    write_sheet("audit.obj", &sheet, "");
    tl_garment garment = {0};
    tl_error error = {0};
    assert_ok(tl_model_load_in("audit.obj", TL_UNITS_M, &garment.model, &error), error);
    tl_mesh *mesh = &garment.model.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (garment.model.points[i] == (uint32_t)inner)
            mesh->uvs[i].y = 2 - mesh->uvs[i].y; /* v runs down from 1 */
    tl_audit audit = {0};
    tl_audit_garment(&audit, &garment);
    const struct tl_audit_finding *finding = expect(&audit, TL_AUDIT_UV_FLIPPED, 1);
    assert_int_equal(finding->place.triangle, 0);
    tl_audit_release(&audit);
    tl_garment_release(&garment);
}

static void units(void **state)
{
    (void)state;
    struct sheet sheet = plain_sheet();
    write_sheet("audit.obj", &sheet, "");
    tl_audit audit = audit_file("audit.obj", TL_UNITS_AUTO);
    expect(&audit, TL_AUDIT_UNITS_GUESSED, 1);
    assert_int_equal(tl_audit_count(&audit, true), 0);
    tl_audit_release(&audit);
    for (int i = 0; i < sheet.place_count; i++)
        for (int k = 0; k < 3; k++)
            sheet.places[i][k] *= 1e-3;
    sheet.has_uvs = false;
    write_sheet("audit.obj", &sheet, "");
    audit = audit_file("audit.obj", TL_UNITS_AUTO);
    expect(&audit, TL_AUDIT_UNITS_UNFIT, 1);
    assert_int_equal(tl_audit_count(&audit, true), 1);
    tl_audit_release(&audit);
    /* Upright along Z, on the ground, about y = 0: a body's shape. */
    sheet = plain_sheet();
    for (int i = 0; i < sheet.place_count; i++) {
        sheet.places[i][2] = sheet.places[i][1] * 4;
        sheet.places[i][1] = i % 2 ? 0.01 : -0.01;
    }
    sheet.has_uvs = false;
    audit = audit_sheet(&sheet);
    expect(&audit, TL_AUDIT_UP_GUESSED, 1);
    tl_audit_release(&audit);
}

static void files(void **state)
{
    (void)state;
    struct sheet sheet = plain_sheet();
    sheet.material = "cotton";
    remove("audit.mtl");
    tl_audit audit = audit_sheet(&sheet);
    const struct tl_audit_finding *finding = expect(&audit, TL_AUDIT_FILE_MISSING, 1);
    assert_non_null(strstr(finding->place.file, "audit.mtl"));
    tl_audit_release(&audit);

    write_text("audit.mtl", "newmtl cotton\nmap_Kd audit_absent.png\n");
    audit = audit_sheet(&sheet);
    finding = expect(&audit, TL_AUDIT_FILE_MISSING, 1);
    assert_non_null(strstr(finding->place.file, "audit_absent.png"));
    tl_audit_release(&audit);

    write_text("audit_text.png", "no picture");
    write_text("audit.mtl", "newmtl cotton\nmap_Kd audit_text.png\n");
    audit = audit_sheet(&sheet);
    finding = expect(&audit, TL_AUDIT_FILE_UNREADABLE, 1);
    assert_non_null(strstr(finding->place.file, "audit_text.png"));
    tl_audit_release(&audit);
}

/* Of a glTF file: the triangle (0 0 0) (1 0 0) (0 1 0), one material with a picture; no UVs. */
static void write_gltf(const char *uri)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
        "\"images\":[{\"uri\":\"%s\"}],\"textures\":[{\"source\":0}],"
        "\"materials\":[{\"name\":\"print\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}",
        uri);
    write_text("audit.gltf", text);
}

static void textures(void **state)
{
    (void)state;
    /* A grey picture of one texel. */
    static const unsigned char png[] = {
        137, 80, 78,  71, 13,  10,  26,  10,  0,   0,  0, 13, 73, 72, 68, 82, 0,  0,   0,   1,   0,  0,   0,
        1,   8,  0,   0,  0,   0,   58,  126, 155, 85, 0, 0,  0,  10, 73, 68, 65, 84,  120, 156, 99, 104, 0,
        0,   0,  130, 0,  129, 119, 205, 114, 182, 0,  0, 0,  0,  73, 69, 78, 68, 174, 66,  96,  130};
    FILE *stream = fopen("audit_dot.png", "w");
    assert_non_null(stream);
    assert_int_equal(fwrite(png, 1, sizeof png, stream), sizeof png);
    assert_int_equal(fclose(stream), 0);
    write_gltf("audit_dot.png");
    tl_audit audit = audit_file("audit.gltf", TL_UNITS_AUTO);
    const struct tl_audit_finding *finding = expect(&audit, TL_AUDIT_TEXTURE_UNSCALED, 1);
    assert_string_equal(finding->place.name, "print");
    tl_audit_release(&audit);

    write_gltf("audit_absent.png");
    audit = audit_file("audit.gltf", TL_UNITS_AUTO);
    finding = expect(&audit, TL_AUDIT_FILE_MISSING, 1);
    assert_string_equal(finding->place.file, "audit_absent.png");
    tl_audit_release(&audit);
}

static void a_fabric(void **state)
{
    (void)state;
    tl_fabric_file fabric = {.width_mm = 20, .length_mm = 10};
    fabric.pictures[TL_PICTURE_COLOUR].file = (char *)"colour.png";
    tl_audit audit = {0};
    tl_audit_fabric(&audit, &fabric);
    expect_clean(&audit);
    fabric.width_mm = 0;
    tl_audit_fabric(&audit, &fabric);
    expect(&audit, TL_AUDIT_TEXTURE_UNSCALED, 1);
    tl_audit_release(&audit);
}

/* Findings beyond those that are listed are counted. */
static void a_long_list(void **state)
{
    (void)state;
    tl_audit audit = {0};
    for (int i = 0; i < TL_AUDIT_LISTED + 7; i++)
        tl_audit_add_file(&audit, TL_AUDIT_FILE_MISSING, "a.png", "absent");
    cJSON *object = cJSON_CreateObject();
    tl_audit_add_json(&audit, object);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(object, "findings")), TL_AUDIT_LISTED);
    assert_int_equal(cJSON_GetObjectItem(object, "errors")->valueint, TL_AUDIT_LISTED + 7);
    cJSON_Delete(object);
    tl_audit_release(&audit);
}

/* Each code has its row in docs/findings.md. */
static void codes_are_documented(void **state)
{
    (void)state;
    static char text[1 << 16];
    FILE *stream = fopen(TOILE_SOURCE_DIR "/docs/findings.md", "r");
    assert_non_null(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    fclose(stream);
    for (int code = 0; code < TL_AUDIT_CODES; code++) {
        const struct tl_audit_kind *kind = &tl_audit_kinds[code];
        char *row = tl_format("\n| `%s` | %s | %s | %s |\n", kind->code, kind->is_error ? "error" : "warning",
                              kind->meaning, kind->remedy);
        if (!strstr(text, row))
            fail_msg("docs/findings.md lacks the row:%s", row);
        free(row);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clean_file_has_no_findings),
        cmocka_unit_test(triangles),
        cmocka_unit_test(a_one_sided_strip),
        cmocka_unit_test(crossings),
        cmocka_unit_test(open_seams),
        cmocka_unit_test(stitches),
        cmocka_unit_test(a_folded_pattern),
        cmocka_unit_test(units),
        cmocka_unit_test(files),
        cmocka_unit_test(textures),
        cmocka_unit_test(a_fabric),
        cmocka_unit_test(a_long_list),
        cmocka_unit_test(codes_are_documented),
    };
    assert_int_equal(chdir(TOILE_SCRATCH_DIR), 0);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
