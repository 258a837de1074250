/* Environment mapping against numerical integration on the CPU, in every mode, composition and layout; the
 * test_white furnace; what the plan runs and what it costs. */
#include "tests/render/envmap/maps_oracle.h"

#include "render/scene/view.h"

#include "tests/testing.h"

#include <string.h>

#define SIDE 12 /* pixels */

/* A point of the unit sphere that a pixel's middle sees, from outside or from inside. */
struct point {
    vec3s normal; /* on the viewer's side */
    vec3s viewer, mirror;
    double cosine;
};

static bool find_point(const struct tl_view *view, int x, int y, bool inside, struct point *out)
{
    float across = 2 * ((float)x + 0.5f) / SIDE - 1, up = 1 - 2 * ((float)y + 0.5f) / SIDE;
    vec3s ray = glms_vec3_add(
        view->forward, glms_vec3_add(glms_vec3_scale(view->right, across), glms_vec3_scale(view->up, up)));
    ray = glms_vec3_normalize(ray);
    float along = -glms_vec3_dot(ray, view->eye), square = glms_vec3_norm2(view->eye) - along * along;
    if (square >= 0.98f)
        return false;
    float half = sqrtf(1 - square);
    vec3s hit = glms_vec3_add(view->eye, glms_vec3_scale(ray, inside ? along + half : along - half));
    out->normal = inside ? glms_vec3_negate(hit) : hit;
    out->viewer = glms_vec3_negate(ray);
    out->cosine = (double)glms_vec3_dot(out->normal, out->viewer);
    out->mirror = mirrored_ray(out->normal, out->viewer);
    return out->cosine > 0.2; /* nearer to the rim a pixel reaches far over the sphere */
}

#define INDEX 1.5
static const vec3s kd = {{0.6f, 0.4f, 0.2f}};
static const float glossiness = 0.9f; /* s = 10 */

static vec3s over_light(const tl_environment *environment, int mode, const struct point *point)
{
    if (mode == TL_MAPS_MIRROR || mode == TL_MAPS_REFRACTION)
        return lights(point->mirror);
    return mode == TL_MAPS_DIFFUSE ? (vec3s){{0, 0, 0}} : integrate(environment, point->mirror, 10);
}

static vec3s under_light(const tl_environment *environment, int mode, const struct point *point, bool inside)
{
    bool total;
    if (mode == TL_MAPS_REFRACTION)
        return lights(refracted_ray(point->normal, point->viewer, INDEX, inside, &total));
    if (mode == TL_MAPS_TRANSMISSION)
        return glms_vec3_mul(kd, integrate(environment, glms_vec3_negate(point->viewer), 10));
    return mode == TL_MAPS_GLOSSY ? (vec3s){{0, 0, 0}}
                                  : glms_vec3_mul(kd, integrate(environment, point->normal, 1));
}

static vec3s expected_light(const tl_environment *environment, const struct tl_maps_params *maps,
                            const struct point *point, bool inside)
{
    vec3s over = over_light(environment, maps->mode, point),
          under = under_light(environment, maps->mode, point, inside);
    float over_share = (float)dielectric(INDEX, point->cosine);
    float under_share = maps->fresnel == TL_MAPS_FRESNEL_COAT ? 1 - over_share : 1;
    if (maps->fresnel == TL_MAPS_FRESNEL_OFF) {
        bool is_under = maps->mode == TL_MAPS_REFRACTION || maps->mode == TL_MAPS_TRANSMISSION;
        over_share = is_under ? 0 : 1; /* specular is 1: so is Schlick's F */
        under_share = maps->mode == TL_MAPS_MIRROR ? 0 : 1;
    }
    return glms_vec3_add(glms_vec3_scale(over, over_share), glms_vec3_scale(under, under_share));
}

/* One ball, looked at from outside or from within. */
static void scene_open(struct test_scene *scene, test_radiance *radiance)
{
    test_scene_open(scene, test_environment(128, 64, radiance), (vec3s){{1.5f, 1, 3}}, (vec3s){{0, 0, 0}}, 35,
                    SIDE, SIDE);
    tl_material *ball = test_scene_add(scene, test_sphere((vec3s){{0, 0, 0}}, 1, 96));
    ball->diffuse = kd;
    ball->specular = (vec3s){{1, 1, 1}};
    ball->glossiness = glossiness;
    ball->gloss.fresnel = TL_FRESNEL_DIELECTRIC;
    ball->gloss.index = (float)INDEX;
    scene->settings.light.method = TL_METHOD_MAPS;
    scene->settings.maps.size = 64;
    scene->settings.maps.minify = false; /* one direction a pixel */
}

/* The scene's own frame, or one whose eye is inside the ball. */
static tl_frame frame_of(const struct test_scene *scene, bool inside)
{
    return inside ? test_frame((vec3s){{0, 0.8f, 0}}, (vec3s){{0.5f, 0.3f, 0.5f}}, 90, scene->surfaces, 1,
                               &scene->environment)
                  : scene->frame;
}

/* The largest error of a picture. */
static double compare(const struct test_scene *scene, tl_renderer *renderer, bool inside, int *counted,
                      int *totals)
{
    tl_frame frame = frame_of(scene, inside);
    tl_image image = test_draw(renderer, &frame, &scene->settings);
    struct tl_view view = tl_view_make(&frame.camera, SIDE, SIDE);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct point point;
        bool total;
        if (!find_point(&view, i % SIDE, i / SIDE, inside, &point))
            continue;
        vec3s expected = expected_light(&scene->environment, &scene->settings.maps, &point, inside);
        refracted_ray(point.normal, point.viewer, INDEX, inside, &total);
        ++*counted;
        *totals += total;
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)(test_pixel(&image, i % SIDE, i / SIDE)[c] - expected.raw[c])));
    }
    tl_image_release(&image);
    return worst;
}

static const char *const modes[] = {"surface", "mirror", "refraction", "diffuse", "glossy", "transmission"};
static const char *const fresnels[] = {"off", "additive", "coat"};

/* Relative to the peak: 1 % for normals in half floats (1e-3 rad times a slope of 6 in exponents), the blend
 * of two exponents (0.6 %), and bilinear texels of 1/40 rad (their square times 36 / 8: 0.3 %). */
#define TOLERANCE (0.01 * BRIGHTEST)

static void modes_are_integrals(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, lights);
    for (int mode = 0; mode < 6; mode++)
        for (int fresnel = 0; fresnel < 3; fresnel++) {
            int counted = 0, totals = 0;
            scene.settings.maps.mode = mode;
            scene.settings.maps.fresnel = fresnel;
            double worst = compare(&scene, device->renderer, false, &counted, &totals);
            print_message("%s, Fresnel %s: %d pixels, off by %.2f %% of the brightest\n", modes[mode],
                          fresnels[fresnel], counted, 100 * worst / BRIGHTEST);
            assert_true(counted > 50);
            assert_int_equal(totals, 0);
            assert_true(worst < TOLERANCE);
        }
    test_scene_close(&scene);
}

/* From within, light refracts out of the ball where it can, and is totally reflected elsewhere. At the
 * critical angle the direction's slope has no bound: a pixel there may be off by more. */
static void backs_refract_outwards(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    int counted = 0, totals = 0, off = 0;
    scene_open(&scene, lights);
    scene.settings.maps.mode = TL_MAPS_REFRACTION;
    tl_frame frame = frame_of(&scene, true);
    tl_image image = test_draw(device->renderer, &frame, &scene.settings);
    struct tl_view view = tl_view_make(&frame.camera, SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct point point;
        bool total;
        if (!find_point(&view, i % SIDE, i / SIDE, true, &point))
            continue;
        vec3s direction = refracted_ray(point.normal, point.viewer, INDEX, true, &total);
        double sine = INDEX * sqrt(1 - point.cosine * point.cosine);
        counted++;
        totals += total;
        const float *pixel = test_pixel(&image, i % SIDE, i / SIDE);
        float distance = glms_vec3_distance((vec3s){{pixel[0], pixel[1], pixel[2]}}, lights(direction));
        off += (double)distance > sqrt(3) * TOLERANCE && fabs(sine - 1) > 0.02;
    }
    print_message("%d pixels, %d of them totally reflected, %d off\n", counted, totals, off);
    assert_true(totals > 20 && counted - totals > 20);
    assert_int_equal(off, 0);
    tl_image_release(&image);
    test_scene_close(&scene);
}

static void layouts_are_integrals(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, lights);
    for (int layout = 0; layout <= TL_LAYOUT_COUNT; layout++) {
        bool by_matrix = layout == TL_LAYOUT_COUNT;
        const int some[] = {TL_MAPS_SURFACE, TL_MAPS_MIRROR, TL_MAPS_TRANSMISSION};
        for (size_t i = 0; i < 3; i++) {
            int counted = 0, totals = 0;
            scene.settings.maps.mode = some[i];
            scene.settings.maps.layout = by_matrix ? TL_LAYOUT_PARABOLOID : layout;
            scene.settings.maps.look_up = by_matrix;
            scene.settings.maps.size = layout == TL_LAYOUT_CUBE ? 64 : 128;
            double worst = compare(&scene, device->renderer, false, &counted, &totals);
            print_message("%s, %s: off by %.2f %% of the brightest\n",
                          by_matrix ? "paraboloid by matrix" : tl_layout_names[layout], modes[some[i]],
                          100 * worst / BRIGHTEST);
            assert_true(worst < TOLERANCE);
        }
    }
    test_scene_close(&scene);
}

/* In test_white light of 1 a lobe brings 1 whatever its exponent: what is left are the weights, which are
 * those of any layout. Reflectances and colours are halves, 5e-4, and lobes are exact to 1e-3 (test_lobes.c).
 */
static void white_furnace(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, test_white);
    double worst = 0;
    scene.settings.maps.size = 32;
    struct tl_view view = tl_view_make(&scene.frame.camera, SIDE, SIDE);
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++)
        for (int mode = 0; mode < 6; mode++)
            for (int fresnel = 0; fresnel < 3; fresnel++) {
                if (layout != TL_LAYOUT_CUBE && !(mode == TL_MAPS_SURFACE && fresnel == TL_MAPS_FRESNEL_COAT))
                    continue;
                scene.settings.maps.layout = layout;
                scene.settings.maps.mode = mode;
                scene.settings.maps.fresnel = fresnel;
                tl_image image = test_scene_draw(&scene, device->renderer);
                for (int i = 0; i < SIDE * SIDE; i++) {
                    struct point point;
                    if (!find_point(&view, i % SIDE, i / SIDE, false, &point))
                        continue;
                    float over = mode == TL_MAPS_DIFFUSE ? 0 : 1, f = (float)dielectric(INDEX, point.cosine);
                    for (int c = 0; c < 3; c++) {
                        float under = mode == TL_MAPS_REFRACTION ? 1 : mode == TL_MAPS_GLOSSY ? 0 : kd.raw[c];
                        float expected = f * over + (fresnel == TL_MAPS_FRESNEL_COAT ? 1 - f : 1) * under;
                        if (fresnel == TL_MAPS_FRESNEL_OFF)
                            expected = mode == TL_MAPS_MIRROR    ? 1
                                       : mode == TL_MAPS_SURFACE ? 1 + under
                                       : mode == TL_MAPS_GLOSSY  ? 1
                                                                 : under;
                        assert_near(test_pixel(&image, i % SIDE, i / SIDE)[c], expected, 3e-3);
                        worst =
                            fmax(worst, fabs((double)(test_pixel(&image, i % SIDE, i / SIDE)[c] - expected)));
                        if (fresnel == TL_MAPS_FRESNEL_COAT) /* never more than what arrives */
                            assert_true(test_pixel(&image, i % SIDE, i / SIDE)[c] < 1 + 2e-3f);
                    }
                }
                tl_image_release(&image);
            }
    print_message("test_white furnace: off by %.1e\n", worst);
    test_scene_close(&scene);
}

/* The light of a material with a coat and transmission: the two lobes and the diffuse light of the other side
 * below the film, plus the reflection of the film. */
static vec3s layered_light(const struct test_scene *scene, const struct point *point)
{
    const tl_environment *environment = &scene->environment;
    const tl_material *material = &scene->shapes[0].material;
    float coat = material->coat * (float)dielectric(1.5, point->cosine);
    vec3s through = integrate(environment, glms_vec3_negate(point->normal), 1);
    vec3s under = glms_vec3_add(glms_vec3_mul(kd, integrate(environment, point->normal, 1)),
                                glms_vec3_mul(material->transmission, through));
    under = glms_vec3_add(under, integrate(environment, point->mirror, 10));
    return glms_vec3_add(glms_vec3_scale(under, 1 - coat),
                         glms_vec3_scale(integrate(environment, point->mirror, 20), coat));
}

static void layers_are_integrals(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, lights);
    scene.shapes[0].material.coat = 0.8f;
    scene.shapes[0].material.coat_glossiness = 0.95f; /* s = 20 */
    scene.shapes[0].material.transmission = (vec3s){{0.3f, 0.2f, 0.1f}};
    test_scene_refresh(&scene);
    tl_image image = test_scene_draw(&scene, device->renderer);
    struct tl_view view = tl_view_make(&scene.frame.camera, SIDE, SIDE);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct point point;
        if (!find_point(&view, i % SIDE, i / SIDE, false, &point))
            continue;
        vec3s expected = layered_light(&scene, &point);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)(test_pixel(&image, i % SIDE, i / SIDE)[c] - expected.raw[c])));
    }
    print_message("coat and light from behind: off by %.2f %% of the brightest\n", 100 * worst / BRIGHTEST);
    assert_true(worst < TOLERANCE);
    tl_image_release(&image);
    test_scene_close(&scene);
}

/* The unshadowed light of the other passes, which have exact lobes of their own: no more than texels differ.
 */
static void surfaces_are_lit_as_elsewhere(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, lights);
    scene.settings.maps.size = 128;
    tl_image image = test_scene_draw(&scene, device->renderer);
    scene.settings.light.method = TL_METHOD_UNSHADOWED;
    scene.settings.light.composition = TL_COMPOSE_RATIO;
    scene.settings.light.pem_size = 128;
    tl_image exact = test_scene_draw(&scene, device->renderer);
    for (size_t i = 0; i < (size_t)4 * SIDE * SIDE; i++)
        assert_near(tl_image_floats(&image)[i], tl_image_floats(&exact)[i], 0.003 * BRIGHTEST);
    tl_image_release(&image);
    tl_image_release(&exact);
    test_scene_close(&scene);
}

/* Bright and dark patches of some degrees. */
static vec3s checks(vec3s d)
{
    int column = (int)floorf(atan2f(d.x, d.z) * 12), row = (int)floorf(asinf(d.y) * 12);
    return (column + row) & 1 ? (vec3s){{1, 0.9f, 0.8f}} : (vec3s){{0.1f, 0.1f, 0.2f}};
}

/* Over covered pixels only, because maps do not smooth outlines. */
static double difference(const tl_image *a, const tl_image *truth)
{
    double squares = 0;
    int counted = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *first = tl_image_floats(a) + 4 * (size_t)i,
                    *second = tl_image_floats(truth) + 4 * (size_t)i;
        if (second[3] < 1)
            continue;
        counted++;
        for (int c = 0; c < 3; c++)
            squares += pow((double)(first[c] - second[c]), 2) / 3;
    }
    return sqrt(squares / counted);
}

/* A small ball shows checks smaller than its pixels: mip levels against 256 samples a pixel, as a share of
 * the error without levels. */
static double share_left(tl_renderer *renderer, int layout, int mode)
{
    struct test_scene scene;
    scene_open(&scene, checks);
    scene.settings.maps.layout = layout;
    scene.settings.maps.mode = mode;
    tl_image sharp = test_scene_draw(&scene, renderer);
    scene.settings.maps.minify = true;
    tl_image levels = test_scene_draw(&scene, renderer);
    scene.settings.maps.minify = false;
    scene.settings.image.supersample = 16;
    tl_image truth = test_scene_draw(&scene, renderer);
    double without = difference(&sharp, &truth), with = difference(&levels, &truth);
    print_message("%s: RMS error of a small ball, %s, %.3f, by levels %.3f\n", tl_layout_names[layout],
                  modes[mode], without, with);
    tl_image_release(&sharp);
    tl_image_release(&levels);
    tl_image_release(&truth);
    test_scene_close(&scene);
    return with / without;
}

/* A ball refracts less than it mirrors, and squeezes towards its rim along one direction only, where levels
 * follow the smaller difference: less is gained, and only the cube has texels fine enough to show it. */
static void levels_stand_for_samples(void **state)
{
    struct test_device *device = *state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++)
        assert_true(share_left(device->renderer, layout, TL_MAPS_MIRROR) < 0.6);
    assert_true(share_left(device->renderer, TL_LAYOUT_CUBE, TL_MAPS_REFRACTION) < 0.8);
}

/* The largest error of a ball of nearly the index of air, which looks along the view: into the singular rim
 * of a sphere map. Relative to the brightest. */
static double pole_error(tl_renderer *renderer, int layout, int size)
{
    const double index = 1.05;
    struct test_scene scene;
    scene_open(&scene, lights);
    scene.shapes[0].material.gloss.index = (float)index;
    test_scene_refresh(&scene);
    scene.settings.maps.mode = TL_MAPS_REFRACTION;
    scene.settings.maps.layout = layout;
    scene.settings.maps.size = size;
    tl_image image = test_scene_draw(&scene, renderer);
    struct tl_view view = tl_view_make(&scene.frame.camera, SIDE, SIDE);
    double squares = 0, worst = 0;
    int counted = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct point point;
        bool total;
        if (!find_point(&view, i % SIDE, i / SIDE, false, &point))
            continue;
        vec3s expected = lights(refracted_ray(point.normal, point.viewer, index, false, &total));
        for (int c = 0; c < 3; c++) {
            double off = (double)(test_pixel(&image, i % SIDE, i / SIDE)[c] - expected.raw[c]);
            worst = fmax(worst, fabs(off));
            squares += off * off / 3;
        }
        counted++;
    }
    print_message("%s, %d texels, index %.2f: off by %.2f %% of the brightest RMS, %.2f %% at most\n",
                  tl_layout_names[layout], size, index, 100 * sqrt(squares / counted) / BRIGHTEST,
                  100 * worst / BRIGHTEST);
    tl_image_release(&image);
    test_scene_close(&scene);
    return worst / BRIGHTEST;
}

/* Bilinear texels of 1/40 rad, and the environment's own as much: 1 % of a lobe of exponent 6. A point half a
 * texel within the rim of a sphere map lies 0.25 rad from its pole, and texels there are mixed from all
 * around it: 5 %, as docs/environments.md says. */
static void refraction_looks_at_the_pole(void **state)
{
    struct test_device *device = *state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        double worst = pole_error(device->renderer, layout, 128);
        assert_true(worst < (layout == TL_LAYOUT_SPHERE ? 0.06 : 0.01));
    }
}

/* The light is smooth and the pixels are small, so that mip levels change it by the blur of a texel or two: a
 * lobe of exponent 6 over 0.03 rad, 0.5 %. A full-screen triangle may be clipped to two, and a pixel at their
 * common edge has neighbours that are computed for derivatives only. These read zeros from buffers, so that
 * the derivative of a value that depends on one shows the edge as a dotted line. */
static void levels_of_refraction_are_smooth(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, lights);
    scene.frame.camera.fov_y = 0.2f; /* the ball fills the image */
    scene.settings.image.width = scene.settings.image.height = 96;
    scene.settings.maps.mode = TL_MAPS_REFRACTION;
    tl_image sharp = test_scene_draw(&scene, device->renderer);
    scene.settings.maps.minify = true;
    struct test_difference difference = test_scene_error(&scene, device->renderer, &sharp);
    print_message("refraction, levels against none: %zu pixels, off by %.2f %% of the brightest\n",
                  difference.pixels, 100 * difference.largest);
    assert_true(difference.pixels > 8000);
    assert_true(difference.largest < 0.01);
    tl_image_release(&sharp);
    test_scene_close(&scene);
}

static enum tl_job_action action_of(const tl_plan *plan, const char *name)
{
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, name) == 0)
            return plan->rows[i].action;
    print_error("no job %s\n", name);
    fail();
    return TL_JOB_DROP;
}

static void draw(tl_renderer *renderer, struct test_scene *scene)
{
    tl_image image = test_scene_draw(scene, renderer);
    tl_image_release(&image);
}

/* A sphere map follows the view when it turns, and only then; the others are made once. */
static void sphere_maps_follow_the_view(void **state)
{
    struct test_device *device = *state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct test_scene scene;
        scene_open(&scene, lights);
        struct tl_camera *camera = &scene.frame.camera;
        *camera = (struct tl_camera){.eye = {{0, 0, 4}}, .up = {{0, 1, 0}}, .fov_y = 0.6f, 0.1f, 10};
        scene.settings.maps.layout = layout;
        scene.settings.maps.size = 16;
        scene.settings.maps.mode = TL_MAPS_MIRROR;
        draw(device->renderer, &scene);
        camera->eye.x = camera->target.x = 0.25f; /* exact: the view's direction stays the same to the bit */
        draw(device->renderer, &scene);
        const tl_plan *plan = tl_renderer_last_plan(device->renderer);
        assert_int_equal(action_of(plan, "envmap"), TL_JOB_REUSE);
        assert_int_equal(action_of(plan, "look_up"), TL_JOB_RUN);
        camera->target = (vec3s){{0, 0.2f, 0}};
        draw(device->renderer, &scene);
        bool follows = layout == TL_LAYOUT_SPHERE;
        assert_int_equal(action_of(plan, "envmap"), follows ? TL_JOB_RUN : TL_JOB_REUSE);
        assert_int_equal(action_of(plan, "envmap_lobes"), TL_JOB_REUSE);
        test_scene_close(&scene);
    }
}

/* A scene without environment maps allocates nothing for them. */
static void unused_maps_cost_nothing(void **state)
{
    (void)state;
    struct test_device *fresh;
    assert_int_equal(test_device_open((void **)&fresh), 0);
    struct test_scene scene;
    scene_open(&scene, lights);
    scene.settings.light.method = TL_METHOD_UNSHADOWED;
    const char *const jobs[] = {"envmap_lobes", "capture", "envmap", "look_up"};
    draw(fresh->renderer, &scene);
    const tl_plan *plan = tl_renderer_last_plan(fresh->renderer);
    struct tl_render_memory without = tl_renderer_memory(fresh->renderer);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(action_of(plan, jobs[i]), TL_JOB_DROP);
    scene.settings.light.method = TL_METHOD_MAPS;
    draw(fresh->renderer, &scene);
    struct tl_render_memory with = tl_renderer_memory(fresh->renderer);
    assert_int_equal(action_of(plan, "look_up"), TL_JOB_RUN);
    assert_int_equal(action_of(plan, "capture"), TL_JOB_DROP);
    assert_int_equal(action_of(plan, "regions"), TL_JOB_DROP);
    /* at least 6 faces of 64 x 64 for the diffuse lobe, two glossy ones and the environment */
    assert_true(with.pems - without.pems >= (size_t)4 * 6 * 64 * 64 * 16);
    test_scene_close(&scene);
    assert_int_equal(test_device_close((void **)&fresh), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modes_are_integrals),
        cmocka_unit_test(backs_refract_outwards),
        cmocka_unit_test(layouts_are_integrals),
        cmocka_unit_test(white_furnace),
        cmocka_unit_test(layers_are_integrals),
        cmocka_unit_test(surfaces_are_lit_as_elsewhere),
        cmocka_unit_test(levels_stand_for_samples),
        cmocka_unit_test(sphere_maps_follow_the_view),
        cmocka_unit_test(levels_of_refraction_are_smooth),
        cmocka_unit_test(refraction_looks_at_the_pole),
        cmocka_unit_test(unused_maps_cost_nothing),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
