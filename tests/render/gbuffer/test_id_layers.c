/* The layers of an ID buffer behind open triangles against brute force: every triangle is intersected with
 * the ray of every pixel, and the hits are followed in order of their distance while they are open. Pixels
 * count where rays beside the pixel's centre find the same triangles; at an edge rounding decides. */
#include "tests/render/soup.h"

#include "render/gbuffer/depth_terms.glsl"
#include "render/gbuffer/ids_internal.h"

#include "tests/testing.h"

#include <omp.h>
#include <string.h>

#define WIDTH     173 /* no multiple of anything */
#define HEIGHT    131
#define PIXELS    ((size_t)WIDTH * HEIGHT)
#define TRIANGLES 500
#define LAYERS    (1 + TL_TRANSPARENCY_LAYERS)
/* Pixels from the centre: five steps of the raster's grid, and less than one, for slivers. */
#define ASIDE 0.02
#define GRID  0.003

/* What a ray sees, the nearest first; 0: nothing. */
struct seen {
    uint32_t ids[LAYERS];
};

struct hit {
    double distance;
    uint32_t id;
    bool is_open;
};

static const tl_surface *surface_at(const struct soup *soups, size_t count, uint32_t *triangle)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t own = (uint32_t)(soups[i].surface.index_count / 3);
        if (*triangle < own)
            return &soups[i].surface;
        *triangle -= own;
    }
    return NULL;
}

/* Inserts a hit among the nearest LAYERS of them. */
static int insert(struct hit *hits, int count, struct hit hit)
{
    int at = count < LAYERS ? count : LAYERS;
    while (at > 0 && hits[at - 1].distance > hit.distance)
        at--;
    for (int i = count < LAYERS ? count : LAYERS - 1; i > at; i--)
        hits[i] = hits[i - 1];
    if (at < LAYERS)
        hits[at] = hit;
    return count < LAYERS ? count + 1 : LAYERS;
}

static struct seen look(const struct soup *soups, size_t soup_count, const struct tl_view *view, double x,
                        double y)
{
    vec3s direction = view->forward;
    direction = glms_vec3_add(direction, glms_vec3_scale(view->right, (float)(2 * x / WIDTH - 1)));
    direction = glms_vec3_add(direction, glms_vec3_scale(view->up, (float)(2 * y / HEIGHT - 1)));
    struct hit hits[LAYERS] = {{0}};
    int count = 0;
    uint32_t all = 0;
    for (size_t i = 0; i < soup_count; i++)
        all += (uint32_t)(soups[i].surface.index_count / 3);
    for (uint32_t number = 0; number < all; number++) {
        uint32_t own = number;
        const tl_surface *surface = surface_at(soups, soup_count, &own);
        vec3s corners[3];
        for (size_t k = 0; k < 3; k++)
            corners[k] = surface->positions[surface->indices[3 * (size_t)own + k]];
        double distance, u, v;
        if (!soup_intersect(corners, view->eye, direction, &distance, &u, &v) || u < 0 || v < 0 ||
            u + v > 1 || distance < (double)view->near_m || distance > (double)view->far_m)
            continue;
        vec3s normal =
            glms_vec3_cross(glms_vec3_sub(corners[1], corners[0]), glms_vec3_sub(corners[2], corners[0]));
        bool is_back = glms_vec3_dot(normal, direction) > 0;
        if (is_back) /* the way along which the depth 1 - near / distance grows by the step */
            distance += (double)DEPTH_OF_BACKS * distance * distance / (double)view->near_m;
        const struct tl_mesh_part *part =
            3 * own < surface->parts[1].first_index ? &surface->parts[0] : &surface->parts[1];
        count = insert(hits, count,
                       (struct hit){.distance = distance,
                                    .id = (number + 1) | (is_back ? TL_SAMPLE_BACK : 0),
                                    .is_open = surface->materials[part->material].openness > 0});
    }
    struct seen seen = {{0}};
    for (int i = 0; i < count; i++) {
        seen.ids[i] = hits[i].id;
        if (!hits[i].is_open)
            break;
    }
    return seen;
}

/* What lies behind the closed end of a pixel must be nothing, too. */
static struct seen drawn_at(const struct tl_id_buffer *ids, size_t pixel)
{
    struct seen seen = {{ids->ids[pixel]}};
    for (int layer = 1; layer < ids->layer_count; layer++)
        seen.ids[layer] = tl_ids_layer(ids, layer).ids[pixel];
    return seen;
}

static void draw(const struct soup *soups, size_t count, const struct tl_view *view, struct tl_id_buffer *ids)
{
    const tl_surface *surfaces[2] = {&soups[0].surface, count > 1 ? &soups[1].surface : NULL};
    struct tl_triangle_ranges ranges = {0};
    tl_triangle_ranges_make(surfaces, count, &ranges);
    const struct tl_gbuffer_request request = {.view = view,
                                               .width = WIDTH,
                                               .height = HEIGHT,
                                               .drawn = surfaces,
                                               .surface_count = count,
                                               .only_triangle = true};
    tl_ids_draw_on_cpu(ids, &request, &ranges, true);
    tl_triangle_ranges_release(&ranges);
}

/* Counts what the buffer says of itself. */
static void check_counts(const struct tl_id_buffer *ids)
{
    size_t covered = 0;
    for (int layer = 0; layer < ids->layer_count; layer++)
        for (size_t i = 0; i < PIXELS; i++) {
            uint32_t id = tl_ids_layer(ids, layer).ids[i];
            covered += id != 0;
            if (id == 0)
                continue;
            assert_true(layer == 0 || layer <= ids->depths[i / WIDTH]);
            uint32_t place = tl_ids_place(ids, id);
            assert_true(place < ids->seen_count);
            assert_int_equal(ids->seen[place], ((id & ~TL_SAMPLE_BACK) - 1) | (id & TL_SAMPLE_BACK));
        }
    assert_int_equal(covered, ids->covered);
}

/* Returns how many pixels that count have all layers. */
static size_t check_view(const struct soup *soups, size_t count, vec3s eye, float near_m,
                         struct tl_id_buffer *ids)
{
    const struct tl_camera camera = {.eye = eye,
                                     .target = {{0, 0.1f, 0}},
                                     .up = {{0, 1, 0}},
                                     .fov_y = 0.7f,
                                     .near_m = near_m,
                                     .far_m = 50};
    const struct tl_view view = tl_view_make(&camera, WIDTH, HEIGHT);
    size_t doubtful = 0, wrong = 0, layers[LAYERS] = {0};
    draw(soups, count, &view, ids);
    check_counts(ids);
#pragma omp parallel for schedule(dynamic) reduction(+ : doubtful, wrong, layers[:LAYERS])
    for (size_t i = 0; i < PIXELS; i++) {
        const size_t column = i % WIDTH, row = i / WIDTH;
        const double x = (double)column + 0.5, y = (double)row + 0.5;
        const struct seen seen = look(soups, count, &view, x, y);
        bool is_clear = true;
        for (int k = 0; k < 8; k++) {
            const double aside = k < 4 ? ASIDE : GRID;
            const struct seen other =
                look(soups, count, &view, x + (k & 1 ? aside : -aside), y + (k & 2 ? aside : -aside));
            is_clear &= memcmp(&other, &seen, sizeof seen) == 0;
        }
        const struct seen drawn = drawn_at(ids, i);
        doubtful += !is_clear;
        wrong += is_clear && memcmp(&drawn, &seen, sizeof seen) != 0;
        for (int k = 0; k < LAYERS; k++)
            layers[k] += is_clear && seen.ids[k] != 0;
    }
    printf("pixels by layer %zu %zu %zu %zu %zu, doubtful %zu, wrong %zu\n", layers[0], layers[1], layers[2],
           layers[3], layers[4], doubtful, wrong);
    assert_int_equal(wrong, 0);
    assert_true(doubtful < PIXELS / 4);
    return layers[LAYERS - 1];
}

/* Two surfaces of two parts each, some open: `open` has a bit for each part. */
static void check_soups(int open)
{
    struct soup soups[2];
    struct tl_id_buffer ids = {0};
    for (int i = 0; i < 2; i++) {
        soup_create(&soups[i], TRIANGLES / 2, 18 + (uint64_t)i);
        for (int k = 0; k < 2; k++)
            soups[i].materials[k].openness = open >> (2 * i + k) & 1 ? 0.3f : 0;
    }
    assert_true(check_view(soups, 2, (vec3s){{1.5f, 1, 3}}, 0.02f, &ids) > 100);
    /* the near plane cuts many */
    assert_true(check_view(soups, 2, (vec3s){{0.2f, 0.1f, 0.3f}}, 0.5f, &ids) > 100);
    tl_ids_release(&ids);
    soup_release(&soups[0]);
    soup_release(&soups[1]);
}

static void test_layers_are_hits_in_order(void **state)
{
    (void)state;
    check_soups(15); /* all */
    check_soups(11); /* closed ones end the layers */
}

/* Triangles of a pixel or a few behind single open ones: nothing beside an open pixel is left out. */
static void test_small_triangles(void **state)
{
    (void)state;
    struct soup soup;
    struct tl_id_buffer ids = {0};
    soup_create(&soup, 1500, 7);
    for (size_t i = 0; i < 4500; i += 3)
        for (size_t k = 1; k < 3; k++)
            soup.positions[i + k] = glms_vec3_lerp(soup.positions[i], soup.positions[i + k], 0.2f);
    soup.parts[0].index_count = 600; /* a few are open */
    soup.parts[1].first_index = 600;
    soup.parts[1].index_count = 4500 - 600;
    soup.materials[0].openness = 0.5f;
    check_view(&soup, 1, (vec3s){{0, 1, 3}}, 0.02f, &ids);
    assert_true(ids.layer_count > 1);
    tl_ids_release(&ids);
    soup_release(&soup);
}

/* Nothing is left of layers that are not there any more, and the layers do not depend on threads. */
static void test_layers_are_renewed(void **state)
{
    (void)state;
    struct soup soup;
    struct tl_id_buffer ids = {0}, fresh = {0};
    soup_create(&soup, TRIANGLES, 5);
    soup.materials[1].openness = 0.5f;
    const struct tl_camera
        near = {.eye = {{0, 0, 3}}, .up = {{0, 1, 0}}, .fov_y = 0.7f, .near_m = 0.02f, .far_m = 50},
        far = {.eye = {{0, 1, 8}}, .up = {{0, 1, 0}}, .fov_y = 0.7f, .near_m = 0.02f, .far_m = 50};
    const struct tl_view views[2] = {tl_view_make(&near, WIDTH, HEIGHT), tl_view_make(&far, WIDTH, HEIGHT)};
    const int threads = omp_get_max_threads();
    draw(&soup, 1, &views[0], &ids);
    assert_true(ids.layer_count > 2);
    omp_set_num_threads(1);
    draw(&soup, 1, &views[1], &fresh);
    omp_set_num_threads(3);
    draw(&soup, 1, &views[1], &ids);
    omp_set_num_threads(threads);
    assert_int_equal(ids.layer_count, fresh.layer_count);
    for (int layer = 0; layer < ids.layer_count; layer++)
        assert_memory_equal(tl_ids_layer(&ids, layer).ids, tl_ids_layer(&fresh, layer).ids,
                            PIXELS * sizeof(uint32_t));
    soup.materials[1].openness = 0;
    draw(&soup, 1, &views[1], &ids);
    assert_int_equal(ids.layer_count, 1);
    tl_ids_release(&ids);
    tl_ids_release(&fresh);
    soup_release(&soup);
}

/* Of open triangles in one place the first one is seen, once, and then what lies behind them. Light comes
 * through the nearer ones, so both of their sides are listed. */
static void test_equal_depths_and_other_sides(void **state)
{
    (void)state;
    struct soup soup;
    struct tl_id_buffer ids = {0};
    soup_create(&soup, 6, 1);
    for (size_t t = 0; t < 6; t++) {
        float z = t < 3 ? 0.5f : -0.5f;
        const vec3s corners[3] = {{{-9, -9, z}}, {{9, -9, z}}, {{0, 18, z}}};
        memcpy(soup.positions + 3 * t, corners, sizeof corners);
    }
    soup.materials[0].openness = 0.5f;
    soup.materials[0].transmission = (vec3s){{0.2f, 0.2f, 0.2f}};
    const struct tl_camera camera = {
        .eye = {{0, 0, 3}}, .up = {{0, 1, 0}}, .fov_y = 0.7f, .near_m = 0.02f, .far_m = 50};
    const struct tl_view view = tl_view_make(&camera, WIDTH, HEIGHT);
    draw(&soup, 1, &view, &ids);
    assert_int_equal(ids.layer_count, 2);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_int_equal(ids.ids[i], 1);
        assert_int_equal(ids.layers[0][i], 4);
    }
    const uint32_t seen[] = {0, 0 | TL_SAMPLE_BACK, 3};
    assert_int_equal(ids.seen_count, TL_COUNT(seen));
    assert_memory_equal(ids.seen, seen, sizeof seen);
    tl_ids_release(&ids);
    soup_release(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_layers_are_hits_in_order), cmocka_unit_test(test_small_triangles),
        cmocka_unit_test(test_layers_are_renewed), cmocka_unit_test(test_equal_depths_and_other_sides)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
