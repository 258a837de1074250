#include "assets/environment/environment.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>

static tl_environment load(const char *path)
{
    tl_environment environment;
    tl_error error;
    assert_ok(tl_environment_load(path, &environment, &error), error);
    return environment;
}

static const float *texel(const tl_environment *environment, int x, int y)
{
    return tl_image_floats(&environment->image) + 3 * (size_t)(y * environment->image.width + x);
}

/* Darkest green of five rows about a place of the picture: the painted axes are black and two texels wide. */
static float darkest(const tl_environment *environment, double u, double v)
{
    int x = (int)(u * environment->image.width), y = (int)(v * environment->image.height);
    float minimum = 1;
    for (int row = y - 2; row <= y + 2; row++)
        minimum = fminf(minimum, texel(environment, x, row)[1]);
    return minimum;
}

/* The OpenEXR project's picture with axes painted on it, read as it is seen: at its centre Y goes up and X to
 * the left, a quarter to the left of that Z goes to the right. Turned or mirrored readings differ. */
static void orientation(void **state)
{
    (void)state;
    tl_environment painted = load(test_data("envmaps/exr/OrientationLatLong.exr"));
    assert_int_equal(painted.layout, TL_ENV_LATLONG);
    assert_true(darkest(&painted, 0.5, 0.45) < 0.1f && darkest(&painted, 0.5, 0.6) > 0.3f);
    assert_true(darkest(&painted, 0.47, 0.5) < 0.1f && darkest(&painted, 0.53, 0.5) > 0.3f);
    assert_true(darkest(&painted, 0.25, 0.45) < 0.1f && darkest(&painted, 0.25, 0.6) > 0.3f);
    assert_true(darkest(&painted, 0.28, 0.5) < 0.1f && darkest(&painted, 0.22, 0.5) > 0.3f);
    tl_environment_release(&painted);
}

/* The texel of a lat-long map that a direction meets (docs/inside.md, conventions: u = 0.5 + atan2(x, -z) /
 * 2pi, v = acos(y) / pi). */
static const float *latlong_towards(const tl_environment *map, const double d[3])
{
    double u = 0.5 + atan2(d[0], -d[2]) / (2 * M_PI), v = acos(d[1]) / M_PI;
    int x = (int)(u * map->image.width), y = (int)(v * map->image.height);
    return texel(map, x < map->image.width ? x : 0, y < map->image.height ? y : map->image.height - 1);
}

/* The unit direction through a texel's centre of a GL cube map (OpenGL 4.5, table 8.19). */
static void cube_direction(int face, double s, double t, double d[3])
{
    const double table[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    double length = sqrt(1 + s * s + t * t);
    for (int i = 0; i < 3; i++)
        d[i] = table[face][i] / length;
}

static double log_luminance(const float *rgb)
{
    return log(1e-3 + 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2]);
}

/* Root mean square difference of the two maps' log luminance when the lat-long map is looked up in a
 * direction with these signs. */
static double difference(const tl_environment *cube, const tl_environment *latlong, const double signs[3])
{
    int side = cube->image.width;
    double sum = 0;
    for (int row = 0; row < 6 * side; row++)
        for (int x = 0; x < side; x++) {
            double d[3];
            cube_direction(row / side, 2 * (x + 0.5) / side - 1, 2 * (row % side + 0.5) / side - 1, d);
            for (int i = 0; i < 3; i++)
                d[i] *= signs[i];
            double gap = log_luminance(texel(cube, x, row)) - log_luminance(latlong_towards(latlong, d));
            sum += gap * gap;
        }
    return sqrt(sum / (6.0 * side * side));
}

/* The OpenEXR project's two renditions of one light probe. The right reading differs by resampling only (its
 * sample positions are half a texel off ours, at edges of a stage full of small lamps); every other sense of
 * an axis differs by as much as unrelated directions do. */
static void a_cube_and_a_latlong_of_one_place_agree(void **state)
{
    (void)state;
    tl_environment cube = load(test_data("envmaps/exr/StageEnvCube.exr"));
    tl_environment latlong = load(test_data("envmaps/exr/StageEnvLatLong.exr"));
    assert_int_equal(cube.layout, TL_ENV_CUBE);
    assert_int_equal(latlong.layout, TL_ENV_LATLONG);
    const double as_is[3] = {1, 1, 1};
    double right = difference(&cube, &latlong, as_is), best_wrong = INFINITY;
    for (int wrong = 1; wrong < 8; wrong++) {
        const double signs[3] = {wrong & 1 ? -1 : 1, wrong & 2 ? -1 : 1, wrong & 4 ? -1 : 1};
        best_wrong = fmin(best_wrong, difference(&cube, &latlong, signs));
    }
    print_message("log luminance differs by %.3f, in the best wrong sense by %.3f\n", right, best_wrong);
    assert_true(4 * right < best_wrong);
    tl_environment_release(&cube);
    tl_environment_release(&latlong);
}

/* The same place as RGBE and as OpenEXR: RGBE keeps 8 bits of a texel's largest channel, 1/128 of it at
 * worst. */
static void formats_agree(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"envmaps/hdr/brown_photostudio_02_1k.hdr", "envmaps/exr/brown_photostudio_02_1k_half_piz_rgba.exr"},
        {"envmaps/hdr/kloppenheim_05_1k.hdr", "envmaps/exr/kloppenheim_05_1k_float_zip.exr"},
        {"envmaps/hdr/studio_small_03_1k.hdr", "envmaps/exr/studio_small_03_1k_half_zip.exr"}};
    for (size_t i = 0; i < TL_COUNT(pairs); i++) {
        tl_environment hdr = load(test_data(pairs[i][0])), exr = load(test_data(pairs[i][1]));
        assert_true(hdr.image.width == exr.image.width && hdr.image.height == exr.image.height);
        for (int y = 0; y < hdr.image.height; y++)
            for (int x = 0; x < hdr.image.width; x++) {
                const float *a = texel(&hdr, x, y), *b = texel(&exr, x, y);
                float largest = fmaxf(b[0], fmaxf(b[1], b[2]));
                for (int c = 0; c < 3; c++)
                    if (fabsf(a[c] - b[c]) > largest / 128 + 1e-7f)
                        assert_near(a[c], b[c], largest / 128);
            }
        tl_environment_release(&hdr);
        tl_environment_release(&exr);
    }
    tl_environment sun = load(test_data("envmaps/hdr/kloppenheim_05_1k.hdr"));
    assert_near(sun.peak, 83456, 0); /* beyond the half range */
    assert_string_equal(sun.name, "kloppenheim_05_1k.hdr");
    tl_environment_release(&sun);
}

/* Values that are no radiance are replaced and counted: the counts are those that OpenEXR's own tools find in
 * R, G and B. */
static void cleaned_values_are_counted(void **state)
{
    (void)state;
    const struct {
        const char *file;
        size_t negative, nan, inf;
    } files[] = {{"envmaps/exr/pmndrs_esplanade_512.exr", 5054, 0, 0},
                 {"exr-features/BrightRingsNanInf.exr", 6, 6, 6}};
    for (size_t i = 0; i < TL_COUNT(files); i++) {
        tl_environment environment = load(test_data(files[i].file));
        assert_int_equal(environment.negative_count, files[i].negative);
        assert_int_equal(environment.nan_count, files[i].nan);
        assert_int_equal(environment.inf_count, files[i].inf);
        float peak = 0;
        for (int k = 0; k < 3 * environment.image.width * environment.image.height; k++) {
            float value = tl_image_floats(&environment.image)[k];
            assert_true(isfinite(value) && value >= 0);
            peak = fmaxf(peak, value);
        }
        assert_near(environment.peak, peak, 0);
        tl_environment_release(&environment);
    }
}

/* ---- Radiance, made by hand ---- */

#define WIDTH 8

/* Two rows of RGBE: row 0 begins with 1 (128/256 * 2^1) in red, everything else is a quarter grey. */
static const uint8_t rgbe[2][WIDTH][4] = {{{128, 0, 0, 129},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127}},
                                          {{128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {128, 128, 128, 127},
                                           {0, 0, 0, 0}}};

static const char *write_picture(const char *header, const uint8_t *data, size_t size)
{
    static const char path[] = TOILE_SCRATCH_DIR "/radiance.hdr";
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fputs(header, stream);
    fwrite(data, 1, size, stream);
    assert_int_equal(fclose(stream), 0);
    return path;
}

#define HEADER "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n"

/* The red texel is at column x and row y, the black one opposite. */
static void check_picture(const char *path, int x, int y, double factor)
{
    tl_environment picture = load(path);
    assert_true(picture.image.width == WIDTH && picture.image.height == 2);
    assert_near(texel(&picture, x, y)[0], 1 * factor, 1e-6);
    assert_near(texel(&picture, x, y)[1], 0, 0);
    assert_near(texel(&picture, WIDTH - 1 - x, 1 - y)[0], 0, 0);
    for (int row = 0; row < 2; row++)
        for (int column = 1; column < WIDTH - 1; column++)
            assert_near(texel(&picture, column, row)[2], 0.25 * factor, 1e-6);
    tl_environment_release(&picture);
}

static void radiance_encodings(void **state)
{
    (void)state;
    check_picture(write_picture(HEADER "-Y 2 +X 8\n", rgbe[0][0], sizeof rgbe), 0, 0, 1);
    /* the old runs: (1, 1, 1, n) repeats the texel before it */
    static const uint8_t old[] = {128, 0,   0,   129, 128, 128, 128, 127, 1, 1, 1, 6,
                                  128, 128, 128, 127, 1,   1,   1,   6,   0, 0, 0, 0};
    check_picture(write_picture(HEADER "-Y 2 +X 8\n", old, sizeof old), 0, 0, 1);
    /* the new ones: component by component, above 128 a run, else literals */
    static const uint8_t new[] = {2,       2,   0,       8,   128 + 8, 128, 1,       0,   128 + 7, 128,
                                  1,       0,   128 + 7, 128, 1,       129, 128 + 7, 127, 2,       2,
                                  0,       8,   128 + 7, 128, 1,       0,   128 + 7, 128, 1,       0,
                                  128 + 7, 128, 1,       0,   128 + 7, 127, 1,       0};
    check_picture(write_picture(HEADER "-Y 2 +X 8\n", new, sizeof new), 0, 0, 1);
}

static void radiance_headers(void **state)
{
    (void)state;
    const uint8_t *data = rgbe[0][0];
    check_picture(write_picture(HEADER "+Y 2 +X 8\n", data, sizeof rgbe), 0, 1, 1);
    check_picture(write_picture(HEADER "-Y 2 -X 8\n", data, sizeof rgbe), WIDTH - 1, 0, 1);
    check_picture(write_picture("#?RGBE\n\n-Y 2 +X 8\n", data, sizeof rgbe), 0, 0, 1);
    /* exposures multiply; radiance is what is stored over their product */
    check_picture(write_picture("#?RADIANCE\nEXPOSURE=4\nEXPOSURE=0.5\n\n-Y 2 +X 8\n", data, sizeof rgbe), 0,
                  0, 0.5);
    static const char *const refused[] = {HEADER "+X 8 -Y 2\n",
                                          HEADER "-Y 0 +X 8\n",
                                          HEADER "-Y 2 +X -8\n",
                                          HEADER "-Y 2 +X 100000\n",
                                          HEADER "-Y 3 +X 8\n",
                                          HEADER,
                                          "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 8\n"};
    for (size_t i = 0; i < TL_COUNT(refused); i++) {
        tl_environment environment;
        tl_error error;
        assert_false(tl_environment_load(write_picture(refused[i], data, sizeof rgbe), &environment, &error));
        assert_non_null(strstr(error.message, "radiance.hdr"));
    }
}

/* Six faces side by side become six stacked ones; any other shape is lat-long. */
static void horizontal_cubes_are_stacked(void **state)
{
    (void)state;
    uint8_t data[2][12][4];
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 12; x++) {
            const uint8_t value[4] = {(uint8_t)(128 + x / 2), (uint8_t)(128 + x % 2), (uint8_t)(128 + y),
                                      136};
            memcpy(data[y][x], value, 4);
        }
    tl_environment cube = load(write_picture(HEADER "-Y 2 +X 12\n", data[0][0], sizeof data));
    assert_int_equal(cube.layout, TL_ENV_CUBE);
    assert_true(cube.image.width == 2 && cube.image.height == 12);
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 2; x++) {
            int face = y / 2;
            assert_near(texel(&cube, x, y)[0], 128 + face, 0);
            assert_near(texel(&cube, x, y)[1], 128 + x, 0);
            assert_near(texel(&cube, x, y)[2], 128 + y % 2, 0);
        }
    tl_environment_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radiance_encodings),
        cmocka_unit_test(radiance_headers),
        cmocka_unit_test(horizontal_cubes_are_stacked),
        cmocka_unit_test(orientation),
        cmocka_unit_test(a_cube_and_a_latlong_of_one_place_agree),
        cmocka_unit_test(formats_agree),
        cmocka_unit_test(cleaned_values_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
