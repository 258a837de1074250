/* Refinement of coarse garments: edges get shorter and nothing else changes. */
#include "assets/refine.h"

#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>
#include <string.h>

/* A square of 3 x 1 m in two triangles, which are two parts and, as at a seam of UVs, share no vertex; and a
 * needle, 3 m x 1 cm, along its left side. */
enum { VERTICES = 9 };

static tl_garment make_sheet(void)
{
    static const vec3s corners[VERTICES] = {{{0, 0, 0}}, {{3, 0, 0}}, {{3, 1, 0}},
                                            {{0, 0, 0}}, {{3, 1, 0}}, {{0, 1, 0}},
                                            {{0, 0, 0}}, {{0, 1, 0}}, {{-0.01f, 0.5f, 0}}};
    static const uint32_t indices[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    tl_garment garment = {0};
    tl_mesh *mesh = &garment.model.mesh;
    garment.model.name = tl_copy_string("sheet");
    garment.model.point_count = mesh->vertex_count = VERTICES;
    mesh->positions = TL_NEW_ARRAY(vec3s, VERTICES);
    mesh->normals = TL_NEW_ARRAY(vec3s, VERTICES);
    mesh->uvs = TL_NEW_ARRAY(vec2s, VERTICES);
    garment.model.pins = TL_NEW_ARRAY(float, VERTICES);
    for (int i = 0; i < VERTICES; i++) {
        mesh->positions[i] = corners[i];
        mesh->normals[i] = (vec3s){{0, 0, 1}};
        mesh->uvs[i] = (vec2s){{corners[i].x / 4, 1 - corners[i].y}};
        garment.model.pins[i] = corners[i].y > 0.9f ? 1 : 0;
    }
    mesh->index_count = TL_COUNT(indices);
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    memcpy(mesh->indices, indices, sizeof indices);
    mesh->part_count = 2;
    mesh->parts = TL_NEW_ARRAY(struct tl_mesh_part, 2);
    mesh->parts[0] = (struct tl_mesh_part){.first_index = 0, .index_count = 3, .uv_metres = 1};
    mesh->parts[1] = (struct tl_mesh_part){.first_index = 3, .index_count = 6, .uv_metres = 1};
    tl_garment_take_pins(&garment);
    return garment;
}

static double area_of(const tl_mesh *mesh, const struct tl_mesh_part *part)
{
    double area = 0;
    for (uint32_t i = part->first_index; i < part->first_index + part->index_count; i += 3) {
        const vec3s *p = mesh->positions;
        const uint32_t *v = &mesh->indices[i];
        vec3s cross = glms_vec3_cross(glms_vec3_sub(p[v[1]], p[v[0]]), glms_vec3_sub(p[v[2]], p[v[0]]));
        assert_true(cross.z > 0); /* same winding */
        area += 0.5 * (double)glms_vec3_norm(cross);
    }
    return area;
}

static bool is_at(vec3s p, vec3s place)
{
    return p.x == place.x && p.y == place.y && p.z == place.z;
}

/* The number of triangle sides between positions a and b, in either direction. */
static int sides_between(const tl_mesh *mesh, vec3s a, vec3s b)
{
    int sides = 0;
    for (size_t i = 0; i < mesh->index_count; i++) {
        vec3s p = mesh->positions[mesh->indices[i]];
        vec3s q = mesh->positions[mesh->indices[i % 3 == 2 ? i - 2 : i + 1]];
        sides += (is_at(p, a) && is_at(q, b)) || (is_at(p, b) && is_at(q, a));
    }
    return sides;
}

/* Every side of only one triangle lies on the outline, whose length is unchanged: there are no cracks. */
static double outline_of(const tl_mesh *mesh)
{
    double length = 0;
    for (size_t i = 0; i < mesh->index_count; i++) {
        vec3s p = mesh->positions[mesh->indices[i]];
        vec3s q = mesh->positions[mesh->indices[i % 3 == 2 ? i - 2 : i + 1]];
        int sides = sides_between(mesh, p, q);
        assert_true(sides == 1 || sides == 2);
        length += sides == 1 ? (double)glms_vec3_distance(p, q) : 0;
    }
    return length;
}

static void refinement_changes_only_edge_lengths(void **state)
{
    (void)state;
    const float lengths[] = {1.4f, 0.5f, 0.13f};
    for (size_t k = 0; k < TL_COUNT(lengths); k++) {
        tl_garment garment = make_sheet();
        const tl_mesh *mesh = &garment.model.mesh;
        tl_error error = {0};
        double outline = outline_of(mesh);
        assert_ok(tl_garment_refine(&garment, lengths[k], &error), error);
        assert_true(tl_mesh_longest_edge(mesh) <= lengths[k]);
        assert_near(area_of(mesh, &mesh->parts[0]), 1.5, 1e-5);
        assert_near(area_of(mesh, &mesh->parts[1]), 1.505, 1e-5);
        assert_int_equal(mesh->parts[0].index_count + mesh->parts[1].index_count, mesh->index_count);
        assert_near(outline_of(mesh), outline, 1e-5);
        assert_int_equal(garment.model.point_count, mesh->vertex_count);
        size_t pinned = 0;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            vec3s at = mesh->positions[i];
            assert_near(mesh->uvs[i].x, at.x / 4, 1e-6);
            assert_near(mesh->uvs[i].y, 1 - at.y, 1e-6);
            assert_near(mesh->normals[i].z, 1, 1e-6);
            pinned += at.y > 0.99f;
        }
        assert_int_equal(garment.pin_count, pinned); /* all along the upper side */
        assert_true(pinned > 4);
        tl_garment_release(&garment);
    }
}

static void fine_garments_are_unchanged(void **state)
{
    (void)state;
    tl_garment garment = make_sheet();
    tl_error error = {0};
    assert_ok(tl_garment_refine(&garment, 4, &error), error);
    assert_int_equal(garment.model.mesh.vertex_count, VERTICES);
    assert_int_equal(garment.model.mesh.index_count, 9);
    assert_int_equal(garment.pin_count, 4);
    tl_garment_release(&garment);
}

/* Three square metres at 0.1 mm are 7e8 triangles. */
static void too_large_results_are_refused(void **state)
{
    (void)state;
    tl_garment garment = make_sheet();
    tl_error error = {0};
    assert_false(tl_garment_refine(&garment, 1e-4f, &error));
    assert_non_null(strstr(error.message, "cloth.longest_edge_m"));
    tl_garment_release(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refinement_changes_only_edge_lengths),
        cmocka_unit_test(fine_garments_are_unchanged),
        cmocka_unit_test(too_large_results_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
