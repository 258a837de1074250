/* Photometric stereo against pictures whose normals, colours and gloss are known in closed form: waves of two
 * colours, lit by this file's own formulas, darkened towards the corners, with noise, as PNG files of 8 bits.
 * The tolerances are the stated ones: 3 degrees and 3 %. The table that it prints is that of
 * docs/fabrics.md. */
#include "tests/testing.h"

#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "assets/swatch/swatch.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <string.h>

enum { SIDE = 96 };
#define WIDTH_MM 40.0
#define DEGREE   (3.14159265358979323846 / 180)

struct scene {
    int lamps;
    double noise, off_deg; /* of values; of the first lamp's azimuth, in the file of lamps */
    double corner, specular, exponent;
    bool near, is_dark; /* lamps with positions; a cast shadow crosses each picture */
};

struct lamp {
    double azimuth_deg, elevation_deg, at[3];
};

static struct lamp lamp_of(const struct scene *scene, int k)
{
    struct lamp lamp = {360.0 * k / scene->lamps + 10, k % 2 ? 60 : 40, {0}};
    double far = 90 + 10 * k, azimuth = lamp.azimuth_deg * DEGREE, elevation = lamp.elevation_deg * DEGREE;
    lamp.at[0] = far * cos(azimuth) * cos(elevation);
    lamp.at[1] = far * sin(azimuth) * cos(elevation);
    lamp.at[2] = far * sin(elevation);
    return lamp;
}

static void unit(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void place(int column, int row, double *x, double *y)
{
    *x = WIDTH_MM * ((column + 0.5) / SIDE - 0.5);
    *y = -WIDTH_MM * ((row + 0.5) / SIDE - 0.5);
}

/* Slopes of two waves; higher along y than along x, so that no axis stands for the other. */
static void normal_at(double x, double y, double n[3])
{
    n[0] = -0.35 * cos(2 * 3.14159265358979 * x / 8);
    n[1] = -0.55 * cos(2 * 3.14159265358979 * (y + 0.5 * x) / 10);
    n[2] = 1;
    unit(n);
}

static const double colours[2][3] = {{0.5, 0.2, 0.1}, {0.25, 0.3, 0.4}};
static const double *colour_at(int column, int row)
{
    return colours[(column / 12 + row / 12) % 2];
}

static double noise_of(uint32_t seed)
{
    double sum = 0;
    for (int i = 0; i < 12; i++) {
        seed = seed * 747796405u + 2891336453u;
        uint32_t word = ((seed >> ((seed >> 28) + 4)) ^ seed) * 277803737u;
        sum += (double)((word >> 22) ^ word) / 4294967296.0;
    }
    return sum - 6;
}

static double srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static double mean_distance(const struct scene *scene)
{
    double sum = 0;
    for (int k = 0; k < scene->lamps; k++)
        sum += 90 + 10 * k;
    return sum / scene->lamps;
}

static void shade(const struct scene *scene, int k, int column, int row, double out[3])
{
    struct lamp lamp = lamp_of(scene, k);
    double x, y, n[3], l[3], e = 0.9;
    place(column, row, &x, &y);
    normal_at(x, y, n);
    memcpy(l, lamp.at, sizeof l);
    if (scene->near) {
        l[0] -= x;
        l[1] -= y;
        e *= pow(mean_distance(scene), 2) / dot(l, l);
    }
    unit(l);
    double facing = fmax(dot(n, l), 0), mirrored = fmax(2 * n[2] * dot(n, l) - l[2], 0),
           q = 2 * (x * x + y * y) / (WIDTH_MM * WIDTH_MM), lens = 1 - (1 - scene->corner) * q;
    bool is_dark = scene->is_dark && (column + 13 * k) % SIDE < SIDE / (scene->lamps + 2);
    for (int c = 0; c < 3; c++) {
        double light = e * (colour_at(column, row)[c] * facing +
                            scene->specular * (scene->exponent + 1) / 2 * pow(mirrored, scene->exponent));
        uint32_t seed = (uint32_t)(((k * SIDE + row) * SIDE + column) * 3 + c);
        out[c] = (is_dark ? 0 : light * lens) + scene->noise * noise_of(seed * 2654435761u + 17);
    }
}

static tl_image picture_of(const struct scene *scene, int k)
{
    tl_image picture = tl_image_create(SIDE, SIDE, 3, TL_IMAGE_U8);
    double light[3];
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++) {
            shade(scene, k, column, row, light);
            for (int c = 0; c < 3; c++)
                tl_image_bytes(&picture)[3 * (row * SIDE + column) + c] =
                    (uint8_t)(255 * srgb(fmin(fmax(light[c], 0), 1)) + 0.5);
        }
    return picture;
}

static char folder[] = "/tmp/toile_swatch_XXXXXX";
static char *file_of(const char *name)
{
    return tl_format("%s/%s", folder, name);
}

static void write_text(const char *path, const char *text)
{
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
}

static void write_rig(const struct scene *scene, const char *path)
{
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fprintf(stream, "swatch: {width_mm: %g, even: %s}\nlamps:\n", WIDTH_MM,
            scene->corner < 1 ? "true" : "false");
    for (int k = 0; k < scene->lamps; k++) {
        struct lamp lamp = lamp_of(scene, k);
        double off = k == 0 ? scene->off_deg : 0;
        if (scene->near)
            fprintf(stream, "  - {position_mm: [%.9g, %.9g, %.9g], intensity: 0.9}\n", lamp.at[0], lamp.at[1],
                    lamp.at[2]);
        else
            fprintf(stream, "  - {azimuth_deg: %g, elevation_deg: %g, intensity: 0.9}\n",
                    lamp.azimuth_deg + off, lamp.elevation_deg);
    }
    fclose(stream);
}

static void solve(const struct scene *scene, struct tl_swatch_maps *out)
{
    tl_error error = {0};
    struct tl_swatch_rig rig;
    tl_image pictures[TL_SWATCH_LAMPS_MAX];
    char *lamps = file_of("lamps.yaml"), *file = file_of("picture.png");
    write_rig(scene, lamps);
    assert_ok(tl_swatch_rig_load(lamps, &rig, &error), error);
    assert_int_equal(rig.count, scene->lamps);
    for (int k = 0; k < scene->lamps; k++) {
        tl_image picture = picture_of(scene, k);
        assert_ok(tl_image_save_png(file, &picture, &error), error);
        tl_image_release(&picture);
        assert_ok(tl_swatch_picture_load(file, &pictures[k], &error), error);
    }
    assert_ok(tl_swatch_solve(&rig, pictures, out, &error), error);
    for (int k = 0; k < scene->lamps; k++)
        tl_image_release(&pictures[k]);
    free(lamps);
    free(file);
}

/* The mean angle between normals, in degrees, and the relative error of colours in the root mean square. */
struct errors {
    double normal_deg, albedo;
};
static struct errors compare(const struct tl_swatch_maps *swatch)
{
    double angle = 0, squares = 0, sum = 0;
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++) {
            double x, y, n[3];
            const float *own = tl_image_floats(&swatch->normal) + (size_t)3 * (size_t)(row * SIDE + column);
            const float *albedo =
                tl_image_floats(&swatch->albedo) + (size_t)3 * (size_t)(row * SIDE + column);
            place(column, row, &x, &y);
            normal_at(x, y, n);
            const double found[3] = {(double)own[0], (double)own[1], (double)own[2]};
            angle += acos(fmin(dot(n, found), 1)) / DEGREE;
            for (int c = 0; c < 3; c++) {
                squares += pow((double)albedo[c] - colour_at(column, row)[c], 2);
                sum += pow(colour_at(column, row)[c], 2);
            }
        }
    return (struct errors){angle / (SIDE * SIDE), sqrt(squares / sum)};
}

static struct errors check(const char *name, const struct scene *scene, double normal_deg, double albedo)
{
    struct tl_swatch_maps swatch;
    solve(scene, &swatch);
    struct errors errors = compare(&swatch);
    printf("%-44s normals %5.2f degrees, albedo %5.2f %%, residual %5.2f %%, lean %4.2f, corner %.3f, gloss "
           "%.3f %.4f\n",
           name, errors.normal_deg, 100 * errors.albedo, 100 * (double)swatch.residual,
           (double)swatch.lean_deg, (double)swatch.corner, (double)swatch.glossiness,
           (double)swatch.specular);
    if (!(errors.normal_deg <= normal_deg) || !(errors.albedo <= albedo)) {
        print_error("%s: expected %g degrees and %g\n", name, normal_deg, albedo);
        fail();
    }
    if (scene->corner < 1)
        assert_near(swatch.corner, scene->corner, 0.015);
    tl_swatch_release(&swatch);
    return errors;
}

/* Without a fault of the pictures only their 256 levels are left. */
static void test_pictures_without_faults(void **state)
{
    (void)state;
    const int counts[] = {4, 6, 8, 12};
    for (size_t i = 0; i < TL_COUNT(counts); i++) {
        char *name = tl_format("%d lamps", counts[i]);
        check(name, &(struct scene){.lamps = counts[i], .corner = 1}, 0.6, 0.012);
        free(name);
    }
}

static void test_pictures_with_faults(void **state)
{
    (void)state;
    const int counts[] = {4, 6, 8, 12};
    for (size_t i = 0; i < TL_COUNT(counts); i++) {
        char *name = tl_format("%d lamps, noise 1 %%, corners -15 %%", counts[i]);
        check(name, &(struct scene){.lamps = counts[i], .noise = 0.01, .corner = 0.85}, 3, 0.03);
        free(name);
        name = tl_format("%d lamps, ... first lamp 5 degrees off", counts[i]);
        check(name, &(struct scene){.lamps = counts[i], .noise = 0.01, .corner = 0.85, .off_deg = 5}, 3,
              0.03);
        free(name);
    }
}

static void test_near_lamps(void **state)
{
    (void)state;
    check("8 lamps at 90 to 160 mm", &(struct scene){.lamps = 8, .corner = 1, .near = true}, 0.6, 0.012);
}

/* A lamp that is in the shade of something lights nothing there: the others do. */
static void test_cast_shadows(void **state)
{
    (void)state;
    check("8 lamps, a tenth of each picture in shade",
          &(struct scene){.lamps = 8, .noise = 0.005, .corner = 1, .is_dark = true}, 3, 0.03);
}

static void test_gloss(void **state)
{
    (void)state;
    struct tl_swatch_maps swatch;
    const struct scene glossy = {.lamps = 12, .noise = 0.005, .corner = 1, .specular = 0.04, .exponent = 12};
    check("12 lamps, gloss 0.917 of 0.04", &glossy, 2, 0.03);
    solve(&glossy, &swatch);
    assert_true(swatch.has_gloss);
    assert_near(swatch.glossiness, 1 - 1 / glossy.exponent, 0.01);
    assert_near(swatch.specular, glossy.specular, 0.05 * glossy.specular);
    tl_swatch_release(&swatch);
    solve(&(struct scene){.lamps = 8, .noise = 0.005, .corner = 1}, &swatch);
    assert_true(swatch.has_gloss && swatch.specular == 0); /* matt cloth */
    tl_swatch_release(&swatch);
}

/* Every lamp counts: a brighter picture moves the normals. */
static void test_each_lamp_counts(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_swatch_rig rig = {.width_mm = 10, .count = 4};
    tl_image pictures[4];
    struct tl_swatch_maps swatch;
    for (int k = 0; k < 4; k++)
        rig.lamps[k] = (struct tl_swatch_lamp){90.0f * (float)k, 45, {0}, 1};
    for (int bright = 0; bright < 4; bright++) {
        for (int k = 0; k < 4; k++) {
            pictures[k] = tl_image_create(16, 16, 3, TL_IMAGE_F32);
            for (int i = 0; i < 16 * 16 * 3; i++)
                tl_image_floats(&pictures[k])[i] = k == bright ? 0.31f : 0.3f;
        }
        assert_ok(tl_swatch_solve(&rig, pictures, &swatch, &error), error);
        /* Level cloth whose picture is brighter leans to that lamp: b = (M^-1) sum l_k I_k, by hand. */
        double lean = atan(0.01 / sqrt(2) / ((1.21) / (2 * sqrt(2)) * 1)) / DEGREE;
        assert_near(swatch.lean_deg, lean, 0.3 * lean);
        assert_true(swatch.lamps[bright].used > 0.5f);
        assert_false(swatch.has_gloss); /* no lamp is within 45 degrees of the mirror direction */
        tl_swatch_release(&swatch);
        for (int k = 0; k < 4; k++)
            tl_image_release(&pictures[k]);
    }
}

static void refuse(const char *text, const char *expected)
{
    tl_error error = {0};
    struct tl_swatch_rig rig;
    char *path = file_of("bad.yaml");
    write_text(path, text);
    assert_false(tl_swatch_rig_load(path, &rig, &error));
    assert_null(strchr(error.message, '\n'));
    if (!strstr(error.message, expected)) {
        print_error("%s: expected %s\n", error.message, expected);
        fail();
    }
    free(path);
}

#define LAMP(azimuth, elevation) "  - {azimuth_deg: " azimuth ", elevation_deg: " elevation "}\n"
#define HEAD                     "swatch: {width_mm: 40}\nlamps:\n"

static void test_bad_lamps(void **state)
{
    (void)state;
    refuse(HEAD LAMP("0", "45") LAMP("90", "45") LAMP("180", "45"), "at least 4");
    refuse(HEAD LAMP("0", "45") LAMP("0", "60") LAMP("180", "45") LAMP("180", "60"), "one plane");
    refuse(HEAD LAMP("0", "88") LAMP("90", "88") LAMP("180", "88") LAMP("270", "88"), "one direction");
    refuse(HEAD LAMP("0", "45") LAMP("90", "-45"), "bad.yaml:4: lamps.elevation_deg");
    refuse(HEAD "  - {position_mm: [10, 10, -50]}\n", "bad.yaml:3: lamps.position_mm");
    refuse(HEAD "  - {azimut_deg: 3}\n", "azimuth_deg");
    refuse("lamps: {azimuth_deg: 3}\n", "expected a list");
    refuse("lamps: [3]\n", "option: value");
    refuse("swatch: [{width_mm: 3}]\n", "is no table");
    refuse("lamps:\n" LAMP("0", "45") LAMP("90", "45") LAMP("180", "45") LAMP("270", "45"),
           "width_mm: is missing");
}

static void test_bad_pictures(void **state)
{
    (void)state;
    tl_error error = {0};
    char *path = file_of("bright.png"), *exr = file_of("nan.exr");
    tl_image picture = tl_image_create(16, 16, 3, TL_IMAGE_U8), read;
    memset(tl_image_bytes(&picture), 255, (size_t)16 * 3 * 2);
    assert_ok(tl_image_save_png(path, &picture, &error), error);
    assert_false(tl_swatch_picture_load(path, &read, &error));
    assert_non_null(strstr(error.message, "12 % of it is saturated"));
    tl_image_release(&picture);
    picture = tl_image_create(4, 4, 3, TL_IMAGE_F32);
    tl_image_floats(&picture)[7] = NAN;
    static const char *const names[] = {"R", "G", "B"};
    const struct tl_exr_layer layer = {names, &picture};
    assert_ok(tl_exr_save(exr, &layer, 1, &error), error);
    assert_false(tl_swatch_picture_load(exr, &read, &error));
    assert_non_null(strstr(error.message, "not finite"));
    tl_image_release(&picture);
    free(path);
    free(exr);
}

/* Nothing is made up of two lamps. */
static void test_too_dark(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_swatch_rig rig = {.width_mm = 10, .count = 4};
    tl_image pictures[4];
    struct tl_swatch_maps swatch;
    for (int k = 0; k < 4; k++) {
        rig.lamps[k] = (struct tl_swatch_lamp){90.0f * (float)k, 45, {0}, 1};
        pictures[k] = tl_image_create(16, 16, 3, TL_IMAGE_F32);
        for (int i = 0; i < 16 * 16 * 3; i++)
            tl_image_floats(&pictures[k])[i] = k < 2 || i % 7 ? 0.3f : 0;
    }
    for (int k = 0; k < 2; k++)
        memset(tl_image_floats(&pictures[k]), 0, sizeof(float) * 3 * (size_t)32);
    assert_false(tl_swatch_solve(&rig, pictures, &swatch, &error));
    assert_non_null(strstr(error.message, "fewer than three lamps"));
    for (int k = 0; k < 4; k++)
        tl_image_release(&pictures[k]);
}

int main(void)
{
    if (!mkdtemp(folder))
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures_without_faults),
        cmocka_unit_test(test_pictures_with_faults),
        cmocka_unit_test(test_near_lamps),
        cmocka_unit_test(test_cast_shadows),
        cmocka_unit_test(test_gloss),
        cmocka_unit_test(test_each_lamp_counts),
        cmocka_unit_test(test_bad_lamps),
        cmocka_unit_test(test_bad_pictures),
        cmocka_unit_test(test_too_dark),
    };
    return cmocka_run_group_tests_name("swatch", tests, NULL, NULL);
}
