/* The gallery's parts that need no device: integrals against a furnace and a closed form, the scale of
 * differences, heads, and the record that a stopped run continues from. */
#include "tests/testing.h"

#include "app/lab/experiments/experiments.h"
#include "app/lab/gallery/integral.h"
#include "app/lab/gallery/panels.h"
#include "app/lab/gallery/shots.h"
#include "app/lab/gallery/store.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Integrals ---- */

/* One pixel, whose four samples lie at the origin with one normal, seen from `eye`. */
struct scene {
    tl_environment environment;
    tl_image normals, points, diffuse, covered;
    struct tl_settings settings;
    vec3s eye;
};

static tl_image same_texels(int channels, const float texel[])
{
    tl_image image = tl_image_create(2, 2, channels, TL_IMAGE_F32);
    for (int i = 0; i < 4; i++)
        memcpy(tl_image_floats(&image) + i * channels, texel, (size_t)channels * sizeof *texel);
    return image;
}

static void begin(struct scene *scene, vec3s normal, vec3s eye, const char *const assignments[])
{
    const struct tl_settings_source source = {.scene_file = "gallery"};
    tl_error error = {0};
    assert_ok(tl_settings_load(&scene->settings, &source, &error), error);
    assert_ok(tl_settings_assign(&scene->settings, assignments, 8, &error), error);
    scene->environment = (tl_environment){.layout = TL_ENV_LATLONG};
    scene->environment.image = tl_image_create(128, 64, 3, TL_IMAGE_F32);
    scene->normals = same_texels(3, normal.raw);
    scene->points = same_texels(3, (const float[]){0, 0, 0});
    scene->diffuse = same_texels(3, (const float[]){1, 1, 1});
    scene->covered = same_texels(4, (const float[]){1, 1, 1, 1});
    scene->eye = eye;
}

static vec3s finish(struct scene *scene)
{
    tl_image image = tl_integral_make(&(const struct tl_integral_request){.environment = &scene->environment,
                                                                          .eye = scene->eye,
                                                                          .settings = &scene->settings,
                                                                          .normals = &scene->normals,
                                                                          .points = &scene->points,
                                                                          .diffuse = &scene->diffuse,
                                                                          .covered = &scene->covered});
    const float *texel = tl_image_floats(&image);
    vec3s light = {{texel[0], texel[1], texel[2]}};
    assert_int_equal(image.width, 1);
    assert_float_equal(texel[3], 1, 0);
    tl_image_release(&image);
    tl_image_release(&scene->environment.image);
    tl_image_release(&scene->normals);
    tl_image_release(&scene->points);
    tl_image_release(&scene->diffuse);
    tl_image_release(&scene->covered);
    return light;
}

/* In a white furnace every term of a white surface is 1, and so is a coat over it at any angle. */
static void white_furnace(void **state)
{
    (void)state;
    static const char *const all[][8] = {
        {"maps.mode=diffuse"},
        {"maps.mode=mirror"},
        {"maps.mode=refraction"},
        {"maps.mode=transmission", "material.glossiness=0.9"},
        {"maps.mode=glossy", "material.glossiness=0.97", "material.specular=[1, 1, 1]"},
        {"maps.fresnel=coat", "material.fresnel=dielectric", "material.specular=[1, 1, 1]"}};
    const vec3s eyes[] = {{{0, 0, 2}}, {{1, 0.2f, 0.3f}}, {{-3, -2, 0.5f}}};
    for (size_t m = 0; m < TL_COUNT(all); m++)
        for (size_t e = 0; e < TL_COUNT(eyes); e++) {
            struct scene scene;
            begin(&scene, (vec3s){{0, 0, 1}}, eyes[e], all[m]);
            float *texels = tl_image_floats(&scene.environment.image);
            for (size_t i = 0; i < (size_t)128 * 64 * 3; i++)
                texels[i] = 1;
            vec3s light = finish(&scene);
            for (int c = 0; c < 3; c++)
                assert_float_equal(light.raw[c], 1, 3e-3f); /* the sum's own bound: 1/432 of variance */
        }
}

/* Light that grows evenly from below to above, L = 1 + d.y: E(n, s) = 1 + n.y (s + 1)/(s + 2) about n, for
 * the mean of the cosine over K_s is (s + 1)/(s + 2). A mirror reads 1 + r.y. */
static void linear_light(void **state)
{
    (void)state;
    static const struct {
        const char *assignments[8];
        double exponent; /* 0: a ray */
    } all[] = {{{"maps.mode=diffuse"}, 1},
               {{"maps.mode=glossy", "material.glossiness=0.9", "material.specular=[1, 1, 1]"}, 10},
               {{"maps.mode=mirror"}, 0}};
    for (size_t m = 0; m < TL_COUNT(all); m++) {
        struct scene scene;
        vec3s n = glms_vec3_normalize((vec3s){{0.2f, 0.7f, 0.5f}});
        begin(&scene, n, glms_vec3_scale(n, 2), all[m].assignments);
        for (int y = 0; y < 64; y++)
            for (int i = 0; i < 128 * 3; i++)
                tl_image_floats(&scene.environment.image)[y * 128 * 3 + i] =
                    (float)(1 + cos(M_PI * (y + 0.5) / 64));
        double s = all[m].exponent, mean = s > 0 ? (s + 1) / (s + 2) : 1;
        assert_float_equal(finish(&scene).x, (float)(1 + (double)n.y * mean), 3e-3f);
    }
}

/* ---- Differences ---- */

static struct tl_gallery_shot grey_shot(float value)
{
    struct tl_gallery_shot shot = {.light = tl_image_create(64, 64, 4, TL_IMAGE_F32),
                                   .shown = tl_image_create(64, 64, 3, TL_IMAGE_U8)};
    for (size_t i = 0; i < (size_t)64 * 64; i++)
        for (size_t c = 0; c < 4; c++)
            tl_image_floats(&shot.light)[4 * i + c] = c < 3 ? value : 1;
    return shot;
}

static void scale_holds_the_differences(void **state)
{
    (void)state;
    struct tl_gallery_shot exact = grey_shot(0.5f), equal = grey_shot(0.5f), other = grey_shot(0.53f);
    assert_true(tl_panels_end(&(const struct tl_panel_row){&exact, &equal}, 1) == 0);
    const struct tl_panel_row row = {&exact, &other};
    assert_float_equal((float)tl_panels_end(&row, 1), 0.05f, 1e-7f);
    tl_image_floats(&other.light)[0] = 1000; /* one pixel does not set the scale */
    assert_float_equal((float)tl_panels_end(&row, 1), 0.05f, 1e-7f);
    int width, height;
    tl_panels_size(1, 64, &width, &height);
    tl_image picture = tl_panels_make(&row, 1, 64, "exact", "tested", 0.05);
    assert_int_equal(picture.width, width);
    assert_int_equal(picture.height, height);
    tl_image_release(&picture);
    tl_gallery_shot_release(&exact);
    tl_gallery_shot_release(&equal);
    tl_gallery_shot_release(&other);
}

/* Errors under one noise keep their order, and are what they are without noise. */
static void noise_keeps_the_order(void **state)
{
    (void)state;
    const double noise = 0.036;
    double before = 0;
    for (double error = 0; error < 0.2; error += 1e-4) {
        const double measured = hypot(error, noise), found = tl_gallery_error_less_noise(measured, noise);
        assert_true(found >= before);
        assert_near(found, fmax(error, noise / 4), 1e-9);
        assert_near(tl_gallery_error_less_noise(error, 0), error, 1e-12);
        before = found;
    }
}

static int count_cut(const struct tl_experiment *section, char *head)
{
    const bool fits = tl_panels_head_fits(tl_shots_side(section), head);
    if (!fits)
        print_error("%s: \"%s\" is cut off\n", section->name, head);
    free(head);
    return !fits;
}

/* The heads above every picture are shown whole. */
static void heads_fit(void **state)
{
    (void)state;
    int cut = 0;
    const struct tl_experiment *section;
    assert_false(tl_panels_head_fits(256, "a head of so many words that it takes three lines above a picture "
                                          "of 256 pixels, not two"));
    for (size_t i = 0; (section = tl_experiment_at(TL_OUTPUT_PICTURES, i)); i++) {
        struct tl_experiment_picture picture = {.experiment = section};
        cut += count_cut(section, tl_gallery_exact_head(section));
        while (tl_picture_next(&picture, TL_OUTPUT_PICTURES))
            cut += count_cut(section, tl_picture_name(&picture, TL_OUTPUT_PICTURES));
    }
    assert_int_equal(cut, 0);
}

/* ---- The record ---- */

/* The entries of a section, with errors given in order for both objects. */
static size_t make_entries(const char *section, const double errors[], struct tl_gallery_entry entries[])
{
    struct tl_experiment_picture picture = {.experiment = tl_experiment_find(TL_OUTPUT_PICTURES, section)};
    size_t count = 0;
    while (tl_picture_next(&picture, TL_OUTPUT_PICTURES)) {
        entries[count] = (struct tl_gallery_entry){.picture = picture};
        entries[count].figures.error[0] = entries[count].figures.error[1] = errors[count];
        count++;
    }
    return count;
}

static void record_gives_figures_back(void **state)
{
    (void)state;
    tl_error error = {0};
    const char *folder = TOILE_SCRATCH_DIR "/gallery_record";
    const double errors[8] = {0.25, 0.125, 0.5, 0.75};
    struct tl_gallery_entry entries[8];
    make_entries("a9", errors, entries);
    entries[0].image = "a9-01.png";
    entries[0].figures.time_ms[1] = 12.5;
    assert_ok(tl_folder_make(folder, &error), error);
    unlink(TOILE_SCRATCH_DIR "/gallery_record/gallery.json");
    unlink(TOILE_SCRATCH_DIR "/gallery_record/a9-01.png");
    tl_gallery_store *store = tl_gallery_store_open(folder, &error);
    assert_ok(store != NULL, error);
    assert_ok(tl_gallery_store_put(store, 7, &entries[0], &error), error);
    tl_gallery_store_close(&store);
    store = tl_gallery_store_open(folder, &error);
    assert_ok(store != NULL, error);
    struct tl_gallery_entry found = {.image = "a9-01.png"};
    assert_false(tl_gallery_store_find(store, 7, &found)); /* the picture is not there */
    FILE *picture = fopen(TOILE_SCRATCH_DIR "/gallery_record/a9-01.png", "w");
    assert_non_null(picture);
    fclose(picture);
    assert_false(tl_gallery_store_find(store, 8, &found));
    assert_true(tl_gallery_store_find(store, 7, &found));
    assert_memory_equal(&found.figures, &entries[0].figures, sizeof found.figures);
    assert_ok(tl_gallery_store_forget(store, &found, &error), error);
    assert_false(tl_gallery_store_find(store, 7, &found));
    tl_gallery_store_close(&store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace),
        cmocka_unit_test(linear_light),
        cmocka_unit_test(scale_holds_the_differences),
        cmocka_unit_test(noise_keeps_the_order),
        cmocka_unit_test(heads_fit),
        cmocka_unit_test(record_gives_figures_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
