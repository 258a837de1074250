/* Triangles that a picture may show, against every triangle at every sample in double: what is seen is kept,
 * what surely is not is left out, and the GPU draws the same picture from what is kept. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/gbuffer/samples.h"
#include "render/scene/view.h"

#include "tests/testing.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH  44
#define HEIGHT 32
#define BITS   8
/* Samples: further from an edge than this, and nobody's rounding matters. */
#define CLEAR (2.0 / (1 << BITS))

/* Depths: nearer to each other than this may be drawn in either order. */
#define ALIKE          1e-5
#define ALIKE_AT_EDGES 1e-4

/* Metres from the plane of the eye: rounding. */
#define ON_THE_PLANE 1e-6

enum { NOBODY = UINT32_MAX };

struct corner {
    double x, y, z, w;
};

static struct corner project(const struct tl_view *view, vec3s p, int width, int height)
{
    double clip[4];
    for (int r = 0; r < 4; r++)
        clip[r] = (double)view->view_projection.raw[0][r] * (double)p.x +
                  (double)view->view_projection.raw[1][r] * (double)p.y +
                  (double)view->view_projection.raw[2][r] * (double)p.z +
                  (double)view->view_projection.raw[3][r];
    return (struct corner){(0.5 + 0.5 * clip[0] / clip[3]) * width, (0.5 + 0.5 * clip[1] / clip[3]) * height,
                           0.5 + 0.5 * clip[2] / clip[3], clip[3]};
}

/* The least distance inwards from an edge's line: below 0 outside. */
static double inset(const struct corner c[3], double x, double y)
{
    double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    double minimum = INFINITY;
    for (int i = 0; i < 3; i++) {
        const struct corner *a = &c[i], *b = &c[(i + 1) % 3];
        double cross = (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
        minimum = fmin(minimum, (area < 0 ? -cross : cross) / hypot(b->x - a->x, b->y - a->y));
    }
    return minimum;
}

static double depth_at(const struct corner c[3], double x, double y)
{
    double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    double v = ((x - c[0].x) * (c[2].y - c[0].y) - (y - c[0].y) * (c[2].x - c[0].x)) / area;
    double w = ((c[1].x - c[0].x) * (y - c[0].y) - (c[1].y - c[0].y) * (x - c[0].x)) / area;
    return c[0].z + v * (c[1].z - c[0].z) + w * (c[2].z - c[0].z);
}

struct scene {
    const tl_surface *surfaces[2];
    size_t count;
    struct tl_view view;
    int width, height;
};

static struct scene scene_of(const tl_surface *a, const tl_surface *b, vec3s eye, vec3s target, int width,
                             int height)
{
    const struct tl_camera camera = {
        .eye = eye, .target = target, .up = {{0, 1, 0}}, .fov_y = 0.7f, .near_m = 0.02f, .far_m = 50};
    return (struct scene){{a, b}, b ? 2 : 1, tl_view_make(&camera, width, height), width, height};
}

static size_t triangles_of(const struct scene *scene)
{
    size_t triangles = 0;
    for (size_t s = 0; s < scene->count; s++)
        triangles += scene->surfaces[s]->index_count / 3;
    return triangles;
}

/* Triangle `number` as it is seen; false when a corner is not before the eye. */
static bool see(const struct scene *scene, uint32_t number, struct corner out[3])
{
    size_t s = 0;
    bool ahead = true;
    for (; number >= scene->surfaces[s]->index_count / 3; s++)
        number -= (uint32_t)(scene->surfaces[s]->index_count / 3);
    for (size_t i = 0; i < 3; i++) {
        const tl_surface *surface = scene->surfaces[s];
        out[i] = project(&scene->view, surface->positions[surface->indices[3 * (size_t)number + i]],
                         scene->width, scene->height);
        ahead &= out[i].w > 0;
    }
    return ahead;
}

/* The nearest triangle at each sample; NOBODY when there is none, or no telling. */
static uint32_t *find_winners(const struct scene *scene)
{
    size_t samples = (size_t)scene->width * (size_t)scene->height;
    uint32_t *winners = TL_NEW_ARRAY(uint32_t, samples);
    double *nearest = TL_NEW_ARRAY(double, samples), *doubtful = TL_NEW_ARRAY(double, samples);
    for (size_t i = 0; i < samples; i++)
        winners[i] = NOBODY, nearest[i] = doubtful[i] = 1;
    for (uint32_t t = 0; t < triangles_of(scene); t++) {
        struct corner corners[3];
        bool ahead = see(scene, t, corners);
        for (size_t i = 0; ahead && i < samples; i++) {
            size_t column = i % (size_t)scene->width, row = i / (size_t)scene->width;
            double x = (double)column + 0.5, y = (double)row + 0.5;
            double inside = inset(corners, x, y);
            if (inside < -CLEAR)
                continue;
            double depth = depth_at(corners, x, y);
            if (inside >= CLEAR && depth < nearest[i]) {
                doubtful[i] = fmin(doubtful[i], nearest[i]);
                nearest[i] = depth, winners[i] = t;
            } else {
                doubtful[i] = fmin(doubtful[i], inside < CLEAR ? depth - ALIKE_AT_EDGES : depth);
            }
        }
    }
    for (size_t i = 0; i < samples; i++)
        if (doubtful[i] < nearest[i] + ALIKE)
            winners[i] = NOBODY;
    free(nearest);
    free(doubtful);
    return winners;
}

static struct tl_cull make(const struct scene *scene, bool nearest_only, size_t first_fading)
{
    const struct tl_cull_request request = {.surfaces = scene->surfaces,
                                            .surface_count = scene->count,
                                            .view_projection = scene->view.view_projection,
                                            .width = scene->width,
                                            .height = scene->height,
                                            .subpixel_bits = BITS,
                                            .nearest_only = nearest_only,
                                            .first_fading = first_fading};
    struct tl_cull cull = {0};
    tl_cull_make(&request, &cull);
    return cull;
}

/* Which triangles are kept. They come in their order, with their own corners. */
static bool *kept_of(const struct scene *scene, const struct tl_cull *cull)
{
    bool *kept = TL_NEW_ARRAY(bool, triangles_of(scene));
    size_t next = 0;
    assert_int_equal(cull->part_count, scene->count);
    for (size_t s = 0, first = 0; s < scene->count; first += scene->surfaces[s++]->index_count / 3) {
        assert_int_equal(cull->parts[s].first, next);
        for (size_t i = 0; i < cull->parts[s].count; i++, next++) {
            uint32_t number = cull->numbers[next];
            assert_true(next == 0 || number > cull->numbers[next - 1]);
            assert_true(number >= first && number - first < scene->surfaces[s]->index_count / 3);
            assert_memory_equal(cull->indices + 3 * next, scene->surfaces[s]->indices + 3 * (number - first),
                                3 * sizeof(uint32_t));
            kept[number] = true;
        }
    }
    assert_int_equal(next, cull->triangle_count);
    return kept;
}

/* Every winner is kept. Returns how many different ones there are. */
static size_t check_winners(const struct scene *scene, const bool *kept)
{
    size_t count = 0, samples = (size_t)scene->width * (size_t)scene->height;
    uint32_t *winners = find_winners(scene);
    bool *won = TL_NEW_ARRAY(bool, triangles_of(scene));
    for (size_t i = 0; i < samples; i++) {
        uint32_t winner = winners[i];
        if (winner == NOBODY)
            continue;
        assert_true(kept[winner]);
        count += !won[winner];
        won[winner] = true;
    }
    free(winners);
    free(won);
    return count;
}

static void refresh(struct test_shape *a, struct test_shape *b)
{
    test_shape_refresh(a);
    if (b)
        test_shape_refresh(b);
}

static const vec3s eyes[] = {{{1.6f, 0.9f, 2.4f}}, {{-2, 0.1f, 0.6f}}, {{0.2f, 2.8f, 0.4f}}, {{0.3f, -2, 1}}};

/* A closed ball under an open sheet, from all round: the sheet's backs are seen from below. At most as many
 * are kept as are seen and, about each edge on a sample, their neighbours: half as many again; here twice as
 * many. */
static void test_what_is_seen_is_kept(void **state)
{
    (void)state;
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 0.6f, 32),
                      sheet = test_sheet(0.7f, 0.7f, 0.1f, 2, 24);
    refresh(&ball, &sheet);
    for (size_t i = 0; i < TL_COUNT(eyes); i++) {
        struct scene scene =
            scene_of(&ball.surface, &sheet.surface, eyes[i], (vec3s){{0, 0.2f, 0}}, WIDTH, HEIGHT);
        struct tl_cull cull = make(&scene, true, scene.count);
        bool *kept = kept_of(&scene, &cull);
        size_t winners = check_winners(&scene, kept);
        assert_true(winners > 50);
        assert_true(cull.triangle_count < 2 * winners);
        free(kept);
        tl_cull_release(&cull);
    }
    test_shape_release(&ball);
    test_shape_release(&sheet);
}

/* An open half ball, looked into: nothing but backs. */
static void test_inside_of_an_open_shape(void **state)
{
    (void)state;
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 0.6f, 32);
    refresh(&ball, NULL);
    tl_surface half = ball.surface;
    uint32_t *indices = TL_NEW_ARRAY(uint32_t, half.index_count);
    size_t count = 0;
    for (size_t i = 0; i < half.index_count; i += 3)
        if (half.positions[half.indices[i]].z < 0)
            for (size_t c = 0; c < 3; c++)
                indices[count++] = half.indices[i + c];
    struct tl_mesh_part part = *half.parts;
    part.index_count = (uint32_t)count;
    half.indices = indices, half.index_count = count, half.parts = &part;
    struct scene scene = scene_of(&half, NULL, (vec3s){{0.1f, 0.2f, 2}}, (vec3s){{0, 0, 0}}, WIDTH, HEIGHT);
    struct tl_cull cull = make(&scene, true, 1);
    bool *kept = kept_of(&scene, &cull);
    assert_true(check_winners(&scene, kept) > 50);
    free(kept);
    free(indices);
    tl_cull_release(&cull);
    test_shape_release(&ball);
}

/* Without regard to what is nearer: all that cover a sample, nothing that misses every one. */
static void test_what_covers_a_sample_is_kept(void **state)
{
    (void)state;
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 0.6f, 48);
    refresh(&ball, NULL);
    struct scene scene = scene_of(&ball.surface, NULL, eyes[0], (vec3s){{0, 0, 0}}, WIDTH, HEIGHT);
    struct tl_cull cull = make(&scene, false, 1);
    bool *kept = kept_of(&scene, &cull);
    size_t covering = 0, missing = 0;
    for (uint32_t t = 0; t < triangles_of(&scene); t++) {
        struct corner corners[3];
        double maximum = -INFINITY;
        assert_true(see(&scene, t, corners));
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                maximum = fmax(maximum, inset(corners, x + 0.5, y + 0.5));
        assert_true(kept[t] || maximum < CLEAR);
        assert_true(!kept[t] || maximum > -2 * CLEAR); /* the margin is measured along both axes */
        covering += maximum > CLEAR;
        missing += maximum < -2 * CLEAR;
    }
    assert_true(covering > 300 && missing > 300);
    free(kept);
    tl_cull_release(&cull);
    test_shape_release(&ball);
}

/* Surfaces with holes or transparency hide nothing; an opaque half of the square hides the small one. */
static void test_what_hides(void **state)
{
    (void)state;
    struct test_shape small =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.3f, 12);
    struct test_shape square =
        test_square((vec3s){{2, 0, 0.6f}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 3, 1);
    refresh(&small, &square);
    struct scene alone = scene_of(&small.surface, NULL, (vec3s){{0.11f, 0.07f, 2.5f}},
                                  (vec3s){{0.11f, 0.07f, 0}}, WIDTH, HEIGHT);
    struct scene both = scene_of(&small.surface, &square.surface, (vec3s){{0.11f, 0.07f, 2.5f}},
                                 (vec3s){{0.11f, 0.07f, 0}}, WIDTH, HEIGHT);
    struct tl_cull bare = make(&alone, true, 1), hidden = make(&both, true, 2), fading = make(&both, true, 1);
    square.material.alpha_cutoff = 0.5f;
    test_shape_refresh(&square);
    both.surfaces[1] = &square.surface;
    struct tl_cull masked = make(&both, true, 2);
    assert_true(bare.parts[0].count > 50);
    assert_int_equal(hidden.parts[0].count, 0);
    assert_int_equal(fading.parts[0].count, bare.parts[0].count);
    assert_int_equal(masked.parts[0].count, bare.parts[0].count);
    struct tl_cull *all[] = {&bare, &hidden, &fading, &masked};
    for (size_t i = 0; i < TL_COUNT(all); i++)
        tl_cull_release(all[i]);
    test_shape_release(&small);
    test_shape_release(&square);
}

/* From within: what lies across the plane of the eye stays, what lies behind it goes. */
static void test_eye_inside(void **state)
{
    (void)state;
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 0.6f, 32);
    refresh(&ball, NULL);
    struct scene scene =
        scene_of(&ball.surface, NULL, (vec3s){{0.1f, 0, 0.1f}}, (vec3s){{0, 0.2f, -1}}, WIDTH, HEIGHT);
    struct tl_cull cull = make(&scene, true, 1);
    bool *kept = kept_of(&scene, &cull);
    assert_true(check_winners(&scene, kept) > 20);
    size_t across = 0, behind = 0;
    for (uint32_t t = 0; t < triangles_of(&scene); t++) {
        struct corner c[3];
        if (see(&scene, t, c))
            continue;
        bool all_behind = c[0].w <= 0 && c[1].w <= 0 && c[2].w <= 0, no_telling = false;
        for (int i = 0; i < 3; i++)
            no_telling |= fabs(c[i].w) < ON_THE_PLANE;
        assert_true(no_telling || kept[t] == !all_behind);
        across += !all_behind;
        behind += all_behind;
    }
    assert_true(across > 20 && behind > 200);
    free(kept);
    tl_cull_release(&cull);
    test_shape_release(&ball);
}

/* The G-buffer holds the winners, by their numbers: at a size at which what is hidden is left out, and at one
 * at which it is not. */
static void check_drawn(const struct test_device *device, const struct scene *scene)
{
    tl_error error = {0};
    tl_surfaces *surfaces = tl_surfaces_create(device->gpu);
    struct tl_gbuffer gbuffer = {0};
    struct tl_triangle_ranges ranges = {0};
    struct tl_samples samples = {0};
    const struct tl_gbuffer_request request = {.view = &scene->view,
                                               .width = scene->width,
                                               .height = scene->height,
                                               .surfaces = surfaces,
                                               .drawn = scene->surfaces,
                                               .surface_count = scene->count};
    assert_true(tl_surfaces_update(surfaces, scene->surfaces, scene->count, &error));
    assert_true(tl_gbuffer_draw(&gbuffer, device->gpu, &request, &error));
    tl_triangle_ranges_make(scene->surfaces, scene->count, &ranges);
    tl_samples_read(&gbuffer, &ranges, scene->view.eye, &samples);
    uint32_t *drawn = TL_NEW_ARRAY(uint32_t, (size_t)scene->width * (size_t)scene->height);
    for (size_t i = 0; i < samples.count; i++)
        drawn[samples.items[i].texel] = 1 + (samples.items[i].triangle & ~TL_SAMPLE_BACK);
    uint32_t *winners = find_winners(scene);
    size_t checked = 0, texels = (size_t)scene->width * (size_t)scene->height;
    for (size_t i = 0; i < texels; i++) {
        if (winners[i] == NOBODY)
            continue;
        assert_int_equal(drawn[i], 1 + winners[i]);
        checked++;
    }
    assert_true(checked > samples.count / 2);
    free(winners);
    free(drawn);
    tl_samples_release(&samples);
    tl_triangle_ranges_release(&ranges);
    tl_gbuffer_release(&gbuffer);
    tl_surfaces_destroy(&surfaces);
}

static void test_picture_is_the_same(void **state)
{
    const struct test_device *device = *state;
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 0.6f, 24),
                      sheet = test_sheet(0.7f, 0.7f, 0.1f, 2, 16);
    refresh(&ball, &sheet);
    const int sizes[][2] = {{WIDTH, HEIGHT}, {3 * WIDTH, 3 * HEIGHT}};
    for (size_t i = 0; i < TL_COUNT(eyes); i += 2)
        for (size_t k = 0; k < TL_COUNT(sizes); k++) {
            struct scene scene = scene_of(&ball.surface, &sheet.surface, eyes[i], (vec3s){{0, 0.2f, 0}},
                                          sizes[k][0], sizes[k][1]);
            check_drawn(device, &scene);
        }
    test_shape_release(&ball);
    test_shape_release(&sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_seen_is_kept),
        cmocka_unit_test(test_inside_of_an_open_shape),
        cmocka_unit_test(test_what_covers_a_sample_is_kept),
        cmocka_unit_test(test_what_hides),
        cmocka_unit_test(test_eye_inside),
        cmocka_unit_test(test_picture_is_the_same),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
