/* Gloss from tables on the GPU: against the formula, and against render/brdf's own look-up; one pass against
 * several. Rows A1 to A5 and A7. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/brdf/tables/tables.h"

#include "tests/testing.h"

static const char *const models[] = {"phong", "blinn_phong", "cosine_lobe", "torrance_sparrow",
                                     "ward",  "banks"};

/* Bent towards the viewer, so that little of it is seen at grazing angles. */
static struct test_shape specimen(int model)
{
    struct test_shape shape = test_sheet(0, 0.8f, 0.08f, 1.5f, 48);
    shape.material.diffuse = (vec3s){{0, 0, 0}};
    shape.material.specular = (vec3s){{0.3f, 0.2f, 0.1f}};
    shape.material.glossiness = 0.9f;
    shape.material.gloss = (struct tl_gloss){.model = model,
                                             .facets = TL_FACETS_BECKMANN,
                                             .width_weft = 0.3f,
                                             .width_warp = 0.15f,
                                             .rotation = 0.3f,
                                             .index = 1.5f};
    return shape;
}

static void open_scene(struct test_scene *scene, int model)
{
    test_scene_open_lamplit(scene, specimen(model), 96, 96);
    scene->frame.camera.eye = (vec3s){{0, 1.9f, 0.9f}};
    scene->lamps[0] = test_lamp_towards((vec3s){{0.3f, 1, -0.5f}}, 3);
}

/* The limit is half a percent for float tables of 512^2, without the diffuse light. */
static void tables_are_near_the_formula(void **state)
{
    struct test_device *device = *state;
    static const struct {
        int precision, size;
    } tables[] = {{TL_PRECISION_FLOAT, 64},
                  {TL_PRECISION_FLOAT, 512},
                  {TL_PRECISION_FLOAT, 256},
                  {TL_PRECISION_FIXED16, 256},
                  {TL_PRECISION_FIXED8, 256}};
    for (int model = TL_REFLECT_PHONG; model <= TL_REFLECT_BANKS; model++) {
        struct test_scene scene;
        open_scene(&scene, model);
        tl_image direct = test_scene_draw(&scene, device->renderer);
        double off[TL_COUNT(tables)];
        scene.settings.shading.reflectance = TL_REFLECTANCE_TABLE;
        for (size_t i = 0; i < TL_COUNT(tables); i++) {
            scene.settings.shading.table_size = tables[i].size;
            scene.settings.shading.table_precision = tables[i].precision;
            off[i] = test_scene_error(&scene, device->renderer, &direct).rel_rmse;
        }
        print_message("%-17s float, 64, 512 and 256 texels: %.4f %.4f %.4f; 256 of 16 bits %.4f, of 8 bits "
                      "%.4f\n",
                      models[model], off[0], off[1], off[2], off[3], off[4]);
        assert_true(off[1] < 0.005);
        assert_true(off[1] < 0.3 * off[0]);
        assert_near(off[3], off[2], 0.001);
        assert_true(off[4] > off[2]);
        tl_image_release(&direct);
        test_scene_close(&scene);
    }
}

/* A level of 255 of the largest value that the product of a material's tables can have, for each pass: they
 * multiply numbers that are at most 1. */
static double rounding(const struct test_scene *scene)
{
    const tl_material *material = &scene->shapes[0].material;
    const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
    const struct tl_brdf_table_params params = {.size = scene->settings.shading.table_size,
                                                .precision = TL_PRECISION_FIXED16,
                                                .range = TL_RANGE_SCALED,
                                                .angles = true};
    struct tl_brdf_tables tables = tl_brdf_tables_make(&brdf, &params);
    double largest = (double)scene->lamps[0].irradiance.x;
    for (int i = 0; i < tables.count; i++)
        largest *= (double)tables.tables[i].scale;
    double sum = tables.count * largest / 255;
    tl_brdf_tables_release(&tables);
    return sum;
}

/* A7. Tables multiplied by blending are those multiplied in a shader, but for the target's precision: floats
 * to a few units of their last digit, eight bits to a level a pass. */
static void passes_give_one_image(void **state)
{
    struct test_device *device = *state;
    for (int model = TL_REFLECT_PHONG; model <= TL_REFLECT_BANKS; model++) {
        struct test_scene scene;
        open_scene(&scene, model);
        struct tl_shading_params *shading = &scene.settings.shading;
        shading->reflectance = TL_REFLECTANCE_TABLE;
        shading->table_precision = TL_PRECISION_FIXED16;
        tl_image one = test_scene_draw(&scene, device->renderer);
        double level = rounding(&scene) / test_brightest(&one);
        size_t bytes = tl_renderer_memory(device->renderer).other;
        for (int maximum = 1; maximum <= 2; maximum++)
            for (int target = 0; target < 2; target++) {
                shading->max_textures_per_pass = maximum;
                shading->pass_target = target;
                struct test_difference off = test_scene_error(&scene, device->renderer, &one);
                print_message("%-17s %d a pass, %s: rel. RMSE %.1e, largest %.1e of the peak (bound %.1e), "
                              "%td bytes more\n",
                              models[model], maximum, target ? "float" : "8 bits", off.rel_rmse, off.largest,
                              level,
                              (ptrdiff_t)tl_renderer_memory(device->renderer).other - (ptrdiff_t)bytes);
                assert_true(off.largest < (target == TL_PASS_TARGET_FLOAT ? 1e-5 : level + 1e-5));
                if (target == TL_PASS_TARGET_FIXED8 && maximum == 1 && model >= TL_REFLECT_TORRANCE_SPARROW)
                    assert_true(off.rel_rmse > 1e-4); /* it was drawn in several passes */
            }
        tl_image_release(&one);
        test_scene_close(&scene);
    }
}

/* A2. In eight bits a factor cut at 1 darkens grazing views; divided by its greatest value it does not. */
static void clamped_tables_darken_grazing_views(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, TL_REFLECT_TORRANCE_SPARROW);
    scene.frame.camera.eye = (vec3s){{0, 0.35f, 2.2f}};
    scene.lamps[0] = test_lamp_towards((vec3s){{0, 0.3f, -1}}, 3);
    tl_image direct = test_scene_draw(&scene, device->renderer);
    double sums[2] = {0, 0}, exact = 0;
    scene.settings.shading.reflectance = TL_REFLECTANCE_TABLE;
    scene.settings.shading.table_precision = TL_PRECISION_FIXED16;
    for (int range = 0; range < 2; range++) {
        scene.settings.shading.table_range = range;
        tl_image image = test_scene_draw(&scene, device->renderer);
        for (size_t i = 0; i < (size_t)96 * 96 * 4; i += 4) {
            sums[range] += (double)tl_image_floats(&image)[i];
            exact += range == 0 ? (double)tl_image_floats(&direct)[i] : 0;
        }
        tl_image_release(&image);
    }
    print_message("grazing: clamped %.3f, scaled %.3f of the light\n", sums[0] / exact, sums[1] / exact);
    assert_true(sums[TL_RANGE_CLAMPED] < 0.9 * exact);
    assert_true(fabs(sums[TL_RANGE_SCALED] / exact - 1) < 0.02);
    tl_image_release(&direct);
    test_scene_close(&scene);
}

/* Tables that no surface needs any more are destroyed. */
static void tables_come_and_go(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, TL_REFLECT_WARD);
    tl_image first = test_scene_draw(&scene, device->renderer);
    tl_image_release(&first);
    size_t bytes = tl_renderer_memory(device->renderer).other;
    scene.settings.shading.reflectance = TL_REFLECTANCE_TABLE;
    scene.settings.shading.table_size = 64;
    for (int i = 0; i < 3; i++) { /* a slider's way: one set of tables stays */
        scene.shapes[0].material.gloss.width_weft = 0.2f + 0.1f * (float)i;
        test_scene_refresh(&scene);
        tl_image image = test_scene_draw(&scene, device->renderer);
        tl_image_release(&image);
        assert_true(tl_renderer_memory(device->renderer).other > bytes);
        assert_true(tl_renderer_memory(device->renderer).other <= bytes + (size_t)3 * 64 * 64 * 16);
    }
    scene.settings.shading.reflectance = TL_REFLECTANCE_DIRECT;
    tl_image image = test_scene_draw(&scene, device->renderer);
    tl_image_release(&image);
    assert_int_equal(tl_renderer_memory(device->renderer).other, bytes);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_are_near_the_formula),
        cmocka_unit_test(passes_give_one_image),
        cmocka_unit_test(clamped_tables_darken_grazing_views),
        cmocka_unit_test(tables_come_and_go),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
