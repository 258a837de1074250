#include "assets/model.h"
#include "config/base/memory.h"

#include "tests/assets/hostile.h"
#include "tests/testing.h"

#include <math.h>
#include <string.h>

/* A box of 0.6 x 1.5 x 0.3 m as quads, outside out; its last face is the top. */
static const float box[8][3] = {{0, 0, 0},    {0.6f, 0, 0},    {0.6f, 1.5f, 0},    {0, 1.5f, 0},
                                {0, 0, 0.3f}, {0.6f, 0, 0.3f}, {0.6f, 1.5f, 0.3f}, {0, 1.5f, 0.3f}};
static const uint32_t quads[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                     {0, 4, 7, 3}, {1, 2, 6, 5}, {3, 7, 6, 2}};

/* ---- Files of the box, made here ---- */

struct bytes {
    uint8_t data[8192];
    size_t size;
};

__attribute__((format(printf, 2, 3))) static void put_text(struct bytes *out, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf((char *)out->data + out->size, sizeof out->data - out->size, format, arguments);
    va_end(arguments);
    out->size += (size_t)written;
    assert_true(out->size < sizeof out->data);
}

static void put_number(struct bytes *out, const void *value, size_t size, bool big)
{
    const uint8_t *from = value; /* the machine is little-endian, as all that toile runs on */
    assert_true(out->size + size <= sizeof out->data);
    for (size_t i = 0; i < size; i++)
        out->data[out->size++] = from[big ? size - 1 - i : i];
}

static void put_float(struct bytes *out, float value, bool big)
{
    put_number(out, &value, sizeof value, big);
}

enum form { TEXT, LITTLE, BIG };

/* Vertices with a property before and one after their coordinates, faces as lists of bytes and ints after an
 * element that is not known. */
static struct bytes ply_of(enum form form, size_t faces)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    struct bytes out = {0};
    bool big = form == BIG;
    put_text(&out,
             "ply\nformat %s 1.0\ncomment a box\nelement vertex 8\nproperty uchar quality\nproperty float x\n"
             "property double y\nproperty float z\nproperty short extra\nelement other 1\nproperty list "
             "uchar ushort "
             "numbers\nelement face %zu\nproperty list uchar int vertex_indices\nend_header\n",
             names[form], faces);
    for (int i = 0; i < 8; i++) {
        double y = (double)box[i][1];
        int16_t extra = -7;
        if (form == TEXT)
            put_text(&out, "200 %.9g %.17g %.9g -7\n", (double)box[i][0], y, (double)box[i][2]);
        else {
            put_number(&out, (uint8_t[]){200}, 1, big);
            put_float(&out, box[i][0], big);
            put_number(&out, &y, sizeof y, big);
            put_float(&out, box[i][2], big);
            put_number(&out, &extra, sizeof extra, big);
        }
    }
    if (form == TEXT)
        put_text(&out, "2 5 65535\n");
    else {
        put_number(&out, (uint8_t[]){2}, 1, big);
        put_number(&out, (uint16_t[]){5}, 2, big);
        put_number(&out, (uint16_t[]){65535}, 2, big);
    }
    for (size_t f = 0; f < faces; f++) {
        if (form == TEXT)
            put_text(&out, "4 %u %u %u %u\n", quads[f][0], quads[f][1], quads[f][2], quads[f][3]);
        else {
            put_number(&out, (uint8_t[]){4}, 1, big);
            for (int c = 0; c < 4; c++)
                put_number(&out, &quads[f][c], 4, big);
        }
    }
    return out;
}

static struct bytes off_of(size_t faces)
{
    struct bytes out = {0};
    put_text(&out, "OFF # a box\n8 %zu 0\n\n", faces);
    for (int i = 0; i < 8; i++)
        put_text(&out, "%.9g %.9g %.9g\n", (double)box[i][0], (double)box[i][1], (double)box[i][2]);
    for (size_t f = 0; f < faces; f++)
        put_text(&out, "4 %u %u %u %u\n", quads[f][0], quads[f][1], quads[f][2], quads[f][3]);
    return out;
}

static struct bytes stl_of(enum form form, size_t faces)
{
    struct bytes out = {0};
    uint32_t count = (uint32_t)(2 * faces);
    put_text(&out, form == TEXT ? "solid box\n" : "solid in its eighty bytes");
    if (form != TEXT) {
        out.size = 80;
        put_number(&out, &count, 4, false);
    }
    for (size_t t = 0; t < 2 * faces; t++) {
        const uint32_t *quad = quads[t / 2], corners[3] = {quad[0], quad[1 + t % 2], quad[2 + t % 2]};
        if (form == TEXT)
            put_text(&out, " facet normal 0 0 0\n  outer loop\n");
        else
            for (int c = 0; c < 3; c++)
                put_float(&out, 0, false);
        for (int c = 0; c < 3; c++) {
            const float *at = box[corners[c]];
            if (form == TEXT)
                put_text(&out, "   vertex %.9g %.9g %.9g\n", (double)at[0], (double)at[1], (double)at[2]);
            else
                for (int k = 0; k < 3; k++)
                    put_float(&out, at[k], false);
        }
        if (form == TEXT)
            put_text(&out, "  endloop\n endfacet\n");
        else
            put_number(&out, (uint16_t[]){0}, 2, false);
    }
    if (form == TEXT)
        put_text(&out, "endsolid box\n");
    return out;
}

static tl_model load(const char *name, const struct bytes *file)
{
    const char *path = scratch(name);
    scratch_write(path, file->data, file->size);
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(path, &model, &error), error);
    return model;
}

static bool has_defect(const tl_model *model, const char *text)
{
    for (size_t i = 0; i < model->defect_count; i++)
        if (strcmp(model->defects[i], text) == 0)
            return true;
    return false;
}

/* ---- Reading ---- */

/* The box's volume is that of its triangles only when each of them is there, once, outside out. */
static double volume_of(const tl_mesh *mesh)
{
    double sum = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *v = &mesh->indices[i];
        vec3s cross = glms_vec3_cross(mesh->positions[v[1]], mesh->positions[v[2]]);
        sum += (double)glms_vec3_dot(mesh->positions[v[0]], cross) / 6;
    }
    return sum;
}

static void check_box(const char *name, struct bytes file)
{
    tl_model model = load(name, &file);
    const tl_mesh *mesh = &model.mesh;
    bool seen[8] = {0};
    assert_int_equal(mesh->vertex_count, 8);
    assert_int_equal(mesh->index_count, 36);
    for (size_t i = 0; i < 8; i++)
        for (int k = 0; k < 8; k++)
            seen[k] |= memcmp(&mesh->positions[i], box[k], sizeof box[k]) == 0;
    for (int k = 0; k < 8; k++)
        assert_true(seen[k]);
    assert_float_equal(volume_of(mesh), 0.27, 1e-6); /* 0.6 x 1.5 x 0.3 m */
    for (size_t i = 0; i < 8; i++) {                 /* a corner's normal points away from the middle */
        vec3s away = glms_vec3_sub(mesh->positions[i], (vec3s){{0.3f, 0.75f, 0.15f}});
        assert_true(glms_vec3_dot(away, mesh->normals[i]) > 0);
    }
    assert_int_equal(model.defect_count, 0);
    assert_int_equal(model.units.units, TL_UNITS_M);
    assert_int_equal(model.material_count, 1);
    tl_model_release(&model);
}

static void all_formats_hold_the_same_box(void **state)
{
    (void)state;
    check_box("text.ply", ply_of(TEXT, 6));
    check_box("little.ply", ply_of(LITTLE, 6));
    check_box("big.PLY", ply_of(BIG, 6));
    check_box("text.stl", stl_of(TEXT, 6));
    check_box("binary.stl", stl_of(LITTLE, 6));
    check_box("box.off", off_of(6));
}

static void attributes_of_vertices(void **state)
{
    (void)state;
    struct bytes ply = {0}, off = {0};
    put_text(
        &ply,
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nproperty float s\nproperty float t\nelement face 1\n"
        "property list uchar uint vertex_index\nend_header\n"
        "0 0 0  0 0 2  255 0 51  0.25 1\n1 0 0  0 3 4  0 255 0  1 1\n0 1 0  0 0 1  0 0 255  0 0.5\n3 0 1 "
        "2\n");
    put_text(&off, "STCNOFF 3 1 0\n0 0 0  0 0 2  255 0 51 255  0.25 1\n1 0 0  0 3 4  0 255 0 255  1 1\n"
                   "0 1 0  0 0 1  0 0 255 255  0 0.5\n3 0 1 2  0.5 0.5 0.5\n");
    const struct bytes *files[] = {&ply, &off};
    for (int f = 0; f < 2; f++) {
        tl_model model = load(f == 0 ? "attributes.ply" : "attributes.off", files[f]);
        assert_float_equal(model.mesh.normals[0].z, 1, 0);
        assert_float_equal(model.mesh.normals[1].y, 0.6, 1e-6);
        assert_float_equal(model.colours[0].x, 1, 1e-6);
        assert_float_equal(model.colours[0].z, 0.2, 1e-6);
        assert_float_equal(model.mesh.uvs[0].x, 0.25, 0);
        assert_float_equal(model.mesh.uvs[0].y, 0, 0); /* from the top */
        assert_float_equal(model.mesh.uvs[2].y, 0.5, 0);
        assert_string_equal(model.ignored[0], "vertex colours");
        assert_int_equal(model.ignored_count, 1 + (f == 1)); /* the face's colour */
        tl_model_release(&model);
    }
}

/* ---- Defects ---- */

static void a_hole_is_reported(void **state)
{
    (void)state;
    struct bytes file = stl_of(LITTLE, 5); /* no top: 2 x (0.6 + 0.3) m around */
    tl_model model = load("open.stl", &file);
    assert_int_equal(model.defect_count, 1);
    assert_true(has_defect(&model, "1 open border, the longest 1.8 m around"));
    tl_model_release(&model);
    file =
        off_of(4); /* without top and right side, which touch: one border of 2 x 0.6 + 2 x 1.5 + 2 x 0.3 m */
    model = load("open.off", &file);
    assert_true(has_defect(&model, "1 open border, the longest 4.8 m around"));
    tl_model_release(&model);
}

/* A grid in the corner of which there is every kind of noise. */
static void noise_is_reported(void **state)
{
    (void)state;
    enum { SIDE = 16, GRID = (SIDE + 1) * (SIDE + 1) };
    struct bytes file = {0};
    put_text(&file, "OFF %d %d 0\n", GRID + 5, SIDE * SIDE + 5);
    for (int i = 0; i < GRID; i++)
        put_text(&file, "%d %d 0\n", i % (SIDE + 1), i / (SIDE + 1));
    put_text(&file, "40 0 0\n41 0 0\n40 1 0\n5 5 5\n99 99 99\n"); /* the last has no triangle */
    for (int i = 0; i < SIDE * SIDE; i++) {
        int a = i / SIDE * (SIDE + 1) + i % SIDE;
        put_text(&file, "4 %d %d %d %d\n", a, a + 1, a + SIDE + 2, a + SIDE + 1);
    }
    put_text(&file, "3 %d %d %d\n", GRID, GRID + 1, GRID + 2); /* a loose triangle */
    put_text(&file, "3 0 0 1\n");                              /* two equal corners */
    put_text(&file, "3 %d 20 19\n", GRID + 3);                 /* a fin: an edge of three */
    put_text(&file, "3 0 1 %d\n", GRID + 3); /* runs along the border as its neighbour does */
    put_text(&file, "2 3 4\n");              /* no face */
    tl_model model = load("noise.off", &file);
    assert_true(has_defect(&model, "1 triangles with two equal corners, left out"));
    assert_true(has_defect(&model, "1 vertices without triangles, left out"));
    assert_true(has_defect(&model, "1 edges of more than two triangles"));
    assert_true(has_defect(&model, "1 edges between triangles that face opposite ways"));
    assert_true(has_defect(&model, "1 loose pieces of 1 triangles in all"));
    assert_int_equal(model.mesh.vertex_count, GRID + 4);
    assert_int_equal(tl_model_point_count(&model), GRID + 5);
    tl_model_release(&model);
}

static void faces_that_point_inwards_are_reported(void **state)
{
    (void)state;
    struct bytes file = {0};
    put_text(&file, "OFF 8 6 0\n");
    for (int i = 0; i < 8; i++)
        put_text(&file, "%.9g %.9g %.9g\n", (double)box[i][0], (double)box[i][1], (double)box[i][2]);
    for (size_t f = 0; f < 6; f++)
        put_text(&file, "4 %u %u %u %u\n", quads[f][3], quads[f][2], quads[f][1], quads[f][0]);
    tl_model model = load("inside out.off", &file);
    assert_int_equal(model.defect_count, 1);
    assert_non_null(strstr(model.defects[0], "inwards"));
    tl_model_release(&model);
}

/* Units and the upright axis are decided as for OBJ. */
static void units_follow_size(void **state)
{
    (void)state;
    struct bytes file = {0};
    put_text(&file, "OFF 4 4 0\n0 -5 0\n30 -5 0\n0 5 0\n0 0 172\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
    tl_model model = load("centimetres.off", &file);
    assert_int_equal(model.units.units, TL_UNITS_CM);
    assert_true(model.units.z_up);
    assert_float_equal(model.mesh.positions[3].z, 1.72, 1e-6);
    tl_model_release(&model);
}

/* The same body as STL and OBJ: the OBJ file has six digits, and one place with two vertices. */
static void the_real_body(void **state)
{
    (void)state;
    tl_model stl, obj;
    tl_error error;
    assert_ok(tl_model_load(test_data("avatars/mean_all.stl"), &stl, &error), error);
    assert_ok(tl_model_load(test_data("avatars/mean_all.obj"), &obj, &error), error);
    assert_int_equal(stl.mesh.index_count, obj.mesh.index_count);
    assert_int_equal(stl.defect_count, 0);
    for (size_t i = 0; i < stl.mesh.index_count; i++) {
        vec3s a = stl.mesh.positions[stl.mesh.indices[i]], b = obj.mesh.positions[obj.mesh.indices[i]];
        assert_true(glms_vec3_distance(a, b) < 2e-6f);
        assert_true(glms_vec3_dot(stl.mesh.normals[stl.mesh.indices[i]],
                                  obj.mesh.normals[obj.mesh.indices[i]]) > 0.99f);
    }
    tl_model_release(&stl);
    tl_model_release(&obj);
}

/* ---- Broken files ---- */

static bool try_scan(struct outcome *outcome, const char *path)
{
    tl_model model;
    tl_error error = {0};
    bool loaded = tl_model_load(path, &model, &error);
    count_outcome(outcome, path, loaded, &error);
    for (size_t i = 0; loaded && i < model.mesh.index_count; i++)
        assert_true(model.mesh.indices[i] < model.mesh.vertex_count);
    for (size_t i = 0; loaded && i < model.mesh.vertex_count; i++)
        assert_true(isfinite(glms_vec3_norm(model.mesh.positions[i])) &&
                    isfinite(glms_vec3_norm(model.mesh.normals[i])));
    tl_model_release(&model);
    return loaded;
}

static void damaged_scans(void **state)
{
    (void)state;
    const struct {
        const char *name;
        struct bytes file;
        bool text;
    } files[] = {
        {"damaged text.ply", ply_of(TEXT, 6), true},      {"damaged little.ply", ply_of(LITTLE, 6), false},
        {"damaged big.ply", ply_of(BIG, 6), false},       {"damaged text.stl", stl_of(TEXT, 6), true},
        {"damaged binary.stl", stl_of(LITTLE, 6), false}, {"damaged.off", off_of(6), true}};
    for (size_t i = 0; i < TL_COUNT(files); i++) {
        mutate(files[i].name, files[i].file.data, files[i].file.size, 1000, files[i].text, try_scan);
        for (size_t size = 1; size < files[i].file.size; size += 7) { /* cut short */
            struct outcome outcome = {0};
            scratch_write(scratch(files[i].name), files[i].file.data, size);
            try_scan(&outcome, scratch(files[i].name));
        }
    }
}

#define PLY_HEAD "ply\nformat binary_little_endian 1.0\n"

static void false_claims_are_refused(void **state)
{
    (void)state;
    static const char *const lies[][3] = {
        {"a.ply", PLY_HEAD "element vertex 16000000\nproperty float x\nend_header\nabcd",
         "claims 16000000 elements"},
        {"b.ply", PLY_HEAD "element vertex 18446744073709551615\nproperty float x\nend_header\nabcd",
         "claims"},
        {"c.ply", PLY_HEAD "element vertex 99999999999999999999\nproperty float x\nend_header\nabcd",
         "without its count"},
        {"d.ply", PLY_HEAD "element vertex 4000000000\nend_header\nabcd", "claims"},
        {"e.ply",
         PLY_HEAD "element face 1\nproperty list uint uint vertex_index\nend_header\n\xff\xff\xff\xff",
         "ends before"},
        {"f.ply", PLY_HEAD "element face 1\nproperty list float uint vertex_index\nend_header\nabcd",
         "no whole number"},
        {"g.ply", PLY_HEAD "element vertex 1\nproperty quad x\nend_header\nabcd", "unknown type"},
        {"h.ply", PLY_HEAD "property float x\nend_header\nabcd", "before any element"},
        {"i.ply", "ply\nformat morse 1.0\nend_header\n", "format that is not known"},
        {"j.ply", PLY_HEAD "element vertex 1\nproperty float x\n", "ends within its header"},
        {"k.ply", "plywood\n", "is no PLY file"},
        {"l.ply", PLY_HEAD "element vertex 1\nproperty uchar x\nend_header\na", "cloud of points"},
        {"a.stl", "solid \n facet normal 0 0 0\nouter loop\nvertex 0 0 0\nendloop\n", "facet of 1 vertices"},
        {"b.stl", "solid \n facet normal 0 0 0\nouter loop\nvertex 0 0 0\n", "ends within a facet"},
        {"c.stl", "solid \n cube 1 2 3\n", "is no word of STL"},
        {"d.stl", "ply\n", "room for 0"},
        {"a.off", "OFF\n4000000000 1 0\n0 0 0\n", "ends after 1 lines"},
        {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "does not exist"},
        {"c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "lacks a corner"},
        {"d.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "is no number"},
        {"e.off", "4OFF\n3 1 0\n", "no OFF file of three dimensions"},
        {"f.off", "OFF BINARY\n", "is binary OFF"},
        {"g.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 0\n", "points or lines"},
        {"h.off", "OFF\n-3 1 0\n", "counts of vertices"},
    };
    for (size_t i = 0; i < TL_COUNT(lies); i++) {
        const char *path = scratch(lies[i][0]);
        scratch_write(path, lies[i][1], strlen(lies[i][1]));
        tl_model model;
        tl_error error = {0};
        bool loaded = tl_model_load(path, &model, &error);
        if (loaded || !strstr(error.message, lies[i][2]) || error.code != TL_INPUT)
            print_error("%s: %s\n", path, loaded ? "loaded" : error.message);
        assert_false(loaded);
        assert_non_null(strstr(error.message, lies[i][2]));
        tl_model_release(&model);
    }
    report("false claims", (struct outcome){0, TL_COUNT(lies)});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_formats_hold_the_same_box),
        cmocka_unit_test(attributes_of_vertices),
        cmocka_unit_test(a_hole_is_reported),
        cmocka_unit_test(noise_is_reported),
        cmocka_unit_test(faces_that_point_inwards_are_reported),
        cmocka_unit_test(units_follow_size),
        cmocka_unit_test(the_real_body),
        cmocka_unit_test(false_claims_are_refused),
        cmocka_unit_test(damaged_scans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
