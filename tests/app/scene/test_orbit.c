/* Camera moves against their definitions: where the eye is, and that what lies under the pointer stays under
 * it. Tolerances: a few float roundings (6e-8) of metres, or of pixels in a view of 1000. */
#include "app/scene/camera.h"
#include "app/scene/orbit.h"

#include "tests/testing.h"

#include <string.h>

#define METRES 2e-6
#define PIXELS 2e-3

static const float view_width = 1280, view_height = 800;

static struct tl_camera_params some_orbit(void)
{
    return (struct tl_camera_params){
        .yaw_deg = 35, .pitch_deg = 20, .distance_m = 3, .target = {0.2f, 1.1f, -0.3f}, .fov_deg = 35};
}

/* A known distance leaves nothing to the box but the depth range. */
static struct tl_camera camera_of(const struct tl_camera_params *orbit)
{
    struct tl_box box = {.upper = {{1, 1, 1}}};
    const struct tl_framing framing = tl_framing_of_box(box, 0.9f);
    return tl_camera_frame(orbit, &framing, view_width / view_height);
}

/* Pixel position of a world point: cglm's look-at and perspective, which orbit.c does not use. */
static vec2s project(const struct tl_camera *camera, vec3s point)
{
    mat4s view = glms_lookat(camera->eye, camera->target, camera->up);
    mat4s projection = glms_perspective(camera->fov_y, view_width / view_height, 0.01f, 100.0f);
    vec4s clip = glms_mat4_mulv(glms_mat4_mul(projection, view), glms_vec4(point, 1));
    return (vec2s){
        {(0.5f + 0.5f * clip.x / clip.w) * view_width, (0.5f - 0.5f * clip.y / clip.w) * view_height}};
}

static vec3s point_under(const struct tl_camera *camera, float x, float y, vec3s on_plane)
{
    struct tl_ray ray = tl_orbit_ray(camera, x, y, view_width, view_height);
    vec3s axis = glms_vec3_sub(camera->target, camera->eye);
    float along =
        glms_vec3_dot(glms_vec3_sub(on_plane, ray.origin), axis) / glms_vec3_dot(ray.direction, axis);
    return glms_vec3_muladds(ray.direction, along, ray.origin);
}

static void the_orbit_is_found_again_in_its_camera(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit(), taken = orbit;
    struct tl_camera camera = camera_of(&orbit);
    taken.distance_m = 0;
    memset(taken.target, 0, sizeof taken.target);
    tl_orbit_take(&taken, &camera);
    assert_near(taken.distance_m, orbit.distance_m, METRES);
    for (int axis = 0; axis < 3; axis++)
        assert_near(taken.target[axis], orbit.target[axis], METRES);
}

static void rays_go_where_points_are_seen(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit();
    struct tl_camera camera = camera_of(&orbit);
    for (int i = 0; i < 9; i++) {
        int column = i % 3, row = i / 3;
        float x = view_width * 0.5f * (float)column, y = view_height * 0.5f * (float)row;
        struct tl_ray ray = tl_orbit_ray(&camera, x, y, view_width, view_height);
        assert_near(glms_vec3_norm(ray.direction), 1, 1e-6);
        vec2s pixel = project(&camera, glms_vec3_muladds(ray.direction, 2.5f, ray.origin));
        assert_near(pixel.x, x, PIXELS);
        assert_near(pixel.y, y, PIXELS);
    }
}

static void a_turn_moves_the_near_side_with_the_pointer(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit(), turned = orbit;
    struct tl_camera camera = camera_of(&orbit);
    vec3s near_side = glms_vec3_lerp(camera.target, camera.eye, 0.1f);
    tl_orbit_turn(&turned, 0.05f, 0.05f); /* right and down */
    camera = camera_of(&turned);
    vec2s pixel = project(&camera, near_side);
    assert_true(pixel.x > 0.5f * view_width + 1 && pixel.y > 0.5f * view_height + 1);
    assert_near(turned.yaw_deg, 35 - 9, 1e-4);
    assert_near(turned.pitch_deg, 20 + 9, 1e-4);
}

static void turns_stay_in_range(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit();
    for (int i = 0; i < 100; i++) {
        tl_orbit_turn(&orbit, -0.37f, 0.05f);
        assert_true(orbit.yaw_deg >= -180 && orbit.yaw_deg < 180 && orbit.pitch_deg <= 89);
    }
    tl_orbit_turn(&orbit, 0, -100);
    assert_near(orbit.pitch_deg, -89, 0);
}

static void a_pan_keeps_the_grabbed_point_under_the_pointer(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit();
    struct tl_camera camera = camera_of(&orbit);
    vec3s grabbed = point_under(&camera, 300, 200, camera.target);
    tl_orbit_pan(&orbit, 250 / view_height, -80 / view_height);
    camera = camera_of(&orbit);
    vec2s pixel = project(&camera, grabbed);
    assert_near(pixel.x, 550, PIXELS);
    assert_near(pixel.y, 120, PIXELS);
}

static void a_zoom_keeps_the_point_under_the_pointer(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit();
    struct tl_camera camera = camera_of(&orbit);
    vec3s point = point_under(&camera, 900, 150, camera.target);
    tl_orbit_zoom(&orbit, 2, (900 - 0.5f * view_width) / view_height,
                  (150 - 0.5f * view_height) / view_height);
    assert_near(orbit.distance_m, 3 * 0.875 * 0.875, METRES);
    camera = camera_of(&orbit);
    vec2s pixel = project(&camera, point);
    assert_near(pixel.x, 900, PIXELS);
    assert_near(pixel.y, 150, PIXELS);
}

static void zooms_stay_in_range(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit();
    tl_orbit_zoom(&orbit, 1000, 0.3f, 0.3f);
    assert_near(orbit.distance_m, 0.05, METRES);
    tl_orbit_zoom(&orbit, -1000, 0.3f, 0.3f);
    assert_near(orbit.distance_m, 100, 1e-4);
    for (int axis = 0; axis < 3; axis++)
        assert_true(isfinite(orbit.target[axis]));
}

static void focus_looks_at_the_point_from_half_as_far(void **state)
{
    (void)state;
    struct tl_camera_params orbit = some_orbit();
    vec3s point = {{0.1f, 1.4f, 0.2f}};
    tl_orbit_focus(&orbit, point);
    struct tl_camera camera = camera_of(&orbit);
    vec2s pixel = project(&camera, point);
    assert_near(pixel.x, 0.5f * view_width, PIXELS);
    assert_near(pixel.y, 0.5f * view_height, PIXELS);
    assert_near(glms_vec3_distance(camera.eye, point), 1.5, METRES);
    assert_near(orbit.yaw_deg, 35, 0);
}

/* The way between two cameras starts and ends at them, goes the shorter way round, and changes the distance
 * by the same ratio in each half. */
static void goes_between(void **state)
{
    (void)state;
    struct tl_camera_params from = some_orbit(), to = from;
    from.yaw_deg = 170;
    to.yaw_deg = -170;
    to.distance_m = 12;
    to.target[1] = 0.1f;
    struct tl_camera_params half = tl_orbit_between(&from, &to, 0.5f),
                            start = tl_orbit_between(&from, &to, 0), end = tl_orbit_between(&from, &to, 1);
    assert_near(tl_orbit_wrap_deg(half.yaw_deg + 180), 0, 1e-4);
    assert_near(half.distance_m, 6, 1e-5); /* sqrt(3 x 12) */
    assert_near(half.target[1], 0.6, METRES);
    assert_near(start.yaw_deg, 170, 1e-4);
    assert_near(start.distance_m, from.distance_m, METRES);
    assert_memory_equal(&end, &to, sizeof to);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_between),
        cmocka_unit_test(the_orbit_is_found_again_in_its_camera),
        cmocka_unit_test(rays_go_where_points_are_seen),
        cmocka_unit_test(a_turn_moves_the_near_side_with_the_pointer),
        cmocka_unit_test(turns_stay_in_range),
        cmocka_unit_test(a_pan_keeps_the_grabbed_point_under_the_pointer),
        cmocka_unit_test(a_zoom_keeps_the_point_under_the_pointer),
        cmocka_unit_test(zooms_stay_in_range),
        cmocka_unit_test(focus_looks_at_the_point_from_half_as_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
