/* The ways to put light together, against exact lobes on the CPU and closed forms on simple scenes. */
#include "tests/render/scenes.h"

#include "render/env/exponent.h"
#include "render/env/from_environment.h"
#include "render/env/lobes.h"
#include "render/light/terms.h"
#include "render/pem/pems.h"
#include "render/pem/regions.h"

#include "tests/testing.h"

/* A soft light overhead, coloured across, none from elsewhere: surfaces that look up see all of it. */
static vec3s overhead(vec3s d)
{
    float height = fmaxf(d.y - 0.8f, 0);
    return (vec3s){{40 * height * (1 + d.x), 30 * height, 20 * height * (1 - d.z)}};
}

/* Red from the left, green from the right, blue evenly. */
static vec3s halves(vec3s d)
{
    return d.x < 0 ? (vec3s){{1, 0, 0.5f}} : (vec3s){{0, 1, 0.5f}};
}

static vec3s patch(vec3s d)
{
    return glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.3f, 1, 0.2f}})) > 0.985f ? (vec3s){{20, 15, 10}}
                                                                                    : (vec3s){{0, 0, 0}};
}

static vec3s sunny(vec3s d)
{
    bool sun = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.3f, 0.8f, 0.5f}})) > 0.999f;
    return sun ? (vec3s){{3000, 2700, 2400}} : (vec3s){{0.5f, 0.6f, 0.7f}};
}

static struct tl_render_settings settings_of(enum tl_method method, enum tl_prefilter prefilter,
                                             enum tl_composition composition)
{
    struct tl_render_settings settings = test_settings(1, 1);
    settings.light.method = (int)method;
    settings.light.prefilter = (int)prefilter;
    settings.light.composition = (int)composition;
    settings.light.visibility = TL_VISIBILITY_DEPTH;
    settings.light.map_size = 64;
    return settings;
}

struct tilt {
    vec3s normal, right, view;
};

/* Normals within 27 degrees of +Y, seen from up to 20 degrees beside them. */
static struct tilt tilt_of(int i)
{
    float angle = 2.399963f * (float)i, slope = 0.5f * ((float)i + 0.5f) / 12;
    struct tilt tilt = {.normal =
                            glms_vec3_normalize((vec3s){{slope * cosf(angle), 1, slope * sinf(angle)}})};
    tilt.right = glms_vec3_normalize(glms_vec3_cross((vec3s){{0, 0, 1}}, tilt.normal));
    tilt.view = glms_vec3_normalize(glms_vec3_add(tilt.normal, glms_vec3_scale(tilt.right, 0.35f)));
    return tilt;
}

static vec3s mirror_of(const struct tilt *tilt)
{
    return glms_vec3_sub(glms_vec3_scale(tilt->normal, 2 * glms_vec3_dot(tilt->normal, tilt->view)),
                         tilt->view);
}

/* One pixel of a lone square. */
static vec3s draw_square(tl_renderer *renderer, const struct tilt *tilt, float glossiness,
                         const tl_environment *environment, const struct tl_render_settings *settings)
{
    struct test_shape square = test_square((vec3s){{0, 0, 0}}, tilt->right, tilt->normal, 1, 1);
    square.material.diffuse = (vec3s){{0.5f, 0.5f, 0.5f}};
    square.material.specular = (vec3s){{1, 1, 1}}; /* F is 1 at every angle */
    square.material.glossiness = glossiness;
    test_shape_refresh(&square);
    tl_frame frame =
        test_frame(glms_vec3_scale(tilt->view, 3), (vec3s){{0, 0, 0}}, 0.1f, &square.surface, 1, environment);
    tl_image image = test_draw(renderer, &frame, settings);
    const float *pixel = test_pixel(&image, 0, 0);
    vec3s colour = {{pixel[0], pixel[1], pixel[2]}};
    tl_image_release(&image);
    test_shape_release(&square);
    return colour;
}

static void assert_colour(vec3s actual, vec3s expected, float relative)
{
    for (int c = 0; c < 3; c++)
        assert_near(actual.raw[c], expected.raw[c], relative * expected.raw[c]);
}

/* E as the CPU knows it: kd E(n, 1) + F ks E(r, s). */
static vec3s exact_colour(const tl_environment *environment, int pem_size, const struct tilt *tilt,
                          float glossiness)
{
    tl_cube cube = tl_cube_from_environment(environment, pem_size);
    struct tl_lobes lobes = {0};
    tl_lobes_make(&lobes, &cube, tl_exponents_needed(glossiness, glossiness));
    vec3s diffuse = tl_lobes_fetch(&lobes, tilt->normal, tl_exponent_blend(1));
    vec3s gloss = tl_lobes_fetch(&lobes, mirror_of(tilt), tl_exponent_blend(tl_lobe_exponent(glossiness)));
    tl_lobes_release(&lobes);
    tl_cube_release(&cube);
    return glms_vec3_add(glms_vec3_scale(diffuse, 0.5f), gloss);
}

/* The GPU's exact light is the CPU's, but for directions in halves: 1e-3 rad times a slope of up to sqrt(s)
 * + 2. */
static void test_exact_light(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(128, 64, overhead);
    struct tl_render_settings settings =
        settings_of(TL_METHOD_UNSHADOWED, TL_PREFILTER_SLICES, TL_COMPOSE_RATIO);
    const float glossiness[] = {0, 0.5f, 0.9f};
    for (int g = 0; g < 3; g++)
        for (int i = 0; i < 12; i++) {
            struct tilt tilt = tilt_of(i);
            vec3s actual = draw_square(device->renderer, &tilt, glossiness[g], &environment, &settings);
            assert_colour(actual, exact_colour(&environment, settings.light.pem_size, &tilt, glossiness[g]),
                          0.008f);
        }
    tl_environment_release(&environment);
}

/* Without occlusion, sum, difference and ratio equal the exact light: the latter two by construction, the sum
 * within the 1 % error of slices. */
static void test_unoccluded_is_exact(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(128, 64, overhead);
    const struct {
        enum tl_prefilter prefilter;
        enum tl_composition composition;
        float tolerance;
    } ways[] = {
        {TL_PREFILTER_SLICES, TL_COMPOSE_SUM, 0.02f},
        {TL_PREFILTER_SLICES, TL_COMPOSE_DIFFERENCE, 0.008f},
        {TL_PREFILTER_SLICES, TL_COMPOSE_RATIO, 0.008f},
        {TL_PREFILTER_CHAIN, TL_COMPOSE_RATIO, 0.008f},
        {TL_PREFILTER_CHAIN, TL_COMPOSE_DIFFERENCE, 0.008f},
    };
    for (size_t way = 0; way < sizeof ways / sizeof *ways; way++)
        for (int g = 0; g < 3; g++) {
            float glossiness = 0.45f * (float)g;
            struct tl_render_settings settings =
                settings_of(TL_METHOD_PEM, ways[way].prefilter, ways[way].composition);
            struct tilt tilt = tilt_of(4 * g);
            vec3s actual = draw_square(device->renderer, &tilt, glossiness, &environment, &settings);
            assert_colour(actual, exact_colour(&environment, settings.light.pem_size, &tilt, glossiness),
                          ways[way].tolerance);
        }
    tl_environment_release(&environment);
}

/* One region holds all light: power (kd K_1(n . d) + F ks K_s(r . d)). */
static void test_lights(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(128, 64, patch);
    struct tl_render_settings settings = settings_of(TL_METHOD_LIGHTS, TL_PREFILTER_CHAIN, TL_COMPOSE_SUM);
    settings.light.regions = 6;
    tl_cube cube = tl_cube_from_environment(&environment, settings.light.pem_size);
    struct tl_regions regions = {0};
    tl_regions_cut(&cube, 6, &regions);
    const struct tl_region *light = &regions.items[2]; /* the upper face */
    for (int i = 0; i < 12; i++) {
        struct tilt tilt = tilt_of(i);
        const float g = 0.8f;
        float diffuse = lobe_cosine(1, glms_vec3_dot(tilt.normal, light->direction));
        float gloss = lobe_cosine(tl_lobe_exponent(g), glms_vec3_dot(mirror_of(&tilt), light->direction));
        vec3s expected = glms_vec3_scale(light->power, 0.5f * diffuse + gloss);
        assert_colour(draw_square(device->renderer, &tilt, g, &environment, &settings), expected, 0.01f);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
    tl_environment_release(&environment);
}

/* A point of the ground at the foot of a wall that hides all that lies to the left: white cloth, or a white
 * gloss of exponent 1 about the mirror direction, which leans to the left. */
static vec3s draw_foot(tl_renderer *renderer, const tl_environment *environment,
                       const struct tl_render_settings *settings, bool is_gloss)
{
    struct test_shape shapes[2] = {
        test_square((vec3s){{0.5f, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 0.5f, 4),
        test_square((vec3s){{0, 20, 0}}, (vec3s){{0, 0, -1}}, (vec3s){{1, 0, 0}}, 20, 4),
    };
    tl_surface surfaces[2];
    for (int i = 0; i < 2; i++) {
        shapes[i].material.diffuse = is_gloss ? (vec3s){{0, 0, 0}} : (vec3s){{1, 1, 1}};
        shapes[i].material.specular = is_gloss ? (vec3s){{1, 1, 1}} : (vec3s){{0, 0, 0}};
        shapes[i].material.glossiness = 0;
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
    tl_frame frame = test_frame((vec3s){{0.6f, 1, 0}}, (vec3s){{0.5f, 0, 0}}, 0.1f, surfaces, 2, environment);
    tl_image image = test_draw(renderer, &frame, settings);
    const float *pixel = test_pixel(&image, 0, 0);
    vec3s colour = {{pixel[0], pixel[1], pixel[2]}};
    tl_image_release(&image);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    return colour;
}

/* Half of the sky is hidden, and all of the red: PEMs and lights lose red alone; occlusion halves every
 * colour; occlusion by colour knows red from green. Unshadowed it is a half each. The regions that the wall's
 * plane cuts, and those at the horizon, are all or nothing: of 96 a few, a few hundredths of the light each.
 * Gloss about r has (1 - r.x) / 2 of its light from the left; occlusion takes as much of it as of the diffuse
 * light. */
static void test_methods_at_a_wall(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(128, 64, halves);
    const struct {
        enum tl_method method;
        float red, green, blue;
    } methods[] = {
        {TL_METHOD_UNSHADOWED, 0.5f, 0.5f, 0.5f}, {TL_METHOD_PEM, 0, 0.5f, 0.25f},
        {TL_METHOD_LIGHTS, 0, 0.5f, 0.25f},       {TL_METHOD_AO, 0.25f, 0.25f, 0.25f},
        {TL_METHOD_AO_COLOUR, 0, 0.5f, 0.25f},
    };
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        struct tl_render_settings settings =
            settings_of(methods[i].method, TL_PREFILTER_CHAIN, TL_COMPOSE_RATIO);
        settings.light.cut = TL_CUT_SPHERE;
        settings.light.regions = 96;
        settings.light.map_size = 512;
        vec3s actual = draw_foot(device->renderer, &environment, &settings, false);
        assert_near(actual.x, methods[i].red, 0.04);
        assert_near(actual.y, methods[i].green, 0.04);
        assert_near(actual.z, methods[i].blue, 0.04);
        const float lean = 0.1f / sqrtf(1.01f); /* -r.x */
        actual = draw_foot(device->renderer, &environment, &settings, true);
        assert_near(actual.x, methods[i].red * (1 + lean), 0.04);
        assert_near(actual.y, methods[i].green * (1 - lean), 0.04);
        const bool sees_half = methods[i].method == TL_METHOD_PEM || methods[i].method == TL_METHOD_LIGHTS;
        assert_near(actual.z, methods[i].blue * (sees_half ? 1 - lean : 1), 0.04);
    }
    tl_environment_release(&environment);
}

/* A sun that stands apart is as bright as it was among the regions; and what a sheet hides from it is dark.
 * The sun is 5 degrees wide: its lobe is broadened as the regions' are. */
static void test_sun_apart(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(256, 128, sunny);
    for (int shadowed = 0; shadowed < 2; shadowed++)
        for (int i = 0; i < 12; i += 3) {
            struct tilt tilt = tilt_of(i);
            struct tl_render_settings settings = settings_of(shadowed ? TL_METHOD_PEM : TL_METHOD_UNSHADOWED,
                                                             TL_PREFILTER_CHAIN, TL_COMPOSE_RATIO);
            settings.light.cut = TL_CUT_SPHERE;
            settings.light.pem_size = 64;
            vec3s together = draw_square(device->renderer, &tilt, 0.5f, &environment, &settings);
            settings.light.sun = true;
            vec3s separate = draw_square(device->renderer, &tilt, 0.5f, &environment, &settings);
            assert_colour(separate, together, 0.02f);
        }
    tl_environment_release(&environment);
}

/* 2.1 degrees in radius. */
static vec3s small_sun(vec3s d)
{
    bool sun = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.3f, 0.8f, 0.5f}})) > 0.9993f;
    return sun ? (vec3s){{3000, 2700, 2400}} : (vec3s){{0.5f, 0.6f, 0.7f}};
}

/* A mirror lobe as narrow as the sun, along it: the share of K_s within the sun's radius R is 1 - cos^(s + 1)
 * R. What stands for it, a lobe broadened by the sun's spread, R / sqrt 2, is 1.03 of that at this exponent;
 * broadened by R it would be 0.82. */
static void test_sun_in_a_narrow_lobe(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(1024, 512, small_sun);
    struct tl_render_settings settings =
        settings_of(TL_METHOD_UNSHADOWED, TL_PREFILTER_CHAIN, TL_COMPOSE_RATIO);
    settings.light.sun = true;
    vec3s sun = glms_vec3_normalize((vec3s){{0.3f, 0.8f, 0.5f}});
    struct tilt tilt = {{{0, 1, 0}}, {{1, 0, 0}}, {{-sun.x, sun.y, -sun.z}}};
    vec3s light = draw_square(device->renderer, &tilt, 0.999f, &environment, &settings);
    double share = (double)light.x / 3000, exact = 1 - pow(0.9993, 1001);
    print_message("a sun in a lobe of exponent 1000: %.3f of its light, %.3f by integration\n", share, exact);
    assert_near(share / exact, 1.03, 0.06); /* its texels are a twelfth of it wide */
    tl_environment_release(&environment);
}

static void test_sun_casts_a_shadow(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(256, 128, sunny);
    struct test_shape shapes[2] = {
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 1, 4),
        test_square((vec3s){{0, 1, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 0.25f, 2),
    };
    tl_surface surfaces[2];
    for (int i = 0; i < 2; i++) {
        shapes[i].material.specular = (vec3s){{0, 0, 0}};
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
    struct tl_render_settings settings = settings_of(TL_METHOD_PEM, TL_PREFILTER_CHAIN, TL_COMPOSE_RATIO);
    settings.light.sun = true;
    settings.light.pem_size = 64;
    /* The sheet's shadow lies opposite the sun: 0.3 / 0.8 and 0.5 / 0.8 m to the side, a metre below. */
    vec3s shadow = {{-0.375f, 0, -0.625f}};
    float light[2];
    for (int i = 0; i < 2; i++) {
        vec3s target = {{i == 0 ? shadow.x : 0.6f, 0, i == 0 ? shadow.z : 0.6f}};
        vec3s eye = glms_vec3_add(target, (vec3s){{-0.8f, 1, -1.5f}});
        tl_frame frame = test_frame(eye, target, 0.1f, surfaces, 2, &environment);
        tl_image image = test_draw(device->renderer, &frame, &settings);
        light[i] = test_pixel(&image, 0, 0)[0];
        tl_image_release(&image);
    }
    assert_true(light[1] > 5 * light[0]);
    assert_true(light[0] > 0); /* the sky still shines there */
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* A change begins a new average, whatever was averaged before: the same bits as without a past. */
static void test_average_restarts(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, halves);
    struct test_shape sheet = test_sheet(0.5f, 0.5f, 0.1f, 2, 24);
    test_shape_refresh(&sheet);
    tl_frame frame =
        test_frame((vec3s){{1, 1.5f, 2}}, (vec3s){{0, 0.5f, 0}}, 30, &sheet.surface, 1, &environment);
    struct tl_render_settings settings = settings_of(TL_METHOD_PEM, TL_PREFILTER_CHAIN, TL_COMPOSE_RATIO);
    settings.image.width = settings.image.height = 48;
    settings.light.jitter = true;
    settings.light.rounds = 4;
    tl_image first = test_draw(device->renderer, &frame, &settings), last = {0};
    for (int round = 1; round < 6; round++) {
        tl_image_release(&last);
        last = test_draw(device->renderer, &frame, &settings);
    }
    assert_memory_not_equal(first.texels, last.texels, (size_t)48 * 48 * 4 * sizeof(float));
    const tl_plan *plan = tl_renderer_last_plan(device->renderer);
    for (int i = 0; i < plan->count; i++)
        assert_int_not_equal(plan->rows[i].action, TL_JOB_RUN); /* at rest nothing is done */
    frame.camera.eye.x += 0.5f;
    tl_image elsewhere = test_draw(device->renderer, &frame, &settings);
    frame.camera.eye.x -= 0.5f;
    tl_image again = test_draw(device->renderer, &frame, &settings);
    assert_memory_equal(first.texels, again.texels, (size_t)48 * 48 * 4 * sizeof(float));
    tl_image_release(&first);
    tl_image_release(&last);
    tl_image_release(&elsewhere);
    tl_image_release(&again);
    test_shape_release(&sheet);
    tl_environment_release(&environment);
}

static vec3s mean_colour(const tl_image *image)
{
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < image->width * image->height; i++)
        for (int c = 0; c < 3; c++)
            sum.raw[c] += tl_image_floats(image)[4 * i + c];
    return sum;
}

/* Satin whose colour comes from inside its threads, by maps, which have no lobe for that: not black. */
static void test_threads_by_maps(void **state)
{
    const struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open(&scene, test_environment(64, 32, test_daylight), (vec3s){{0.5f, 0.8f, 2}},
                    (vec3s){{0, 0.3f, 0}}, 25, 48, 48);
    tl_material *satin = test_scene_add(&scene, test_sphere((vec3s){{0, 0.3f, 0}}, 0.3f, 32));
    satin->diffuse = (vec3s){{0.05f, 0.02f, 0.01f}};
    satin->specular = (vec3s){{0.04f, 0.04f, 0.04f}};
    satin->glossiness = 0.3f;
    satin->gloss = (struct tl_gloss){
        .model = TL_REFLECT_WARD, .ward = TL_WARD_BOUNDED, .width_weft = 0.5f, .width_warp = 0.2f};
    satin->thread_count = 1;
    satin->threads[0] = (struct tl_thread){{{9, 9, 9}}, 0.5f, 0.2f};
    test_scene_refresh(&scene);
    scene.settings.light.method = TL_METHOD_REFERENCE;
    scene.settings.reference.strata = 256;
    tl_image exact = test_scene_draw(&scene, device->renderer);
    const vec3s truth = mean_colour(&exact);
    scene.settings.light.method = TL_METHOD_PEM;
    for (int lobe = TL_LOBE_SINGLE; lobe <= TL_LOBE_DUAL; lobe++) {
        scene.settings.light.lobe = lobe;
        tl_image drawn = test_scene_draw(&scene, device->renderer);
        const vec3s mean = mean_colour(&drawn);
        printf("%s lobe: %+.1f %+.1f %+.1f %%\n", lobe == TL_LOBE_SINGLE ? "single" : "dual",
               100 * (double)(mean.x / truth.x - 1), 100 * (double)(mean.y / truth.y - 1),
               100 * (double)(mean.z / truth.z - 1));
        assert_colour(mean, truth, 0.6f); /* without its threads it has lost nine tenths */
        tl_image_release(&drawn);
    }
    tl_image_release(&exact);
    test_scene_close(&scene);
}

/* Relative RMSE of the scene's image against `exact`. */
static double error_of(const struct test_scene *scene, tl_renderer *renderer, const tl_image *exact)
{
    return test_scene_error(scene, renderer, exact).rel_rmse;
}

/* Gloss of facets, by PEMs, lobe by lobe: nearer to its integral by ray tracing than the lobe about the
 * mirror direction that stood for it. On a ball nothing is in the way of any light. */
static void test_sums_of_lobes(void **state)
{
    const struct test_device *device = *state;
    const struct tl_gloss glosses[] = {
        {.model = TL_REFLECT_WARD, .ward = TL_WARD_BOUNDED, .width_weft = 0.5f, .width_warp = 0.1f},
        {.model = TL_REFLECT_TORRANCE_SPARROW, .width_weft = 0.4f, .width_warp = 0.4f}};
    for (size_t i = 0; i < sizeof glosses / sizeof *glosses; i++) {
        struct test_scene scene;
        test_scene_open(&scene, test_environment(64, 32, test_daylight), (vec3s){{0.5f, 0.8f, 2}},
                        (vec3s){{0, 0.3f, 0}}, 25, 48, 48);
        tl_material *material = test_scene_add(&scene, test_sphere((vec3s){{0, 0.3f, 0}}, 0.3f, 32));
        material->diffuse = (vec3s){{0.05f, 0.02f, 0.01f}};
        material->specular = (vec3s){{0.5f, 0.4f, 0.3f}};
        material->glossiness = 0.9f;
        material->gloss = glosses[i];
        test_scene_refresh(&scene);
        scene.settings.light.method = TL_METHOD_REFERENCE;
        scene.settings.reference.strata = 1024;
        tl_image exact = test_scene_draw(&scene, device->renderer);
        scene.settings.light.method = TL_METHOD_UNSHADOWED;
        scene.settings.light.lobe = TL_LOBE_DUAL;
        scene.settings.light.pem_size = 64;
        scene.settings.light.lobes = 5;
        double sum = error_of(&scene, device->renderer, &exact);
        scene.settings.light.pem_layout = TL_PEM_PARABOLOID;
        double in_paraboloids = error_of(&scene, device->renderer, &exact);
        scene.settings.light.pem_layout = TL_PEM_CUBE;
        scene.settings.light.lobes = 1;
        double one = error_of(&scene, device->renderer, &exact);
        scene.shapes[0].material.gloss.model = TL_REFLECT_PHONG;
        test_scene_refresh(&scene);
        double phong = error_of(&scene, device->renderer, &exact);
        printf("model %d: five lobes %.3f, in paraboloids %.3f, one lobe %.3f, about the mirror direction "
               "%.3f\n",
               (int)glosses[i].model, sum, in_paraboloids, one, phong);
        assert_true(sum < 0.4 * phong && in_paraboloids < 0.4 * phong);
        assert_true(i > 0 || sum < 0.4 * one); /* a strongly anisotropic gloss is no lobe */
        tl_image_release(&exact);
        test_scene_close(&scene);
    }
}

/* From below the ground is not there: a ball stands in the same pixels as without it, and nothing else does.
 */
static void test_ground_from_below(void **state)
{
    const struct test_device *device = *state;
    const int methods[] = {TL_METHOD_PEM, TL_METHOD_REFERENCE};
    struct test_scene scene;
    test_scene_open(&scene, test_environment(64, 32, test_daylight), (vec3s){{0.3f, -0.7f, 1.5f}},
                    (vec3s){{0, 0.4f, 0}}, 40, 48, 48);
    test_scene_add(&scene, test_sphere((vec3s){{0, 0.4f, 0}}, 0.3f, 32));
    test_scene_refresh(&scene);
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
        for (int by_rays = 0; by_rays < 2; by_rays++) {
            tl_image images[2];
            if (by_rays)
                test_scene_use_rays(&scene, 24, 1);
            scene.settings.light.method = methods[m];
            for (int ground = 0; ground < 2; ground++) {
                scene.settings.image.ground = ground;
                images[ground] = test_scene_draw(&scene, device->renderer);
            }
            for (int i = 0; i < 48 * 48; i++)
                assert_near(tl_image_floats(&images[1])[4 * i + 3], tl_image_floats(&images[0])[4 * i + 3],
                            1e-6);
            assert_true(test_brightest(&images[1]) > 0);
            tl_image_release(&images[0]);
            tl_image_release(&images[1]);
        }
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact_light),
        cmocka_unit_test(test_unoccluded_is_exact),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_methods_at_a_wall),
        cmocka_unit_test(test_sun_apart),
        cmocka_unit_test(test_sun_in_a_narrow_lobe),
        cmocka_unit_test(test_sun_casts_a_shadow),
        cmocka_unit_test(test_average_restarts),
        cmocka_unit_test(test_threads_by_maps),
        cmocka_unit_test(test_sums_of_lobes),
        cmocka_unit_test(test_ground_from_below),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
