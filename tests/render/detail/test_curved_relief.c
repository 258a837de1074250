/* Relief over curved surfaces, as it is drawn, against rays traced to a displaced cylinder in closed form:
 * which pixels it covers, and which of its points they show. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/reference/shading_point.h"
#include "render/scene/view.h"

#include "tests/testing.h"

#include <math.h>
#include <string.h>

enum { SIDE = 192, TEXELS = 128, AROUND = 20, SEGMENTS = 160, RINGS = 48 };
static const double radius = 0.5, half_height = 1.2, depth = 0.04;
static const vec3s lamp = {{0.8f, 0.4f, 0.5f}};
static const double period = 2 * M_PI * 0.5 / AROUND; /* of heights, metres along both axes */

enum pattern { GROOVES, THREADS, STUDS }; /* along the axis; around it; both */
static const char *const names[] = {"grooves", "threads", "studs"};

/* Heights at a place, in periods: the deepest are -depth, the highest 0, on the mesh. */
static double height_at(enum pattern pattern, double u, double v)
{
    double a = 0.5 + 0.5 * cos(2 * M_PI * u), b = 0.5 + 0.5 * cos(2 * M_PI * v);
    return depth * ((pattern == GROOVES ? a : pattern == THREADS ? b : a * b) - 1);
}

/* What is painted on it, by the place of the point. */
static double paint_at(double u, double v)
{
    return 0.5 + 0.25 * sin(2 * M_PI * u) + 0.2 * sin(2 * M_PI * v);
}

static tl_image make_map(enum pattern pattern, bool is_paint)
{
    tl_image map = tl_image_create(TEXELS, TEXELS, is_paint ? 3 : 1, TL_IMAGE_F32);
    map.linear = true;
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        int column = i % TEXELS, row = i / TEXELS;
        double u = (column + 0.5) / TEXELS, v = (row + 0.5) / TEXELS;
        if (is_paint)
            for (int c = 0; c < 3; c++)
                tl_image_floats(&map)[3 * i + c] = (float)paint_at(u, v);
        else
            tl_image_floats(&map)[i] = (float)(1 + height_at(pattern, u, v) / depth);
    }
    return map;
}

/* A cylinder about the y axis: u in metres around it, v downwards. */
static void make_cylinder(struct test_shape *shape)
{
    *shape = test_sphere((vec3s){{0, 0, 0}}, 1, SEGMENTS / 2); /* a grid of SEGMENTS by SEGMENTS / 2 */
    for (size_t i = 0; i < shape->mesh.vertex_count; i++) {
        float phi = 2 * (float)M_PI * shape->mesh.uvs[i].x,
              y = (float)half_height * (1 - 2 * shape->mesh.uvs[i].y);
        shape->mesh.normals[i] = (vec3s){{sinf(phi), 0, cosf(phi)}};
        shape->mesh.positions[i] = (vec3s){{(float)radius * sinf(phi), y, (float)radius * cosf(phi)}};
        shape->mesh.tangents[i] = (vec4s){{cosf(phi), 0, -sinf(phi), 1}};
        shape->mesh.uvs[i] = (vec2s){{(float)radius * phi, (float)half_height - y}};
    }
    tl_mesh_measure_uvs(&shape->mesh);
}

static void scene_open(struct test_scene *scene, const tl_image *heights, const tl_image *paint, vec3s eye)
{
    struct test_shape shape;
    make_cylinder(&shape);
    test_scene_open(scene, test_environment(8, 4, test_white), eye, (vec3s){{0, 0, 0}}, 24, SIDE, SIDE);
    tl_material *material = test_scene_add(scene, shape);
    material->diffuse = (vec3s){{1, 1, 1}};
    material->specular = (vec3s){{0, 0, 0}};
    material->height_m = (float)depth;
    material->height_map.image = heights;
    material->diffuse_map.image = paint;
    material->height_map.transform.scale[0] = material->height_map.transform.scale[1] = (float)(1 / period);
    material->diffuse_map.transform = material->height_map.transform;
    test_scene_refresh(scene);
    scene->settings.image.supersample = 1;
    scene->settings.light.method = TL_METHOD_UNSHADOWED;
    scene->settings.light.lobe = TL_LOBE_DUAL;
    scene->settings.detail.mode = TL_DETAIL_RELIEF;
    scene->settings.detail.steps = 128;
}

/* What a ray sees: the paint, or the light of a lamp, of the displaced cylinder; -1: nothing. */
struct seen {
    double paint, light;
};

static struct seen seen_at(enum pattern pattern, const double p[3])
{
    double phi = atan2(p[0], p[2]), u = phi * radius / period, v = (half_height - p[1]) / period, step = 1e-4;
    double r = hypot(p[0], p[2]), square = 0, cosine = 0;
    double by_phi =
        (height_at(pattern, u + step, v) - height_at(pattern, u - step, v)) / (2 * step) * radius / period;
    double by_y = -(height_at(pattern, u, v + step) - height_at(pattern, u, v - step)) / (2 * step) / period;
    const double n[3] = {sin(phi) - by_phi / r * cos(phi), -by_y, cos(phi) + by_phi / r * sin(phi)};
    vec3s l = glms_vec3_normalize(lamp);
    for (int c = 0; c < 3; c++) {
        square += n[c] * n[c];
        cosine += n[c] * (double)l.raw[c];
    }
    double horizon = sin(phi) * (double)l.x + cos(phi) * (double)l.z; /* of the smooth cylinder, as a ramp */
    return (struct seen){paint_at(u, v),
                         3 / M_PI * fmax(cosine / sqrt(square), 0) * fmin(fmax(32 * horizon, 0), 1)};
}

/* Where a ray first is below the displaced cylinder, in steps of a 100th of a period. */
static struct seen traced(enum pattern pattern, vec3s origin, vec3s along)
{
    double o[3], d[3], previous = 0;
    for (int c = 0; c < 3; c++)
        o[c] = (double)origin.raw[c], d[c] = (double)along.raw[c];
    double a = d[0] * d[0] + d[2] * d[2], b = o[0] * d[0] + o[2] * d[2];
    double root = b * b - a * (o[0] * o[0] + o[2] * o[2] - radius * radius), step = period / 100;
    for (double t = (-b - sqrt(root)) / a; root > 0 && t <= (-b + sqrt(root)) / a; t += step) {
        double p[3];
        for (int c = 0; c < 3; c++)
            p[c] = o[c] + t * d[c];
        double u = atan2(p[0], p[2]) * radius / period, v = (half_height - p[1]) / period;
        double over = hypot(p[0], p[2]) - radius - height_at(pattern, u, v);
        if (over < 0 && fabs(p[1]) < half_height) {
            double back = previous > 0 ? step * over / (previous - over) : 0; /* to the crossing */
            for (int c = 0; c < 3; c++)
                p[c] += back * d[c];
            return seen_at(pattern, p);
        }
        previous = over;
    }
    return (struct seen){-1, -1};
}

struct errors {
    int differing; /* pixels that are covered and should not be, or the reverse */
    double value;  /* root mean square over pixels that are covered and should be, over the mean */
};

static struct errors compare(struct test_device *device, const struct test_scene *scene,
                             const struct seen *seen, bool by_lamp)
{
    tl_image drawn = test_scene_draw(scene, device->renderer);
    struct errors errors = {0};
    double squares = 0, sum = 0;
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *pixel = test_pixel(&drawn, i % SIDE, i / SIDE);
        double expected = by_lamp ? seen[i].light : seen[i].paint;
        bool is_drawn = pixel[3] > 0;
        errors.differing += is_drawn != (expected >= 0);
        if (is_drawn && expected >= 0) {
            squares += pow((double)pixel[0] - expected, 2);
            sum += expected;
            count++;
        }
    }
    errors.value = sqrt(squares / count) / (sum / count);
    tl_image_release(&drawn);
    return errors;
}

/* Draws and traces a view. Errors as on planes and curved, of paint, then of light. */
static void check_view(struct test_device *device, enum pattern pattern, vec3s eye, struct errors out[2][2])
{
    tl_image heights = make_map(pattern, false), paint = make_map(pattern, true);
    struct test_scene scene;
    struct seen *seen = TL_NEW_ARRAY(struct seen, (size_t)SIDE * SIDE);
    scene_open(&scene, &heights, &paint, eye);
    struct tl_view view = tl_view_make(&scene.frame.camera, SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct tl_ray_differential ray = tl_camera_ray(&view, SIDE, SIDE, i % SIDE, i / SIDE);
        seen[i] = traced(pattern, ray.origin, ray.direction);
    }
    for (int by_lamp = 0; by_lamp < 2; by_lamp++) {
        if (by_lamp) {
            tl_environment_release(&scene.environment);
            scene.environment = test_environment(8, 4, test_black);
            scene.frame.environment_revision++;
            scene.frame.lamp_count = 1;
            scene.lamps[0] = test_lamp_towards(lamp, 3);
            scene.shapes[0].material.diffuse_map.image = NULL;
            test_scene_refresh(&scene);
        }
        for (int curved = 0; curved < 2; curved++) {
            scene.settings.detail.curved = curved;
            out[by_lamp][curved] = compare(device, &scene, seen, by_lamp);
        }
    }
    free(seen);
    test_scene_close(&scene);
    tl_image_release(&heights);
    tl_image_release(&paint);
}

/* A plane's relief covers all of the mesh. */
static void outlines_show_the_relief(void **state)
{
    static const vec3s eyes[] = {{{0, 0, 4}}, {{1, 2, 3}}};
    static const struct {
        enum pattern pattern;
        int eye;
    } views[] = {{GROOVES, 0}, {THREADS, 1}, {STUDS, 0}, {STUDS, 1}};
    for (size_t i = 0; i < TL_COUNT(views); i++) {
        struct errors errors[2][2];
        check_view(*state, views[i].pattern, eyes[views[i].eye], errors);
        print_message("%-7s %s: outline off by %d pixels as on planes, %d curved; paint by %.3f and %.3f, "
                      "light by %.3f and "
                      "%.3f\n",
                      names[views[i].pattern], views[i].eye ? "from above" : "from ahead",
                      errors[0][0].differing, errors[0][1].differing, errors[0][0].value, errors[0][1].value,
                      errors[1][0].value, errors[1][1].value);
        assert_int_equal(errors[0][1].differing, errors[1][1].differing);
        assert_true(errors[0][0].differing > SIDE && errors[0][1].differing < 0.06 * errors[0][0].differing);
        assert_true(errors[0][1].value < 0.4 * errors[0][0].value);
        assert_true(errors[1][1].value < 0.6 * errors[1][0].value);
    }
}

/* On a plane nothing bends: the same points as without curvature, whatever ends their march. */
static void planes_are_as_before(void **state)
{
    struct test_device *device = *state;
    tl_image heights = make_map(STUDS, false), paint = make_map(STUDS, true);
    struct test_scene scene;
    scene_open(&scene, &heights, &paint, (vec3s){{0.4f, 0.2f, 1}});
    struct tl_material material = scene.shapes[0].material;
    test_shape_release(&scene.shapes[0]);
    scene.shapes[0] = test_square((vec3s){{0, 0, 0}}, (vec3s){{0, 0, -1}}, (vec3s){{1, 0, 0}}, 0.8f, 8);
    scene.shapes[0].material = material;
    test_scene_refresh(&scene);
    for (int back = 0; back < 2; back++) {
        scene.frame.camera.eye.x = back ? -1 : 1;
        scene.settings.detail.curved = false;
        tl_image flat = test_scene_draw(&scene, device->renderer);
        scene.settings.detail.curved = true;
        struct test_difference off = test_scene_error(&scene, device->renderer, &flat);
        print_message("plane, %s: off by %.4f over %zu pixels\n", back ? "back" : "front", off.rel_rmse,
                      off.pixels);
        assert_true(off.pixels > SIDE * SIDE / 18 &&
                    off.rel_rmse < 0.02); /* maps are read where steps end, and sharper */
        tl_image_release(&flat);
    }
    test_scene_close(&scene);
    tl_image_release(&heights);
    tl_image_release(&paint);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(outlines_show_the_relief),
                                       cmocka_unit_test(planes_are_as_before)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
