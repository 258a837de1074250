/* Pixels from fewer samples, guided by ids. The light of the samples is a ramp over the image, another one
 * for each part, layer and side that is seen: what every pixel must show is known exactly. Two layers of one
 * part lie behind one another, one of them seen at a grazing angle; a hem is folded over and shows its back;
 * a bar is narrower than a sample. */
#include "render/shade/outlines.h"

#include "tests/render/scenes.h"

#include "render/present/resample.h"

#include "tests/testing.h"

#include "config/base/memory.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH  230
#define HEIGHT 200
#define PIXELS ((size_t)WIDTH * HEIGHT)

enum kind { KIND_NOTHING, KIND_FLOOR, KIND_FRONT, KIND_HEM, KIND_BAR, KIND_COUNT };

struct layers {
    struct test_shape shapes[2];
    const tl_surface *listed[2];
    struct tl_triangle_ranges ranges;
    struct tl_shade_materials materials;
    struct tl_view view;
    struct tl_raster raster;
};

/* Of 3 x 3 cells the left columns are the sheet in front, whose last row is folded forwards, the right ones
 * the floor behind it; triangles in between disappear. */
static struct test_shape make_cloth(void)
{
    struct test_shape cloth =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.5f, 3);
    const float heights[] = {0.95f, 0.6f, 0.25f, 0.42f}, forward[] = {0, 0.02f, 0.04f, 0.047f};
    for (size_t i = 0; i < cloth.mesh.vertex_count; i++) {
        int column = (int)lroundf(3 * cloth.mesh.uvs[i].x), row = (int)lroundf(3 * cloth.mesh.uvs[i].y);
        vec3s *p = &cloth.mesh.positions[i];
        if (column < 2)
            *p = (vec3s){
                {-0.5f + 0.62f * (float)column + 0.11f * (float)row, heights[row], 0.45f + forward[row]}};
        else
            *p = (vec3s){{column == 2 ? -0.9f : 0.7f, 0.1f, 0.9f - 0.9f * (float)row}};
    }
    for (size_t t = 0; t < cloth.mesh.index_count; t += 3) {
        int floors = 0;
        for (size_t k = 0; k < 3; k++)
            floors += cloth.mesh.uvs[cloth.mesh.indices[t + k]].x > 0.5f;
        if (floors % 3 != 0)
            cloth.mesh.indices[t + 1] = cloth.mesh.indices[t + 2] = cloth.mesh.indices[t];
    }
    return cloth;
}

static void open_layers(struct layers *scene)
{
    *scene = (struct layers){.shapes = {make_cloth()}};
    scene->shapes[1] =
        test_square((vec3s){{0.3f, 0.5f, 0.8f}}, (vec3s){{0.0018f, 0.0006f, 0}}, (vec3s){{0, 0, 1}}, 0.5f, 1);
    for (size_t i = 0; i < scene->shapes[1].mesh.vertex_count; i++) /* 2 mm wide, 0.9 m high, leaning */
        scene->shapes[1].mesh.positions[i] =
            (vec3s){{0.3f + 0.002f * scene->shapes[1].mesh.uvs[i].x + 0.15f * scene->shapes[1].mesh.uvs[i].y,
                     0.95f - 0.9f * scene->shapes[1].mesh.uvs[i].y, 0.5f}};
    tl_surface surfaces[2];
    for (size_t i = 0; i < 2; i++) {
        test_shape_refresh(&scene->shapes[i]);
        surfaces[i] = scene->shapes[i].surface;
        scene->listed[i] = &scene->shapes[i].surface;
    }
    tl_triangle_ranges_make(scene->listed, 2, &scene->ranges);
    tl_shade_materials_make(&scene->materials, scene->listed, 2, 1, tl_detail_options.defaults, 5);
    tl_frame frame = test_frame((vec3s){{0.1f, 0.55f, 2.6f}}, (vec3s){{0, 0.4f, 0}}, 28, surfaces, 2, NULL);
    scene->view = tl_view_make(&frame.camera, WIDTH, HEIGHT);
}

static void close_layers(struct layers *scene)
{
    tl_raster_release(&scene->raster);
    tl_shade_materials_release(&scene->materials);
    tl_triangle_ranges_release(&scene->ranges);
    for (size_t i = 0; i < 2; i++)
        test_shape_release(&scene->shapes[i]);
}

/* All that outlines read of an ID buffer. */
static struct tl_id_buffer ids_of(struct layers *scene, int width, int height)
{
    struct tl_id_buffer ids = {
        .width = width, .height = height, .ids = TL_NEW_ARRAY(uint32_t, (size_t)width * (size_t)height)};
    const struct tl_raster_request request = {scene->listed, 2,      scene->view.view_projection,
                                              width,         height, false};
    tl_raster_draw(&scene->raster, &request, &(struct tl_raster_layers){.nearest = ids.ids});
    return ids;
}

static enum kind kind_of(const struct layers *scene, uint32_t id)
{
    if (id == 0)
        return KIND_NOTHING;
    uint32_t corners[3], number = (id & ~TL_SAMPLE_BACK) - 1;
    size_t index;
    tl_triangle_find(&scene->ranges, number, corners, &index);
    if (index == 1)
        return KIND_BAR;
    if (scene->shapes[0].mesh.uvs[corners[0]].x > 0.5f)
        return KIND_FLOOR;
    return id & TL_SAMPLE_BACK ? KIND_HEM : KIND_FRONT;
}

/* Ramps; the floor's cover is one, too, as the ground's is. x, y: 0 to 1 over the image. */
#define RAMP 0.3f
static void light_of(enum kind kind, float x, float y, float out[4])
{
    static const float bases[KIND_COUNT][3] = {
        {0, 0, 0}, {0.1f, 0.1f, 0.6f}, {1, 0.1f, 0.1f}, {0.1f, 1, 0.1f}, {1, 1, 1}};
    const float slope = kind == KIND_NOTHING ? 0 : RAMP;
    out[0] = bases[kind][0] + slope * x;
    out[1] = bases[kind][1] + slope * y;
    out[2] = bases[kind][2] + slope * (0.7f * x - 0.7f * y);
    out[3] = kind == KIND_NOTHING ? 0 : kind == KIND_FLOOR ? 0.65f + RAMP * x : 1;
}

struct enlarged {
    struct tl_id_buffer samples, pixels;
    float *light, *image;
    struct tl_outlines_counts counts;
};

static struct enlarged enlarge(struct layers *scene, int columns, int rows)
{
    struct enlarged made = {.samples = ids_of(scene, columns, rows),
                            .pixels = ids_of(scene, WIDTH, HEIGHT),
                            .light = TL_NEW_ARRAY(float, 4 * (size_t)columns * (size_t)rows),
                            .image = TL_NEW_ARRAY(float, 4 * PIXELS)};
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            const size_t at = (size_t)y * (size_t)columns + (size_t)x;
            light_of(kind_of(scene, made.samples.ids[at]), ((float)x + 0.5f) / (float)columns,
                     ((float)y + 0.5f) / (float)rows, made.light + 4 * at);
        }
    const struct tl_resample resample = {made.light, columns, rows, made.image, WIDTH, HEIGHT};
    const struct tl_outlines_request request = {.samples = &made.samples,
                                                .pixels = &made.pixels,
                                                .light = made.light,
                                                .ranges = &scene->ranges,
                                                .materials = &scene->materials,
                                                .view = &scene->view};
    tl_resample(&resample);
    made.counts = tl_outlines_draw(&request, made.image);
    return made;
}

static void release(struct enlarged *made)
{
    free(made->samples.ids);
    free(made->pixels.ids);
    free(made->light);
    free(made->image);
}

/* How many of the samples about a pixel, `reach` to each side, are of a kind. All of them are of the image.
 */
static int samples_of(const struct layers *scene, const struct tl_id_buffer *samples, size_t pixel, int reach,
                      enum kind kind)
{
    int count = 0;
    const size_t line = pixel / WIDTH;
    double x = ((double)(pixel % WIDTH) + 0.5) * samples->width / WIDTH - 0.5;
    double y = ((double)line + 0.5) * samples->height / HEIGHT - 0.5;
    for (int j = 1 - reach; j <= reach; j++)
        for (int i = 1 - reach; i <= reach; i++) {
            int column = (int)floor(x) + i, row = (int)floor(y) + j;
            if (column >= 0 && row >= 0 && column < samples->width && row < samples->height)
                count += kind_of(scene, samples->ids[row * samples->width + column]) == kind;
        }
    return count;
}

/* True for a pixel whose 4 x 4 samples are of the image: beyond its border there is no ramp. */
static bool is_inside(const struct tl_id_buffer *samples, size_t pixel)
{
    const size_t line = pixel / WIDTH;
    double x = ((double)(pixel % WIDTH) + 0.5) * samples->width / WIDTH - 0.5;
    double y = ((double)line + 0.5) * samples->height / HEIGHT - 0.5;
    return x >= 1 && y >= 1 && x < samples->width - 2 && y < samples->height - 2;
}

/* Ramps are interpolated exactly between four samples of the pixel's kind. From fewer of them a pixel is as
 * far off as a ramp changes over the distance of the furthest of 4 x 4 samples. */
static void check_pixels(struct layers *scene, int columns, int rows)
{
    struct enlarged made = enlarge(scene, columns, rows);
    const double rough = (double)RAMP * 1.5 * hypot(2, 2) / fmin(columns, rows);
    double worst[3] = {0};
    size_t of[KIND_COUNT] = {0}, four = 0, some = 0, none = 0, miscovered = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const enum kind kind = kind_of(scene, made.pixels.ids[i]);
        const float *pixel = made.image + 4 * i;
        const size_t line = i / WIDTH;
        float expected[4];
        light_of(kind, ((float)(i % WIDTH) + 0.5f) / WIDTH, ((float)line + 0.5f) / HEIGHT, expected);
        double off = 0;
        for (int c = 0; c < 4; c++)
            off = fmax(off, fabs((double)(pixel[c] - expected[c])));
        of[kind]++;
        if (kind != KIND_FLOOR)
            miscovered += pixel[3] != expected[3];
        if (kind == KIND_NOTHING) {
            worst[0] = fmax(worst[0], off);
        } else if (samples_of(scene, &made.samples, i, 1, kind) == 4 && is_inside(&made.samples, i)) {
            worst[0] = fmax(worst[0], off);
            four++;
        } else if (samples_of(scene, &made.samples, i, 2, kind) > 0) {
            worst[1] = fmax(worst[1], off);
            some++;
        } else {
            none++;
            assert_true(pixel[0] + pixel[1] + pixel[2] > 0.2f); /* no black dots */
        }
    }
    printf("%3d x %3d: off by %.1e, at outlines by %.4f (allowed %.4f); pixels of four samples %zu, of some "
           "%zu, of none %zu; kept %zu, blended %zu, nearest %zu, foreign %zu, lost %zu\n",
           columns, rows, worst[0], worst[1], rough, four, some, none, made.counts.kept, made.counts.blended,
           made.counts.nearest, made.counts.foreign, made.counts.lost);
    for (int k = 0; k < KIND_COUNT; k++)
        assert_true(of[k] > (k == KIND_BAR ? 30u : 500u));
    assert_true(four > PIXELS / 4 && some > 500);
    assert_int_equal(miscovered, 0);
    assert_near(worst[0], 0, 1e-5);
    assert_near(worst[1], 0, rough);
    assert_true(made.counts.foreign == none && made.counts.lost == 0);
    assert_int_equal(made.counts.kept + made.counts.blended + made.counts.nearest + none,
                     PIXELS - of[KIND_NOTHING]);
    release(&made);
}

static void test_ramps(void **state)
{
    (void)state;
    static const int sizes[][2] = {{193, 168}, {137, 119}, {115, 100}, {150, 170}, {58, 50}};
    struct layers scene;
    open_layers(&scene);
    for (size_t i = 0; i < TL_COUNT(sizes); i++)
        check_pixels(&scene, sizes[i][0], sizes[i][1]);
    close_layers(&scene);
}

static void test_threads(void **state)
{
    (void)state;
    const int threads = omp_get_max_threads();
    struct layers scene;
    open_layers(&scene);
    struct enlarged one;
    for (int i = 1; i <= 3; i++) {
        omp_set_num_threads(i);
        struct enlarged made = enlarge(&scene, 137, 119);
        if (i == 1) {
            one = made;
            continue;
        }
        assert_memory_equal(made.image, one.image, 4 * PIXELS * sizeof *made.image);
        assert_memory_equal(&made.counts, &one.counts, sizeof made.counts);
        release(&made);
    }
    omp_set_num_threads(threads);
    release(&one);
    close_layers(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ramps), cmocka_unit_test(test_threads)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
