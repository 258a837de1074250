/* Maps of offsets and Blinn's form with vectors of vertices [Wimmer n.d., Offset Bump Maps, Basic Algorithm
 * (Eye Space)], as drawn under a lamp, against closed forms evaluated at the rays of pixels in double. */
#include "tests/render/scenes.h"

#include "tests/testing.h"

#define SIZE 48

struct drawn_scene {
    struct test_scene scene;
    tl_image bumps, encoded;
};

/* Unit normals of 2 x 2 texels as offsets are made of them, or encoded as in a picture; slopes are along u
 * and minus v. */
static tl_image normals_of(const float slopes[4][2], bool encoded)
{
    tl_image image = tl_image_create(2, 2, 3, TL_IMAGE_F32);
    image.linear = true;
    for (int i = 0; i < 4; i++) {
        vec3s n = glms_vec3_normalize((vec3s){{-slopes[i][0], -slopes[i][1], 1}});
        for (int c = 0; c < 3; c++)
            tl_image_floats(&image)[3 * i + c] = encoded ? 0.5f + 0.5f * n.raw[c] : n.raw[c];
    }
    return image;
}

/* A square with one matt colour under the lamp, seen aslant. */
static void open_scene(struct drawn_scene *drawn, const float slopes[4][2], int cells)
{
    struct test_shape square =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.5f, cells);
    drawn->bumps = normals_of(slopes, false);
    drawn->encoded = normals_of(slopes, true);
    square.mesh.parts[0].uv_metres = 1;
    square.material.diffuse = (vec3s){{0.8f, 0.8f, 0.8f}};
    square.material.specular = (vec3s){{0, 0, 0}};
    test_scene_open_lamplit(&drawn->scene, square, SIZE, SIZE);
    drawn->scene.settings.detail.minify = TL_DETAIL_MINIFY_NONE;
    drawn->scene.frame.camera.eye = (vec3s){{0.5f, 0.4f, 2.4f}};
}

static void close_scene(struct drawn_scene *drawn)
{
    test_scene_close(&drawn->scene);
    tl_image_release(&drawn->bumps);
    tl_image_release(&drawn->encoded);
}

struct ray {
    double from[3], to[3];
};

static struct ray pixel_ray(const struct tl_camera *camera, int x, int y)
{
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    vec3s right = glms_vec3_normalize(glms_vec3_cross(forward, camera->up)),
          up = glms_vec3_cross(right, forward);
    double half = tan(0.5 * (double)camera->fov_y);
    double across = half * (2 * (x + 0.5) / SIZE - 1), down = half * (1 - 2 * (y + 0.5) / SIZE);
    struct ray ray;
    for (int c = 0; c < 3; c++) {
        ray.from[c] = (double)camera->eye.raw[c];
        ray.to[c] = (double)forward.raw[c] + across * (double)right.raw[c] + down * (double)up.raw[c];
    }
    return ray;
}

/* A surface in closed form: its bumped normal where a ray meets it; false within a pixel or two of its rim.
 */
typedef bool bumped_surface(const float slopes[4][2], const struct ray *ray, double n[3]);

/* Largest difference of the drawn picture to kd / pi E n.l, over the peak. */
static double picture_error(struct test_device *device, struct drawn_scene *drawn, const float slopes[4][2],
                            int mode, bumped_surface *surface)
{
    const struct tl_lamp *lamp = &drawn->scene.lamps[0];
    vec3s l = glms_vec3_normalize(lamp->direction);
    double worst = 0, peak = 0;
    int count = 0;
    drawn->scene.settings.detail.mode = mode;
    drawn->scene.shapes[0].material.normal_map.image =
        mode == TL_DETAIL_OFFSET || mode == TL_DETAIL_EYE_SPACE ? &drawn->bumps : &drawn->encoded;
    test_scene_refresh(&drawn->scene);
    tl_image image = test_scene_draw(&drawn->scene, device->renderer);
    for (int i = 0; i < SIZE * SIZE; i++) {
        struct ray ray = pixel_ray(&drawn->scene.frame.camera, i % SIZE, i / SIZE);
        double n[3];
        if (!surface(slopes, &ray, n))
            continue;
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), cosine = 0, facing = 0;
        for (int c = 0; c < 3; c++) {
            cosine += n[c] / length * (double)l.raw[c];
            facing -= n[c] / length * ray.to[c];
        }
        if (facing < 0.1) /* the drawing turns such normals to the viewer */
            continue;
        double expected = 0.8 / M_PI * (double)lamp->irradiance.x * fmax(cosine, 0);
        worst = fmax(worst, fabs(expected - (double)test_pixel(&image, i % SIZE, i / SIZE)[0]));
        peak = fmax(peak, expected);
        count++;
    }
    assert_true(count > 300 && peak > 0.1);
    tl_image_release(&image);
    return worst / peak;
}

/* The plane z = 0 with slopes interpolated linearly between the centres of texels, repeated. */
static bool on_plane(const float slopes[4][2], const struct ray *ray, double n[3])
{
    double t = -ray->from[2] / ray->to[2], x = ray->from[0] + t * ray->to[0],
           y = ray->from[1] + t * ray->to[1];
    double u = 2 * (x + 0.5) - 0.5, v = 2 * (0.5 - y) - 0.5;
    double mean[2] = {0, 0};
    for (int i = 0; i < 4; i++) {
        int column = (int)floor(u) + i % 2, row = (int)floor(v) + i / 2;
        double share = (1 - fabs(u - column)) * (1 - fabs(v - row));
        for (int c = 0; c < 2; c++)
            mean[c] += share * (double)slopes[(column & 1) + 2 * (row & 1)][c];
    }
    n[0] = -mean[0];
    n[1] = -mean[1];
    n[2] = 1;
    return fabs(x) < 0.47 && fabs(y) < 0.47;
}

/* The same from so far that a pixel shows all slopes. */
static bool on_far_plane(const float slopes[4][2], const struct ray *ray, double n[3])
{
    const bool inside = on_plane(slopes, ray, n);
    for (int c = 0; c < 2; c++)
        n[c] = -0.25 * (double)(slopes[0][c] + slopes[1][c] + slopes[2][c] + slopes[3][c]);
    return inside;
}

static const float uneven[4][2] = {{0, 0.1f}, {1.2f, -0.3f}, {0.2f, 0.4f}, {-0.5f, 0}};

/* GL reads texels with weights of 8 bits: 1 / 256 of the steepest step, 1.7, as slopes. Averages of normals,
 * which the normal map draws, lean less than those of slopes. */
static void test_averages(void **state)
{
    struct test_device *device = *state;
    struct drawn_scene drawn;
    open_scene(&drawn, uneven, 2);
    double near_error = picture_error(device, &drawn, uneven, TL_DETAIL_OFFSET, on_plane),
           near_normals = picture_error(device, &drawn, uneven, TL_DETAIL_NORMAL, on_plane);
    for (size_t v = 0; v < drawn.scene.shapes[0].mesh.vertex_count; v++)
        drawn.scene.shapes[0].mesh.uvs[v] = glms_vec2_scale(drawn.scene.shapes[0].mesh.uvs[v], 256);
    drawn.scene.shapes[0].mesh.parts[0].uv_metres = 1.0f / 256;
    test_scene_refresh(&drawn.scene);
    double far_error = picture_error(device, &drawn, uneven, TL_DETAIL_OFFSET, on_far_plane),
           far_normals = picture_error(device, &drawn, uneven, TL_DETAIL_NORMAL, on_far_plane);
    print_message("offset maps: %.3f %% of the peak off the mean slope between texels, %.3f %% where a pixel "
                  "shows all; normal maps %.1f and %.1f %%\n",
                  100 * near_error, 100 * far_error, 100 * near_normals, 100 * far_normals);
    assert_true(near_error < 2.0 / 256 && far_error < 2e-3);
    assert_true(near_normals > 0.03 && far_normals > 0.03);
    close_scene(&drawn);
}

/* The cylinder P(u, v) = (R sin a, L (1/2 - v), R cos a), a = A (u - 1/2), of constant slopes a metre of a UV
 * unit of 1 m: N' = N_n - h_u / (R A) e_u - h_v / L e_v. */
#define RADIUS 0.5
#define ANGLE  2.0
#define LENGTH 1.5

static bool on_cylinder(const float slopes[4][2], const struct ray *ray, double n[3])
{
    const double *o = ray->from, *d = ray->to;
    double a = d[0] * d[0] + d[2] * d[2], b = o[0] * d[0] + o[2] * d[2],
           c = o[0] * o[0] + o[2] * o[2] - RADIUS * RADIUS, root = b * b - a * c;
    if (root < 0)
        return false;
    double t = (-b - sqrt(root)) / a, x = o[0] + t * d[0], y = o[1] + t * d[1], z = o[2] + t * d[2];
    double angle = atan2(x, z), along = (double)slopes[0][0] / (RADIUS * ANGLE),
           up = (double)slopes[0][1] / LENGTH;
    n[0] = sin(angle) - along * cos(angle);
    n[1] = -up;
    n[2] = cos(angle) + along * sin(angle);
    return fabs(angle) < 0.4 * ANGLE && fabs(y) < 0.45 * LENGTH && t > 0;
}

static const float even[4][2] = {{0.6f, -0.5f}, {0.6f, -0.5f}, {0.6f, -0.5f}, {0.6f, -0.5f}};

static void bend(struct drawn_scene *drawn)
{
    tl_mesh *mesh = &drawn->scene.shapes[0].mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float a = (float)ANGLE * (mesh->uvs[i].x - 0.5f);
        mesh->positions[i] = (vec3s){
            {(float)RADIUS * sinf(a), (float)LENGTH * (0.5f - mesh->uvs[i].y), (float)RADIUS * cosf(a)}};
        mesh->normals[i] = (vec3s){{sinf(a), 0, cosf(a)}};
        mesh->tangents[i] = (vec4s){{cosf(a), 0, -sinf(a), mesh->tangents[i].w}};
    }
    test_scene_refresh(&drawn->scene);
}

/* Faces of angle e stand e^2 / 8 of the radius inside, and are shorter than the arc by e^2 / 24; means of two
 * of them by as much again: below e^2 of the slopes, 1 % at 20 faces of 0.1. Square patches are wrong by the
 * stretch. */
static void test_cylinder(void **state)
{
    struct test_device *device = *state;
    for (int cells = 4; cells <= 20; cells *= 5) {
        struct drawn_scene drawn;
        open_scene(&drawn, even, cells);
        bend(&drawn);
        double vertices = picture_error(device, &drawn, even, TL_DETAIL_EYE_SPACE, on_cylinder),
               samples = picture_error(device, &drawn, even, TL_DETAIL_BLINN, on_cylinder),
               patches = picture_error(device, &drawn, even, TL_DETAIL_OFFSET, on_cylinder);
        print_message("cylinder of %d faces: vectors of vertices %.2f %% of the peak off its closed form, "
                      "derivatives of samples %.2f %%, square patches %.1f %%\n",
                      cells, 100 * vertices, 100 * samples, 100 * patches);
        double face = ANGLE / cells;
        assert_true(vertices < face * face && samples < face * face);
        assert_true(patches > 0.03);
        close_scene(&drawn);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_averages), cmocka_unit_test(test_cylinder)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
