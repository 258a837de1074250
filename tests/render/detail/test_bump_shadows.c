/* The shadows that bumps cast on their own surface, as lamps see them: horizon maps and the march of the
 * shaders against a march in double through the same heights, front and back, under
 * low lamps. On a flat square of white cloth, light with shadows over light without is the mask. */
#include "tests/render/height_oracle.h"
#include "tests/render/scenes.h"

#include "assets/weave/weave.h"
#include "config/base/memory.h"
#include "render/detail/detail.h"

#include "tests/testing.h"

#define SIDE  96 /* pixels: as large as the weave's texels */
#define HALF  0.06f
#define WAVES 3 /* of the ripples, over the square */
#define DEPTH 0.016

struct bench {
    struct test_scene scene;
    tl_image ripples;
    tl_weave weave;
    struct tl_detail_heights heights; /* what the renderer makes of either */
    bool behind;                      /* seen and lit from the back */
};

/* Seen from so far away that all rays are nearly parallel. */
static void bench_open(struct bench *bench, vec3s eye)
{
    struct test_shape square =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, HALF, 2);
    *bench = (struct bench){.behind = eye.z < 0};
    square.material.diffuse = (vec3s){{1, 1, 1}};
    square.material.specular = (vec3s){{0, 0, 0}};
    square.material.double_sided = true;
    test_scene_open_lamplit(&bench->scene, square, SIDE, SIDE);
    bench->scene.frame.camera.eye = eye;
    bench->scene.frame.camera.target = (vec3s){{0, 0, 0}};
    bench->scene.frame.camera.fov_y = 2 * atanf(HALF / glms_vec3_norm(eye));
    bench->scene.settings.detail.steps = 128;
}

static void bench_refresh(struct bench *bench)
{
    const struct test_shape *square = &bench->scene.shapes[0];
    test_scene_refresh(&bench->scene);
    assert_true(
        tl_detail_heights_make(&square->material, square->mesh.parts[0].uv_metres, 1, &bench->heights));
}

static void bench_close(struct bench *bench)
{
    test_scene_close(&bench->scene);
    tl_detail_heights_release(&bench->heights);
    tl_image_release(&bench->ripples);
    tl_weave_release(&bench->weave);
}

static void use_ripples(struct bench *bench)
{
    enum { TEXELS = 96 };
    bench->ripples = tl_image_create(TEXELS, TEXELS, 1, TL_IMAGE_F32);
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        int column = i % TEXELS;
        double turn = 2 * M_PI * WAVES * (column + 0.5) / TEXELS;
        tl_image_floats(&bench->ripples)[i] = (float)(0.5 + 0.5 * cos(turn));
    }
    tl_material *material = &bench->scene.shapes[0].material;
    material->height_map.image = &bench->ripples;
    material->height_m = (float)DEPTH;
    bench_refresh(bench);
}

static void use_weave(struct bench *bench)
{
    const struct tl_weave_params params = {.pattern = TL_WEAVE_PLAIN,
                                           .warp_pitch_mm = 20,
                                           .weft_pitch_mm = 20,
                                           .crimp_mm = 5,
                                           .warp_tint = {1, 1, 1},
                                           .weft_tint = {1, 1, 1},
                                           .texels_per_yarn = 16};
    assert_true(tl_weave_create(&params, &bench->weave));
    bench->scene.shapes[0].material.weave = &bench->weave;
    bench_refresh(bench);
}

/* UV of the mesh that a pixel sees: the square fills the picture, which the back mirrors. */
static vec2s pixel_uv(const struct bench *bench, int pixel)
{
    int column = bench->behind ? SIDE - 1 - pixel % SIDE : pixel % SIDE, row = pixel / SIDE;
    return (vec2s){{((float)column + 0.5f) / SIDE, ((float)row + 0.5f) / SIDE}};
}

/* ---- Truths: whether light reaches a place of the field ---- */

/* For the cosine of the ripples, along x: no crest farther than one wave can be the first occluder. */
static bool clears_ripples(const struct bench *bench, double u, double v, vec3s light)
{
    (void)bench;
    (void)v;
    double along = (double)light.x, k = 2 * M_PI * WAVES / (2 * (double)HALF), x = u * 2 * (double)HALF;
    double from = 0.5 * DEPTH * cos(k * x), climb = (double)light.z / fabs(along);
    for (int i = 1; i <= 500; i++) {
        double way = i / 500.0 * 2 * M_PI / k;
        if (0.5 * DEPTH * cos(k * (x + copysign(way, along))) > from + climb * way)
            return false;
    }
    return true;
}

static const struct tl_height_field *field_of(const struct bench *bench)
{
    return bench->behind ? &bench->heights.back : &bench->heights.field;
}

/* By fifths of a texel, until the ray is over everything. */
static bool marches_free(const struct bench *bench, double u, double v, vec3s light)
{
    const struct tl_height_field *field = field_of(bench);
    double from = height_at(field, u, v), flat = hypot((double)light.x, (double)light.y);
    double climb = (double)light.z / flat, x = (double)light.x / flat, y = (double)light.y / flat;
    double step = 0.2 / ((double)field->repeats_per_m[0] * field->heights->width);
    for (double way = step; from + climb * way < (double)field->high_m; way += step) {
        double du = (double)field->repeats_per_m[0] * x * way, dv = (double)field->repeats_per_m[3] * y * way;
        if (height_at(field, u + du, v + dv) > from + climb * way)
            return false;
    }
    return true;
}

/* ---- Masks ---- */

struct verdict {
    double agree; /* share of pixels */
    double off;   /* root mean square error of the light over its mean */
};

typedef bool truth_of(const struct bench *bench, double u, double v, vec3s light);

/* Pixels whose own slope faces away from all light are ignored. */
static struct verdict judge(const tl_image *open, const tl_image *shadowed, const bool *lit)
{
    double agreed = 0, squares = 0, sum = 0;
    int pixels = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double all = (double)test_pixel(open, i % SIDE, i / SIDE)[0];
        if (all < 1e-4)
            continue;
        double mask = (double)test_pixel(shadowed, i % SIDE, i / SIDE)[0] / all;
        pixels++;
        agreed += (mask > 0.5) == lit[i];
        squares += all * all * (mask - lit[i]) * (mask - lit[i]);
        sum += lit[i] ? all : 0;
    }
    assert_true(pixels > SIDE * SIDE / 10);
    return (struct verdict){agreed / pixels, sqrt(squares / pixels) / (sum / pixels)};
}

static vec3s lamp_from(int degrees, int turn)
{
    float up = glm_rad((float)degrees), about = glm_rad((float)turn);
    return (vec3s){{cosf(up) * cosf(about), cosf(up) * sinf(about), sinf(up)}};
}

#define TURNS 3

/* By lamp. Shadows change the program and its maps, lamps do not. */
static void draw_all(struct bench *bench, struct test_device *device, int shadow, const vec3s lights[],
                     tl_image images[])
{
    bench->scene.settings.detail.shadow = shadow;
    for (int i = 0; i < TURNS; i++) {
        vec3s light = lights[i];
        light.z *= bench->behind ? -1 : 1;
        bench->scene.lamps[0] = test_lamp_towards(light, 3);
        images[i] = test_scene_draw(&bench->scene, device->renderer);
    }
}

static void find_lit(const struct bench *bench, truth_of *truth, vec3s light, bool *lit)
{
    const float *rows = bench->heights.rows;
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec2s uv = pixel_uv(bench, i);
        lit[i] = truth(bench, (double)(rows[0] * uv.x + rows[2]), (double)(rows[4] * uv.y + rows[5]), light);
    }
}

/* By enum tl_detail_shadow, the worst of all turns of the lamp. */
static void judge_all(struct bench *bench, struct test_device *device, int degrees, truth_of *truth,
                      struct verdict worst[3])
{
    static bool lit[SIDE * SIDE];
    const vec3s lights[TURNS] = {lamp_from(degrees, 0), lamp_from(degrees, 67), lamp_from(degrees, 202)};
    tl_image images[3][TURNS];
    for (int shadow = 0; shadow < 3; shadow++)
        draw_all(bench, device, shadow, lights, images[shadow]);
    for (int i = 0; i < TURNS; i++) {
        find_lit(bench, truth, lights[i], lit);
        for (int shadow = 0; shadow < 3; shadow++) {
            struct verdict found = judge(&images[TL_DETAIL_SHADOW_NONE][i], &images[shadow][i], lit);
            worst[shadow].agree = fmin(worst[shadow].agree, found.agree);
            worst[shadow].off = fmax(worst[shadow].off, found.off);
        }
    }
    for (int i = 0; i < 3 * TURNS; i++)
        tl_image_release(&images[i / TURNS][i % TURNS]);
}

/* Horizons are bytes at texels, between which a yarn's border is half in shadow: one pixel in twenty may lie
 * there. */
static void check(struct bench *bench, struct test_device *device, const char *name, truth_of *truth)
{
    static const char *const names[] = {"none", "horizon", "relief"};
    const double minimum[] = {0, 0.95, 0.99};
    for (int degrees = 5; degrees <= 15; degrees += 10) {
        struct verdict worst[3] = {{1, 0}, {1, 0}, {1, 0}};
        judge_all(bench, device, degrees, truth, worst);
        printf("%s, lamp at %2d degrees:", name, degrees);
        for (int shadow = 0; shadow < 3; shadow++)
            printf("%s %s %.2f %%, light off by %.1f %%", shadow ? ";" : "", names[shadow],
                   100 * worst[shadow].agree, 100 * worst[shadow].off);
        printf("\n");
        for (int shadow = 1; shadow < 3; shadow++)
            assert_true(worst[shadow].agree >= minimum[shadow]);
        assert_true(worst[1].off < 0.6 * worst[0].off); /* nearer to the truth than no shadow */
        assert_true(worst[2].off < worst[1].off);
    }
}

static const vec3s above = {{0, 0, 4}}, below = {{0, 0, -4}};

static void test_ripples(void **state)
{
    struct bench bench;
    bench_open(&bench, above);
    use_ripples(&bench);
    check(&bench, *state, "ripples", clears_ripples);
    bench_close(&bench);
}

static void test_weave(void **state)
{
    struct bench bench;
    bench_open(&bench, above);
    use_weave(&bench);
    check(&bench, *state, "weave", marches_free);
    bench_close(&bench);
}

/* The back is the same sheet from below: its valleys are the front's crests. */
static void test_back(void **state)
{
    struct bench bench;
    bench_open(&bench, below);
    use_weave(&bench);
    check(&bench, *state, "the weave's back", marches_free);
    bench_close(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ripples), cmocka_unit_test(test_weave),
                                       cmocka_unit_test(test_back)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
