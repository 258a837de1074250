/* OBJ and MTL as models. */
#include "assets/garment.h"
#include "assets/image/image_file.h"
#include "assets/model.h"
#include "assets/model_export.h"

#include "tests/testing.h"

#include <string.h>
#include <sys/stat.h>

#define SCRATCH TOILE_SCRATCH_DIR "/wavefront"

static const char *write_text(const char *name, const char *text)
{
    static char path[1024];
    mkdir(SCRATCH, 0777);
    snprintf(path, sizeof path, SCRATCH "/%s", name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    return path;
}

static tl_model load_in(const char *path, enum tl_units units)
{
    tl_model model;
    tl_error error = {0};
    assert_ok(tl_model_load_in(path, units, &model, &error), error);
    return model;
}

static tl_model load_text(const char *text)
{
    return load_in(write_text("a.obj", text), TL_UNITS_M);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void corners_share_vertices(void **state)
{
    (void)state;
    tl_model model = load_text(SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.25\n"
                                      "f 1/1 2/2 3/3\nf 1/5 3/3 4/4\n");
    /* Four points; the first has two texture coordinates. */
    assert_int_equal(model.mesh.vertex_count, 5);
    assert_int_equal(tl_model_point_count(&model), 4);
    const uint32_t points[] = {0, 1, 2, 0, 3}, indices[] = {0, 1, 2, 3, 2, 4};
    assert_memory_equal(model.points, points, sizeof points);
    assert_memory_equal(model.mesh.indices, indices, sizeof indices);
    assert_memory_equal(&model.mesh.positions[0], &model.mesh.positions[3], sizeof(vec3s)); /* welds */
    assert_near(model.mesh.uvs[3].x, 0.5, 0);
    assert_near(model.mesh.uvs[3].y, 0.75, 0); /* v runs down here */
    for (size_t i = 0; i < 5; i++)
        assert_near(model.mesh.normals[i].z, 1, 1e-6); /* computed: there are none */
    tl_model_release(&model);
}

static void every_form_of_index_is_read(void **state)
{
    (void)state;
    tl_model model =
        load_text("f 1 2 3\n" SQUARE "vt 0 0\nvn 0 0 2\nvn nan nan nan\n"
                  "f 1/1 3/1 4/1\nf 1//1 2//1 3//1\nf -4/-1/-2 -2/-1/-2 -1/-1/-2\nf 1//2 2//2 3//2 # c\n");
    assert_int_equal(model.mesh.index_count, 15);
    for (size_t i = 0; i < model.mesh.vertex_count; i++)
        assert_near(model.mesh.normals[i].z, 1, 1e-6); /* made unit; or computed, as for nan */
    tl_model_release(&model);
}

static void line_endings_and_continuations(void **state)
{
    (void)state;
    tl_model plain = load_text(SQUARE "f 1 2 3 4\n");
    tl_model odd = load_text(
        "# c\r\n\r\nv 0 0 0\rv\t1   0 0 \r\nv 1 1 0 0.5 0.5 0.5\n  v 0 1 \\\n  0\n\ns off\nf 1 2 \\\r\n3 4");
    assert_int_equal(odd.mesh.vertex_count, plain.mesh.vertex_count);
    assert_memory_equal(odd.mesh.positions, plain.mesh.positions, 4 * sizeof(vec3s));
    assert_memory_equal(odd.mesh.indices, plain.mesh.indices, 6 * sizeof(uint32_t));
    assert_int_equal(odd.ignored_count, 1); /* vertex colours */
    tl_model_release(&plain);
    tl_model_release(&odd);
}

static void groups_and_materials_make_parts(void **state)
{
    (void)state;
    write_text("a.mtl", "newmtl red cloth\nKd 0.8 0.1 0.05\nKs 0.5 0.5 0.5\nNs 40\nillum 2\nNi 1.45\n"
                        "newmtl dull\nKd 2 0.5 -1\nKs 1 1 1\nNs 3\nillum 1\nd 0.5\n");
    tl_model model = load_text("mtllib a.mtl\n" SQUARE "f 1 2 3\nusemtl red cloth\ng left\nf 1 2 3\nf 1 3 4\n"
                               "g right\nf 1 2 4\nusemtl dull\nf 2 3 4\nusemtl absent\nf 2 3 4\n");
    const int materials[] = {0, 1, 1, 2, 3};
    const uint32_t counts[] = {3, 6, 3, 3, 3};
    assert_int_equal(model.mesh.part_count, 5);
    uint32_t first = 0;
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(model.mesh.parts[i].material, materials[i]);
        assert_int_equal(model.mesh.parts[i].index_count, counts[i]);
        assert_int_equal(model.mesh.parts[i].first_index, first);
        first += counts[i];
    }
    const tl_material *red = &model.materials[1], *dull = &model.materials[2];
    assert_string_equal(red->name, "red cloth");
    assert_near(red->diffuse.x, 0.8, 1e-7);
    assert_near(red->specular.y, 0.04, 1e-7); /* 0.08 Ks */
    assert_near(red->glossiness, 0.9, 1e-6);  /* s = Ns / 4 = 10 */
    assert_near(dull->diffuse.x, 1, 0);
    assert_near(dull->diffuse.z, 0, 0);
    assert_near(dull->specular.x, 0, 0); /* illum 1: no highlight */
    assert_near(dull->glossiness, 0, 0);
    assert_string_equal(model.materials[3].name, "absent");
    assert_int_equal(model.ignored_count, 1); /* d */
    tl_model_release(&model);
}

static void maps_are_loaded_and_flipped(void **state)
{
    (void)state;
    uint8_t texels[16] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0};
    tl_image image = {.width = 2, .height = 2, .channels = 4, .type = TL_IMAGE_U8, .texels = texels};
    tl_error error = {0};
    mkdir(SCRATCH, 0777);
    assert_ok(tl_image_save_png(SCRATCH "/my map.png", &image, &error), error);
    write_text("a.mtl", "newmtl a\nmap_Kd -s 2 4 1 -o 0.25 0.5 -clamp on my map.png\nmap_d my map.png\n"
                        "norm C:\\\\cloth\\\\my map.png\nmap_Ks nowhere.png\nmap_Bump -bm 0.5 my map.png\n");
    tl_model model = load_text("mtllib a.mtl\nusemtl a\n" SQUARE "f 1 2 3\n");
    const tl_material *material = &model.materials[1];
    assert_non_null(material->diffuse_map.image);
    assert_true(material->diffuse_map.clamp_u && material->diffuse_map.clamp_v);
    assert_near(material->alpha_cutoff, 0.5, 0);
    assert_false(material->diffuse_map.image->linear);
    assert_true(material->normal_map.image->linear);
    assert_null(material->specular_map.image);
    /* vt (0.3, 0.7): MTL samples at (0.25 + 2 * 0.3, 0.5 + 4 * 0.7), from below. */
    vec2s uv = tl_uv_transformed(&material->diffuse_map.transform, (vec2s){{0.3f, 1 - 0.7f}});
    assert_near(uv.x, 0.85, 1e-6);
    assert_near(uv.y, 1 - 3.3, 1e-6);
    assert_int_equal(model.ignored_count, 2); /* nowhere.png, map_Bump */
    tl_model_release(&model);
}

static void units_scale_positions(void **state)
{
    (void)state;
    const char *path = write_text("mm.obj", "v 0 0 0\nv 812 0 0\nv 0 400 0\nf 1 2 3\n");
    tl_model guessed, given = load_in(path, TL_UNITS_CM);
    tl_error error = {0};
    assert_ok(tl_model_load(path, &guessed, &error), error);
    assert_int_equal(guessed.units.units, TL_UNITS_MM);
    assert_near(guessed.mesh.positions[1].x, 0.812, 1e-7);
    assert_near(given.mesh.positions[1].x, 8.12, 1e-6);
    vec3s points[3];
    tl_model_points(&given, given.mesh.positions, points);
    assert_near(points[1].x, 812, 1e-4);
    tl_model_release(&guessed);
    tl_model_release(&given);
}

/* Too many groups to draw one by one are gathered by material, with every triangle kept. */
static void many_groups_are_merged_by_material(void **state)
{
    (void)state;
    const int groups = 3000;
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    fputs(SQUARE, stream);
    for (int i = 0; i < groups; i++)
        fprintf(stream, "g %d\nusemtl %s\nf 1 2 3\n", i, i % 3 ? "a" : "b");
    fclose(stream);
    tl_model model = load_text(text);
    free(text);
    assert_int_equal(model.mesh.part_count, 3); /* none, a, b */
    assert_int_equal(model.mesh.index_count, 3 * groups);
    assert_int_equal(model.mesh.parts[1].index_count + model.mesh.parts[2].index_count, 3 * groups);
    assert_int_equal(model.mesh.parts[2].index_count, groups * 2);
    tl_model_release(&model);
}

/* Points, faces and UVs that are written are read back; v to the bit. */
static void written_objects_are_read_back(void **state)
{
    (void)state;
    tl_garment skirt;
    tl_error error = {0};
    assert_ok(tl_garment_cut("skirt", 0.08f, &skirt, &error), error);
    const tl_mesh *mesh = &skirt.model.mesh;
    tl_surface surface = tl_surface_of_mesh("garment", mesh, skirt.model.materials);
    mkdir(SCRATCH, 0777);
    assert_ok(tl_model_export_obj(SCRATCH "/skirt.obj", &skirt.model, &surface, &error), error);
    tl_model back = load_in(SCRATCH "/skirt.obj", TL_UNITS_AUTO);
    assert_int_equal(back.units.units, TL_UNITS_M);
    assert_int_equal(tl_model_point_count(&back), mesh->vertex_count);
    assert_int_equal(back.mesh.index_count, mesh->index_count);
    assert_int_equal(back.mesh.part_count, mesh->part_count);
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t there = back.mesh.indices[i], here = mesh->indices[i];
        assert_int_equal(back.points[there], here);
        assert_memory_equal(&back.mesh.positions[there], &mesh->positions[here], sizeof(vec3s));
        assert_near(back.mesh.uvs[there].y, mesh->uvs[here].y, 1e-6);
    }
    tl_model_release(&back);
    tl_garment_release(&skirt);
}

/* Counts as `grep -c` has them; boxes that are garments. The poses of one shirt have one unit. */
static void real_garments(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        size_t points, triangles;
        enum tl_units units;
        bool z_up;
    } garments[] = {
        {"garments/cipc_dress_knife_stage.obj", 15656, 29456, TL_UNITS_M, true},
        {"garments/diffcloth_dress-handsup-drape.obj", 3634, 7026, TL_UNITS_IN, false},
        {"garments/diffcloth_dress-v5k-f10k.obj", 5563, 10180, TL_UNITS_IN, false},
        {"garments/diffcloth_skirt3448.obj", 1809, 3448, TL_UNITS_M, false},
        {"garments/diffcloth_tshirt1000-tri.obj", 1426, 2745, TL_UNITS_DM, false},
        {"sequences/tshirt_iter0/000.obj", 1426, 2745, TL_UNITS_DM, false},
        {"sequences/tshirt_iter0/120.obj", 1426, 2745, TL_UNITS_DM, false},
        {"sequences/tshirt_iter0/250.obj", 1426, 2745, TL_UNITS_DM, false},
    };
    for (size_t i = 0; i < sizeof garments / sizeof garments[0]; i++) {
        tl_model model = load_in(test_data(garments[i].file), TL_UNITS_AUTO);
        assert_int_equal(tl_model_point_count(&model), garments[i].points);
        assert_int_equal(model.mesh.index_count, 3 * garments[i].triangles);
        assert_int_equal(model.units.units, garments[i].units);
        assert_int_equal(model.units.z_up, garments[i].z_up);
        for (size_t v = 0; v < model.mesh.vertex_count; v++)
            assert_near(glms_vec3_norm(model.mesh.normals[v]), 1, 1e-5);
        tl_model_release(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_share_vertices),
        cmocka_unit_test(every_form_of_index_is_read),
        cmocka_unit_test(line_endings_and_continuations),
        cmocka_unit_test(groups_and_materials_make_parts),
        cmocka_unit_test(maps_are_loaded_and_flipped),
        cmocka_unit_test(units_scale_positions),
        cmocka_unit_test(many_groups_are_merged_by_material),
        cmocka_unit_test(written_objects_are_read_back),
        cmocka_unit_test(real_garments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
