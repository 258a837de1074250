/* The light passes against the CPU's chain look-up, closed forms, and equivalent scenes. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "render/pem/chain.h"
#include "render/pem/lobe.h"

#include "tests/testing.h"

/* Half floats are within 2^-10 of a value where they are cut, 2^-11 where they are rounded, and GL leaves to
 * the driver which. What is lit passes three of them: PEM, kd or ks, normal. */
#define HALF_STEP 9.765625e-4f

static vec3s white(vec3s d)
{
    (void)d;
    return (vec3s){{1, 1, 1}};
}

/* Smooth and coloured, gradient at most 1.3 per radian. */
static vec3s gradient(vec3s d)
{
    return (vec3s){{2 + d.x, 2 - 0.8f * d.y + 0.5f * d.z, 1.5f + d.z}};
}

static vec3s sunny(vec3s d)
{
    bool sun = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.3f, 0.8f, 0.5f}})) > 0.995f;
    return sun ? (vec3s){{1e6f, 9e5f, 8e5f}} : (vec3s){{0.5f, 0.6f, 0.7f}};
}

/* White noise by a fixed hash of the direction's texel. */
static vec3s noise(vec3s d)
{
    uint32_t hash = (uint32_t)(int)(d.x * 4096) * 73856093u ^ (uint32_t)(int)(d.y * 4096) * 19349663u ^
                    (uint32_t)(int)(d.z * 4096) * 83492791u;
    hash = (hash ^ hash >> 13) * 1274126177u;
    float value = (float)(hash >> 8) / 16777216.0f;
    return (vec3s){{value, 1 - value, value * value}};
}

static vec3s from_plus_x(vec3s d)
{
    return d.x > 0.9f ? (vec3s){{1, 1, 1}} : (vec3s){{0, 0, 0}};
}

static struct tl_render_settings unshadowed(int width, int height, enum tl_lobe lobe)
{
    struct tl_render_settings settings = test_settings(width, height);
    settings.light.method = TL_METHOD_UNSHADOWED;
    settings.light.lobe = (int)lobe;
    return settings;
}

/* Constant light: whatever the glossiness, a sphere shows kd + ks (dual) or their mixture (single). */
static void test_white_furnace(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, white);
    struct test_shape sphere = test_sphere((vec3s){{0, 0, 0}}, 1, 24);
    const float kd = 0.25f;
    sphere.material.diffuse = (vec3s){{kd, kd, kd}};
    sphere.material.specular = (vec3s){{1, 1, 1}}; /* F is 1 at every angle */
    for (int lobe = TL_LOBE_SINGLE; lobe <= TL_LOBE_DUAL; lobe++)
        for (int step = 0; step <= 8; step++) {
            float g = (float)step / 8;
            sphere.material.glossiness = g;
            test_shape_refresh(&sphere);
            tl_frame frame =
                test_frame((vec3s){{0, 0, 4}}, (vec3s){{0, 0, 0}}, 40, &sphere.surface, 1, &environment);
            struct tl_render_settings settings = unshadowed(32, 32, (enum tl_lobe)lobe);
            tl_image image = test_draw(device->renderer, &frame, &settings);
            float expected = lobe == TL_LOBE_DUAL ? kd + 1 : kd + (1 - kd) * g;
            int covered = 0;
            for (int y = 0; y < 32; y++)
                for (int x = 0; x < 32; x++) {
                    const float *pixel = test_pixel(&image, x, y);
                    covered += pixel[3] == 1;
                    for (int c = 0; c < 3; c++)
                        assert_near(pixel[c], pixel[3] * expected, 2 * HALF_STEP * expected);
                }
            assert_true(covered > 200);
            tl_image_release(&image);
        }
    test_shape_release(&sphere);
    tl_environment_release(&environment);
}

/* Schlick's term at 60 degrees: 0.04 + 0.96 (1 - 0.5)^5. */
static void test_fresnel(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, white);
    struct test_shape square = test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 1, 1);
    square.material.diffuse = (vec3s){{0, 0, 0}};
    test_shape_refresh(&square);
    tl_frame frame =
        test_frame((vec3s){{0, 2, 2 * sqrtf(3)}}, (vec3s){{0, 0, 0}}, 0.1f, &square.surface, 1, &environment);
    struct tl_render_settings settings = unshadowed(1, 1, TL_LOBE_DUAL);
    tl_image image = test_draw(device->renderer, &frame, &settings);
    assert_near(test_pixel(&image, 0, 0)[0], 0.04 + 0.96 / 32, 2 * HALF_STEP * 0.07);
    tl_image_release(&image);
    test_shape_release(&square);
    tl_environment_release(&environment);
}

struct orientation {
    vec3s normal, right, view; /* unit; `view` points to the eye */
};

/* Squares turned every way, seen from directions up to 70 degrees off their normal. */
static struct orientation orientation(int i)
{
    float z = 1 - 2 * ((float)i + 0.5f) / 24, phi = 2.399963f * (float)i, r = sqrtf(1 - z * z);
    vec3s normal = {{r * cosf(phi), z, r * sinf(phi)}};
    vec3s helper = fabsf(normal.y) < 0.9f ? (vec3s){{0, 1, 0}} : (vec3s){{1, 0, 0}};
    vec3s right = glms_vec3_normalize(glms_vec3_cross(helper, normal));
    float tilt = 1.2f * (float)(i % 5) / 4;
    vec3s view = glms_vec3_add(glms_vec3_scale(normal, cosf(tilt)), glms_vec3_scale(right, sinf(tilt)));
    return (struct orientation){normal, right, view};
}

/* One pixel of a square turned to orientation `i`. */
static vec3s draw_square(tl_renderer *renderer, const struct orientation *o, const tl_material *material,
                         const tl_environment *environment, const struct tl_render_settings *settings)
{
    struct test_shape square = test_square((vec3s){{0, 0, 0}}, o->right, o->normal, 1, 1);
    square.material = *material;
    test_shape_refresh(&square);
    tl_frame frame =
        test_frame(glms_vec3_scale(o->view, 3), (vec3s){{0, 0, 0}}, 0.1f, &square.surface, 1, environment);
    tl_image image = test_draw(renderer, &frame, settings);
    const float *pixel = test_pixel(&image, 0, 0);
    assert_near(pixel[3], 1, 0);
    vec3s colour = {{pixel[0], pixel[1], pixel[2]}};
    tl_image_release(&image);
    test_shape_release(&square);
    return colour;
}

/* With VIS = 1 the PEMs must add up to the undivided environment, filtered and looked up on the CPU: about
 * the normal and the mirror direction, or once, between the two by glossiness. */
static void check_sum(struct test_device *device, vec3s (*radiance)(vec3s), enum tl_cut cut,
                      enum tl_lobe lobes, float glossiness, float tolerance)
{
    tl_environment environment = test_environment(128, 64, radiance);
    struct tl_render_settings settings = unshadowed(1, 1, lobes);
    settings.light.cut = (int)cut;
    tl_cube cube = tl_cube_from_environment(&environment, settings.light.pem_size);
    struct tl_chain chain = tl_chain_build(&cube, TL_CHAIN_SQRT_COSINE);
    struct tl_lobe_table *lobe = TL_NEW(struct tl_lobe_table);
    tl_lobe_calibrate(settings.light.pem_size, TL_CHAIN_SQRT_COSINE, lobe);
    tl_material material = tl_material_default("test");
    material.diffuse = (vec3s){{0.5f, 0.5f, 0.5f}};
    material.specular = (vec3s){{1, 1, 1}};
    material.glossiness = glossiness;
    float level = lobe->level[(int)lroundf(glossiness * (TL_LOBE_STEPS - 1))];
    for (int i = 0; i < 24; i++) {
        struct orientation o = orientation(i);
        float n_dot_v = glms_vec3_dot(o.normal, o.view);
        vec3s r = glms_vec3_sub(glms_vec3_scale(o.normal, 2 * n_dot_v), o.view);
        vec3s diffuse = tl_chain_sample(&chain, o.normal, lobe->level[0]);
        vec3s gloss = tl_chain_sample(&chain, r, level);
        vec3s one =
            tl_chain_sample(&chain, glms_vec3_normalize(glms_vec3_lerp(o.normal, r, glossiness)), level);
        vec3s actual = draw_square(device->renderer, &o, &material, &environment, &settings);
        for (int c = 0; c < 3; c++) {
            float expected = lobes == TL_LOBE_DUAL ? 0.5f * diffuse.raw[c] + gloss.raw[c]
                                                   : (0.5f + 0.5f * glossiness) * one.raw[c];
            assert_near(actual.raw[c], expected, tolerance + 4 * HALF_STEP * expected);
        }
    }
    free(lobe);
    tl_chain_release(&chain);
    tl_cube_release(&cube);
    tl_environment_release(&environment);
}

/* A normal in halves is off by up to sqrt(3)/2 x 2^-10 rad, its reflection by twice that; times the gradient.
 */
static void test_sum_of_pems_smooth(void **state)
{
    for (int step = 0; step <= 5; step++)
        for (int lobes = TL_LOBE_SINGLE; lobes <= TL_LOBE_DUAL; lobes++)
            check_sum(*state, gradient, TL_CUT_FACES, (enum tl_lobe)lobes, (float)(step * 51) / 255,
                      1.3f * 3 * 8.5e-4f);
}

/* The same error is a fiftieth of a texel of 32 a side; neighbours differ by up to one. Faces, borders and
 * corners in a wrong place would show as differences of half. */
static void test_sum_of_pems_noise(void **state)
{
    check_sum(*state, noise, TL_CUT_FACES, TL_LOBE_DUAL, 1, 0.04f);
}

/* Regions of the sphere lie on several faces. */
static void test_sum_of_pems_of_the_sphere(void **state)
{
    check_sum(*state, gradient, TL_CUT_SPHERE, TL_LOBE_DUAL, 0.6f, 1.3f * 3 * 8.5e-4f);
}

/* A sun of 1e6 does not fit a half float; it must come back as it was. */
static void test_sum_of_pems_sun(void **state)
{
    check_sum(*state, sunny, TL_CUT_FACES, TL_LOBE_DUAL, 0.6f, 1e6f * 2e-3f * HALF_STEP);
}

static double largest_difference(const tl_image *a, const tl_image *b)
{
    double largest = 0;
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height * 4; i++)
        largest = fmax(largest, fabs((double)(tl_image_floats(a)[i] - tl_image_floats(b)[i])));
    return largest;
}

static double mean_difference(const tl_image *a, const tl_image *b)
{
    double sum = 0;
    size_t count = (size_t)a->width * (size_t)a->height * 4;
    for (size_t i = 0; i < count; i++)
        sum += fabs((double)(tl_image_floats(a)[i] - tl_image_floats(b)[i]));
    return sum / (double)count;
}

/* A sphere under a sheet, both glossy. */
static void make_scene(struct test_shape shapes[2], tl_surface surfaces[2])
{
    shapes[0] = test_sphere((vec3s){{0, 0.5f, 0}}, 0.4f, 24);
    shapes[1] = test_sheet(1.1f, 0.5f, 0.06f, 2, 32);
    for (int i = 0; i < 2; i++) {
        shapes[i].material.glossiness = 0.7f;
        test_shape_refresh(&shapes[i]);
        surfaces[i] = shapes[i].surface;
    }
}

/* How the regions are dealt out to passes changes the order of additions and nothing else. */
static void test_passes_add_up(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, gradient);
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    make_scene(shapes, surfaces);
    tl_frame frame = test_frame((vec3s){{1, 1.5f, 2}}, (vec3s){{0, 0.6f, 0}}, 40, surfaces, 2, &environment);
    struct tl_render_settings settings = test_settings(64, 48);
    settings.light.map_size = 64;
    tl_image whole = test_draw(device->renderer, &frame, &settings);
    const int passes[] = {1, 5, 64};
    for (int i = 0; i < 3; i++) {
        settings.light.pems_per_pass = passes[i];
        tl_image other = test_draw(device->renderer, &frame, &settings);
        assert_near(largest_difference(&whole, &other), 0, 24 * 1.2e-7 * 4);
        tl_image_release(&other);
    }
    tl_image_release(&whole);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

static void test_twice_the_same_bits(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, sunny);
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    make_scene(shapes, surfaces);
    tl_frame frame = test_frame((vec3s){{1, 1.5f, 2}}, (vec3s){{0, 0.6f, 0}}, 40, surfaces, 2, &environment);
    struct tl_render_settings settings = test_settings(64, 48);
    tl_image first = test_draw(device->renderer, &frame, &settings);
    tl_error error = {0};
    tl_renderer *another = tl_renderer_create(device->gpu, &error);
    assert_non_null(another);
    tl_image second = test_draw(another, &frame, &settings);
    assert_memory_equal(first.texels, second.texels, (size_t)64 * 48 * 4 * sizeof(float));
    tl_renderer_destroy(&another);
    tl_image_release(&first);
    tl_image_release(&second);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* Counter-clockwise from above: light from +X, turned by a quarter, comes from -Z. */
static void test_yaw_direction(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, from_plus_x);
    struct test_shape square =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{-1, 0, 0}}, (vec3s){{0, 0, -1}}, 1, 1);
    square.material.specular = (vec3s){{0, 0, 0}};
    test_shape_refresh(&square);
    tl_frame frame =
        test_frame((vec3s){{0, 0, -3}}, (vec3s){{0, 0, 0}}, 0.1f, &square.surface, 1, &environment);
    struct tl_render_settings settings = test_settings(1, 1);
    float light[4];
    for (int quarter = 0; quarter < 4; quarter++) {
        frame.environment_yaw = (float)quarter * (float)M_PI / 2;
        tl_image image = test_draw(device->renderer, &frame, &settings);
        light[quarter] = test_pixel(&image, 0, 0)[0];
        tl_image_release(&image);
    }
    assert_true(light[1] > 4 * light[0] && light[1] > 4 * light[2] && light[1] > 4 * light[3]);
    test_shape_release(&square);
    tl_environment_release(&environment);
}

static void turn_shape(struct test_shape *shape, float angle)
{
    for (size_t i = 0; i < shape->mesh.vertex_count; i++) {
        vec3s axis = {{0, 1, 0}},
              t = {{shape->mesh.tangents[i].x, shape->mesh.tangents[i].y, shape->mesh.tangents[i].z}};
        shape->mesh.positions[i] = glms_vec3_rotate(shape->mesh.positions[i], angle, axis);
        shape->mesh.normals[i] = glms_vec3_rotate(shape->mesh.normals[i], angle, axis);
        t = glms_vec3_rotate(t, angle, axis);
        shape->mesh.tangents[i] = (vec4s){{t.x, t.y, t.z, shape->mesh.tangents[i].w}};
    }
    test_shape_refresh(shape);
}

/* To turn the environment is to turn everything else the other way. The regions' views turn with them, so
 * only roundings differ, and here and there a sample at an edge: a thousandth of the mean, which is 0.1. A
 * yaw of the wrong sign in the look-up alone differs by 0.003. */
static void test_yaw_turns_light_and_shadow(void **state)
{
    struct test_device *device = *state;
    const float angle = 0.7f;
    vec3s eye = {{1, 1.5f, 2}}, target = {{0, 0.6f, 0}}, axis = {{0, 1, 0}};
    tl_environment environment = test_environment(64, 32, sunny);
    for (int i = 0; i < 64 * 32 * 3; i++) /* a sun of 60 */
        tl_image_floats(&environment.image)[i] = fminf(tl_image_floats(&environment.image)[i], 60);
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    make_scene(shapes, surfaces);
    struct tl_render_settings settings = test_settings(64, 48);
    tl_frame frame = test_frame(eye, target, 40, surfaces, 2, &environment);
    frame.environment_yaw = angle;
    tl_image turned_light = test_draw(device->renderer, &frame, &settings);
    for (int i = 0; i < 2; i++) {
        turn_shape(&shapes[i], -angle);
        surfaces[i] = shapes[i].surface;
    }
    frame = test_frame(glms_vec3_rotate(eye, -angle, axis), glms_vec3_rotate(target, -angle, axis), 40,
                       surfaces, 2, &environment);
    tl_image turned_scene = test_draw(device->renderer, &frame, &settings);
    assert_near(mean_difference(&turned_light, &turned_scene), 0, 1e-4);
    tl_image_release(&turned_light);
    tl_image_release(&turned_scene);
    test_shape_release(&shapes[0]);
    test_shape_release(&shapes[1]);
    tl_environment_release(&environment);
}

/* Light on a square that faces +Z with the given material, seen head on. */
static vec3s facing_z(struct test_device *device, const tl_material *material, float handedness,
                      const tl_environment *environment, bool from_behind)
{
    struct test_shape square = test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 1, 1);
    for (size_t i = 0; i < square.mesh.vertex_count; i++)
        square.mesh.tangents[i].w = handedness;
    square.material = *material;
    square.mesh.parts[0].uv_metres = 2; /* its side: a weave lies to scale */
    test_shape_refresh(&square);
    tl_frame frame = test_frame((vec3s){{0, 0, from_behind ? -3.0f : 3.0f}}, (vec3s){{0, 0, 0}}, 0.1f,
                                &square.surface, 1, environment);
    struct tl_render_settings settings = unshadowed(1, 1, TL_LOBE_DUAL);
    tl_image image = test_draw(device->renderer, &frame, &settings);
    vec3s colour = {{test_pixel(&image, 0, 0)[0], test_pixel(&image, 0, 0)[1], test_pixel(&image, 0, 0)[2]}};
    tl_image_release(&image);
    test_shape_release(&square);
    return colour;
}

/* The colour of a matt square with this normal. */
static vec3s facing(struct test_device *device, vec3s normal, const tl_material *material,
                    const tl_environment *environment)
{
    vec3s right = glms_vec3_normalize(glms_vec3_cross((vec3s){{0.1f, 1, 0.2f}}, normal));
    const struct orientation o = {normal, right, normal};
    tl_material plain = *material;
    plain.normal_map.image = NULL;
    plain.weave = NULL;
    struct tl_render_settings settings = unshadowed(1, 1, TL_LOBE_DUAL);
    return draw_square(device->renderer, &o, &plain, environment, &settings);
}

static void assert_same_colour(vec3s actual, vec3s expected)
{
    /* A normal of bytes is off by up to 1/255; times the gradient, and a byte's flat is 1/255 off as well. */
    for (int c = 0; c < 3; c++)
        assert_near(actual.raw[c], expected.raw[c], 1.3 * 2.5 / 255);
}

static tl_image normal_image(vec3s n)
{
    tl_image image = tl_image_create(2, 2, 3, TL_IMAGE_U8);
    image.linear = true;
    for (int i = 0; i < 12; i++)
        tl_image_bytes(&image)[i] = (uint8_t)lroundf(127.5f + 127.5f * n.raw[i % 3]);
    return image;
}

/* A normal map tilts the normal as if the square were tilted: x along the tangent, y along w cross(n, t). */
static void test_normal_map_direction(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(128, 64, gradient);
    tl_material material = tl_material_default("test");
    material.specular = (vec3s){{0, 0, 0}};
    const vec3s mapped = {{0.48f, 0.64f, 0.6f}};
    tl_image image = normal_image(mapped);
    material.normal_map.image = &image;

    vec3s actual = facing_z(device, &material, 1, &environment, false);
    assert_same_colour(actual, facing(device, mapped, &material, &environment));
    actual = facing_z(device, &material, -1, &environment, false);
    assert_same_colour(actual,
                       facing(device, (vec3s){{mapped.x, -mapped.y, mapped.z}}, &material, &environment));
    /* A back is a surface of its own: its normal is the front's, turned round. */
    actual = facing_z(device, &material, 1, &environment, true);
    assert_same_colour(actual, facing(device, glms_vec3_negate(mapped), &material, &environment));
    tl_image_release(&image);
    tl_environment_release(&environment);
}

/* The weave adds its slopes to the map's, its gloss to the glossiness, and multiplies the diffuse colour. */
static void test_weave(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(128, 64, gradient);
    tl_material material = tl_material_default("test");
    tl_image bent = normal_image(glms_vec3_normalize((vec3s){{0.4f, 0, 1}}));
    tl_weave weave = {.size_m = {0.002f, 0.002f},
                      .normal = normal_image(glms_vec3_normalize((vec3s){{0.2f, 0.3f, 1}})),
                      .height = tl_image_create(2, 2, 1, TL_IMAGE_F32),
                      .gloss = tl_image_create(2, 2, 1, TL_IMAGE_F32),
                      .tint = tl_image_create(2, 2, 3, TL_IMAGE_F32)};
    for (int i = 0; i < 4; i++) {
        tl_image_floats(&weave.gloss)[i] = 0.25f;
        for (int c = 0; c < 3; c++)
            tl_image_floats(&weave.tint)[3 * i + c] = 0.5f + 0.1f * (float)c;
    }
    material.specular = (vec3s){{0, 0, 0}};
    material.normal_map.image = &bent;
    material.weave = &weave;
    vec3s sum_of_slopes = glms_vec3_normalize((vec3s){{0.6f, 0.3f, 1}});
    tl_material tinted = material;
    tinted.diffuse = (vec3s){{0.25f, 0.3f, 0.35f}};
    assert_same_colour(facing_z(device, &material, 1, &environment, false),
                       facing(device, sum_of_slopes, &tinted, &environment));

    material.normal_map.image = NULL;
    tl_image_release(&weave.normal);
    weave.normal = normal_image((vec3s){{0, 0, 1}});
    material.diffuse = (vec3s){{0, 0, 0}};
    material.specular = (vec3s){{1, 1, 1}};
    material.glossiness = 0.5f;
    tl_material glossier = material;
    glossier.glossiness = 0.75f;
    assert_same_colour(facing_z(device, &material, 1, &environment, false),
                       facing(device, (vec3s){{0, 0, 1}}, &glossier, &environment));
    tl_image_release(&bent);
    tl_image_release(&weave.normal);
    tl_image_release(&weave.height);
    tl_image_release(&weave.gloss);
    tl_image_release(&weave.tint);
    tl_environment_release(&environment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_furnace),
        cmocka_unit_test(test_fresnel),
        cmocka_unit_test(test_sum_of_pems_smooth),
        cmocka_unit_test(test_sum_of_pems_noise),
        cmocka_unit_test(test_sum_of_pems_of_the_sphere),
        cmocka_unit_test(test_sum_of_pems_sun),
        cmocka_unit_test(test_passes_add_up),
        cmocka_unit_test(test_twice_the_same_bits),
        cmocka_unit_test(test_yaw_direction),
        cmocka_unit_test(test_yaw_turns_light_and_shadow),
        cmocka_unit_test(test_normal_map_direction),
        cmocka_unit_test(test_weave),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
