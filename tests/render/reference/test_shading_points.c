/* The shading points of the reference against the G-buffer: the same samples are covered, with the same
 * points, normals and materials. The two share no code except the shapes. */
#include "tests/render/scenes.h"

#include "assets/weave/weave.h"
#include "config/base/memory.h"
#include "render/inside.h"
#include "render/reference/shading_point.h"

#include "tests/testing.h"

#include <epoxy/gl.h>

#define WIDTH  96
#define HEIGHT 64

static vec3s grey(vec3s direction)
{
    (void)direction;
    return (vec3s){{1, 1, 1}};
}

/* Smooth patterns, another in each channel; alpha is a disc in the middle. */
static tl_image pattern(int width, int height, int channels, bool linear)
{
    tl_image image = tl_image_create(width, height, channels, TL_IMAGE_U8);
    image.linear = linear;
    for (int i = 0; i < width * height; i++) {
        int row = i / width;
        float u = ((float)(i % width) + 0.5f) / (float)width, v = ((float)row + 0.5f) / (float)height;
        const float values[4] = {0.5f + 0.4f * sinf(6.2832f * u), 0.5f + 0.4f * sinf(6.2832f * v),
                                 0.6f + 0.3f * sinf(6.2832f * (u + 2 * v)),
                                 hypotf(u - 0.5f, v - 0.5f) < 0.45f ? 1.0f : 0.0f};
        for (int c = 0; c < channels; c++)
            tl_image_bytes(&image)[i * channels + c] = (uint8_t)lroundf(255 * values[c]);
    }
    return image;
}

/* Unit normals, 0.5 + 0.5 n. */
static tl_image bumps(int side)
{
    tl_image image = tl_image_create(side, side, 3, TL_IMAGE_U8);
    image.linear = true;
    for (int i = 0; i < side * side; i++) {
        int row = i / side;
        float u = ((float)(i % side) + 0.5f) / (float)side, v = ((float)row + 0.5f) / (float)side;
        vec3s n = {{0.5f * sinf(6.2832f * u), 0.3f * cosf(6.2832f * v), 1}};
        n = glms_vec3_normalize(n);
        for (int c = 0; c < 3; c++)
            tl_image_bytes(&image)[3 * i + c] = (uint8_t)lroundf(127.5f + 127.5f * n.raw[c]);
    }
    return image;
}

struct maps {
    tl_image colour, colour_alpha, grey_alpha, data, normal;
    tl_weave weave;
};

static struct maps maps_make(void)
{
    struct maps maps = {.colour = pattern(32, 24, 3, false),
                        .colour_alpha = pattern(64, 64, 4, false),
                        .grey_alpha = pattern(8, 8, 2, false),
                        .data = pattern(16, 16, 1, true),
                        .normal = bumps(32),
                        .weave = {.size_m = {0.2f, 0.25f},
                                  .normal = bumps(16),
                                  .height = tl_image_create(16, 16, 1, TL_IMAGE_F32),
                                  .gloss = tl_image_create(16, 16, 1, TL_IMAGE_F32),
                                  .tint = tl_image_create(16, 16, 3, TL_IMAGE_F32)}};
    for (int i = 0; i < 256; i++) {
        tl_image_floats(&maps.weave.gloss)[i] = 0.1f * sinf((float)i * 0.3927f);
        for (int c = 0; c < 3; c++)
            tl_image_floats(&maps.weave.tint)[3 * i + c] = 0.7f + 0.2f * cosf((float)(i + 5 * c) * 0.3927f);
    }
    maps.weave.yarns = TL_NEW(struct tl_yarns); /* deviations of up to 0.3 and 0.2, in smooth waves */
    maps.weave.yarns->pitch_m[0] = 0.05f;
    maps.weave.yarns->pitch_m[1] = 0.004f;
    for (int i = 1; i < TL_WARP_YARNS; i++)
        maps.weave.yarns->sums[i] = 0.3f * sinf((float)i);
    for (int i = 1; i < TL_WEFT_YARNS; i++)
        maps.weave.yarns->sums[TL_WARP_YARNS + 1 + i] = 0.2f * sinf(0.9f * (float)i);
    return maps;
}

static void maps_free(struct maps *maps)
{
    tl_image_release(&maps->colour);
    tl_image_release(&maps->colour_alpha);
    tl_image_release(&maps->grey_alpha);
    tl_image_release(&maps->data);
    tl_image_release(&maps->normal);
    tl_weave_release(&maps->weave);
}

/* Every map with a transform of its own. */
static void use_maps(tl_material *material, const struct maps *maps)
{
    const struct tl_uv_transform turned = {.offset = {0.1f, -0.3f}, .scale = {2, 1.5f}, .rotation = 0.4f};
    const struct tl_uv_transform plain = {.scale = {1.5f, 1.5f}};
    material->diffuse_map = (struct tl_map){.image = &maps->colour, .transform = turned};
    material->normal_map = (struct tl_map){.image = &maps->normal, .transform = plain, .clamp_u = true};
    material->normal_scale = 0.7f;
    material->gloss_map = (struct tl_map){.image = &maps->data, .transform = turned, .clamp_v = true};
    material->specular_map = (struct tl_map){.image = &maps->colour, .transform = plain};
    material->occlusion_map = (struct tl_map){.image = &maps->data, .transform = plain};
    material->occlusion_strength = 0.6f;
    material->weave = &maps->weave;
    material->specular = (vec3s){{0.3f, 0.3f, 0.3f}}; /* so that what changes it is beyond the tolerance */
    material->glossiness = 0.8f;
}

struct layers {
    float point[HEIGHT * WIDTH][4], normal[HEIGHT * WIDTH][4], diffuse[HEIGHT * WIDTH][4];
    float specular[HEIGHT * WIDTH][4];
};

static void read_layer(const struct tl_gbuffer *gbuffer, enum tl_gbuffer_layer layer, float (*out)[4])
{
    glGetTextureImage(gbuffer->target.colours[layer].id, 0, GL_RGBA, GL_FLOAT, HEIGHT * WIDTH * 16, out);
}

static struct tl_shading_point look(const struct tl_reference_scene *scene, const struct tl_view *view, int x,
                                    int y)
{
    const float step_x = 2.0f / WIDTH, step_y = 2.0f / HEIGHT;
    vec3s along = glms_vec3_add(view->forward, glms_vec3_scale(view->right, ((float)x + 0.5f) * step_x - 1));
    along = glms_vec3_add(along, glms_vec3_scale(view->up, ((float)y + 0.5f) * step_y - 1));
    float length = glms_vec3_norm(along);
    const struct tl_ray_differential ray = {.origin = view->eye,
                                            .direction = glms_vec3_divs(along, length),
                                            .from_m = view->near_m * length,
                                            .to_m = view->far_m * length,
                                            .across = glms_vec3_scale(view->right, step_x / length),
                                            .down = glms_vec3_scale(view->up, step_y / length)};
    return tl_shading_point_find(scene, &ray);
}

static float largest_difference(const float *a, const float *b)
{
    return fmaxf(fabsf(a[0] - b[0]), fmaxf(fabsf(a[1] - b[1]), fabsf(a[2] - b[2])));
}

/* The number of samples that differ by more than a tolerance. */
struct tally {
    int samples, cover, point, normal, diffuse, specular, gloss;
};

static void compare(struct tally *tally, const struct tl_shading_point *found, const struct layers *layers,
                    int i)
{
    tally->samples++;
    if (fabsf(found->cover - layers->point[i][3]) > 1e-3f) {
        tally->cover++;
        return;
    }
    if (!(found->cover > 0))
        return;
    tally->point += largest_difference(found->point.raw, layers->point[i]) > 5e-4f;
    tally->normal += largest_difference(found->normal.raw, layers->normal[i]) > 0.03f;
    tally->gloss += fabsf(1 / found->exponent - layers->normal[i][3]) > 0.01f;
    tally->diffuse += largest_difference(found->diffuse.raw, layers->diffuse[i]) > 0.01f;
    /* At grazing angles Schlick's term magnifies what the normals differ by. */
    bool grazing = glms_vec3_dot(found->normal, found->axis) < 0.5f;
    tally->specular += !grazing && largest_difference(found->glossy.raw, layers->specular[i]) > 0.01f;
}

/* Edges may fall to either side, samples lie where GL places vertices (TEST_PLACE of a pixel that is some 5
 * cm of the ground), and software GL chooses mip levels and mixes them roughly: one sample in a hundred may
 * be beyond the tolerances, which are a few steps of what the maps' bytes hold. A transform, wrap or factor
 * that is wrong moves hundreds. */
static void check(const struct tally *tally)
{
    printf("%d samples; beyond tolerance: cover %d, point %d, normal %d, gloss %d, diffuse %d, specular %d\n",
           tally->samples, tally->cover, tally->point, tally->normal, tally->gloss, tally->diffuse,
           tally->specular);
    int allowed = tally->samples / 100;
    assert_true(tally->cover <= allowed && tally->point <= allowed && tally->normal <= allowed &&
                tally->gloss <= allowed && tally->diffuse <= allowed && tally->specular <= allowed);
}

/* A ball and a sheet, one seen from the inside, before a square full of holes, all on the ground. */
static void compare_all(struct test_device *device, const struct maps *maps, const tl_image *holes)
{
    tl_error error = {0};
    tl_environment environment = test_environment(16, 8, grey);
    struct test_shape shapes[3] = {test_sphere((vec3s){{0.45f, 0.4f, 0.2f}}, 0.4f, 48),
                                   test_sheet(0.9f, 0.5f, 0.1f, 1, 32),
                                   test_square((vec3s){{-0.5f, 0.5f, 0}}, (vec3s){{0.8f, 0, 0.6f}},
                                               (vec3s){{-0.6f, 0, 0.8f}}, 0.45f, 4)};
    use_maps(&shapes[0].material, maps);
    use_maps(&shapes[1].material, maps);
    shapes[2].material.diffuse_map.image = holes;
    shapes[2].material.alpha_cutoff = 0.5f;
    tl_surface surfaces[3];
    for (int i = 0; i < 3; i++) {
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
    struct tl_render_settings settings = test_settings(WIDTH, HEIGHT);
    settings.image.ground = true;
    settings.image.supersample = 1;
    settings.light.lobe = TL_LOBE_DUAL;
    settings.reference.terminator = TL_TERMINATOR_GEOMETRIC; /* rays start on the triangles */
    tl_frame frame =
        test_frame((vec3s){{0.4f, 0.7f, 2.6f}}, (vec3s){{0, 0.55f, 0}}, 40, surfaces, 3, &environment);
    tl_image image = test_draw(device->renderer, &frame, &settings);
    struct layers *layers = TL_NEW(struct layers);
    read_layer(&tl_renderer_frame_resources(device->renderer)->gbuffer, TL_GBUFFER_POINT, layers->point);
    read_layer(&tl_renderer_frame_resources(device->renderer)->gbuffer, TL_GBUFFER_NORMAL, layers->normal);
    read_layer(&tl_renderer_frame_resources(device->renderer)->gbuffer, TL_GBUFFER_DIFFUSE, layers->diffuse);
    read_layer(&tl_renderer_frame_resources(device->renderer)->gbuffer, TL_GBUFFER_SPECULAR,
               layers->specular);

    struct tl_casters casters;
    assert_ok(tl_casters_measure(surfaces, 3, &casters, &error), error);
    struct tl_ground *ground = TL_NEW(struct tl_ground);
    tl_ground_make(&casters, TL_GROUND_GREY, ground);
    struct tl_reference_scene scene;
    const struct tl_reference_request request = tl_frame_reference_request(&frame, &settings, ground);
    assert_ok(tl_reference_scene_make(&request, &scene, &error), error);
    struct tl_view view = tl_view_make(&frame.camera, WIDTH, HEIGHT);
    struct tally tally = {0};
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        struct tl_shading_point found = look(&scene, &view, i % WIDTH, i / WIDTH);
        compare(&tally, &found, layers, i);
    }
    check(&tally);

    tl_reference_scene_release(&scene);
    free(ground);
    free(layers);
    tl_image_release(&image);
    for (int i = 0; i < 3; i++)
        test_shape_release(&shapes[i]);
    tl_environment_release(&environment);
}

static void test_shading_points_match_the_gbuffer(void **state)
{
    struct maps maps = maps_make();
    compare_all(*state, &maps, &maps.colour_alpha);
    compare_all(*state, &maps, &maps.grey_alpha); /* its alpha is no colour either */
    maps_free(&maps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shading_points_match_the_gbuffer)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
