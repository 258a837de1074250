/* A body under a garment as authored: a fine ball in a coarse bowl whose flat triangles it reaches through,
 * as far as the bowl goes and nowhere else; and real suits, in which no vertex of the body is left outside.
 */
#include "tests/testing.h"

#include "app/scene/inset_body.h"
#include "assets/avatar.h"
#include "assets/garment.h"
#include "cloth/contact/collider.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* A part of a sphere about the origin, from the pole -Y up to the given height, with normals. */
static tl_mesh bowl(float radius, uint32_t rings, uint32_t sides, float top_y)
{
    tl_mesh mesh = {.vertex_count = (size_t)(rings + 1) * (sides + 1),
                    .index_count = (size_t)6 * rings * sides};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.normals = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, mesh.index_count);
    float last = acosf(-top_y / radius);
    for (uint32_t r = 0, at = 0; r <= rings; r++)
        for (uint32_t s = 0; s <= sides; s++, at++) {
            float polar = last * (float)r / (float)rings;
            float around = 2 * (float)M_PI * (float)(s % sides) / (float)sides;
            mesh.normals[at] =
                (vec3s){{sinf(polar) * cosf(around), -cosf(polar), sinf(polar) * sinf(around)}};
            mesh.positions[at] = glms_vec3_scale(mesh.normals[at], radius);
        }
    uint32_t *index = mesh.indices;
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t s = 0; s < sides; s++) {
            uint32_t a = r * (sides + 1) + s, b = a + sides + 1;
            const uint32_t quad[6] = {a, b, a + 1, a + 1, b, b + 1};
            for (int k = 0; k < 6; k++)
                *index++ = quad[k];
        }
    return mesh;
}

/* The number of the body's vertices outside of the garment, of those for which depths are not 0. */
static size_t outside_of(const tl_mesh *garment, const tl_mesh *body, const float *depths,
                         const vec3s *positions)
{
    tl_error error = {0};
    tl_collider *cloth = tl_collider_create(garment, false, &error);
    assert_ok(cloth != NULL, error);
    size_t outside = 0;
    for (size_t i = 0; i < body->vertex_count; i++) {
        const vec3s x = positions[i];
        const double point[3] = {(double)x.x, (double)x.y, (double)x.z};
        struct tl_contact contact;
        outside += depths[i] > 0 && tl_collider_query(cloth, point, 0.05, &contact) && contact.distance_m > 0;
    }
    tl_collider_destroy(&cloth);
    return outside;
}

static void a_ball_is_inset_in_a_bowl(void **state)
{
    (void)state;
    const float radius = 0.2f;
    tl_mesh ball = bowl(radius, 90, 180, 0.9999f * radius), cloth = bowl(radius, 9, 14, 0);
    tl_error error = {0};
    float *depths = tl_inset_body_find(&cloth, &ball, &error);
    assert_ok(depths != NULL, error);
    size_t inset = 0;
    float deepest_m = 0;
    for (size_t i = 0; i < ball.vertex_count; i++) {
        inset += depths[i] > 0;
        deepest_m = fmaxf(deepest_m, depths[i]);
        if (ball.positions[i].y > 0.01f)
            assert_near(depths[i], 0, 0); /* past the rim: no cloth covers it */
        if (ball.positions[i].y < -0.02f)
            assert_true(depths[i] >= 0.9f * TL_INSET_BODY_CLEARANCE_M);
    }
    assert_true(inset > ball.vertex_count / 3);
    assert_true(deepest_m > 2 * TL_INSET_BODY_CLEARANCE_M); /* the bowl's triangles are flat */
    assert_true(outside_of(&cloth, &ball, depths, ball.positions) > 1000);
    tl_inset_body_apply(depths, ball.normals, ball.positions, ball.vertex_count);
    assert_int_equal(outside_of(&cloth, &ball, depths, ball.positions), 0);
    free(depths);
    /* Cloth that faces the other way does not cover: a sleeve beside a hip. */
    for (size_t t = 0; t < cloth.index_count / 3; t++) {
        uint32_t first = cloth.indices[3 * t];
        cloth.indices[3 * t] = cloth.indices[3 * t + 1];
        cloth.indices[3 * t + 1] = first;
    }
    depths = tl_inset_body_find(&cloth, &ball, &error);
    assert_ok(depths != NULL, error);
    for (size_t i = 0; i < ball.vertex_count; i++)
        assert_near(depths[i], 0, 0);
    free(depths);
    tl_mesh_release(&ball);
    tl_mesh_release(&cloth);
}

static float *find(const char *garment_file, const char *avatar_file, tl_garment *garment, tl_avatar *avatar)
{
    tl_error error = {0};
    assert_ok(tl_garment_load(test_data(garment_file), garment, &error), error);
    assert_ok(tl_avatar_load(test_data(avatar_file), avatar, &error), error);
    float *depths = tl_inset_body_find(&garment->model.mesh, &avatar->model.mesh, &error);
    assert_ok(depths != NULL, error);
    return depths;
}

static void a_body_is_inset_into_its_own_suit_only(void **state)
{
    (void)state;
    tl_garment garment;
    tl_avatar avatar;
    float *depths =
        find("garments/mh_female_sportsuit01.glb", "avatars/mh_female_body.glb", &garment, &avatar);
    tl_mesh *body = &avatar.model.mesh;
    size_t before = outside_of(&garment.model.mesh, body, depths, body->positions);
    tl_inset_body_apply(depths, body->normals, body->positions, body->vertex_count);
    size_t after = outside_of(&garment.model.mesh, body, depths, body->positions);
    print_message("sports suit: %zu vertices of its body reach through it, %zu when it is inset\n", before,
                  after);
    assert_true(before > 100);
    assert_true(after <= before / 50); /* between the legs two sides of the cloth are near */
    free(depths);
    tl_garment_release(&garment);
    tl_avatar_release(&avatar);
    depths = find("garments/mh_female_sportsuit01.glb", "avatars/mh_male_body.glb", &garment, &avatar);
    for (size_t i = 0; i < avatar.model.mesh.vertex_count; i++)
        assert_near(depths[i], 0, 0);
    free(depths);
    tl_garment_release(&garment);
    tl_avatar_release(&avatar);
}

static vec3s area_of(const tl_mesh *mesh, size_t triangle)
{
    const uint32_t *v = &mesh->indices[3 * triangle];
    const vec3s *x = mesh->positions;
    return glms_vec3_cross(glms_vec3_sub(x[v[1]], x[v[0]]), glms_vec3_sub(x[v[2]], x[v[0]]));
}

/* The collar of this suit stands off the neck: no triangle turns over beside it. */
static void skin_is_not_torn(void **state)
{
    (void)state;
    tl_garment garment;
    tl_avatar avatar;
    float *depths = find("garments/mh_male_casualsuit06.glb", "avatars/mh_male_body.glb", &garment, &avatar);
    tl_mesh *body = &avatar.model.mesh;
    vec3s *before = TL_NEW_ARRAY(vec3s, body->index_count / 3);
    size_t moved = 0, turned = 0;
    for (size_t t = 0; t < body->index_count / 3; t++)
        before[t] = area_of(body, t);
    tl_inset_body_apply(depths, body->normals, body->positions, body->vertex_count);
    for (size_t i = 0; i < body->vertex_count; i++)
        moved += depths[i] > 0;
    for (size_t t = 0; t < body->index_count / 3; t++)
        turned += glms_vec3_dot(before[t], area_of(body, t)) < 0;
    print_message("casual suit: %zu vertices of its body are moved, %zu triangles turn over\n", moved,
                  turned);
    assert_true(moved > 100);
    assert_int_equal(turned, 0);
    free(before);
    free(depths);
    tl_garment_release(&garment);
    tl_avatar_release(&avatar);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_is_inset_in_a_bowl),
        cmocka_unit_test(a_body_is_inset_into_its_own_suit_only),
        cmocka_unit_test(skin_is_not_torn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
