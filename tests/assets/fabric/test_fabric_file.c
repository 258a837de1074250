/* Fabrics of other programs. U3M: against a file written here from known values and against the format's own
 * example; measurements: against paths computed from the closed forms of known stiffnesses; folders: against
 * the names of four libraries; archives: against names and sizes that lead out of them. */
#include "assets/base/material.h"
#include "assets/fabric/fabric_maps.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include "config/colour/srgb.h"
#include "tests/testing.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

#define SCRATCH TOILE_SCRATCH_DIR "/fabric_file"

static void write_text(const char *name, const char *text)
{
    tl_error error;
    struct tl_writer writer;
    assert_ok(tl_folder_make(SCRATCH "/textures", &error), error);
    char *path = tl_format(SCRATCH "/%s", name);
    assert_ok(tl_writer_begin(&writer, path, &error), error);
    fputs(text, writer.stream);
    assert_ok(tl_writer_commit(&writer, &error), error);
    free(path);
}

/* A picture of two texels, side by side. */
static void write_picture(const char *name, const uint8_t *left, const uint8_t *right, int channels)
{
    tl_error error;
    tl_image image = tl_image_create(2, 1, channels, TL_IMAGE_U8);
    memcpy(image.texels, left, (size_t)channels);
    memcpy(tl_image_bytes(&image) + channels, right, (size_t)channels);
    char *path = tl_format(SCRATCH "/%s", name);
    assert_ok(tl_image_save_png(path, &image, &error), error);
    free(path);
    tl_image_release(&image);
}

static void empty_scratch(void)
{
    assert_int_equal(system("rm -rf " SCRATCH), 0);
    tl_error error;
    assert_ok(tl_folder_make(SCRATCH "/textures", &error), error);
}

static const struct tl_fabric_field *field_of(const tl_fabric_file *file, const char *name)
{
    for (size_t i = 0; i < file->field_count; i++)
        if (strcmp(file->fields[i].name, name) == 0)
            return &file->fields[i];
    print_error("no field %s\n", name);
    fail();
    return NULL;
}

/* ---- U3M ---- */

#define IMAGE(path, width, height)                                                                           \
    "\"image\": {\"path\": \"" path "\", \"width\": " width ", \"height\": " height                          \
    ", \"dpi\": {\"x\": 300, \"y\": 300}, \"repeat\": {\"mode\": \"mirror_x\", \"rotation\": 0}}"
#define NUMBER(key, value) "\"" key "\": {\"constant\": " value ", \"texture\": null}, "
#define HEAD               "{\"schema\": \"1.1\", \"custom\": null, \"material\": {\"name\": \"Probe\", "
#define PHYSICS                                                                                              \
    "\"physics\": {\"thickness\": 0.4, \"weight\": 180, \"composition\": null, \"devices\": {\"fab\": "      \
    "\"null\"}, "                                                                                            \
    "\"material_type\": null, \"construction\": {\"type\": \"Twill\", \"name\": null}}"

static const char probe[] =
    HEAD "\"side\": null, \"metadata\": null, \"front\": {\"shader\": \"principled\", " NUMBER(
        "alpha",
        "0.75") NUMBER("anisotropy_value",
                       "0.5") NUMBER("anisotropy_rotation",
                                     "0.25") NUMBER("clearcoat_value",
                                                    "0.2") NUMBER("clearcoat_roughness",
                                                                  "0.1") NUMBER("ior",
                                                                                "1.4") NUMBER("sheen_value",
                                                                                              "0.3")
        NUMBER("clearcoat_normal", "0") NUMBER("specular_value", "0.5") NUMBER("transmission", "0.1") NUMBER(
            "unheard_of",
            "1") "\"metalness\": {\"constant\": 0.25, \"texture\": null}, "
                 "\"roughness\": {\"constant\": 0, \"texture\": {\"factor\": 0.5, \"offset\": 0.1, " IMAGE(
                     "textures/rough.png", "20",
                     "10") "}}, \"basecolor\": {\"constant\": {\"r\": 0, \"g\": 0, \"b\": 0}, \"texture\": "
                           "{\"mode\": \"multiply\", "
                           "\"factor\": {\"r\": 1, \"g\": 0.5, \"b\": 1}, " IMAGE(
                               "textures/base.png", "20",
                               "10") "}}, \"normal\": {\"constant\": {\"x\": 0, \"y\": 0, \"z\": 1}, "
                                     "\"texture\": null}, "
                                     "\"displacement\": {\"constant\": 0, \"texture\": {\"factor\": 0.8, "
                                     "\"offset\": 0, " IMAGE(
                                         "textures/lost.png", "20",
                                         "10") "}}}, \"back\": {\"basecolor\": {\"constant\": {\"r\": 0.1, "
                                               "\"g\": 0.2, \"b\": 0.3}, \"texture\": null}, "
                                               "\"roughness\": {\"constant\": 0.5, \"texture\": "
                                               "null}}, " PHYSICS "}}";

static void write_probe(void)
{
    empty_scratch();
    write_text("probe.u3m", probe);
    write_picture("textures/rough.png", (const uint8_t[]){0, 0, 0}, (const uint8_t[]){255, 255, 255}, 3);
    write_picture("textures/base.png", (const uint8_t[]){255, 255, 255}, (const uint8_t[]){128, 64, 32}, 3);
}

static void check_probe(const tl_fabric_file *file)
{
    tl_error error;
    struct tl_fabric_maps maps;
    struct tl_fabric_means means;
    assert_string_equal(file->name, "Probe");
    assert_near(file->surface.alpha, 0.75, 1e-6);
    assert_near(file->surface.specular, 0.04, 1e-6); /* half of 8 % */
    assert_near(file->surface.metalness, 0.25, 1e-6);
    assert_near(file->surface.anisotropy, 0.5, 1e-6);
    assert_near(file->surface.rotation_deg, 90, 1e-4);
    assert_near(file->surface.coat, 0.2, 1e-6);
    assert_near(file->surface.transmission, 0.1, 1e-6);
    assert_near(file->surface.sheen, 0.3, 1e-6);
    assert_near(file->width_mm, 20, 1e-6);
    assert_near(file->length_mm, 10, 1e-6);
    assert_true(file->mirrors_u && !file->mirrors_v);
    assert_near(file->physics.weight_kg_m2, 0.18, 1e-9);
    assert_near(file->physics.thickness_m, 4e-4, 1e-9);
    assert_true(isnan(file->physics.bend_warp));
    assert_near(file->back[2], 0.3, 1e-6);
    assert_int_equal(file->missing_count, 1);
    static const char *const used[] = {"material.front.basecolor", "material.front.roughness",
                                       "material.front.metalness", "material.front.alpha",
                                       "material.physics.weight",  "material.back.basecolor"};
    static const char *const unused[] = {"material.front.clearcoat_normal", "material.front.ior",
                                         "material.front.displacement",     "material.back.roughness",
                                         "material.front.unheard_of",       "material.physics.construction"};
    for (size_t i = 0; i < TL_COUNT(used); i++)
        assert_true(field_of(file, used[i])->is_used && field_of(file, unused[i])->is_used == false);
    assert_ok(tl_fabric_maps_load(file, &maps, &error), error);
    assert_true(maps.width == 2 && maps.height == 1);
    /* linear light, times the factor, without the share of a constant metalness: the options have that */
    const uint8_t right[3] = {128, 64, 32};
    const float factor[3] = {1, 0.5f, 1};
    for (int c = 0; c < 3; c++) {
        assert_near(tl_image_floats(&maps.colour)[c], factor[c], 1e-6);
        assert_near(tl_image_floats(&maps.colour)[3 + c],
                    factor[c] * tl_srgb_to_linear((float)right[c] / 255), 1e-6);
    }
    float smooth = tl_glossiness_from_roughness(0.1f), rough = tl_glossiness_from_roughness(0.6f);
    assert_near(tl_image_floats(&maps.gloss)[0], (smooth - rough) / 2, 1e-6);
    assert_ok(tl_fabric_maps_means(file, &means, &error), error);
    assert_near(means.glossiness, (smooth + rough) / 2, 1e-6);
    tl_fabric_maps_mirror(&maps, true, false);
    assert_int_equal(maps.width, 4);
    assert_near(tl_image_floats(&maps.gloss)[3], tl_image_floats(&maps.gloss)[0], 0);
    assert_near(tl_image_floats(&maps.gloss)[2], tl_image_floats(&maps.gloss)[1], 0);
    tl_fabric_maps_release(&maps);
}

static void u3m_is_read(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    write_probe();
    assert_ok(tl_fabric_file_open(SCRATCH "/probe.u3m", &file, &error), error);
    check_probe(&file);
    tl_fabric_file_release(&file);
}

/* The formulas of u3m_additional_spec_u3m.txt, written out for one texel. */
static void colours_are_blended_as_specified(void **state)
{
    (void)state;
    const double a = (double)tl_srgb_to_linear(200.0f / 255), b = 0.3;
    const struct {
        const char *mode;
        double expected;
    } modes[] = {{"add", a + b},
                 {"subtract", a - b},
                 {"multiply", a * b},
                 {"divide", 1},
                 {"max", a},
                 {"min", b},
                 {"overlay", 1 - 2 * (1 - a) * (1 - b)}};
    for (size_t i = 0; i < TL_COUNT(modes); i++) {
        tl_fabric_file file;
        tl_error error;
        struct tl_fabric_maps maps;
        empty_scratch();
        write_picture("textures/base.png", (const uint8_t[]){200, 200, 200}, (const uint8_t[]){200, 200, 200},
                      3);
        char *text =
            tl_format(HEAD "\"front\": {\"basecolor\": {\"constant\": null, \"texture\": {\"mode\": \"%s\", "
                           "\"factor\": {\"r\": 0.3, \"g\": 0.3, \"b\": 0.3}, " IMAGE("textures/base.png",
                                                                                      "1", "1") "}}}}}",
                      modes[i].mode);
        write_text("blend.u3m", text);
        free(text);
        assert_ok(tl_fabric_file_open(SCRATCH "/blend.u3m", &file, &error), error);
        assert_ok(tl_fabric_maps_load(&file, &maps, &error), error);
        assert_near(tl_image_floats(&maps.colour)[0], fmin(modes[i].expected, 1), 1e-5);
        tl_fabric_maps_release(&maps);
        tl_fabric_file_release(&file);
    }
}

static void the_formats_example_is_read(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    assert_ok(tl_fabric_file_open(test_data("u3m/Example_1.0.u3m"), &file, &error), error);
    assert_string_equal(file.name, "Example_0.9");
    assert_int_equal(file.missing_count, 5); /* it comes without its pictures */
    assert_false(field_of(&file, "custom")->is_used);
    tl_fabric_file_release(&file);
}

/* ---- Measurements ---- */

/* A path of a strip that is slack at first and then has a constant stiffness, N/m. */
static void write_stretch(FILE *to, double stiffness)
{
    fprintf(to, "\"S2\": {\"width\": 5, \"samplesTree\": [[8.0, 0.5, 8.1, 0.9");
    for (int i = 0; i <= 40; i++) {
        double tension = 1.0 + i * 0.5; /* gf/cm */
        fprintf(to, ", %.9g, %.9g", 8.2 + 8.0 * tension * 9.80665e-3 / 1e-2 / stiffness, 5 * tension);
    }
    fprintf(to, "]]}");
}

/* Euler's load of a strip clamped at both ends, with the growth of half of the shortening. */
static void write_bending(FILE *to, const char *test, double stiffness)
{
    double critical = 4 * M_PI * M_PI * stiffness * 0.05 / (0.02 * 0.02) / 9.80665e-3;
    fprintf(to, "\"%s\": {\"width\": 5, \"samplesTree\": [[2.0, %.9g, 1.8, %.9g]]}", test, -critical,
            -critical * 1.05);
}

static void write_strip(FILE *to, const char *name, double stretch, double bend)
{
    fprintf(to, "\"%s\": {", name);
    write_stretch(to, stretch);
    fputs(", ", to);
    write_bending(to, "D1", 1.3 * bend); /* the strip curls by itself */
    fputs(", ", to);
    write_bending(to, "U1", 0.7 * bend);
    fputs("}, ", to);
}

static void measurements_give_back_their_stiffness(void **state)
{
    (void)state;
    const double weft = 900, warp = 2500, shear = 40, bias = 4 / (1 / weft + 1 / warp + 1 / shear);
    tl_fabric_file file;
    tl_error error;
    empty_scratch();
    FILE *to = fopen(SCRATCH "/strips.json", "w");
    assert_non_null(to);
    fputs("{\"custom\": {\"someone\": {\"stretch\": 1}}, \"raw_data\": {", to);
    write_strip(to, "L", warp, 9e-6);
    write_strip(to, "W", weft, 5e-6);
    write_strip(to, "B", bias, 3e-6);
    fputs("\"T\": {\"samplesTree\": [[0.03, -500]]}, \"M\": 142.5}}", to);
    assert_int_equal(fclose(to), 0);
    assert_ok(tl_fabric_file_open(SCRATCH "/strips.json", &file, &error), error);
    assert_near(file.physics.weight_kg_m2, 0.1425, 1e-9);
    assert_near(file.physics.thickness_m, 3e-4, 1e-9);
    /* nine digits were written; the strain is relative to the path's first distance, 8 cm */
    assert_near(file.physics.stretch_warp / warp, 1, 1e-4);
    assert_near(file.physics.stretch_weft / weft, 1, 1e-4);
    assert_near(file.physics.shear / shear, 1, 1e-3);
    assert_near(file.physics.bend_warp / 9e-6, 1, 1e-6);
    assert_near(file.physics.bend_weft / 5e-6, 1, 1e-6);
    assert_false(field_of(&file, "custom")->is_used);
    assert_false(file.has_surface);
    tl_fabric_file_release(&file);
}

/* The maker's own evaluation of these measurements, in dyn cm, is 43.4 along the length and 52.8 along the
 * width. */
static void the_measured_example_is_near_its_makers_figures(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    assert_ok(tl_fabric_file_open(test_data("u3m/physics_example2.json"), &file, &error), error);
    assert_near(file.physics.weight_kg_m2, 0.1056, 1e-6);
    assert_near(file.physics.thickness_m, 1.0464e-4, 1e-8);
    assert_near(file.physics.bend_warp, 43.4e-7,
                0.15 * 43.4e-7); /* two ways to read one curve: only roughly equal */
    assert_near(file.physics.bend_weft, 52.8e-7, 0.15 * 52.8e-7);
    tl_fabric_file_release(&file);
}

/* ---- Folders ---- */

static void pictures_are_known_by_their_names(void **state)
{
    (void)state;
    const struct {
        const char *name;
        enum tl_picture_use use;
        int channel;
        bool inverted, y_down;
    } known[] = {{"Fabric061_2K-JPG_Color.png", TL_PICTURE_COLOUR, -1, false, false},
                 {"Fabric061_2K-JPG_NormalGL.png", TL_PICTURE_NORMAL, -1, false, false},
                 {"Fabric061_2K-JPG_NormalDX.png", TL_PICTURE_NORMAL, -1, false, true},
                 {"Fabric061_2K-JPG_Displacement.png", TL_PICTURE_HEIGHT, -1, false, false},
                 {"denim_fabric_diff_4k.png", TL_PICTURE_COLOUR, -1, false, false},
                 {"denim_fabric_nor_dx_4k.png", TL_PICTURE_NORMAL, -1, false, true},
                 {"denim_fabric_arm_4k.png", TL_PICTURE_ROUGHNESS, 1, false, false},
                 {"denim_fabric_rough_4k.png", TL_PICTURE_ROUGHNESS, -1, false, false},
                 {"cloth_baseColor.png", TL_PICTURE_COLOUR, -1, false, false},
                 {"cloth_ambientOcclusion.png", TL_PICTURE_OCCLUSION, -1, false, false},
                 {"cloth_Glossiness.png", TL_PICTURE_ROUGHNESS, -1, true, false},
                 {"cloth_opacity.png", TL_PICTURE_OPACITY, -1, false, false},
                 {"cloth_Metallic_1024.png", TL_PICTURE_METALNESS, -1, false, false},
                 {"wool_depth.png", TL_PICTURE_HEIGHT, -1, false, false},
                 {"anything.png", TL_PICTURE_COLOUR, -1, false, false}};
    for (size_t i = 0; i < TL_COUNT(known); i++) {
        tl_fabric_file file;
        tl_error error;
        empty_scratch();
        write_picture(known[i].name, (const uint8_t[]){10, 128, 200}, (const uint8_t[]){90, 80, 255}, 3);
        assert_ok(tl_fabric_file_open(SCRATCH "/", &file, &error), error);
        const struct tl_fabric_picture *picture = &file.pictures[known[i].use];
        if (!picture->file || strcmp(picture->file, known[i].name) != 0)
            print_error("%s is not the %s\n", known[i].name, tl_picture_names[known[i].use]);
        assert_non_null(picture->file);
        assert_int_equal(picture->channel, known[i].channel);
        assert_int_equal(picture->is_inverted, known[i].inverted);
        assert_int_equal(picture->is_y_down, known[i].y_down);
        tl_fabric_file_release(&file);
    }
    assert_string_equal(tl_picture_names[TL_PICTURE_HEIGHT], "height");
}

/* Of two conventions the program's own is taken; gloss, packed channels and DirectX's normals mean the same
 * thing. */
static void conventions_agree(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    struct tl_fabric_maps gl, dx;
    empty_scratch();
    write_picture("a_NormalGL.png", (const uint8_t[]){128, 160, 230}, (const uint8_t[]){100, 128, 230}, 3);
    write_picture("a_NormalDX.png", (const uint8_t[]){128, 95, 230}, (const uint8_t[]){100, 127, 230}, 3);
    write_picture("a_orm.png", (const uint8_t[]){255, 51, 0}, (const uint8_t[]){128, 102, 255}, 3);
    assert_ok(tl_fabric_file_open(SCRATCH, &file, &error), error);
    assert_string_equal(file.pictures[TL_PICTURE_NORMAL].file, "a_NormalGL.png");
    assert_false(field_of(&file, "a_NormalDX.png")->is_used);
    assert_ok(tl_fabric_maps_load(&file, &gl, &error), error);
    tl_fabric_file_release(&file);
    /* half hidden, and all metal */
    assert_near(tl_image_floats(&gl.colour)[0], 1, 1e-6);
    assert_near(tl_image_floats(&gl.colour)[3], 0, 1e-6);
    assert_near(tl_image_bytes(&gl.specular)[3], 255, 0);
    assert_int_equal(unlink(SCRATCH "/a_NormalGL.png"), 0);
    assert_int_equal(unlink(SCRATCH "/a_orm.png"), 0);
    write_picture("a_gloss.png", (const uint8_t[]){204, 204, 204}, (const uint8_t[]){153, 153, 153}, 3);
    assert_ok(tl_fabric_file_open(SCRATCH, &file, &error), error);
    assert_ok(tl_fabric_maps_load(&file, &dx, &error), error);
    tl_fabric_file_release(&file);
    for (int i = 0; i < 6; i++)
        assert_near(tl_image_bytes(&dx.normal)[i], tl_image_bytes(&gl.normal)[i], 1);
    for (int i = 0; i < 2; i++)
        assert_near(tl_image_floats(&dx.gloss)[i], tl_image_floats(&gl.gloss)[i], 1e-6);
    tl_fabric_maps_release(&gl);
    tl_fabric_maps_release(&dx);
}

/* Cloth that is metal throughout, and hidden nowhere, has channels that nobody filled. Metal with hidden
 * places stays metal, and a picture of metalness alone is meant. */
static void unfilled_channels_are_left(void **state)
{
    (void)state;
    static const struct {
        uint8_t first[3], second[3];
        bool is_metal;
    } cases[] = {{{255, 51, 255}, {255, 102, 255}, false},
                 {{255, 51, 255}, {254, 102, 255}, true},
                 {{255, 51, 255}, {255, 102, 254}, true}};
    tl_error error;
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_fabric_file file;
        empty_scratch();
        write_picture("a_orm.png", cases[i].first, cases[i].second, 3);
        assert_ok(tl_fabric_file_open(SCRATCH, &file, &error), error);
        assert_non_null(file.pictures[TL_PICTURE_ROUGHNESS].file);
        assert_int_equal(file.pictures[TL_PICTURE_METALNESS].file != NULL, cases[i].is_metal);
        assert_int_equal(file.pictures[TL_PICTURE_OCCLUSION].file != NULL, cases[i].is_metal);
        assert_int_equal(strstr(field_of(&file, "a_orm.png")->use, "not filled") == NULL, cases[i].is_metal);
        tl_fabric_file_release(&file);
    }
}

/* Normals that all lean lost their middle grey: what is left of them rises and falls about the cloth. */
static void leaning_normals_are_levelled(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    struct tl_fabric_maps maps;
    empty_scratch();
    write_picture("a_normal.png", (const uint8_t[]){47, 30, 255}, (const uint8_t[]){47, 50, 255}, 3);
    assert_ok(tl_fabric_file_open(SCRATCH, &file, &error), error);
    assert_ok(tl_fabric_maps_load(&file, &maps, &error), error);
    const uint8_t *normal = tl_image_bytes(&maps.normal);
    assert_near(maps.lean_deg, 44, 2);
    assert_near(normal[0], 128, 2);
    assert_near(normal[3], 128, 2);
    assert_near(normal[1] + normal[4], 256, 3);
    assert_true(normal[4] > normal[1] + 8);
    tl_fabric_maps_release(&maps);
    tl_fabric_file_release(&file);
}

/* A picture of another size is averaged in linear light, texel by texel of the smaller raster. */
static void sizes_are_made_equal(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    struct tl_fabric_maps maps;
    empty_scratch();
    tl_image fine = tl_image_create(2 * TL_LIMIT_FABRIC_SIDE, 2, 3, TL_IMAGE_U8);
    for (int i = 0; i < fine.width * fine.height; i++)
        memset(tl_image_bytes(&fine) + 3 * i, i % 2 ? 255 : 0, 3);
    assert_ok(tl_image_save_png(SCRATCH "/fine_color.png", &fine, &error), error);
    tl_image_release(&fine);
    assert_ok(tl_fabric_file_open(SCRATCH, &file, &error), error);
    assert_ok(tl_fabric_maps_load(&file, &maps, &error), error);
    assert_int_equal(maps.width, TL_LIMIT_FABRIC_SIDE);
    for (int i = 0; i < 3 * maps.width * maps.height; i++)
        assert_near(tl_image_floats(&maps.colour)[i], 0.5, 1e-6);
    tl_fabric_maps_release(&maps);
    tl_fabric_file_release(&file);
}

/* ---- Archives ---- */

static void add_entry(zip_t *zip, const char *name, const char *data, size_t size)
{
    zip_source_t *source = zip_source_buffer(zip, data, size, 0);
    assert_true(zip_file_add(zip, name, source, ZIP_FL_ENC_UTF_8) >= 0);
}

static zip_t *new_archive(const char *name)
{
    char *path = tl_format(SCRATCH "/%s", name);
    zip_t *zip = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, NULL);
    free(path);
    assert_non_null(zip);
    return zip;
}

static void an_archive_is_as_its_folder(void **state)
{
    (void)state;
    tl_fabric_file file;
    tl_error error;
    char *rough, *base;
    size_t rough_size, base_size;
    write_probe();
    assert_ok(tl_file_read(SCRATCH "/textures/rough.png", &rough, &rough_size, &error), error);
    assert_ok(tl_file_read(SCRATCH "/textures/base.png", &base, &base_size, &error), error);
    zip_t *zip = new_archive("probe.u3ma");
    add_entry(zip, "inner/probe.u3m", probe, sizeof probe - 1);
    add_entry(zip, "inner/textures/rough.png", rough, rough_size);
    add_entry(zip, "inner/textures/base.png", base, base_size);
    assert_int_equal(zip_close(zip), 0);
    assert_ok(tl_fabric_file_open(SCRATCH "/probe.u3ma", &file, &error), error);
    check_probe(&file);
    tl_fabric_file_release(&file);
    free(rough);
    free(base);
}

static void refuse(const char *name, const char *expected)
{
    tl_fabric_file file;
    tl_error error = {0};
    char *path = tl_format(SCRATCH "/%s", name);
    bool opened = tl_fabric_file_open(path, &file, &error);
    if (opened || !strstr(error.message, expected))
        print_error("%s: expected \"%s\", got %s\n", name, expected, opened ? "no error" : error.message);
    assert_false(opened);
    assert_non_null(strstr(error.message, expected));
    assert_non_null(strstr(error.message, name));
    assert_null(strchr(error.message, '\n'));
    assert_int_equal(error.code, TL_INPUT);
    free(path);
}

static void archives_cannot_lead_out(void **state)
{
    (void)state;
    static const char *const names[] = {"../probe.u3m", "/etc/probe.u3m", "a/../../probe.u3m",
                                        "a\\..\\probe.u3m", "C:/probe.u3m"};
    empty_scratch();
    for (size_t i = 0; i < TL_COUNT(names); i++) {
        zip_t *zip = new_archive("out.u3ma");
        add_entry(zip, names[i], probe, sizeof probe - 1);
        assert_int_equal(zip_close(zip), 0);
        refuse("out.u3ma", "leads out of it");
    }
    static const char outside[] = HEAD "\"front\": {\"roughness\": {\"constant\": 0, \"texture\": {" IMAGE(
        "../secret.png", "1", "1") "}}}}}";
    zip_t *zip = new_archive("points.u3ma");
    add_entry(zip, "probe.u3m", outside, sizeof outside - 1);
    assert_int_equal(zip_close(zip), 0);
    refuse("points.u3ma", "leads out of it");
    write_text("points.u3m", outside);
    refuse("points.u3m", "leads out of it");
}

/* Changes the size that both of an entry's headers state. */
static void lie_about_size(const char *path, uint32_t claimed)
{
    char *data;
    size_t size;
    tl_error error;
    assert_ok(tl_file_read(path, &data, &size, &error), error);
    for (size_t i = 0; i + 30 < size; i++) {
        if (memcmp(data + i, "PK\3\4", 4) == 0)
            memcpy(data + i + 22, &claimed, 4);
        if (memcmp(data + i, "PK\1\2", 4) == 0)
            memcpy(data + i + 24, &claimed, 4);
    }
    FILE *to = fopen(path, "wb");
    assert_non_null(to);
    assert_int_equal(fwrite(data, 1, size, to), size);
    assert_int_equal(fclose(to), 0);
    free(data);
}

static void sizes_are_checked_before_memory_is_taken(void **state)
{
    (void)state;
    const struct {
        uint32_t claimed;
        const char *expected;
    } lies[] = {{0xf0000000u, "at most"}, {60u << 20, "more than deflate can hold"}, {9000, "damaged"}};
    empty_scratch();
    for (size_t i = 0; i < TL_COUNT(lies); i++) {
        zip_t *zip = new_archive("bomb.u3ma");
        add_entry(zip, "probe.u3m", probe, sizeof probe - 1);
        assert_int_equal(zip_close(zip), 0);
        lie_about_size(SCRATCH "/bomb.u3ma", lies[i].claimed);
        refuse("bomb.u3ma", lies[i].expected);
    }
    write_text("words.u3ma", "no archive at all");
    refuse("words.u3ma", "no sound zip archive");
    zip_t *zip = new_archive("two.u3ma");
    add_entry(zip, "a.u3m", probe, sizeof probe - 1);
    add_entry(zip, "b.u3m", probe, sizeof probe - 1);
    assert_int_equal(zip_close(zip), 0);
    refuse("two.u3ma", "several fabrics");
}

/* ---- Faults ---- */

static void faults_are_named(void **state)
{
    (void)state;
    const struct {
        const char *name, *text, *expected;
    } faults[] = {
        {"cut.u3m", "{\"schema\": \"1.1\",\n\"material\": {", "cut.u3m:2: is no sound JSON"},
        {"list.u3m", "[1, 2]", "expected a JSON object"},
        {"other.u3m", "{\"a\": 1}", "is no U3M file"},
        {"empty.u3m", HEAD "\"front\": null}}", "neither a front nor physics"},
        {"front.u3m", HEAD "\"front\": 5}}", "front: expected an object"},
        {"rough.u3m", HEAD "\"front\": {\"roughness\": {\"constant\": \"high\", \"texture\": null}}}}",
         "material.front.roughness: expected a number"},
        {"mode.u3m",
         HEAD "\"front\": {\"basecolor\": {\"constant\": null, \"texture\": {\"mode\": \"melt\"}}}}}",
         "material.front.basecolor: expected texture.mode"},
        {"path.u3m", HEAD "\"front\": {\"alpha\": {\"constant\": 1, \"texture\": {\"image\": {}}}}}}",
         "material.front.alpha: expected texture.image.path"},
        {"weight.u3m", HEAD "\"front\": null, \"physics\": {\"weight\": -5}}}",
         "material.physics.weight: expected a number"},
        {"none.json", "{\"custom\": {}}", "expected an object \"raw_data\""},
        {"odd.json", "{\"raw_data\": {\"L\": {\"S2\": {\"width\": 5, \"samplesTree\": [[1, 2, 3]]}}}}",
         "raw_data.L.S2: expected samplesTree"},
        {"width.json", "{\"raw_data\": {\"L\": {\"S2\": {\"width\": -5, \"samplesTree\": [[1, 2, 3, 4]]}}}}",
         "raw_data.L.S2: expected width"},
        {"text.json",
         "{\"raw_data\": {\"L\": {\"S2\": {\"width\": 5, \"samplesTree\": [[1, \"2\", 3, 4]]}}}}",
         "raw_data.L.S2: expected numbers"},
        {"mass.json", "{\"raw_data\": {\"M\": 0}}", "raw_data.M: expected g/m^2"},
    };
    empty_scratch();
    for (size_t i = 0; i < TL_COUNT(faults); i++) {
        write_text(faults[i].name, faults[i].text);
        refuse(faults[i].name, faults[i].expected);
    }
    refuse("nowhere.u3m", "no such file");
    refuse("textures", "holds no texture maps");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(u3m_is_read),
        cmocka_unit_test(colours_are_blended_as_specified),
        cmocka_unit_test(the_formats_example_is_read),
        cmocka_unit_test(measurements_give_back_their_stiffness),
        cmocka_unit_test(the_measured_example_is_near_its_makers_figures),
        cmocka_unit_test(pictures_are_known_by_their_names),
        cmocka_unit_test(conventions_agree),
        cmocka_unit_test(unfilled_channels_are_left),
        cmocka_unit_test(leaning_normals_are_levelled),
        cmocka_unit_test(sizes_are_made_equal),
        cmocka_unit_test(an_archive_is_as_its_folder),
        cmocka_unit_test(archives_cannot_lead_out),
        cmocka_unit_test(sizes_are_checked_before_memory_is_taken),
        cmocka_unit_test(faults_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
