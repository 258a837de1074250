/* Directions of look-ups computed at vertices, as they are drawn: two triangles whose corners have normals of
 * their own, against directions that are computed at the corners and weighted by the barycentric coordinates
 * of the point that each pixel sees, in double; and how the error of a ball falls with its triangles. */
#include "tests/render/envmap/maps_oracle.h"

#include "render/scene/view.h"

#include "tests/testing.h"

#define SIDE  16
#define INDEX 1.5
static const vec3s kd = {{0.6f, 0.4f, 0.2f}};

/* One square of two triangles, whose normals lean outwards, seen from close by and from the side. */
static void scene_open(struct test_scene *scene, bool from_behind)
{
    vec3s eye = {{0.3f, 0.2f, from_behind ? -0.9f : 0.9f}};
    test_scene_open(scene, test_environment(128, 64, lights), eye, (vec3s){{0, 0.05f, 0}}, 60, SIDE, SIDE);
    struct test_shape square =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.7f, 1);
    for (size_t i = 0; i < square.mesh.vertex_count; i++) {
        vec3s place = square.mesh.positions[i];
        square.mesh.normals[i] =
            glms_vec3_normalize((vec3s){{0.6f * place.x, 0.5f * place.y + 0.1f * place.x, 1}});
    }
    tl_material *material = test_scene_add(scene, square);
    material->diffuse = kd;
    material->specular = (vec3s){{1, 1, 1}};
    material->glossiness = 0.9f;
    material->gloss.fresnel = TL_FRESNEL_DIELECTRIC;
    material->gloss.index = (float)INDEX;
    test_scene_refresh(scene);
    scene->settings.image.supersample = 1;
    scene->settings.light.method = TL_METHOD_MAPS;
    scene->settings.maps.size = 64;
    scene->settings.maps.minify = false; /* one direction a pixel */
    scene->settings.maps.vectors = TL_MAPS_VECTORS_VERTEX;
}

/* What a pixel's middle sees of the mesh, and where in its triangle. */
static bool find_point(const tl_mesh *mesh, const struct tl_view *view, int pixel, vec3s place[3],
                       vec3s normal[3], double weights[3])
{
    vec3s along, hit;
    float across = 2 * ((float)(pixel % SIDE) + 0.5f) / SIDE - 1,
          up = 1 - 2 * ((float)(pixel / SIDE) + 0.5f) / SIDE;
    float tangent = tanf(GLM_PI_4f * 2 / 3); /* half of 60 degrees */
    along = glms_vec3_add(view->forward,
                          glms_vec3_add(glms_vec3_scale(glms_vec3_normalize(view->right), across * tangent),
                                        glms_vec3_scale(glms_vec3_normalize(view->up), up * tangent)));
    hit = glms_vec3_add(view->eye, glms_vec3_scale(along, -view->eye.z / along.z)); /* the plane z = 0 */
    for (size_t t = 0; t < mesh->index_count / 3; t++) {
        for (size_t i = 0; i < 3; i++) {
            place[i] = mesh->positions[mesh->indices[3 * t + i]];
            normal[i] = mesh->normals[mesh->indices[3 * t + i]];
        }
        double area = 0, minimum = 1;
        for (int i = 0; i < 3; i++) {
            vec3s a = place[(i + 1) % 3], b = place[(i + 2) % 3];
            weights[i] = (double)((b.x - a.x) * (hit.y - a.y) - (b.y - a.y) * (hit.x - a.x));
            area += weights[i];
        }
        for (int i = 0; i < 3; i++) {
            weights[i] /= area;
            minimum = fmin(minimum, weights[i]);
        }
        if (minimum > 1e-3)
            return true;
    }
    return false;
}

/* The interpolated values of a pixel. */
struct interpolated {
    vec3s over, under, normal; /* as they come: shorter than 1 */
    double cosine;
};

static struct interpolated interpolate(const vec3s place[3], const vec3s normal[3], const double weights[3],
                                       vec3s eye, int mode, bool from_behind)
{
    struct interpolated sum = {0};
    for (int i = 0; i < 3; i++) {
        bool total;
        float weight = (float)weights[i];
        vec3s v = glms_vec3_normalize(glms_vec3_sub(eye, place[i]));
        vec3s n = from_behind ? glms_vec3_negate(normal[i]) : normal[i];
        vec3s under = mode == TL_MAPS_REFRACTION     ? refracted_ray(n, v, INDEX, from_behind, &total)
                      : mode == TL_MAPS_TRANSMISSION ? glms_vec3_negate(v)
                                                     : n;
        sum.over = glms_vec3_add(sum.over, glms_vec3_scale(mirrored_ray(n, v), weight));
        sum.under = glms_vec3_add(sum.under, glms_vec3_scale(under, weight));
        sum.normal = glms_vec3_add(sum.normal, glms_vec3_scale(n, weight));
        sum.cosine += weights[i] * (double)glms_vec3_dot(n, v);
    }
    return sum;
}

static vec3s expected_light(const struct test_scene *scene, const struct interpolated *at, int mode,
                            int fresnel)
{
    const tl_environment *environment = &scene->environment;
    const tl_material *material = &scene->shapes[0].material;
    vec3s r = glms_vec3_normalize(at->over), below = glms_vec3_normalize(at->under);
    bool sharp = mode == TL_MAPS_MIRROR || mode == TL_MAPS_REFRACTION;
    vec3s over = sharp ? lights(r) : integrate(environment, r, 10);
    vec3s under =
        mode == TL_MAPS_REFRACTION
            ? lights(below)
            : glms_vec3_mul(kd, integrate(environment, below, mode == TL_MAPS_TRANSMISSION ? 10 : 1));
    float f = (float)dielectric(INDEX, at->cosine);
    if (fresnel != TL_MAPS_FRESNEL_OFF)
        return glms_vec3_add(glms_vec3_scale(over, f),
                             glms_vec3_scale(under, fresnel == TL_MAPS_FRESNEL_COAT ? 1 - f : 1));
    if (mode == TL_MAPS_MIRROR)
        return over;
    if (mode != TL_MAPS_SURFACE)
        return under;
    vec3s through = glms_vec3_mul(material->transmission, integrate(environment, glms_vec3_negate(below), 1));
    float coat = material->coat * (float)dielectric(1.5, at->cosine);
    under = glms_vec3_scale(glms_vec3_add(glms_vec3_add(over, under), through), 1 - coat);
    return coat > 0 ? glms_vec3_add(under, glms_vec3_scale(integrate(environment, r, 20), coat)) : under;
}

static double compare(const struct test_scene *scene, tl_renderer *renderer, bool from_behind, int *counted)
{
    int mode = scene->settings.maps.mode, fresnel = scene->settings.maps.fresnel;
    tl_image image = test_scene_draw(scene, renderer);
    struct tl_view view = tl_view_make(&scene->frame.camera, SIDE, SIDE);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec3s place[3], normal[3];
        double weights[3];
        if (!find_point(&scene->shapes[0].mesh, &view, i, place, normal, weights))
            continue;
        struct interpolated at = interpolate(place, normal, weights, view.eye, mode, from_behind);
        vec3s expected = expected_light(scene, &at, mode, fresnel);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)(test_pixel(&image, i % SIDE, i / SIDE)[c] - expected.raw[c])));
        ++*counted;
    }
    tl_image_release(&image);
    return worst / BRIGHTEST;
}

static const char *const modes[] = {"surface", "mirror", "refraction", "diffuse", "glossy", "transmission"};

/* Texels of 1/80 rad and the environment's own of 1/40, times a lobe of exponent 6: 0.3 %; the blend of two
 * exponents: 0.6 %. At the corners the directions are the exact ones of test_envmap.c; between them those are
 * off by up to a tenth of the brightest, as the last line of the next test says. */
#define TOLERANCE 0.01

static void corners_are_interpolated(void **state)
{
    struct test_device *device = *state;
    for (int behind = 0; behind < 2; behind++) {
        struct test_scene scene;
        scene_open(&scene, behind);
        const int some[] = {TL_MAPS_MIRROR, TL_MAPS_REFRACTION, TL_MAPS_DIFFUSE, TL_MAPS_TRANSMISSION};
        for (size_t i = 0; i < 4; i++)
            for (int fresnel = 0; fresnel < 3; fresnel++) {
                int counted = 0;
                if (some[i] == TL_MAPS_DIFFUSE && fresnel != TL_MAPS_FRESNEL_OFF)
                    continue;
                scene.settings.maps.mode = some[i];
                scene.settings.maps.fresnel = fresnel;
                double worst = compare(&scene, device->renderer, behind, &counted);
                print_message("%s, %s, Fresnel %d: %d pixels, off by %.2f %% of the brightest\n",
                              behind ? "from behind" : "in front", modes[some[i]], fresnel, counted,
                              100 * worst);
                assert_true(counted > 150);
                assert_true(worst < TOLERANCE);
            }
        test_scene_close(&scene);
    }
}

/* The coat and the light from behind follow the corners, too. Specular is 1, and so is F. */
static void layers_are_interpolated(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    int counted = 0;
    scene_open(&scene, false);
    scene.shapes[0].material.coat = 0.8f;
    scene.shapes[0].material.coat_glossiness = 0.95f;
    scene.shapes[0].material.transmission = (vec3s){{0.3f, 0.2f, 0.1f}};
    test_scene_refresh(&scene);
    double worst = compare(&scene, device->renderer, false, &counted);
    print_message("coat and light from behind: off by %.2f %% of the brightest\n", 100 * worst);
    assert_true(worst < TOLERANCE);
    test_scene_close(&scene);
}

/* RMS over the pixels of the ball that are well within it, of vectors at vertices against vectors at pixels.
 */
static double ball_error(tl_renderer *renderer, int layout, int look_up, int segments)
{
    struct test_scene scene;
    test_scene_open(&scene, test_environment(128, 64, lights), (vec3s){{1.5f, 1, 3}}, (vec3s){{0, 0, 0}}, 35,
                    48, 48);
    test_scene_add(&scene, test_sphere((vec3s){{0, 0, 0}}, 1, segments));
    scene.settings.image.supersample = 1;
    scene.settings.light.method = TL_METHOD_MAPS;
    scene.settings.maps.layout = layout;
    scene.settings.maps.look_up = look_up;
    scene.settings.maps.size = 64;
    scene.settings.maps.minify = false;
    scene.settings.maps.mode = TL_MAPS_MIRROR;
    tl_image exact = test_scene_draw(&scene, renderer);
    scene.settings.maps.vectors = TL_MAPS_VECTORS_VERTEX;
    tl_image drawn = test_scene_draw(&scene, renderer);
    struct test_difference difference = test_compare(&drawn, &exact);
    assert_true(difference.pixels > 800);
    tl_image_release(&exact);
    tl_image_release(&drawn);
    test_scene_close(&scene);
    return difference.rel_rmse;
}

/* The direction of a mean of unit vectors is off by the square of their spread, so that twice as many
 * triangles across leave a quarter. A cube looks up directions of any length; spheres and paraboloids take
 * vectors for unit vectors, and a mean is shorter than these. */
static void finer_meshes_are_nearer(void **state)
{
    struct test_device *device = *state;
    const struct {
        const char *name;
        int layout, look_up;
    } ways[] = {{"cube", TL_LAYOUT_CUBE, TL_LOOK_UP_DIRECT},
                {"paraboloid by matrix", TL_LAYOUT_PARABOLOID, TL_LOOK_UP_MATRIX},
                {"sphere", TL_LAYOUT_SPHERE, TL_LOOK_UP_DIRECT}};
    double errors[3][3];
    for (int w = 0; w < 3; w++) {
        for (int i = 0; i < 3; i++)
            errors[w][i] = ball_error(device->renderer, ways[w].layout, ways[w].look_up, 8 << i);
        print_message("%s: relative RMSE with 8, 16, 32 segments: %.2f %%, %.2f %%, %.2f %%\n", ways[w].name,
                      100 * errors[w][0], 100 * errors[w][1], 100 * errors[w][2]);
        assert_true(errors[w][0] > 0.01);
        for (int i = 1; i < 3; i++)
            assert_true(errors[w][i] < errors[w][i - 1] / 3);
    }
    assert_true(errors[1][1] > 1.5 * errors[0][1]);
}

/* The ground is lit as SURFACE whatever the mode is, and its directions have to be those of SURFACE, too.
 * They are exact for diffuse light on a plane; a ball of many triangles is nearly exact. The target of the
 * vectors is given back. */
static void the_ground_has_its_own(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open(&scene, test_environment(64, 32, lights), (vec3s){{1.5f, 1, 3}}, (vec3s){{0, 0, 0}}, 60,
                    32, 32);
    test_scene_add(&scene, test_sphere((vec3s){{0, 0, 0}}, 0.6f, 64));
    scene.settings.image.supersample = 1;
    scene.settings.image.ground = true;
    scene.settings.light.method = TL_METHOD_MAPS;
    scene.settings.maps.size = 32;
    scene.settings.maps.minify = false;
    scene.settings.maps.mode = TL_MAPS_TRANSMISSION;
    tl_image exact = test_scene_draw(&scene, device->renderer);
    size_t bytes = tl_renderer_memory(device->renderer).pems;
    scene.settings.maps.vectors = TL_MAPS_VECTORS_VERTEX;
    tl_image drawn = test_scene_draw(&scene, device->renderer);
    assert_int_equal(tl_renderer_memory(device->renderer).pems - bytes, 2 * 16 * 32 * 32);
    double worst = 0;
    int counted = 0;
    for (int i = 0; i < 32 * 32; i++) {
        const float *first = test_pixel(&exact, i % 32, i / 32), *second = test_pixel(&drawn, i % 32, i / 32);
        counted += first[3] > 0 && first[3] < 0.99f; /* the ground's cover fades outwards */
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)(first[c] - second[c])));
    }
    print_message(
        "ball on the ground: %d pixels of ground, vertices against pixels off by %.2f %% of the brightest\n",
        counted, 100 * worst / BRIGHTEST);
    assert_true(counted > 100);
    assert_true(worst < 0.01 * BRIGHTEST);
    tl_image_release(&drawn);
    scene.settings.maps.vectors = TL_MAPS_VECTORS_PIXEL;
    tl_image again = test_scene_draw(&scene, device->renderer);
    assert_int_equal(tl_renderer_memory(device->renderer).pems, bytes);
    tl_image_release(&again);
    tl_image_release(&exact);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_are_interpolated),
        cmocka_unit_test(layers_are_interpolated),
        cmocka_unit_test(finer_meshes_are_nearer),
        cmocka_unit_test(the_ground_has_its_own),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
