/* Crossings of a mesh by patches equal brute force over all pairs of triangles: where it is crumpled, where a
 * smooth sheet passes through itself, at a loop within a patch and its neighbours, and where only a part has
 * moved since. */
#include "cloth/cage/patches.h"
#include "config/base/memory.h"
#include "tests/cloth/crossing_oracle.h"
#include "tests/testing.h"

#include <omp.h>
#include <string.h>

enum { CELLS = 48, PER_PATCH = 4, COLUMNS = CELLS + 1, COUNT = COLUMNS * COLUMNS };
enum { PATCHES = CELLS / PER_PATCH, PATCH_COUNT = 2 * PATCHES * PATCHES };

struct sheet {
    struct tl_topology topology;
    struct tl_patches patches;
    vec3d *x;
};

/* Two triangles of patches a cell of the coarse grid, cut along the diagonal. */
static struct sheet make_sheet(void)
{
    const size_t triangle_count = (size_t)2 * CELLS * CELLS;
    uint32_t *indices = TL_NEW_ARRAY(uint32_t, 3 * triangle_count), *weld = TL_NEW_ARRAY(uint32_t, COUNT);
    uint32_t *patch_of = TL_NEW_ARRAY(uint32_t, triangle_count), (*corners)[3] = tl_alloc(PATCH_COUNT, 12);
    struct sheet sheet = {.x = TL_NEW_ARRAY(vec3d, COUNT)};
    for (uint32_t i = 0; i < COUNT; i++)
        weld[i] = i;
    for (uint32_t t = 0; t < triangle_count; t++) {
        const uint32_t cell = t / 2, row = cell / CELLS, column = cell % CELLS, a = row * COLUMNS + column;
        const uint32_t in_row = row % PER_PATCH, in_column = column % PER_PATCH;
        const bool upper = in_row > in_column || (in_row == in_column && t % 2 == 1);
        const uint32_t own[3] = {a, t % 2 == 0 ? a + 1 : a + COLUMNS + 1,
                                 t % 2 == 0 ? a + COLUMNS + 1 : a + COLUMNS};
        memcpy(indices + 3 * t, own, sizeof own);
        patch_of[t] = 2 * (row / PER_PATCH * PATCHES + column / PER_PATCH) + upper;
    }
    for (uint32_t patch = 0; patch < PATCH_COUNT; patch++) {
        const uint32_t cell = patch / 2, a = cell / PATCHES * (PATCHES + 1) + cell % PATCHES;
        const uint32_t own[3] = {a, patch % 2 == 0 ? a + 1 : a + PATCHES + 1, a + PATCHES + 2};
        memcpy(corners[patch], own, sizeof own);
    }
    sheet.topology = tl_topology_build(indices, 3 * triangle_count, weld, COUNT, COUNT);
    sheet.patches = tl_patches_make(&sheet.topology, patch_of, PATCH_COUNT, (const uint32_t(*)[3])corners);
    free(indices);
    free(weld);
    free(patch_of);
    free(corners);
    return sheet;
}

static void release(struct sheet *sheet)
{
    tl_topology_release(&sheet->topology);
    tl_patches_release(&sheet->patches);
    free(sheet->x);
}

static void place(struct sheet *sheet, vec3d (*at)(double u, double v))
{
    for (uint32_t i = 0; i < COUNT; i++)
        sheet->x[i] = vec3d_as_drawn(at((double)(i % COLUMNS) / CELLS, (double)(i / COLUMNS) / CELLS));
}

static void check(struct sheet *sheet, const char *name, const bool *changed, size_t at_min)
{
    struct tl_near_pairs pairs = {0};
    const size_t expected = oracle_crossings(&sheet->topology, sheet->x);
    tl_patches_crossings(&sheet->patches, &sheet->topology, sheet->x, &(struct tl_patch_marks){changed, NULL},
                         &pairs);
    print_message("%s: %zu crossing pairs\n", name, expected);
    assert_true(expected >= at_min);
    assert_int_equal(pairs.count, expected);
    tl_near_pairs_release(&pairs);
}

static double noise(double u, double v, double seed)
{
    const double n = sin(u * 127.1 + v * 311.7 + seed) * 43758.5453;
    return n - floor(n) - 0.5;
}

static vec3d crumpled(double u, double v)
{
    return (vec3d){u + 0.06 * noise(u, v, 1), v + 0.06 * noise(u, v, 2), 0.06 * noise(u, v, 3)};
}
static vec3d smooth(double u, double v)
{
    return (vec3d){u, v, 0.1 * sin(7 * u + 3 * v)};
}
/* A figure of eight: its branches face 90 degrees apart where they cross. */
static vec3d eight(double u, double v)
{
    const double t = 2 * M_PI * 0.97 * u + 0.3;
    return (vec3d){0.3 * sin(t), v + 0.013 * u, 0.3 * sin(t) * cos(t)};
}
/* A ring of more than one turn, slightly out of round: two layers that face alike pass through each other. */
static vec3d ring(double u, double v)
{
    const double t = 2 * M_PI * 1.3 * u, radius = 0.2 + 0.01 * sin(0.7 * t + 2.2);
    return (vec3d){radius * cos(t), v + 0.013 * u, radius * sin(t)};
}
/* A loop of about the size of a patch. */
static vec3d loop(double u, double v)
{
    const double t = (u - 0.47) * 30;
    const vec3d straight = {u, v + 0.1 * u, 0};
    const double share = exp(-t * t / 4);
    return vec3d_add(straight, (vec3d){-0.09 * t * share, 0, 0.06 * share});
}

/* Folded flat along a side of patches, and twisted, so that its halves pass through each other from the fold
 * on: patches that are flat, and neighbours. */
static vec3d folded(double u, double v)
{
    const double past = fmax(u - 0.5, 0);
    return (vec3d){u - 2 * past + 0.003 * v, v + 0.007 * past, 0.1 * past * (v - 0.513)};
}

static void crossings_equal_brute_force(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        vec3d (*at)(double u, double v);
        size_t at_min;
    } cases[] = {{"crumpled", crumpled, 100}, {"smooth", smooth, 0}, {"eight", eight, 40},
                 {"ring", ring, 40},          {"loop", loop, 40},    {"folded", folded, 10}};
    struct sheet sheet = make_sheet();
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        place(&sheet, cases[i].at);
        check(&sheet, cases[i].name, NULL, cases[i].at_min);
    }
    release(&sheet);
}

/* A corner of the sheet is put through its middle. */
static void what_has_changed_is_enough(void **state)
{
    (void)state;
    struct sheet sheet = make_sheet();
    bool changed[PATCH_COUNT] = {false};
    place(&sheet, smooth);
    check(&sheet, "before", NULL, 0);
    for (uint32_t row = 0; row <= 2 * PER_PATCH; row++)
        for (uint32_t column = 0; column <= 2 * PER_PATCH; column++)
            sheet.x[row * COLUMNS + column] =
                (vec3d){0.5 + 0.01 * row, 0.5 + 0.013 * column, -0.15 + 0.03 * (row + column)};
    for (uint32_t patch = 0; patch < PATCH_COUNT; patch++) /* and those with a side there */
        changed[patch] = patch / 2 / PATCHES <= 2 && patch / 2 % PATCHES <= 2;
    check(&sheet, "a corner moved", changed, 10);
    release(&sheet);
}

static void threads_make_no_difference(void **state)
{
    (void)state;
    const int threads = omp_get_max_threads();
    struct sheet sheet = make_sheet();
    struct tl_near_pairs pairs[2] = {{0}, {0}};
    place(&sheet, crumpled);
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(1 + 2 * i);
        tl_patches_crossings(&sheet.patches, &sheet.topology, sheet.x, &(struct tl_patch_marks){0},
                             &pairs[i]);
    }
    omp_set_num_threads(threads);
    assert_int_equal(pairs[0].count, pairs[1].count);
    assert_memory_equal(pairs[0].pairs, pairs[1].pairs, pairs[0].count * sizeof *pairs[0].pairs);
    tl_near_pairs_release(&pairs[0]);
    tl_near_pairs_release(&pairs[1]);
    release(&sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_equal_brute_force),
        cmocka_unit_test(what_has_changed_is_enough),
        cmocka_unit_test(threads_make_no_difference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
