/* The CPU's rasteriser against software GL (Mesa 22.3): the ID buffers are the same to the bit, for random
 * triangles, for slivers, for triangles that the frustum cuts or that are far larger than the picture, for
 * corners on pixel centres, for equal depths, and for a dressed figure. Without GL: what tiles the picture
 * covers every pixel once, and threads change nothing. */
#include "tests/render/scenes.h"
#include "tests/render/soup.h"

#include "assets/body/form.h"
#include "assets/cut/garment_cut.h"
#include "config/base/memory.h"
#include "render/gbuffer/ids_internal.h"

#include "tests/testing.h"

#include <omp.h>
#include <string.h>

/* Pixels of the pictures whose triangles are placed in pixels. Powers of two: places are exact then. */
#define SIDE 64

struct oracle {
    void *device;
    struct tl_id_buffer gl, cpu;
    size_t behind; /* pixels of further layers compared so far */
};

static int open_oracle(void **state)
{
    struct oracle *oracle = TL_NEW(struct oracle);
    *state = oracle;
    return test_device_open(&oracle->device);
}

static int close_oracle(void **state)
{
    struct oracle *oracle = *state;
    tl_ids_release(&oracle->gl);
    tl_ids_release(&oracle->cpu);
    int failed = test_device_close(&oracle->device);
    free(oracle);
    return failed;
}

struct picture {
    const tl_surface *surfaces[3];
    size_t count;
    struct tl_view view;
    int width, height;
};

static uint32_t id_at(const struct tl_id_buffer *ids, int layer, size_t pixel)
{
    return layer < ids->layer_count ? tl_ids_layer(ids, layer).ids[pixel] : 0;
}

/* Pixels that may differ behind the nearest layer: the depth that GL's program compares with what was passed
 * is rounded otherwise than the one that GL keeps. Measured: 3e-6. */
#define BEHIND_SHARE 1e-5

/* Draws a picture both ways and compares them. Returns how many pixels are covered. */
static size_t check(struct oracle *oracle, const struct picture *picture)
{
    const struct test_device *device = oracle->device;
    if (!tl_gpu_is_software(device->gpu)) {
        printf("skipped: %s rounds corners in its own way\n", tl_gpu_name(device->gpu));
        skip();
    }
    tl_error error = {0};
    tl_surfaces *surfaces = tl_surfaces_create(device->gpu);
    struct tl_triangle_ranges ranges = {0};
    assert_ok(tl_surfaces_update(surfaces, picture->surfaces, picture->count, &error), error);
    tl_triangle_ranges_make(picture->surfaces, picture->count, &ranges);
    const struct tl_gbuffer_request request = {.view = &picture->view,
                                               .width = picture->width,
                                               .height = picture->height,
                                               .surfaces = surfaces,
                                               .drawn = picture->surfaces,
                                               .surface_count = picture->count,
                                               .only_triangle = true};
    struct tl_id_buffer *gl = &oracle->gl, *cpu = &oracle->cpu;
    assert_ok(tl_ids_draw_by_gl(gl, device->gpu, &request, &ranges, true, &error), error);
    tl_ids_draw_on_cpu(cpu, &request, &ranges, true);
    size_t coverage = 0, ids = 0, behind = 0, pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < pixels; i++) {
        coverage += (gl->ids[i] != 0) != (cpu->ids[i] != 0);
        ids += gl->ids[i] != cpu->ids[i];
        bool differs = false;
        for (int layer = 1; layer < gl->layer_count || layer < cpu->layer_count; layer++) {
            differs |= id_at(gl, layer, i) != id_at(cpu, layer, i);
            oracle->behind += id_at(cpu, layer, i) != 0;
        }
        behind += differs;
    }
    if (ids + behind > 0)
        print_error(
            "%zu of %zu pixels are covered in one of the pictures only, %zu show different triangles, "
            "%zu behind the nearest\n",
            coverage, pixels, ids, behind);
    assert_int_equal(coverage, 0);
    assert_int_equal(ids, 0);
    assert_true((double)behind <= BEHIND_SHARE * (double)pixels);
    if (behind == 0) {
        assert_int_equal(gl->covered, cpu->covered);
        assert_int_equal(gl->seen_count, cpu->seen_count);
        assert_memory_equal(gl->seen, cpu->seen, gl->seen_count * sizeof *gl->seen);
    }
    tl_triangle_ranges_release(&ranges);
    tl_surfaces_destroy(&surfaces);
    return cpu->covered;
}

static struct tl_view look(vec3s eye, vec3s target, float near_m, int width, int height)
{
    const struct tl_camera camera = {
        .eye = eye, .target = target, .up = {{0, 1, 0}}, .fov_y = 0.7f, .near_m = near_m, .far_m = 50};
    return tl_view_make(&camera, width, height);
}

/* x and y of positions are in pixels of a picture of SIDE x SIDE, z is a depth in -1 .. 1. */
static struct picture in_pixels(struct soup *soup)
{
    for (size_t i = 0; i < soup->surface.vertex_count; i++) {
        soup->positions[i].x = soup->positions[i].x * (2.0f / SIDE) - 1;
        soup->positions[i].y = soup->positions[i].y * (2.0f / SIDE) - 1;
    }
    return (struct picture){.surfaces = {&soup->surface},
                            .count = 1,
                            .view = {.view_projection = glms_mat4_identity()},
                            .width = SIDE,
                            .height = SIDE};
}

/* From afar, from near, from among the triangles, and with a near plane that cuts through many of them. */
static void check_from_all_sides(struct oracle *oracle, const tl_surface *surface)
{
    const struct {
        vec3s eye;
        float near_m;
    } cameras[] = {{{{0, 0, 40}}, 0.02f},
                   {{{1.5f, 1, 2}}, 0.02f},
                   {{{0.2f, 0.1f, 0.3f}}, 0.02f},
                   {{{0.2f, 0.1f, 0.3f}}, 0.5f}};
    const int sizes[][2] = {{44, 32}, {317, 211}, {900, 800}};
    for (size_t c = 0; c < TL_COUNT(cameras); c++)
        for (size_t k = 0; k < TL_COUNT(sizes); k++) {
            struct picture picture = {.surfaces = {surface},
                                      .count = 1,
                                      .view = look(cameras[c].eye, (vec3s){{0, 0.1f, 0}}, cameras[c].near_m,
                                                   sizes[k][0], sizes[k][1]),
                                      .width = sizes[k][0],
                                      .height = sizes[k][1]};
            assert_true(check(oracle, &picture) > 0);
        }
}

static void test_random_triangles(void **state)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct soup soup;
        soup_create(&soup, 3000, seed);
        check_from_all_sides(*state, &soup.surface);
        soup_release(&soup);
    }
}

/* What lies behind open triangles is the same, layer by layer. */
static void test_open_triangles(void **state)
{
    struct soup soup;
    soup_create(&soup, 1000, 4);
    soup.materials[0].openness = 0.4f;
    check_from_all_sides(*state, &soup.surface);
    const struct oracle *oracle = *state;
    printf("%zu pixels behind others\n", oracle->behind);
    assert_true(oracle->behind > 500000);
    soup_release(&soup);
}

/* Corners nearly on a line, from 1 mm down to nothing, and two corners in one place. */
static void test_slivers(void **state)
{
    struct soup soup;
    soup_create(&soup, 6000, 5);
    uint64_t random = 6;
    for (size_t t = 0; t < 6000; t++) {
        vec3s *p = soup.positions + 3 * t;
        vec3s offset = soup_point(&random, t % 7 == 0 ? 0 : powf(10, -3 - (float)(t % 5)));
        p[2] = glms_vec3_add(t % 11 == 0 ? p[0] : glms_vec3_lerp(p[0], p[1], soup_random(&random)), offset);
    }
    check_from_all_sides(*state, &soup.surface);
    soup_release(&soup);
}

/* Triangles up to a million times the picture, about its middle: every edge function must hold them. */
static void test_huge_triangles(void **state)
{
    for (int power = 0; power <= 6; power++) {
        struct soup soup;
        soup_create(&soup, 200, 7 + (uint64_t)power);
        for (size_t i = 0; i < 600; i++) {
            soup.positions[i] = glms_vec3_scale(soup.positions[i], powf(10, (float)power));
            soup.positions[i].z = 0.5f * sinf((float)i);
        }
        struct picture picture = in_pixels(&soup);
        assert_true(check(*state, &picture) > 0);
        picture.view = look((vec3s){{0.1f, 0.2f, 2}}, (vec3s){{0, 0, 0}}, 0.02f, SIDE, SIDE);
        check(*state, &picture);
        soup_release(&soup);
    }
}

/* Quads that tile the picture and more, cut into triangles either way, either side up. Corners lie on
 * multiples of 1/256 pixel; one in three on a pixel's centre. */
static void make_tiles(struct soup *soup, size_t cells, float first, float step, uint64_t seed)
{
    size_t across = cells + 1;
    vec3s *corners = TL_NEW_ARRAY(vec3s, across * across);
    uint64_t random = seed;
    for (size_t i = 0; i < across * across; i++) {
        size_t column = i % across, row = i / across;
        float x = first + step * (float)column, y = first + step * (float)row;
        float move_x = 0.3f * step * (2 * soup_random(&random) - 1),
              move_y = 0.3f * step * (2 * soup_random(&random) - 1);
        bool on_centre = soup_random(&random) < 1 / 3.0f;
        corners[i] = on_centre
                         ? (vec3s){{floorf(x + move_x) + 0.5f, floorf(y + move_y) + 0.5f, 0}}
                         : (vec3s){{roundf(256 * (x + move_x)) / 256, roundf(256 * (y + move_y)) / 256, 0}};
    }
    soup_create(soup, 2 * cells * cells, seed);
    vec3s *p = soup->positions;
    for (size_t i = 0; i < cells * cells; i++, p += 6) {
        size_t a = i / cells * across + i % cells;
        vec3s quad[4] = {corners[a], corners[a + 1], corners[a + across + 1], corners[a + across]};
        size_t turn = soup_random(&random) < 0.5f;
        for (size_t k = 0; k < 3; k++) {
            p[k] = quad[(turn + k) % 4];
            p[3 + k] = quad[(turn + 2 + k) % 4];
        }
        if (soup_random(&random) < 0.5f) {
            vec3s other = p[1];
            p[1] = p[2];
            p[2] = other;
        }
    }
    free(corners);
}

/* Draws triangle `t` of a picture of SIDE x SIDE alone. */
static void draw_alone(struct tl_raster *raster, const struct picture *picture, size_t t, uint32_t *ids)
{
    const struct tl_mesh_part part = {.index_count = 3};
    tl_surface alone = *picture->surfaces[0];
    alone.indices += 3 * t;
    alone.index_count = 3;
    alone.parts = &part;
    alone.part_count = 1;
    const struct tl_raster_request request = {.surfaces = (const tl_surface *[]){&alone},
                                              .surface_count = 1,
                                              .view_projection = picture->view.view_projection,
                                              .width = SIDE,
                                              .height = SIDE};
    tl_raster_draw(raster, &request, &(struct tl_raster_layers){.nearest = ids});
}

/* Neighbours leave no gap and share no pixel: each triangle is drawn alone, and each pixel counted. */
static void test_tiles_cover_once(void **state)
{
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct soup soup;
        make_tiles(&soup, 12, -4, 6, seed);
        struct picture picture = in_pixels(&soup);
        int times[SIDE * SIDE] = {0};
        uint32_t ids[SIDE * SIDE];
        struct tl_raster raster = {0};
        for (size_t t = 0; t < soup.surface.index_count / 3; t++) {
            draw_alone(&raster, &picture, t, ids);
            for (int i = 0; i < SIDE * SIDE; i++)
                times[i] += ids[i] != 0;
        }
        for (int i = 0; i < SIDE * SIDE; i++)
            assert_int_equal(times[i], 1);
        assert_int_equal(check(*state, &picture), SIDE * SIDE);
        tl_raster_release(&raster);
        soup_release(&soup);
    }
}

/* A rectangle whose sides pass through pixel centres covers those of two sides: as many pixels as its area.
 * Its halves and their copies, the other way up, are at one depth: the first ones are seen. */
static void test_on_pixel_centres(void **state)
{
    struct soup soup;
    soup_create(&soup, 4, 1);
    const vec3s quad[] = {{{2.5f, 3.5f, 0}}, {{6.5f, 3.5f, 0}}, {{6.5f, 9.5f, 0}}, {{2.5f, 9.5f, 0}}};
    const size_t corners[12] = {0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0};
    for (size_t i = 0; i < 12; i++)
        soup.positions[i] = quad[corners[i]];
    struct picture picture = in_pixels(&soup);
    struct oracle *oracle = *state;
    assert_int_equal(check(oracle, &picture), 4 * 6);
    assert_int_equal(oracle->cpu.seen_count, 2);
    assert_int_equal(oracle->cpu.seen[0], 0);
    assert_int_equal(oracle->cpu.seen[1], 1);
    soup_release(&soup);
}

/* Many triangles at two depths only. Of those that cover a pixel when they are drawn alone, the first of the
 * nearer ones is seen, a front before a back: cloth folded flat shows its outside. */
static void test_equal_depths(void **state)
{
    struct soup soup;
    soup_create(&soup, 400, 9);
    for (size_t i = 0; i < 1200; i++) {
        soup.positions[i] = glms_vec3_scale(glms_vec3_adds(soup.positions[i], 1), 0.5f * SIDE);
        soup.positions[i].z = i / 3 % 5 == 0 ? -0.25f : 0.25f;
    }
    struct picture picture = in_pixels(&soup);
    struct tl_raster raster = {0};
    uint32_t ids[SIDE * SIDE], expected[SIDE * SIDE] = {0};
    int ranks[SIDE * SIDE] = {0};
    for (uint32_t t = 0; t < 400; t++) {
        draw_alone(&raster, &picture, t, ids);
        for (int i = 0; i < SIDE * SIDE; i++) {
            int rank = ids[i] == 0 ? 0 : 1 + 2 * (t % 5 == 0) + !(ids[i] & TL_SAMPLE_BACK);
            if (rank > ranks[i]) {
                expected[i] = ids[i] + t;
                ranks[i] = rank;
            }
        }
    }
    struct oracle *oracle = *state;
    assert_true(check(oracle, &picture) > SIDE * SIDE / 2);
    assert_memory_equal(oracle->cpu.ids, expected, sizeof expected);
    tl_raster_release(&raster);
    soup_release(&soup);
}

/* A dressed form on the ground. */
struct figure {
    tl_garment garment;
    tl_avatar form;
    struct tl_ground ground;
    tl_surface surfaces[2];
    const tl_surface *drawn[3];
};

static void open_figure(struct figure *figure)
{
    tl_error error = {0};
    struct tl_casters casters;
    assert_ok(tl_garment_cut("dress", 0.02f, &figure->garment, &error), error);
    figure->form = tl_avatar_form();
    const tl_model *models[] = {&figure->garment.model, &figure->form.model};
    for (int i = 0; i < 2; i++) {
        figure->surfaces[i] =
            tl_surface_of_mesh(i == 0 ? "garment" : "avatar", &models[i]->mesh, models[i]->materials);
        figure->drawn[i] = &figure->surfaces[i];
    }
    assert_ok(tl_casters_measure(figure->surfaces, 2, &casters, &error), error);
    tl_ground_make(&casters, TL_GROUND_GREY, &figure->ground);
    figure->drawn[2] = &figure->ground.surface;
}

static void close_figure(struct figure *figure)
{
    tl_garment_release(&figure->garment);
    tl_avatar_release(&figure->form);
    free(figure);
}

static struct picture of_figure(const struct figure *figure, vec3s eye, vec3s target, float near_m, int width,
                                int height)
{
    struct picture picture = {
        .count = 3, .view = look(eye, target, near_m, width, height), .width = width, .height = height};
    memcpy(picture.surfaces, figure->drawn, sizeof picture.surfaces);
    return picture;
}

/* From afar, from 1 m, with the near plane in the skirt, and from within: a part of the body, of the dress
 * and of the ground lies behind the eye. At the sizes of a picture in motion, at rest, and with four samples
 * a pixel. */
static void test_dressed_figure(void **state)
{
    struct figure *figure = TL_NEW(struct figure);
    open_figure(figure);
    const struct {
        vec3s eye, target;
        float near_m;
        int width, height;
    } views[] = {{{{2, 1.6f, 4}}, {{0, 0.9f, 0}}, 0.02f, 450, 400},
                 {{{2, 1.6f, 4}}, {{0, 0.9f, 0}}, 0.02f, 900, 800},
                 {{{2, 1.6f, 4}}, {{0, 0.9f, 0}}, 0.02f, 1800, 1600},
                 {{{-20, 6, 30}}, {{0, 0.9f, 0}}, 0.02f, 900, 800},
                 {{{0.3f, 1.2f, 1}}, {{0, 1, 0}}, 0.02f, 900, 800},
                 {{{0, 0.7f, 1}}, {{0, 0.7f, 0}}, 0.85f, 900, 800},
                 {{{0.05f, 1, 0.02f}}, {{1, 0.6f, 0.3f}}, 0.005f, 900, 800},
                 {{{0.02f, 1.1f, 0}}, {{0, 0, 0.1f}}, 0.005f, 900, 800}};
    for (size_t i = 0; i < TL_COUNT(views); i++) {
        struct picture picture = of_figure(figure, views[i].eye, views[i].target, views[i].near_m,
                                           views[i].width, views[i].height);
        assert_true(check(*state, &picture) > 0);
    }
    close_figure(figure);
}

/* The picture does not depend on the number of threads, and a raster that has drawn other pictures draws the
 * same one again. */
static void test_threads(void **state)
{
    (void)state;
    struct figure *figure = TL_NEW(struct figure);
    open_figure(figure);
    const int width = 450, height = 400, threads = omp_get_max_threads();
    size_t bytes = (size_t)width * (size_t)height * sizeof(uint32_t);
    struct picture picture =
        of_figure(figure, (vec3s){{0.3f, 1.2f, 1}}, (vec3s){{0, 1, 0}}, 0.02f, width, height);
    struct tl_raster_request request = {.surfaces = picture.surfaces,
                                        .surface_count = picture.count,
                                        .view_projection = picture.view.view_projection,
                                        .width = width,
                                        .height = height};
    uint32_t *one = tl_alloc(bytes, 1), *more = tl_alloc(bytes, 1);
    struct tl_raster raster = {0};
    omp_set_num_threads(1);
    tl_raster_draw(&raster, &request, &(struct tl_raster_layers){.nearest = one});
    const int counts[] = {2, 5};
    for (size_t i = 0; i < TL_COUNT(counts); i++) {
        omp_set_num_threads(counts[i]);
        request.height = height / 3;
        request.surface_count = 1;
        tl_raster_draw(&raster, &request, &(struct tl_raster_layers){.nearest = more});
        request.height = height;
        request.surface_count = picture.count;
        tl_raster_draw(&raster, &request, &(struct tl_raster_layers){.nearest = more});
        assert_memory_equal(one, more, bytes);
    }
    omp_set_num_threads(threads);
    tl_raster_release(&raster);
    free(one);
    free(more);
    close_figure(figure);
}

/* A triangle with a corner that is not finite, or on the eye's plane, is not drawn; the others are. */
static void test_corners_that_are_not_finite(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 3e38f};
    for (size_t k = 0; k < TL_COUNT(bad); k++) {
        struct soup soup;
        make_tiles(&soup, 4, 0, 16, 3);
        struct picture picture = in_pixels(&soup);
        soup.positions[7].raw[k % 3] = bad[k];
        uint32_t ids[SIDE * SIDE] = {0};
        struct tl_raster raster = {0};
        const struct tl_raster_request request = {.surfaces = picture.surfaces,
                                                  .surface_count = 1,
                                                  .view_projection = picture.view.view_projection,
                                                  .width = SIDE,
                                                  .height = SIDE};
        tl_raster_draw(&raster, &request, &(struct tl_raster_layers){.nearest = ids});
        size_t covered = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            assert_true((ids[i] & ~TL_SAMPLE_BACK) != 3 || isfinite(bad[k]));
            covered += ids[i] != 0;
        }
        assert_true(covered > SIDE * SIDE / 2);
        tl_raster_release(&raster);
        soup_release(&soup);
    }
}

/* Where GL runs on the CPU the raster draws the ids and GL draws nothing; GL does what the raster cannot do,
 * holes. */
static void test_who_draws(void **state)
{
    struct oracle *oracle = *state;
    const struct test_device *device = oracle->device;
    if (!tl_gpu_is_software(device->gpu)) {
        printf("skipped: %s draws all ids\n", tl_gpu_name(device->gpu));
        skip();
    }
    struct soup soup;
    soup_create(&soup, 100, 3);
    for (int masked = 0; masked < 2; masked++) {
        tl_error error = {0};
        const tl_surface *drawn = &soup.surface;
        const struct tl_view view = look((vec3s){{0, 0, 4}}, (vec3s){{0, 0, 0}}, 0.02f, SIDE, SIDE);
        tl_surfaces *surfaces = tl_surfaces_create(device->gpu);
        struct tl_triangle_ranges ranges = {0};
        struct tl_id_buffer ids = {0};
        soup.materials[1].alpha_cutoff = masked ? 0.5f : 0;
        assert_ok(tl_surfaces_update(surfaces, &drawn, 1, &error), error);
        tl_triangle_ranges_make(&drawn, 1, &ranges);
        const struct tl_gbuffer_request request = {.view = &view,
                                                   .width = SIDE,
                                                   .height = SIDE,
                                                   .surfaces = surfaces,
                                                   .drawn = &drawn,
                                                   .surface_count = 1,
                                                   .only_triangle = true};
        assert_ok(tl_ids_draw(&ids, device->gpu, &request, &ranges, &error), error);
        assert_true(ids.covered > 100);
        assert_int_equal(tl_gbuffer_bytes(&ids.drawn) > 0, masked);
        assert_int_equal(tl_raster_bytes(&ids.raster) > 0, !masked);
        tl_ids_release(&ids);
        tl_triangle_ranges_release(&ranges);
        tl_surfaces_destroy(&surfaces);
    }
    soup_release(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_triangles), cmocka_unit_test(test_open_triangles),
        cmocka_unit_test(test_slivers),          cmocka_unit_test(test_huge_triangles),
        cmocka_unit_test(test_tiles_cover_once), cmocka_unit_test(test_on_pixel_centres),
        cmocka_unit_test(test_equal_depths),     cmocka_unit_test(test_dressed_figure),
        cmocka_unit_test(test_threads),          cmocka_unit_test(test_corners_that_are_not_finite),
        cmocka_unit_test(test_who_draws),
    };
    return cmocka_run_group_tests(tests, open_oracle, close_oracle);
}
