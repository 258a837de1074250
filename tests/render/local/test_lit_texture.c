/* Normal maps lit in texture space, and those held in object space, as they are drawn: a square whose texels
 * lie at the middles of pixels against the formula at every texel's own normal, in double, and curved
 * surfaces against the same matrix at pixels. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/local/lit_texture.h"

#include "tests/testing.h"

#include <math.h>
#include <string.h>

enum { SIDE = 64 };
static const vec3s kd = {{0.6f, 0.4f, 0.2f}}, f0 = {{0.3f, 0.2f, 0.1f}};
static const double glossiness = 0.9;

/* Normals within 60 degrees of the surface's own, without order: each texel differs from its neighbours. */
static tl_image make_random_map(void)
{
    tl_image map = tl_image_create(SIDE, SIDE, 3, TL_IMAGE_U8);
    map.linear = true;
    uint8_t *bytes = tl_image_bytes(&map);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double turn = 2.399963 * i, tilt = 0.0003 * ((i * 7919) % 3490);
        const double n[3] = {sin(tilt) * cos(turn), sin(tilt) * sin(turn), cos(tilt)};
        for (int c = 0; c < 3; c++)
            bytes[3 * i + c] = (uint8_t)lround(127.5 + 127.5 * n[c]);
    }
    return map;
}

/* Waves of a few texels, in float: GL interpolates texels of eight bits in steps that a highlight shows. */
static tl_image make_wave_map(void)
{
    tl_image map = tl_image_create(SIDE, SIDE, 3, TL_IMAGE_F32);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int row = i / SIDE;
        double u = 2 * M_PI * 4 * (i % SIDE + 0.5) / SIDE, v = 2 * M_PI * 3 * (row + 0.5) / SIDE;
        const double n[3] = {0.4 * cos(u), 0.3 * cos(v), 1};
        for (int c = 0; c < 3; c++)
            tl_image_floats(&map)[3 * i + c] =
                (float)(0.5 + 0.5 * n[c] / sqrt(n[0] * n[0] + n[1] * n[1] + 1));
    }
    return map;
}

static void set_material(tl_material *material, const tl_image *map)
{
    material->gloss.model = TL_REFLECT_BLINN_PHONG;
    material->diffuse = kd;
    material->specular = f0;
    material->glossiness = (float)glossiness;
    material->normal_map.image = map;
    material->normal_map.clamp_u = material->normal_map.clamp_v = true;
}

static void light_in_texture_space(struct test_scene *scene, int side)
{
    struct tl_shading_params *shading = &scene->settings.shading;
    shading->space = TL_SPACE_TEXTURE;
    shading->coordinates = TL_COORDINATES_MATRIX;
    shading->texture_size = side;
}

/* A square that fills the image, so that pixel (x, y) shows texel (x, y), in a plane of its own. */
struct plane {
    vec3s right, normal, lamp;
};

static void square_open(struct test_scene *scene, const struct plane *plane, const tl_image *map,
                        bool from_back)
{
    const float distance = 3;
    test_scene_open_lamplit(scene, test_square((vec3s){{0, 0, 0}}, plane->right, plane->normal, 1, 4), SIDE,
                            SIDE);
    scene->frame.camera.eye = glms_vec3_scale(plane->normal, from_back ? -distance : distance);
    scene->frame.camera.up = glms_vec3_cross(plane->normal, plane->right);
    scene->frame.camera.fov_y = 2 * atanf(1 / distance);
    scene->lamps[0] = test_lamp_towards(plane->lamp, 3);
    set_material(&scene->shapes[0].material, map);
    test_scene_refresh(scene);
    light_in_texture_space(scene, SIDE);
}

static double schlick(double f, double cosine)
{
    return f + (fmin(50 * f, 1) - f) * pow(1 - cosine, 5);
}

/* The power, or the value of a table of it in bytes, linear between entries. */
static double power(double cosine, double exponent, bool by_table)
{
    if (!by_table)
        return pow(cosine, exponent);
    const int last = TL_POWER_TABLE_SIZE - 1;
    double at = cosine * last, entries[2];
    for (int i = 0; i < 2; i++)
        entries[i] = round(255 * pow(fmin(floor(at) + i, last) / last, exponent)) / 255;
    return entries[0] + (at - floor(at)) * (entries[1] - entries[0]);
}

struct terms {
    double cosine, power; /* of the lamp; of the halfway vector */
};

/* The cosines of a texel: one matrix for all, whose rows are the lamp and the halfway vector in the square's
 * own frame. */
static struct terms terms_of(const struct plane *plane, const tl_image *map, int texel, bool by_table)
{
    vec3s up = glms_vec3_cross(plane->normal, plane->right), l = glms_vec3_normalize(plane->lamp);
    vec3s h = glms_vec3_normalize(glms_vec3_add(l, plane->normal));
    const vec3s axes[3] = {plane->right, up, plane->normal};
    double n[3], square = 0, a = 0, d = 0;
    for (int i = 0; i < 3; i++) {
        n[i] = 2 * tl_image_bytes(map)[3 * texel + i] / 255.0 - 1;
        square += n[i] * n[i];
    }
    for (int i = 0; i < 3; i++) {
        a += n[i] / sqrt(square) * (double)glms_vec3_dot(axes[i], l);
        d += n[i] / sqrt(square) * (double)glms_vec3_dot(axes[i], h);
    }
    bool shines = a > 0 && n[2] > 0 && d > 0;
    return (struct terms){fmax(a, 0), shines ? power(d, 4 / (1 - glossiness), by_table) : 0};
}

static double scale_of_gloss(const struct plane *plane, int channel)
{
    vec3s l = glms_vec3_normalize(plane->lamp), h = glms_vec3_normalize(glms_vec3_add(l, plane->normal));
    double exponent = 4 / (1 - glossiness), lobe = (exponent + 2) / (8 * M_PI);
    return lobe * schlick((double)f0.raw[channel], (double)glms_vec3_dot(h, l));
}

static double light_of(const struct plane *plane, struct terms terms, int channel)
{
    static const double irradiance[3] = {3, 2.7, 2.4};
    return irradiance[channel] *
           ((double)kd.raw[channel] * terms.cosine / M_PI + scale_of_gloss(plane, channel) * terms.power);
}

/* The largest error over all texels, and the largest light. */
static double square_error(const struct test_scene *scene, tl_renderer *renderer, const struct plane *plane,
                           const tl_image *map, bool by_table, double *peak)
{
    tl_image drawn = test_scene_draw(scene, renderer);
    double worst = 0;
    *peak = 0;
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        struct terms terms = terms_of(plane, map, texel, by_table);
        for (int c = 0; c < 3; c++) {
            double expected = light_of(plane, terms, c);
            worst = fmax(worst, fabs((double)test_pixel(&drawn, texel % SIDE, texel / SIDE)[c] - expected));
            *peak = fmax(*peak, expected);
        }
    }
    tl_image_release(&drawn);
    return worst;
}

static const struct plane planes[] = {
    {.right = {{1, 0, 0}}, .normal = {{0, 0, 1}}, .lamp = {{-0.6f, 0.7f, 0.8f}}},
    {.right = {{0.8f, 0, -0.6f}}, .normal = {{0.36f, 0.8f, 0.48f}}, .lamp = {{0.9f, 0.5f, 0.1f}}},
};

/* Each texel is the formula at its normal. In bytes, rounded to 255 steps of each term: cosines up to 1,
 * gloss up to its largest value. What is left is GL's reading of texels not quite at their middles:
 * neighbours of noise differ by up to the peak, along two axes. */
static void texels_are_lit_by_the_formula(void **state)
{
    struct test_device *device = *state;
    tl_image map = make_random_map();
    for (size_t p = 0; p < TL_COUNT(planes); p++) {
        const struct plane *plane = &planes[p];
        struct test_scene scene;
        double peak;
        square_open(&scene, plane, &map, false);
        double off = square_error(&scene, device->renderer, plane, &map, false, &peak);
        scene.settings.shading.power = TL_POWER_TABLE;
        double by_table = square_error(&scene, device->renderer, plane, &map, true, &peak);
        double not_by_table = square_error(&scene, device->renderer, plane, &map, false, &peak);
        scene.settings.shading.pass_target = TL_PASS_TARGET_FIXED8;
        double bytes = square_error(&scene, device->renderer, plane, &map, true, &peak);
        double step = 0;
        for (int c = 0; c < 3; c++)
            step = fmax(step, light_of(plane, (struct terms){0.5 / 255, 0.5 / 255}, c));
        print_message(
            "plane %zu: peak %.2f, off by %.1e; a table of powers: %.1e (%.1e from the power); texels of 8 "
            "bits: %.1e, half a step is %.1e\n",
            p, peak, off, by_table, not_by_table, bytes, step);
        assert_true(off < 1e-3 * peak);
        assert_true(by_table < 2e-3 * peak);
        assert_true(not_by_table > 2 * by_table);
        assert_true(bytes > 0.5 * step && bytes < 1.02 * step + by_table);
        test_scene_close(&scene);
    }
    tl_image_release(&map);
}

/* The same matrix at pixels and at texels of a sheet with waves of its own, which texels magnify: what
 * differs is that light is interpolated in place of normals: by the square of a texel, but for the kinks of a
 * bilinear map, where it is by the texel. */
static void smaller_texels_come_near_pixels(void **state)
{
    enum { SIZES = 3 };
    struct test_device *device = *state;
    tl_image map = make_wave_map();
    struct test_scene scene;
    double errors[SIZES];
    test_scene_open_lamplit(&scene, test_sheet(0, 0.8f, 0.1f, 1, 32), 256, 256);
    scene.frame.camera.eye = (vec3s){{0, 2.5f, 0.3f}};
    set_material(&scene.shapes[0].material, &map);
    test_scene_refresh(&scene);
    scene.settings.shading.coordinates = TL_COORDINATES_MATRIX;
    tl_image at_pixels = test_scene_draw(&scene, device->renderer);
    for (int i = 0; i < SIZES; i++) {
        light_in_texture_space(&scene, SIDE << i);
        errors[i] = test_scene_error(&scene, device->renderer, &at_pixels).rel_rmse;
        print_message("a sheet of waves with %4d texels: off by %.4f\n", SIDE << i, errors[i]);
    }
    for (int i = 1; i < SIZES; i++)
        assert_true(errors[i] < 0.45 * errors[i - 1]);
    tl_image_release(&at_pixels);
    test_scene_close(&scene);
    tl_image_release(&map);
}

/* `by_weights` is what filters of hardware may make of it: both ways weigh their own texels, along two axes.
 */
static double off_pixels(struct test_scene *scene, tl_renderer *renderer, double *by_weights)
{
    int space = scene->settings.shading.space;
    tl_image drawn = test_scene_draw(scene, renderer);
    scene->settings.shading.space = TL_SPACE_WORLD;
    tl_image at_pixels = test_scene_draw(scene, renderer);
    scene->settings.shading.space = space;
    struct test_difference off = test_compare(&drawn, &at_pixels);
    tl_image_release(&at_pixels);
    tl_image_release(&drawn);
    *by_weights = 2 * off.moved_rmse;
    return off.rel_rmse;
}

/* The back of cloth has normals and colours of its own. UVs that change have another place in the texture;
 * those that are mirrored turn a square's front over in it; those that overlap have none, and are lit at
 * pixels. */
static void has_its_texels(const struct test_device *device, int space)
{
    tl_image map = make_wave_map();
    struct plane plane = planes[1];
    plane.lamp = glms_vec3_add(plane.right, glms_vec3_scale(plane.normal, -1.5f));
    struct test_scene scene;
    square_open(&scene, &plane, &map, true);
    scene.settings.shading.space = space;
    tl_material *material = &scene.shapes[0].material;
    material->back = (struct tl_back){true, {{0.1f, 0.5f, 0.9f}}, {{0.02f, 0.3f, 0.1f}}};
    test_scene_refresh(&scene);
    double by_weights, plain_by_weights;
    double back = off_pixels(&scene, device->renderer, &by_weights);
    material->back.is_given = false;
    test_scene_refresh(&scene);
    double plain_back = off_pixels(&scene, device->renderer, &plain_by_weights);
    print_message("back: off by %.4f, without colours of its own %.4f\n", back, plain_back);
    assert_true(back < 1e-4 + by_weights && plain_back < 1e-4 + plain_by_weights);
    test_scene_close(&scene);

    static const char *const names[] = {"as they are", "moved", "mirrored", "overlapping"};
    square_open(&scene, &planes[1], &map, false);
    scene.settings.shading.space = space;
    tl_mesh *mesh = &scene.shapes[0].mesh;
    material = &scene.shapes[0].material;
    material->normal_map.clamp_u = material->normal_map.clamp_v = false;
    material->back = (struct tl_back){true, {{0.1f, 0.5f, 0.9f}}, {{0.02f, 0.3f, 0.1f}}};
    vec2s *own = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    memcpy(own, mesh->uvs, mesh->vertex_count * sizeof *own);
    for (int k = 0; k < 4; k++) {
        tl_image before = test_scene_draw(&scene, device->renderer); /* with the charts of other UVs */
        tl_image_release(&before);
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            const vec2s uvs[] = {own[i],
                                 {{2 * own[i].x - 5, 0.5f * own[i].y + 3}},
                                 {{1 - own[i].x, own[i].y}},
                                 {{fabsf(2 * own[i].x - 1), own[i].y}}};
            mesh->uvs[i] = uvs[k];
            mesh->tangents[i].w = k == 2 ? -1 : 1;
        }
        test_scene_refresh(&scene);
        double off = off_pixels(&scene, device->renderer, &by_weights);
        print_message("UVs %s: off by %.4f\n", names[k], off);
        assert_true(k == 3 ? off == 0 : off > 0 && off < 1e-4 + by_weights);
    }
    free(own);
    test_scene_close(&scene);
    tl_image_release(&map);
}

static void every_point_has_its_texel(void **state)
{
    has_its_texels(*state, TL_SPACE_TEXTURE);
    has_its_texels(*state, TL_SPACE_OBJECT);
}

static void mean_of(const tl_image *drawn, int first, int side, double mean[3])
{
    for (int c = 0; c < 3; c++)
        mean[c] = 0;
    for (int i = 0; i < side * side; i++)
        for (int c = 0; c < 3; c++)
            mean[c] += (double)test_pixel(drawn, first + i % side, first + i / side)[c] / (side * side);
}

/* From afar a pixel covers many texels and shows the mean of their light: not the light of their mean normal.
 */
static void levels_average_light(void **state)
{
    struct test_device *device = *state;
    const struct plane facing = {.right = {{1, 0, 0}}, .normal = {{0, 0, 1}}, .lamp = {{0, 0.1f, 1}}},
                       *plane = &facing;
    tl_image map = make_random_map();
    struct test_scene scene;
    double mean[3] = {0}, seen[3];
    square_open(&scene, plane, &map, false);
    scene.frame.camera.fov_y = 2 * atanf(8.0f / 3);
    for (int texel = 0; texel < SIDE * SIDE; texel++)
        for (int c = 0; c < 3; c++)
            mean[c] += light_of(plane, terms_of(plane, &map, texel, false), c) / (SIDE * SIDE);
    for (int space = 0; space < 2; space++) {
        scene.settings.shading.space = space ? TL_SPACE_TEXTURE : TL_SPACE_WORLD;
        tl_image drawn = test_scene_draw(&scene, device->renderer);
        mean_of(&drawn, SIDE / 2 - 4, 8, seen); /* the square has 8 x 8 pixels */
        double off = fabs(seen[0] / mean[0] - 1);
        print_message("texels of an eighth of a pixel, %s: off their mean by %.4f\n",
                      space ? "lit, then averaged" : "averaged, then lit", off);
        assert_true(space ? off < 1e-3 : off > 0.3);
        tl_image_release(&drawn);
    }
    test_scene_close(&scene);
    tl_image_release(&map);
}

/* A texel that covers many of the map has their mean normal, which is shorter than 1 and receives that much
 * less. All normals of this map face the lamp, so that their mean cosine is that of their mean. */
static void large_texels_have_mean_normals(void **state)
{
    struct test_device *device = *state;
    const struct plane plane = {.right = {{1, 0, 0}}, .normal = {{0, 0, 1}}, .lamp = {{0, 0.1f, 1}}};
    tl_image map = make_random_map();
    struct test_scene scene;
    double mean = 0, seen[3];
    square_open(&scene, &plane, &map, false);
    scene.shapes[0].material.specular = (vec3s){{0, 0, 0}};
    test_scene_refresh(&scene);
    light_in_texture_space(&scene, 8);
    scene.settings.detail.minify = TL_DETAIL_MINIFY_TOKSVIG;
    for (int texel = 0; texel < SIDE * SIDE; texel++)
        mean += 3 * (double)kd.x * terms_of(&plane, &map, texel, false).cosine / M_PI / (SIDE * SIDE);
    tl_image drawn = test_scene_draw(&scene, device->renderer);
    mean_of(&drawn, 0, SIDE, seen);
    print_message("texels over 64 of the map: off their mean by %.4f\n", fabs(seen[0] / mean - 1));
    assert_true(fabs(seen[0] / mean - 1) < 0.03); /* detail_bumps neglects the variance of z */
    tl_image_release(&drawn);
    test_scene_close(&scene);
    tl_image_release(&map);
}

/* Parts have a texture each, one after the other, so that their UVs may be the same. */
static void parts_have_their_own(void **state)
{
    struct test_device *device = *state;
    tl_image map = make_wave_map();
    struct test_scene scene;
    square_open(&scene, &planes[1], &map, false);
    struct test_shape *shape = &scene.shapes[0];
    uint32_t half = (uint32_t)shape->mesh.index_count / 2;
    tl_material materials[2] = {shape->material, shape->material};
    materials[1].glossiness = 0.5f;
    struct tl_mesh_part parts[2] = {shape->mesh.parts[0], shape->mesh.parts[0]};
    parts[0].index_count = parts[1].index_count = parts[1].first_index = half;
    parts[1].material = 1;
    scene.surfaces[0].parts = parts;
    scene.surfaces[0].part_count = 2;
    scene.surfaces[0].materials = materials;
    scene.surfaces[0].topology_revision += 1000;
    scene.settings.image.width = scene.settings.image.height = 4 * SIDE;
    scene.settings.shading.texture_size = 4 * SIDE;
    double by_weights, off = off_pixels(&scene, device->renderer, &by_weights);
    scene.settings.shading.space = TL_SPACE_OBJECT;
    double normals_off = off_pixels(&scene, device->renderer, &by_weights);
    print_message("two parts: off by %.4f, in object space by %.4f\n", off, normals_off);
    assert_true(off > 0 &&
                off < 0.02 + by_weights); /* their texels are half as wide as a pixel along one of two axes */
    assert_true(normals_off > 0 && normals_off < 0.02 + by_weights);
    test_scene_close(&scene);
    tl_image_release(&map);
}

/* Half of a square, whose edge runs across texels: texels beyond it are empty and must not darken it, from
 * near or from afar, nor show what was in them before. Its map is even, so that all of it has one colour. */
static void empty_texels_have_no_weight(void **state)
{
    struct test_device *device = *state;
    tl_image map = tl_image_create(4, 4, 3, TL_IMAGE_U8);
    map.linear = true;
    for (int i = 0; i < 16; i++)
        memcpy(tl_image_bytes(&map) + (size_t)3 * (size_t)i, (const uint8_t[]){160, 110, 230}, 3);
    struct test_scene scene;
    square_open(&scene, &planes[0], &map, false);
    struct test_shape *shape = &scene.shapes[0];
    shape->material.glossiness = 0.5f;
    test_scene_refresh(&scene);
    tl_image before = test_scene_draw(&scene, device->renderer);
    tl_image_release(&before);
    shape->material.glossiness = (float)glossiness;
    size_t kept = 0;
    for (size_t i = 0; i < shape->mesh.index_count; i += 3) {
        float sum = 0;
        for (size_t k = 0; k < 3; k++)
            sum +=
                shape->mesh.uvs[shape->mesh.indices[i + k]].x + shape->mesh.uvs[shape->mesh.indices[i + k]].y;
        if (sum < 3) {
            memmove(shape->mesh.indices + kept, shape->mesh.indices + i, 3 * sizeof *shape->mesh.indices);
            kept += 3;
        }
    }
    shape->mesh.index_count = shape->mesh.parts[0].index_count = (uint32_t)kept;
    test_scene_refresh(&scene);
    struct terms terms = terms_of(&planes[0], &map, 0, false);
    static const float sizes[] = {1.3f, 5, 11}; /* so that pixels lie between texels */
    for (size_t k = 0; k < 2 * TL_COUNT(sizes); k++) {
        scene.frame.camera.fov_y = 2 * atanf(sizes[k / 2] / 3);
        scene.settings.shading.space = k % 2 ? TL_SPACE_OBJECT : TL_SPACE_TEXTURE;
        tl_image drawn = test_scene_draw(&scene, device->renderer);
        double worst = 0;
        int covered = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const float *pixel = test_pixel(&drawn, i % SIDE, i / SIDE);
            covered += pixel[3] == 1;
            worst =
                fmax(worst, pixel[3] == 1 ? fabs((double)pixel[0] / light_of(&planes[0], terms, 0) - 1) : 0);
        }
        print_message("half a square of %d pixels: off by %.1e at worst\n", covered, worst);
        assert_true(covered > 0 && worst < 1e-4);
        tl_image_release(&drawn);
    }
    test_scene_close(&scene);
    tl_image_release(&map);
}

/* Moves the square without a change of its topology: z is a function of x in its own plane, even, so that the
 * nearest rotation is that of the plane. */
static void move_square(struct test_scene *scene, const struct plane *plane, double bend)
{
    tl_mesh *mesh = &scene->shapes[0].mesh;
    struct test_shape flat = test_square((vec3s){{0, 0, 0}}, plane->right, plane->normal, 1, 4);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        double x = (double)glms_vec3_dot(flat.mesh.positions[i], plane->right), slope = -2 * bend * x;
        float length = (float)sqrt(1 + slope * slope);
        vec3s along = glms_vec3_add(plane->right, glms_vec3_scale(plane->normal, (float)slope));
        vec3s normal = glms_vec3_sub(plane->normal, glms_vec3_scale(plane->right, (float)slope));
        along = glms_vec3_scale(along, 1 / length);
        mesh->positions[i] = glms_vec3_add(flat.mesh.positions[i],
                                           glms_vec3_scale(plane->normal, (float)(bend * (0.5 - x * x))));
        mesh->normals[i] = glms_vec3_scale(normal, 1 / length);
        mesh->tangents[i] = (vec4s){{along.x, along.y, along.z, flat.mesh.tangents[i].w}};
    }
    test_shape_release(&flat);
    scene->surfaces[0].motion_revision += 1000;
    scene->frame.camera.eye = glms_vec3_scale(plane->normal, 3);
    scene->frame.camera.up = glms_vec3_cross(plane->normal, plane->right);
    scene->lamps[0] = test_lamp_towards(plane->lamp, 3);
}

/* A map in object space has the normals of each texel, and moves with the square wherever it turns. In bytes
 * a normal is off by up to 2 x 0.5 x sqrt(3) / 255, which a power of 40 sees through its steepest slope,
 * sqrt(40 / e). */
static void normals_turn_with_the_object(void **state)
{
    struct test_device *device = *state;
    tl_image map = make_random_map();
    struct test_scene scene;
    double peak, wrong = sqrt(3.0) / 255;
    for (int bytes = 0; bytes < 2; bytes++) {
        square_open(&scene, &planes[0], &map, false);
        scene.settings.shading.space = TL_SPACE_OBJECT;
        scene.settings.shading.pass_target = bytes ? TL_PASS_TARGET_FIXED8 : TL_PASS_TARGET_FLOAT;
        double made = square_error(&scene, device->renderer, &planes[0], &map, false, &peak);
        move_square(&scene, &planes[1], 0);
        double moved = square_error(&scene, device->renderer, &planes[1], &map, false, &peak);
        double bound = light_of(&planes[1], (struct terms){wrong, wrong * sqrt(40 / exp(1))}, 0);
        print_message("object space, %s: off by %.1e where made, %.1e moved (bound %.1e), peak %.2f\n",
                      bytes ? "bytes" : "float", made, moved, bound, peak);
        assert_true(bytes ? made > 1e-3 * peak && moved < bound : made < 1e-3 * peak && moved < 1e-3 * peak);
        test_scene_close(&scene);
    }
    tl_image_release(&map);
}

/* Bends come after the map was made: the light stays that of the even square, to the digits of its texels,
 * while in world space it changes. A map of the bent shape has the bend. */
static void bends_are_not_in_the_map(void **state)
{
    struct test_device *device = *state;
    const struct plane plane = {.right = {{1, 0, 0}}, .normal = {{0, 0, 1}}, .lamp = {{0.2f, 0.1f, 1}}};
    tl_image map = tl_image_create(4, 4, 3, TL_IMAGE_U8);
    map.linear = true;
    for (int i = 0; i < 16; i++)
        memcpy(tl_image_bytes(&map) + (size_t)3 * (size_t)i, (const uint8_t[]){160, 110, 230}, 3);
    struct test_scene scene;
    square_open(&scene, &plane, &map, false);
    scene.settings.shading.space = TL_SPACE_OBJECT;
    struct terms terms = terms_of(&plane, &map, 0, false);
    for (int step = 0; step <= 3; step++) {
        move_square(&scene, &plane, 0.1 * step);
        tl_image drawn = test_scene_draw(&scene, device->renderer);
        double by_weights, worst = 0, off = off_pixels(&scene, device->renderer, &by_weights);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const float *pixel = test_pixel(&drawn, i % SIDE, i / SIDE);
            worst = fmax(worst, pixel[3] == 1 ? fabs((double)pixel[0] / light_of(&plane, terms, 0) - 1) : 0);
        }
        print_message("bent by %4.1f degrees: off the even square by %.1e, off world space by %.3f\n",
                      atan(0.2 * step) * 180 / M_PI, worst, off);
        assert_true(worst < 1e-4);
        assert_true(step == 0 ? off < 1e-4 + by_weights : off > 0.05 * step);
        tl_image_release(&drawn);
    }
    scene.surfaces[0].topology_revision += 1000;
    double by_weights, renewed = off_pixels(&scene, device->renderer, &by_weights);
    print_message("a new map: off world space by %.4f\n", renewed);
    assert_true(renewed < 0.01 + by_weights);
    test_scene_close(&scene);
    tl_image_release(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_lit_by_the_formula), cmocka_unit_test(smaller_texels_come_near_pixels),
        cmocka_unit_test(every_point_has_its_texel),     cmocka_unit_test(levels_average_light),
        cmocka_unit_test(parts_have_their_own),          cmocka_unit_test(large_texels_have_mean_normals),
        cmocka_unit_test(empty_texels_have_no_weight),   cmocka_unit_test(normals_turn_with_the_object),
        cmocka_unit_test(bends_are_not_in_the_map),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
