/* The gizmo's geometry against closed forms: points of an axis, of a plane or of the ring are projected by
 * cglm's look-at and perspective, which gizmo.c does not use, and a drag from one to the other is the
 * difference that they were made with. Tolerances: float roundings of pixels in a view of 1000, 1e-4 of one,
 * which are 2e-7 m each at these distances; those of a drag along a slanted axis are a few times that. */
#include "app/scene/camera.h"
#include "app/view/gizmo/gizmo.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#define METRES  2e-5
#define DEGREES 0.02

enum { WIDTH = 900, HEIGHT = 800 };
static const float distance_m = 3, fov_deg = 30;

static struct tl_gizmo gizmo_at(float yaw_deg, float pitch_deg, vec3s pivot)
{
    const struct tl_camera_params orbit = {.yaw_deg = yaw_deg,
                                           .pitch_deg = pitch_deg,
                                           .distance_m = distance_m,
                                           .target = {0.1f, 1.1f, -0.2f},
                                           .fov_deg = fov_deg};
    const struct tl_framing framing = tl_framing_of_box((struct tl_box){.upper = {{1, 2, 1}}}, 0.9f);
    return (struct tl_gizmo){.camera = tl_camera_frame(&orbit, &framing, (float)WIDTH / HEIGHT),
                             .width = WIDTH,
                             .height = HEIGHT,
                             .scale = 1,
                             .stretch = 1,
                             .pivot = pivot};
}

static const vec3s target = {{0.1f, 1.1f, -0.2f}}, aside = {{0.3f, 1.25f, -0.1f}};
static const vec3s axes[3] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};

static vec2s project(const struct tl_gizmo *gizmo, vec3s point)
{
    mat4s view = glms_lookat(gizmo->camera.eye, gizmo->camera.target, gizmo->camera.up);
    mat4s projection = glms_perspective(glm_rad(fov_deg), (float)WIDTH / HEIGHT, 0.01f, 100.0f);
    vec4s clip = glms_mat4_mulv(glms_mat4_mul(projection, view), glms_vec4(point, 1));
    return (vec2s){{(0.5f + 0.5f * clip.x / clip.w) * WIDTH, (0.5f - 0.5f * clip.y / clip.w) * HEIGHT}};
}

static vec3s along(vec3s point, vec3s direction, float by)
{
    return glms_vec3_muladds(direction, by, point);
}

/* From the front, where X and Y lie in the plane of the image: metres a pixel times pixels, whatever the
 * pointer does across the axis. */
static void arrows_from_the_front_move_by_metres_a_pixel(void **state)
{
    (void)state;
    const struct tl_gizmo gizmo = gizmo_at(0, 0, target);
    const double metres = 2 * (double)distance_m * tan(M_PI * (double)fov_deg / 360) / HEIGHT;
    const vec2s from = {{450 + 90, 400 + 3}}, to = {{450 + 90 + 120, 400 + 140}};
    struct tl_gizmo_change change = tl_gizmo_drag(&gizmo, TL_GIZMO_X, from, to);
    assert_near(change.move_m.x, 120 * metres, METRES);
    assert_true(change.move_m.y == 0 && change.move_m.z == 0 && change.turn_deg == 0 && change.factor == 1);
    change = tl_gizmo_drag(&gizmo, TL_GIZMO_Y, from, to);
    assert_near(change.move_m.y, -137 * metres, METRES);
    assert_true(change.move_m.x == 0 && change.move_m.z == 0);
    change = tl_gizmo_drag(&gizmo, TL_GIZMO_VIEW, from, to);
    assert_near(change.move_m.x, 120 * metres, METRES);
    assert_near(change.move_m.y, -137 * metres, METRES);
    assert_near(change.move_m.z, 0, METRES);
    change = tl_gizmo_drag(&gizmo, TL_GIZMO_Z, from, to); /* it points at the eye */
    assert_true(change.move_m.z == 0);
}

static void arrows_follow_points_of_their_axes(void **state)
{
    (void)state;
    static const float views[][2] = {{35, 20}, {-120, 55}, {160, -30}};
    for (size_t v = 0; v < TL_COUNT(views); v++) {
        const struct tl_gizmo gizmo = gizmo_at(views[v][0], views[v][1], aside);
        for (int k = 0; k < 3; k++) {
            vec2s from = project(&gizmo, along(aside, axes[k], 0.15f));
            vec2s to = project(&gizmo, along(aside, axes[k], 0.15f - 0.4f));
            struct tl_gizmo_change change =
                tl_gizmo_drag(&gizmo, (enum tl_gizmo_handle)(TL_GIZMO_X + k), from, to);
            for (int i = 0; i < 3; i++)
                assert_near(change.move_m.raw[i], i == k ? -0.4 : 0, METRES);
        }
    }
}

/* An axis ends at its vanishing point: no pointer is farther than that. */
static void no_drag_goes_past_the_vanishing_point(void **state)
{
    (void)state;
    for (int side = -1; side <= 1; side += 2) { /* -Z and +Z lead away from the eye */
        const struct tl_gizmo gizmo = gizmo_at(side < 0 ? 20 : 200, 10, target);
        vec2s from = project(&gizmo, along(target, axes[2], -0.1f * (float)side));
        vec2s back = glms_vec2_normalize(glms_vec2_sub(project(&gizmo, target), from));
        float before = 0;
        for (int pixels = 100; pixels <= 100000; pixels *= 10) {
            vec2s to = glms_vec2_muladds(back, (float)pixels, from);
            float away = (float)side * tl_gizmo_drag(&gizmo, TL_GIZMO_Z, from, to).move_m.z;
            assert_true(away >= before && away < 1000);
            before = away;
        }
    }
}

static void the_square_follows_points_of_the_image_plane(void **state)
{
    (void)state;
    const struct tl_gizmo gizmo = gizmo_at(35, 20, aside);
    vec3s ahead = glms_vec3_normalize(glms_vec3_sub(gizmo.camera.target, gizmo.camera.eye));
    vec3s right = glms_vec3_normalize(glms_vec3_cross(ahead, axes[1])), above = glms_vec3_cross(right, ahead);
    vec3s moved = glms_vec3_add(glms_vec3_scale(right, 0.2f), glms_vec3_scale(above, -0.35f));
    struct tl_gizmo_change change = tl_gizmo_drag(&gizmo, TL_GIZMO_VIEW, project(&gizmo, aside),
                                                  project(&gizmo, glms_vec3_add(aside, moved)));
    for (int i = 0; i < 3; i++)
        assert_near(change.move_m.raw[i], moved.raw[i], METRES);
}

static vec3s on_ring(float angle_deg)
{
    float angle = glm_rad(angle_deg);
    return along(aside, (vec3s){{sinf(angle), 0, cosf(angle)}}, 0.3f);
}

static void the_ring_follows_points_of_its_plane(void **state)
{
    (void)state;
    static const float turns[][2] = {{10, 55}, {10, -40}, {170, -170}, {-170, 170}, {0, 179}};
    static const float expected[] = {45, -50, 20, -20, 179};
    for (int below = 0; below < 2; below++) {
        const struct tl_gizmo gizmo = gizmo_at(-50, below ? -60 : 60, aside);
        for (size_t i = 0; i < TL_COUNT(turns); i++) {
            struct tl_gizmo_change change =
                tl_gizmo_drag(&gizmo, TL_GIZMO_TURN, project(&gizmo, on_ring(turns[i][0])),
                              project(&gizmo, on_ring(turns[i][1])));
            assert_near(change.turn_deg, expected[i], DEGREES);
            assert_true(glms_vec3_norm(change.move_m) == 0 && change.factor == 1);
        }
    }
}

/* Seen flat: a radian for the ring's 80 pixels, in the direction in which the ring's near, or far, side goes.
 */
static void a_flat_ring_turns_along_its_tangent(void **state)
{
    (void)state;
    const double radian = 180 / M_PI;
    for (int pitch = -10; pitch <= 10; pitch += 20) {
        const struct tl_gizmo gizmo = gizmo_at(0, (float)pitch, target);
        struct tl_gizmo_drawing drawing;
        assert_true(tl_gizmo_draw(&gizmo, &drawing));
        vec2s near_side = drawing.ring[0], far_side = drawing.ring[TL_GIZMO_RING_POINTS / 2];
        assert_true(!drawing.is_far[0] && drawing.is_far[TL_GIZMO_RING_POINTS / 2]);
        near_side.x += 1; /* within its segment */
        far_side.x -= 1;
        struct tl_gizmo_change change =
            tl_gizmo_drag(&gizmo, TL_GIZMO_TURN, near_side, (vec2s){{near_side.x + 40, near_side.y}});
        assert_near(change.turn_deg, 0.5 * radian, 0.1);
        change = tl_gizmo_drag(&gizmo, TL_GIZMO_TURN, far_side, (vec2s){{far_side.x + 40, far_side.y}});
        assert_near(change.turn_deg, -0.5 * radian, 0.1);
    }
    /* Where both sides are one line, it is the near one. */
    const struct tl_gizmo gizmo = gizmo_at(0, 0, target);
    const vec2s from = {{450 - 40, 400}}, to = {{450, 400}};
    assert_near(tl_gizmo_drag(&gizmo, TL_GIZMO_TURN, from, to).turn_deg, 0.5 * radian, 0.1);
}

static void the_box_sizes_by_the_ratio_of_distances(void **state)
{
    (void)state;
    const struct tl_gizmo gizmo = gizmo_at(35, 20, aside);
    vec2s centre = project(&gizmo, aside), arm = {{78, -78}};
    vec2s from = glms_vec2_add(centre, arm);
    static const float factors[] = {1, 1.5f, 0.4f, 3};
    for (size_t i = 0; i < TL_COUNT(factors); i++)
        assert_near(
            tl_gizmo_drag(&gizmo, TL_GIZMO_SIZE, from, glms_vec2_muladds(arm, factors[i], centre)).factor,
            factors[i], 1e-5);
    assert_near(tl_gizmo_drag(&gizmo, TL_GIZMO_SIZE, from, glms_vec2_sub(centre, arm)).factor, 0.05, 1e-6);
}

static enum tl_gizmo_handle under(const struct tl_gizmo *gizmo, vec2s at, float right, float down)
{
    return tl_gizmo_under(gizmo, (vec2s){{at.x + right, at.y + down}});
}

/* Handles are where they are drawn, as large on every screen, and none is caught from elsewhere. */
static void handles_are_caught_where_they_are(void **state)
{
    (void)state;
    for (int scale = 1; scale <= 2; scale++) {
        struct tl_gizmo gizmo = gizmo_at(0, 10, target);
        const float unit = (float)scale;
        const vec2s centre = project(&gizmo, target);
        gizmo.scale = unit;
        assert_int_equal(under(&gizmo, centre, 0, 0), TL_GIZMO_VIEW);
        assert_int_equal(under(&gizmo, centre, 100 * unit, 5 * unit), TL_GIZMO_X);
        assert_int_equal(under(&gizmo, centre, 5 * unit, -90 * unit), TL_GIZMO_Y);
        assert_int_equal(under(&gizmo, centre, 78 * unit, -78 * unit), TL_GIZMO_SIZE);
        assert_int_equal(under(&gizmo, centre, -80 * unit, 0), TL_GIZMO_TURN);
        assert_int_equal(under(&gizmo, centre, -100 * unit, 0), TL_GIZMO_NONE);
        assert_int_equal(under(&gizmo, centre, 60 * unit, -40 * unit), TL_GIZMO_NONE);
        assert_int_equal(under(&gizmo, centre, 135 * unit, 0), TL_GIZMO_NONE);
    }
}

static void an_axis_towards_the_eye_has_no_arrow(void **state)
{
    (void)state;
    struct tl_gizmo_drawing drawing;
    struct tl_gizmo gizmo = gizmo_at(5, 5, target);
    assert_true(tl_gizmo_draw(&gizmo, &drawing));
    assert_true(drawing.has_arrow[0] && drawing.has_arrow[1] && !drawing.has_arrow[2]);
    gizmo = gizmo_at(0, 12, target); /* it would end 23 pixels below */
    assert_int_equal(under(&gizmo, project(&gizmo, target), 0, 26), TL_GIZMO_NONE);
    gizmo = gizmo_at(30, 5, target);
    assert_true(tl_gizmo_draw(&gizmo, &drawing));
    assert_true(drawing.has_arrow[0] && drawing.has_arrow[1] && drawing.has_arrow[2]);
    /* Arrows are 110 pixels long where they lie in the plane of the image. */
    gizmo = gizmo_at(0, 0, target);
    assert_true(tl_gizmo_draw(&gizmo, &drawing));
    assert_near(glms_vec2_distance(drawing.to[0], project(&gizmo, target)), 110, 1e-2);
    /* Behind the eye there is none. */
    gizmo.pivot = (vec3s){{0.1f, 1.1f, 10}};
    assert_false(tl_gizmo_draw(&gizmo, &drawing));
    assert_int_equal(tl_gizmo_under(&gizmo, project(&gizmo, target)), TL_GIZMO_NONE);
}

static void changes_snap_to_whole_steps(void **state)
{
    (void)state;
    const struct tl_gizmo_change change = {{{0.0349f, -0.0151f, 0.004f}}, -52.6f, 1.374f};
    const struct tl_gizmo_change snapped = tl_gizmo_snap(&change);
    const double moves[3] = {0.03, -0.02, 0};
    for (int k = 0; k < 3; k++)
        assert_near(snapped.move_m.raw[k], moves[k], 1e-7);
    assert_near(snapped.turn_deg, -60, 1e-5);
    assert_near(snapped.factor, 1.35, 1e-6);
}

static void rays_meet_axes_and_planes(void **state)
{
    (void)state;
    const struct tl_ray ray = {{{0, 0, 4}}, {{0, 0.6f, -0.8f}}}; /* at (0, 3, 0) after 5 */
    float parameter;
    vec3s hit;
    assert_true(tl_gizmo_nearest_on_axis(&ray, (vec3s){{7, 0, 0}}, axes[1], &parameter));
    assert_near(parameter, 3, 1e-5);
    assert_true(tl_gizmo_on_plane(&ray, glms_vec3_zero(), axes[2], &hit));
    assert_near(glms_vec3_distance(hit, (vec3s){{0, 3, 0}}), 0, 1e-5);
    assert_false(tl_gizmo_on_plane(&ray, (vec3s){{0, 0, 5}}, axes[2], &hit)); /* behind */
    assert_false(tl_gizmo_on_plane(&ray, glms_vec3_zero(), axes[0], &hit));   /* along it */
    assert_false(tl_gizmo_nearest_on_axis(&ray, glms_vec3_zero(), ray.direction, &parameter));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrows_from_the_front_move_by_metres_a_pixel),
        cmocka_unit_test(arrows_follow_points_of_their_axes),
        cmocka_unit_test(no_drag_goes_past_the_vanishing_point),
        cmocka_unit_test(the_square_follows_points_of_the_image_plane),
        cmocka_unit_test(the_ring_follows_points_of_its_plane),
        cmocka_unit_test(a_flat_ring_turns_along_its_tangent),
        cmocka_unit_test(the_box_sizes_by_the_ratio_of_distances),
        cmocka_unit_test(handles_are_caught_where_they_are),
        cmocka_unit_test(an_axis_towards_the_eye_has_no_arrow),
        cmocka_unit_test(changes_snap_to_whole_steps),
        cmocka_unit_test(rays_meet_axes_and_planes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
