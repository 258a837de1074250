/* PEMs as cropped paraboloid maps, drawn: against the same PEMs as cubes, and against a constant environment.
 *
 * The maps are sampled at half of the cubes' step h and interpolated. A level is piecewise linear; where its
 * slope changes by c the interpolation errs by c h / 4 at most. A filtered level falls from its smallest tap
 * to 0 within one step, 0.7 of its peak: an error of 0.7 / 8, 9 % of the peak, on either axis, 18 % in all.
 * Level 0 falls from its peak on both sides: 25 % on either axis. The bounds here are smaller: twice what
 * came out. They are enough to name a lost or misplaced map, which is wrong by all of its light. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/pem/lobe.h"
#include "render/pem/pems.h"

#include "tests/testing.h"

#define SIDE 64

/* A spot of 12 degrees radius in a dim sky. */
static vec3s spot_at;
static vec3s spot(vec3s d)
{
    bool lit = glms_vec3_dot(d, glms_vec3_normalize(spot_at)) > cosf(12 * GLM_PIf / 180);
    return lit ? (vec3s){{8, 6, 4}} : (vec3s){{0.1f, 0.2f, 0.3f}};
}

static float reflectance = 0.8f;

struct scene {
    tl_environment environment;
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    tl_frame frame;
    struct tl_render_settings settings;
};

/* A ball under a sheet. */
static void open_scene(struct scene *scene, test_radiance *radiance, int pem_size, int regions)
{
    *scene = (struct scene){.environment = test_environment(256, 128, radiance)};
    scene->shapes[0] = test_sphere((vec3s){{0, 0.5f, 0}}, 0.5f, 48);
    scene->shapes[1] = test_sheet(1.15f, 0.5f, 0.06f, 2, 32);
    scene->settings = test_settings(SIDE, SIDE);
    scene->settings.light.pem_size = pem_size;
    scene->settings.light.regions = regions;
    scene->settings.light.map_size = 64;
    scene->settings.light.lobe = TL_LOBE_DUAL;
}

static void close_scene(struct scene *scene)
{
    test_shape_release(&scene->shapes[0]);
    test_shape_release(&scene->shapes[1]);
    tl_environment_release(&scene->environment);
}

static tl_image draw(const struct test_device *device, struct scene *scene, float glossiness)
{
    for (int i = 0; i < 2; i++) {
        scene->shapes[i].material.glossiness = glossiness;
        scene->shapes[i].material.diffuse = (vec3s){{1 - reflectance, 1 - reflectance, 1 - reflectance}};
        scene->shapes[i].material.specular = (vec3s){{reflectance, reflectance, reflectance}};
        test_shape_refresh(&scene->shapes[i]);
        scene->surfaces[i] = scene->shapes[i].surface;
    }
    scene->frame = test_frame((vec3s){{1, 1.4f, 2.2f}}, (vec3s){{0, 0.7f, 0}}, 40, scene->surfaces, 2,
                              &scene->environment);
    return test_draw(device->renderer, &scene->frame, &scene->settings);
}

struct difference {
    double rms;     /* relative to the mean of covered pixels */
    double largest; /* relative to the brightest */
};

static struct difference compare(const tl_image *image, const tl_image *expected)
{
    struct difference difference = {0};
    double mean = 0, squares = 0, peak = 0;
    int covered = 0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const float *a = test_pixel(image, x, y), *b = test_pixel(expected, x, y);
            assert_near(a[3], b[3], 0);
            if (b[3] < 1)
                continue;
            covered++;
            for (int c = 0; c < 3; c++) {
                double off = (double)a[c] - (double)b[c];
                mean += (double)b[c];
                peak = fmax(peak, (double)b[c]);
                squares += off * off;
                difference.largest = fmax(difference.largest, fabs(off));
            }
        }
    assert_true(covered > 400 && mean > 0);
    difference.rms = sqrt(squares / (3 * covered)) / (mean / (3 * covered));
    difference.largest /= peak;
    return difference;
}

#define GLOSSES 5
static const float glosses[GLOSSES] = {0, 0.9f, 0.98f, 0.997f, 1};

/* One layout after the other: each replaces the one before. */
static void draw_all(const struct test_device *device, struct scene *scene, tl_image images[2][GLOSSES])
{
    for (int layout = TL_PEM_CUBE; layout <= TL_PEM_PARABOLOID; layout++) {
        scene->settings.light.pem_layout = layout;
        for (int i = 0; i < GLOSSES; i++)
            images[layout][i] = draw(device, scene, glosses[i]);
    }
}

/* Returns the largest rms difference. */
static double layouts_agree(const struct test_device *device, struct scene *scene, const char *what)
{
    tl_image images[2][GLOSSES];
    double worst = 0;
    draw_all(device, scene, images);
    for (int i = 0; i < GLOSSES; i++) {
        struct difference off = compare(&images[TL_PEM_PARABOLOID][i], &images[TL_PEM_CUBE][i]);
        printf("%s, g %.3f: rms %.4f of the mean, largest %.3f of the peak\n", what, (double)glosses[i],
               off.rms, off.largest);
        assert_near(off.rms, 0, glosses[i] < 1 ? 0.09 : 0.27);
        assert_near(off.largest, 0, glosses[i] < 1 ? 0.11 : 0.26);
        worst = fmax(worst, off.rms);
        tl_image_release(&images[0][i]);
        tl_image_release(&images[1][i]);
    }
    return worst;
}

static void layouts_draw_the_same(void **state)
{
    for (int lobe = TL_LOBE_SINGLE; lobe <= TL_LOBE_DUAL; lobe++) {
        struct scene scene;
        open_scene(&scene, test_daylight, 128, 96);
        scene.settings.light.lobe = lobe;
        /* They are not the same images: that would say that the option does nothing. */
        assert_true(layouts_agree(*state, &scene, lobe ? "two lobes" : "one lobe") > 1e-3);
        close_scene(&scene);
    }
}

/* The spot's light crosses edges and corners of the cube, where two or three charts meet; or lies within one.
 */
static void edges_and_corners_are_no_different(void **state)
{
    static const vec3s places[] = {{{1, 1, 1}}, {{0.1f, 1, 1}}, {{1, 0, -0.98f}}, {{-0.1f, 1, 0.2f}}};
    static const char *const names[] = {"corner", "edge above", "edge in front", "within a face"};
    for (size_t k = 0; k < TL_COUNT(places); k++) {
        struct scene scene;
        spot_at = places[k];
        open_scene(&scene, spot, 64, 24);
        layouts_agree(*state, &scene, names[k]);
        close_scene(&scene);
    }
}

/* Regions of the sphere lie on several faces. */
static void cuts_of_the_sphere_are_no_different(void **state)
{
    struct scene scene;
    open_scene(&scene, test_daylight, 64, 24);
    scene.settings.light.cut = TL_CUT_SPHERE;
    layouts_agree(*state, &scene, "cut of the sphere");
    close_scene(&scene);
}

/* Smooth and coloured. */
static vec3s gradient(vec3s d)
{
    return (vec3s){{2 + d.x, 2 - 0.8f * d.y + 0.5f * d.z, 1.5f + d.z}};
}

/* Under smooth light hardly anything is lost to interpolation: a look-up in a slightly wrong direction shows.
 */
static void smooth_light_is_the_same(void **state)
{
    struct scene scene;
    open_scene(&scene, gradient, 64, 24);
    scene.settings.light.lobe = TL_LOBE_SINGLE;
    for (int i = 0; i < 4; i++) {
        tl_image images[2];
        for (int layout = 0; layout < 2; layout++) {
            scene.settings.light.pem_layout = layout;
            images[layout] = draw(*state, &scene, 0.2f + 0.2f * (float)i);
        }
        struct difference off = compare(&images[1], &images[0]);
        assert_near(off.rms, 0, 0.009);
        assert_near(off.largest, 0, 0.025);
        printf("smooth, g %.1f: rms %.5f, largest %.5f\n", 0.2 + 0.2 * i, off.rms, off.largest);
        tl_image_release(&images[0]);
        tl_image_release(&images[1]);
    }
    close_scene(&scene);
}

/* Radiance of 1e6 does not fit a half float; it must be scaled before it is sampled. */
static vec3s sun(vec3s d)
{
    bool lit = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.3f, 0.8f, 0.5f}})) > 0.97f;
    return lit ? (vec3s){{1e6f, 9e5f, 8e5f}} : (vec3s){{0.5f, 0.6f, 0.7f}};
}

static void a_sun_stays_in_range(void **state)
{
    struct scene scene;
    open_scene(&scene, sun, 64, 24);
    layouts_agree(*state, &scene, "sun");
    close_scene(&scene);
}

/* A perfect reflector is white under white light. */
static void white_stays_white(void **state)
{
    struct scene scene;
    open_scene(&scene, test_white, 128, 96);
    scene.settings.light.method = TL_METHOD_UNSHADOWED;
    scene.settings.light.pem_layout = TL_PEM_PARABOLOID;
    reflectance = 1;
    for (int i = 0; i < GLOSSES; i++) {
        tl_image image = draw(*state, &scene, glosses[i]);
        double largest = 0, squares = 0;
        int covered = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const float *pixel = test_pixel(&image, x, y);
                if (pixel[3] < 1)
                    continue;
                double off = (double)pixel[0] - 1;
                covered++;
                squares += off * off;
                largest = fmax(largest, fabs(off));
            }
        printf("white, g %.3f: rms %.5f, largest %.5f\n", (double)glosses[i], sqrt(squares / covered),
               largest);
        /* Half floats that may be cut: 2^-10 of each region's light. */
        assert_near(largest, 0, 1e-3);
        tl_image_release(&image);
    }
    reflectance = 0.8f;
    close_scene(&scene);
}

/* The glossiness that reads this level. */
static float gloss_of(const struct tl_lobe_table *table, float level)
{
    int i = 0;
    while (i + 2 < TL_LOBE_STEPS && table->level[i + 1] > level)
        i++;
    float part = (table->level[i] - level) / (table->level[i] - table->level[i + 1]);
    return ((float)i + part) / (TL_LOBE_STEPS - 1);
}

/* Where one level takes over from another, the switch from maps to cubes among them, the image does not jump:
 * a step of a twenty-fifth of a level changes it by no more than a twenty-fifth of what half a level does,
 * twice over. */
static void no_level_begins_with_a_step(void **state)
{
    struct scene scene;
    struct tl_lobe_table *table = TL_NEW(struct tl_lobe_table);
    spot_at = (vec3s){{0.3f, 1, 0.6f}};
    open_scene(&scene, spot, 64, 24);
    scene.settings.light.pem_layout = TL_PEM_PARABOLOID;
    tl_lobe_calibrate(64, TL_CHAIN_SQRT_COSINE, table);
    for (int level = 1; level <= 4; level++) {
        const float offsets[] = {-0.25f, -0.02f, 0.02f, 0.25f};
        tl_image images[4];
        for (int i = 0; i < 4; i++)
            images[i] = draw(*state, &scene, gloss_of(table, (float)level + offsets[i]));
        double whole = compare(&images[0], &images[3]).rms, step = compare(&images[1], &images[2]).rms;
        printf("level %d: half a level changes the image by %.4f, a 25th by %.5f\n", level, whole, step);
        assert_true(whole > 0.01);
        assert_true(step < 2 * whole * 0.04 / 0.5);
        for (int i = 0; i < 4; i++)
            tl_image_release(&images[i]);
    }
    free(table);
    close_scene(&scene);
}

/* How regions are placed in textures does not matter but for the order of additions, and for weights of
 * filters that hardware rounds to the one side or the other, along two axes, of texels that differ by up to
 * the peak. */
static void passes_add_up(void **state)
{
    struct scene scene;
    open_scene(&scene, test_daylight, 64, 24);
    scene.settings.light.pem_layout = TL_PEM_PARABOLOID;
    tl_image whole = draw(*state, &scene, 0.98f);
    scene.settings.light.pems_per_pass = 5;
    tl_image other = draw(*state, &scene, 0.98f);
    assert_near(compare(&other, &whole).largest, 0, 2 * 24 * 1.2e-7 + 2 * 2 * TEST_WEIGHT);
    tl_image_release(&whole);
    tl_image_release(&other);
    close_scene(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layouts_draw_the_same),
        cmocka_unit_test(edges_and_corners_are_no_different),
        cmocka_unit_test(cuts_of_the_sphere_are_no_different),
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(no_level_begins_with_a_step),
        cmocka_unit_test(passes_add_up),
        cmocka_unit_test(a_sun_stays_in_range),
        cmocka_unit_test(smooth_light_is_the_same),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
