/* KHR_materials_variants: the material of each part in each variant, in small files and in real ones. */
#include "assets/model.h"

#include "tests/testing.h"

#include <string.h>

#define PATH TOILE_SCRATCH_DIR "/model_variants.gltf"

/* A triangle whose material is 0 of three, with the mappings and variants given as JSON. The buffer is three
 * points: (0 0 0) (1 0 0) (0 1 0). */
static bool load(const char *mappings, const char *variants, tl_model *out, tl_error *error)
{
    FILE *file = fopen(PATH, "w");
    assert_non_null(file);
    fprintf(
        file,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0,"
        "\"extensions\":{\"KHR_materials_variants\":{\"mappings\":%s}}},"
        "{\"attributes\":{\"POSITION\":0},\"material\":2}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"extensionsUsed\":[\"KHR_materials_variants\"],"
        "\"extensions\":{\"KHR_materials_variants\":{\"variants\":%s}},"
        "\"materials\":[{\"name\":\"red\"},{\"name\":\"blue\"},{\"name\":\"thread\"}]}",
        mappings, variants);
    fclose(file);
    return tl_model_load(PATH, out, error);
}

#define TWO "[{\"name\":\"Red\"},{\"name\":\"Blue\"}]"

static void parts_change_material(void **state)
{
    (void)state;
    tl_model model;
    tl_error error;
    assert_ok(load("[{\"material\":1,\"variants\":[1]}]", TWO, &model, &error), error);
    assert_int_equal(model.variant_count, 2);
    assert_int_equal(model.ignored_count, 0);
    const struct tl_variant *red = tl_model_find_variant(&model, "Red");
    const struct tl_variant *blue = tl_model_find_variant(&model, "Blue");
    assert_non_null(red);
    assert_non_null(blue);
    assert_null(tl_model_find_variant(&model, "blue"));
    assert_int_equal(red->materials[0], 0); /* not mapped: as without a variant */
    assert_int_equal(blue->materials[0], 1);
    assert_int_equal(red->materials[1], 2);
    assert_int_equal(blue->materials[1], 2);
    tl_model_release(&model);
}

/* Variants are chosen by name, so each has a name of its own. */
static void every_variant_has_a_name(void **state)
{
    (void)state;
    tl_model model;
    tl_error error;
    assert_ok(
        load("[]", "[{\"name\":\"Red\"},{\"name\":\"\"},{\"name\":\"Red\"},{\"name\":7}]", &model, &error),
        error);
    assert_int_equal(model.variant_count, 4);
    assert_string_equal(model.variants[0].name, "Red");
    assert_string_equal(model.variants[1].name, "variant 1");
    assert_string_equal(model.variants[2].name, "Red variant 2");
    assert_string_equal(model.variants[3].name, "variant 3");
    tl_model_release(&model);
}

static void indices_out_of_range_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *mappings, *variants, *message;
    } cases[] = {
        {"[{\"material\":3,\"variants\":[0]}]", TWO, "material 3 does not exist"},
        {"[{\"material\":-1,\"variants\":[0]}]", TWO, "material -1 does not exist"},
        {"[{\"variants\":[0]}]", TWO, "material -1 does not exist"},
        {"[{\"material\":\"blue\",\"variants\":[0]}]", TWO, "material -1 does not exist"},
        {"[7]", TWO, "material -1 does not exist"},
        {"[{\"material\":1,\"variants\":[2]}]", TWO, "variant 2 does not exist"},
        {"[{\"material\":1,\"variants\":[\"Blue\"]}]", TWO, "variant -1 does not exist"},
        {"[{\"material\":1,\"variants\":[0]}]", "[]", "variant 0 does not exist"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tl_model model;
        tl_error error;
        assert_false(load(cases[i].mappings, cases[i].variants, &model, &error));
        assert_non_null(strstr(error.message, PATH ": KHR_materials_variants: "));
        assert_non_null(strstr(error.message, cases[i].message));
    }
}

/* Empty lists of mappings and variants change nothing. */
static void empty_lists_are_accepted(void **state)
{
    (void)state;
    static const char *const mappings[] = {"[]", "{}", "[{\"material\":1}]",
                                           "[{\"material\":1,\"variants\":{}}]"};
    for (size_t i = 0; i < sizeof mappings / sizeof mappings[0]; i++) {
        tl_model model;
        tl_error error;
        assert_ok(load(mappings[i], TWO, &model, &error), error);
        assert_int_equal(model.variants[1].materials[0], 0);
        tl_model_release(&model);
    }
}

static void check_real(const char *path, const char *variant, const char *material)
{
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(test_data(path), &model, &error), error);
    const struct tl_variant *found = tl_model_find_variant(&model, variant);
    assert_non_null(found);
    bool used = false;
    for (size_t p = 0; p < model.mesh.part_count; p++)
        used |= strcmp(model.materials[found->materials[p]].name, material) == 0;
    assert_true(used);
    tl_model_release(&model);
}

static void the_velvet_sofa(void **state)
{
    (void)state;
    check_real("models/GlamVelvetSofa.glb", "Pale Pink", "GlamVelvetSofa_fabric_palepink");
    check_real("models/GlamVelvetSofa.glb", "Navy", "GlamVelvetSofa_fabric_navy");
}

static void the_sheen_chair(void **state)
{
    (void)state;
    check_real("models/SheenChair/SheenChair.gltf", "Peacock Velvet", "wood Black");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_change_material),
        cmocka_unit_test(every_variant_has_a_name),
        cmocka_unit_test(indices_out_of_range_are_refused),
        cmocka_unit_test(empty_lists_are_accepted),
        cmocka_unit_test(the_velvet_sofa),
        cmocka_unit_test(the_sheen_chair),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
