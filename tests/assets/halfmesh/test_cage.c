/* Cages against what flat cloth must keep: areas, lengths, outlines, seams, pins, joints; the map against the
 * pattern; topology by brute force. */
#include "tests/testing.h"

#include "assets/halfmesh/halfmesh.h"

#include "config/base/memory.h"

#include <string.h>

/* A flat sheet of columns x rows squares, each cut along a diagonal that changes from one to the next; held
 * and seams are none at first. Its rest shapes are its corners' places. */
struct cloth {
    size_t vertex_count, triangle_count;
    double (*places)[2];
    uint32_t (*triangles)[3];
    float (*rest)[3][2];
    bool (*seams)[3];
    bool *held;
};

static struct cloth make_sheet(int columns, int rows, double width, double height)
{
    struct cloth cloth = {.vertex_count = (size_t)((columns + 1) * (rows + 1)),
                          .triangle_count = (size_t)(2 * columns * rows)};
    cloth.places = tl_alloc(cloth.vertex_count, sizeof *cloth.places);
    cloth.triangles = tl_alloc(cloth.triangle_count, sizeof *cloth.triangles);
    cloth.rest = tl_alloc(cloth.triangle_count, sizeof *cloth.rest);
    cloth.seams = tl_alloc(cloth.triangle_count, sizeof *cloth.seams);
    cloth.held = TL_NEW_ARRAY(bool, cloth.vertex_count);
    size_t next = 0;
    for (int row = 0; row <= rows; row++)
        for (int column = 0; column <= columns; column++) {
            double *place = cloth.places[row * (columns + 1) + column];
            place[0] = width * column / columns;
            place[1] = height * row / rows;
        }
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            uint32_t a = (uint32_t)(row * (columns + 1) + column), b = a + 1, d = a + (uint32_t)columns + 1,
                     c = d + 1;
            const uint32_t one[6] = {a, b, c, a, c, d}, other[6] = {a, b, d, b, c, d};
            memcpy(cloth.triangles[next], (row + column) % 2 ? one : other, sizeof one);
            next += 2;
        }
    for (size_t t = 0; t < cloth.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 2; c++)
                cloth.rest[t][k][c] = (float)cloth.places[cloth.triangles[t][k]][c];
    return cloth;
}

static void release_cloth(struct cloth *cloth)
{
    free(cloth->places);
    free(cloth->triangles);
    free(cloth->rest);
    free(cloth->seams);
    free(cloth->held);
}

static struct tl_cage cage_of(const struct cloth *cloth, size_t vertex_target)
{
    const struct tl_cage_source source = {.vertex_count = cloth->vertex_count,
                                          .triangle_count = cloth->triangle_count,
                                          .triangles = (const uint32_t(*)[3])cloth->triangles,
                                          .rest = (const float(*)[3][2])cloth->rest,
                                          .seams = (const bool(*)[3])cloth->seams,
                                          .held = cloth->held};
    struct tl_cage cage;
    assert_true(tl_cage_make(&source, vertex_target, &cage));
    return cage;
}

static double signed_area(const float rest[3][2])
{
    return 0.5 * ((double)(rest[1][0] - rest[0][0]) * (double)(rest[2][1] - rest[0][1]) -
                  (double)(rest[2][0] - rest[0][0]) * (double)(rest[1][1] - rest[0][1]));
}

static double area_of(const float (*rest)[3][2], size_t count)
{
    double area = 0;
    for (size_t t = 0; t < count; t++)
        area += signed_area(rest[t]);
    return area;
}

static double rest_length(const float rest[3][2], int a, int b)
{
    return hypot((double)(rest[a][0] - rest[b][0]), (double)(rest[a][1] - rest[b][1]));
}

/* How many triangles have both vertices. */
static size_t users_of(const struct tl_cage *cage, uint32_t a, uint32_t b)
{
    size_t users = 0;
    for (size_t t = 0; t < cage->triangle_count; t++) {
        int found = 0;
        for (int k = 0; k < 3; k++)
            found += cage->triangles[t][k] == a || cage->triangles[t][k] == b;
        users += found == 2;
    }
    return users;
}

/* Edges with one triangle, by brute force; fails on an edge with more than two. */
static size_t border_edges(const struct tl_cage *cage)
{
    size_t border = 0;
    for (size_t t = 0; t < cage->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            size_t users = users_of(cage, cage->triangles[t][k], cage->triangles[t][(k + 1) % 3]);
            assert_true(users == 1 || users == 2);
            border += users == 1;
        }
    return border;
}

/* V - E + F: 1 for a disc, 0 for a tube. */
static long euler(const struct tl_cage *cage)
{
    return (long)cage->vertex_count - (long)(3 * cage->triangle_count + border_edges(cage)) / 2 +
           (long)cage->triangle_count;
}

/* The place of a point of the map among the cage's corners, by their places in the cloth. */
static void place_of(const struct cloth *cloth, const struct tl_cage *cage, size_t vertex, double out[2])
{
    const struct tl_cage_point *point = &cage->points[vertex];
    out[0] = out[1] = 0;
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++)
            out[c] +=
                point->weights[k] * cloth->places[cage->vertices[cage->triangles[point->triangle][k]]][c];
}

/* The sides of every triangle at rest are as long as between the corners' places: rest shapes stay those of
 * the cloth. `tolerance`: metres. */
static void check_lengths(const struct cloth *cloth, const struct tl_cage *cage, double tolerance)
{
    for (size_t t = 0; t < cage->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const double *a = cloth->places[cage->vertices[cage->triangles[t][k]]];
            const double *b = cloth->places[cage->vertices[cage->triangles[t][(k + 1) % 3]]];
            assert_near(rest_length((const float(*)[2])cage->rest[t], k, (k + 1) % 3),
                        hypot(a[0] - b[0], a[1] - b[1]), tolerance);
        }
}

static void test_sheet(void **state)
{
    (void)state;
    struct cloth cloth = make_sheet(24, 30, 0.8, 1);
    struct tl_cage cage = cage_of(&cloth, 60);
    assert_int_equal(cage.vertex_count, 60);
    assert_int_equal(cage.refused, 0);
    assert_int_equal(euler(&cage), 1);
    assert_near(area_of((const float(*)[3][2])cage.rest, cage.triangle_count), 0.8, 1e-6);
    check_lengths(&cloth, &cage, 1e-6);
    const uint32_t corners[4] = {0, 24, 30 * 25, 31 * 25 - 1};
    for (int i = 0; i < 4; i++) { /* a corner is a vertex of its own triangle still */
        const struct tl_cage_point *point = &cage.points[corners[i]];
        assert_near(fmax(point->weights[0], fmax(point->weights[1], point->weights[2])), 1, 0);
    }
    for (size_t v = 0; v < cloth.vertex_count; v++) {
        double place[2];
        const double *weights = cage.points[v].weights;
        place_of(&cloth, &cage, v, place);
        assert_near(place[0], cloth.places[v][0], 1e-6);
        assert_near(place[1], cloth.places[v][1], 1e-6);
        assert_near(weights[0] + weights[1] + weights[2], 1, 1e-12);
        assert_true(fmin(weights[0], fmin(weights[1], weights[2])) > -1e-6); /* straight borders */
    }
    /* Needles would make a stiff cage: height to longest side. */
    for (size_t t = 0; t < cage.triangle_count; t++) {
        double longest = 0;
        for (int k = 0; k < 3; k++)
            longest = fmax(longest, rest_length((const float(*)[2])cage.rest[t], k, (k + 1) % 3));
        assert_true(2 * signed_area((const float(*)[2])cage.rest[t]) > 0.14 * longest * longest);
        assert_true(longest < 2 * sqrt(2 / sqrt(3) * 0.8 / 60));
    }
    tl_cage_release(&cage);
    release_cloth(&cloth);
}

/* Every triangle's frame turned by an angle of its own, as the frames of a garment without a pattern differ:
 * lengths are the same, and the weft's direction is the mean of those around. */
static void test_frames(void **state)
{
    (void)state;
    struct cloth cloth = make_sheet(20, 20, 1, 1);
    for (size_t t = 0; t < cloth.triangle_count; t++) {
        double angle = 0.5 + 0.02 * sin(12.9898 * (double)t), c = cos(angle), s = sin(angle);
        for (int k = 0; k < 3; k++) {
            float x = cloth.rest[t][k][0], y = cloth.rest[t][k][1];
            cloth.rest[t][k][0] = (float)(c * (double)x - s * (double)y) + 0.01f * (float)t;
            cloth.rest[t][k][1] = (float)(s * (double)x + c * (double)y);
        }
    }
    struct tl_cage cage = cage_of(&cloth, 50);
    check_lengths(&cloth, &cage, 1e-5); /* rounding of floats up to 8, a few times over */
    for (size_t t = 0; t < cage.triangle_count; t++) {
        const uint32_t *v = cage.triangles[t];
        const double *a = cloth.places[cage.vertices[v[0]]], *b = cloth.places[cage.vertices[v[1]]];
        double turn = atan2((double)(cage.rest[t][1][1] - cage.rest[t][0][1]),
                            (double)(cage.rest[t][1][0] - cage.rest[t][0][0])) -
                      atan2(b[1] - a[1], b[0] - a[0]);
        assert_near(cos(turn - 0.5), 1, 0.03 * 0.03 / 2);
    }
    tl_cage_release(&cage);
    release_cloth(&cloth);
}

/* A mirrored pattern (the left half of a garment as it is often written) keeps its handedness. */
static void test_mirrored(void **state)
{
    (void)state;
    struct cloth cloth = make_sheet(20, 20, 1, 1);
    for (size_t t = 0; t < cloth.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            cloth.rest[t][k][0] = -cloth.rest[t][k][0];
    struct tl_cage cage = cage_of(&cloth, 50);
    assert_int_equal(cage.vertex_count, 50);
    assert_near(area_of((const float(*)[3][2])cage.rest, cage.triangle_count), -1, 1e-6);
    for (size_t t = 0; t < cage.triangle_count; t++)
        assert_true(signed_area((const float(*)[2])cage.rest[t]) < 0);
    check_lengths(&cloth, &cage, 1e-6);
    tl_cage_release(&cage);
    release_cloth(&cloth);
}

/* A seam down the middle: what lies on one side stays there, and the seam remains a chain of edges. */
static void test_seam(void **state)
{
    (void)state;
    struct cloth cloth = make_sheet(20, 20, 1, 1);
    for (size_t t = 0; t < cloth.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            cloth.seams[t][k] =
                cloth.triangles[t][(k + 1) % 3] % 21 == 10 && cloth.triangles[t][(k + 2) % 3] % 21 == 10;
    struct tl_cage cage = cage_of(&cloth, 40);
    size_t on_seam = 0;
    for (size_t i = 0; i < cage.vertex_count; i++)
        on_seam += cage.vertices[i] % 21 == 10;
    assert_in_range(on_seam, 2, 12);
    double left = 0;
    for (size_t t = 0; t < cage.triangle_count; t++) {
        int sides[3] = {0};
        for (int k = 0; k < 3; k++) {
            uint32_t column = cage.vertices[cage.triangles[t][k]] % 21;
            sides[(column > 10) - (column < 10) + 1]++;
        }
        assert_true(sides[0] == 0 || sides[2] == 0);
        left += sides[0] > 0 ? signed_area((const float(*)[2])cage.rest[t]) : 0;
    }
    assert_near(left, 0.5, 1e-6);
    for (uint32_t v = 0; v < cloth.vertex_count; v++) {
        double place[2];
        place_of(&cloth, &cage, v, place);
        assert_near(place[0], cloth.places[v][0], 1e-6);
    }
    tl_cage_release(&cage);
    release_cloth(&cloth);
}

/* Held vertices: one within the cloth stays, and a held border is joined to held vertices only. */
static void test_held(void **state)
{
    (void)state;
    struct cloth cloth = make_sheet(20, 20, 1, 1);
    cloth.held[10 * 21 + 10] = true;
    for (size_t i = 0; i < 21; i++)
        cloth.held[(size_t)20 * 21 + i] = true;
    struct tl_cage cage = cage_of(&cloth, 40);
    size_t held = 0;
    bool middle = false;
    for (size_t i = 0; i < cage.vertex_count; i++) {
        held += cloth.held[cage.vertices[i]];
        middle |= cage.vertices[i] == 10 * 21 + 10;
    }
    assert_true(middle);
    assert_in_range(held, 3, 12);
    tl_cage_release(&cage);
    release_cloth(&cloth);
}

/* A tube, closed by its topology: its rest lengths are those of the flat sheet although its corners lie on a
 * cylinder, where their distances are chords. */
static void test_tube(void **state)
{
    (void)state;
    enum { AROUND = 40, ALONG = 30 };
    struct cloth cloth = make_sheet(AROUND, ALONG, 1, 1);
    for (size_t t = 0; t < cloth.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (cloth.triangles[t][k] % (AROUND + 1) == AROUND)
                cloth.triangles[t][k] -= AROUND;
    struct tl_cage cage = cage_of(&cloth, 80);
    assert_int_equal(cage.vertex_count, 80);
    assert_int_equal(euler(&cage), 0);
    assert_near(area_of((const float(*)[3][2])cage.rest, cage.triangle_count), 1, 1e-5);
    double rims = 0;
    for (size_t t = 0; t < cage.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (users_of(&cage, cage.triangles[t][k], cage.triangles[t][(k + 1) % 3]) == 1)
                rims += rest_length((const float(*)[2])cage.rest[t], k, (k + 1) % 3);
    assert_near(rims, 2, 1e-5);
    tl_cage_release(&cage);
    release_cloth(&cloth);
}

/* Two layers that share no vertex, and a third that hangs on an edge of the first, which OpenMesh refuses:
 * all stay, and the third stays joined. */
static void test_layers(void **state)
{
    (void)state;
    struct cloth one = make_sheet(12, 12, 1, 1);
    struct cloth cloth = {.vertex_count = 2 * one.vertex_count + 1,
                          .triangle_count = 2 * one.triangle_count + 1};
    cloth.places = tl_alloc(cloth.vertex_count, sizeof *cloth.places);
    cloth.triangles = tl_alloc(cloth.triangle_count, sizeof *cloth.triangles);
    cloth.rest = tl_alloc(cloth.triangle_count, sizeof *cloth.rest);
    cloth.seams = tl_alloc(cloth.triangle_count, sizeof *cloth.seams);
    cloth.held = TL_NEW_ARRAY(bool, cloth.vertex_count);
    for (size_t t = 0; t < 2 * one.triangle_count; t++) {
        size_t layer = t / one.triangle_count;
        memcpy(cloth.rest[t], one.rest[t % one.triangle_count], sizeof cloth.rest[t]);
        for (int k = 0; k < 3; k++)
            cloth.triangles[t][k] =
                one.triangles[t % one.triangle_count][k] + (uint32_t)(layer * one.vertex_count);
    }
    const uint32_t flap[3] = {6 * 13 + 6, 6 * 13 + 7, (uint32_t)(2 * one.vertex_count)};
    const float shape[3][2] = {{0, 0}, {1.0f / 12, 0}, {0, 0.1f}};
    memcpy(cloth.triangles[2 * one.triangle_count], flap, sizeof flap);
    memcpy(cloth.rest[2 * one.triangle_count], shape, sizeof shape);
    struct tl_cage cage = cage_of(&cloth, 60);
    assert_int_equal(cage.refused, 1);
    assert_true(cage.vertex_count <= 62);
    size_t joined = 0;
    for (size_t t = 0; t < cage.triangle_count; t++) {
        int layers[3] = {0};
        for (int k = 0; k < 3; k++)
            layers[cage.vertices[cage.triangles[t][k]] / one.vertex_count]++;
        assert_true(layers[0] == 0 || layers[1] == 0);
        if (layers[2] == 1) {
            joined++;
            assert_int_equal(layers[0], 2);
        }
    }
    assert_int_equal(joined, 1);
    assert_near(area_of((const float(*)[3][2])cage.rest, cage.triangle_count), 2 + 0.05 / 12, 1e-5);
    tl_cage_release(&cage);
    release_cloth(&cloth);
    release_cloth(&one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sheet),  cmocka_unit_test(test_frames), cmocka_unit_test(test_mirrored),
        cmocka_unit_test(test_seam),   cmocka_unit_test(test_held),   cmocka_unit_test(test_tube),
        cmocka_unit_test(test_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
