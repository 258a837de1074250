/* Variance shadow maps against hand-made cases, as the image shows them: light with shadows over light
 * without. One bright patch of sky makes one region that matters; with six regions each is a whole cube face
 * of 2 pi / 3 sr, so its cone has cos = 1 - 1/3 and tan = sqrt(5) / 2. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "render/visibility/maps.h"

#include "tests/testing.h"

#define TAN_CONE 1.118034f

static vec3s patch_direction; /* of bright_patch; set by the tests */

static vec3s bright_patch(vec3s d)
{
    float cosine = glms_vec3_dot(d, patch_direction);
    return cosine > 0.98f ? (vec3s){{10, 10, 10}} : (vec3s){{0, 0, 0}};
}

static struct tl_render_settings settings_of_six(int width, int height)
{
    struct tl_render_settings settings = test_settings(width, height);
    settings.light.regions = 6;
    settings.light.map_size = 256;
    settings.light.depth_bias_m = 0.001f;
    settings.light.bleed_reduction = 0;
    return settings;
}

/* The intersection of the ray through a pixel's centre with the plane y = 0. */
static vec3s ground_point(const struct tl_camera *camera, const struct tl_render_settings *settings, int x,
                          int y)
{
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    vec3s right = glms_vec3_normalize(glms_vec3_cross(forward, camera->up));
    vec3s up = glms_vec3_cross(right, forward);
    float half = tanf(camera->fov_y / 2), width = (float)settings->image.width,
          height = (float)settings->image.height;
    float sx = (2 * ((float)x + 0.5f) / width - 1) * half * width / height;
    float sy = (1 - 2 * ((float)y + 0.5f) / height) * half;
    vec3s ray = glms_vec3_add(forward, glms_vec3_add(glms_vec3_scale(right, sx), glms_vec3_scale(up, sy)));
    return glms_vec3_add(camera->eye, glms_vec3_scale(ray, -camera->eye.y / ray.y));
}

/* Shadowed over unshadowed light, pixel by pixel, in the red channel; -1 where nothing is lit or drawn. */
static tl_image visibility_image(struct test_device *device, const tl_frame *frame,
                                 struct tl_render_settings settings)
{
    tl_image shadowed = test_draw(device->renderer, frame, &settings);
    settings.light.method = TL_METHOD_UNSHADOWED;
    tl_image lit = test_draw(device->renderer, frame, &settings);
    for (size_t i = 0; i < (size_t)lit.width * (size_t)lit.height * 4; i += 4) {
        float without = tl_image_floats(&lit)[i];
        tl_image_floats(&shadowed)[i] = without > 1e-4f ? tl_image_floats(&shadowed)[i] / without : -1;
    }
    tl_image_release(&lit);
    return shadowed;
}

static float normal_distribution(float x)
{
    return 0.5f * erfcf(-x / sqrtf(2));
}

/* The x at which normal_distribution(x) = share, by bisection. */
static double deviate(double share)
{
    double low = -4, high = 4;
    for (int i = 0; i < 40; i++) {
        double middle = 0.5 * (low + high);
        *(0.5 * erfc(-middle / sqrt(2)) < share ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

/* A sheet at height 1 covers x < 0; light falls straight down. Of two depths a and b the Chebyshev bound at b
 * is the share of b exactly, so the shadow of the straight edge is the Gaussian's integral. */
static void test_half_plane_penumbra(void **state)
{
    struct test_device *device = *state;
    patch_direction = (vec3s){{0, 1, 0}};
    tl_environment environment = test_environment(128, 64, bright_patch);
    struct test_shape shapes[2] = {
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 2, 8),
        test_square((vec3s){{-1, 1, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 1, 4),
    };
    tl_surface surfaces[2];
    for (int i = 0; i < 2; i++) {
        shapes[i].material.specular = (vec3s){{0, 0, 0}};
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
    struct tl_render_settings settings = settings_of_six(64, 16);
    settings.light.blur_m = 0.15f;
    const float sigma = settings.light.blur_m * TAN_CONE;
    /* From beside, below the sheet, along x. */
    tl_frame frame = test_frame((vec3s){{0, 0.7f, 1.9f}}, (vec3s){{0, 0, 0}}, 45, surfaces, 2, &environment);
    tl_image visibility = visibility_image(device, &frame, settings);
    /* A map's texel is 4 sqrt(2) / 252 m = 0.13 sigma; the edge may lie half of one off, where the slope is
     * at most 0.4 / sigma: 0.027. The kernel ends at 3 sigma: 0.003. */
    const float tolerance = 0.03f;
    int dark = 0, bright = 0;
    double count = 0, sums[4] = {0, 0, 0, 0}; /* of x, its deviate, x^2 and their product */
    for (int y = 0; y < settings.image.height; y++)
        for (int x = 0; x < settings.image.width; x++) {
            vec3s point = ground_point(&frame.camera, &settings, x, y);
            float actual = test_pixel(&visibility, x, y)[0];
            if (fabsf(point.z) > 0.4f || fabsf(point.x) > 1.2f) /* within reach of the sheet's other edges */
                continue;
            assert_near(actual, normal_distribution(point.x / sigma), tolerance);
            dark += actual < 1e-3f;
            bright += actual > 0.999f;
            if (actual < 0.05f || actual > 0.95f)
                continue;
            double at = (double)point.x, z = deviate((double)actual);
            const double terms[4] = {at, z, at * at, at * z};
            for (int i = 0; i < 4; i++)
                sums[i] += terms[i];
            count++;
        }
    assert_true(dark > 20 && bright > 20); /* whole shadow and whole light were both seen */
    /* The slope of the deviate is 1 / sigma wherever the edge lies. Texels widen the Gaussian by 0.1 %, its
     * end at 3 sigma narrows it by 1.3 %. */
    double slope = (count * sums[3] - sums[0] * sums[1]) / (count * sums[2] - sums[0] * sums[0]);
    print_message("%.0f pixels of the penumbra: sigma is %.3f of what was asked for\n", count,
                  1 / (slope * (double)sigma));
    assert_true(count > 10);
    assert_near(1 / (slope * (double)sigma), 1, 0.03);
    tl_image_release(&visibility);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* The shadow of a ball on the ground lies where the light's direction puts it, and is as large as the ball's
 * disc seen aslant. The ground lies behind the map's sphere: it is kept there all the same, and is lit beside
 * the shadow. */
static void test_shadow_position(void **state)
{
    struct test_device *device = *state;
    patch_direction = glms_vec3_normalize((vec3s){{0.3f, 1, 0.2f}});
    tl_environment environment = test_environment(256, 128, bright_patch);
    struct test_shape ball = test_sphere((vec3s){{0, 1, 0}}, 0.15f, 24);
    test_shape_refresh(&ball);
    struct tl_render_settings settings = settings_of_six(96, 96);
    settings.image.ground = true;
    settings.light.blur_m = 0.01f;
    tl_frame frame =
        test_frame((vec3s){{-1.5f, 3, -1}}, (vec3s){{-0.3f, 0, -0.2f}}, 20, &ball.surface, 1, &environment);
    tl_image visibility = visibility_image(device, &frame, settings);
    double weight = 0, mean_x = 0, mean_z = 0, area = 0;
    for (int y = 0; y < settings.image.height; y++)
        for (int x = 0; x < settings.image.width; x++) {
            const float *pixel = test_pixel(&visibility, x, y);
            vec3s point = ground_point(&frame.camera, &settings, x, y);
            /* The ball itself is seen only beyond this distance from its shadow. */
            if (pixel[3] < 1 || pixel[0] < 0 || hypotf(point.x + 0.3f, point.z + 0.2f) > 0.35f)
                continue;
            double shadow = (double)(1 - pixel[0]);
            vec3s right = glms_vec3_sub(ground_point(&frame.camera, &settings, x + 1, y), point);
            vec3s down = glms_vec3_sub(ground_point(&frame.camera, &settings, x, y + 1), point);
            area += shadow * (double)glms_vec3_norm(glms_vec3_cross(right, down));
            weight += shadow;
            mean_x += shadow * (double)point.x;
            mean_z += shadow * (double)point.z;
        }
    /* The region's direction is the centre of the patch's light on the cube, within half a texel of 32
     * (0.03); at one metre that is 3 cm. */
    assert_true(weight > 50);
    assert_near(mean_x / weight, -0.3, 0.03);
    assert_near(mean_z / weight, -0.2, 0.03);
    const double disc = M_PI * 0.15 * 0.15 / (double)patch_direction.y;
    print_message("the shadow has %.4f m2, the disc %.4f\n", area, disc);
    assert_near(area / disc, 1,
                0.1); /* a texel of 256 around the rim has 0.02; all of the map's square, 1.27 */
    tl_image_release(&visibility);
    test_shape_release(&ball);
    tl_environment_release(&environment);
}

/* Light from straight below meets the ground first. */
static void test_ground_blocks_light_from_below(void **state)
{
    struct test_device *device = *state;
    patch_direction = (vec3s){{0, -1, 0}};
    tl_environment environment = test_environment(128, 64, bright_patch);
    struct test_shape ball = test_sphere((vec3s){{0, 1, 0}}, 0.4f, 24);
    ball.material.specular = (vec3s){{0, 0, 0}};
    test_shape_refresh(&ball);
    struct tl_render_settings settings = settings_of_six(32, 32);
    tl_frame frame =
        test_frame((vec3s){{0, 0.3f, 2}}, (vec3s){{0, 0.7f, 0}}, 10, &ball.surface, 1, &environment);
    tl_image lit = test_draw(device->renderer, &frame, &settings);
    settings.image.ground = true;
    tl_image dark = test_draw(device->renderer, &frame, &settings);
    assert_true(test_pixel(&lit, 16, 24)[0] > 0.01f);
    for (int i = 0; i < 32 * 32 * 4; i += 4)
        assert_near(tl_image_floats(&dark)[i], 0, 0);
    tl_image_release(&lit);
    tl_image_release(&dark);
    test_shape_release(&ball);
    tl_environment_release(&environment);
}

/* A convex body shadows none of its lit side: no acne, whatever the map's size. Only near the terminator does
 * the other side come within a texel; there n.l < 0.35 is left out. */
static void test_no_acne(void **state)
{
    struct test_device *device = *state;
    patch_direction = glms_vec3_normalize((vec3s){{0.2f, 1, 0.4f}});
    tl_environment environment = test_environment(128, 64, bright_patch);
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 1, 64);
    ball.material.specular = (vec3s){{0, 0, 0}};
    test_shape_refresh(&ball);
    tl_frame frame = test_frame((vec3s){{0, 3, 3}}, (vec3s){{0, 0, 0}}, 30, &ball.surface, 1, &environment);
    struct tl_render_settings settings = settings_of_six(64, 64);
    settings.light.depth_bias_m = 0.004f;
    for (int size = 64; size <= 1024; size *= 4)
        for (int kind = 0; kind < 3; kind++) { /* variance maps without and with blur, depth maps */
            settings.light.map_size = size;
            settings.light.blur_m = kind == 1 ? 0.05f : 0;
            settings.light.visibility = kind == 2 ? TL_VISIBILITY_DEPTH : TL_VISIBILITY_VSM;
            tl_image visibility = visibility_image(device, &frame, settings);
            for (int y = 8; y < 56; y++)
                for (int x = 8; x < 56; x++) {
                    const float *pixel = test_pixel(&visibility, x, y);
                    /* The eye's side of the ball, within 50 degrees of the light. */
                    float dx = ((float)x - 31.5f) / 32, dy = ((float)y - 31.5f) / 32;
                    if (dx * dx + dy * dy < 0.3f)
                        assert_near(pixel[0], 1, 0.02);
                }
            tl_image_release(&visibility);
        }
    test_shape_release(&ball);
    tl_environment_release(&environment);
}

/* Texels that the alpha mask cuts away cast no shadow. */
static void test_mask_lets_light_through(void **state)
{
    struct test_device *device = *state;
    patch_direction = (vec3s){{0, 1, 0}};
    tl_environment environment = test_environment(128, 64, bright_patch);
    struct test_shape shapes[2] = {
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 2, 8),
        test_square((vec3s){{0, 1, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 1, 4),
    };
    /* Left half there, right half cut away. */
    tl_image mask = tl_image_create(2, 1, 4, TL_IMAGE_U8);
    tl_image_bytes(&mask)[3] = 255;
    shapes[1].material.diffuse_map.image = &mask;
    shapes[1].material.diffuse_map.clamp_u = true;
    shapes[1].material.alpha_cutoff = 0.5f;
    tl_surface surfaces[2];
    for (int i = 0; i < 2; i++) {
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
    struct tl_render_settings settings = settings_of_six(64, 16);
    settings.light.blur_m = 0;
    tl_frame frame = test_frame((vec3s){{0, 0.7f, 1.9f}}, (vec3s){{0, 0, 0}}, 45, surfaces, 2, &environment);
    tl_image visibility = visibility_image(device, &frame, settings);
    int dark = 0, bright = 0;
    for (int y = 0; y < settings.image.height; y++)
        for (int x = 0; x < settings.image.width; x++) {
            vec3s point = ground_point(&frame.camera, &settings, x, y);
            float actual = test_pixel(&visibility, x, y)[0];
            if (fabsf(point.z) > 0.4f || fabsf(point.x) > 0.9f || fabsf(point.x) < 0.05f)
                continue;
            assert_near(actual, point.x < 0 ? 0 : 1, 0.01);
            dark += point.x < 0;
            bright += point.x > 0;
        }
    assert_true(dark > 20 && bright > 20);
    tl_image_release(&visibility);
    tl_image_release(&mask);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* The view of a region: the sphere's nearest point to the light at depth 0, its farthest at 1, its centre in
 * the middle; and the yaw is a turn about +Y that takes +X to -Z. */
static void test_region_view(void **state)
{
    (void)state;
    const struct tl_casters casters = {.centre = {{1, 2, 3}}, .radius = 0.7f};
    const vec3s directions[] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, -1, 0}}, {{0.6f, -0.48f, 0.64f}}};
    for (int i = 0; i < 4; i++) {
        struct tl_region_view view = tl_region_view_make(directions[i], &casters, 256);
        for (int end = -1; end <= 1; end++) {
            vec3s p = glms_vec3_add(casters.centre, glms_vec3_scale(directions[i], -0.7f * (float)end));
            vec4s point = {{p.x, p.y, p.z, 1}};
            assert_near(glms_vec4_dot(view.map_rows[0], point), 0.5, 1e-5);
            assert_near(glms_vec4_dot(view.map_rows[1], point), 0.5, 1e-5);
            assert_near(glms_vec4_dot(view.map_rows[2], point), 0.5 + 0.5 * end, 1e-5);
        }
    }
    vec3s turned = tl_turn_direction((vec3s){{1, 0.5f, 0}}, (float)M_PI / 2);
    assert_near(turned.x, 0, 1e-6);
    assert_near(turned.y, 0.5, 0);
    assert_near(turned.z, -1, 1e-6);
}

/* Depth maps, everything else as little as can be. */
static struct tl_render_settings depth_of_six(int width, int height)
{
    struct tl_render_settings settings = settings_of_six(width, height);
    settings.light.visibility = TL_VISIBILITY_DEPTH;
    settings.light.composition = TL_COMPOSE_RATIO;
    return settings;
}

/* A ground sheet, and one at height 1 that covers x < 0, seen from beside and below it. */
static void open_half_plane(struct test_shape shapes[2], tl_surface surfaces[2])
{
    shapes[0] = test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 2, 8);
    shapes[1] = test_square((vec3s){{-1, 1, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 1, 4);
    for (int i = 0; i < 2; i++) {
        shapes[i].material.specular = (vec3s){{0, 0, 0}};
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
}

static tl_frame half_plane_frame(const tl_surface surfaces[2], const tl_environment *environment)
{
    return test_frame((vec3s){{0, 0.7f, 1.9f}}, (vec3s){{0, 0, 0}}, 45, surfaces, 2, environment);
}

/* With a depth map the shadow's edge is at its exact place, and sharp except for the two texels that a
 * look-up blends: the casters are 4 m wide on 252 texels. The light's direction is the patch's centre of
 * light on the cube, exact to a hundredth of a texel of 32 a face; the sheet has no slope and therefore no
 * offset. */
static void test_depth_half_plane(void **state)
{
    struct test_device *device = *state;
    patch_direction = (vec3s){{0, 1, 0}};
    tl_environment environment = test_environment(128, 64, bright_patch);
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    open_half_plane(shapes, surfaces);
    struct tl_render_settings settings = depth_of_six(64, 16);
    tl_frame frame = half_plane_frame(surfaces, &environment);
    tl_image visibility = visibility_image(device, &frame, settings);
    int dark = 0, bright = 0;
    for (int y = 0; y < settings.image.height; y++)
        for (int x = 0; x < settings.image.width; x++) {
            vec3s point = ground_point(&frame.camera, &settings, x, y);
            if (fabsf(point.z) > 0.4f || fabsf(point.x) > 1.2f || fabsf(point.x) < 2 * 4.0f / 252)
                continue;
            assert_near(test_pixel(&visibility, x, y)[0], point.x > 0, 1e-5);
            dark += point.x < 0;
            bright += point.x > 0;
        }
    assert_true(dark > 20 && bright > 20);
    tl_image_release(&visibility);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* The share of the patch's light, as the cube holds it, that comes past the edge to a point of the ground:
 * from directions with d.x / d.y > -x. */
static double area_visibility(const tl_cube *cube, float x)
{
    const int up = 2, parts = 8;
    double seen = 0, all = 0;
    for (int row = 0; row < cube->size; row++)
        for (int column = 0; column < cube->size; column++) {
            float light = cube->texels[3 * (size_t)((up * cube->size + row) * cube->size + column)];
            light *= tl_cube_solid_angle(cube->size, column, row);
            for (int part = 0; light > 0 && part < parts * parts; part++) {
                vec3s d = tl_cube_direction(
                    up, ((float)column + ((float)(part % parts) + 0.5f) / (float)parts) / (float)cube->size,
                    ((float)row + ((float)part / (float)parts + 0.5f) / (float)parts) / (float)cube->size);
                all += (double)light;
                seen += d.x > -x * d.y ? (double)light : 0;
            }
        }
    return seen / all;
}

/* Averaged over rounds, hard shadows along directions inside a region become the region's own soft shadow. 64
 * rounds of an even sequence know a share to about 1/64 times the logarithm of 64; a texel of the map is 0.04
 * of the penumbra. */
static void test_rounds_become_area_light(void **state)
{
    struct test_device *device = *state;
    patch_direction = (vec3s){{0, 1, 0}};
    tl_environment environment = test_environment(256, 128, bright_patch);
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    open_half_plane(shapes, surfaces);
    struct tl_render_settings settings = depth_of_six(128, 64);
    settings.light.pem_size = 64;
    settings.light.jitter = true;
    settings.light.rounds = 64;
    tl_frame frame = half_plane_frame(surfaces, &environment);
    for (int round = 0; round + 1 < settings.light.rounds; round++) {
        tl_image image = test_draw(device->renderer, &frame, &settings);
        tl_image_release(&image);
        assert_false(tl_renderer_is_at_rest(device->renderer));
    }
    tl_image shadowed = test_draw(device->renderer, &frame, &settings);
    assert_true(tl_renderer_is_at_rest(device->renderer));
    settings.light.method = TL_METHOD_UNSHADOWED;
    tl_image lit = test_draw(device->renderer, &frame, &settings);
    tl_cube cube = tl_cube_from_environment(&environment, settings.light.pem_size);
    int between = 0;
    for (int y = 0; y < settings.image.height; y++)
        for (int x = 0; x < settings.image.width; x++) {
            vec3s point = ground_point(&frame.camera, &settings, x, y);
            if (fabsf(point.z) > 0.4f || fabsf(point.x) > 1)
                continue;
            double actual = (double)(test_pixel(&shadowed, x, y)[0] / test_pixel(&lit, x, y)[0]);
            assert_near(actual, area_visibility(&cube, point.x), 0.07);
            between += actual > 0.1 && actual < 0.9;
        }
    assert_true(between > 10);
    tl_cube_release(&cube);
    tl_image_release(&shadowed);
    tl_image_release(&lit);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* Directions of rounds lie inside their region, the first is its own, and their mean tends to it. */
static void test_rounds_stay_inside(void **state)
{
    (void)state;
    patch_direction = glms_vec3_normalize((vec3s){{0.3f, 1, 0.2f}});
    tl_environment environment = test_environment(128, 64, bright_patch);
    tl_cube cube = tl_cube_from_environment(&environment, 32);
    struct tl_regions regions = {0};
    tl_regions_cut(&cube, 6, &regions);
    for (int i = 0; i < regions.count; i++) {
        vec3s sum = {{0, 0, 0}}, first = tl_region_seen_direction(&regions, i, 0);
        assert_memory_equal(&first, &regions.items[i].direction, sizeof first);
        for (int round = 1; round <= 128; round++) {
            vec3s d = tl_region_seen_direction(&regions, i, round);
            int face;
            float s, t;
            tl_cube_locate(d, &face, &s, &t);
            int column = (int)(s * 32) < 31 ? (int)(s * 32) : 31,
                row = (int)(t * 32) < 31 ? (int)(t * 32) : 31;
            assert_int_equal(regions.labels[(face * 32 + row) * 32 + column], i);
            sum = glms_vec3_add(sum, d);
        }
        /* A black region is a whole face, 1.6 rad wide: the mean of 128 even draws is within a few
         * hundredths. */
        assert_near(glms_vec3_angle(sum, regions.items[i].direction), 0, 0.05);
    }
    tl_regions_release(&regions);
    tl_cube_release(&cube);
    tl_environment_release(&environment);
}

/* The largest light in the middle of the shadow of a sheet `height_m` above the ground, and the bytes of
 * maps. */
static float leak_under(struct test_device *device, const tl_environment *environment, float height_m,
                        int moments, size_t *bytes)
{
    struct test_shape shapes[2] = {
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 2, 8),
        test_square((vec3s){{0, height_m, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 0.6f, 4)};
    tl_surface surfaces[2];
    for (int i = 0; i < 2; i++) {
        shapes[i].material.specular = (vec3s){{0, 0, 0}};
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
    struct tl_render_settings settings = settings_of_six(32, 8);
    settings.light.blur_m = 0;
    settings.light.moments = moments;
    /* From below the sheet: from afar, so that it does not hide what it shadows. */
    tl_frame frame =
        test_frame((vec3s){{0, 0.006f, 1.9f}}, (vec3s){{0, 0, 0}}, 0.09f, surfaces, 2, environment);
    tl_image visibility = visibility_image(device, &frame, settings);
    float maximum = 0;
    int seen = 0;
    for (int y = 0; y < settings.image.height; y++)
        for (int x = 0; x < settings.image.width; x++) {
            vec3s point = ground_point(&frame.camera, &settings, x, y);
            if (point.y > 1e-4f || fabsf(point.z) > 0.4f || fabsf(point.x) > 0.4f)
                continue;
            seen++;
            maximum = fmaxf(maximum, test_pixel(&visibility, x, y)[0]);
        }
    assert_true(seen > 20);
    tl_image_release(&visibility);
    *bytes = tl_renderer_memory(device->renderer).maps;
    for (int i = 0; i < 2; i++)
        test_shape_release(&shapes[i]);
    return maximum;
}

/* Moments in half precision take half the memory. Rounded to 2^-12 of themselves, depths m of half a unit and
 * squares have a variance that is off by e = 2^-12 m^2 + 2 m 2^-12 m at most; where a shadow's caster is d
 * units away Chebyshev's bound lets e / (e + d^2) of the light through. One unit is 2 x 2 sqrt(2) m here. In
 * floats e is 2^-12 times smaller. */
static void test_half_precision_leaks_near_casters(void **state)
{
    struct test_device *device = *state;
    patch_direction = (vec3s){{0, 1, 0}};
    tl_environment environment = test_environment(128, 64, bright_patch);
    static const float heights[] = {0.015f, 0.03f, 0.06f, 0.25f, 1};
    float near_leak = 0;
    for (size_t i = 0; i < TL_COUNT(heights); i++) {
        size_t bytes[2];
        float leaks[2];
        for (int moments = TL_MOMENTS_FLOAT; moments <= TL_MOMENTS_HALF; moments++)
            leaks[moments] = leak_under(device, &environment, heights[i], moments, &bytes[moments]);
        float away = (heights[i] - 0.001f) / (4 * sqrtf(2)), error = 3 * 0.27f * ldexpf(1, -12);
        float bound = error / (error + away * away);
        print_message(
            "a sheet %.3f m above the ground lets %.4f through in floats, %.4f in halves (bound %.4f); "
            "%zu and %zu bytes\n",
            (double)heights[i], (double)leaks[0], (double)leaks[1], (double)bound, bytes[0], bytes[1]);
        assert_true(leaks[TL_MOMENTS_FLOAT] < 0.05f);
        assert_true(leaks[TL_MOMENTS_HALF] <= bound + 0.005f);
        near_leak = fmaxf(near_leak, leaks[TL_MOMENTS_HALF]);
        /* Six maps and one that blurs, of 256 x 256 texels, of 8 bytes or 4, besides a depth buffer. */
        assert_int_equal(bytes[0] - bytes[1], 7 * 256 * 256 * 4);
    }
    assert_true(near_leak > 0.1f); /* else nothing was rounded */
    tl_environment_release(&environment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_plane_penumbra),
        cmocka_unit_test(test_shadow_position),
        cmocka_unit_test(test_ground_blocks_light_from_below),
        cmocka_unit_test(test_no_acne),
        cmocka_unit_test(test_mask_lets_light_through),
        cmocka_unit_test(test_region_view),
        cmocka_unit_test(test_depth_half_plane),
        cmocka_unit_test(test_half_precision_leaks_near_casters),
        cmocka_unit_test(test_rounds_become_area_light),
        cmocka_unit_test(test_rounds_stay_inside),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
