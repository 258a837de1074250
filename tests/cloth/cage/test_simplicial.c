/* A fine grid that is turned against a coarse one: each of its triangles becomes a triangle, a side or a
 * corner of the coarse mesh, where it is much finer by the largest shares alone. */
#include "cloth/cage/simplicial.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

enum { COARSE = 12, SIDE = COARSE + 1, BONE_COUNT = SIDE * SIDE };

/* Two triangles a cell. */
static uint32_t *make_triangles(uint32_t cells, size_t *count)
{
    uint32_t *indices = TL_NEW_ARRAY(uint32_t, (size_t)6 * cells * cells);
    *count = 0;
    for (uint32_t row = 0; row < cells; row++)
        for (uint32_t column = 0; column < cells; column++) {
            const uint32_t a = row * (cells + 1) + column, c = a + cells + 2;
            const uint32_t corners[6] = {a, a + 1, c, a, c, c - 1};
            memcpy(indices + *count, corners, sizeof corners);
            *count += 6;
        }
    return indices;
}

/* The coarse triangle below a point of the plane, and its shares of the point. */
static void lie(double x, double y, uint32_t corners[3], double shares[3])
{
    const uint32_t left = (uint32_t)x, low = (uint32_t)y, a = low * SIDE + left;
    const double u = x - left, v = y - low;
    corners[0] = a, corners[1] = u > v ? a + 1 : a + SIDE, corners[2] = a + SIDE + 1;
    shares[0] = 1 - fmax(u, v), shares[1] = fabs(u - v), shares[2] = fmin(u, v);
}

/* Whether three bones are corners of one coarse triangle, by all of these. */
static bool are_of_one(const uint32_t *triangles, size_t count, const uint32_t bones[3])
{
    for (size_t t = 0; t < count; t += 3) {
        int found = 0;
        for (int k = 0; k < 3; k++)
            found += bones[k] == triangles[t] || bones[k] == triangles[t + 1] || bones[k] == triangles[t + 2];
        if (found == 3)
            return true;
    }
    return false;
}

/* A grid of `cells` a side, turned by 0.5 rad. Returns the number of its bad triangles, by brute force. */
static size_t map_grid(uint32_t cells)
{
    const uint32_t count = (cells + 1) * (cells + 1);
    size_t coarse_count, fine_count, bad = 0;
    uint32_t *coarse = make_triangles(COARSE, &coarse_count), *fine = make_triangles(cells, &fine_count);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, count), *map = TL_NEW_ARRAY(uint32_t, count);
    uint32_t(*corners)[3] = tl_alloc(count, sizeof *corners);
    double(*shares)[3] = tl_alloc(count, sizeof *shares);
    for (uint32_t i = 0; i < count; i++) {
        const double x = 7.0 * (i % (cells + 1)) / cells - 3.5, y = 7.0 * (i / (cells + 1)) / cells - 3.5;
        weld[i] = i;
        lie(COARSE / 2.0 + cos(0.5) * x - sin(0.5) * y, COARSE / 2.0 + sin(0.5) * x + cos(0.5) * y,
            corners[i], shares[i]);
    }
    struct tl_topology topology = tl_topology_build(fine, fine_count, weld, count, count);
    struct tl_fans fans = tl_fans_build(coarse, coarse_count, BONE_COUNT);
    const struct tl_skin_source source = {&topology, BONE_COUNT, (const uint32_t(*)[3])corners,
                                          (const double(*)[3])shares};
    const struct tl_coarse_mesh mesh = {(const uint32_t(*)[3])coarse, &fans};
    const size_t counted = tl_simplicial_map(&source, &mesh, map);
    for (size_t t = 0; t < fine_count; t += 3) {
        const uint32_t bones[3] = {map[fine[t]], map[fine[t + 1]], map[fine[t + 2]]};
        bad += !are_of_one(coarse, coarse_count, bones);
    }
    assert_int_equal(counted, bad);
    tl_fans_release(&fans);
    tl_topology_release(&topology);
    free(coarse);
    free(fine);
    free(weld);
    free(map);
    free(corners);
    free(shares);
    return bad;
}

static void triangles_become_one(void **state)
{
    (void)state;
    static const uint32_t cells[] = {60, 25, 16}; /* 8.6, 3.6 and 2.3 edges a coarse one */
    for (size_t i = 0; i < TL_COUNT(cells); i++) {
        const size_t bad = map_grid(cells[i]);
        print_message("%u cells: %zu bad\n", cells[i], bad);
        assert_int_equal(bad, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(triangles_become_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
