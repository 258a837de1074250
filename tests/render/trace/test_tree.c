/* Rays through the tree of the graphics card against all triangles of small meshes, one by one; the tree's
 * shape, and its work. */
#include "tests/render/tree_rays.h"

#include "config/base/memory.h"

#include "tests/testing.h"

/* ---- Small meshes ---- */

enum { SOUP_TRIANGLES = 300, SOUP_RAYS = 4000 };

static void test_soups_are_as_brute_force(void **state)
{
    static struct card_ray rays[SOUP_RAYS];
    static const size_t counts[] = {0, 1, 3, 4, 30, SOUP_TRIANGLES};
    float openness[SOUP_TRIANGLES];
    random_rays(rays, SOUP_RAYS, 3);
    for (size_t t = 0; t < SOUP_TRIANGLES; t++)
        openness[t] = t % 3 == 0 ? 0 : 0.25f * (float)(t % 4);
    for (size_t i = 0; i < TL_COUNT(counts); i++) {
        struct soup soup;
        struct card card;
        size_t hits = 0;
        soup_create(&soup, counts[i], 1 + i);
        struct flat_mesh mesh = flat_mesh_of_soup(&soup);
        mesh.openness = openness;
        mesh.other_count = counts[i] / 3;
        card_open(&card, *state, NULL, NULL);
        for (uint64_t pose = 0; pose < 2; pose++) { /* wholly elsewhere: the tree is a bad one, and right */
            soup_place(&soup, 10 * i + pose);
            card_update(&card, &mesh);
            assert_int_equal(card_count_faulty(&card, &mesh, rays, SOUP_RAYS, &hits), 0);
        }
        assert_true(hits >= counts[i]);
        card_close(&card);
        soup_release(&soup);
    }
}

/* Each triangle has one place, each node one parent, and nodes lie as they are documented. */
static void check_tree(const struct tl_tree *tree)
{
    size_t placed = 0, next = TL_TREE_CASTERS;
    bool *placed_at = TL_NEW_ARRAY(bool, tree->triangle_count);
    assert_in_range(tree->level_count, 1, TL_TREE_LEVELS_MAX);
    assert_int_equal(tree->level_first[0], 0);
    assert_int_equal(tree->level_first[tree->level_count], tree->node_count);
    for (size_t node = 0; node < tree->node_count; node++) {
        assert_int_equal(tree->heads[node][0], next);
        assert_int_equal(tree->heads[node][1], placed);
        for (int s = 0; s < TL_TREE_WIDTH; s++) {
            const uint32_t child = tree->children[node][s];
            if (child == TL_TREE_NO_CHILD)
                continue;
            if (child & TL_TREE_LEAF) {
                const uint32_t count = (child & ~TL_TREE_LEAF) >> TL_TREE_COUNT_SHIFT;
                assert_int_equal(child & TL_TREE_PLACE, placed);
                assert_in_range(count, 1, TL_TREE_LEAF_MAX);
                placed += count;
            } else {
                assert_int_equal(child, next++);
            }
        }
    }
    assert_int_equal(next, tree->node_count);
    assert_int_equal(placed, tree->triangle_count);
    for (size_t i = 0; i < placed; i++) {
        assert_false(placed_at[tree->order[i]]);
        placed_at[tree->order[i]] = true;
    }
    free(placed_at);
}

/* Triangles each of which is a fraction of the one before, at the fraction of its distance: splits of smallest
 * area take them off one by one. And many triangles at one place: no split parts them. */
static void test_depth_is_bounded(void **state)
{
    enum { COUNT = 4000, RAYS = 200 };
    static struct card_ray rays[RAYS];
    struct soup soup;
    for (int at_one_place = 0; at_one_place < 2; at_one_place++) {
        struct card card;
        size_t hits = 0;
        soup_create(&soup, COUNT, 1);
        for (size_t i = 0; i < (size_t)3 * COUNT; i++) {
            const size_t triangle = i / 3;
            const float scale = powf(0.98f, (float)triangle);
            soup.positions[i] =
                at_one_place
                    ? soup.positions[i % 3]
                    : (vec3s){{scale, i % 3 == 1 ? 0.01f * scale : 0, i % 3 == 2 ? 0.01f * scale : 0}};
        }
        struct flat_mesh mesh = flat_mesh_of_soup(&soup);
        card_open(&card, *state, NULL, NULL);
        card_update(&card, &mesh);
        check_tree(&card.tree.tree);
        for (size_t i = 0; i < RAYS; i++) { /* through the middle of each, from nearby, to nearby */
            const vec3s *corners = &soup.positions[3 * i];
            const vec3s sum = glms_vec3_add(corners[0], glms_vec3_add(corners[1], corners[2]));
            rays[i] = (struct card_ray){.origin = glms_vec3_scale(sum, 1.0f / 3), .direction = {{-1, 0, 0}}};
            rays[i].to = 0.01f * corners[0].x;
            rays[i].origin.x += 0.005f * corners[0].x;
        }
        if (!at_one_place)
            assert_int_equal(card_count_faulty(&card, &mesh, rays, RAYS, &hits), 0);
        card_close(&card);
        soup_release(&soup);
    }
}

/* ---- Work ---- */

enum { LINES = 40000 };

/* Random lines of all directions, evenly spread, that meet the box of a mesh. */
static void lines_through(const struct flat_mesh *mesh, struct card_ray rays[LINES])
{
    uint64_t seed = 5;
    vec3s low = mesh->positions[0], high = low;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        low = glms_vec3_minv(low, mesh->positions[v]);
        high = glms_vec3_maxv(high, mesh->positions[v]);
    }
    const vec3s middle = glms_vec3_scale(glms_vec3_add(low, high), 0.5f);
    const float radius = 0.5f * glms_vec3_distance(low, high);
    for (size_t count = 0; count < LINES;) {
        const vec3s direction = soup_direction(&seed), right = glms_vec3_ortho(direction);
        const float x = 2 * soup_random(&seed) - 1,
                    y = 2 * soup_random(&seed) - 1; /* of a disc across the line */
        const vec3s across = glms_vec3_normalize(right), up = glms_vec3_cross(direction, across);
        const vec3s at = glms_vec3_add(glms_vec3_scale(across, x * radius), glms_vec3_scale(up, y * radius));
        const vec3s origin = glms_vec3_sub(glms_vec3_add(middle, at), glms_vec3_scale(direction, 2 * radius));
        float from = 0, to = x * x + y * y <= 1 ? FAR_M : -1;
        for (int axis = 0; axis < 3; axis++) {
            const float a = (low.raw[axis] - origin.raw[axis]) / direction.raw[axis],
                        b = (high.raw[axis] - origin.raw[axis]) / direction.raw[axis];
            from = fmaxf(from, fminf(a, b));
            to = fminf(to, fmaxf(a, b));
        }
        if (from <= to)
            rays[count++] = (struct card_ray){.origin = origin, .direction = direction, .to = FAR_M};
    }
}

/* The cost of a tree is the work of lines that nothing stops. Bytes round boxes up: by a step of 254 at a
 * side. */
static void test_cost_is_work(void **state)
{
    static struct card_ray rays[LINES];
    struct soup soup;
    soup_create(&soup, SOUP_TRIANGLES, 9);
    struct flat_mesh mesh = flat_mesh_of_soup(&soup);
    float openness[SOUP_TRIANGLES];
    for (size_t t = 0; t < SOUP_TRIANGLES; t++)
        openness[t] = 1;
    mesh.openness = openness;
    lines_through(&mesh, rays);
    const struct card_work work =
        card_measure_work(*state, &mesh, "#define ONLY TREE_THROUGH\n", CARD_ORDER, rays, LINES);
    assert_near(work.nodes + 0.4 * work.triangles, work.cost, 0.02 * work.cost);
    soup_release(&soup);
}

/* A mesh that has jumped to another place gets a tree of that place. */
static void test_worn_trees_are_built_again(void **state)
{
    struct soup soup;
    struct card card;
    soup_create(&soup, SOUP_TRIANGLES, 9);
    struct flat_mesh mesh = flat_mesh_of_soup(&soup);
    card_open(&card, *state, NULL, NULL);
    card_update(&card, &mesh);
    const double marked = card.tree.built_cost *= 1.01; /* a build would set it */
    for (int i = 0; i < 20; i++)                        /* at rest: it is kept */
        card_update(&card, &mesh);
    assert_near(card.tree.built_cost, marked, 0);
    soup_place(&soup, 10);
    struct tl_tree fresh =
        tl_tree_build(mesh.positions, mesh.corners, mesh.triangle_count, mesh.triangle_count);
    const double best = tl_tree_cost(&fresh, mesh.positions, mesh.corners);
    assert_true(tl_tree_cost(&card.tree.tree, mesh.positions, mesh.corners) > 2 * best);
    for (int i = 0; i < 8; i++)
        card_update(&card, &mesh);
    assert_near(tl_tree_cost(&card.tree.tree, mesh.positions, mesh.corners), best, 1e-9);
    tl_tree_release(&fresh);
    card_close(&card);
    soup_release(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soups_are_as_brute_force),
        cmocka_unit_test(test_depth_is_bounded),
        cmocka_unit_test(test_cost_is_work),
        cmocka_unit_test(test_worn_trees_are_built_again),
    };
    return cmocka_run_group_tests(tests, card_gpu_open, card_gpu_close);
}
