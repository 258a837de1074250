/* Borders of pieces: what a hand-made strip of two panels must have; and, for built-in garments, the listed
 * borders of every triangle against a search of all borders of its piece. */
#include "assets/topology/borders.h"

#include "assets/cut/garment_cut.h"
#include "assets/topology/pieces_internal.h"
#include "cloth/mesh/topology.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>
#include <string.h>
#include <time.h>

/* ---- Two panels ---- */

/* Panels of 0.2 x 0.1 m side by side with UVs half a metre apart, `cells` squares along each side; the second
 * is sewn to the first along x = 0.2. UV units are two metres. */
static tl_mesh make_panels(int cells)
{
    size_t row = (size_t)cells + 1, count = row * row;
    tl_mesh mesh = {.vertex_count = 2 * count, .index_count = (size_t)12 * (size_t)cells * (size_t)cells};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.uvs = TL_NEW_ARRAY(vec2s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, mesh.index_count);
    size_t next = 0;
    for (size_t p = 0; p < 2; p++) {
        for (size_t i = 0; i < count; i++) {
            const size_t column = i % row, line = i / row;
            float x = 0.2f * (float)column / (float)cells, y = 0.1f * (float)line / (float)cells;
            mesh.positions[p * count + i] = (vec3s){{x + 0.2f * (float)p, y, 0}};
            mesh.uvs[p * count + i] = (vec2s){{(x + 0.7f * (float)p) / 2, -y / 2}};
        }
        for (size_t i = 0; i < (size_t)cells * (size_t)cells; i++) {
            uint32_t a = (uint32_t)(p * count + i / (size_t)cells * row + i % (size_t)cells),
                     r = (uint32_t)row;
            const uint32_t square[] = {a, a + 1, a + r + 1, a, a + r + 1, a + r};
            memcpy(mesh.indices + next, square, sizeof square);
            next += 6;
        }
    }
    return mesh;
}

static double length_of_kind(const tl_borders *borders, enum tl_border_kind kind)
{
    double sum = 0;
    for (size_t i = 0; i < borders->border_count; i++) {
        const struct tl_border *b = &borders->borders[i];
        if (b->kind == (float)kind)
            sum += (double)(b->metres * hypotf(b->to[0] - b->from[0], b->to[1] - b->from[1]));
    }
    return sum;
}

static void test_two_panels(void **state)
{
    (void)state;
    tl_mesh mesh = make_panels(5);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh.vertex_count);
    tl_weld_positions(mesh.positions, mesh.vertex_count, weld);
    tl_borders borders = tl_borders_make(&mesh, NULL, weld, NULL, 0);
    assert_int_equal(borders.piece_count, 2);
    assert_true(borders.is_to_scale);
    assert_near(length_of_kind(&borders, TL_BORDER_SEAM_OVER), 0.1, 1e-5);
    assert_near(length_of_kind(&borders, TL_BORDER_SEAM_UNDER), 0.1, 1e-5);
    assert_near(length_of_kind(&borders, TL_BORDER_HEM), 2 * 0.5, 1e-5);
    for (size_t i = 0; i < borders.border_count; i++) {
        const struct tl_border *b = &borders.borders[i];
        bool first = b->from[0] < 0.2f;
        assert_near(b->metres, 2, 1e-5);
        if (b->kind != (float)TL_BORDER_HEM) /* the whole seam changes over from one panel to the other */
            assert_true((b->kind == (float)TL_BORDER_SEAM_OVER) == first);
        else /* straight: any hem fits */
            assert_true(b->widest_m > 0.5f);
        if (i > 0 && b->start_m > 0) { /* one border begins where the one before it ends */
            assert_near(b->from[0], b[-1].to[0], 0);
            assert_near(b->from[1], b[-1].to[1], 0);
            assert_near(b->start_m - b[-1].start_m,
                        b[-1].metres * hypotf(b[-1].to[0] - b[-1].from[0], b[-1].to[1] - b[-1].from[1]),
                        1e-6);
        }
    }
    tl_borders_release(&borders);
    free(weld);
    tl_mesh_release(&mesh);
}

/* The same panels apart, which a list of seams joins. */
static void test_seams_join(void **state)
{
    (void)state;
    const int cells = 4;
    const uint32_t row = 5, count = 25;
    tl_mesh mesh = make_panels(cells);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh.vertex_count);
    struct tl_seam_pair seams[5];
    for (uint32_t i = 0; i < row; i++)
        seams[i] = (struct tl_seam_pair){i * row + row - 1, count + i * row};
    for (uint32_t i = 0; i < mesh.vertex_count; i++)
        weld[i] = i;
    tl_borders separate = tl_borders_make(&mesh, NULL, weld, NULL, 0);
    tl_borders sewn = tl_borders_make(&mesh, NULL, weld, seams, row);
    assert_near(length_of_kind(&separate, TL_BORDER_HEM), 1.2, 1e-5);
    assert_near(length_of_kind(&sewn, TL_BORDER_HEM), 1.0, 1e-5);
    assert_near(length_of_kind(&sewn, TL_BORDER_SEAM_OVER), 0.1, 1e-5);
    tl_borders_release(&separate);
    tl_borders_release(&sewn);
    free(weld);
    tl_mesh_release(&mesh);
}

/* ---- Garments ---- */

static vec2s end_of(const struct tl_border *border, int end)
{
    const float *p = end ? border->to : border->from;
    return glms_vec2_scale((vec2s){{p[0], p[1]}}, border->metres);
}

static vec2s nearest_point(vec2s p, const struct tl_border *border)
{
    vec2s a = end_of(border, 0), along = glms_vec2_sub(end_of(border, 1), a);
    float share = glms_vec2_dot(glms_vec2_sub(p, a), along) / fmaxf(glms_vec2_norm2(along), 1e-20f);
    return glms_vec2_add(a, glms_vec2_scale(along, fminf(fmaxf(share, 0), 1)));
}

/* Seams, hems and darts are looked for apart. */
enum { CLASSES = 3, DART = 2 };
static int class_of(const struct tl_border *border)
{
    static const int classes[TL_BORDER_KINDS] = {[TL_BORDER_HEM] = 1, [TL_BORDER_DART] = DART};
    return classes[(int)border->kind];
}

/* Which side of a line from a to b a point lies on. */
static float side(vec2s a, vec2s b, vec2s p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/* Borders of all pieces with the piece of each. */
struct all_borders {
    const tl_borders *borders;
    const uint32_t *pieces; /* [border_count] */
};

/* The nearest border of a piece to p (metres) of a class: its distance, and whether the way there
 * crosses no other border. */
static float search_all(const struct all_borders *all, uint32_t piece, int class, vec2s p, bool *is_clear)
{
    float nearest = INFINITY;
    vec2s foot = p;
    size_t found = 0;
    for (size_t i = 0; i < all->borders->border_count; i++) {
        const struct tl_border *border = &all->borders->borders[i];
        if (all->pieces[i] != piece || class_of(border) != class)
            continue;
        vec2s q = nearest_point(p, border);
        float distance = glms_vec2_distance(p, q);
        if (distance < nearest) {
            nearest = distance;
            foot = q;
            found = i;
        }
    }
    *is_clear = isfinite(nearest);
    for (size_t i = 0; i < all->borders->border_count && *is_clear; i++) {
        const struct tl_border *border = &all->borders->borders[i];
        if (i == found || all->pieces[i] != piece)
            continue;
        vec2s a = end_of(border, 0), b = end_of(border, 1);
        const float margin = 1e-9f; /* ways that pass within a hair of a corner count as crossing it */
        if (side(p, foot, a) * side(p, foot, b) <= margin && side(a, b, p) * side(a, b, foot) <= 0)
            *is_clear = false;
    }
    return nearest;
}

static float search_listed(const tl_borders *borders, uint32_t triangle, int class, vec2s p)
{
    float nearest = INFINITY;
    for (uint32_t k = borders->firsts[triangle]; k < borders->firsts[triangle + 1]; k++) {
        const struct tl_border *border = &borders->borders[borders->near[k]];
        if (class_of(border) == class)
            nearest = fminf(nearest, glms_vec2_distance(p, nearest_point(p, border)));
    }
    return nearest;
}

/* Where one leg of a dart turns back as the other. */
static bool is_tip(const tl_borders *borders, size_t i)
{
    const struct tl_border *a = &borders->borders[i], *b = a + 1;
    vec2s along = glms_vec2_sub(end_of(a, 1), end_of(a, 0)), on = glms_vec2_sub(end_of(b, 1), end_of(b, 0));
    return class_of(a) == DART && class_of(b) == DART && glms_vec2_dot(along, on) < 0;
}

static double cpu_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static uint32_t *weld_of(const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    for (uint32_t i = 0; garment->welds_seams_only && i < mesh->vertex_count; i++)
        weld[i] = i;
    return weld;
}

/* The piece of each border, found from its sides as tl_borders_make does. */
static uint32_t *pieces_of_borders(const tl_mesh *mesh, const struct tl_pieces *pieces,
                                   const tl_borders *borders)
{
    uint32_t *found = TL_NEW_ARRAY(uint32_t, borders->border_count);
    for (uint32_t s = 0; s < mesh->index_count; s++) {
        if (pieces->across[s] != TL_NO_BORDER)
            continue;
        vec2s a = mesh->uvs[mesh->indices[s]], b = mesh->uvs[mesh->indices[s - s % 3 + (s % 3 + 1) % 3]];
        for (size_t i = 0; i < borders->border_count; i++) {
            const struct tl_border *border = &borders->borders[i];
            if (border->from[0] == a.x && border->from[1] == a.y && border->to[0] == b.x &&
                border->to[1] == b.y)
                found[i] = pieces->pieces[s / 3];
        }
    }
    return found;
}

static void check_garment(const char *name, float edge_m, size_t dart_tips)
{
    tl_garment garment;
    tl_error error;
    assert_ok(tl_garment_cut(name, edge_m, &garment, &error), error);
    const tl_mesh *mesh = &garment.model.mesh;
    uint32_t *weld = weld_of(&garment);
    double start = cpu_seconds();
    tl_borders borders = tl_borders_make(mesh, garment.pattern, weld, garment.seams, garment.seam_count);
    double took = cpu_seconds() - start;
    struct tl_pieces pieces = tl_pieces_find(mesh, garment.pattern, weld, garment.seams, garment.seam_count);
    uint32_t *of_borders = pieces_of_borders(mesh, &pieces, &borders);
    const struct all_borders all = {&borders, of_borders};
    size_t checked = 0, clear = 0, longest = 0;
    uint32_t seed = 1;
    for (uint32_t t = 0; t < borders.triangle_count; t += 3) {
        float weights[2];
        for (int i = 0; i < 2; i++) {
            seed = seed * 1664525u + 1013904223u;
            weights[i] = (float)(seed >> 8) / 16777216.0f;
        }
        if (weights[0] + weights[1] > 1) {
            weights[0] = 1 - weights[0];
            weights[1] = 1 - weights[1];
        }
        const uint32_t *v = &mesh->indices[3 * (size_t)t];
        vec2s a = mesh->uvs[v[0]], b = mesh->uvs[v[1]], c = mesh->uvs[v[2]];
        vec2s p = glms_vec2_add(a, glms_vec2_add(glms_vec2_scale(glms_vec2_sub(b, a), weights[0]),
                                                 glms_vec2_scale(glms_vec2_sub(c, a), weights[1])));
        p = glms_vec2_scale(p, pieces.metres[pieces.pieces[t]]);
        for (int class = 0; class < CLASSES; class ++) {
            bool is_clear;
            float expected = search_all(&all, pieces.pieces[t], class, p, &is_clear);
            float listed = search_listed(&borders, t, class, p);
            assert_true(listed >= expected - 1e-6f);
            if (is_clear && expected < TL_BORDER_REACH_M) {
                assert_near(listed, expected, 1e-6);
                clear++;
            }
            checked++;
        }
        size_t length = borders.firsts[t + 1] - borders.firsts[t];
        longest = length > longest ? length : longest;
    }
    printf("%s, %zu triangles, %zu pieces, %zu borders: %.1f ms, %zu kB, at most %zu a triangle; %zu of %zu "
           "searches near\n",
           name, borders.triangle_count, borders.piece_count, borders.border_count, 1e3 * took,
           tl_borders_bytes(&borders) / 1024, longest, clear, checked);
    assert_true(clear > checked / 20);
    /* what is over on one side is under on the other */
    assert_near(length_of_kind(&borders, TL_BORDER_SEAM_OVER), length_of_kind(&borders, TL_BORDER_SEAM_UNDER),
                0.02 * length_of_kind(&borders, TL_BORDER_SEAM_OVER));
    size_t tips = 0;
    for (size_t i = 0; i + 1 < borders.border_count; i++)
        tips += is_tip(&borders, i);
    assert_int_equal(tips, dart_tips);
    free(of_borders);
    tl_pieces_release(&pieces);
    tl_borders_release(&borders);
    free(weld);
    tl_garment_release(&garment);
}

static void test_lists_hold_the_nearest(void **state)
{
    (void)state;
    check_garment("dress", 0.02f, 2);
    check_garment("trousers", 0.02f, 4);
    check_garment("shirt", 0.02f, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_two_panels), cmocka_unit_test(test_seams_join),
                                       cmocka_unit_test(test_lists_hold_the_nearest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
