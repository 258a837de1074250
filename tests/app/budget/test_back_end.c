#include "app/budget/back_end.h"

#include "app/budget/quality.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <string.h>

/* A machine whose frames take these times; counts how often each back-end was measured. */
struct machine {
    double ms[TL_VISIBILITY_AUTO];
    int measured[TL_VISIBILITY_AUTO];
    int fails; /* the back-end that cannot be measured; AUTO: none */
};

static bool measure(void *context, int visibility, double *ms, tl_error *error)
{
    struct machine *machine = context;
    machine->measured[visibility]++;
    *ms = machine->ms[visibility];
    return visibility != machine->fails || tl_fail(error, TL_USAGE, "broken");
}

static struct tl_back_end choose(struct machine *machine, struct tl_back_end_request request)
{
    struct tl_back_end chosen;
    tl_error error = {0};
    request.measure = measure;
    request.context = machine;
    machine->fails = TL_VISIBILITY_AUTO;
    assert_ok(tl_back_end_choose(&request, &chosen, &error), error);
    assert_int_equal(isfinite(chosen.rays_ms), machine->measured[TL_VISIBILITY_RAYS]);
    assert_int_equal(isfinite(chosen.maps_ms), machine->measured[TL_VISIBILITY_VSM]);
    assert_non_null(strstr(chosen.reason, "light.visibility"));
    assert_null(strchr(chosen.reason, '\n'));
    return chosen;
}

/* Of 50 ms drawing has 30. */
static void times_decide(void **state)
{
    (void)state;
    static const struct {
        double rays_ms, maps_ms;
        int chosen;
        bool measures_maps;
    } rows[] = {
        {10, 1, TL_VISIBILITY_RAYS, false},  /* rays hold it: maps are not even tried */
        {30, 1, TL_VISIBILITY_RAYS, false},  /* ... just */
        {31, 29, TL_VISIBILITY_VSM, true},   /* rays do not, maps do */
        {31, 30, TL_VISIBILITY_VSM, true},   /* ... just */
        {31, 31, TL_VISIBILITY_RAYS, true},  /* a tie that holds nothing */
        {200, 67, TL_VISIBILITY_RAYS, true}, /* neither does, and maps gain less than three times */
        {210, 70, TL_VISIBILITY_VSM, true},  /* ... three times */
        {31, 300, TL_VISIBILITY_RAYS, true}, /* as on a CPU */
    };
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        struct machine machine = {
            .ms = {[TL_VISIBILITY_VSM] = rows[i].maps_ms, [TL_VISIBILITY_RAYS] = rows[i].rays_ms}};
        const struct tl_back_end_request request = {.budget_ms = 50};
        assert_int_equal(choose(&machine, request).visibility, rows[i].chosen);
        assert_int_equal(machine.measured[TL_VISIBILITY_VSM], rows[i].measures_maps);
        assert_int_equal(machine.measured[TL_VISIBILITY_DEPTH], 0);
    }
}

/* What is known needs no measurement: without a budget, with GL on the CPU, with materials that maps do not
 * show. */
static void what_is_known_is_not_measured(void **state)
{
    (void)state;
    const struct tl_back_end_request known[] = {{.budget_ms = 0},
                                                {.budget_ms = 50, .is_software = true},
                                                {.budget_ms = 50, .needs_rays = true},
                                                {.budget_ms = 0, .measures_both = true},
                                                {.budget_ms = 50, .needs_rays = true, .measures_both = true}};
    for (size_t i = 0; i < TL_COUNT(known); i++) {
        struct machine machine = {.ms = {[TL_VISIBILITY_VSM] = 1, [TL_VISIBILITY_RAYS] = 1000}};
        assert_int_equal(choose(&machine, known[i]).visibility, TL_VISIBILITY_RAYS);
        assert_int_equal(machine.measured[TL_VISIBILITY_RAYS], 0);
    }
    struct machine asked = {.ms = {[TL_VISIBILITY_VSM] = 20, [TL_VISIBILITY_RAYS] = 10}};
    const struct tl_back_end_request both = {.budget_ms = 50, .is_software = true, .measures_both = true};
    const struct tl_back_end chosen = choose(&asked, both);
    assert_int_equal(chosen.visibility, TL_VISIBILITY_RAYS);
    assert_near(chosen.rays_ms, 10, 0);
    assert_near(chosen.maps_ms, 20, 0);
    assert_non_null(strstr(chosen.reason, "rays take 10.0 ms, shadow maps 20.0 ms, of 30.0 ms"));
}

static void a_failure_is_passed_on(void **state)
{
    (void)state;
    for (int fails = 0; fails < TL_VISIBILITY_AUTO; fails += TL_VISIBILITY_RAYS) {
        struct machine machine = {.ms = {[TL_VISIBILITY_RAYS] = 1000}, .fails = fails};
        const struct tl_back_end_request request = {.budget_ms = 50, .measure = measure, .context = &machine};
        struct tl_back_end chosen;
        tl_error error = {0};
        assert_false(tl_back_end_choose(&request, &chosen, &error));
        assert_string_equal(error.message, "broken");
    }
}

/* Auto is what the presets of rays say; the renderer never sees it, and levels keep it. */
static void auto_is_rays_unless_chosen(void **state)
{
    (void)state;
    const char *const presets[] = {"scene.preset=review", "scene.preset=draft"};
    for (size_t i = 0; i < TL_COUNT(presets); i++) {
        const struct tl_settings_source source = {.assignments = &presets[i], .assignment_count = 1};
        struct tl_settings settings;
        tl_error error = {0};
        assert_ok(tl_settings_load(&settings, &source, &error), error);
        assert_int_equal(settings.light.visibility, TL_VISIBILITY_AUTO);
        assert_int_equal(tl_settings_render(&settings).light.visibility, TL_VISIBILITY_RAYS);
        const struct tl_quality levels = {.of[TL_CONTROL_RATIO] = 1};
        tl_quality_apply(&levels, &settings);
        assert_int_equal(settings.light.visibility, TL_VISIBILITY_AUTO);
    }
}

static void fabrics_that_maps_do_not_show_need_rays(void **state)
{
    (void)state;
    static const struct {
        const char *fabric;
        bool needs_rays;
    } rows[] = {
        {"scene.fabric=cotton_plain", false}, {"scene.fabric=satin", true}, {"material.coat=0.5", true}};
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        const struct tl_settings_source source = {.assignments = &rows[i].fabric, .assignment_count = 1};
        struct tl_settings settings;
        tl_error error = {0};
        assert_ok(tl_settings_load(&settings, &source, &error), error);
        assert_int_equal(tl_settings_need_rays(&settings), rows[i].needs_rays);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(times_decide),
        cmocka_unit_test(what_is_known_is_not_measured),
        cmocka_unit_test(a_failure_is_passed_on),
        cmocka_unit_test(auto_is_rays_unless_chosen),
        cmocka_unit_test(fabrics_that_maps_do_not_show_need_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
