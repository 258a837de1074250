/* The counter of crossing triangle pairs equals brute force over all pairs: on random triangles, on a
 * crumpled sheet whose triangles share corners, and on a real garment that comes crossed. */
#include "assets/garment.h"
#include "cloth/self_contact/crossings.h"
#include "config/base/memory.h"
#include "tests/cloth/crossing_oracle.h"
#include "tests/testing.h"

#include "config/base/log.h"

static double noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static vec3d scattered(uint32_t *state, double size)
{
    return (vec3d){size * noise(state), size * noise(state), size * noise(state)};
}

static struct tl_topology join(const uint32_t *indices, size_t index_count, size_t vertex_count)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, vertex_count);
    for (size_t i = 0; i < vertex_count; i++)
        weld[i] = (uint32_t)i;
    struct tl_topology topology = tl_topology_build(indices, index_count, weld, vertex_count, vertex_count);
    free(weld);
    return topology;
}

static void check_count(const char *name, const struct tl_topology *topology, const vec3d *x, size_t at_min)
{
    size_t expected = oracle_crossings(topology, x), found = tl_crossings_count(NULL, topology, x);
    printf("%s: %zu crossing pairs of %zu triangles\n", name, expected, topology->triangle_count);
    assert_true(expected >= at_min);
    assert_int_equal(found, expected);
    /* with a tree of a time at which the triangles lay in a row, where none crossed */
    vec3d *before = TL_NEW_ARRAY(vec3d, topology->vertex_count);
    for (size_t i = 0; i < topology->vertex_count; i++)
        before[i] = (vec3d){10.0 * (double)i, x[i].y, x[i].z};
    struct tl_near_tree tree = tl_near_tree_create(topology, before);
    tl_near_tree_refit(&tree, topology, before, NULL, NULL);
    assert_int_equal(tl_crossings_count(&tree, topology, x), expected);
    tl_near_tree_release(&tree);
    free(before);
}

/* Triangles of all sizes without common corners, away from the origin. */
static void test_random_triangles(void **state)
{
    (void)state;
    enum { TRIANGLES = 800 };
    static uint32_t indices[3 * TRIANGLES];
    static vec3d x[3 * TRIANGLES];
    for (uint32_t seed = 1; seed <= 5; seed++) {
        uint32_t random = seed;
        for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
            vec3d about = i % 3 == 0 ? scattered(&random, 1) : vec3d_sub(x[i - i % 3], (vec3d){40, 1, -7});
            indices[i] = i;
            x[i] = vec3d_add(vec3d_add(about, scattered(&random, 0.01 + 0.4 * noise(&random))),
                             (vec3d){40, 1, -7});
        }
        struct tl_topology topology = join(indices, (size_t)3 * TRIANGLES, (size_t)3 * TRIANGLES);
        check_count("scattered", &topology, x, 100);
        tl_topology_release(&topology);
    }
}

/* A grid whose vertices are displaced by more than its cells: neighbours with a common corner cross too. */
static void test_crumpled_sheet(void **state)
{
    (void)state;
    enum { CELLS = 24, COLUMNS = CELLS + 1 };
    static uint32_t indices[6 * CELLS * CELLS];
    static vec3d x[COLUMNS * COLUMNS];
    uint32_t random = 11;
    size_t count = 0;
    for (uint32_t i = 0; i < COLUMNS * COLUMNS; i++) {
        const uint32_t column = i % COLUMNS, row = i / COLUMNS;
        x[i] = vec3d_add((vec3d){0.02 * column, 1 + 0.02 * row, 0}, scattered(&random, 0.05));
    }
    for (uint32_t row = 0; row < CELLS; row++)
        for (uint32_t column = 0; column < CELLS; column++) {
            uint32_t a = row * COLUMNS + column, c = a + COLUMNS + 1;
            const uint32_t corners[6] = {a, a + 1, c, a, c, c - 1};
            for (int i = 0; i < 6; i++)
                indices[count++] = corners[i];
        }
    struct tl_topology topology = join(indices, count, (size_t)COLUMNS * COLUMNS);
    check_count("crumpled", &topology, x, 100);
    tl_topology_release(&topology);
}

/* Two triangles at known relations. A side that ends on the other triangle's plane touches it only. */
static void test_relations(void **state)
{
    (void)state;
    static const struct {
        vec3d p, q, r; /* the other triangle; the first is (0,0,0) (1,0,0) (0,1,0) */
        size_t crossings;
    } cases[] = {
        {{0.2, 0.2, -1}, {0.2, 0.3, 1}, {3, 3, 1}, 1},      /* a side passes through */
        {{0.2, 0.2, -1}, {0.2, 0.2, -0.01}, {3, 3, -1}, 0}, /* below */
        {{0.6, 0.6, -1}, {0.6, 0.6, 1}, {3, 3, 1}, 0},      /* past the long side */
        {{-1, 0.2, -1}, {-1, 0.2, 1}, {3, 0.2, 0}, 1}, /* around it: its own sides pass through the other */
        {{0.2, 0.2, 0}, {0.2, 0.3, 1}, {3, 3, 1}, 0},  /* a corner lies on it */
        {{0.1, 0.1, 0}, {0.4, 0.1, 0}, {0.1, 0.4, 0}, 0}, /* in its plane */
    };
    const uint32_t indices[6] = {0, 1, 2, 3, 4, 5};
    struct tl_topology topology = join(indices, 6, 6);
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        const vec3d x[6] = {{0}, {1, 0, 0}, {0, 1, 0}, cases[i].p, cases[i].q, cases[i].r};
        assert_int_equal(tl_crossings_count(NULL, &topology, x), cases[i].crossings);
        assert_int_equal(oracle_crossings(&topology, x), cases[i].crossings);
    }
    tl_topology_release(&topology);
}

/* MakeHuman's suit has a shirt that passes through the trousers. */
static void test_real_garment(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment;
    assert_ok(tl_garment_load(test_data("garments/mh_male_casualsuit06.glb"), &garment, &error), error);
    const tl_mesh *mesh = &garment.model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    vec3d *x = TL_NEW_ARRAY(vec3d, mesh->vertex_count);
    size_t count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        x[weld[i]] = vec3d_from(mesh->positions[i]);
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, count);
    check_count("casual suit", &topology, x, 100);
    /* As a mesh: the same pairs, in numbers of its triangles. */
    bool *crossed = TL_NEW_ARRAY(bool, mesh->index_count / 3);
    struct tl_near_pairs pairs = {0};
    tl_crossings_of_mesh(mesh, mesh->positions, &pairs);
    assert_int_equal(pairs.count, oracle_crossings(&topology, x));
    for (size_t i = 0; i < pairs.count; i++)
        crossed[pairs.pairs[i][0]] = crossed[pairs.pairs[i][1]] = true;
    tl_near_pairs_release(&pairs);
    for (size_t t = 0; t < topology.triangle_count; t++) {
        bool crosses = false;
        for (size_t other = 0; other < topology.triangle_count && !crosses; other++)
            crosses = other != t && tl_triangles_cross(topology.triangles[t], topology.triangles[other], x);
        assert_int_equal(crossed[topology.source[t]], crosses);
    }
    free(crossed);
    tl_topology_release(&topology);
    free(x);
    free(weld);
    tl_garment_release(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_triangles),
        cmocka_unit_test(test_crumpled_sheet),
        cmocka_unit_test(test_relations),
        cmocka_unit_test(test_real_garment),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
