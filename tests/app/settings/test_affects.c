/* A new option is one row. The test adds an option to a table, as a contributor would, and everything that
 * asks what an option affects takes notice of it: reloading, appearances, sliders, recorded flights, the
 * inputs of a frame. The linker puts the wrapped functions in place of those that bind the tables (--wrap).
 */
#include "tests/testing.h"

#include "app/lab/flight/fly_account.h"
#include "app/scene/session.h"
#include "config/base/memory.h"
#include "render/frame/resources.h"
#include "render/plan/affects.h"

#include <stdlib.h>
#include <string.h>

#define ROWS_MAX 64

/* A table with one row more. */
struct extended {
    struct tl_option rows[ROWS_MAX];
    struct tl_option_table table;
};
static struct extended scene, image;
static uint64_t affects; /* the new row's column; 0: there is no new row */

static const struct tl_option_table *extend(struct extended *out, const struct tl_option_table *table,
                                            enum tl_option_type type, size_t offset)
{
    assert_true(table->row_count < ROWS_MAX);
    memcpy(out->rows, table->rows, table->row_count * sizeof *table->rows);
    out->rows[table->row_count] = (struct tl_option){
        .name = "throwaway", .type = type, .offset = offset, .affects = affects, .unit = "", .help = ""};
    out->table = *table;
    out->table.rows = out->rows;
    out->table.row_count++;
    return &out->table;
}

/* Fields of rows that affect nothing that is asked for here, so that a change is seen through the new row. */
#define SETTINGS_OFFSET offsetof(struct tl_settings, camera.yaw_deg)
#define IMAGE_OFFSET    offsetof(struct tl_image_params, legend)

void __real_tl_settings_bind(struct tl_settings *settings, struct tl_binding bindings[TL_SETTINGS_TABLES]);
void __wrap_tl_settings_bind(struct tl_settings *settings, struct tl_binding bindings[TL_SETTINGS_TABLES]);
void __real_tl_render_settings_bind(struct tl_render_settings *settings,
                                    struct tl_binding bindings[TL_RENDER_TABLES]);
void __wrap_tl_render_settings_bind(struct tl_render_settings *settings,
                                    struct tl_binding bindings[TL_RENDER_TABLES]);

void __wrap_tl_settings_bind(struct tl_settings *settings, struct tl_binding bindings[TL_SETTINGS_TABLES])
{
    __real_tl_settings_bind(settings, bindings);
    assert_ptr_equal(bindings[0].params, settings); /* the scene's: the first of all settings */
    if (affects)
        bindings[0].table = extend(&scene, bindings[0].table, TL_FLOAT, SETTINGS_OFFSET);
}

void __wrap_tl_render_settings_bind(struct tl_render_settings *settings,
                                    struct tl_binding bindings[TL_RENDER_TABLES])
{
    __real_tl_render_settings_bind(settings, bindings);
    for (size_t i = 0; affects && i < TL_RENDER_TABLES; i++)
        if (bindings[i].table == &tl_image_options)
            bindings[i].table = extend(&image, &tl_image_options, TL_BOOL, IMAGE_OFFSET);
}

static struct tl_settings load(void)
{
    const struct tl_settings_source source = {0};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    return settings;
}

/* The settings with another value of the new option. */
static struct tl_settings changed(const struct tl_settings *settings)
{
    struct tl_settings result = *settings;
    result.camera.yaw_deg += 1;
    return result;
}

static const uint64_t without = TL_AFFECTS_NOTHING;

static void scenes_follow_a_new_row(void **state)
{
    (void)state;
    struct tl_settings old = load(), new = changed(&old);
    affects = without;
    assert_false(tl_session_needs_scene(&old, &new));
    assert_false(tl_session_needs_light(&old, &new));
    affects = TL_AFFECTS_ENVIRONMENT;
    assert_true(tl_session_needs_light(&old, &new));
    affects = TL_AFFECTS_SCENE;
    assert_true(tl_session_needs_scene(&old, &new));

    struct tl_settings kept = new;
    affects = without;
    tl_session_keep_scene(&old, &kept);
    assert_false(tl_settings_equal(&kept, &old));
    affects = TL_AFFECTS_SCENE;
    tl_session_keep_scene(&old, &kept);
    affects = 0;
    assert_true(tl_settings_equal(&kept, &old));
}

static void appearances_follow_a_new_row(void **state)
{
    (void)state;
    struct tl_settings old = load(), new = changed(&old);
    affects = without;
    assert_true(tl_appearance_is_same(&old, &new));
    affects = TL_AFFECTS_MATERIALS;
    assert_false(tl_appearance_is_same(&old, &new));

    affects = without;
    assert_false(tl_session_needs_appearance(&old, &new));
    affects = TL_AFFECTS_APPEARANCE;
    assert_true(tl_session_needs_appearance(&old, &new));
}

/* The row of the camera says AT_ONCE, the new one does not. */
static void sliders_follow_a_new_row(void **state)
{
    (void)state;
    struct tl_settings old = load(), new = changed(&old);
    affects = 0;
    assert_false(tl_settings_differ_slowly(&old, &new));
    affects = TL_AFFECTS_MATERIALS | TL_AFFECTS_AT_ONCE;
    assert_false(tl_settings_differ_slowly(&old, &new));
    affects = TL_AFFECTS_MATERIALS;
    assert_true(tl_settings_differ_slowly(&old, &new));
}

/* The record is of a flight of the same program without the new option. */
static void recorded_flights_follow_a_new_row(void **state)
{
    (void)state;
    struct tl_settings settings = load();
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    struct tl_flight_record record = {.settings = cJSON_CreateObject()};
    tl_error error = {0};
    affects = 0;
    tl_settings_bind(&settings, bindings);
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++)
        for (size_t r = 0; r < bindings[t].table->row_count; r++) {
            char *key = tl_format("%s.%s", bindings[t].table->name, bindings[t].table->rows[r].name);
            char *text = tl_options_get_text(&bindings[t], &bindings[t].table->rows[r]);
            cJSON_AddStringToObject(record.settings, key, text);
            free(text);
            free(key);
        }
    assert_ok(tl_flight_record_suits(&record, "earlier", &settings, true, &error), error);
    affects = without;
    assert_ok(tl_flight_record_suits(&record, "earlier", &settings, false, &error), error);
    assert_false(tl_flight_record_suits(&record, "earlier", &settings, true, &error));
    assert_non_null(strstr(error.message, "scene.throwaway"));
    affects = TL_AFFECTS_WORK;
    assert_false(tl_flight_record_suits(&record, "earlier", &settings, false, &error));
    assert_non_null(strstr(error.message, "scene.throwaway"));
    cJSON_Delete(record.settings);
}

/* Sets the inputs of a frame without surfaces, and computes their hashes. */
static void compute_inputs(const struct tl_render_settings *settings, struct tl_resources *resources,
                           uint64_t hashes[TL_INPUT_COUNT])
{
    const tl_environment place = {0};
    const tl_frame frame = {.camera = {.target = {{0, 0, -1}}, .up = {{0, 1, 0}}}, .environment = &place};
    const uint64_t zero[TL_INPUT_COUNT] = {0};
    struct tl_rest rest = {0};
    tl_frame_hash_inputs(&frame, settings, 0, zero, &rest, hashes);
    tl_inputs_set(resources, &frame, settings, 0, &rest, hashes);
    free(resources->shapes.drawn);
    tl_triangle_ranges_release(&resources->shapes.ranges);
    resources->shapes.drawn = NULL;
}

/* The new row of table image in the inputs that hold this table; every row that there is, in all inputs:
 * tests/render/frame/test_inputs.c. */
static void inputs_follow_a_new_row(void **state)
{
    (void)state;
    static struct tl_resources resources;
    const struct {
        uint64_t bit;
        enum tl_resource input;
        const bool *field;
    } cases[] = {
        {TL_AFFECTS_SIZE, TL_INPUT_SIZE, &resources.size.options.legend},
        {TL_AFFECTS_GROUND, TL_INPUT_GROUND, &resources.ground_input.options.legend},
        {TL_AFFECTS_SHOW, TL_INPUT_SHOW, &resources.show_options.legend},
        {TL_AFFECTS_VIEW, TL_INPUT_VIEW, &resources.view_options.legend},
        {TL_AFFECTS_VIEW_SCALE, TL_INPUT_VIEW, &resources.view_options.legend},
    };
    affects = 0;
    struct tl_settings loaded = load();
    struct tl_render_settings settings = tl_settings_render(&loaded);
    uint64_t off[TL_INPUT_COUNT], on[TL_INPUT_COUNT];
    settings.image.view = TL_VIEW_VISIBILITY;
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        affects = cases[i].bit;
        settings.image.legend = false;
        compute_inputs(&settings, &resources, off);
        assert_false(*cases[i].field);
        settings.image.legend = true;
        compute_inputs(&settings, &resources, on);
        assert_true(*cases[i].field);
        assert_int_not_equal(off[cases[i].input], on[cases[i].input]);
        affects = TL_AFFECTS_NOTHING;
        compute_inputs(&settings, &resources, on);
        assert_false(*cases[i].field);
    }
    affects = TL_AFFECTS_VIEW_SCALE;
    settings.image.view = TL_VIEW_LIGHT;
    settings.image.legend = false;
    compute_inputs(&settings, &resources, off);
    settings.image.legend = true;
    compute_inputs(&settings, &resources, on);
    assert_memory_equal(off, on, sizeof off);
}

/* Each row of each table has its column, and a table of the renderer is bound for the inputs as well. */
static void every_row_says_what_it_affects(void **state)
{
    (void)state;
    affects = 0;
    struct tl_settings settings = load();
    struct tl_render_settings render = tl_settings_render(&settings);
    struct tl_binding all[TL_SETTINGS_TABLES], drawn[TL_RENDER_TABLES];
    tl_settings_bind(&settings, all);
    tl_render_settings_bind(&render, drawn);
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++) {
        bool is_drawn = false;
        for (size_t d = 0; d < TL_RENDER_TABLES; d++)
            is_drawn = is_drawn || drawn[d].table == all[t].table;
        for (size_t r = 0; r < all[t].table->row_count; r++) {
            const struct tl_option *row = &all[t].table->rows[r];
            bool is_input = row->affects >> TL_AFFECTS_RENDER != 0;
            if (row->affects == 0 || (is_input && !is_drawn))
                fail_msg("%s.%s: affects 0x%llx", all[t].table->name, row->name,
                         (unsigned long long)row->affects);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_follow_a_new_row),  cmocka_unit_test(appearances_follow_a_new_row),
        cmocka_unit_test(sliders_follow_a_new_row), cmocka_unit_test(recorded_flights_follow_a_new_row),
        cmocka_unit_test(inputs_follow_a_new_row),  cmocka_unit_test(every_row_says_what_it_affects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
