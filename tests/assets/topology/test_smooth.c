/* Loop's surface against what it must be: plain repeated refinement written out here, which converges to it;
 * planes, of which it reproduces linear functions; the closed form of cubic B-splines along creases; and
 * seams, which stay closed. */
#include "assets/topology/smooth.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAXIMUM 40000 /* vertices and triangles of the oracle */

/* A mesh that is refined by search: slow and short. creases[a][b] as a list of pairs. */
struct plain {
    size_t vertex_count, triangle_count, crease_count;
    vec3s *places;
    uint32_t (*triangles)[3];
    uint32_t (*creases)[2];
};

static struct plain plain_make(const vec3s *places, size_t vertex_count, const uint32_t (*triangles)[3],
                               size_t triangle_count, const uint32_t (*creases)[2], size_t crease_count)
{
    struct plain mesh = {vertex_count,
                         triangle_count,
                         crease_count,
                         tl_alloc(MAXIMUM, sizeof(vec3s)),
                         tl_alloc(MAXIMUM, sizeof *mesh.triangles),
                         tl_alloc(MAXIMUM, sizeof *mesh.creases)};
    memcpy(mesh.places, places, vertex_count * sizeof *places);
    memcpy(mesh.triangles, triangles, triangle_count * sizeof *triangles);
    if (crease_count > 0)
        memcpy(mesh.creases, creases, crease_count * sizeof *creases);
    return mesh;
}

static void plain_release(struct plain *mesh)
{
    free(mesh->places);
    free(mesh->triangles);
    free(mesh->creases);
}

static bool is_crease(const struct plain *mesh, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < mesh->crease_count; i++)
        if ((mesh->creases[i][0] == a && mesh->creases[i][1] == b) ||
            (mesh->creases[i][0] == b && mesh->creases[i][1] == a))
            return true;
    return false;
}

/* One step of Loop's rules as published, on a closed mesh in which every crease is a closed line. */
static void plain_refine(struct plain *mesh)
{
    size_t edges = 0, old = mesh->vertex_count;
    uint32_t(*ends)[2] = tl_alloc(MAXIMUM, sizeof *ends), (*corners)[3] = tl_alloc(MAXIMUM, sizeof *corners);
    vec3s *places = tl_alloc(MAXIMUM, sizeof *places);
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = mesh->triangles[t][k], b = mesh->triangles[t][(k + 1) % 3];
            size_t e = 0;
            while (e < edges &&
                   !((ends[e][0] == a && ends[e][1] == b) || (ends[e][0] == b && ends[e][1] == a)))
                e++;
            if (e == edges) {
                ends[edges][0] = a;
                ends[edges++][1] = b;
                places[old + e] = (vec3s){{0, 0, 0}};
            }
            corners[t][k] = (uint32_t)(old + e);
            vec3s far = mesh->places[mesh->triangles[t][(k + 2) % 3]];
            if (!is_crease(mesh, a, b)) /* each of the two triangles adds its far corner */
                places[old + e] = glms_vec3_add(places[old + e], glms_vec3_scale(far, 1.0f / 8));
        }
    for (size_t e = 0; e < edges; e++)
        for (int k = 0; k < 2; k++)
            places[old + e] = glms_vec3_add(
                places[old + e], glms_vec3_scale(mesh->places[ends[e][k]],
                                                 is_crease(mesh, ends[e][0], ends[e][1]) ? 0.5f : 0.375f));
    for (uint32_t v = 0; v < old; v++) {
        size_t n = 0, creases = 0;
        vec3s sum = {{0, 0, 0}}, along = sum;
        for (size_t e = 0; e < edges; e++)
            for (int k = 0; k < 2; k++)
                if (ends[e][k] == v) {
                    vec3s other = mesh->places[ends[e][1 - k]];
                    n++;
                    sum = glms_vec3_add(sum, other);
                    if (is_crease(mesh, v, ends[e][1 - k])) {
                        creases++;
                        along = glms_vec3_add(along, other);
                    }
                }
        double c = 0.375 + 0.25 * cos(2 * M_PI / (double)n), beta = (0.625 - c * c) / (double)n;
        places[v] =
            creases == 2
                ? glms_vec3_add(glms_vec3_scale(mesh->places[v], 0.75f), glms_vec3_scale(along, 0.125f))
                : glms_vec3_add(glms_vec3_scale(mesh->places[v], (float)(1 - (double)n * beta)),
                                glms_vec3_scale(sum, (float)beta));
    }
    size_t crease_count = mesh->crease_count;
    for (size_t i = 0; i < crease_count; i++)
        for (size_t e = 0; e < edges; e++) {
            uint32_t a = mesh->creases[i][0], b = mesh->creases[i][1], m = (uint32_t)(old + e);
            if ((ends[e][0] == a && ends[e][1] == b) || (ends[e][0] == b && ends[e][1] == a)) {
                mesh->creases[i][1] = m;
                mesh->creases[mesh->crease_count][0] = m;
                mesh->creases[mesh->crease_count++][1] = b;
                break;
            }
        }
    size_t triangle_count = mesh->triangle_count;
    for (size_t t = 0; t < triangle_count; t++) {
        uint32_t v[3], e[3];
        memcpy(v, mesh->triangles[t], sizeof v);
        memcpy(e, corners[t], sizeof e); /* e[k]: between corners k and k + 1 */
        const uint32_t children[4][3] = {
            {v[0], e[0], e[2]}, {v[1], e[1], e[0]}, {v[2], e[2], e[1]}, {e[0], e[1], e[2]}};
        memcpy(mesh->triangles[t], children[3], sizeof children[3]);
        for (int k = 0; k < 3; k++)
            memcpy(mesh->triangles[mesh->triangle_count++], children[k], sizeof children[k]);
    }
    memcpy(mesh->places, places, (old + edges) * sizeof *places);
    mesh->vertex_count = old + edges;
    free(ends);
    free(corners);
    free(places);
}

static struct tl_smooth smooth_of(const struct plain *mesh)
{
    bool(*creases)[3] = tl_alloc(mesh->triangle_count, sizeof *creases);
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            creases[t][k] = is_crease(mesh, mesh->triangles[t][(k + 1) % 3], mesh->triangles[t][(k + 2) % 3]);
    const struct tl_smooth_source source = {mesh->vertex_count, mesh->triangle_count,
                                            (const uint32_t(*)[3])mesh->triangles, (const bool(*)[3])creases};
    struct tl_smooth smooth = tl_smooth_make(&source);
    free(creases);
    return smooth;
}

static const vec3s cube_places[8] = {{{-1, -1, -1}}, {{1, -1, -1}}, {{1, 1, -1}}, {{-1, 1, -1}},
                                     {{-1, -1, 1}},  {{1, -1, 1}},  {{1, 1, 1}},  {{-1, 1, 1}}};
static const uint32_t cube[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                     {2, 3, 7}, {2, 7, 6}, {0, 4, 7}, {0, 7, 3}, {1, 2, 6}, {1, 6, 5}};
static const uint32_t lid[4][2] = {{4, 5}, {5, 6}, {6, 7}, {7, 4}};

/* After k further steps a vertex is 2^-2k or nearer to the limit: its neighbours are 2^-k apart, on a smooth
 * surface. */
static void the_limit_is_that_of_endless_refinement(void **state)
{
    (void)state;
    for (int creased = 0; creased < 2; creased++) {
        struct plain mesh = plain_make(cube_places, 8, cube, 12, lid, creased ? 4 : 0);
        struct tl_smooth smooth = smooth_of(&mesh);
        assert_int_equal(smooth.vertex_count, 8 + 18);
        assert_int_equal(smooth.triangle_count, 48);
        vec3s limit[26];
        tl_smooth_apply(&smooth, cube_places, limit);
        double errors[5] = {0};
        for (int step = 1; step < 5; step++) {
            plain_refine(&mesh); /* keeps the numbers of the vertices that are there */
            for (size_t v = 0; v < 8; v++)
                errors[step] = fmax(errors[step], (double)glms_vec3_distance(mesh.places[v], limit[v]));
            if (step == 1) /* the edges' vertices, found by their ends */
                continue;
        }
        print_message("%s: %.5f %.5f %.5f %.5f m off after 1 to 4 steps\n", creased ? "creased" : "smooth",
                      errors[1], errors[2], errors[3], errors[4]);
        assert_true(errors[4] < 0.01);
        for (int step = 2; step < 5; step++)
            assert_true(errors[step] < 0.45 * errors[step - 1]);
        plain_release(&mesh);
        tl_smooth_release(&smooth);
    }
}

/* The new vertices lie on the same surface: those of a mesh that was refined once are its vertices. */
static void new_vertices_lie_on_the_same_surface(void **state)
{
    (void)state;
    for (int creased = 0; creased < 2; creased++) {
        struct plain mesh = plain_make(cube_places, 8, cube, 12, lid, creased ? 4 : 0);
        struct tl_smooth coarse = smooth_of(&mesh);
        vec3s limit[26], *finer = tl_alloc(MAXIMUM, sizeof *finer);
        tl_smooth_apply(&coarse, mesh.places, limit);
        plain_refine(&mesh);
        struct tl_smooth fine = smooth_of(&mesh);
        tl_smooth_apply(&fine, mesh.places, finer);
        for (size_t i = 0; i < 26; i++) { /* both have the same vertices, in an order of their own */
            float nearest = INFINITY;
            for (size_t k = 0; k < 26; k++)
                nearest = fminf(nearest, glms_vec3_distance(limit[i], finer[k]));
            assert_true(nearest < 1e-5f);
        }
        for (size_t i = 0; i < coarse.vertex_count; i++) {
            double sum = 0;
            for (size_t k = coarse.firsts[i]; k < coarse.firsts[i + 1]; k++) {
                assert_true(coarse.weights[k] > 0);
                sum += (double)coarse.weights[k];
            }
            assert_true(fabs(sum - 1) < 1e-6);
        }
        free(finer);
        tl_smooth_release(&coarse);
        tl_smooth_release(&fine);
        plain_release(&mesh);
    }
}

/* A flat sheet of n x n squares: inside it stays where it is; its border is a B-spline, (1 4 1) / 6 at its
 * vertices and (1 23 23 1) / 48 between two of them; its corners stay. */
static void borders_are_splines_and_planes_stay(void **state)
{
    (void)state;
    enum { N = 6, SIDE = N + 1 };
    vec3s places[SIDE * SIDE];
    uint32_t triangles[2 * N * N][3];
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            float wave = j == 0 ? 0.1f * (float)((i * i) % 5) : 0; /* the lower border's height */
            places[j * SIDE + i] = (vec3s){{(float)i, (float)j, wave}};
        }
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            uint32_t a = (uint32_t)(j * SIDE + i), b = a + 1, d = a + SIDE, c = d + 1;
            const uint32_t two[2][3] = {{a, b, c}, {a, c, d}};
            memcpy(triangles[2 * (j * N + i)], two, sizeof two);
        }
    struct tl_smooth smooth = tl_smooth_make(
        &(struct tl_smooth_source){SIDE * SIDE, 2 * N * N, (const uint32_t(*)[3])triangles, NULL});
    vec3s *fine = tl_alloc(smooth.vertex_count, sizeof *fine);
    tl_smooth_apply(&smooth, places, fine);
    for (int j = 2; j < N - 1; j++)
        for (int i = 2; i < N - 1; i++)
            assert_true(glms_vec3_distance(fine[j * SIDE + i], places[j * SIDE + i]) < 1e-5f);
    for (int i = 1; i < N; i++) {
        float expected = (places[i - 1].z + 4 * places[i].z + places[i + 1].z) / 6;
        assert_true(fabsf(fine[i].z - expected) < 1e-5f);
    }
    size_t middles = 0;
    for (size_t e = 0; e + smooth.source_count < smooth.vertex_count; e++) {
        uint32_t a = smooth.ends[e][0], b = smooth.ends[e][1];
        if (b != a + 1 || b >= N || a < 1)
            continue;
        float expected = (places[a - 1].z + 23 * places[a].z + 23 * places[b].z + places[b + 1].z) / 48;
        assert_true(fabsf(fine[smooth.source_count + e].z - expected) < 1e-5f);
        middles++;
    }
    assert_int_equal(middles, N - 2);
    assert_true(glms_vec3_distance(fine[N], places[N]) < 1e-6f); /* the corner with one triangle */
    free(fine);
    tl_smooth_release(&smooth);
}

/* Three leaves at one edge, and a triangle without an area: nothing tears, nothing is lost. */
static void any_triangles_stay_closed(void **state)
{
    (void)state;
    static const vec3s places[5] = {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{-1, 0, 1}}, {{-1, 0, -1}}};
    static const uint32_t leaves[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 0, 2}};
    struct tl_smooth smooth = tl_smooth_make(&(struct tl_smooth_source){5, 4, leaves, NULL});
    vec3s fine[16];
    assert_in_range(smooth.vertex_count, 5 + 7, 16);
    tl_smooth_apply(&smooth, places, fine);
    for (int leaf = 0; leaf < 3; leaf++) /* all have the same vertex in the middle of the shared edge */
        assert_int_equal(smooth.triangles[4 * leaf + 3][2], smooth.triangles[3][2]);
    assert_true(glms_vec3_distance(fine[smooth.triangles[3][2]], (vec3s){{0, 0.5f, 0}}) < 0.26f);
    for (size_t t = 12; t < 16; t++)
        assert_true(smooth.triangles[t][0] == smooth.triangles[t][1]);
    for (size_t i = 0; i < smooth.vertex_count; i++)
        assert_true(isfinite(fine[i].x) && isfinite(fine[i].y) && isfinite(fine[i].z));
    tl_smooth_release(&smooth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_limit_is_that_of_endless_refinement),
        cmocka_unit_test(new_vertices_lie_on_the_same_surface),
        cmocka_unit_test(borders_are_splines_and_planes_stay),
        cmocka_unit_test(any_triangles_stay_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
