/* The table of experiments: every row of the technique set is pictured, every option of every row exists,
 * names that become files are unique. */
#include "tests/testing.h"

#include "app/lab/experiments/experiments.h"
#include "app/lab/experiments/picture.h"
#include "config/base/memory.h"

#include <string.h>

/* Whether a section's title, "C1, C2  Heights as normals", begins with the id. */
static bool is_titled(const struct tl_experiment *section, const char *id)
{
    const size_t length = strlen(id);
    for (const char *at = section->title;; at += 2) {
        const size_t name = strcspn(at, ", ");
        if (name == length && strncmp(at, id, length) == 0)
            return true;
        at += name;
        if (strncmp(at, ", ", 2) != 0)
            return false;
    }
}

static bool has_section(const char *id)
{
    const struct tl_experiment *section;
    for (size_t i = 0; (section = tl_experiment_at(TL_OUTPUT_PICTURES, i)); i++)
        if (is_titled(section, id))
            return true;
    return false;
}

/* All rows of the technique set, but for those of the program itself (F): a row that is measured within
 * another's section, C2 with C1, is named by that section's title. */
static void test_every_id_has_a_section(void **state)
{
    (void)state;
    static const struct {
        char group;
        int count;
    } groups[] = {{'A', 13}, {'B', 8}, {'C', 15}, {'D', 16}, {'E', 6}};
    for (size_t g = 0; g < TL_COUNT(groups); g++)
        for (int i = 1; i <= groups[g].count; i++) {
            char id[16];
            snprintf(id, sizeof id, "%c%d", groups[g].group, i);
            if (!has_section(id))
                fail_msg("%s has no section", id);
        }
}

/* Rows of the four sources name section and figure; test `citations` knows which there are. */
static void test_sections_name_their_source(void **state)
{
    (void)state;
    static const char *const own[] = {"c9", "d12", "d13", "d15", "f2"};
    const struct tl_experiment *section;
    for (size_t i = 0; (section = tl_experiment_at(TL_OUTPUT_PICTURES, i)); i++) {
        bool is_own = section->name[0] == 'e';
        for (size_t k = 0; k < TL_COUNT(own); k++)
            is_own = is_own || strcmp(section->name, own[k]) == 0;
        if (is_own == (section->source != NULL))
            fail_msg("%s: %s", section->title, is_own ? "is this program's own" : "names no source");
    }
}

/* A title names the ids of its rows, and each section has rows. */
static void test_sections_are_titled_as_their_rows(void **state)
{
    (void)state;
    const struct tl_experiment *section;
    for (size_t i = 0; (section = tl_experiment_at(TL_OUTPUT_PICTURES, i)); i++) {
        assert_true(tl_picture_count(section, TL_OUTPUT_PICTURES) > 0);
        for (const struct tl_technique *t = NULL; (t = tl_experiment_next(section, TL_OUTPUT_PICTURES, t));)
            if (!is_titled(section, t->id))
                fail_msg("%s: \"%s\" is of %s", section->title, t->picture, t->id);
    }
}

/* An exact picture drawn with the settings of the row that it judges finds no error, whatever the technique
 * does. Integrals are no drawing. A static solid may be equal where the sheet is not. */
static void check_exact(const struct tl_experiment_picture *picture)
{
    bool differs = picture->experiment->exact == TL_EXACT_INTEGRAL;
    for (int object = 0; object < TL_PICTURE_OBJECTS; object++) {
        struct tl_settings tested, exact;
        tl_error error = {0};
        assert_ok(tl_picture_settings(picture, (enum tl_picture_object)object, 64, false, &tested, &error),
                  error);
        assert_ok(tl_picture_settings(picture, (enum tl_picture_object)object, 64, true, &exact, &error),
                  error);
        differs = differs || !tl_settings_equal(&tested, &exact);
        if (picture->experiment->exact == TL_EXACT_INTEGRAL) { /* it has no hems' gloss */
            assert_int_equal(tested.light.method, TL_METHOD_MAPS);
            assert_int_equal(tested.construction.show, TL_CONSTRUCTION_NEVER);
        }
    }
    if (!differs)
        fail_msg("%s, %s: is measured against itself", picture->experiment->name,
                 picture->technique->picture);
}

static bool has_technique(const struct tl_experiment *experiment, const char *name)
{
    for (const struct tl_technique *t = NULL; (t = tl_experiment_next(experiment, TL_OUTPUT_PICTURES, t));)
        if (strcmp(t->picture, name) == 0)
            return true;
    return false;
}

static void test_no_picture_is_measured_against_itself(void **state)
{
    (void)state;
    const struct tl_experiment *experiment;
    for (size_t i = 0; (experiment = tl_experiment_at(TL_OUTPUT_PICTURES, i)); i++) {
        struct tl_experiment_picture picture = {.experiment = experiment};
        assert_non_null(experiment->exact_text);
        while (tl_picture_next(&picture, TL_OUTPUT_PICTURES))
            check_exact(&picture);
        for (int c = 0; c < TL_EXPERIMENT_CLAIMS && experiment->claims[c].nearer; c++) {
            assert_true(has_technique(experiment, experiment->claims[c].nearer));
            assert_true(has_technique(experiment, experiment->claims[c].farther));
        }
    }
}

static void check_pictures(const struct tl_experiment *experiment, enum tl_output output)
{
    struct tl_experiment_picture picture = {.experiment = experiment};
    assert_true(tl_picture_count(experiment, output) > 0);
    while (tl_picture_next(&picture, output))
        for (int object = 0; object < TL_PICTURE_OBJECTS; object++)
            for (int reference = 0; reference < 2; reference++) {
                struct tl_settings settings;
                tl_error error = {0};
                assert_ok(tl_picture_settings(&picture, (enum tl_picture_object)object, 64, reference,
                                              &settings, &error),
                          error);
            }
}

/* Settings of techniques that are measured in motion: appearance over base over scene, then the setup. */
static void check_setups(const struct tl_experiment *experiment, enum tl_output output)
{
    int appearances = experiment->appearance_count ? experiment->appearance_count : 1;
    const struct tl_settings_source source = {.scene_file = experiment->scene};
    struct tl_settings scene, settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&scene, &source, &error), error);
    assert_ok(tl_settings_assign(&scene, experiment->base, TL_COUNT(experiment->base), &error), error);
    assert_ok(tl_setup_apply(&experiment->reference, &scene, &settings, &error), error);
    assert_true(tl_experiment_count(experiment, output) > 1);
    for (int a = 0; a < appearances; a++) {
        struct tl_settings seen = scene;
        if (experiment->appearances)
            assert_ok(tl_settings_assign(&seen, experiment->appearances[a].assignments,
                                         TL_EXPERIMENT_ASSIGNMENTS, &error),
                      error);
        for (const struct tl_technique *t = NULL; (t = tl_experiment_next(experiment, output, t));)
            assert_ok(tl_setup_apply(&t->setup, &seen, &settings, &error), error);
    }
}

static void test_every_option_exists(void **state)
{
    (void)state;
    for (int output = 0; output < TL_OUTPUTS; output++) {
        const struct tl_experiment *experiment;
        for (size_t i = 0; (experiment = tl_experiment_at((enum tl_output)output, i)); i++)
            if (output == TL_OUTPUT_PICTURES || output == TL_OUTPUT_GOLDEN)
                check_pictures(experiment, (enum tl_output)output);
            else
                check_setups(experiment, (enum tl_output)output);
    }
}

/* Pictures' files are called after their experiments; a page's rows are found by their group and name. */
static void test_names_are_unique(void **state)
{
    (void)state;
    for (int output = 0; output < TL_OUTPUTS; output++) {
        const struct tl_experiment *experiment;
        for (size_t i = 0; (experiment = tl_experiment_at((enum tl_output)output, i)); i++) {
            assert_ptr_equal(tl_experiment_find((enum tl_output)output, experiment->name), experiment);
            for (const struct tl_technique *t = NULL;
                 (t = tl_experiment_next(experiment, (enum tl_output)output, t));)
                for (const struct tl_technique *u = t;
                     (u = tl_experiment_next(experiment, (enum tl_output)output, u));)
                    assert_false(strcmp(t->names[output], u->names[output]) == 0 &&
                                 (!t->group || !u->group || strcmp(t->group, u->group) == 0));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_id_has_a_section),
        cmocka_unit_test(test_sections_name_their_source),
        cmocka_unit_test(test_sections_are_titled_as_their_rows),
        cmocka_unit_test(test_no_picture_is_measured_against_itself),
        cmocka_unit_test(test_every_option_exists),
        cmocka_unit_test(test_names_are_unique),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
