/* Colourways: how a scene's section is read and refused, and what it makes of materials. */
#include "tests/testing.h"

#include "app/scene/appearance.h"
#include "app/settings/layers.h"
#include "assets/garment.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <string.h>

#define PATH TOILE_SCRATCH_DIR "/colourways.yaml"

static void write_scene(const char *text)
{
    FILE *file = fopen(PATH, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static struct tl_settings settings;

static bool load(const char *colourway, tl_error *error)
{
    char *assignment = tl_format("scene.colourway=%s", colourway);
    const char *const assignments[] = {assignment};
    const struct tl_settings_source source = {PATH, assignments, 1};
    bool loaded = tl_settings_load(&settings, &source, error);
    free(assignment);
    return loaded;
}

#define SCENE                                                                                                \
    "scene: {garment: dress, fabric: wool}\n"                                                                \
    "material: {glossiness: 0.25}\n"                                                                         \
    "colourways:\n"                                                                                          \
    "  Ink:\n"                                                                                               \
    "    bodice: {diffuse: [0.01, 0.02, 0.07], fabric: satin, glossiness: 0.5}\n"                            \
    "    skirt: {diffuse: [0.2, 0.1, 0.1]}\n"                                                                \
    "  As cut:\n"                                                                                            \
    "  Work:\n"                                                                                              \
    "    all: {fabric: denim}\n"                                                                             \
    "    skirt: {warp_tint: [0.5, 0.5, 0.5]}\n"

/* The garment's two materials in a colourway. */
static struct tl_appearance dress_in(const char *colourway, tl_garment *dress)
{
    tl_error error = {0};
    struct tl_appearance appearance;
    assert_ok(load(colourway, &error), error);
    assert_ok(tl_garment_cut("dress", 0.08f, dress, &error), error);
    assert_ok(tl_appearance_make(&settings, &dress->model, NULL, &appearance, &error), error);
    return appearance;
}

static void looks_follow_the_scene(void **state)
{
    (void)state;
    tl_garment dress;
    struct tl_material_params satin, denim;
    struct tl_weave_params satin_weave, denim_weave;
    tl_error error = {0};
    write_scene(SCENE);
    assert_ok(tl_option_layer_read_appearance("satin", &satin, &satin_weave, &error), error);
    assert_ok(tl_option_layer_read_appearance("denim", &denim, &denim_weave, &error), error);

    struct tl_appearance appearance = dress_in("Ink", &dress);
    const tl_material *bodice = &appearance.garment.materials[0], *skirt = &appearance.garment.materials[1];
    /* The fabric's, where nothing else is said; its threads share the colour out. */
    assert_near(bodice->diffuse.z, (1 - satin.thread) * 0.07f, 1e-7);
    assert_near(bodice->specular.z, satin.specular[2], 1e-7);
    assert_int_equal(bodice->thread_count, 1);
    assert_near(bodice->diffuse.z * (1 + bodice->threads[0].ratio.z), 0.07f, 1e-6);
    assert_near(tl_material_colour(bodice).z, 0.07f, 1e-6);
    assert_near(bodice->threads[0].width_warp, satin.thread_along, 0); /* along the warps */
    assert_near(bodice->threads[0].width_weft, satin.thread_across, 0);
    assert_near(bodice->glossiness, 0.5, 0);
    assert_near(skirt->diffuse.x, 0.2, 1e-7);
    assert_near(skirt->glossiness, 0.25, 0); /* the scene's */
    assert_non_null(bodice->weave);
    assert_non_null(skirt->weave);
    assert_true(bodice->weave != skirt->weave); /* satin and wool */
    assert_int_equal(appearance.name_count, 3);
    assert_string_equal(appearance.names[1], "As cut");
    tl_appearance_release(&appearance);
    tl_garment_release(&dress);

    appearance = dress_in("Work", &dress);
    bodice = &appearance.garment.materials[0], skirt = &appearance.garment.materials[1];
    assert_near(skirt->diffuse.x, denim.diffuse[0], 0); /* `all` first, the skirt's own on top */
    assert_true(bodice->weave != skirt->weave);         /* other yarns */
    assert_near(tl_image_floats(&bodice->weave->height)[0], tl_image_floats(&skirt->weave->height)[0], 0);
    tl_appearance_release(&appearance);
    tl_garment_release(&dress);

    appearance = dress_in("As cut", &dress);
    tl_garment same;
    struct tl_appearance plain = dress_in("", &same);
    assert_near(appearance.garment.materials[0].glossiness, plain.garment.materials[0].glossiness, 0);
    assert_true(appearance.garment.materials[0].weave ==
                appearance.garment.materials[1].weave); /* made once */
    tl_appearance_release(&plain);
    tl_garment_release(&same);
    tl_appearance_release(&appearance);
    tl_garment_release(&dress);
}

static void one_material_that_maps_do_not_show_needs_rays(void **state)
{
    (void)state;
    tl_error error = {0};
    write_scene("scene: {garment: dress, fabric: cotton_plain}\ncolourways:\n"
                "  Plain: {skirt: {fabric: denim, diffuse: [0.1, 0.1, 0.1]}}\n"
                "  Gloss: {skirt: {fabric: satin}}\n  Coat: {skirt: {coat: 0.5}}\n");
    static const char *const names[] = {"", "Plain", "Gloss", "Coat"};
    for (size_t i = 0; i < TL_COUNT(names); i++) {
        assert_ok(load(names[i], &error), error);
        assert_int_equal(tl_settings_need_rays(&settings), i >= 2);
    }
}

/* Stitches in the cloth's colour are dyed with it; those that contrast with it, as denim's, are not. */
static void stitches_follow_the_cloth(void **state)
{
    (void)state;
    tl_garment dress;
    write_scene(
        "scene: {garment: dress, fabric: satin}\ncolourways: {Blue: {all: {diffuse: [0.05, 0.1, 0.6]}}}\n");
    struct tl_appearance plain = dress_in("", &dress);
    const vec3s wine = plain.garment.materials[0].construction.thread;
    tl_appearance_release(&plain);
    tl_garment_release(&dress);
    struct tl_appearance blue = dress_in("Blue", &dress);
    const vec3s thread = blue.garment.materials[0].construction.thread;
    assert_near(thread.x, wine.x / settings.material.diffuse[0] * 0.05f, 1e-6);
    assert_near(thread.z, wine.z / settings.material.diffuse[2] * 0.6f, 1e-6);
    tl_appearance_release(&blue);
    tl_garment_release(&dress);
    write_scene("scene: {garment: dress, fabric: denim}\ncolourways: {Black: {all: {diffuse: [0.02, 0.02, "
                "0.02]}}}\n");
    struct tl_appearance black = dress_in("Black", &dress);
    for (int c = 0; c < 3; c++)
        assert_near(black.garment.materials[0].construction.thread.raw[c], settings.construction.thread[c],
                    1e-6);
    tl_appearance_release(&black);
    tl_garment_release(&dress);
}

/* A file's material with a picture, a cut-out and maps of its own. */
static tl_material printed(tl_image *print, tl_image *gloss)
{
    *print = tl_image_create(2, 1, 4, TL_IMAGE_U8);
    const uint8_t texels[8] = {200, 10, 10, 255, 10, 200, 10, 0};
    memcpy(print->texels, texels, sizeof texels);
    *gloss = tl_image_create(1, 1, 1, TL_IMAGE_U8);
    tl_material material = tl_material_default("lace");
    material.diffuse = (vec3s){{0.9f, 0.8f, 0.7f}};
    material.glossiness = 0.6f;
    material.alpha_cutoff = 0.5f;
    material.diffuse_map.image = print;
    material.gloss_map.image = gloss;
    return material;
}

static tl_material look_of(const char *colourway, const tl_material *file, struct tl_appearance *appearance)
{
    tl_error error = {0};
    tl_material materials[] = {*file};
    struct tl_mesh_part part = {.index_count = 3};
    tl_model model = {.name = (char[]){"lace.glb"},
                      .mesh = {.part_count = 1, .parts = &part},
                      .material_count = 1,
                      .materials = materials};
    assert_ok(load(colourway, &error), error);
    assert_ok(tl_appearance_make(&settings, &model, NULL, appearance, &error), error);
    return appearance->garment.materials[0];
}

static void a_files_own_material_is_dyed(void **state)
{
    (void)state;
    tl_image print, gloss;
    tl_material file = printed(&print, &gloss), made;
    struct tl_appearance appearance;
    write_scene("scene: {fabric: none}\n"
                "colourways:\n"
                "  Same:\n"
                "  Tinted: {lace: {diffuse: [0.5, 0.5, 0.5]}}\n"
                "  Plain: {lace: {diffuse: [0.5, 0.5, 0.5], print: false}}\n"
                "  Velvet: {lace: {fabric: wool}}\n"
                "  Own: {all: {fabric: wool}, lace: {fabric: none}}\n");
    made = look_of("Same", &file, &appearance);
    file.construction = tl_construction_of(&settings.construction); /* sewn like any garment */
    assert_memory_equal(&made, &file, sizeof made);
    tl_appearance_release(&appearance);

    made = look_of("Tinted", &file, &appearance);
    assert_ptr_equal(made.diffuse_map.image, &print);
    assert_ptr_equal(made.gloss_map.image, &gloss); /* a colour changes no gloss */
    assert_near(made.diffuse.x, 0.5, 0);
    assert_near(made.glossiness, 0.6, 1e-7);
    tl_appearance_release(&appearance);

    made = look_of("Plain", &file, &appearance);
    assert_near(made.diffuse.x, 0.5, 0);
    assert_non_null(made.diffuse_map.image); /* lace keeps its holes */
    const uint8_t holes[8] = {255, 255, 255, 255, 255, 255, 255, 0};
    assert_memory_equal(made.diffuse_map.image->texels, holes, sizeof holes);
    tl_appearance_release(&appearance);

    made = look_of("Velvet", &file, &appearance);
    assert_ptr_equal(made.diffuse_map.image, &print); /* the print stays, in its own colours */
    assert_near(made.diffuse.x, 0.9, 1e-7);
    assert_null(made.gloss_map.image);
    assert_non_null(made.weave);
    tl_appearance_release(&appearance);

    made = look_of("Own", &file, &appearance);
    assert_ptr_equal(made.gloss_map.image, &gloss);
    assert_near(made.diffuse.x, 0.9, 1e-7);
    assert_null(made.weave);
    tl_appearance_release(&appearance);
    tl_image_release(&print);
    tl_image_release(&gloss);
}

static void refusals_name_file_line_and_field(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"  A: {bodice: {difuse: [0, 0, 0]}}\n",
         ":2: colourways.A.bodice: swatch.difuse: no such option: did you mean "
         "swatch.diffuse?"},
        {"  A:\n    bodice: {fabric: satn}\n", ":3: colourways.A.bodice: swatch.fabric: satn is no name"},
        {"  A:\n    bodice: {fabric: none.yaml}\n", ":3: colourways.A.bodice.fabric: "},
        {"  A:\n    bodice: {diffuse: [0, 2, 0]}\n", ":3: colourways.A.bodice: swatch.diffuse: "},
        {"  A:\n    bodice: {diffuse: {r: 1}}\n",
         ":3: colourways.A.bodice.diffuse: is a table inside a table"},
        {"  A:\n    bodice: {gloss: 1, gloss: 1}\n", ":3: colourways.A.bodice: swatch.gloss: no such option"},
        {"  A:\n    bodice: {coat: 1, coat: 1}\n", ":3: colourways.A.bodice.coat: is given twice"},
        {"  A:\n    bodice:\n  A:\n", ":4: colourways.A: is given twice"},
        {"  A:\n    bodice: satin\n", ":3: expected options"},
        {"  A: satin\n", ":2: expected parts"},
        {"  - name: A\n", ":2: expected names"},
        {"  A:\n    bodice:\n    bodice:\n", ":4: colourways.A.bodice: is given twice"},
        {"  ? [a]\n  : b\n", ":2: a list or table stands where a name was expected"},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        char *text = tl_format("colourways:\n%s", cases[i].text);
        tl_error error = {0};
        write_scene(text);
        assert_false(load("A", &error));
        char *start = tl_format("%s%s", PATH, cases[i].message);
        if (strncmp(error.message, start, strlen(start)) != 0)
            fail_msg("%s\nfor\n%s", error.message, text);
        free(start);
        free(text);
    }
}

static void expect_refused(const char *colourway, const char *message)
{
    tl_garment dress;
    tl_error error = {0};
    struct tl_appearance appearance;
    assert_ok(load(colourway, &error), error);
    assert_ok(tl_garment_cut("dress", 0.08f, &dress, &error), error);
    assert_false(tl_appearance_make(&settings, &dress.model, NULL, &appearance, &error));
    assert_non_null(strstr(error.message, message));
    assert_null(appearance.names);
    tl_garment_release(&dress);
}

static void names_that_nobody_has_are_refused(void **state)
{
    (void)state;
    write_scene("colourways:\n  Ink:\n    bodise: {fabric: satin}\n");
    expect_refused("Imk", "did you mean Ink?");
    expect_refused("Ink", PATH
                   ":3: colourways.Ink.bodise: the garment dress has no such material: did you mean bodice?");
    write_scene("scene: {garment: skirt}\n");
    expect_refused("Chartreuse", "there are Bottle green, Denim, Poppy");
}

/* Which file's section is meant, and that a change later is the same as loading it. */
static void settings_know_whose_they_are(void **state)
{
    (void)state;
    tl_error error = {0};
    write_scene(SCENE);
    assert_ok(load("Ink", &error), error);
    assert_string_equal(settings.scene.colourways, PATH);
    assert_true(settings.colourways->is_known);
    assert_int_equal(settings.colourways->swatch_count, 2);
    struct tl_settings changed = settings;
    assert_ok(tl_settings_apply_colourway(&changed, "Work", &error), error);
    assert_false(tl_settings_equal(&changed, &settings));
    assert_ok(load("Work", &error), error);
    assert_true(tl_settings_equal(&changed, &settings));
    assert_ok(tl_settings_apply_colourway(&changed, "", &error), error);
    assert_int_equal(changed.colourways->swatch_count, 0);
    assert_int_equal(changed.colourways->name_count, 3);

    write_scene("scene: {garment: skirt}\n");
    assert_ok(load("Poppy", &error), error);
    assert_true(settings.colourways->is_known);
    assert_string_equal(tl_settings_colourways_source(&settings), "skirt");
    write_scene("scene: {garment: skirt, colourways: dress}\n");
    assert_ok(load("Ink", &error), error);
    assert_true(settings.colourways->is_known);
}

/* All built-in ones fit the garments that they are for. */
static void built_in_ones_fit(void **state)
{
    (void)state;
    tl_error error = {0};
    for (const char *const *name = tl_garment_names; *name; name++) {
        tl_garment garment;
        assert_ok(tl_garment_cut(*name, 0.08f, &garment, &error), error);
        char *scene = tl_format("scene: {garment: %s}\n", *name);
        write_scene(scene);
        free(scene);
        assert_ok(load("", &error), error);
        assert_true(settings.colourways->name_count >= 2);
        for (size_t i = 0; i < settings.colourways->name_count; i++) {
            struct tl_appearance appearance;
            assert_ok(tl_settings_apply_colourway(&settings, settings.colourways->names[i], &error), error);
            assert_ok(tl_appearance_make(&settings, &garment.model, NULL, &appearance, &error), error);
            tl_appearance_release(&appearance);
        }
        tl_garment_release(&garment);
    }
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(looks_follow_the_scene),
        cmocka_unit_test(one_material_that_maps_do_not_show_needs_rays),
        cmocka_unit_test(stitches_follow_the_cloth),
        cmocka_unit_test(a_files_own_material_is_dyed),
        cmocka_unit_test(refusals_name_file_line_and_field),
        cmocka_unit_test(names_that_nobody_has_are_refused),
        cmocka_unit_test(settings_know_whose_they_are),
        cmocka_unit_test(built_in_ones_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
