/* Welding and connectivity, on meshes small enough to check by hand. */
#include "assets/topology/sets.h"
#include "cloth/mesh/topology.h"
#include "cloth/tangents/tangent_frames.h"
#include "tests/testing.h"

static void test_weld_is_bitwise_but_for_zero(void **state)
{
    (void)state;
    const vec3s positions[] = {
        {{0, 1, 2}}, {{-0.0f, 1, 2}}, {{nextafterf(0, 1), 1, 2}}, {{3, 4, 5}}, {{0, 1, 2}}};
    const uint32_t expected[] = {0, 0, 1, 2, 0};
    uint32_t weld[5];
    assert_int_equal(tl_weld_positions(positions, 5, weld), 3);
    assert_memory_equal(weld, expected, sizeof weld);
}

/* A square of two triangles, one of them repeated with opposite winding; a third triangle on the diagonal;
 * and a triangle whose corners weld together. */
static const uint32_t corners[] = {0, 1, 2, 0, 2, 3, 2, 0, 3, 0, 2, 4, 1, 1, 5};
static const uint32_t identity[] = {0, 1, 2, 3, 4, 5};

static void test_edges_and_neighbours(void **state)
{
    (void)state;
    struct tl_topology square = tl_topology_build(corners, 6, identity, 4, 4);
    assert_int_equal(square.triangle_count, 2);
    assert_int_equal(square.edge_count, 5);
    assert_int_equal(square.neighbour[0][1], 1); /* the edge that faces corner 1 is the diagonal */
    assert_int_equal(square.neighbour[1][2], 0);
    assert_int_equal(square.neighbour[0][0], TL_NONE);
    assert_int_equal(tl_topology_far_corner(&square, 0, 1), 2);
    assert_int_equal(tl_topology_far_corner(&square, 1, 0), 1);
    tl_topology_release(&square);
}

static void test_repeated_and_collapsed_triangles_are_dropped(void **state)
{
    (void)state;
    struct tl_topology mesh = tl_topology_build(corners, 9, identity, 6, 6);
    assert_int_equal(mesh.triangle_count, 2);
    tl_topology_release(&mesh);
    mesh = tl_topology_build(corners, 15, identity, 6, 6);
    const uint32_t source[] = {0, 1, 3};
    assert_int_equal(mesh.triangle_count, 3);
    assert_memory_equal(mesh.source, source, sizeof source);
    assert_int_equal(mesh.edge_count, 7);
    tl_topology_release(&mesh);
}

static void test_an_edge_of_three_triangles_is_no_hinge(void **state)
{
    (void)state;
    struct tl_topology mesh = tl_topology_build(corners, 15, identity, 6, 6);
    for (size_t t = 0; t < mesh.triangle_count; t++)
        for (int i = 0; i < 3; i++)
            assert_int_equal(mesh.neighbour[t][i], TL_NONE);
    tl_topology_release(&mesh);
}

static void test_fans_list_every_corner_once(void **state)
{
    (void)state;
    struct tl_fans fans = tl_fans_build(corners, 6, 4);
    const uint32_t first[] = {0, 2, 3, 5, 6}, items[] = {0, 3, 1, 2, 4, 5};
    assert_memory_equal(fans.first, first, sizeof first);
    assert_memory_equal(fans.items, items, sizeof items);
    tl_fans_release(&fans);
}

/* All triangles of a fan share a vertex, so each batch has one lane; a strip of separate quads fills its
 * lanes. Every element is listed once, and no batch contains a vertex twice. */
static void test_batches_share_no_vertex(void **state)
{
    (void)state;
    enum { COUNT = 240 };
    for (int fan = 0; fan < 2; fan++) {
        uint32_t triangles[COUNT][3];
        for (uint32_t i = 0; i < COUNT; i++)
            for (uint32_t k = 0; k < 3; k++)
                triangles[i][k] = fan && k == 0 ? 0 : i + k + 1;
        struct tl_batches batches = tl_batches_build(&triangles[0][0], 3, 3, COUNT, COUNT + 3);
        int seen[COUNT] = {0};
        for (size_t run = 0, slot = 0; run < batches.run_count; run++) {
            int used[COUNT + 3] = {0};
            for (; slot < batches.run_ends[run] * TL_BATCH; slot++) {
                uint32_t e = batches.elements[slot];
                for (size_t k = 0; e != TL_NONE && k < 3; k++)
                    assert_int_equal(used[triangles[e][k]]++, 0);
                if (e != TL_NONE)
                    seen[e]++;
            }
        }
        for (size_t e = 0; e < COUNT; e++)
            assert_int_equal(seen[e], 1);
        assert_int_equal(batches.count, fan ? COUNT : COUNT / TL_BATCH);
        assert_int_equal(batches.run_count, fan ? COUNT : 3);
        assert_int_equal(batches.run_ends[batches.run_count - 1], batches.count);
        tl_batches_release(&batches);
    }
}

static void test_sets(void **state)
{
    (void)state;
    uint32_t *parents = tl_sets_create(6);
    tl_sets_join(parents, 4, 2);
    tl_sets_join(parents, 5, 4);
    tl_sets_join(parents, 0, 1);
    const uint32_t expected[] = {0, 0, 2, 3, 2, 2};
    for (uint32_t i = 0; i < 6; i++)
        assert_int_equal(tl_sets_find(parents, i), expected[i]);
    free(parents);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weld_is_bitwise_but_for_zero),
        cmocka_unit_test(test_edges_and_neighbours),
        cmocka_unit_test(test_repeated_and_collapsed_triangles_are_dropped),
        cmocka_unit_test(test_an_edge_of_three_triangles_is_no_hinge),
        cmocka_unit_test(test_fans_list_every_corner_once),
        cmocka_unit_test(test_batches_share_no_vertex),
        cmocka_unit_test(test_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
