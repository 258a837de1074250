/* Environment mapping in several passes, as they are drawn: in a float target against the single pass, which
 * test_envmap.c compares with integrals; in an 8-bit target against bounds that follow from its steps, and
 * against a count of these steps in double. */
#include "tests/render/envmap/maps_oracle.h"

#include "tests/testing.h"

#include <string.h>

#define SIDE 48

enum coating { PLAIN, COLOURED, COATED };

/* A ball over the ground. COLOURED: Fresnel's term differs between the colours. COATED: a coat, and light
 * from behind. */
static void scene_open(struct test_scene *scene, enum coating coating, bool has_ground)
{
    test_scene_open(scene, test_environment(64, 32, lights), (vec3s){{1.5f, 1, 3}}, (vec3s){{0, 0, 0}}, 45,
                    SIDE, SIDE);
    tl_material *ball = test_scene_add(scene, test_sphere((vec3s){{0, 0, 0}}, 1, 24));
    ball->diffuse = (vec3s){{0.6f, 0.4f, 0.2f}};
    ball->specular = coating == COLOURED ? (vec3s){{0.9f, 0.5f, 0.1f}} : (vec3s){{1, 1, 1}};
    ball->glossiness = 0.9f;
    ball->gloss.fresnel = coating == COLOURED ? TL_FRESNEL_SCHLICK : TL_FRESNEL_DIELECTRIC;
    ball->gloss.index = 1.5f;
    if (coating == COATED) {
        ball->coat = 0.8f;
        ball->coat_glossiness = 0.95f;
        ball->transmission = (vec3s){{0.3f, 0.2f, 0.1f}};
    }
    test_scene_refresh(scene);
    scene->settings.image.supersample = 1;
    scene->settings.image.ground = has_ground;
    scene->settings.light.method = TL_METHOD_MAPS;
    scene->settings.maps.size = 32;
}

static size_t bytes_of(tl_renderer *renderer)
{
    return tl_renderer_memory(renderer).pems;
}

static double largest_difference(const tl_image *a, const tl_image *b)
{
    double worst = 0;
    for (size_t i = 0; i < (size_t)4 * SIDE * SIDE; i++)
        worst = fmax(worst, fabs((double)(tl_image_floats(a)[i] - tl_image_floats(b)[i])));
    return worst;
}

/* One pass against several. The passes allocate a target of four floats a pixel, so that equality is not that
 * of two images of one kind. */
static double float_difference(struct test_scene *scene, tl_renderer *renderer)
{
    struct tl_maps_params *maps = &scene->settings.maps;
    maps->passes = TL_MAPS_PASSES_ONE;
    tl_image one = test_scene_draw(scene, renderer);
    size_t bytes = bytes_of(renderer);
    maps->passes = TL_MAPS_PASSES_SEVERAL;
    tl_image several = test_scene_draw(scene, renderer);
    assert_int_equal(bytes_of(renderer) - bytes, (size_t)16 * SIDE * SIDE);
    assert_true(test_brightest(&one) > 0.02);
    double worst = largest_difference(&one, &several);
    tl_image_release(&one);
    tl_image_release(&several);
    return worst;
}

/* A sum of five terms of at most BRIGHTEST, in another order: a few roundings of 2^-24. */
#define ROUNDING (8 * BRIGHTEST / (1 << 24))

static double worst_of(tl_renderer *renderer, enum coating coating, bool has_ground, int mode_count,
                       int first_fresnel, int last_fresnel)
{
    struct test_scene scene;
    double worst = 0;
    scene_open(&scene, coating, has_ground);
    for (int mode = TL_MAPS_SURFACE; mode < mode_count; mode++)
        for (int fresnel = first_fresnel; fresnel <= last_fresnel; fresnel++) {
            scene.settings.maps.mode = mode;
            scene.settings.maps.fresnel = fresnel;
            double off = float_difference(&scene, renderer);
            if (off > ROUNDING)
                print_error("coating %d, ground %d, mode %d, Fresnel %d: off by %.2g\n", coating, has_ground,
                            mode, fresnel, off);
            worst = fmax(worst, off);
        }
    test_scene_close(&scene);
    return worst;
}

static void passes_in_float_equal_one_pass(void **state)
{
    struct test_device *device = *state;
    double worst = 0;
    worst = worst_of(device->renderer, PLAIN, true, 6, TL_MAPS_FRESNEL_OFF, TL_MAPS_FRESNEL_COAT);
    for (int ground = 0; ground < 2; ground++)
        worst = fmax(worst,
                     worst_of(device->renderer, COATED, ground, 1, TL_MAPS_FRESNEL_OFF, TL_MAPS_FRESNEL_OFF));
    worst =
        fmax(worst, worst_of(device->renderer, COLOURED, true, 2, TL_MAPS_FRESNEL_OFF, TL_MAPS_FRESNEL_COAT));
    print_message("several passes against one, in float: off by %.1e\n", worst);
    assert_true(worst <= ROUNDING);
}

/* Every layout; paraboloids by matrices take two passes for each term. Vectors at vertices: those of a cube,
 * and the matrices'. */
static void layouts_take_passes(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, PLAIN, true);
    scene.settings.maps.fresnel = TL_MAPS_FRESNEL_COAT;
    for (int layout = 0; layout <= TL_LAYOUT_COUNT; layout++)
        for (int vectors = 0; vectors < 2; vectors++) {
            bool by_matrix = layout == TL_LAYOUT_COUNT;
            if (vectors && !by_matrix && layout != TL_LAYOUT_CUBE)
                continue;
            scene.settings.maps.layout = by_matrix ? TL_LAYOUT_PARABOLOID : layout;
            scene.settings.maps.look_up = by_matrix;
            scene.settings.maps.vectors = vectors;
            double off = float_difference(&scene, device->renderer);
            print_message("%s, vectors at %s: off by %.1e\n",
                          by_matrix ? "paraboloid in two halves" : tl_layout_names[layout],
                          vectors ? "vertices" : "pixels", off);
            assert_true(off <= ROUNDING);
        }
    test_scene_close(&scene);
}

/* Draws with one set of terms in a float target. */
static tl_image draw(struct test_scene *scene, tl_renderer *renderer, int mode, int fresnel, int target)
{
    scene->settings.maps.mode = mode;
    scene->settings.maps.fresnel = fresnel;
    scene->settings.maps.pass_target = target;
    return test_scene_draw(scene, renderer);
}

static double steps(double value)
{
    return floor(255 * fmin(fmax(value, 0), 1) + 0.5);
}

/* What an 8-bit target keeps of the passes, from their terms in float: alpha rounds F, every pass clamps and
 * rounds its light, the product with alpha, and the sum. Rounding of products and sums differs between
 * devices: a step each. */
static void eight_bits_are_counted(void **state)
{
    struct test_device *device = *state;
    for (int fresnel = TL_MAPS_FRESNEL_ADDITIVE; fresnel <= TL_MAPS_FRESNEL_COAT; fresnel++)
        for (int i = 0; i < 2; i++) {
            struct test_scene scene;
            double worst = 0, squares = 0, plain = 0, white = i ? 4 : 1;
            int counted = 0;
            scene_open(&scene, PLAIN, false);
            scene.settings.maps.passes = TL_MAPS_PASSES_SEVERAL;
            scene.settings.maps.pass_white = (float)white;
            tl_image over =
                draw(&scene, device->renderer, TL_MAPS_MIRROR, TL_MAPS_FRESNEL_OFF, TL_PASS_TARGET_FLOAT);
            tl_image under =
                draw(&scene, device->renderer, TL_MAPS_DIFFUSE, TL_MAPS_FRESNEL_OFF, TL_PASS_TARGET_FLOAT);
            tl_image exact = draw(&scene, device->renderer, TL_MAPS_MIRROR, fresnel, TL_PASS_TARGET_FLOAT);
            tl_image bytes = draw(&scene, device->renderer, TL_MAPS_MIRROR, fresnel, TL_PASS_TARGET_FIXED8);
            for (int p = 0; p < SIDE * SIDE; p++) {
                const float *lm = test_pixel(&over, p % SIDE, p / SIDE),
                            *ld = test_pixel(&under, p % SIDE, p / SIDE),
                            *lo = test_pixel(&exact, p % SIDE, p / SIDE),
                            *seen = test_pixel(&bytes, p % SIDE, p / SIDE);
                double left = fresnel == TL_MAPS_FRESNEL_COAT ? (double)ld[0] : 0;
                if (lm[3] < 1 || fabs((double)lm[0] - left) < 0.2)
                    continue;
                double f = ((double)lo[0] - (double)ld[0]) / ((double)lm[0] - left), alpha = steps(f) / 255;
                for (int c = 0; c < 3; c++) {
                    double added = floor(alpha * steps((double)lm[c] / white) + 0.5);
                    double rest = fresnel == TL_MAPS_FRESNEL_COAT ? 1 - alpha : 1;
                    double sum = fmin(added + floor(rest * steps((double)ld[c] / white) + 0.5), 255);
                    double shown = 255 * (double)seen[c] / white;
                    assert_near(shown, floor(shown + 0.5), 1e-3); /* a whole number of steps */
                    worst = fmax(worst, fabs(shown - sum));
                    squares += pow(shown - 255 * (double)lo[c] / white, 2) / 3;
                    plain = fmax(plain, fabs(shown - 255 * (double)lo[c] / white));
                }
                counted++;
            }
            print_message("Fresnel %d, white %.0f: %d pixels, off by %.0f steps from the count; from the "
                          "exact light by "
                          "%.2f steps RMS, %.1f at most\n",
                          fresnel, white, counted, worst, sqrt(squares / counted), plain);
            assert_true(counted > 200);
            assert_true(worst <= 2.001);
            /* F is off by half a step, of light of at most BRIGHTEST; three more roundings of half a step */
            if (white > BRIGHTEST) {
                assert_true(plain < 0.5 + 1.5 + 2);
                assert_true(sqrt(squares / counted) > 0.2);
            }
            tl_image_release(&over);
            tl_image_release(&under);
            tl_image_release(&exact);
            tl_image_release(&bytes);
            test_scene_close(&scene);
        }
}

/* Light beyond the white of an 8-bit target is lost; the rest stays within the steps. */
static void white_clamps(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    int clamped = 0, kept = 0;
    scene_open(&scene, PLAIN, false);
    scene.settings.maps.passes = TL_MAPS_PASSES_SEVERAL;
    scene.settings.maps.pass_white = 0.5f;
    tl_image exact =
        draw(&scene, device->renderer, TL_MAPS_MIRROR, TL_MAPS_FRESNEL_OFF, TL_PASS_TARGET_FLOAT);
    tl_image bytes =
        draw(&scene, device->renderer, TL_MAPS_MIRROR, TL_MAPS_FRESNEL_OFF, TL_PASS_TARGET_FIXED8);
    /* A byte is within .6 of a step, which is what Direct3D 11.3 asks of hardware; GL asks nothing. */
    for (size_t i = 0; i < (size_t)4 * SIDE * SIDE; i++) {
        float light = tl_image_floats(&exact)[i];
        if (i % 4 == 3 || tl_image_floats(&exact)[i / 4 * 4 + 3] < 1)
            continue;
        assert_near(tl_image_floats(&bytes)[i], fminf(light, 0.5f), 0.6 * 0.5 / 255);
        clamped += light > 0.5f;
        kept += light < 0.5f;
    }
    print_message("white 0.5: %d values clamped, %d kept\n", clamped, kept);
    assert_true(clamped > 200 && kept > 200);
    tl_image_release(&exact);
    tl_image_release(&bytes);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_in_float_equal_one_pass),
        cmocka_unit_test(layouts_take_passes),
        cmocka_unit_test(eight_bits_are_counted),
        cmocka_unit_test(white_clamps),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
