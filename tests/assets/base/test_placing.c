/* Placing: the axis that points up, then size, then direction, then place. */
#include "assets/base/placing.h"
#include "tests/testing.h"

#include "config/base/memory.h"

static void place(const struct tl_placing *placing, vec3s *position, vec3s *normal)
{
    struct tl_mesh_part part = {.uv_metres = 2};
    vec4s tangent = {{normal->x, normal->y, normal->z, -1}};
    tl_mesh mesh = {.vertex_count = 1,
                    .positions = position,
                    .normals = normal,
                    .tangents = &tangent,
                    .part_count = 1,
                    .parts = &part};
    tl_placing_apply(placing, &mesh);
    assert_near(part.uv_metres, 2 * placing->scale, 1e-6);
    for (int i = 0; i < 3; i++)
        assert_near(tangent.raw[i], normal->raw[i], 0);
    assert_near(tangent.w, -1, 0);
}

static void assert_at(vec3s v, float x, float y, float z)
{
    assert_near(v.x, x, 1e-6);
    assert_near(v.y, y, 1e-6);
    assert_near(v.z, z, 1e-6);
}

static void nothing_changes_by_default(void **state)
{
    (void)state;
    const struct tl_placing none = {.scale = 1};
    vec3s position = {{0.1f, 0.2f, 0.3f}}, normal = {{0, 0, 1}};
    assert_false(tl_placing_moves(&none));
    place(&none, &position, &normal);
    assert_true(position.x == 0.1f && position.y == 0.2f && position.z == 0.3f);
}

/* What points up in the file points up in the scene, and what faces -Y there faces the viewer. */
static void z_up_stands(void **state)
{
    (void)state;
    const struct tl_placing upright = {.z_up = true, .scale = 1};
    vec3s position = {{1, 2, 3}}, normal = {{0, -1, 0}};
    assert_true(tl_placing_moves(&upright));
    place(&upright, &position, &normal);
    assert_at(position, 1, 3, -2);
    assert_at(normal, 0, 0, 1);
}

static void size_direction_and_place_follow(void **state)
{
    (void)state;
    const struct tl_placing placing = {.scale = 2, .turn_deg = 90, .move_m = {{10, 20, 30}}};
    vec3s position = {{0, 1, 3}}, normal = {{0, 0, 1}};
    assert_true(tl_placing_moves(&placing));
    place(&placing, &position, &normal);
    assert_at(position, 16, 22, 30);
    assert_at(normal, 1, 0, 0);
}

/* What is placed can be traced back, and a change about a point leaves that point where it is and nothing
 * else. */
static void changes_about_a_point_keep_it(void **state)
{
    (void)state;
    const struct tl_placing placing = {.z_up = true, .scale = 2, .turn_deg = 30, .move_m = {{1, -2, 0.5f}}};
    const vec3s point = {{0.3f, 1.2f, -0.4f}}, other = {{0.5f, 1.2f, -0.4f}};
    const struct tl_placing upright = {.scale = 2, .turn_deg = 30, .move_m = {{1, -2, 0.5f}}};
    const struct tl_placing *placings[] = {&placing, &upright};
    for (size_t i = 0; i < TL_COUNT(placings); i++) {
        vec3s origin = tl_placing_origin(placings[i], point), far = tl_placing_origin(placings[i], other);
        vec3s back = tl_placing_point(placings[i], origin);
        assert_at(back, point.x, point.y, point.z);
        const struct tl_placing changed = tl_placing_about(placings[i], point, 90, 1.5f);
        assert_near(changed.scale, 3, 1e-6);
        assert_near(changed.turn_deg, 120, 1e-4);
        back = tl_placing_point(&changed, origin);
        assert_at(back, point.x, point.y, point.z);
        vec3s moved = tl_placing_point(&changed, far); /* 0.2 m to +X becomes 0.3 m to -Z */
        assert_at(moved, point.x, point.y, point.z - 0.3f);
    }
}

/* What is placed one way and taken over to another way is where that one places it. */
static void one_place_leads_to_another(void **state)
{
    (void)state;
    const struct tl_placing from = {.scale = 2, .turn_deg = 30, .move_m = {{1, -2, 0.5f}}};
    const struct tl_placing to = {.scale = 0.5f, .turn_deg = -75, .move_m = {{-3, 0.25f, 4}}};
    const vec3s point = {{0.3f, 1.2f, -0.4f}};
    const struct tl_placing between = tl_placing_between(&from, &to), none = tl_placing_between(&to, &to);
    vec3s taken = tl_placing_point(&between, tl_placing_point(&from, point));
    vec3s placed = tl_placing_point(&to, point);
    assert_at(taken, placed.x, placed.y, placed.z);
    assert_false(tl_placing_moves(&none));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_changes_by_default), cmocka_unit_test(z_up_stands),
        cmocka_unit_test(size_direction_and_place_follow), cmocka_unit_test(changes_about_a_point_keep_it),
        cmocka_unit_test(one_place_leads_to_another)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
