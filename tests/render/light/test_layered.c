/* Materials that are more than two cosine lobes, lit by rays: each against the oracle, which knows their true
 * gloss; what a scene without them is spared; and their extremes. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/metrics/compare.h"

#include "tests/testing.h"

#include <string.h>

#define WIDTH  48
#define HEIGHT 36

static vec3s daylight(vec3s d)
{
    bool window = fabsf(d.x) < 0.4f && d.y > 0.1f && d.y < 0.7f && d.z < 0;
    float sky = 0.5f + 0.3f * d.y;
    return window ? (vec3s){{6, 6, 5}} : (vec3s){{sky, sky, sky}};
}

/* A sun of 2 degrees, which texels of 64 x 32 do not show. */
static vec3s noon(vec3s d)
{
    bool sun = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.7f, 0.6f, 0.4f}})) > 0.9994f;
    return sun ? (vec3s){{1000, 1000, 900}} : (vec3s){{0.2f, 0.2f, 0.2f}};
}

/* A sheet that hangs over a ball. */
static void scene_open(struct test_scene *scene, test_radiance *radiance)
{
    const int height = radiance == noon ? 128 : 32;
    test_scene_open(scene, test_environment(2 * height, height, radiance), (vec3s){{0.6f, 1.4f, 1.8f}},
                    (vec3s){{0, 0.6f, 0}}, 40, WIDTH, HEIGHT);
    tl_material *sheet = test_scene_add(scene, test_sheet(0.9f, 0.6f, 0.05f, 2, 24));
    tl_material *ball = test_scene_add(scene, test_sphere((vec3s){{0, 0.4f, 0}}, 0.35f, 32));
    sheet->diffuse = (vec3s){{0.4f, 0.3f, 0.3f}};
    sheet->glossiness = 0.9f;
    sheet->specular = (vec3s){{0.2f, 0.2f, 0.2f}};
    ball->diffuse = (vec3s){{0.2f, 0.3f, 0.5f}};
    scene->frame.still = true;
    test_scene_use_rays(scene, 96, 8);
    scene->settings.light.lobes = 7;
    scene->settings.reference.strata = 512;
    scene->settings.reference.replicates = 4;
}

static tl_image draw(tl_renderer *renderer, struct test_scene *scene, int method)
{
    test_scene_refresh(scene);
    scene->settings.light.method = method;
    return test_scene_draw(scene, renderer);
}

struct feature {
    const char *name;
    int model;
    float weft, warp, coat, transmission, openness;
    int ward;
    double error; /* relative RMSE against the oracle at most: see test_against_the_oracle */
    float fuzz;
    int facets;   /* 0: Beckmann's */
    int threads;  /* systems of threads with a lobe of their own */
    float follow; /* of fuzz, which stands on bumps then */
    float roughness;
};

static const struct feature features[] = {
    {.name = "two lobes", .error = 0.05},
    {.name = "ward", .model = TL_REFLECT_WARD, .weft = 0.35f, .warp = 0.12f, .error = 0.05},
    {.name = "ward, turned", .model = TL_REFLECT_WARD, .weft = 0.12f, .warp = 0.35f, .error = 0.05},
    {.name = "ward, bounded", TL_REFLECT_WARD, 0.35f, 0.12f, .ward = TL_WARD_BOUNDED, .error = 0.07},
    {.name = "satin's threads",
     TL_REFLECT_WARD,
     0.16f,
     0.07f,
     .ward = TL_WARD_BOUNDED,
     .error = 0.09,
     .threads = 1},
    {.name = "shot silk",
     TL_REFLECT_WARD,
     0.16f,
     0.16f,
     .ward = TL_WARD_BOUNDED,
     .error = 0.09,
     .threads = 2},
    {.name = "torrance-sparrow", .model = TL_REFLECT_TORRANCE_SPARROW, .weft = 0.25f, .error = 0.05},
    {.name = "ggx",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.25f,
     .error = 0.08,
     .facets = TL_FACETS_GGX},
    {.name = "blinn-phong", .model = TL_REFLECT_BLINN_PHONG, .error = 0.05},
    {.name = "cosine lobe", .model = TL_REFLECT_COSINE_LOBE, .error = 0.05},
    {.name = "banks", .model = TL_REFLECT_BANKS, .error = 0.05},
    {.name = "coat", .coat = 1, .error = 0.05},
    {.name = "rough", .error = 0.05, .roughness = 0.7f},
    {.name = "transmission", .transmission = 0.5f, .error = 0.05},
    {.name = "openness", .openness = 0.4f, .error = 0.05},
    {.name = "fuzz", .fuzz = 1, .error = 0.05},
    {.name = "fuzz over a coat", .coat = 1, .fuzz = 0.5f, .transmission = 0.3f, .error = 0.05},
    {.name = "bumps", .error = 0.1, .follow = 1}, /* alone: what any lobe errs by on them */
    {.name = "fuzz of a pile", .fuzz = 1, .error = 0.1, .follow = 1},
    {.name = "all", TL_REFLECT_WARD, 0.35f, 0.12f, 1, 0.3f, 0.4f, .error = 0.05, .fuzz = 0.4f},
};

/* The normals of a pile that leans by up to 35 degrees in patches much wider than a pixel. */
static tl_image patches;

static void make_patches(void)
{
    enum { TEXELS = 64 };
    patches = tl_image_create(TEXELS, TEXELS, 3, TL_IMAGE_U8);
    patches.linear = true;
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        const int row = i / TEXELS;
        const float x = 2 * GLM_PIf * (float)(i % TEXELS) / TEXELS, y = 2 * GLM_PIf * (float)row / TEXELS;
        const vec3s n = glms_vec3_normalize((vec3s){{0.5f * sinf(2 * x + y), 0.5f * cosf(2 * y), 1}});
        for (int c = 0; c < 3; c++)
            tl_image_bytes(&patches)[3 * i + c] = (uint8_t)lroundf(255 * (0.5f + 0.5f * n.raw[c]));
    }
}

static void set_feature(const struct feature *feature, tl_material *material)
{
    material->gloss.model = feature->model;
    material->gloss.ward = feature->ward;
    material->gloss.facets = feature->facets ? feature->facets : TL_FACETS_BECKMANN;
    material->gloss.width_weft = feature->weft;
    material->gloss.width_warp = feature->warp;
    material->coat = feature->coat;
    material->diffuse_roughness = feature->roughness;
    material->coat_glossiness = 0.97f;
    material->transmission = (vec3s){{feature->transmission, feature->transmission, feature->transmission}};
    material->openness = feature->openness;
    material->thread_count = feature->threads;
    material->threads[0] = (struct tl_thread){{{0.3f, 2, 1}}, 0.45f, 0.15f};
    material->threads[1] = (struct tl_thread){{{1.5f, 0.1f, 0.5f}}, 0.15f, 0.45f};
    material->fuzz.colour = (vec3s){{feature->fuzz, 0.8f * feature->fuzz, 0.6f * feature->fuzz}};
    material->fuzz.follow = feature->follow;
    if (feature->follow > 0)
        material->normal_map = (struct tl_map){.image = &patches, .transform = {.scale = {1, 1}}};
}

/* Images may err as much as the method does with two lobes (3 to 5 % when each pixel has one sample), though
 * the sheet is seen at some 70 degrees from its normal, where the horizon cuts lobes in half and a set of
 * lobes errs most. Threads are narrow, and the oracle itself has 2 % there; the tails of GGX reach below that
 * horizon. The set's own error is in test_lobe_fit. Alpha is what is covered and not looked through, and must
 * agree but for the edges' pixels. */
static void test_against_the_oracle(void **state)
{
    const struct test_device *device = *state;
    for (size_t i = 0; i < TL_COUNT(features); i++) {
        struct test_scene scene;
        struct tl_comparison comparison;
        tl_error error = {0};
        scene_open(&scene, daylight);
        set_feature(&features[i], &scene.shapes[0].material);
        tl_image image = draw(device->renderer, &scene, TL_METHOD_PEM);
        tl_image truth = draw(device->renderer, &scene, TL_METHOD_REFERENCE);
        assert_ok(tl_image_compare(&image, &truth, -1, 0, &comparison, &error), error);
        double alpha = 0;
        for (int p = 0; p < WIDTH * HEIGHT; p++)
            alpha += (double)fabsf(tl_image_floats(&image)[4 * p + 3] - tl_image_floats(&truth)[4 * p + 3]);
        printf("%-18s error %.2f %%, of the oracle %.2f %%, alpha off by %.4f a pixel\n", features[i].name,
               100 * comparison.rel_rmse, 100 * tl_renderer_standard_error(device->renderer),
               alpha / (WIDTH * HEIGHT));
        assert_true(comparison.rel_rmse < features[i].error);
        assert_true(alpha / (WIDTH * HEIGHT) < 0.002);
        tl_image_release(&image);
        tl_image_release(&truth);
        test_scene_close(&scene);
    }
}

/* A sun on diffuse lobes of their own: no worse than on Lambert's by more than what the light of
 * the sky around it is off by, whose factor is a mean. */
static void test_sun_on_diffuse_lobes(void **state)
{
    const struct test_device *device = *state;
    static const struct feature diffuse[] = {{.name = "two lobes"},
                                             {.name = "rough", .roughness = 0.7f},
                                             {.name = "banks", .model = TL_REFLECT_BANKS}};
    double lambert = 0;
    for (size_t i = 0; i < TL_COUNT(diffuse); i++) {
        struct test_scene scene;
        struct tl_comparison comparison;
        tl_error error = {0};
        scene_open(&scene, noon);
        set_feature(&diffuse[i], &scene.shapes[0].material);
        scene.shapes[0].material.specular = (vec3s){{0, 0, 0}};
        tl_image image = draw(device->renderer, &scene, TL_METHOD_PEM);
        tl_image truth = draw(device->renderer, &scene, TL_METHOD_REFERENCE);
        assert_ok(tl_image_compare(&image, &truth, -1, 0, &comparison, &error), error);
        printf("sun on %-10s error %.2f %%, of the oracle %.2f %%\n", diffuse[i].name,
               100 * comparison.rel_rmse, 100 * tl_renderer_standard_error(device->renderer));
        lambert = i == 0 ? comparison.rel_rmse : lambert;
        assert_true(comparison.rel_rmse < lambert + 0.02);
        tl_image_release(&image);
        tl_image_release(&truth);
        test_scene_close(&scene);
    }
}

/* Under light of 1 from everywhere nothing sends back more than 1, and open cloth shows what is behind it. */
static void test_furnace(void **state)
{
    const struct test_device *device = *state;
    for (size_t i = 0; i < TL_COUNT(features); i++) {
        struct test_scene scene;
        scene_open(&scene, test_white);
        set_feature(&features[i], &scene.shapes[0].material);
        scene.shapes[0].material.diffuse = (vec3s){{0, 0, 0}};
        scene.shapes[0].material.specular = (vec3s){{1, 1, 1}};
        if (features[i].transmission > 0)
            scene.shapes[0].material.specular = (vec3s){{0.5f, 0.5f, 0.5f}};
        tl_image image = draw(device->renderer, &scene, TL_METHOD_PEM);
        float maximum = 0;
        for (int p = 0; p < 4 * WIDTH * HEIGHT; p++)
            maximum = fmaxf(maximum, tl_image_floats(&image)[p]);
        printf("%-18s sends back %.3f at most\n", features[i].name, (double)maximum);
        assert_true(maximum < 1.1f); /* test_lobe_fit: up to 9 % too much towards some viewers */
        tl_image_release(&image);
        test_scene_close(&scene);
    }
}

static bool runs(const tl_plan *plan, const char *name)
{
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, name) == 0)
            return plan->rows[i].action != TL_JOB_DROP;
    fail_msg("no job %s", name);
    return false;
}

/* A feature that is taken away takes its jobs and its memory with it. */
static void test_only_what_the_scene_requires(void **state)
{
    const struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, daylight);
    const struct feature plain = {.name = "plain"}, all = features[TL_COUNT(features) - 1];
    tl_image image = draw(device->renderer, &scene, TL_METHOD_PEM);
    struct tl_render_memory before = tl_renderer_memory(device->renderer);
    assert_false(runs(tl_renderer_last_plan(device->renderer), "transparency"));
    assert_int_equal(before.transparency, 0);
    tl_image_release(&image);

    set_feature(&all, &scene.shapes[0].material);
    image = draw(device->renderer, &scene, TL_METHOD_PEM);
    struct tl_render_memory with = tl_renderer_memory(device->renderer);
    assert_true(runs(tl_renderer_last_plan(device->renderer), "transparency"));
    assert_true(with.transparency > 0);
    assert_int_equal(with.targets - before.targets, 8 * WIDTH * HEIGHT); /* the layer of facets */
    assert_true(with.pems > before.pems); /* exponents of the lobes and the coat */
    tl_image_release(&image);

    set_feature(&plain, &scene.shapes[0].material);
    image = draw(device->renderer, &scene, TL_METHOD_PEM);
    struct tl_render_memory after = tl_renderer_memory(device->renderer);
    assert_false(runs(tl_renderer_last_plan(device->renderer), "transparency"));
    assert_int_equal(after.transparency, 0);
    assert_int_equal(after.targets, before.targets);
    tl_image_release(&image);
    test_scene_close(&scene);
}

static void check_sane(const tl_image *image, const char *name)
{
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const float *pixel = tl_image_floats(image) + 4 * (size_t)p;
        for (int c = 0; c < 4; c++)
            if (!(pixel[c] >= 0 && pixel[c] < 1e4f))
                fail_msg("%s: channel %d of pixel %d is %g", name, c, p, (double)pixel[c]);
        assert_true(pixel[3] <= 1.0001f);
    }
}

static void test_extremes(void **state)
{
    const struct test_device *device = *state;
    static const struct feature extremes[] = {
        {.name = "widths 1e-3", .model = TL_REFLECT_WARD, .weft = 1e-3f, .warp = 1e-3f},
        {.name = "widths 1 and 1e-3", .model = TL_REFLECT_WARD, .weft = 1, .warp = 1e-3f},
        {.name = "facets 1", .model = TL_REFLECT_TORRANCE_SPARROW, .weft = 1},
        {.name = "open .99", .openness = 0.99f},
        {.name = "all through", .transmission = 1},
        {.name = "all fuzz", .fuzz = 1},
        {.name = "everything", TL_REFLECT_BANKS, 1e-3f, 1, 1, 1, 0.99f, 0},
    };
    const float glossinesses[] = {0, 0.5f, 1};
    for (size_t i = 0; i < TL_COUNT(extremes); i++)
        for (size_t g = 0; g < TL_COUNT(glossinesses); g++) {
            const int methods[] = {TL_METHOD_PEM, TL_METHOD_UNSHADOWED, TL_METHOD_REFERENCE};
            struct test_scene scene;
            scene_open(&scene, daylight);
            set_feature(&extremes[i], &scene.shapes[0].material);
            scene.shapes[0].material.glossiness = glossinesses[g];
            scene.shapes[0].material.coat_glossiness = glossinesses[g];
            scene.shapes[0].material.coat = 1;
            scene.settings.light.rounds = 1;
            scene.settings.reference.strata = 16;
            scene.settings.reference.replicates = 1;
            for (int m = 0; m < 3; m++) {
                tl_image image = draw(device->renderer, &scene, methods[m]);
                check_sane(&image, extremes[i].name);
                tl_image_release(&image);
            }
            test_scene_close(&scene);
        }
}

int main(void)
{
    make_patches();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_the_oracle), cmocka_unit_test(test_sun_on_diffuse_lobes),
        cmocka_unit_test(test_furnace), cmocka_unit_test(test_only_what_the_scene_requires),
        cmocka_unit_test(test_extremes)};
    const int failed = cmocka_run_group_tests_name("layered", tests, test_device_open, test_device_close);
    tl_image_release(&patches);
    return failed;
}
