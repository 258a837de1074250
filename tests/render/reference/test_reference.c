/* The reference against closed forms. Every result must be within 0.1 % of its formula, and three standard
 * errors must be less than that, so that noise cannot hide an error. Effects that the formulas neglect are
 * smaller: rays start 1e-5 of the half diagonal of the scene off their surface, and discs have 256 sides. */
#include "tests/render/scenes.h"

#include "config/base/interrupt.h"
#include "config/base/memory.h"
#include "render/env/exponent.h"
#include "render/reference/reference.h"
#include "render/reference/scene.h"

#include "tests/testing.h"

#include <omp.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <sys/wait.h>

#define EXACTNESS 1e-3
#define SIZE      16 /* pixels a side */
#define TILES     16 /* of 4 x 4 pixels */

static struct test_scene *scene_new(tl_environment environment, vec3s eye, vec3s target, float fov_deg)
{
    struct test_scene *scene = TL_NEW(struct test_scene);
    test_scene_open(scene, environment, eye, target, fov_deg, SIZE, SIZE);
    if (eye.x == target.x && eye.z == target.z)
        scene->frame.camera.up = (vec3s){{0, 0, -1}};
    scene->settings.image.supersample = 1;
    scene->settings.light.reflect_scene = false;
    scene->settings.reference.strata = 4096;
    return scene;
}

static tl_material *scene_add(struct test_scene *scene, struct test_shape shape)
{
    tl_material *material = test_scene_add(scene, shape);
    material->diffuse = (vec3s){{0.5f, 0.5f, 0.5f}};
    material->specular = (vec3s){{0, 0, 0}};
    return material;
}

static void scene_free(struct test_scene *scene)
{
    test_scene_close(scene);
    free(scene);
}

static tl_image draw(struct test_scene *scene, struct tl_reference_report *report)
{
    tl_error error = {0};
    tl_image image;
    struct tl_ground ground;
    test_scene_refresh(scene);
    bool has_ground = scene->settings.image.ground;
    if (has_ground) {
        struct tl_casters casters;
        assert_ok(tl_casters_measure(scene->surfaces, scene->shape_count, &casters, &error), error);
        tl_ground_make(&casters, TL_GROUND_GREY, &ground);
    }
    const struct tl_reference_request request =
        tl_frame_reference_request(&scene->frame, &scene->settings, has_ground ? &ground : NULL);
    assert_ok(tl_reference_draw(&request, &image, report, &error), error);
    return image;
}

struct estimate {
    double mean, error; /* of the green channel over the image, and its standard error */
};

/* Tiles err independently of each other. Within one, pixels share their directions, so at worst they err
 * alike: this is an upper bound. */
static struct estimate estimate_of(struct test_scene *scene)
{
    struct tl_reference_report report;
    tl_image image = draw(scene, &report);
    assert_int_equal(report.replicates, scene->settings.reference.replicates);
    double sum = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *pixel = test_pixel(&image, i % SIZE, i / SIZE);
        assert_near(pixel[3], 1, 0);
        sum += (double)pixel[1];
    }
    tl_image_release(&image);
    double mean = sum / (SIZE * SIZE);
    return (struct estimate){mean, report.standard_error * mean / sqrt(TILES)};
}

static void check(struct test_scene *scene, double expected)
{
    struct estimate estimate = estimate_of(scene);
    printf("expected %.6f, drawn %.6f, off by %+.4f %%, standard error %.4f %%\n", expected, estimate.mean,
           100 * (estimate.mean / expected - 1), 100 * estimate.error / expected);
    assert_true(3 * estimate.error <= EXACTNESS * expected);
    assert_near(estimate.mean, expected, EXACTNESS * expected);
}

/* The point of the plane through `at` under the centre of a pixel, seen by the camera of the scene. */
static vec3s pixel_point(const struct test_scene *scene, int x, int y, vec3s at, vec3s normal)
{
    const struct tl_camera *camera = &scene->frame.camera;
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    vec3s right = glms_vec3_normalize(glms_vec3_cross(forward, camera->up));
    vec3s up = glms_vec3_cross(right, forward);
    float half = tanf(camera->fov_y / 2);
    vec3s d = glms_vec3_add(forward, glms_vec3_scale(right, half * (2 * ((float)x + 0.5f) / SIZE - 1)));
    d = glms_vec3_add(d, glms_vec3_scale(up, half * (1 - 2 * ((float)y + 0.5f) / SIZE)));
    float t = glms_vec3_dot(glms_vec3_sub(at, camera->eye), normal) / glms_vec3_dot(d, normal);
    return glms_vec3_add(camera->eye, glms_vec3_scale(d, t));
}

static const vec3s origin = {{0, 0, 0}}, x_axis = {{1, 0, 0}}, y_axis = {{0, 1, 0}}, z_axis = {{0, 0, 1}};

/* Uniform light of 1 without occluders, seen from the front: every lobe returns its colour. */
static void test_furnace(void **state)
{
    (void)state;
    const float glossinesses[] = {0, 0.3f, 0.7f, 0.95f, 0.995f, 1};
    for (int lobe = TL_LOBE_SINGLE; lobe <= TL_LOBE_DUAL; lobe++)
        for (size_t i = 0; i < TL_COUNT(glossinesses); i++) {
            struct test_scene *scene =
                scene_new(tl_environment_constant(1, 1, 1), (vec3s){{0, 0, 2}}, origin, 0.5f);
            tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
            material->specular = (vec3s){{0.25f, 0.25f, 0.25f}};
            material->glossiness = glossinesses[i];
            scene->settings.light.lobe = lobe;
            scene->settings.reference.lobe_samples = 512;
            double g = (double)glossinesses[i], single = 0.5 * (1 - g) + 0.25 * g;
            check(scene, lobe == TL_LOBE_DUAL ? 0.5 + 0.25 : single);
            scene_free(scene);
        }
}

/* Threads that are matt send back the mean sine of their angle to the light, by n.l: 8 / 3 pi. */
static void test_threads_in_even_light(void **state)
{
    (void)state;
    struct test_scene *scene = scene_new(tl_environment_constant(1, 1, 1), (vec3s){{0, 0, 2}}, origin, 0.5f);
    tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
    material->gloss.model = TL_REFLECT_BANKS;
    check(scene, 0.5 * 8 / (3 * M_PI));
    scene_free(scene);
}

/* A coat reflects a twenty-fifth of light that falls straight on it, and the facets below keep the rest. */
static void test_coat_over_facets(void **state)
{
    (void)state;
    double base = 0;
    for (int coat = 0; coat < 2; coat++) {
        struct test_scene *scene =
            scene_new(tl_environment_constant(1, 1, 1), (vec3s){{0, 0, 2}}, origin, 0.5f);
        tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
        material->specular = (vec3s){{0.5f, 0.5f, 0.5f}};
        material->gloss = (struct tl_gloss){.model = TL_REFLECT_WARD, .width_weft = 0.3f, .width_warp = 0.2f};
        material->coat = (float)coat;
        material->coat_glossiness = 0.9f;
        scene->settings.reference.lobe_samples = 512;
        if (coat)
            check(scene, 0.04 + 0.96 * base);
        else
            base = estimate_of(scene).mean;
        scene_free(scene);
    }
}

/* A thin sheet sends a lamp behind it to all sides: t E cos / pi. */
static void test_lamp_behind_a_sheet(void **state)
{
    (void)state;
    struct test_scene *scene =
        scene_new(test_environment(16, 8, test_black), (vec3s){{0, 0, 2}}, origin, 0.5f);
    tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
    material->transmission = (vec3s){{0.3f, 0.3f, 0.3f}};
    scene->lamps[0] = test_lamp_towards((vec3s){{0, 0.6f, -0.8f}}, 5);
    scene->frame.lamp_count = 1;
    check(scene, 0.3 * (double)scene->lamps[0].irradiance.y * 0.8 / M_PI);
    scene_free(scene);
}

/* The same seen obliquely with s = 1: the part of the lobe below the surface is lost. A cosine lobe whose
 * axis is at an angle a to the normal keeps (1 + cos a) / 2. */
static void test_lobe_below_the_horizon(void **state)
{
    (void)state;
    for (int degrees = 20; degrees <= 80; degrees += 20) {
        float a = glm_rad((float)degrees), cosine = cosf(a);
        struct test_scene *scene =
            scene_new(tl_environment_constant(1, 1, 1), (vec3s){{2 * sinf(a), 0, 2 * cosine}}, origin, 0.2f);
        tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
        material->diffuse = (vec3s){{0, 0, 0}};
        material->specular = (vec3s){{1, 1, 1}}; /* F = 1 at every angle */
        material->glossiness = 0;
        check(scene, (1 + (double)cosine) / 2);
        scene_free(scene);
    }
}

/* The geometric horizon: normals that lean by an angle a lose (1 - cos a) / 2 of their light to it. */
static void test_geometric_terminator(void **state)
{
    (void)state;
    const float a = glm_rad(40);
    struct test_scene *scene = scene_new(tl_environment_constant(1, 1, 1), (vec3s){{0, 0, 2}}, origin, 0.5f);
    scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
    for (size_t i = 0; i < scene->shapes[0].mesh.vertex_count; i++)
        scene->shapes[0].mesh.normals[i] = (vec3s){{sinf(a), 0, cosf(a)}};
    scene->settings.reference.terminator = TL_TERMINATOR_GEOMETRIC;
    check(scene, 0.5 * (1 + (double)cosf(a)) / 2);
    scene_free(scene);
}

static struct test_shape disc(vec3s centre, float radius)
{
    struct test_shape shape = test_square(centre, x_axis, y_axis, 1, 64);
    for (size_t i = 0; i < shape.mesh.vertex_count; i++) {
        vec3s d = glms_vec3_sub(shape.mesh.positions[i], centre);
        vec3s round = {{d.x * sqrtf(1 - d.z * d.z / 2), 0, d.z * sqrtf(1 - d.x * d.x / 2)}};
        shape.mesh.positions[i] = glms_vec3_add(centre, glms_vec3_scale(round, radius));
    }
    return shape;
}

/* Share of a uniform sky's cosine-weighted light that a parallel disc takes from a point `a` off its axis
 * [Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-13]. */
static double disc_factor(double radius, double height, double a)
{
    double z = a * a + height * height + radius * radius;
    return (1 - (z - 2 * radius * radius) / sqrt(z * z - 4 * a * a * radius * radius)) / 2;
}

/* On a plane of triangles, and on the ground, whose grey is 0.4. */
static void check_under_disc(float radius, float height, float a, bool ground, int strata)
{
    struct test_scene *scene =
        scene_new(tl_environment_constant(1, 1, 1), (vec3s){{a, 0.5f * height, 0}}, (vec3s){{a, 0, 0}}, 1);
    scene_add(scene, disc((vec3s){{0, height, 0}}, radius));
    if (!ground)
        scene_add(scene, test_square(origin, x_axis, y_axis, 4, 1));
    scene->settings.image.ground = ground;
    scene->settings.reference.strata = strata;
    double expected = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        vec3s point = pixel_point(scene, i % SIZE, i / SIZE, origin, y_axis);
        double off = hypot((double)point.x, (double)point.z);
        expected += (1 - disc_factor((double)radius, (double)height, off)) / (SIZE * SIZE);
    }
    check(scene, (ground ? 0.4 : 0.5) * expected);
    scene_free(scene);
}

static void test_under_a_disc(void **state)
{
    (void)state;
    check_under_disc(0.5f, 0.5f, 0, false, 1 << 13);
    check_under_disc(1, 0.7f, 1.5f, false, 1 << 13);
    check_under_disc(0.7f, 0.5f, 0, true,
                     1 << 15); /* the darkest: it has the noise of the few directions left */
    check_under_disc(0.5f, 0.5f, 0.5f, true, 1 << 13);
}

/* Share that a wall takes which stands upright on the receiver's plane at distance `a`, `height` high,
 * `width` wide to one side [Howell, B-5]. */
static double wall_factor(double a, double height, double width)
{
    double slant = hypot(a, height);
    return (atan2(width, a) - a / slant * atan2(width, slant)) / (2 * M_PI);
}

static void test_before_a_wall(void **state)
{
    (void)state;
    const float heights[] = {0.25f, 1, 1.9f};
    for (size_t i = 0; i < TL_COUNT(heights); i++) {
        const float half = 2, distance = 0.5f, height = heights[i];
        struct test_scene *scene = scene_new(tl_environment_constant(1, 1, 1), (vec3s){{distance, 0.5f, 0}},
                                             (vec3s){{distance, 0, 0}}, 0.5f);
        scene_add(scene, test_square(origin, x_axis, y_axis, half, 1));
        scene_add(scene, test_square((vec3s){{0, height - half, 0}}, z_axis, x_axis, half, 1));
        scene->settings.reference.strata = 1 << 14;
        double expected = 0;
        for (int p = 0; p < SIZE * SIZE; p++) {
            vec3s point = pixel_point(scene, p % SIZE, p / SIZE, origin, y_axis);
            double a = (double)point.x, left = (double)(half - point.z), right = (double)(half + point.z);
            double taken = wall_factor(a, (double)height, left) + wall_factor(a, (double)height, right);
            expected += 0.5 * (1 - taken) / (SIZE * SIZE);
        }
        check(scene, expected);
        scene_free(scene);
    }
}

static vec3s darkness(vec3s direction)
{
    (void)direction;
    return (vec3s){{0, 0, 0}};
}

#define ONE_WIDTH  128
#define ONE_HEIGHT 64
#define ONE_COLUMN 70
#define ONE_ROW    28
#define ONE_LIGHT  1000.0

/* Integral of K_s about `axis` over the texel, whose radiance is constant; by midpoints, in the world. */
static double texel_integral(vec3s axis, float exponent, float yaw)
{
    const int steps = 64;
    double upper = cos(M_PI * ONE_ROW / ONE_HEIGHT), lower = cos(M_PI * (ONE_ROW + 1) / ONE_HEIGHT);
    double sum = 0;
    for (int i = 0; i < steps * steps; i++) {
        double phi = 2 * M_PI * ((ONE_COLUMN + (i % steps + 0.5) / steps) / ONE_WIDTH - 0.5) - (double)yaw;
        int row = i / steps;
        double y = lower + (upper - lower) * (row + 0.5) / steps, r = sqrt(1 - y * y);
        double cosine = r * sin(phi) * (double)axis.x + y * (double)axis.y - r * cos(phi) * (double)axis.z;
        sum += cosine > 0 ? pow(cosine, (double)exponent) : 0;
    }
    double solid_angle = 2 * M_PI / ONE_WIDTH * (upper - lower);
    return ((double)exponent + 1) / (2 * M_PI) * sum / (steps * steps) * solid_angle;
}

static double one_texel_expected(const struct test_scene *scene, float glossiness, float yaw)
{
    double expected = 0, f0 = 0.25;
    for (int p = 0; p < SIZE * SIZE; p++) {
        vec3s point = pixel_point(scene, p % SIZE, p / SIZE, origin, z_axis);
        vec3s v = glms_vec3_normalize(glms_vec3_sub(scene->frame.camera.eye, point));
        vec3s r = {{-v.x, -v.y, v.z}};
        double fresnel = f0 + (1 - f0) * pow(1 - (double)v.z, 5);
        expected += 0.5 * texel_integral(z_axis, 1, yaw) +
                    fresnel * texel_integral(r, tl_lobe_exponent(glossiness), yaw);
    }
    return ONE_LIGHT * expected / (SIZE * SIZE);
}

/* The lobes themselves, their axes, Fresnel's term and the environment's yaw. The texel lies 16 degrees to
 * the right of -Z before the yaw and half a turn further after it; the mirror direction is 11 degrees off it.
 */
static void test_one_texel(void **state)
{
    (void)state;
    const float glossinesses[] = {0, 0.5f, 0.9f, 0.99f}, yaw = 3.3f;
    for (size_t i = 0; i < TL_COUNT(glossinesses); i++) {
        tl_environment environment = test_environment(ONE_WIDTH, ONE_HEIGHT, darkness);
        for (int c = 0; c < 3; c++)
            tl_image_floats(&environment.image)[3 * (ONE_ROW * ONE_WIDTH + ONE_COLUMN) + c] =
                (float)ONE_LIGHT;
        struct test_scene *scene = scene_new(environment, (vec3s){{0.4f, -0.5f, 2}}, origin, 0.2f);
        tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
        material->specular = (vec3s){{0.25f, 0.25f, 0.25f}};
        material->glossiness = glossinesses[i];
        scene->frame.environment_yaw = yaw;
        check(scene, one_texel_expected(scene, glossinesses[i], yaw));
        scene_free(scene);
    }
}

static const vec3s sun_direction = {{0.31f, 0.42f, 0.853f}};

static vec3s sun_and_sky(vec3s direction)
{
    float sun = glms_vec3_dot(direction, glms_vec3_normalize(sun_direction)) > 0.9998f ? 50000 : 0;
    return (vec3s){{sun + 1, sun + 1 + direction.y, sun + 1}};
}

static struct estimate sun_in_mirror(float glossiness, int strata, int lobe_samples)
{
    vec3s sun = glms_vec3_normalize(sun_direction);
    vec3s eye = {{-2 * sun.x, -2 * sun.y + 0.03f, 2 * sun.z}}; /* the mirror shows the sky near the sun */
    struct test_scene *scene = scene_new(test_environment(256, 128, sun_and_sky), eye, origin, 3);
    tl_material *material = scene_add(scene, test_square(origin, x_axis, z_axis, 0.5f, 1));
    material->diffuse = (vec3s){{0, 0, 0}};
    material->specular = (vec3s){{1, 1, 1}};
    material->glossiness = glossiness;
    scene->settings.reference.strata = strata;
    scene->settings.reference.lobe_samples = lobe_samples;
    struct estimate estimate = estimate_of(scene);
    scene_free(scene);
    return estimate;
}

/* A sun of few texels in surfaces up to a mirror: directions from the environment alone, from the lobe alone,
 * both at once: they agree within three standard errors. */
static void test_samplers_agree(void **state)
{
    (void)state;
    const float glossinesses[] = {0.9f, 0.999f, 1};
    for (size_t i = 0; i < TL_COUNT(glossinesses); i++) {
        struct estimate strata = sun_in_mirror(glossinesses[i], 4096, 0);
        struct estimate lobe = sun_in_mirror(glossinesses[i], 0, 4096);
        struct estimate both = sun_in_mirror(glossinesses[i], 2048, 512);
        printf("strata %.5g +- %.2g, lobe %.5g +- %.2g, both %.5g +- %.2g\n", strata.mean, strata.error,
               lobe.mean, lobe.error, both.mean, both.error);
        assert_near(strata.mean, lobe.mean, 3 * hypot(strata.error, lobe.error));
        assert_near(both.mean, lobe.mean, 3 * hypot(both.error, lobe.error));
        assert_near(both.mean, strata.mean, 3 * hypot(both.error, strata.error));
        assert_true(3 * both.error < 0.01 * both.mean);
    }
}

/* A mirror on the floor shows the underside of a ceiling, which sees all of the sky but the mirror; black
 * without reflections. */
static void test_reflected_scene(void **state)
{
    (void)state;
    const float radius = 0.25f, height = 0.5f;
    for (int reflect = 0; reflect < 2; reflect++) {
        struct test_scene *scene =
            scene_new(tl_environment_constant(1, 1, 1), (vec3s){{0, 0.25f, 0}}, origin, 0.5f);
        tl_material *mirror = scene_add(scene, disc(origin, radius));
        scene_add(scene, disc((vec3s){{0, height, 0}}, 1));
        mirror->diffuse = (vec3s){{0, 0, 0}};
        mirror->specular = (vec3s){{0.5f, 0.5f, 0.5f}};
        mirror->glossiness = 1;
        scene->settings.light.reflect_scene = reflect;
        scene->settings.reference.lobe_samples = 2000;
        if (reflect)
            check(scene, 0.5 * 0.5 * (1 - disc_factor((double)radius, (double)height, 0)));
        else
            assert_near(estimate_of(scene).mean, 0, 0);
        scene_free(scene);
    }
}

/* Spheres before a sheet in a sun, on the ground: something of everything. */
static struct test_scene *mixed_scene(void)
{
    struct test_scene *scene =
        scene_new(test_environment(64, 32, sun_and_sky), (vec3s){{0.6f, 1.2f, 3}}, (vec3s){{0, 0.6f, 0}}, 45);
    tl_material *mirror = scene_add(scene, test_sphere((vec3s){{0.3f, 0.4f, 0.3f}}, 0.4f, 24));
    mirror->specular = (vec3s){{0.5f, 0.6f, 0.7f}};
    mirror->glossiness = 0.999f;
    scene_add(scene, test_sheet(1, 0.5f, 0.1f, 2, 24))->glossiness = 0.5f;
    scene->settings.image.ground = true;
    scene->settings.image.supersample = 2;
    scene->settings.image.width = 37; /* tiles stick out */
    scene->settings.image.height = 30;
    scene->settings.light.reflect_scene = true;
    scene->settings.reference.strata = 16;
    return scene;
}

static void test_threads_change_no_bit(void **state)
{
    (void)state;
    struct tl_reference_report reports[2];
    tl_image images[2];
    struct test_scene *scene = mixed_scene();
    int threads = omp_get_max_threads();
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i == 0 ? 1 : 3);
        images[i] = draw(scene, &reports[i]);
    }
    omp_set_num_threads(threads);
    assert_memory_equal(images[0].texels, images[1].texels, (size_t)37 * 30 * 4 * sizeof(float));
    assert_int_equal(reports[0].replicates, reports[1].replicates);
    assert_int_equal(reports[0].rays, reports[1].rays);
    assert_true(reports[0].standard_error == reports[1].standard_error);
    tl_image_release(&images[0]);
    tl_image_release(&images[1]);
    scene_free(scene);
}

/* The reported standard error is the actual error: images of 8 replicates differ from a converged image by
 * their standard error, within a fifth, which is the accuracy of 576 tiles. No mirror, because one highlight
 * would dominate. */
static void test_standard_error(void **state)
{
    (void)state;
    struct test_scene *scene = mixed_scene();
    scene->shapes[0].material.glossiness = 0.5f;
    scene->settings.image.width = scene->settings.image.height = 96;
    scene->settings.image.supersample = 1;
    scene->settings.reference.replicates = 8;
    struct tl_reference_report report, converged_report;
    tl_image image = draw(scene, &report);
    scene->settings.reference.strata = 512;
    tl_image converged = draw(scene, &converged_report);
    double squares = 0, sum = 0;
    size_t values = 0;
    for (size_t i = 0; i < (size_t)4 * 96 * 96; i++) {
        if (i % 4 == 3 || !(tl_image_floats(&converged)[i / 4 * 4 + 3] > 0))
            continue;
        double truth = (double)tl_image_floats(&converged)[i];
        squares += pow((double)tl_image_floats(&image)[i] - truth, 2);
        sum += truth;
        values++;
    }
    double made = sqrt(squares / (double)values) / (sum / (double)values);
    printf("says %.3f %%, makes %.3f %%; converged to %.3f %%\n", 100 * report.standard_error, 100 * made,
           100 * converged_report.standard_error);
    assert_near(made / report.standard_error, 1, 0.2);
    tl_image_release(&image);
    tl_image_release(&converged);
    scene_free(scene);
}

/* Light near the end of float and none at all: every value is finite. */
static vec3s blinding(vec3s direction)
{
    float value = direction.y > 0.9f ? 3e38f : direction.x > 0 ? 1e-38f : 0;
    return (vec3s){{value, value, value}};
}

static void test_extreme_light(void **state)
{
    (void)state;
    vec3s (*const lights[])(vec3s) = {blinding, darkness};
    for (size_t i = 0; i < TL_COUNT(lights); i++) {
        struct tl_reference_report report;
        struct test_scene *scene = mixed_scene();
        tl_environment_release(&scene->environment);
        scene->environment = test_environment(64, 32, lights[i]);
        tl_image image = draw(scene, &report);
        for (size_t v = 0; v < (size_t)4 * 37 * 30; v++)
            assert_true(isfinite(tl_image_floats(&image)[v]));
        assert_true(isfinite(report.standard_error));
        tl_image_release(&image);
        scene_free(scene);
    }
}

/* A child process is interrupted, because an interrupt is for good. It hands over what it drew. */
struct handed_over {
    bool drawn;
    enum tl_code code;
    struct tl_reference_report report;
    float image[37 * 30 * 4];
};

static void on_alarm(int number)
{
    (void)number;
    raise(SIGINT);
}

static void draw_interrupted(struct handed_over *result, bool at_once)
{
    struct test_scene *scene = mixed_scene();
    tl_error error = {0};
    tl_image image;
    test_scene_refresh(scene);
    scene->settings.reference.replicates = 1 << 16;
    tl_interrupt_install();
    if (at_once) {
        raise(SIGINT);
    } else {
        signal(SIGALRM, on_alarm);
        setitimer(ITIMER_REAL, &(struct itimerval){.it_value.tv_usec = 500000}, NULL);
    }
    const struct tl_reference_request request =
        tl_frame_reference_request(&scene->frame, &scene->settings, NULL);
    result->drawn = tl_reference_draw(&request, &image, &result->report, &error);
    result->code = error.code;
    if (result->drawn)
        memcpy(result->image, image.texels, sizeof result->image);
}

static struct handed_over *interrupt_child(bool at_once)
{
    struct handed_over *result =
        mmap(NULL, sizeof *result, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(result != MAP_FAILED);
    pid_t child = fork();
    if (child == 0) {
        draw_interrupted(result, at_once);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return result;
}

/* First of all tests: a child of a process that has run OpenMP could not run it again. */
static void test_interrupt_keeps_what_is_done(void **state)
{
    (void)state;
    struct handed_over *nothing = interrupt_child(true), *some = interrupt_child(false);
    assert_false(nothing->drawn);
    assert_int_equal(nothing->code, TL_INTERRUPTED);
    assert_true(some->drawn);
    assert_in_range(some->report.replicates, 1, (1 << 16) - 1);

    struct test_scene *scene = mixed_scene();
    struct tl_reference_report report;
    scene->settings.image.ground = false;
    scene->settings.reference.replicates = some->report.replicates;
    tl_image image = draw(scene, &report);
    assert_memory_equal(image.texels, some->image, sizeof some->image);
    assert_true(report.standard_error == some->report.standard_error);
    tl_image_release(&image);
    scene_free(scene);
    munmap(nothing, sizeof *nothing);
    munmap(some, sizeof *some);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_interrupt_keeps_what_is_done),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_threads_in_even_light),
        cmocka_unit_test(test_coat_over_facets),
        cmocka_unit_test(test_lamp_behind_a_sheet),
        cmocka_unit_test(test_lobe_below_the_horizon),
        cmocka_unit_test(test_geometric_terminator),
        cmocka_unit_test(test_under_a_disc),
        cmocka_unit_test(test_before_a_wall),
        cmocka_unit_test(test_one_texel),
        cmocka_unit_test(test_samplers_agree),
        cmocka_unit_test(test_reflected_scene),
        cmocka_unit_test(test_threads_change_no_bit),
        cmocka_unit_test(test_standard_error),
        cmocka_unit_test(test_extreme_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
