/* The scene captured into a cube, against ray tracing: closed forms for a ball, and the reference. */
#include "tests/render/scenes.h"

#include "render/env/from_environment.h"
#include "render/env/lobes.h"

#include "tests/testing.h"

#include <string.h>

#define SIZE 32

static vec3s lights(vec3s d)
{
    float lamp = fmaxf(glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.5f, 0.7f, 0.6f}})), 0);
    float warm = 3 * powf(lamp, 6);
    return (vec3s){{0.3f + warm, 0.4f + 0.7f * warm, 0.5f + 0.2f * d.y}};
}
#define BRIGHTEST 3.3

static const vec3s kd = {{0.8f, 0.3f, 0.1f}};
static const vec3s centre = {{0.5f, 0.3f, -2.5f}}; /* of the big ball, seen from the origin */
#define RADIUS 1.5f

static void scene_open(struct test_scene *scene)
{
    test_scene_open(scene, test_environment(128, 64, lights), (vec3s){{0, 0, 1}}, (vec3s){{0, 0, 0}}, 1, 8,
                    8);
    tl_material *ball = test_scene_add(scene, test_sphere(centre, RADIUS, 96));
    test_scene_add(scene, test_sphere((vec3s){{0, 0, 0}}, 0.05f, 48));
    ball->diffuse = kd;
    ball->specular = (vec3s){{0, 0, 0}};
    scene->settings.light.method = TL_METHOD_MAPS;
    scene->settings.maps.mode = TL_MAPS_MIRROR;
    scene->settings.maps.size = SIZE;
    scene->settings.maps.minify = false;
    scene->settings.maps.capture_every = 1;
    /* the middle of the scene is that of the box around both */
    struct tl_box boxes[2] = {tl_box_of(scene->surfaces[0].positions, scene->surfaces[0].vertex_count),
                              tl_box_of(scene->surfaces[1].positions, scene->surfaces[1].vertex_count)};
    for (int axis = 0; axis < 3; axis++)
        scene->settings.maps.capture_at[axis] =
            -0.5f * (fminf(boxes[0].lower.raw[axis], boxes[1].lower.raw[axis]) +
                     fmaxf(boxes[0].upper.raw[axis], boxes[1].upper.raw[axis]));
}

static void draw(tl_renderer *renderer, struct test_scene *scene)
{
    tl_image image = test_scene_draw(scene, renderer);
    tl_image_release(&image);
}

/* Intersects a ray from the origin with the ball: the normal there, or false. */
static bool meet(vec3s direction, vec3s *normal)
{
    float along = glms_vec3_dot(direction, centre);
    float square = glms_vec3_norm2(centre) - along * along;
    if (along < 0 || square >= RADIUS * RADIUS)
        return false;
    vec3s hit = glms_vec3_scale(direction, along - sqrtf(RADIUS * RADIUS - square));
    *normal = glms_vec3_scale(glms_vec3_sub(hit, centre), 1 / RADIUS);
    return true;
}

/* Diffuse light by exact lobes (test_lobes.c), in the environment's frame. */
struct truth {
    struct tl_lobes lobes;
    float yaw;
};

static vec3s seen(const struct truth *truth, vec3s direction)
{
    vec3s normal;
    if (!meet(direction, &normal))
        return lights(tl_turn_direction(direction, -truth->yaw));
    vec3s light = tl_lobes_fetch(&truth->lobes, tl_turn_direction(normal, -truth->yaw),
                                 (struct tl_exponent_blend){.index = 0});
    return glms_vec3_mul(kd, light);
}

/* Rays from the origin, 8 x 8 a texel. Whole texels: normals in halves and bilinear look-ups. Texels that the
 * outline crosses hold four samples: off by an eighth of the contrast on average, half at most. */
static void check_cube(tl_renderer *renderer, struct test_scene *scene, float yaw)
{
    enum { RAYS = 8 };
    tl_error error;
    tl_image cube;
    tl_cube environment = tl_cube_from_environment(&scene->environment, 64);
    struct truth truth = {.yaw = yaw};
    tl_lobes_make(&truth.lobes, &environment, 1);
    scene->frame.environment_yaw = yaw;
    draw(renderer, scene);
    assert_ok(tl_renderer_read_capture(renderer, &cube, &error), error);
    assert_int_equal(cube.width, SIZE);
    assert_int_equal(cube.height, 6 * SIZE);
    double worst = 0, worst_crossed = 0;
    int on_ball = 0, crossed = 0;
    for (int i = 0; i < 6 * SIZE * SIZE; i++) {
        vec3s sum = {{0, 0, 0}}, normal;
        int hits = 0;
        for (int k = 0; k < RAYS * RAYS; k++) {
            int column = i % SIZE, row = i / SIZE % SIZE, across = k % RAYS, down = k / RAYS;
            float s = ((float)column + ((float)across + 0.5f) / RAYS) / SIZE,
                  t = ((float)row + ((float)down + 0.5f) / RAYS) / SIZE;
            vec3s ray = glms_vec3_normalize(tl_cube_direction(i / SIZE / SIZE, s, t));
            hits += meet(ray, &normal);
            sum = glms_vec3_add(sum, glms_vec3_scale(seen(&truth, ray), 1.0f / (RAYS * RAYS)));
        }
        bool is_whole = hits == 0 || hits == RAYS * RAYS;
        on_ball += hits == RAYS * RAYS;
        crossed += !is_whole;
        for (int c = 0; c < 3; c++) {
            double off = fabs((double)(tl_image_floats(&cube)[3 * i + c] - sum.raw[c]));
            worst = fmax(worst, is_whole ? off : 0);
            worst_crossed = fmax(worst_crossed, is_whole ? 0 : off);
        }
    }
    print_message("yaw %.1f: %d texels of the ball, off by %.2f %% of the brightest, %d on its outline by "
                  "%.1f %%\n",
                  (double)yaw, on_ball, 100 * worst / BRIGHTEST, crossed, 100 * worst_crossed / BRIGHTEST);
    assert_true(on_ball > 300 && crossed > 30);
    assert_true(worst < 0.01 * BRIGHTEST);
    assert_true(worst_crossed < 0.5 * BRIGHTEST);
    tl_lobes_release(&truth.lobes);
    tl_cube_release(&environment);
    tl_image_release(&cube);
}

static void a_ball_is_captured(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene);
    check_cube(device->renderer, &scene, 0);
    check_cube(device->renderer, &scene, 1.2f);
    test_scene_close(&scene);
}

/* The reference looks along -Z, with +X on its right; the face has it on its left. The ball is convex and
 * alone (the small one is in the eye, and left away), so that nothing is shadowed but by itself. Where the
 * face shows the ball: the reference's own noise, told with its image, and the capture's 1 %. */
static void the_reference_sees_the_same(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error;
    tl_image cube;
    scene_open(&scene);
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_read_capture(device->renderer, &cube, &error), error);
    struct tl_render_settings settings = scene.settings;
    settings.light.method = TL_METHOD_REFERENCE;
    settings.image.width = settings.image.height = SIZE;
    tl_frame frame =
        test_frame((vec3s){{0, 0, 0}}, (vec3s){{0, 0, -1}}, 90, scene.surfaces, 1, &scene.environment);
    tl_image truth = test_draw(device->renderer, &frame, &settings);
    double sum = 0, squares = 0;
    int counted = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            const float *pixel = test_pixel(&truth, x, y);
            const float *texel = test_pixel(&cube, SIZE - 1 - x, 5 * SIZE + y);
            vec3s normal;
            vec3s ray = tl_cube_texel_direction(SIZE, (5 * SIZE + y) * SIZE + SIZE - 1 - x);
            if (pixel[3] < 1 || !meet(ray, &normal) || glms_vec3_dot(normal, ray) > -0.3f)
                continue;
            counted++;
            for (int c = 0; c < 3; c++) {
                squares += pow((double)(pixel[c] - texel[c]), 2);
                sum += pow((double)pixel[c], 2);
            }
        }
    double noise = tl_renderer_standard_error(device->renderer);
    print_message("%d pixels of the reference: relative RMSE %.2f %%, its own noise %.2f %%\n", counted,
                  100 * sqrt(squares / sum), 100 * noise);
    assert_true(counted > 200);
    assert_true(sqrt(squares / sum) < 0.01 + 3 * noise);
    tl_image_release(&truth);
    tl_image_release(&cube);
    test_scene_close(&scene);
}

/* The small mirror shows the big ball where it should: looking past the mirror's middle, at the normal
 * half-way between the eye and the ball. It is 1/40 of the distance to the ball, by which its map is off. */
static void a_mirror_shows_the_scene(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene);
    tl_cube environment = tl_cube_from_environment(&scene.environment, 64);
    struct truth truth = {.yaw = 0};
    tl_lobes_make(&truth.lobes, &environment, 1);
    scene.settings.maps.size = 64;
    vec3s to_ball = glms_vec3_normalize(centre), to_eye = glms_vec3_normalize((vec3s){{1, 0.2f, 0.1f}});
    vec3s normal = glms_vec3_normalize(glms_vec3_add(to_ball, to_eye));
    vec3s target = glms_vec3_scale(normal, 0.05f);
    scene.frame.camera.eye = glms_vec3_add(target, to_eye);
    scene.frame.camera.target = target;
    scene.frame.camera.fov_y = 0.001f;
    tl_image image = test_scene_draw(&scene, device->renderer);
    vec3s expected = seen(&truth, to_ball);
    for (int c = 0; c < 3; c++)
        assert_near(test_pixel(&image, 4, 4)[c], expected.raw[c], 0.02 * BRIGHTEST);
    tl_image_release(&image);
    scene.settings.maps.capture_every = 0; /* the environment alone */
    image = test_scene_draw(&scene, device->renderer);
    vec3s alone = lights(to_ball);
    for (int c = 0; c < 3; c++)
        assert_near(test_pixel(&image, 4, 4)[c], alone.raw[c], 0.02 * BRIGHTEST);
    tl_image_release(&image);
    tl_lobes_release(&truth.lobes);
    tl_cube_release(&environment);
    test_scene_close(&scene);
}

/* Two lamps on the big ball, which is convex, so that nothing is shadowed but by its own horizon: kd / pi
 * times the irradiance and the cosine, in the texels that see all of the ball. The second capture differs
 * from the first by the lamps alone. Off by the interpolated normals in halves and the texel's own extent: 1
 * % of the brightest. */
static void lamps_light_the_capture(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error;
    tl_image without, with;
    scene_open(&scene);
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_read_capture(device->renderer, &without, &error), error);
    scene.lamps[0] = test_lamp_towards((vec3s){{-0.8f, 0.5f, 0.6f}}, 3);
    scene.lamps[1] = test_lamp_at((vec3s){{1.5f, 1.5f, 0.5f}}, 6);
    scene.frame.lamp_count = 2;
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_read_capture(device->renderer, &with, &error), error);
    double worst = 0, brightest = 0;
    int counted = 0;
    for (int i = 0; i < 6 * SIZE * SIZE; i++) {
        vec3s ray = tl_cube_texel_direction(SIZE, i), normal;
        if (!meet(ray, &normal) || glms_vec3_dot(normal, ray) > -0.3f)
            continue;
        vec3s place = glms_vec3_add(centre, glms_vec3_scale(normal, RADIUS));
        counted++;
        for (int c = 0; c < 3; c++) {
            double expected = 0;
            for (int l = 0; l < 2; l++) {
                const struct tl_lamp *lamp = &scene.lamps[l];
                vec3s to = l == 0 ? lamp->direction : glms_vec3_sub(lamp->position, place);
                double cosine = (double)glms_vec3_dot(normal, glms_vec3_normalize(to));
                double fall = l == 0 ? 1 : 1 / (double)glms_vec3_norm2(to);
                expected += (double)(kd.raw[c] * lamp->irradiance.raw[c]) / M_PI * fall * fmax(cosine, 0);
            }
            double added = (double)(tl_image_floats(&with)[3 * i + c] - tl_image_floats(&without)[3 * i + c]);
            worst = fmax(worst, fabs(added - expected));
            brightest = fmax(brightest, expected);
        }
    }
    print_message("%d texels, the light of lamps off by %.2f %% of its brightest\n", counted,
                  100 * worst / brightest);
    assert_true(counted > 200);
    assert_true(worst < 0.01 * brightest);
    tl_image_release(&without);
    tl_image_release(&with);
    test_scene_close(&scene);
}

static enum tl_job_action capture_action(const tl_renderer *renderer)
{
    const tl_plan *plan = tl_renderer_last_plan(renderer);
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, "capture") == 0)
            return plan->rows[i].action;
    fail();
    return TL_JOB_DROP;
}

static void move(struct test_scene *scene)
{
    scene->shapes[0].mesh.positions[0].y += 0.001f;
    test_scene_refresh(scene);
}

/* The scene moves in every frame: every third frame is captured. At rest a pending capture is completed, and
 * then none is drawn. A still image does not wait. */
static void every_few_frames(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene);
    scene.settings.maps.size = 8;
    scene.settings.maps.capture_every = 3;
    for (int number = 0; number < 9; number++) {
        move(&scene);
        draw(device->renderer, &scene);
        bool is_due = number % 3 == 0;
        assert_int_equal(capture_action(device->renderer), is_due ? TL_JOB_RUN : TL_JOB_REUSE);
        assert_int_equal(tl_renderer_is_at_rest(device->renderer), is_due);
    }
    for (int number = 9; number < 12; number++) { /* the ninth frame is due again */
        draw(device->renderer, &scene);
        assert_int_equal(capture_action(device->renderer), number == 9 ? TL_JOB_RUN : TL_JOB_REUSE);
        assert_true(tl_renderer_is_at_rest(device->renderer));
    }
    scene.frame.still = true;
    for (int number = 0; number < 3; number++) {
        move(&scene);
        draw(device->renderer, &scene);
        assert_int_equal(capture_action(device->renderer), TL_JOB_RUN);
    }
    test_scene_close(&scene);
}

static void nothing_captured_is_told(void **state)
{
    (void)state;
    struct test_device *fresh;
    tl_error error = {0};
    tl_image cube;
    assert_int_equal(test_device_open((void **)&fresh), 0);
    assert_false(tl_renderer_read_capture(fresh->renderer, &cube, &error));
    assert_non_null(strstr(error.message, "maps.capture_every"));
    assert_int_equal(test_device_close((void **)&fresh), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_is_captured),      cmocka_unit_test(the_reference_sees_the_same),
        cmocka_unit_test(lamps_light_the_capture), cmocka_unit_test(a_mirror_shows_the_scene),
        cmocka_unit_test(every_few_frames),        cmocka_unit_test(nothing_captured_is_told),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
