/* Laying out a pattern: every triangle keeps its shape, no two pieces overlap, all show their outer side. */
#include "assets/sewing/layout.h"
#include "tests/testing.h"

#include "config/base/memory.h"

/* Two triangles with a common side, by vertices of their own: a rectangle of w by h metres from (x, y). */
static void add_piece(tl_garment *garment, float x, float y, float w, float h, bool mirrored)
{
    tl_mesh *mesh = &garment->model.mesh;
    const uint32_t first = (uint32_t)mesh->vertex_count;
    const float corners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    mesh->positions = tl_resize(mesh->positions, first + 6, sizeof *mesh->positions);
    garment->pattern = tl_resize(garment->pattern, first + 6, sizeof *garment->pattern);
    mesh->indices = tl_resize(mesh->indices, mesh->index_count + 6, sizeof *mesh->indices);
    for (uint32_t i = 0; i < 6; i++) {
        vec2s at = {{w * corners[i][0], h * corners[i][1]}};
        mesh->positions[first + i] = (vec3s){{at.x, at.y, (float)first}};
        garment->pattern[first + i] = (vec2s){{x + (mirrored ? w - at.x : at.x), y + at.y}};
        mesh->indices[mesh->index_count++] = first + i;
    }
    mesh->vertex_count += 6;
}

/* Three pieces that lie on each other in the pattern, one of them mirrored, two of them in contact. */
static tl_garment three_pieces(void)
{
    tl_garment garment = {0};
    add_piece(&garment, 0, 0, 0.3f, 0.2f, false);
    add_piece(&garment, 0.1f, 0.1f, 0.4f, 0.7f, true);
    add_piece(&garment, 0.3f, 0, 0.3f, 0.2f, false);
    return garment;
}

static vec2s side_of(const vec2s *at, const uint32_t *triangle, int k)
{
    return glms_vec2_sub(at[triangle[k]], at[triangle[0]]);
}

static void test_triangles_keep_their_shape_and_face_outwards(void **state)
{
    (void)state;
    tl_garment garment = three_pieces();
    vec2s flat[18], size;
    assert_true(tl_layout_make(&garment, flat, &size));
    for (size_t t = 0; t < garment.model.mesh.index_count; t += 3) {
        const uint32_t *triangle = &garment.model.mesh.indices[t];
        vec2s was[2] = {side_of(garment.pattern, triangle, 1), side_of(garment.pattern, triangle, 2)};
        vec2s is[2] = {side_of(flat, triangle, 1), side_of(flat, triangle, 2)};
        assert_near(glms_vec2_cross(is[0], is[1]), fabs((double)glms_vec2_cross(was[0], was[1])), 1e-6);
        for (int k = 0; k < 2; k++) { /* not turned: warp stays upright */
            assert_near(is[k].y, was[k].y, 1e-6);
            assert_near(fabsf(is[k].x), fabsf(was[k].x), 1e-6);
        }
    }
    tl_garment_release(&garment);
}

static void test_pieces_lie_apart_on_the_table(void **state)
{
    (void)state;
    tl_garment garment = three_pieces();
    vec2s flat[18], size;
    assert_true(tl_layout_make(&garment, flat, &size));
    vec2s lower[3], upper[3];
    for (int p = 0; p < 3; p++) {
        const vec2s *corners = flat + (ptrdiff_t)6 * p;
        lower[p] = upper[p] = corners[0];
        for (int i = 1; i < 6; i++) {
            lower[p] = glms_vec2_minv(lower[p], corners[i]);
            upper[p] = glms_vec2_maxv(upper[p], corners[i]);
        }
        assert_true(lower[p].x > -1e-6f && lower[p].y > -1e-6f);
        assert_true(upper[p].x < size.x + 1e-6f && upper[p].y < size.y + 1e-6f);
    }
    for (int p = 0; p < 3; p++)
        for (int q = 0; q < p; q++) {
            float gap_x = fmaxf(lower[p].x - upper[q].x, lower[q].x - upper[p].x);
            float gap_y = fmaxf(lower[p].y - upper[q].y, lower[q].y - upper[p].y);
            assert_true(fmaxf(gap_x, gap_y) > TL_LAYOUT_GAP_M - 1e-6f);
        }
    tl_garment_release(&garment);
}

static void test_a_garment_without_a_pattern_has_no_layout(void **state)
{
    (void)state;
    tl_garment garment = three_pieces();
    vec2s flat[18], size;
    free(garment.pattern);
    garment.pattern = NULL;
    assert_false(tl_layout_make(&garment, flat, &size));
    tl_garment_release(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triangles_keep_their_shape_and_face_outwards),
        cmocka_unit_test(test_pieces_lie_apart_on_the_table),
        cmocka_unit_test(test_a_garment_without_a_pattern_has_no_layout),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
