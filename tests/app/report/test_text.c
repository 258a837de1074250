/* Text on pictures: what is drawn lies where tl_text_measure says, letters of other scripts are letters and
 * not boxes, long text ends in an ellipsis, and anything may hang over the picture's edges. */
#include "tests/testing.h"

#include "app/report/canvas.h"
#include "app/report/text.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <string.h>

#define SIZE 16
static const uint32_t white = 0xffffff;

/* The smallest box around everything that is not white; empty (right < left) on a white picture. */
struct ink {
    int left, right, top, bottom;
    size_t count;
};

static struct ink ink_of(const tl_image *picture)
{
    struct ink ink = {picture->width, -1, picture->height, -1, 0};
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            if (tl_image_bytes(picture)[3 * ((ptrdiff_t)y * picture->width + x)] == 0xff)
                continue;
            ink.left = x < ink.left ? x : ink.left;
            ink.right = x > ink.right ? x : ink.right;
            ink.top = y < ink.top ? y : ink.top;
            ink.bottom = y > ink.bottom ? y : ink.bottom;
            ink.count++;
        }
    return ink;
}

static tl_image draw(const struct tl_text_style *style, const char *text)
{
    tl_image picture = tl_canvas_create(400, 100, white);
    tl_text_draw(&picture, 40, 30, style, text);
    return picture;
}

static bool are_equal(const tl_image *a, const tl_image *b)
{
    return memcmp(tl_image_bytes(a), tl_image_bytes(b), 3 * (size_t)a->width * (size_t)a->height) == 0;
}

static void drawn_text_has_the_measured_width(void **state)
{
    (void)state;
    static const int sizes[] = {10, 16, 20, 32};
    for (size_t i = 0; i < TL_COUNT(sizes); i++) {
        const struct tl_text_style style = {.size = sizes[i]};
        tl_image picture = draw(&style, "Hemline HH");
        struct ink ink = ink_of(&picture);
        int width = tl_text_measure(&style, "Hemline HH").width;
        /* H has bearings of a tenth of an em at both sides. */
        assert_in_range(ink.left, 40, 40 + sizes[i] / 5);
        assert_in_range(ink.right, 40 + width - 1 - sizes[i] / 5, 40 + width - 1);
        /* Capitals stand in their em square, on its baseline. */
        assert_in_range(ink.top, 30, 30 + sizes[i] / 5);
        assert_in_range(ink.bottom, 30 + sizes[i] * 7 / 10, 30 + sizes[i] * 9 / 10);
        tl_image_release(&picture);
    }
}

/* An accent is drawn above its letter, and everything else stays as it is. */
static void accents_are_drawn(void **state)
{
    (void)state;
    const struct tl_text_style style = {.size = SIZE};
    assert_int_equal(tl_text_measure(&style, "\xc3\x89t\xc3\xa9 bleu").unknown, 0);
    tl_image plain = draw(&style, "Ete bleu"), accented = draw(&style, "\xc3\x89t\xc3\xa9 bleu");
    assert_true(ink_of(&accented).top < ink_of(&plain).top);
    assert_int_equal(ink_of(&accented).right, ink_of(&plain).right);
    assert_true(ink_of(&accented).count > ink_of(&plain).count);
    tl_image_release(&plain);
    tl_image_release(&accented);
}

/* Three syllables of one em each, all different. */
static void korean_is_drawn(void **state)
{
    (void)state;
    const struct tl_text_style style = {.size = SIZE};
    struct tl_text_extent extent = tl_text_measure(&style, "\xec\x9b\x90\xed\x94\xbc\xec\x8a\xa4");
    if (extent.unknown > 0) {
        printf("skipped: no font on this machine has Korean letters; install fonts-nanum\n");
        skip();
    }
    assert_in_range(extent.width, 3 * SIZE * 8 / 10, 3 * SIZE * 11 / 10);
    tl_image pictures[] = {draw(&style, "\xec\x9b\x90"), draw(&style, "\xed\x94\xbc"),
                           draw(&style, "\xec\x8a\xa4")};
    for (int i = 0; i < 3; i++) {
        assert_true(ink_of(&pictures[i]).count > SIZE * SIZE / 4);
        assert_false(are_equal(&pictures[i], &pictures[(i + 1) % 3]));
    }
    for (int i = 0; i < 3; i++)
        tl_image_release(&pictures[i]);
}

/* A code point that Unicode leaves to private use has no letter in any font. */
static void unknown_letters_are_counted(void **state)
{
    (void)state;
    const struct tl_text_style style = {.size = SIZE};
    assert_int_equal(tl_text_measure(&style, "a\xf3\xb0\x80\x81z").unknown, 1);
    tl_image picture = draw(&style, "\xf3\xb0\x80\x81");
    assert_true(ink_of(&picture).count > 0); /* a box with its code */
    tl_image_release(&picture);
}

/* Bytes that are not UTF-8 become U+FFFD, one each; a newline does not begin a line. */
static void bytes_of_any_kind_are_one_line(void **state)
{
    (void)state;
    const struct tl_text_style style = {.size = SIZE};
    tl_image broken = draw(&style, "a\xff\xfe"), replaced = draw(&style, "a\xef\xbf\xbd\xef\xbf\xbd");
    assert_true(are_equal(&broken, &replaced));
    assert_int_equal(tl_text_measure(&style, "two\nlines").lines, 1);
    tl_image_release(&broken);
    tl_image_release(&replaced);
}

static void long_text_ends_in_an_ellipsis(void **state)
{
    (void)state;
    const struct tl_text_style style = {.size = SIZE, .width = 120};
    const char *text = "a name that is much too long for its column";
    assert_in_range(tl_text_measure(&style, text).width, 120 - SIZE, 120);
    assert_int_equal(tl_text_measure(&style, text).lines, 1);
    tl_image whole = draw(&(const struct tl_text_style){.size = SIZE}, text), cut = draw(&style, text);
    assert_true(ink_of(&cut).right < 40 + 120);
    assert_true(ink_of(&whole).right > 40 + 200);
    tl_image_release(&whole);
    tl_image_release(&cut);
}

static void text_is_aligned_in_its_width(void **state)
{
    (void)state;
    struct tl_text_style style = {.size = SIZE, .width = 200};
    int slack = 200 - tl_text_measure(&style, "warp").width, left[3];
    for (int align = TL_TEXT_LEFT; align <= TL_TEXT_RIGHT; align++) {
        style.align = (enum tl_text_align)align;
        tl_image picture = draw(&style, "warp");
        left[align] = ink_of(&picture).left;
        tl_image_release(&picture);
    }
    assert_int_equal(left[TL_TEXT_CENTRE], left[TL_TEXT_LEFT] + slack / 2);
    assert_int_equal(left[TL_TEXT_RIGHT], left[TL_TEXT_LEFT] + slack);
}

/* Lines are `leading` apart, and no more than asked for. */
static void text_is_wrapped(void **state)
{
    (void)state;
    const char *text = "blue: shorter than at rest; brown: longer; holds 99 % of the cloth";
    struct tl_text_style style = {.size = 10, .width = 170, .lines = 8, .leading = 12};
    struct tl_text_extent extent = tl_text_measure(&style, text);
    assert_in_range(extent.lines, 2, 3);
    assert_true(extent.width <= 170);
    tl_image picture = draw(&style, text);
    struct ink ink = ink_of(&picture);
    assert_in_range(ink.bottom, 30 + (extent.lines - 1) * 12 + 6, 30 + (extent.lines - 1) * 12 + 11);
    assert_true(ink.right < 40 + 170);
    tl_image_release(&picture);
    style.lines = 1;
    assert_int_equal(tl_text_measure(&style, text).lines, 1);
}

/* Wherever a text lies, the part of it on the picture is the same as on a larger picture. */
static void text_is_cut_at_the_edges(void **state)
{
    (void)state;
    const struct tl_text_style style = {.size = SIZE};
    const char *text = "over the edge";
    static const int places[][2] = {{-30, 5}, {50, -9}, {50, 30}, {-5, -5}, {-1000, 0}, {0, 1000}, {90, 20}};
    for (size_t i = 0; i < TL_COUNT(places); i++) {
        tl_image large = tl_canvas_create(300, 200, white), small = tl_canvas_create(100, 40, white);
        tl_text_draw(&large, 100 + places[i][0], 80 + places[i][1], &style, text);
        tl_text_draw(&small, places[i][0], places[i][1], &style, text);
        for (int y = 0; y < 40; y++)
            assert_memory_equal(tl_image_bytes(&small) + (size_t)(3 * y * 100),
                                tl_image_bytes(&large) + (size_t)(3 * ((80 + y) * 300 + 100)), 300);
        tl_image_release(&large);
        tl_image_release(&small);
    }
}

/* Longer than any surface of Cairo's. */
static void text_of_any_length_is_drawn(void **state)
{
    (void)state;
    char *text = tl_alloc(20001, 1);
    memset(text, 'w', 20000);
    const struct tl_text_style style = {.size = SIZE};
    assert_true(tl_text_measure(&style, text).width > 1 << 15);
    tl_image picture = draw(&style, text);
    assert_int_equal(ink_of(&picture).right, 399);
    assert_int_equal(ink_of(&picture).left / 8, 40 / 8);
    tl_image_release(&picture);
    free(text);
}

static void boxes_and_labels_have_their_colours(void **state)
{
    (void)state;
    tl_image canvas = tl_canvas_create(60, 30, white);
    tl_canvas_box(&canvas, -5, -5, 7, 8, 0x102030);
    assert_int_equal(ink_of(&canvas).count, 2 * 3);
    assert_memory_equal(tl_image_bytes(&canvas), "\x10\x20\x30", 3);
    tl_image_release(&canvas);
    canvas = tl_canvas_create(60, 30, white);
    tl_canvas_text(&canvas, 2, 3, "\xe2\x96\x88", 0x102030); /* a full block */
    int middle = 3 * ((3 + TL_CANVAS_LETTER / 2) * 60 + 2 + tl_canvas_text_width("\xe2\x96\x88") / 2);
    assert_memory_equal(tl_image_bytes(&canvas) + middle, "\x10\x20\x30", 3);
    tl_image_release(&canvas);
}

int main(void)
{
    tl_log_set_level(TL_LOG_QUIET);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drawn_text_has_the_measured_width),
        cmocka_unit_test(accents_are_drawn),
        cmocka_unit_test(korean_is_drawn),
        cmocka_unit_test(unknown_letters_are_counted),
        cmocka_unit_test(bytes_of_any_kind_are_one_line),
        cmocka_unit_test(long_text_ends_in_an_ellipsis),
        cmocka_unit_test(text_is_aligned_in_its_width),
        cmocka_unit_test(text_is_wrapped),
        cmocka_unit_test(text_is_cut_at_the_edges),
        cmocka_unit_test(text_of_any_length_is_drawn),
        cmocka_unit_test(boxes_and_labels_have_their_colours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
