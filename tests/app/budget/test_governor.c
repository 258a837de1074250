#include "app/budget/back_end.h"
#include "app/budget/governor.h"

#include "tests/testing.h"

#include <string.h>

/* The defaults and preset review, as the program starts. */
static struct tl_settings full_settings(void)
{
    struct tl_settings settings;
    tl_error error = {0};
    const struct tl_settings_source source = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    settings.detail.mode = TL_DETAIL_RELIEF;
    return settings;
}

static struct tl_settings at(enum tl_control control, uint8_t level, const struct tl_settings *full)
{
    struct tl_quality levels = {{0}};
    levels.of[control] = level;
    struct tl_settings levelled = *full;
    tl_quality_apply(&levels, &levelled);
    return levelled;
}

static void level_0_is_what_was_asked_for(void **state)
{
    (void)state;
    struct tl_settings full = full_settings(), same = at(TL_CONTROL_SCALE, 0, &full);
    assert_true(tl_settings_equal(&full, &same));
}

/* Each level changes its own setting, downwards, and no other; none changes the cloth. */
static void levels_change_their_own_setting(void **state)
{
    (void)state;
    struct tl_settings full = full_settings(), s;
    full.light.regions = 192;
    full.light.refresh = 24;
    full.light.bounce_shares = 8;
    full.detail.steps = 32;
    s = at(TL_CONTROL_REFRESH, 2, &full);
    assert_int_equal(s.light.refresh, 6);
    assert_int_equal(s.light.bounce_shares, 32);
    s.light.refresh = full.light.refresh;
    s.light.bounce_shares = full.light.bounce_shares;
    assert_true(tl_settings_equal(&full, &s));

    const int regions[] = {192, 96, 48, 24};
    for (uint8_t level = 0; level < 4; level++) {
        s = at(TL_CONTROL_REGIONS, level, &full);
        assert_int_equal(s.light.regions, regions[level]);
        assert_int_equal(s.light.refresh, 24);
        assert_int_equal(s.light.bounce_shares, 8);
    }
    s.light.regions = full.light.regions;
    assert_true(tl_settings_equal(&full, &s));

    s = at(TL_CONTROL_RELIEF, 1, &full);
    assert_int_equal(s.detail.steps, 16);
    s.detail.steps = full.detail.steps;
    assert_true(tl_settings_equal(&full, &s));

    for (int control = 0; control < TL_CONTROL_COUNT; control++) {
        s = at((enum tl_control)control, 2, &full);
        assert_memory_equal(&s.cloth, &full.cloth, sizeof s.cloth);
    }

    full.image.scale = 0.8f;
    s = at(TL_CONTROL_SCALE, 4, &full);
    assert_near(s.image.scale, 0.4, 1e-6);
    s.image.scale = full.image.scale;
    assert_true(tl_settings_equal(&full, &s));
}

/* Small settings are not made larger, nor smaller than what still works. */
static void levels_end_somewhere(void **state)
{
    (void)state;
    struct tl_settings full = full_settings();
    full.light.regions = 12;
    full.light.refresh = 1;
    full.light.bounce_shares = 64;
    full.detail.steps = 4;
    full.image.scale = 0.12f;
    for (int control = 0; control < TL_CONTROL_COUNT; control++) {
        struct tl_settings s = at((enum tl_control)control, 2, &full);
        assert_int_equal(s.light.regions, 12);
        assert_int_equal(s.light.refresh, 1);
        assert_int_equal(s.light.bounce_shares, 64);
        assert_int_equal(s.detail.steps, 4);
        assert_true(s.image.scale >= 0.1f && s.image.scale <= 0.12f);
    }
    full.light.refresh = 0; /* all */
    full.light.regions = 192;
    assert_int_equal(at(TL_CONTROL_REFRESH, 1, &full).light.refresh, 96);
}

/* Whatever the settings ask for, no level below is thought to be as good. */
static void what_is_asked_for_errs_least(void **state)
{
    (void)state;
    struct tl_settings full = full_settings();
    const int regions[] = {384, 192, 96};
    for (size_t i = 0; i < sizeof regions / sizeof *regions; i++)
        for (int control = 0; control < TL_CONTROL_COUNT; control++) {
            full.light.regions = regions[i];
            full.light.refresh = 0;
            const struct tl_render_settings drawn = tl_settings_render(&full);
            struct tl_quality levels = {{0}};
            assert_near(tl_quality_error(&levels, &drawn), 0, 0);
            for (int level = 1; level < tl_quality_count((enum tl_control)control, &drawn); level++) {
                levels.of[control] = (uint8_t)level;
                assert_true(tl_quality_error(&levels, &drawn) > 0);
            }
        }
}

/* What is offered as better errs less, from any levels; 192 regions of which 6 are renewed in a frame are
 * older than 96 are, and no better. */
static void better_levels_err_less(void **state)
{
    (void)state;
    struct tl_settings full = full_settings();
    full.light.regions = 192;
    full.light.refresh = 0;
    const struct tl_render_settings drawn = tl_settings_render(&full);
    struct tl_quality levels = {{0}};
    int none = 0, some = 0;
    for (int r = 0; r < tl_quality_count(TL_CONTROL_REGIONS, &drawn); r++)
        for (int f = 0; f < tl_quality_count(TL_CONTROL_REFRESH, &drawn); f++) {
            levels.of[TL_CONTROL_REGIONS] = (uint8_t)r, levels.of[TL_CONTROL_REFRESH] = (uint8_t)f;
            const int better = tl_quality_better(TL_CONTROL_REGIONS, &levels, &drawn);
            struct tl_quality to = levels;
            to.of[TL_CONTROL_REGIONS] = (uint8_t)(better < 0 ? 0 : better);
            const double now = tl_quality_error(&levels, &drawn), then = tl_quality_error(&to, &drawn);
            assert_true(better < 0 ? then >= now : then < now);
            assert_true(better < r);
            const struct tl_render_settings at = tl_quality_at(&levels, &drawn);
            if (at.light.regions == 96 && at.light.refresh == 6)
                assert_int_equal(better, -1);
            none += better < 0 && r > 0;
            some += better >= 0;
        }
    assert_true(none > 0 && some > 0);
}

/* ---- With a renderer, small enough to be quick ---- */

struct device {
    tl_gpu *gpu;
    tl_renderer *renderer;
    tl_environment environment;
    tl_mesh mesh;
    tl_surface surface;
    tl_material material;
};

static vec3s corners[4] = {{{-1, 0, -1}}, {{1, 0, -1}}, {{1, 0, 1}}, {{-1, 0, 1}}}, normals[4];
static vec4s tangents[4];
static vec2s uvs[4] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
static uint32_t indices[6] = {0, 2, 1, 0, 3, 2};
static struct tl_mesh_part part = {.index_count = 6};

static tl_frame frame_of(struct device *device)
{
    for (int i = 0; i < 4; i++) {
        normals[i] = (vec3s){{0, 1, 0}};
        tangents[i] = (vec4s){{1, 0, 0, 1}};
    }
    device->material = (tl_material){.name = "matt", .diffuse = {{0.5f, 0.5f, 0.5f}}};
    device->surface = (tl_surface){.name = "square",
                                   .vertex_count = 4,
                                   .positions = corners,
                                   .normals = normals,
                                   .tangents = tangents,
                                   .uvs = uvs,
                                   .index_count = 6,
                                   .indices = indices,
                                   .part_count = 1,
                                   .parts = &part,
                                   .materials = &device->material,
                                   .topology_revision = 1};
    return (tl_frame){
        .camera = {.eye = {{0, 2, 3}}, .up = {{0, 1, 0}}, .fov_y = 0.7f, .near_m = 0.1f, .far_m = 20},
        .surfaces = &device->surface,
        .surface_count = 1,
        .environment = &device->environment,
        .environment_revision = 1};
}

static int open_device(void **state)
{
    static struct device device;
    tl_error error = {0};
    device.gpu = tl_gpu_create_headless(&error);
    device.renderer = device.gpu ? tl_renderer_create(device.gpu, &error) : NULL;
    device.environment = tl_environment_constant(1, 1, 1);
    *state = &device;
    return device.renderer ? 0 : -1;
}

static int close_device(void **state)
{
    struct device *device = *state;
    tl_renderer_destroy(&device->renderer);
    tl_environment_release(&device->environment);
    tl_gpu_destroy(&device->gpu);
    return 0;
}

static struct tl_settings small_settings(void)
{
    struct tl_settings settings = full_settings();
    settings.image.width = settings.image.height = 640;
    settings.image.supersample = 1;
    settings.light.regions = 48;
    settings.light.pem_size = 16;
    return settings;
}

/* Lit at every sample, so that fewer of them cost a fraction whatever else the machine does. */
static struct tl_settings sampled_settings(void)
{
    struct tl_settings settings = small_settings();
    settings.image.width = settings.image.height = 256;
    settings.light.visibility = TL_VISIBILITY_VSM;
    return settings;
}

/* Whether anything but the ratio is reduced. What is worth reducing, the machine decides. */
static bool is_reduced(const struct tl_quality *levels)
{
    bool is_any = false;
    for (int k = TL_CONTROL_RATIO + 1; k < TL_CONTROL_COUNT; k++)
        is_any |= levels->of[k] > 0;
    return is_any;
}

/* The first frame saves the ratios at samples and nothing else; after it, as nothing was drawn, the table's
 * costs decide. No budget gives everything, none at all the least. */
static void budgets_are_kept_to(void **state)
{
    struct device *device = *state;
    tl_renderer *fresh;
    tl_error error = {0};
    const struct tl_settings settings = small_settings();
    tl_frame frame = frame_of(device);
    fresh = tl_renderer_create(device->gpu, &error);
    assert_non_null(fresh);
    double before = INFINITY;
    const double budgets[] = {1e-3, 5, 10, 20, 50, 200, 1e6};
    for (size_t i = 0; i < sizeof budgets / sizeof *budgets; i++) {
        tl_quality_governor *governor = tl_quality_governor_create(budgets[i]);
        struct tl_quality_choice choice = tl_quality_governor_choose(governor, fresh, &frame, &settings);
        assert_true(isnan(choice.predicted_ms));
        for (int k = 0; k < TL_CONTROL_COUNT; k++)
            assert_int_equal(choice.levels.of[k], k == TL_CONTROL_RATIO);
        tl_quality_governor_learn(governor, tl_renderer_last_plan(fresh), 0, 0);
        choice = tl_quality_governor_choose(governor, fresh, &frame, &settings);
        assert_true(choice.error <= before);
        before = choice.error;
        assert_true(i > 0 || is_reduced(&choice.levels));
        tl_quality_governor_destroy(&governor);
    }
    assert_near(before, 0, 0);
    tl_quality_governor *governor = tl_quality_governor_create(0);
    assert_near(tl_quality_governor_choose(governor, fresh, &frame, &settings).error, 0, 0);
    tl_quality_governor_destroy(&governor);
    tl_renderer_destroy(&fresh);
}

/* Draws as fly and the window do; what frames "took" is made up, and dearer than any budget. */
static struct tl_quality_choice draw_frame(struct device *device, tl_quality_governor *governor,
                                           const tl_frame *frame, double total_ms)
{
    tl_error error = {0};
    const struct tl_settings settings = sampled_settings();
    struct tl_quality_choice choice =
        tl_quality_governor_choose(governor, device->renderer, frame, &settings);
    const struct tl_render_settings full = tl_settings_render(&settings);
    const struct tl_render_settings drawn = tl_quality_at(&choice.levels, &full);
    assert_ok(tl_renderer_draw(device->renderer, frame, &drawn, &error), error);
    tl_quality_governor_learn(governor, tl_renderer_last_plan(device->renderer), 0.5, total_ms);
    return choice;
}

/* In motion a budget that nothing fits sheds everything; three frames after the camera stopped the image is
 * whole again; and a camera that moves on is seen before it is drawn. */
static void rest_gives_everything_back(void **state)
{
    struct device *device = *state;
    tl_quality_governor *governor = tl_quality_governor_create(1e-3);
    tl_frame frame = frame_of(device);
    struct tl_quality_choice choice;
    for (int i = 0; i < 6; i++) {
        frame.camera.eye.x += 0.01f;
        choice = draw_frame(device, governor, &frame, 50);
        assert_true(i == 0 ? isnan(choice.lasting_ms) : choice.lasting_ms <= choice.min_ms); /* to the bit */
        assert_true(i == 0 || choice.lasting_ms <= choice.predicted_ms);
    }
    assert_true(is_reduced(&choice.levels));
    assert_true(isfinite(choice.predicted_ms));
    for (int i = 0; i < 5; i++)
        choice = draw_frame(device, governor, &frame, 50);
    assert_near(choice.error, 0, 0);
    frame.camera.eye.x += 0.01f;
    choice = draw_frame(device, governor, &frame, 50);
    assert_true(is_reduced(&choice.levels));
    tl_quality_governor_destroy(&governor);
}

/* The last levels, one by one. */
static void steps_tell_what_a_level_is_worth(void **state)
{
    struct device *device = *state;
    const struct tl_settings settings = sampled_settings();
    tl_quality_governor *governor = tl_quality_governor_create(1e-3);
    tl_frame frame = frame_of(device);
    for (int i = 0; i < 6; i++) {
        frame.camera.eye.x += 0.01f;
        draw_frame(device, governor, &frame, 50);
    }
    struct tl_quality_step steps[TL_CONTROL_COUNT];
    tl_quality_governor_steps(governor, device->renderer, &frame, &settings, steps);
    bool saves = false;
    for (int k = 0; k < TL_CONTROL_COUNT; k++) {
        assert_in_range(steps[k].level, 0, steps[k].level_count - 1);
        assert_true(isnan(steps[k].error) || (steps[k].level > 0 && steps[k].error > 0));
        saves |= k > TL_CONTROL_RATIO && steps[k].ms > 0;
    }
    assert_true(saves);
    assert_near(steps[TL_CONTROL_REFRESH].value, 24 >> steps[TL_CONTROL_REFRESH].level, 0);
    tl_quality_governor_destroy(&governor);
}

/* What motion may ask for is there before it begins, so that no frame of it prepares regions: one level a
 * call, once the environment stays, and nothing without a budget. */
static void regions_are_prepared_at_rest(void **state)
{
    struct device *device = *state;
    tl_error error = {0};
    tl_renderer *fresh = tl_renderer_create(device->gpu, &error);
    assert_non_null(fresh);
    struct tl_settings settings = small_settings();
    settings.image.width = settings.image.height = 64;
    settings.light.regions = 192;
    const struct tl_render_settings full = tl_settings_render(&settings);
    const tl_frame frame = frame_of(device);
    assert_ok(tl_renderer_draw(fresh, &frame, &full, &error), error);
    tl_quality_governor *none = tl_quality_governor_create(0);
    for (int i = 0; i < 3; i++)
        assert_false(tl_quality_governor_prepare(none, fresh, &frame, &settings));
    tl_quality_governor_destroy(&none);
    tl_quality_governor *governor = tl_quality_governor_create(50);
    assert_false(tl_quality_governor_prepare(governor, fresh, &frame, &settings)); /* may be one of many */
    const int levels = tl_quality_count(TL_CONTROL_REGIONS, &full);
    for (int level = 1; level < levels; level++) {
        struct tl_quality of = {.of[TL_CONTROL_REGIONS] = (uint8_t)(levels - level)};
        const struct tl_render_settings then = tl_quality_at(&of, &full);
        assert_false(tl_renderer_has_regions(fresh, &then));
        assert_true(tl_quality_governor_prepare(governor, fresh, &frame, &settings));
        assert_true(tl_renderer_has_regions(fresh, &then));
    }
    assert_int_equal(levels, 4);
    assert_false(tl_quality_governor_prepare(governor, fresh, &frame, &settings));
    tl_quality_governor_destroy(&governor);
    tl_renderer_destroy(&fresh);
}

static tl_image picture_of(tl_renderer *renderer, const tl_frame *frame, const struct tl_settings *settings)
{
    tl_image image = {0};
    tl_error error = {0};
    const struct tl_render_settings drawn = tl_settings_render(settings);
    assert_ok(tl_renderer_draw(renderer, frame, &drawn, &error), error);
    assert_ok(tl_renderer_read(renderer, &image, &error), error);
    return image;
}

static bool has_run(const tl_plan *plan, const char *name)
{
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, name) == 0)
            return plan->rows[i].action == TL_JOB_RUN;
    return false;
}

/* Both back-ends are timed by frames that are really drawn; the picture after them is that of a new renderer,
 * by rays and by maps. */
static void calibration_leaves_no_trace(void **state)
{
    (void)state;
    struct device *device = *state;
    tl_error error = {0};
    const tl_frame frame = frame_of(device);
    const double budgets_ms[] = {1e6, 1e-3};
    for (size_t i = 0; i < 2; i++) {
        tl_renderer *used = tl_renderer_create(device->gpu, &error),
                    *fresh = tl_renderer_create(device->gpu, &error);
        assert_true(used && fresh);
        struct tl_settings settings = small_settings();
        settings.image.width = settings.image.height = 64;
        settings.material.model = TL_REFLECT_PHONG;
        assert_int_equal(settings.light.visibility, TL_VISIBILITY_AUTO);
        const struct tl_back_end_start start = {.renderer = used,
                                                .frame = &frame,
                                                .budget_ms = budgets_ms[i],
                                                .is_software = true,
                                                .measures_both = true};
        struct tl_back_end chosen;
        assert_ok(tl_back_end_calibrate(&start, &settings, &chosen, &error), error);
        assert_true(chosen.rays_ms > 0 && chosen.rays_ms < INFINITY);
        assert_true(chosen.maps_ms > 0 && chosen.maps_ms < INFINITY);
        assert_true(i > 0 || settings.light.visibility == TL_VISIBILITY_AUTO);
        assert_true(has_run(tl_renderer_last_plan(used), "maps")); /* maps are timed last, as in motion */
        for (int visibility = TL_VISIBILITY_VSM; visibility <= TL_VISIBILITY_AUTO; visibility++) {
            settings.light.visibility = visibility;
            tl_image a = picture_of(used, &frame, &settings), b = picture_of(fresh, &frame, &settings);
            assert_memory_equal(a.texels, b.texels, sizeof(float) * 4 * 64 * 64);
            tl_image_release(&a);
            tl_image_release(&b);
        }
        tl_renderer_destroy(&used);
        tl_renderer_destroy(&fresh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(level_0_is_what_was_asked_for),
        cmocka_unit_test(levels_change_their_own_setting),
        cmocka_unit_test(levels_end_somewhere),
        cmocka_unit_test(what_is_asked_for_errs_least),
        cmocka_unit_test(better_levels_err_less),
        cmocka_unit_test(budgets_are_kept_to),
        cmocka_unit_test(rest_gives_everything_back),
        cmocka_unit_test(regions_are_prepared_at_rest),
        cmocka_unit_test(steps_tell_what_a_level_is_worth),
        cmocka_unit_test(calibration_leaves_no_trace),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
