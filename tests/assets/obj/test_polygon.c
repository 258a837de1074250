#include "assets/obj/polygon.h"

#include "tests/testing.h"

#define CORNERS_MAX 64

static vec3s area_of(const vec3s *corners, const uint32_t triangle[3])
{
    vec3s side = glms_vec3_sub(corners[triangle[1]], corners[triangle[0]]);
    return glms_vec3_cross(side, glms_vec3_sub(corners[triangle[2]], corners[triangle[0]]));
}

/* Triangles of a polygon that does not cross itself, cut without overlap, all face its way, and their areas
 * add up to its own (Newell's formula, in double). */
static void check_cut(const vec3s *corners, size_t count)
{
    uint32_t triangles[3 * CORNERS_MAX], scratch[CORNERS_MAX], uses[CORNERS_MAX] = {0};
    double expected[3] = {0, 0, 0}, total = 0;
    tl_polygon_cut(corners, count, triangles, scratch);
    for (size_t i = 0; i < count; i++) {
        const float *a = corners[i].raw, *b = corners[(i + 1) % count].raw;
        for (int c = 0; c < 3; c++) {
            int u = (c + 1) % 3, v = (c + 2) % 3;
            expected[c] += (double)a[u] * (double)b[v] - (double)a[v] * (double)b[u];
        }
    }
    double area = sqrt(expected[0] * expected[0] + expected[1] * expected[1] + expected[2] * expected[2]);
    for (size_t t = 0; t < count - 2; t++) {
        vec3s part = area_of(corners, &triangles[3 * t]);
        double along =
            ((double)part.x * expected[0] + (double)part.y * expected[1] + (double)part.z * expected[2]) /
            area;
        assert_true(along > 0);
        total += along;
        for (int c = 0; c < 3; c++) {
            assert_true(triangles[3 * t + (size_t)c] < count);
            uses[triangles[3 * t + (size_t)c]]++;
        }
    }
    assert_near(total, area, 1e-5 * area); /* float positions and a few dozen summands */
    for (size_t i = 0; i < count; i++)
        assert_true(uses[i] > 0);
}

/* Star-shaped about its middle, turned into space: any radii give a polygon that does not cross itself. */
static void stars_are_cut_without_overlap(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int round = 0; round < 300; round++) {
        vec3s corners[CORNERS_MAX];
        size_t count = 3 + (size_t)round % (CORNERS_MAX - 2);
        mat4s turn = glms_rotate_make((float)round, (vec3s){{1, (float)(round % 5), -2}});
        for (size_t i = 0; i < count; i++) {
            seed = seed * 1664525u + 1013904223u;
            float radius = 0.2f + (float)(seed >> 8) / (float)(1 << 24);
            float angle = 2 * GLM_PIf * (float)i / (float)count;
            corners[i] = glms_mat4_mulv3(turn, (vec3s){{radius * cosf(angle), radius * sinf(angle), 3}}, 1);
        }
        check_cut(corners, count);
    }
}

static void known_shapes(void **state)
{
    (void)state;
    const vec3s square[] = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}};
    const vec3s arrow[] = {{{0, 0, 0}}, {{2, 1, 0}}, {{0, 2, 0}}, {{0.5f, 1, 0}}}; /* a fan from 0 fails */
    const vec3s stairs[] = {{{0, 0, 0}}, {{3, 0, 0}}, {{3, 1, 0}}, {{2, 1, 0}},
                            {{2, 2, 0}}, {{1, 2, 0}}, {{1, 3, 0}}, {{0, 3, 0}}};
    check_cut(square, 4);
    check_cut(arrow, 4);
    check_cut(stairs, 8);
}

/* Such polygons have no right triangulation, but the count and the indices must be valid. */
static void degenerate_polygons_are_cut(void **state)
{
    (void)state;
    const vec3s bow_tie[] = {{{0, 0, 0}}, {{1, 1, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
    const vec3s point[5] = {{{1, 1, 1}}, {{1, 1, 1}}, {{1, 1, 1}}, {{1, 1, 1}}, {{1, 1, 1}}};
    uint32_t triangles[9] = {9, 9, 9, 9, 9, 9, 9, 9, 9}, scratch[5];
    tl_polygon_cut(bow_tie, 4, triangles, scratch);
    for (int i = 0; i < 6; i++)
        assert_true(triangles[i] < 4);
    tl_polygon_cut(point, 5, triangles, scratch);
    for (int i = 0; i < 9; i++)
        assert_true(triangles[i] < 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_shapes),
        cmocka_unit_test(stars_are_cut_without_overlap),
        cmocka_unit_test(degenerate_polygons_are_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
