/* sRGB against IEC 61966-2-1: the transfer function, bytes, and hexadecimal text. */
#include "tests/testing.h"

#include "config/colour/names.h"
#include "config/colour/srgb.h"

#include <string.h>

/* The two pieces meet, and the standard's values. */
static void test_transfer(void **state)
{
    (void)state;
    assert_near(tl_srgb_to_linear(0), 0, 0);
    assert_near(tl_srgb_to_linear(1), 1, 1e-6);
    assert_near(tl_srgb_to_linear(0.5f), 0.21404114, 1e-6);
    assert_near(tl_srgb_to_linear(0.04045f), 0.04045 / 12.92, 1e-7);
    assert_near(tl_srgb_from_linear(0.18f), 0.46135613, 1e-6);
    for (int i = 0; i <= 255; i++)
        assert_near(tl_srgb_from_linear(tl_srgb_to_linear((float)i / 255)), i / 255.0, 1e-6);
}

/* Every byte in every channel comes back; each channel has its own place. */
static void test_bytes(void **state)
{
    (void)state;
    for (uint32_t i = 0; i <= 255; i++) {
        const uint32_t rgb = i << 16 | (255 - i) << 8 | (i ^ 0x55);
        float linear[3];
        tl_srgb_decode(rgb, linear);
        assert_near(linear[0], tl_srgb_to_linear((float)i / 255), 0);
        assert_near(linear[2], tl_srgb_to_linear((float)(i ^ 0x55) / 255), 0);
        assert_int_equal(tl_srgb_encode(linear), rgb);
    }
    assert_string_equal(tl_hex_of((const float[]){1, 0.21404114f, 0}).text, "#ff8000");
    assert_string_equal(tl_hex_of((const float[]){-1, 2, 0.0005f}).text, "#00ff02"); /* clamped */
}

/* Names that people know by heart, the list's ends, and no name twice. */
static void test_names(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t rgb;
    } known[] = {{"aliceblue", 0xF0F8FF}, {"crimson", 0xDC143C},       {"navy", 0x000080},
                 {"tomato", 0xFF6347},    {"rebeccapurple", 0x663399}, {"yellowgreen", 0x9ACD32}};
    uint32_t rgb;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        assert_true(tl_colour_find(known[i].name, &rgb));
        assert_int_equal(rgb, known[i].rgb);
    }
    assert_false(tl_colour_find("Navy", &rgb));
    assert_false(tl_colour_find("", &rgb));
    size_t count = 1;
    for (; tl_colour_names[count]; count++)
        assert_true(strcmp(tl_colour_names[count - 1], tl_colour_names[count]) < 0);
    assert_int_equal(count, 148);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transfer),
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
