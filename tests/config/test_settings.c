/* The layers: defaults < preset < fabric < scene file < --set; what ships with the program reads well. */
#include "tests/testing.h"

#include "app/settings/settings.h"
#include "assets/garment.h"
#include "assets/specimen/specimen.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <string.h>

#define FOLDER TOILE_SCRATCH_DIR "/settings"

static struct tl_settings settings;

static int begin(void **state)
{
    (void)state;
    memset(&settings, 0, sizeof settings);
    return 0;
}

static void write_text(const char *path, const char *text)
{
    tl_error error = {0};
    struct tl_writer writer;
    assert_ok(tl_folder_make(FOLDER, &error), error);
    assert_ok(tl_writer_begin(&writer, path, &error), error);
    fputs(text, writer.stream);
    assert_ok(tl_writer_commit(&writer, &error), error);
}

static bool load(const char *scene, const char *const *assignments, size_t count, tl_error *error)
{
    const struct tl_settings_source source = {scene, assignments, count};
    return tl_settings_load(&settings, &source, error);
}

static void test_built_in_scene(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_ok(load(NULL, NULL, 0, &error), error);
    assert_string_equal(settings.scene.garment, "dress");
    assert_string_equal(settings.scene.avatar, "auto");
    assert_string_equal(tl_settings_avatar(&settings.scene), "form");
    assert_string_equal(settings.scene.environment, "studio");
    assert_string_equal(settings.scene.fabric, "satin");
    assert_string_equal(settings.scene.preset, "review");
    assert_int_equal(settings.weave.pattern, TL_WEAVE_SATIN); /* from the fabric */
    assert_int_equal(settings.light.lobe, TL_LOBE_DUAL);      /* from the preset */
    assert_ok(load("skirt", NULL, 0, &error), error);         /* built-in scenes have names */
    assert_string_equal(settings.scene.garment, "skirt");
}

/* A fabric that nobody names: what such a garment is made of, a garment file's own look for a file. */
static void test_fabric_left_out(void **state)
{
    (void)state;
    tl_error error = {0};
    const char *const file[] = {"scene.garment=shirt.glb"};
    assert_ok(tl_settings_load(&settings, &(struct tl_settings_source){NULL, file, 1}, &error), error);
    assert_string_equal(settings.scene.fabric, "none");
    assert_true(settings.material.use_file);
    const char *const both[] = {"scene.garment=shirt.glb", "scene.fabric=denim"};
    assert_ok(tl_settings_load(&settings, &(struct tl_settings_source){NULL, both, 2}, &error), error);
    assert_string_equal(settings.scene.fabric, "denim");
    const char *const skirt[] = {"scene.garment=skirt"};
    assert_ok(tl_settings_load(&settings, &(struct tl_settings_source){NULL, skirt, 1}, &error), error);
    assert_string_equal(settings.scene.fabric, "satin");
    static const char *const kinds[][2] = {{"scene.garment=shirt", "cotton_plain"},
                                           {"scene.garment=blouse_specification.json", "cotton_plain"},
                                           {"scene.garment=trousers", "denim"}};
    for (size_t i = 0; i < TL_COUNT(kinds); i++) {
        assert_ok(tl_settings_load(&settings, &(struct tl_settings_source){NULL, kinds[i], 1}, &error),
                  error);
        assert_string_equal(settings.scene.fabric, kinds[i][1]);
    }
}

/* Each layer wins over the one below it, wherever the names of preset and fabric come from. */
static void test_each_layer_wins(void **state)
{
    (void)state;
    tl_error error = {0};
    write_text(FOLDER "/mine.yaml", "light: {regions: 30, map_size: 64}\n");
    write_text(FOLDER "/cloth.yaml", "fabric: {areal_density: 0.2}\nmaterial: {glossiness: 0.25}\n");
    write_text(FOLDER "/scene.yaml", "scene: {preset: mine.yaml, fabric: cloth.yaml, avatar: body.glb}\n"
                                     "light: {map_size: 32}\nmaterial: {glossiness: 0.75}\n");
    assert_ok(load(FOLDER "/scene.yaml", NULL, 0, &error), error);
    assert_int_equal(settings.light.regions, 30);                   /* preset over defaults */
    assert_int_equal(settings.light.map_size, 32);                  /* scene over preset */
    assert_true(settings.fabric.areal_density == 0.2);              /* fabric over defaults */
    assert_true(settings.material.glossiness == 0.75f);             /* scene over fabric */
    assert_string_equal(settings.scene.avatar, FOLDER "/body.glb"); /* beside the scene file */
    assert_string_equal(settings.scene.preset, FOLDER "/mine.yaml");

    static const char *const over[] = {"light.map_size=16", "light.map_size=8", "scene.fabric=denim"};
    assert_ok(load(FOLDER "/scene.yaml", over, TL_COUNT(over), &error), error);
    assert_int_equal(settings.light.map_size, 8); /* --set over scene, the later one */
    assert_int_equal(settings.light.regions, 30);
    assert_true(settings.fabric.areal_density == 0.4);  /* denim's */
    assert_true(settings.material.glossiness == 0.75f); /* the scene still speaks after the fabric */
    static const char *const paper[] = {"scene.preset=paper"};
    assert_ok(load(FOLDER "/scene.yaml", paper, 1, &error), error);
    assert_int_equal(settings.light.pems_per_pass, 12);
    assert_int_equal(settings.light.map_size, 32);
}

static void test_model_in_place_of_a_scene(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_ok(load("some folder/Model.GLB", NULL, 0, &error), error);
    assert_string_equal(settings.scene.avatar, "some folder/Model.GLB");
    assert_string_equal(settings.scene.garment, "none");
    assert_string_equal(settings.scene.fabric, "none");
    assert_true(settings.material.use_file);
    assert_int_equal(settings.weave.pattern, TL_WEAVE_NONE);
    static const char *const dressed[] = {"scene.garment=shirt.gltf"};
    assert_ok(load("m.gltf", dressed, 1, &error), error);
    assert_string_equal(settings.scene.garment, "shirt.gltf");
    assert_string_equal(settings.scene.avatar, "m.gltf");
}

/* Where the options say who wears it, the model is the garment. */
static void test_model_beside_a_body(void **state)
{
    (void)state;
    tl_error error = {0};
    static const char *const worn[] = {"scene.avatar=body.glb"};
    assert_ok(load("shirt.obj", worn, 1, &error), error);
    assert_string_equal(settings.scene.garment, "shirt.obj");
    assert_string_equal(settings.scene.avatar, "body.glb");
    assert_string_equal(settings.scene.fabric, "none");
    static const char *const satin[] = {"scene.avatar=none", "scene.fabric=satin"};
    assert_ok(load("shirt.obj", satin, 2, &error), error);
    assert_string_equal(settings.scene.garment, "shirt.obj");
    assert_string_equal(settings.scene.fabric, "satin");
    static const char *const both[] = {"scene.avatar=body.glb", "scene.garment=skirt"};
    assert_ok(load("shirt.obj", both, 2, &error), error);
    assert_string_equal(settings.scene.garment, "skirt");
}

static size_t check_garment_names(const char *const *names)
{
    tl_error error = {0};
    size_t count = 0;
    for (; names[count]; count++) {
        char *assignment = tl_format("scene.garment=%s", names[count]);
        const char *const assignments[] = {assignment};
        assert_ok(load(NULL, assignments, 1, &error), error);
        assert_string_equal(settings.scene.garment, names[count]);
        free(assignment);
    }
    return count;
}

/* The names that a scene may use are the garments that can be cut, the specimens, and "none". */
static void test_garment_names(void **state)
{
    (void)state;
    size_t count = check_garment_names(tl_garment_names) + check_garment_names(tl_specimen_names);
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&settings, bindings);
    const struct tl_option *garment = &bindings[0].table->rows[0];
    assert_string_equal(garment->name, "garment");
    assert_null(garment->choices[count + 1]);
    assert_string_equal(garment->choices[count], "none");
}

/* A refusal leaves the settings as they were. */
static void refuse(const char *scene, const char *assignment, const char *message)
{
    tl_error error = {0};
    struct tl_settings before = settings;
    assert_false(load(scene, &assignment, assignment ? 1 : 0, &error));
    assert_string_equal(error.message, message);
    assert_memory_equal(&settings, &before, sizeof settings);
}

static void test_refusals(void **state)
{
    (void)state;
    refuse("nowhere.yaml", NULL, "nowhere.yaml: no such file: check the path");
    refuse("drss", NULL,
           "drss: no such scene: expected dress, skirt, trousers, shirt, review, gallery, composed, cusick, "
           "or a "
           "YAML file: "
           "did you mean dress?");
#define SECOND_FABRIC                                                                                        \
    "a second fabric is part of a colourway: write `colourways: {NAME: {overlay: {fabric: voile}}}` and "    \
    "`scene: {colourway: NAME}`"
    refuse(NULL, "scene.overlay_fabric=voile", "--set: scene.overlay_fabric: " SECOND_FABRIC);
    write_text(FOLDER "/old.yaml", "scene: {garment: layers}\noverlay: {coat: 1}\n");
    refuse(FOLDER "/old.yaml", NULL, FOLDER "/old.yaml:2: overlay: " SECOND_FABRIC);
    refuse(NULL, "scene.fabric=satn",
           "--set: scene.fabric: satn is no name known here: expected none, cotton_plain, satin, "
           "denim, silk, charmeuse, taffeta, shot_silk, wool, jersey, interlock_tee, rib_knit, ponte, "
           "swim_knit, "
           "fleece, velvet, "
           "stretch_denim, trouser_twill, voile, jacket_polyester, tablecloth_polyester or "
           "a file name with its extension: did you mean satin?");
    refuse(NULL, "scene.preset=fast",
           "--set: scene.preset: fast is no name known here: expected paper, draft, review or a file "
           "name with "
           "its extension");
    refuse(NULL, "scene.fabric=no.yaml", "no.yaml: no such file: check the path");
    refuse(NULL, "light.regionz=6", "--set: light.regionz: no such option: did you mean light.regions?");
    write_text(FOLDER "/bad.yaml", "scene:\n  garment: dres\n");
    refuse(FOLDER "/bad.yaml", NULL,
           FOLDER "/bad.yaml:2: scene.garment: dres is no name known here: expected dress, skirt, layers, "
                  "trousers, shirt, sheet, disc, sphere, torus, plate, none or a file name "
                  "with its extension: did you mean dress?");
    /* A preset is about quality, a fabric about cloth: neither may reach into the scene. */
    write_text(FOLDER "/preset.yaml", "scene:\n  fabric: wool\n");
    refuse(NULL, "scene.preset=" FOLDER "/preset.yaml",
           FOLDER "/preset.yaml:1: scene: no such table: expected one of cloth, light, image");
    write_text(FOLDER "/fabric.yaml", "light:\n  regions: 6\n");
    refuse(NULL, "scene.fabric=" FOLDER "/fabric.yaml",
           FOLDER "/fabric.yaml:1: light: no such table: expected one of fabric, weave, material, "
                  "construction");
    refuse(FOLDER, NULL, FOLDER ": is a folder: name a file in it");
}

/* All that ships can be loaded, in any combination, and changing to it later is the same as loading it. */
static void test_shipped_files(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_settings changed;
    assert_ok(load(NULL, NULL, 0, &error), error);
    changed = settings;
    for (size_t i = 0; tl_embedded_presets_names[i]; i++)
        for (size_t j = 0; tl_embedded_fabrics_names[j]; j++) {
            assert_ok(tl_settings_apply_preset(&changed, tl_embedded_presets_names[i], &error), error);
            assert_ok(tl_settings_apply_fabric(&changed, tl_embedded_fabrics_names[j], &error), error);
            char *preset = tl_format("scene.preset=%s", tl_embedded_presets_names[i]);
            char *fabric = tl_format("scene.fabric=%s", tl_embedded_fabrics_names[j]);
            const char *const assignments[] = {preset, fabric};
            assert_ok(load(NULL, assignments, TL_COUNT(assignments), &error), error);
            assert_true(tl_settings_equal(&changed, &settings));
            free(preset);
            free(fabric);
        }
    for (size_t i = 0; tl_embedded_scenes_names[i]; i++)
        assert_ok(load(tl_embedded_scenes_names[i], NULL, 0, &error), error);
}

/* The scene file that README.md shows is one that the program reads. */
static void test_readme_example(void **state)
{
    (void)state;
    tl_error error = {0};
    char *page = NULL;
    size_t size = 0;
    assert_ok(tl_file_read(TOILE_SOURCE_DIR "/README.md", &page, &size, &error), error);
    char *example = strstr(page, "```yaml\n");
    assert_non_null(example);
    example += strlen("```yaml\n");
    char *end = strstr(example, "```");
    assert_non_null(end);
    *end = '\0';
    write_text(FOLDER "/readme.yaml", example);
    assert_ok(load(FOLDER "/readme.yaml", NULL, 0, &error), error);
    free(page);
}

static void test_changes_that_fail_change_nothing(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_ok(load(NULL, NULL, 0, &error), error);
    struct tl_settings before = settings;
    write_text(FOLDER "/half.yaml", "fabric: {areal_density: 0.3}\nweave: {pattern: tartan}\n");
    assert_false(tl_settings_apply_fabric(&settings, FOLDER "/half.yaml", &error));
    assert_false(tl_settings_apply_fabric(&settings, "tartan", &error));
    assert_false(tl_settings_apply_preset(&settings, "tartan", &error));
    assert_memory_equal(&settings, &before, sizeof settings);
}

/* The figures of [Knuth et al. 2014]. */
static void test_paper_preset(void **state)
{
    (void)state;
    tl_error error = {0};
    static const char *const paper[] = {"scene.preset=paper"};
    assert_ok(load(NULL, paper, 1, &error), error);
    assert_int_equal(settings.light.lobe, TL_LOBE_DUAL);
    assert_int_equal(settings.light.moments, TL_MOMENTS_HALF);
    assert_int_equal(settings.light.pems_per_pass, 12);
    assert_int_equal(settings.light.pem_size, 128);
    assert_true(settings.light.bleed_reduction == 0);
    assert_int_equal(settings.light.regions % 6, 0);
}

/* The printed settings, read as a scene, give the same settings. */
static void test_print_and_load_back(void **state)
{
    (void)state;
    tl_error error = {0};
    static const char *const assignments[] = {"scene.preset=draft", "camera.target=[0.1, 1.25, -0.3]",
                                              "camera.distance_m=2.7", "scene.clip=Walk: \"fast\""};
    assert_ok(load("skirt", assignments, TL_COUNT(assignments), &error), error);
    struct tl_settings before = settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&settings, bindings);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    tl_options_print_yaml(bindings, TL_SETTINGS_TABLES, out);
    fclose(out);
    write_text(FOLDER "/printed.yaml", text);
    free(text);
    begin(NULL);
    assert_ok(load(FOLDER "/printed.yaml", NULL, 0, &error), error);
    assert_true(tl_settings_equal(&settings, &before));
    settings.camera.target[1] += 0.5f;
    assert_false(tl_settings_equal(&settings, &before));
}

/* A text of the row's type that is not its default. */
static char *another_value(const struct tl_option *row, const void *defaults)
{
    const void *usual = (const char *)defaults + row->offset;
    switch (row->type) {
    case TL_BOOL:
        return tl_copy_string(*(const bool *)usual ? "false" : "true");
    case TL_ENUM:
        return tl_copy_string(row->choices[*(const int *)usual == 0]);
    case TL_INT:
        return tl_format("%d", *(const int *)usual == (int)row->minimum ? (int)row->minimum + 1
                                                                        : (int)row->minimum);
    case TL_FLOAT:
        return tl_format("%.9g", *(const float *)usual == (float)row->maximum ? row->minimum : row->maximum);
    case TL_DOUBLE:
        return tl_format("%.17g", *(const double *)usual == row->maximum ? row->minimum : row->maximum);
    case TL_COLOUR:
    case TL_VECTOR:
        return tl_format("[%.9g, %.9g, %.9g]", row->minimum, 0.25 * row->minimum + 0.75 * row->maximum,
                         row->maximum);
    case TL_STRING:
        return tl_copy_string("another text");
    case TL_PATH:
        break;
    }
    return tl_copy_string("/another/file.name");
}

/* Every option of every table is kept by itself: the change is seen, by what its row affects and by the hash;
 * no other option changes with it; the text that it gives reads back as the same value, alone and in a scene
 * file; and to take what it affects makes the settings equal again. */
static void test_every_option_is_kept(void **state)
{
    (void)state;
    const struct tl_option_filter every = {.any_of = UINT64_MAX};
    tl_error error = {0};
    struct tl_settings usual, one, again, all;
    struct tl_binding of_one[TL_SETTINGS_TABLES], of_again[TL_SETTINGS_TABLES], of_all[TL_SETTINGS_TABLES];
    size_t count = 0;
    tl_settings_reset(&usual);
    all = usual;
    tl_settings_bind(&one, of_one);
    tl_settings_bind(&again, of_again);
    tl_settings_bind(&all, of_all);
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++)
        for (size_t r = 0; r < of_one[t].table->row_count; r++, count++) {
            const struct tl_option *row = &of_one[t].table->rows[r];
            char *key = tl_format("%s.%s", of_one[t].table->name, row->name);
            char *text = another_value(row, of_one[t].table->defaults);
            one = again = usual;
            assert_ok(tl_options_set(of_one, TL_SETTINGS_TABLES, key, text, "here", NULL, &error), error);
            if (tl_settings_changes(&usual, &one) != row->affects ||
                tl_settings_hash(&usual, every) == tl_settings_hash(&one, every))
                fail_msg("%s: is not seen to change, or another option changes with it", key);
            char *back = tl_options_get_text(&of_one[t], row);
            assert_ok(tl_options_set(of_again, TL_SETTINGS_TABLES, key, back, "here", NULL, &error), error);
            if (!tl_settings_equal(&one, &again))
                fail_msg("%s: %s reads back as another value", key, back);
            again = usual;
            tl_settings_take(&one, &again, (struct tl_option_filter){.any_of = row->affects});
            assert_true(tl_settings_equal(&one, &again));
            assert_ok(tl_options_set(of_all, TL_SETTINGS_TABLES, key, text, "here", NULL, &error), error);
            free(back);
            free(text);
            free(key);
        }
    assert_true(count > 150);
    char *printed = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&printed, &size);
    tl_options_print_yaml(of_all, TL_SETTINGS_TABLES, out);
    fclose(out);
    again = usual;
    assert_ok(tl_options_read_yaml(of_again, TL_SETTINGS_TABLES, "all.yaml", printed, size, &error), error);
    assert_true(tl_settings_equal(&all, &again));
    free(printed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fabric_left_out),
        cmocka_unit_test_setup(test_built_in_scene, begin),
        cmocka_unit_test_setup(test_each_layer_wins, begin),
        cmocka_unit_test_setup(test_model_in_place_of_a_scene, begin),
        cmocka_unit_test_setup(test_model_beside_a_body, begin),
        cmocka_unit_test_setup(test_garment_names, begin),
        cmocka_unit_test_setup(test_refusals, begin),
        cmocka_unit_test_setup(test_shipped_files, begin),
        cmocka_unit_test_setup(test_readme_example, begin),
        cmocka_unit_test_setup(test_changes_that_fail_change_nothing, begin),
        cmocka_unit_test_setup(test_paper_preset, begin),
        cmocka_unit_test_setup(test_print_and_load_back, begin),
        cmocka_unit_test(test_every_option_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
