/* The vertices around each vertex (render/gbuffer/rings.h), against every triangle gone through. */
#include "tests/render/scenes.h"

#include "render/gbuffer/rings.h"

#include "tests/testing.h"

#include "config/base/memory.h"

/* Whether two vertices of a surface are corners of one triangle, or lend a third their light together. */
static bool are_neighbours(const tl_surface *surface, uint32_t a, uint32_t b)
{
    const struct tl_light_mesh *mesh = surface->light_mesh;
    const size_t threes = mesh ? surface->vertex_count : surface->index_count / 3;
    for (size_t i = 0; i < threes && a != b; i++) {
        const uint32_t *three = mesh ? mesh->from[i] : surface->indices + 3 * i;
        bool has_a = false, has_b = false;
        for (int k = 0; k < 3; k++) {
            has_a |= three[k] == a;
            has_b |= three[k] == b;
        }
        if (has_a && has_b)
            return true;
    }
    return false;
}

static void check_vertex(const struct tl_vertex_rings *rings, const tl_surface *surface, size_t first,
                         uint32_t vertex)
{
    const uint32_t *ring = rings->neighbours + rings->first[first + vertex];
    uint32_t found = 0;
    for (uint32_t other = 0; other < surface->vertex_count; other++) {
        uint32_t times = 0;
        for (uint32_t i = 0; i < rings->counts[first + vertex]; i++)
            times += ring[i] == first + other;
        assert_int_equal(times, are_neighbours(surface, vertex, other));
        found += times;
    }
    assert_int_equal(found, rings->counts[first + vertex]); /* and none of another surface */
    assert_true(tl_has_own_light(surface, vertex) == (found > 0));
}

static void rings_are_what_triangles_say(void **state)
{
    (void)state;
    struct test_shape shapes[] = {
        test_sheet(1, 0.5f, 0.1f, 2, 4), test_sphere((vec3s){{0, 0, 0}}, 1, 6),
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 1, 4)};
    test_shape_split(&shapes[2], 4);
    const tl_surface *surfaces[TL_COUNT(shapes)];
    for (size_t s = 0; s < TL_COUNT(shapes); s++) {
        test_shape_refresh(&shapes[s]);
        surfaces[s] = &shapes[s].surface;
    }
    struct tl_triangle_ranges ranges = {0};
    tl_triangle_ranges_make(surfaces, TL_COUNT(surfaces), &ranges);
    struct tl_vertex_rings rings = tl_vertex_rings_make(&ranges);
    size_t first = 0;
    for (size_t s = 0; s < TL_COUNT(shapes); first += surfaces[s++]->vertex_count)
        for (uint32_t v = 0; v < surfaces[s]->vertex_count; v++)
            check_vertex(&rings, surfaces[s], first, v);
    assert_int_equal(rings.vertex_count, first);
    assert_true(tl_vertex_rings_bytes(&rings) > first * sizeof(uint32_t));
    tl_vertex_rings_release(&rings);
    assert_int_equal(tl_vertex_rings_bytes(&rings), 0);
    tl_triangle_ranges_release(&ranges);
    for (size_t s = 0; s < TL_COUNT(shapes); s++)
        test_shape_release(&shapes[s]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rings_are_what_triangles_say)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
