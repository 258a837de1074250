#include "tests/render/drawn_scene.h"

#include "assets/weave/weave.h"
#include "render/reference/random.h"

#include "tests/testing.h"

#include <string.h>

#define TEXELS 64 /* a side of the maps */

/* A dim blue sky, a warm wide lamp on one side, a sun on the other: nothing is the same when it is turned.
 * The sun is so small that its penumbrae are as narrow as the samples' path looks for them; pixels find wider
 * ones, too (test_sun_pixels.c). */
static vec3s lopsided(vec3s d)
{
    if (glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.7f, 0.9f, 0.4f}})) > 0.99996f)
        return (vec3s){{9000, 8100, 7200}};
    float lamp = fmaxf(glms_vec3_dot(d, glms_vec3_normalize((vec3s){{-0.8f, 0.5f, 0.5f}})), 0);
    float warm = 2.5f * powf(lamp, 12);
    return (vec3s){{0.15f + warm, 0.2f + 0.6f * warm, 0.3f + 0.1f * d.y + 0.3f * warm}};
}

static void make_maps(struct drawn_scene *drawn)
{
    struct tl_random random = tl_random_begin(18, 1);
    drawn->maps[MAP_COLOUR] = tl_image_create(TEXELS, TEXELS, 3, TL_IMAGE_U8);
    drawn->maps[MAP_NORMAL] = tl_image_create(TEXELS, TEXELS, 3, TL_IMAGE_U8);
    drawn->maps[MAP_GLOSS] = tl_image_create(TEXELS, TEXELS, 1, TL_IMAGE_U8);
    drawn->maps[MAP_HOLES] = tl_image_create(TEXELS, TEXELS, 4, TL_IMAGE_U8);
    drawn->maps[MAP_NORMAL].linear = drawn->maps[MAP_GLOSS].linear = true;
    for (size_t y = 0; y < TEXELS; y++)
        for (size_t x = 0; x < TEXELS; x++) {
            size_t i = y * TEXELS + x;
            /* Stripes across u, so that a map that is mirrored or turned shows. */
            uint8_t stripe = x % 16 < 5 ? 60 : 200;
            uint8_t *colour = tl_image_bytes(&drawn->maps[MAP_COLOUR]) + 3 * i;
            colour[0] = stripe, colour[1] = (uint8_t)(2 * x + y), colour[2] = 120;
            vec3s n =
                glms_vec3_normalize((vec3s){{0.3f * sinf(0.8f * (float)x), 0.2f * cosf(0.4f * (float)y), 1}});
            for (size_t c = 0; c < 3; c++)
                tl_image_bytes(&drawn->maps[MAP_NORMAL])[3 * i + c] =
                    (uint8_t)lroundf(255 * (0.5f + 0.5f * n.raw[c]));
            tl_image_bytes(&drawn->maps[MAP_GLOSS])[i] = (uint8_t)(200 + 55 * tl_random_unit(&random));
            uint8_t *holes = tl_image_bytes(&drawn->maps[MAP_HOLES]) + 4 * i;
            holes[0] = holes[1] = holes[2] = 180;
            holes[3] = x % 16 < 4 && y % 16 < 6 ? 0 : 255;
        }
}

struct tl_map drawn_scene_map(const tl_image *image)
{
    return (struct tl_map){.image = image, .transform = {.scale = {3, 2}, .rotation = 0.2f}};
}

/* A ball under a draped sheet above the ground. */
void drawn_scene_open(struct drawn_scene *drawn, int width, int height)
{
    *drawn = (struct drawn_scene){0};
    make_maps(drawn);
    struct test_scene *scene = &drawn->scene;
    test_scene_open(scene, test_environment(512, 256, lopsided), (vec3s){{0.8f, 1.5f, 2}},
                    (vec3s){{0, 0.6f, 0}}, 40, width, height);
    test_scene_add(scene, test_sphere((vec3s){{0, 0.45f, 0}}, 0.38f, 32));
    test_scene_add(scene, test_sheet(1, 0.55f, 0.07f, 2, 48));
    struct tl_render_settings *settings = &scene->settings;
    settings->light.visibility = TL_VISIBILITY_RAYS;
    settings->light.method = TL_METHOD_PEM;
    settings->light.lobe = TL_LOBE_DUAL;
    settings->light.composition = TL_COMPOSE_RATIO;
    settings->light.regions = 48;
    settings->light.pem_size = 64;
    settings->light.rounds = 1;
    settings->light.repair = settings->light.repair_rest = 0;
    settings->light.sun = true;
    settings->light.reflect_scene = true;
    settings->image.supersample = 1;
    settings->image.ground = true;
    settings->detail.minify = TL_DETAIL_MINIFY_LEAN;
    scene->frame.still = true;
    drawn->plain = *scene;
}

void drawn_scene_close(struct drawn_scene *drawn)
{
    test_scene_close(&drawn->scene);
    tl_weave_release(&drawn->weave);
    tl_weave_release(&drawn->streaked);
    for (int i = 0; i < MAP_COUNT; i++)
        tl_image_release(&drawn->maps[i]);
}

void drawn_scene_edit(struct drawn_scene *drawn, editor *change)
{
    struct test_scene *scene = &drawn->scene;
    scene->settings = drawn->plain.settings;
    scene->frame = drawn->plain.frame;
    for (size_t i = 0; i < scene->shape_count; i++) {
        scene->shapes[i].material = tl_material_default("test");
        scene->shapes[i].material.double_sided = true;
    }
    change(drawn);
    test_scene_refresh(scene);
}

tl_material *drawn_scene_cloth(struct drawn_scene *drawn)
{
    return &drawn->scene.shapes[1].material;
}

void be_matt(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->diffuse = (vec3s){{0.6f, 0.3f, 0.2f}};
}

void be_glossy(struct drawn_scene *drawn)
{
    for (int i = 0; i < 2; i++) {
        drawn->scene.shapes[i].material.specular = (vec3s){{0.3f, 0.2f, 0.1f}};
        drawn->scene.shapes[i].material.glossiness = 0.9f;
    }
}

void be_satin(struct drawn_scene *drawn)
{
    tl_material *cloth = drawn_scene_cloth(drawn);
    cloth->diffuse = (vec3s){{0.3f, 0.022f, 0.045f}};
    cloth->specular = (vec3s){{0.12f, 0.1f, 0.1f}};
    cloth->glossiness = 0.94f;
    cloth->gloss.model = TL_REFLECT_WARD;
    cloth->gloss.width_weft = 0.3f;
    cloth->gloss.width_warp = 0.1f;
    cloth->gloss.rotation = 0.3f;
}

void be_fuzzy(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->fuzz = (struct tl_fuzz){{{1, 0.7f, 0.4f}}, 0.5f, 0};
}

void be_woven(struct drawn_scene *drawn)
{
    struct tl_weave_params params = *(const struct tl_weave_params *)tl_weave_options.defaults;
    params.pattern = TL_WEAVE_TWILL;
    params.warp_pitch_mm = params.weft_pitch_mm = 5;
    params.crimp_mm = 1.2f;
    params.weft_tint[0] = params.weft_tint[1] = 0.3f;
    if (!drawn->weave.tint.texels)
        assert_true(tl_weave_create(&params, &drawn->weave));
    be_satin(drawn);
    drawn_scene_cloth(drawn)->weave = &drawn->weave;
}

/* Yarns that differ along all of the cloth, broader than pixels and finer. */
void be_streaked(struct drawn_scene *drawn)
{
    struct tl_weave_params params = *(const struct tl_weave_params *)tl_weave_options.defaults;
    params.warp_pitch_mm = 20;
    params.weft_pitch_mm = 3;
    params.streaks = 0.5f;
    if (!drawn->streaked.yarns)
        assert_true(tl_weave_create(&params, &drawn->streaked));
    be_satin(drawn);
    drawn_scene_cloth(drawn)->weave = &drawn->streaked;
}

void be_mapped(struct drawn_scene *drawn)
{
    tl_material *cloth = drawn_scene_cloth(drawn);
    be_glossy(drawn);
    cloth->diffuse = (vec3s){{1, 1, 1}};
    cloth->diffuse_map = drawn_scene_map(&drawn->maps[MAP_COLOUR]);
    cloth->normal_map = drawn_scene_map(&drawn->maps[MAP_NORMAL]);
    cloth->gloss_map = drawn_scene_map(&drawn->maps[MAP_GLOSS]);
}

/* A sheet of voile above the ball. */
void be_voile(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->diffuse = (vec3s){{0.46f, 0.46f, 0.45f}};
    drawn_scene_cloth(drawn)->openness = 0.41f;
    drawn_scene_cloth(drawn)->transmission = (vec3s){{0.4f, 0.3f, 0.2f}};
}

void have_warp_threads(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn_scene_cloth(drawn)->thread_count = 1;
    drawn_scene_cloth(drawn)->threads[0] = (struct tl_thread){{{0.9f, 0.6f, 0.4f}}, 0.5f, 0.15f};
}

void have_threads(struct drawn_scene *drawn)
{
    have_warp_threads(drawn);
    drawn_scene_cloth(drawn)->thread_count = 2;
    drawn_scene_cloth(drawn)->threads[1] = (struct tl_thread){{{0.3f, 0.5f, 0.9f}}, 0.15f, 0.5f};
}

void have_ggx_facets(struct drawn_scene *drawn)
{
    have_threads(drawn);
    drawn_scene_cloth(drawn)->gloss.model = TL_REFLECT_TORRANCE_SPARROW;
    drawn_scene_cloth(drawn)->gloss.facets = TL_FACETS_GGX;
}

/* So large that the CPU's picture, too, reads their map as it is. */
void have_holes(struct drawn_scene *drawn)
{
    struct tl_map *map = &drawn_scene_cloth(drawn)->diffuse_map;
    *map = drawn_scene_map(&drawn->maps[MAP_HOLES]);
    map->transform.scale[0] = 0.9f;
    map->transform.scale[1] = 0.6f;
    drawn_scene_cloth(drawn)->alpha_cutoff = 0.5f;
}

void transmit(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->transmission = (vec3s){{0.2f, 0.2f, 0.2f}};
}

void be_open(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->openness = 0.3f;
}

/* The ball shines on the sheet. */
void glow(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn->scene.shapes[0].material.emission = (vec3s){{0.5f, 0.3f, 0.2f}};
}

void look_up(struct drawn_scene *drawn)
{
    drawn->scene.frame.camera.eye = (vec3s){{0.9f, 0.25f, 0.9f}};
    drawn->scene.frame.camera.target = (vec3s){{0, 0.95f, 0}};
}

/* 1 where a shape, not the ground, is seen. */
tl_image drawn_scene_mask(const struct test_device *device, const struct drawn_scene *drawn)
{
    struct test_scene scene = drawn->scene;
    scene.settings.image.ground = false;
    scene.settings.light.method = TL_METHOD_UNSHADOWED;
    tl_image image = test_draw(device->renderer, &drawn->scene.frame, &scene.settings);
    tl_image mask = tl_image_create(image.width, image.height, 1, TL_IMAGE_F32);
    for (size_t i = 0; i < (size_t)image.width * (size_t)image.height; i++)
        tl_image_floats(&mask)[i] = tl_image_floats(&image)[4 * i + 3];
    tl_image_release(&image);
    return mask;
}

/* Largest difference of cover. GL computes the ground's fading in a shader of its own. */
double drawn_scene_cover_difference(const tl_image *a, const tl_image *b)
{
    double largest = 0;
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++)
        largest =
            fmax(largest, fabs((double)(tl_image_floats(a)[4 * i + 3] - tl_image_floats(b)[4 * i + 3])));
    return largest;
}

void drawn_scene_expect_device(const tl_renderer *renderer, const struct drawn_scene *drawn, const char *text)
{
    char said[160];
    tl_renderer_describe_device(renderer, &drawn->scene.frame, &drawn->scene.settings, said, sizeof said);
    if (!strstr(said, text))
        print_error("%s\n", said);
    assert_non_null(strstr(said, text));
}

void drawn_scene_expect_same(const tl_image *a, const tl_image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->texels, b->texels, 16 * (size_t)a->width * (size_t)a->height);
}
