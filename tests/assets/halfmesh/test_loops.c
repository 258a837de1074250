/* Boundary loops against meshes whose borders are known, and against a count of all sides. */
#include "tests/testing.h"

#include "assets/halfmesh/loops.h"

#include "config/base/memory.h"

#include <string.h>

enum { AROUND = 8, RINGS = 3 };

static struct tl_loops find(const uint32_t (*triangles)[3], size_t triangle_count, size_t vertex_count)
{
    const struct tl_loop_source source = {vertex_count, triangle_count, triangles};
    struct tl_loops loops;
    assert_true(tl_loops_find(&source, &loops));
    return loops;
}

static bool has_side(const uint32_t v[3], uint32_t from, uint32_t to)
{
    for (int k = 0; k < 3; k++)
        if (v[k] == from && v[(k + 1) % 3] == to)
            return true;
    return false;
}

/* Each side belongs to its triangle, which runs along it the other way, and to no other; loops are closed. */
static void check_sides(const struct tl_loops *loops, const uint32_t (*triangles)[3], size_t triangle_count)
{
    for (size_t l = 0; l < loops->count; l++)
        for (size_t i = loops->first[l]; i < loops->first[l + 1]; i++) {
            size_t after = i + 1 < loops->first[l + 1] ? i + 1 : loops->first[l];
            uint32_t from = loops->sides[i].from, to = loops->sides[after].from, users = 0;
            assert_true(has_side(triangles[loops->sides[i].triangle], to, from));
            for (size_t t = 0; t < triangle_count; t++)
                users += has_side(triangles[t], from, to) || has_side(triangles[t], to, from);
            assert_int_equal(users, 1);
        }
}

/* Sides with one triangle. */
static size_t count_sides(const uint32_t (*triangles)[3], size_t triangle_count)
{
    size_t count = 0;
    for (size_t i = 0; i < 3 * triangle_count; i++) {
        uint32_t from = triangles[i / 3][i % 3], to = triangles[i / 3][(i + 1) % 3], users = 0;
        for (size_t t = 0; t < triangle_count; t++)
            users += has_side(triangles[t], from, to) || has_side(triangles[t], to, from);
        count += users == 1;
    }
    return count;
}

/* A tube of two bands; outside is counter-clockwise. Vertex k of ring r is r * AROUND + k. */
static size_t make_tube(uint32_t (*triangles)[3])
{
    size_t count = 0;
    for (uint32_t ring = 0; ring + 1 < RINGS; ring++)
        for (uint32_t k = 0; k < AROUND; k++) {
            uint32_t next = (k + 1) % AROUND, a = ring * AROUND + k, b = ring * AROUND + next;
            uint32_t c = b + AROUND, d = a + AROUND;
            const uint32_t two[2][3] = {{a, b, c}, {a, c, d}};
            memcpy(triangles[count], two, sizeof two);
            count += 2;
        }
    return count;
}

static void a_tube_has_two(void **state)
{
    (void)state;
    uint32_t triangles[2 * AROUND * (RINGS - 1)][3];
    size_t count = make_tube(triangles);
    struct tl_loops loops = find((const uint32_t(*)[3])triangles, count, (size_t)AROUND * RINGS);
    assert_int_equal(loops.count, 2);
    assert_int_equal(loops.refused, 0);
    check_sides(&loops, (const uint32_t(*)[3])triangles, count);
    for (size_t l = 0; l < 2; l++) {
        assert_int_equal(loops.first[l + 1] - loops.first[l], AROUND);
        uint32_t ring = l == 0 ? 0 : RINGS - 1;
        for (size_t i = 0; i < AROUND; i++) { /* the lower one runs backwards, the upper one forwards */
            uint32_t step = l == 0 ? AROUND - 1 : 1, now = loops.sides[loops.first[l] + i].from;
            uint32_t next = loops.sides[loops.first[l] + (i + 1) % AROUND].from;
            assert_int_equal(now / AROUND, ring);
            assert_int_equal(next % AROUND, (now + step) % AROUND);
        }
    }
    tl_loops_release(&loops);
}

/* Fins at the tube's rings: sides with three triangles, which are no boundary; each fin has a loop's worth of
 * open sides, which lead from the fin's ends into nothing, or round. */
static void lines_with_three_faces(void **state)
{
    (void)state;
    enum { TUBE = 2 * AROUND * (RINGS - 1), FINS = 3 };
    uint32_t triangles[TUBE + FINS][3];
    size_t count = make_tube(triangles);
    for (uint32_t f = 0; f < FINS; f++) { /* at the middle ring, two neighbours and one apart */
        uint32_t k = f < 2 ? f : 5;
        const uint32_t fin[3] = {AROUND + k, AROUND + k + 1, AROUND * RINGS + f};
        memcpy(triangles[count++], fin, sizeof fin);
    }
    struct tl_loops loops = find((const uint32_t(*)[3])triangles, count, (size_t)AROUND * RINGS + FINS);
    assert_int_equal(loops.refused, FINS);
    check_sides(&loops, (const uint32_t(*)[3])triangles, count);
    assert_int_equal(loops.first[1] - loops.first[0], AROUND);
    assert_int_equal(loops.first[2] - loops.first[1], AROUND);
    tl_loops_release(&loops);
}

/* A fin that comes first takes a side of a triangle at the border, which is refused: the border leads along
 * its own side all the same, and not into the fin. */
static void borders_lead_along_refused_faces(void **state)
{
    (void)state;
    enum { TUBE = 2 * AROUND * (RINGS - 1) };
    uint32_t triangles[TUBE + 1][3] = {{AROUND + 3, 2, AROUND * RINGS}};
    make_tube(triangles + 1);
    struct tl_loops loops = find((const uint32_t(*)[3])triangles, TUBE + 1, (size_t)AROUND * RINGS + 1);
    assert_int_equal(loops.refused, 1);
    assert_int_equal(loops.count, 2);
    assert_int_equal(loops.first[1], AROUND);
    assert_int_equal(loops.first[2], 2 * AROUND);
    check_sides(&loops, (const uint32_t(*)[3])triangles, TUBE + 1);
    tl_loops_release(&loops);
}

static void loops_lead_past_refused_faces(void **state)
{
    (void)state;
    /* A disc of six triangles around vertex 0, one of which is wound the other way. */
    const uint32_t disc[][3] = {{0, 1, 2}, {0, 2, 3}, {0, 4, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 1}};
    struct tl_loops loops = find(disc, TL_COUNT(disc), 7);
    assert_true(loops.refused > 0);
    assert_int_equal(count_sides(disc, TL_COUNT(disc)), 6);
    check_sides(&loops, disc, TL_COUNT(disc));
    assert_int_equal(loops.count, 0); /* its sides do not run one way around: no loop is made up */
    tl_loops_release(&loops);

    /* The same disc, all one way, with a repeated face on vertices 0, 1 and 2: two sides are not boundary. */
    const uint32_t doubled[][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5},
                                   {0, 5, 6}, {0, 6, 1}, {0, 1, 7}};
    loops = find(doubled, TL_COUNT(doubled), 8);
    assert_int_equal(loops.refused, 1);
    assert_int_equal(loops.count, 1);
    assert_int_equal(loops.first[1], 6);
    check_sides(&loops, doubled, TL_COUNT(doubled));
    tl_loops_release(&loops);
}

/* Triangles in a row that share a vertex each with the next have a loop each. */
static void loops_that_touch_stay_apart(void **state)
{
    (void)state;
    const uint32_t row[][3] = {{0, 1, 2}, {2, 3, 4}, {4, 5, 6}};
    struct tl_loops loops = find(row, TL_COUNT(row), 7);
    assert_int_equal(loops.count, TL_COUNT(row));
    for (size_t l = 0; l < TL_COUNT(row); l++)
        assert_int_equal(loops.first[l + 1], 3 * (l + 1));
    check_sides(&loops, row, TL_COUNT(row));
    tl_loops_release(&loops);
}

/* Any list of triangles: nothing crashes, and what is called a loop is one. */
static void soups(void **state)
{
    (void)state;
    enum { VERTICES = 12, TRIANGLES = 30, SOUPS = 200 };
    uint32_t seed = 1;
    for (int soup = 0; soup < SOUPS; soup++) {
        uint32_t triangles[TRIANGLES][3];
        for (size_t t = 0; t < TRIANGLES;) {
            for (int k = 0; k < 3; k++) {
                seed = seed * 1664525u + 1013904223u;
                triangles[t][k] = (seed >> 16) % VERTICES;
            }
            t += triangles[t][0] != triangles[t][1] && triangles[t][1] != triangles[t][2] &&
                 triangles[t][2] != triangles[t][0];
        }
        struct tl_loops loops = find((const uint32_t(*)[3])triangles, TRIANGLES, VERTICES);
        check_sides(&loops, (const uint32_t(*)[3])triangles, TRIANGLES);
        tl_loops_release(&loops);
    }
    struct tl_loops none = find(NULL, 0, 0);
    assert_int_equal(none.count, 0);
    tl_loops_release(&none);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tube_has_two),
        cmocka_unit_test(lines_with_three_faces),
        cmocka_unit_test(borders_lead_along_refused_faces),
        cmocka_unit_test(loops_lead_past_refused_faces),
        cmocka_unit_test(loops_that_touch_stay_apart),
        cmocka_unit_test(soups),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
