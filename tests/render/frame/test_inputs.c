/* An option is one row: its value reaches the input that its column `affects` names, and the input's hash
 * changes with it. Every row of every table of the renderer is set to another value in turn. The table of
 * this file names the place where a job finds the options of each bit. */
#include "config/base/memory.h"
#include "render/frame/inputs.h"
#include "render/frame/resources.h"
#include "render/plan/affects.h"
#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

static struct tl_resources resources;

static const struct {
    uint64_t bit;
    enum tl_resource input;
    const void *place; /* params of the row's table */
} places[] = {
    {TL_AFFECTS_SIZE, TL_INPUT_SIZE, &resources.size.options},
    {TL_AFFECTS_GROUND, TL_INPUT_GROUND, &resources.ground_input.options},
    {TL_AFFECTS_PEM_SIZE, TL_INPUT_PEM_SIZE, &resources.pem_options},
    {TL_AFFECTS_FILTER, TL_INPUT_FILTER, &resources.filter_options},
    {TL_AFFECTS_SUN, TL_INPUT_SUN, &resources.sun_options},
    {TL_AFFECTS_REGIONS, TL_INPUT_REGIONS, &resources.cut_options},
    {TL_AFFECTS_PASSES, TL_INPUT_PASSES, &resources.storage_options},
    {TL_AFFECTS_SHADOW_MAPS, TL_INPUT_MAPS, &resources.shadows.options},
    {TL_AFFECTS_RAYS, TL_INPUT_RAYS, &resources.rays.options},
    {TL_AFFECTS_LIGHT, TL_INPUT_LIGHT, &resources.light_options},
    {TL_AFFECTS_LAMPS, TL_INPUT_LAMPS, &resources.lamps.shading},
    {TL_AFFECTS_REFERENCE, TL_INPUT_REFERENCE, &resources.reference_options},
    {TL_AFFECTS_DETAIL, TL_INPUT_DETAIL, &resources.detail_steps},
    {TL_AFFECTS_DETAIL_MAPS, TL_INPUT_DETAIL_MAPS, &resources.detail_options},
    {TL_AFFECTS_SHOW, TL_INPUT_SHOW, &resources.show_options},
    {TL_AFFECTS_ENVMAP, TL_INPUT_ENVMAP, &resources.envmap_input.options},
    {TL_AFFECTS_LAYOUT, TL_INPUT_LAYOUT, &resources.layout_options},
    {TL_AFFECTS_LOOK_UP, TL_INPUT_LOOK_UP, &resources.look_up_options},
    {TL_AFFECTS_CAPTURE, TL_INPUT_CAPTURE, &resources.capture_options},
    {TL_AFFECTS_VIEW, TL_INPUT_VIEW, &resources.view_options},
    {TL_AFFECTS_VIEW_SCALE, TL_INPUT_VIEW, &resources.view_options},
    {TL_AFFECTS_RATIO, TL_INPUT_RATIO, &resources.ratio_options},
};

/* Settings under which every input depends on its options: a view has a scale, and the scene is captured. */
static void make_settings(struct tl_render_settings *out, struct tl_binding bindings[TL_RENDER_TABLES])
{
    tl_render_settings_bind(out, bindings);
    tl_options_reset(bindings, TL_RENDER_TABLES);
    out->image.view = TL_VIEW_VISIBILITY;
    out->light.method = TL_METHOD_MAPS;
    out->maps.capture_every = 1;
}

/* A value that differs from the present one and from 0. */
static void change(const struct tl_option *row, void *params)
{
    char *field = (char *)params + row->offset;
    float component = 0.5f;
    switch (row->type) {
    case TL_BOOL:
        *(bool *)field = !*(bool *)field;
        break;
    case TL_INT:
    case TL_ENUM:
        *(int *)field = *(int *)field == 1 ? 2 : 1;
        break;
    case TL_DOUBLE:
        *(double *)field += 0.25;
        break;
    case TL_FLOAT:
        *(float *)field += 0.25f;
        break;
    case TL_COLOUR:
    case TL_VECTOR:
        memcpy(field, &component, sizeof component);
        break;
    default:
        fail_msg("%s: no input holds text", row->name);
    }
}

static void compute_inputs(const struct tl_render_settings *settings, uint64_t hashes[TL_INPUT_COUNT])
{
    const struct tl_lamp lamp = {
        .kind = TL_LAMP_DIRECTIONAL, .direction = {{0, 1, 0}}, .irradiance = {{1, 1, 1}}};
    const tl_environment place = {0};
    const tl_frame frame = {.camera = {.target = {{0, 0, -1}}, .up = {{0, 1, 0}}},
                            .environment = &place,
                            .lamps = &lamp,
                            .lamp_count = 1};
    const uint64_t before[TL_INPUT_COUNT] = {0};
    struct tl_rest rest = {0};
    tl_frame_hash_inputs(&frame, settings, 0, before, &rest, hashes);
    tl_inputs_set(&resources, &frame, settings, 0, &rest, hashes);
}

/* Fails unless every input that the row affects holds its value, and, if there are hashes, another hash. */
static void check_row(const struct tl_binding *binding, const struct tl_option *row, const uint64_t *before,
                      const uint64_t *after)
{
    for (size_t i = 0; i < TL_COUNT(places); i++) {
        if (!(row->affects & places[i].bit))
            continue;
        if (!tl_option_equal(row, (const char *)places[i].place + row->offset,
                             (const char *)binding->params + row->offset))
            fail_msg("%s.%s is not in the input %s", binding->table->name, row->name,
                     tl_resource_names[places[i].input]);
        if (before && before[places[i].input] == after[places[i].input])
            fail_msg("%s.%s changes, and the hash of the input %s does not", binding->table->name, row->name,
                     tl_resource_names[places[i].input]);
    }
}

static void a_row_reaches_the_inputs_that_it_affects(void **state)
{
    (void)state;
    struct tl_render_settings settings;
    struct tl_binding bindings[TL_RENDER_TABLES];
    uint64_t before[TL_INPUT_COUNT], after[TL_INPUT_COUNT], bits = 0;
    make_settings(&settings, bindings);
    const struct tl_render_settings unchanged = settings;
    for (size_t t = 0; t < TL_RENDER_TABLES; t++)
        for (size_t r = 0; r < bindings[t].table->row_count; r++) {
            const struct tl_option *row = &bindings[t].table->rows[r];
            bits |= row->affects;
            if (row->affects >> TL_AFFECTS_RENDER == 0)
                continue;
            settings = unchanged;
            compute_inputs(&settings, before);
            check_row(&bindings[t], row, NULL, NULL);
            change(row, bindings[t].params);
            compute_inputs(&settings, after);
            check_row(&bindings[t], row, before, after);
        }
    for (size_t i = 0; i < TL_COUNT(places); i++)
        bits &= ~places[i].bit;
    assert_int_equal(bits >> TL_AFFECTS_RENDER, 0); /* no row has a bit that this file does not know */
}

/* A job that reads an option which its input does not hold finds 0, and reruns for no such option. */
static void an_input_holds_no_other_row(void **state)
{
    (void)state;
    struct tl_render_settings settings;
    struct tl_binding bindings[TL_RENDER_TABLES];
    uint64_t before[TL_INPUT_COUNT], after[TL_INPUT_COUNT];
    make_settings(&settings, bindings);
    settings.light.rounds = 1;
    compute_inputs(&settings, before);
    settings.light.rounds = 7; /* affects no input */
    settings.image.legend = !settings.image.legend;
    compute_inputs(&settings, after);
    for (int i = 0; i < TL_INPUT_COUNT; i++)
        assert_int_equal(before[i], after[i]);
    assert_int_equal(resources.light_options.rounds, 0);
    assert_int_equal(resources.light_options.pem_size, 0);
    assert_int_equal(resources.pem_options.regions, 0);
    assert_int_equal(resources.detail_options.steps, 0);
    assert_false(resources.show_options.legend);
    assert_int_equal(resources.show_options.width, 0);
    free(resources.shapes.drawn);
    tl_triangle_ranges_release(&resources.shapes.ranges);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_row_reaches_the_inputs_that_it_affects),
        cmocka_unit_test(an_input_holds_no_other_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
