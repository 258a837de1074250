/* Colours of views: scales that people can read, whatever colours they see; and the pure parts of painting.
 */
#include "tests/testing.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"
#include "render/inspect/legend.h"
#include "render/inspect/paint.h"
#include "render/inspect/seen.h"

#include <string.h>

static struct tl_legend legend_of(enum tl_image_view view, float range)
{
    struct tl_legend legend;
    tl_legend_make(&(struct tl_legend_source){.view = view, .range = range, .region = -1}, &legend);
    return legend;
}

/* CIE 1976 lightness of an sRGB colour. */
static double lightness(vec3s colour)
{
    double y = 0.2126 * (double)tl_srgb_to_linear(colour.x) + 0.7152 * (double)tl_srgb_to_linear(colour.y) +
               0.0722 * (double)tl_srgb_to_linear(colour.z);
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static void strain_scale_is_symmetric(void **state)
{
    (void)state;
    struct tl_legend legend = legend_of(TL_VIEW_STRAIN_WARP, 0.05f);
    int last = legend.stop_count - 1, middle = last / 2;
    assert_near(legend.low, -5, 1e-5);
    assert_near(legend.high, 5, 1e-5);
    assert_near(legend.stops[middle].value, 0, 1e-6);
    for (int i = 0; i < middle; i++) { /* darker and darker from the middle, equally to both sides */
        assert_true(lightness(legend.stops[i].colour) < lightness(legend.stops[i + 1].colour) - 0.2);
        assert_true(lightness(legend.stops[last - i].colour) <
                    lightness(legend.stops[last - i - 1].colour) - 0.2);
        /* OKLab's lightness is equal by design; CIE's then differs by a few units between blue and orange. */
        assert_near(lightness(legend.stops[i].colour), lightness(legend.stops[last - i].colour), 5);
    }
}

/* Colours as those see them who lack a kind of cone [Machado et al. 2009, table 1, severity 1]; linear RGB.
 */
static const double deficiencies[2][3][3] = {
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};

/* CIE 1976 L*a*b* of an sRGB colour, D65. */
static void lab_of(vec3s colour, const double (*seen)[3], double lab[3])
{
    static const double xyz[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    static const double white[3] = {0.9505, 1, 1.089};
    double linear[3], f[3];
    for (int i = 0; i < 3; i++) {
        linear[i] = 0;
        for (int k = 0; k < 3; k++)
            linear[i] += (seen ? seen[i][k] : i == k) * (double)tl_srgb_to_linear(colour.raw[k]);
        linear[i] = fmin(fmax(linear[i], 0), 1);
    }
    for (int i = 0; i < 3; i++) {
        double t = (xyz[i][0] * linear[0] + xyz[i][1] * linear[1] + xyz[i][2] * linear[2]) / white[i];
        f[i] = t > 0.008856 ? cbrt(t) : 7.787 * t + 16.0 / 116;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]);
    lab[2] = 200 * (f[1] - f[2]);
}

/* Shorter and longer by the same amount must not be taken for one another: a difference of 2.3 is just
 * noticeable, ten is plain. Nearer to 0 than a fifth of the range both are nearly none. */
static void strain_signs_differ_for_everybody(void **state)
{
    (void)state;
    struct tl_legend legend = legend_of(TL_VIEW_STRAIN_WEFT, 0.1f);
    int last = legend.stop_count - 1;
    for (int eye = -1; eye < 2; eye++)
        for (int i = 0; i <= 2 * last / 5; i++) {
            double less[3], more[3];
            lab_of(legend.stops[i].colour, eye < 0 ? NULL : deficiencies[eye], less);
            lab_of(legend.stops[last - i].colour, eye < 0 ? NULL : deficiencies[eye], more);
            double a = less[1] - more[1], b = less[2] - more[2];
            assert_true(hypot(less[0] - more[0], hypot(a, b)) > 10);
        }
}

static void scales_give_their_ends_beyond(void **state)
{
    (void)state;
    for (int view = TL_VIEW_LIGHT; view < TL_VIEW_COUNT; view++) {
        struct tl_legend legend = legend_of((enum tl_image_view)view, 0.02f);
        assert_int_equal(legend.title[0] == '\0', view == TL_VIEW_LIGHT);
        for (int i = 0; i < legend.stop_count; i++) {
            vec3s colour = tl_legend_colour(&legend, legend.stops[i].value);
            for (int c = 0; c < 3; c++) {
                assert_true(legend.stops[i].colour.raw[c] >= 0 && legend.stops[i].colour.raw[c] <= 1);
                assert_near(colour.raw[c], legend.stops[i].colour.raw[c], 1e-5);
            }
        }
        if (legend.stop_count == 0)
            continue;
        vec3s low = tl_legend_colour(&legend, -INFINITY), high = tl_legend_colour(&legend, 1e30f);
        assert_near(glms_vec3_distance(low, legend.stops[0].colour), 0, 0);
        assert_near(glms_vec3_distance(high, legend.stops[legend.stop_count - 1].colour), 0, 0);
        assert_near(glms_vec3_distance(tl_legend_colour(&legend, NAN), low), 0, 0);
    }
    struct tl_legend seen = legend_of(TL_VIEW_VISIBILITY, 0);
    assert_near(tl_legend_colour(&seen, 0.25f).y, 0.25, 1e-6); /* grey is the number itself */
}

static void numbers_have_colours_of_their_own(void **state)
{
    (void)state;
    double nearest = 1;
    for (uint32_t i = 0; i < 24; i++)
        for (uint32_t k = 0; k < i; k++)
            nearest = fmin(nearest, (double)glms_vec3_distance(tl_number_colour(i), tl_number_colour(k)));
    assert_true(nearest > 0.05); /* a dozen of 255 steps */
    assert_near(glms_vec3_distance(tl_number_colour(7), tl_number_colour(7)), 0, 0);
}

/* Against the mean of 10,000 points of the box. */
static void square_waves_are_averaged(void **state)
{
    (void)state;
    const float places[] = {-3.2f, -0.1f, 0, 0.1f, 0.25f, 0.49f, 0.77f, 12.5f};
    const float widths[] = {0, 0.05f, 0.3f, 0.5f, 1, 2.7f};
    for (size_t i = 0; i < TL_COUNT(places); i++)
        for (size_t k = 0; k < TL_COUNT(widths); k++) {
            double sum = 0;
            const int points = 10000;
            for (int p = 0; p < points; p++) {
                double at = (double)places[i] + ((p + 0.5) / points - 0.5) * fmax((double)widths[k], 1e-4);
                sum += at - floor(at) < 0.5 ? 1 : -1;
            }
            assert_near(tl_paint_square_wave(places[i], widths[k]), sum / points, 0.02);
        }
}

/* A few regions, and points with visibilities of their own. */
enum { REGIONS = 37, POINTS = 5, STRIDE = 48 };

static double hash(int a, int b)
{
    double value = sin(12.9898 * a + 78.233 * b) * 43758.5453;
    return value - floor(value);
}

static void visibility_is_the_sum_over_regions(void **state)
{
    (void)state;
    struct tl_regions *regions = TL_NEW(struct tl_regions);
    uint16_t values[POINTS * STRIDE] = {0};
    regions->count = REGIONS;
    for (int i = 0; i < REGIONS; i++) {
        vec3s d = {{(float)hash(i, 1) - 0.5f, (float)hash(i, 2) - 0.5f, (float)hash(i, 3) - 0.5f}};
        regions->items[i] =
            (struct tl_region){.direction = glms_vec3_normalize(d), .importance = (float)hash(i, 4)};
        for (int p = 0; p < POINTS; p++)
            values[p * STRIDE + i] = (uint16_t)(65535 * hash(i, 10 + p));
    }
    struct tl_seen_regions lights;
    tl_seen_regions_make(regions, 0, &lights);
    const struct tl_taps taps = {.point = {3, 0, 4}, .weight = {0.5f, 0.3f, 0.2f}};
    for (int n = 0; n < 20; n++) {
        vec3s normal = glms_vec3_normalize(
            (vec3s){{(float)hash(n, 5) - 0.5f, (float)hash(n, 6) - 0.5f, (float)hash(n, 7) - 0.5f}});
        double all = 0, seen = 0, best = 0;
        int strongest = -1;
        for (int i = 0; i < REGIONS; i++) {
            double visibility = 0;
            for (int t = 0; t < TL_TAPS; t++)
                visibility +=
                    (double)taps.weight[t] * values[(size_t)taps.point[t] * STRIDE + (size_t)i] / 65535;
            double light = (double)regions->items[i].importance *
                           fmax(0, (double)glms_vec3_dot(regions->items[i].direction, normal));
            assert_near(tl_seen_region(values, STRIDE, &taps, i), visibility, 1e-6);
            all += light;
            seen += light * visibility;
            if (light * visibility > best) {
                best = light * visibility;
                strongest = i;
            }
        }
        struct tl_seen result = tl_seen_at(&lights, values, STRIDE, &taps, normal);
        assert_near(result.visibility, seen / all, 1e-5);
        assert_int_equal(result.strongest, strongest);
        assert_near(result.share, best / seen, 1e-5);
    }
    memset(values, 0, sizeof values);
    struct tl_seen dark = tl_seen_at(&lights, values, STRIDE, &taps, (vec3s){{0, 1, 0}});
    assert_int_equal(dark.strongest, -1);
    assert_near(dark.visibility, 0, 0);
    free(regions);
}

static void ranges_hold_99_percent(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    vec3s strains[COUNT];
    tl_surface surface = {.vertex_count = COUNT, .strains = strains};
    const tl_surface *surfaces[] = {&surface};
    for (int i = 0; i < COUNT; i++) /* up to 4 % either way; ten vertices of 30 %; shear of none */
        strains[i] = (vec3s){{i < 10 ? 0.3f : 0.04f * ((float)i / 500 - 1), i < 11 ? -0.3f : 0.001f, 0}};
    assert_near(tl_paint_strain_range(surfaces, 1, 0), 0.05, 1e-7);
    assert_near(tl_paint_strain_range(surfaces, 1, 1), 0.3,
                1e-7); /* eleven of a thousand are more than 1 % */
    assert_near(tl_paint_strain_range(surfaces, 1, 2), 0.001, 1e-7);
    surface.strains = NULL;
    assert_near(tl_paint_strain_range(surfaces, 1, 0), 0.001, 1e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strain_scale_is_symmetric),     cmocka_unit_test(strain_signs_differ_for_everybody),
        cmocka_unit_test(scales_give_their_ends_beyond), cmocka_unit_test(numbers_have_colours_of_their_own),
        cmocka_unit_test(square_waves_are_averaged),     cmocka_unit_test(visibility_is_the_sum_over_regions),
        cmocka_unit_test(ranges_hold_99_percent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
