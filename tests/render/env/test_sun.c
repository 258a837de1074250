/* Suns: found wherever they stand, measured as they are, taken out without losing light; area lights stay. */
#include "render/env/sun.h"

#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "render/env/resample.h"

#include "tests/testing.h"

#include <string.h>

#define DEGREE (M_PI / 180)

/* A disc of light in a sky of radiance 1. */
struct disc {
    vec3s centre;
    double radius; /* rad */
    double share;  /* of all light, with the sky */
};

static double disc_solid_angle(const struct disc *disc)
{
    return 2 * M_PI * (1 - cos(disc->radius));
}

/* Radiance that gives the disc its share of sky and disc. */
static double disc_radiance(const struct disc *disc)
{
    return disc->share / (1 - disc->share) * 4 * M_PI / disc_solid_angle(disc);
}

static vec3s image_direction(const tl_image *image, double x, double y)
{
    double phi = (x / image->width - 0.5) * 2 * M_PI, theta = y / image->height * M_PI;
    return (vec3s){{(float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(-sin(theta) * cos(phi))}};
}

static bool is_within(vec3s direction, const struct disc *disc, double margin)
{
    double chord = (double)glms_vec3_distance(direction, glms_vec3_normalize(disc->centre));
    return chord < 2 * sin(disc->radius / 2) + margin;
}

/* The share of texel (x, y) that the disc covers, by 8 x 8 points weighted by their solid angle. */
static double coverage(const tl_image *image, int x, int y, const struct disc *disc)
{
    double covered = 0, total = 0;
    for (int row = 0; row < 8; row++) {
        double weight = sin((y + (row + 0.5) / 8) / image->height * M_PI);
        for (int column = 0; column < 8; column++) {
            vec3s direction = image_direction(image, x + (column + 0.5) / 8, y + (row + 0.5) / 8);
            covered += is_within(direction, disc, 0) ? weight : 0;
            total += weight;
        }
    }
    return covered / total;
}

/* Lat-long; red, green, blue as 1 : 0.9 : 0.8. */
static tl_environment sky_with(const struct disc *discs, int count, int width)
{
    static const float tint[3] = {1, 0.9f, 0.8f};
    tl_environment sky = {.layout = TL_ENV_LATLONG,
                          .image = tl_image_create(width, width / 2, 3, TL_IMAGE_F32)};
    float *texel = tl_image_floats(&sky.image);
    for (int y = 0; y < width / 2; y++) {
        for (int x = 0; x < width; x++, texel += 3) {
            double radiance = 1;
            vec3s middle = image_direction(&sky.image, x + 0.5, y + 0.5);
            for (int k = 0; k < count; k++)
                if (is_within(middle, &discs[k], 2 * M_PI / width))
                    radiance += disc_radiance(&discs[k]) * coverage(&sky.image, x, y, &discs[k]);
            for (int c = 0; c < 3; c++)
                texel[c] = tint[c] * (float)radiance;
        }
    }
    return sky;
}

static void sum_light(const tl_cube *cube, const struct tl_suns *suns, double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0;
    for (int i = 0; i < 6 * cube->size * cube->size; i++) {
        double area = (double)tl_cube_solid_angle(cube->size, i % cube->size, i / cube->size % cube->size);
        for (size_t c = 0; c < 3; c++)
            sum[c] += area * (double)cube->texels[3 * (size_t)i + c];
    }
    for (int i = 0; i < suns->count; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)suns->items[i].power.raw[c];
}

/* The cube of the last size requested, cached, because making it would take most of the time. */
static struct tl_resampling resampling;

/* Takes the suns of a cube of `size`; no light may be lost but by the rounding of floats, and what is left
 * must be light. */
static struct tl_suns take(const tl_environment *environment, int size, tl_cube *left)
{
    tl_cube cube = tl_cube_from_environment_with(environment, size, &resampling);
    struct tl_suns suns = {0};
    double before[3], after[3];
    sum_light(&cube, &suns, before);
    tl_suns_extract(&cube, environment, &suns);
    sum_light(&cube, &suns, after);
    for (int c = 0; c < 3; c++)
        assert_near(after[c], before[c], 1e-6 * before[c]);
    for (int i = 0; i < 18 * size * size; i++)
        assert_true(isfinite(cube.texels[i]) && cube.texels[i] >= 0);
    if (left)
        *left = cube;
    else
        tl_cube_release(&cube);
    return suns;
}

static double degrees_between(vec3s a, vec3s b)
{
    return 2 * asin(fmin((double)glms_vec3_distance(a, b) / 2, 1)) / DEGREE;
}

/* Sixteen directions inside the disc, the first nearest to its centre, all different, their mean the centre.
 * Sixteen equal cells of a disc, each seen at its centroid, lose the cells' own variance, a sixteenth when
 * they are as compact as the disc: of the radius 3 %; 10 % leaves room for cells of ragged shape. */
static void check_samples(const struct tl_sun *sun)
{
    vec3s mean = {{0, 0, 0}};
    double squares = 0;
    assert_int_equal(sun->sample_count, TL_SUN_SAMPLES_MAX);
    for (int i = 0; i < sun->sample_count; i++) {
        double degrees = degrees_between(sun->samples[i], sun->direction);
        assert_near(glms_vec3_norm(sun->samples[i]), 1, 1e-5);
        assert_true(degrees >= degrees_between(sun->samples[0], sun->direction));
        assert_true(degrees < 1.2 * (double)sun->radius / DEGREE);
        squares += degrees * degrees / sun->sample_count;
        mean = glms_vec3_add(mean, glms_vec3_scale(sun->samples[i], 1 / (float)sun->sample_count));
        for (int k = 0; k < i; k++)
            assert_true(glms_vec3_distance(sun->samples[i], sun->samples[k]) > 0);
    }
    assert_true(degrees_between(glms_vec3_normalize(mean), sun->direction) <
                0.1 * (double)sun->radius / DEGREE);
    double radius = sqrt(2 * squares) * DEGREE;
    assert_true(radius > 0.9 * (double)sun->radius && radius < 1.02 * (double)sun->radius);
}

/* At the middle of a face, on an edge and in a corner of the cube, at the poles and on the seam of the map.
 * The image spreads light over its texels of d = 0.35 degrees, and again where they are read as even squares:
 * each time by d^2 / 12 along both axes, so that R^2 becomes R^2 + 2 d^2 / 3 (less where meridians meet). */
static void suns_are_found_everywhere(void **state)
{
    (void)state;
    const vec3s places[] = {{{0.1f, 0.2f, -1}}, {{1, 0.3f, 1}}, {{1, 1, 1}},        {{-1, 1, -1}},
                            {{0, 1, 0}},        {{0, -1, 0}},   {{0.02f, 0.3f, 1}}, {{0.01f, 1, 0.02f}}};
    for (size_t i = 0; i < TL_COUNT(places); i++) {
        const struct disc disc = {.centre = places[i], .radius = 1 * DEGREE, .share = 0.4};
        tl_environment sky = sky_with(&disc, 1, 1024);
        tl_cube left;
        struct tl_suns suns = take(&sky, 128, &left);
        assert_int_equal(suns.count, 1);
        const struct tl_sun *sun = &suns.items[0];
        assert_true(degrees_between(sun->direction, glms_vec3_normalize(disc.centre)) < 0.02);
        double texel = M_PI / 512, blurred = sqrt(disc.radius * disc.radius + 2 * texel * texel / 3);
        assert_true((double)sun->radius > 0.99 * disc.radius && (double)sun->radius < 1.01 * blurred);
        assert_near(sun->power.x, disc_radiance(&disc) * disc_solid_angle(&disc),
                    0.03 * disc_radiance(&disc) * disc_solid_angle(&disc));
        assert_near(sun->power.y / sun->power.x, 0.9, 1e-3);
        assert_near(sun->power.z / sun->power.x, 0.8, 1e-3);
        check_samples(sun);
        for (int k = 0; k < 6 * 128 * 128; k++) /* only sky is left */
            assert_near(left.texels[3 * (size_t)k], 1, 1e-3);
        tl_cube_release(&left);
        tl_environment_release(&sky);
    }
}

/* The real sun, 0.27 degrees, in texels of the cube three times its size: its place and size come from the
 * environment, whose own texel, 0.18 degrees, limits them. */
static void the_cube_does_not_blur_the_sun(void **state)
{
    (void)state;
    const struct disc disc = {.centre = {{0.3f, 0.8f, 0.5f}}, .radius = 0.27 * DEGREE, .share = 0.6};
    tl_environment sky = sky_with(&disc, 1, 2048);
    for (int size = 64; size <= 256; size *= 2) {
        struct tl_suns suns = take(&sky, size, NULL);
        assert_int_equal(suns.count, 1);
        printf("cube of %3d: radius %.3f degrees, centre off by %.4f\n", size,
               (double)suns.items[0].radius / DEGREE,
               degrees_between(suns.items[0].direction, glms_vec3_normalize(disc.centre)));
        assert_near((double)suns.items[0].radius / DEGREE, 0.27, 0.036); /* sqrt(0.27^2 + 2 (0.18^2) / 3) */
        assert_true(degrees_between(suns.items[0].direction, glms_vec3_normalize(disc.centre)) < 0.02);
    }
    tl_environment_release(&sky);
}

static void other_lights_stay(void **state)
{
    (void)state;
    const struct disc discs[] = {
        {{{0.3f, 0.8f, 0.5f}}, 6 * DEGREE, 0.7},   /* a soft box */
        {{{0.3f, 0.8f, 0.5f}}, 3.5 * DEGREE, 0.5}, /* a lamp nearer by */
        {{{0.3f, 0.8f, 0.5f}}, 1 * DEGREE, 0.03},  /* a sun too weak to matter */
    };
    for (size_t i = 0; i < TL_COUNT(discs); i++) {
        tl_environment sky = sky_with(&discs[i], 1, 512);
        tl_cube whole = tl_cube_from_environment(&sky, 64), left;
        assert_int_equal(take(&sky, 64, &left).count, 0);
        assert_memory_equal(left.texels, whole.texels, sizeof(float) * 18 * 64 * 64);
        tl_cube_release(&whole);
        tl_cube_release(&left);
        tl_environment_release(&sky);
    }
}

static void suns_have_an_end(void **state)
{
    (void)state;
    struct disc discs[6] = {0};
    for (int i = 0; i < 6; i++) {
        double turn = i * M_PI / 3;
        discs[i] = (struct disc){.centre = {{(float)cos(turn), 0.5f, (float)sin(turn)}},
                                 .radius = 0.6 * DEGREE,
                                 .share = 0.3 + 0.05 * i};
    }
    tl_environment sky = sky_with(discs, 2, 1024);
    assert_int_equal(take(&sky, 128, NULL).count, 2);
    tl_environment_release(&sky);
    sky = sky_with(discs, 6, 1024);
    struct tl_suns suns = take(&sky, 128, NULL);
    assert_int_equal(suns.count, TL_SUNS_MAX);
    tl_environment_release(&sky);
}

static void fill(tl_environment *sky, float value)
{
    for (size_t i = 0; i < 3 * (size_t)sky->image.width * (size_t)sky->image.height; i++)
        tl_image_floats(&sky->image)[i] = value;
}

/* Nothing, the same everywhere, one texel of all strengths on black, cubes of any size. */
static void extremes(void **state)
{
    (void)state;
    tl_environment sky = {.layout = TL_ENV_LATLONG, .image = tl_image_create(256, 128, 3, TL_IMAGE_F32)};
    for (int size = 1; size <= 64; size = 3 * size + 1) {
        fill(&sky, 0);
        assert_int_equal(take(&sky, size, NULL).count, 0);
        fill(&sky, 3e37f);
        assert_int_equal(take(&sky, size, NULL).count, 0);
    }
    const float peaks[] = {1e-30f, 1, 1e30f, 3e38f};
    const int lit = 30 * 256 + 77;
    for (int size = 1; size <= 128; size *= 2) {
        for (size_t i = 0; i < TL_COUNT(peaks); i++) {
            fill(&sky, 0);
            for (int c = 0; c < 3; c++)
                tl_image_floats(&sky.image)[3 * lit + c] = peaks[i];
            struct tl_suns suns = take(&sky, size, NULL);
            assert_true(suns.count <= 1 && (size < 64 || suns.count == 1));
            for (int k = 0; k < suns.count; k++) {
                assert_true(isfinite(suns.items[k].radius) && suns.items[k].radius > 0);
                assert_true(
                    degrees_between(suns.items[k].direction, image_direction(&sky.image, 77.5, 30.5)) < 0.05);
            }
        }
    }
    tl_environment_release(&sky);
}

/* The share of texel x in that line of a cube's six faces that the disc covers, by 8 x 8 points. */
static float face_coverage(int size, int line, int x, const struct disc *disc)
{
    int covered = 0, face = line / size, y = line % size;
    for (int row = 0; row < 8; row++)
        for (int column = 0; column < 8; column++) {
            float s = ((float)x + ((float)column + 0.5f) / 8) / (float)size;
            float t = ((float)y + ((float)row + 0.5f) / 8) / (float)size;
            covered += is_within(glms_vec3_normalize(tl_cube_direction(face, s, t)), disc, 0);
        }
    return (float)covered / 64;
}

/* A cube as environment: what it shows is what is taken. */
static void cubes_have_suns_too(void **state)
{
    (void)state;
    enum { SIZE = 256 };
    const struct disc disc = {.centre = {{0.9f, 0.97f, -1}}, .radius = 0.8 * DEGREE, .share = 0.4};
    tl_environment cube = {.layout = TL_ENV_CUBE, .image = tl_image_create(SIZE, 6 * SIZE, 3, TL_IMAGE_F32)};
    for (int line = 0; line < 6 * SIZE; line++) {
        for (int x = 0; x < SIZE; x++) {
            float value = 1;
            int texel = line * SIZE + x;
            if (is_within(tl_cube_texel_direction(SIZE, texel), &disc, 4.0 / SIZE))
                value += (float)disc_radiance(&disc) * face_coverage(SIZE, line, x, &disc);
            for (int c = 0; c < 3; c++)
                tl_image_floats(&cube.image)[3 * (size_t)texel + (size_t)c] = value;
        }
    }
    struct tl_suns suns = take(&cube, 128, NULL);
    double texel = 2.0 / SIZE, blurred = sqrt(disc.radius * disc.radius + 2 * texel * texel / 3);
    assert_int_equal(suns.count, 1);
    assert_true(degrees_between(suns.items[0].direction, glms_vec3_normalize(disc.centre)) < 0.02);
    assert_true((double)suns.items[0].radius > 0.99 * disc.radius &&
                (double)suns.items[0].radius < 1.01 * blurred);
    check_samples(&suns.items[0]);
    tl_environment_release(&cube);
}

/* kloppenheim_05 has a sun with 65 % of the light (docs/notes/visibility.md); the soft boxes of the photo
 * studios are area lights; the built-in studio has one small lamp. What came out, kept to notice change; the
 * sun's core, above a 256th of its peak, has 0.33 degrees. */
static void real_environments(void **state)
{
    (void)state;
    const struct {
        const char *name; /* NULL: the built-in studio */
        int count;
        double share, radius_deg; /* of the first */
    } cases[] = {{NULL, 1, 0.136, 1.13},
                 {"envmaps/exr/kloppenheim_05_1k_float_zip.exr", 1, 0.655, 0.37},
                 {"envmaps/exr/brown_photostudio_02_1k_half_piz_rgba.exr", 0, 0, 0},
                 {"envmaps/exr/studio_small_03_1k_half_zip.exr", 0, 0, 0},
                 {"envmaps/hdr/venice_sunset_1k.hdr", 0, 0, 0}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_environment environment;
        tl_error error = {0};
        if (cases[i].name)
            assert_ok(tl_environment_load(test_data(cases[i].name), &environment, &error), error);
        else
            environment = tl_environment_studio();
        tl_cube left;
        struct tl_suns suns = take(&environment, 128, &left);
        double sum[3];
        sum_light(&left, &suns, sum);
        assert_int_equal(suns.count, cases[i].count);
        printf("%s: %d suns", environment.name, suns.count);
        if (suns.count > 0) {
            double share = (double)suns.items[0].power.y / sum[1];
            printf(", %.1f %% of the light, radius %.2f degrees", 100 * share,
                   (double)suns.items[0].radius / DEGREE);
            assert_near(share, cases[i].share, 0.01);
            assert_near((double)suns.items[0].radius / DEGREE, cases[i].radius_deg, 0.03);
            check_samples(&suns.items[0]);
        }
        printf("\n");
        tl_cube_release(&left);
        tl_environment_release(&environment);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suns_are_found_everywhere),
        cmocka_unit_test(the_cube_does_not_blur_the_sun),
        cmocka_unit_test(other_lights_stay),
        cmocka_unit_test(suns_have_an_end),
        cmocka_unit_test(extremes),
        cmocka_unit_test(cubes_have_suns_too),
        cmocka_unit_test(real_environments),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tl_resampling_release(&resampling);
    return failed;
}
