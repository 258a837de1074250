/* Legends on pictures: the colours of the scale are there, what is beyond the box is left alone, small
 * pictures are refused. */
#include "tests/testing.h"

#include "app/report/legend.h"

#include <string.h>

static const uint8_t paper = 0x18;

static struct tl_legend strain_legend(void)
{
    struct tl_legend legend;
    tl_legend_make(&(struct tl_legend_source){.view = TL_VIEW_STRAIN_WEFT, .range = 0.05f}, &legend);
    return legend;
}

static const uint8_t *pixel(const tl_image *picture, int x, int y)
{
    return tl_image_bytes(picture) + 3 * ((ptrdiff_t)y * picture->width + x);
}

static bool has_colour(const tl_image *picture, vec3s colour)
{
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            double maximum = 0;
            for (int c = 0; c < 3; c++)
                maximum = fmax(maximum, fabs(pixel(picture, x, y)[c] / 255.0 - (double)colour.raw[c]));
            if (maximum <= 3.0 / 255) /* half a column of the bar away */
                return true;
        }
    return false;
}

static void scales_are_drawn(void **state)
{
    (void)state;
    static const int widths[] = {400, 1000};
    struct tl_legend legend = strain_legend();
    for (int i = 0; i < 2; i++) {
        tl_image picture = tl_image_create(widths[i], 600, 3, TL_IMAGE_U8);
        assert_true(tl_legend_draw(&legend, &picture));
        for (int stop = 0; stop < legend.stop_count; stop += 8)
            assert_true(has_colour(&picture, legend.stops[stop].colour));
        assert_true(has_colour(&picture, tl_legend_unknown));
        size_t touched = 0;
        for (int y = 0; y < picture.height; y++)
            for (int x = 0; x < picture.width; x++)
                touched += pixel(&picture, x, y)[0] != 0;
        assert_true(touched > 5000 && touched < (size_t)picture.width * (size_t)picture.height / 3);
        assert_int_equal(pixel(&picture, picture.width - 1, 0)[0], 0);
        assert_int_equal(pixel(&picture, 11 * (i + 1), picture.height - 6 * (i + 1))[0], paper);
        tl_image_release(&picture);
    }
}

static void small_pictures_are_refused(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {100, 600}, {600, 60}};
    struct tl_legend legend = strain_legend(), empty = {0};
    for (int i = 0; i < 3; i++) {
        tl_image picture = tl_image_create(sizes[i][0], sizes[i][1], 3, TL_IMAGE_U8);
        assert_false(tl_legend_draw(&legend, &picture));
        assert_true(tl_legend_draw(&empty, &picture));
        for (int k = 0; k < 3 * picture.width * picture.height; k++)
            assert_int_equal(tl_image_bytes(&picture)[k], 0);
        tl_image_release(&picture);
    }
}

static void numbers_are_short(void **state)
{
    (void)state;
    struct tl_legend legend = strain_legend();
    char text[16];
    tl_legend_number(&legend, -1e-6f, text);
    assert_string_equal(text, "0");
    tl_legend_number(&legend, -2.5f, text);
    assert_string_equal(text, "-2.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scales_are_drawn),
        cmocka_unit_test(small_pictures_are_refused),
        cmocka_unit_test(numbers_are_short),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
