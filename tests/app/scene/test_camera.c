/* The framing camera: everything in view, from every side, at any aspect. */
#include "tests/testing.h"

#include "app/scene/camera.h"

static void project(const struct tl_camera *camera, float aspect, vec3s point, float *x, float *y)
{
    mat4s view = glms_lookat(camera->eye, camera->target, camera->up);
    mat4s clip = glms_mat4_mul(glms_perspective(camera->fov_y, aspect, camera->near_m, camera->far_m), view);
    vec4s p = glms_mat4_mulv(clip, (vec4s){{point.x, point.y, point.z, 1}});
    assert_true(p.w > 0);
    *x = p.x / p.w;
    *y = p.y / p.w;
}

static struct tl_camera framed(const struct tl_camera_params *params, struct tl_box box, float aspect)
{
    const struct tl_framing framing = tl_framing_of_box(box, 0.9f);
    return tl_camera_frame(params, &framing, aspect);
}

static void every_corner_is_in_view(void **state)
{
    (void)state;
    const struct tl_box box = {{{-0.4f, 0, -0.2f}}, {{0.5f, 1.8f, 0.3f}}};
    const float aspects[] = {0.5f, 1, 16.0f / 9};
    for (size_t a = 0; a < 3; a++)
        for (int yaw = -180; yaw < 180; yaw += 30) {
            const struct tl_camera_params params = {.yaw_deg = (float)yaw, .pitch_deg = 0, .fov_deg = 30};
            struct tl_camera camera = framed(&params, box, aspects[a]);
            float largest = 0;
            for (int corner = 0; corner < 8; corner++) {
                float x, y;
                vec3s point = {{corner & 1 ? box.upper.x : box.lower.x,
                                corner & 2 ? box.upper.y : box.lower.y,
                                corner & 4 ? box.upper.z : box.lower.z}};
                project(&camera, aspects[a], point, &x, &y);
                largest = fmaxf(largest, fmaxf(fabsf(x), fabsf(y)));
            }
            assert_true(largest <= 1);
            assert_true(largest > 0.6f); /* and it fills the frame */
        }
}

static void yaw_zero_looks_from_plus_z_and_grows_towards_plus_x(void **state)
{
    (void)state;
    struct tl_camera_params params = {.distance_m = 2, .target = {0, 1, 0}, .fov_deg = 30};
    struct tl_camera camera = framed(&params, (struct tl_box){{{0, 0, 0}}, {{1, 1, 1}}}, 1);
    assert_near(camera.eye.x, 0, 1e-6);
    assert_near(camera.eye.y, 1, 1e-6);
    assert_near(camera.eye.z, 2, 1e-6);
    params.yaw_deg = 90;
    camera = framed(&params, (struct tl_box){{{0, 0, 0}}, {{1, 1, 1}}}, 1);
    assert_near(camera.eye.x, 2, 1e-6);
    params.pitch_deg = 30;
    camera = framed(&params, (struct tl_box){{{0, 0, 0}}, {{1, 1, 1}}}, 1);
    assert_near(camera.eye.y, 2, 1e-6); /* 1 + 2 sin 30 */
}

/* The same target and direction as when the scene is framed, the distance that was asked for. */
static void distance_alone_goes_nearer(void **state)
{
    (void)state;
    const struct tl_box box = {{{-0.4f, 0.5f, -0.2f}}, {{0.5f, 1.8f, 0.3f}}};
    struct tl_camera_params params = {.yaw_deg = 25, .pitch_deg = 8, .fov_deg = 30};
    const struct tl_camera whole = framed(&params, box, 1);
    const vec3s whole_back = glms_vec3_normalize(glms_vec3_sub(whole.eye, whole.target));
    assert_false(tl_camera_is_placed(&params));
    params.distance_m = 0.75f;
    assert_false(tl_camera_is_placed(&params));
    const struct tl_camera camera = framed(&params, box, 1);
    const vec3s back = glms_vec3_normalize(glms_vec3_sub(camera.eye, camera.target));
    assert_near(glms_vec3_distance(camera.target, whole.target), 0, 0);
    assert_near(camera.target.y, 1.15, 1e-6);
    assert_near(glms_vec3_distance(camera.eye, camera.target), 0.75, 1e-6);
    assert_near(glms_vec3_distance(back, whole_back), 0, 1e-6);
    params.target[1] = 0.25f;
    assert_true(tl_camera_is_placed(&params));
    assert_near(framed(&params, box, 1).target.y, 0.25, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_corner_is_in_view),
        cmocka_unit_test(yaw_zero_looks_from_plus_z_and_grows_towards_plus_x),
        cmocka_unit_test(distance_alone_goes_nearer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
