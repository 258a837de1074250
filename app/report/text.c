#include "app/report/text.h"

#include "config/base/log.h"

#include <pango/pangocairo.h>

#include <assert.h>

#define FAMILY "Sans"
#define BASELINE                                                                                             \
    0.8 /* below the top of the em square; DejaVu's capitals are 0.73 high, its tails 0.24 deep */

/* Glyphs stand at whole pixels: Cairo 1.16 rounds their places, so that fractional widths would only make the
 * spaces between letters uneven. Grey, because the order of a screen's subpixels is unknown here. */
static void set_font_options(PangoContext *context)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_SLIGHT);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_ON);
    pango_cairo_context_set_font_options(context, options);
    cairo_font_options_destroy(options);
}

/* New layout; release it with g_object_unref. */
static PangoLayout *layout_of(const struct tl_text_style *style, const char *text)
{
    PangoContext *context = pango_font_map_create_context(pango_cairo_font_map_get_default());
    set_font_options(context);
    PangoLayout *layout = pango_layout_new(context);
    PangoFontDescription *font = pango_font_description_from_string(FAMILY);
    pango_font_description_set_absolute_size(font, (double)style->size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_layout_set_single_paragraph_mode(layout, TRUE);
    if (style->width > 0) {
        pango_layout_set_width(layout, style->width * PANGO_SCALE);
        pango_layout_set_height(layout,
                                style->lines > 1 ? -style->lines : -1); /* negative: lines, not pixels */
        pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
        pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_END);
    }
    char *valid = g_utf8_make_valid(text, -1);
    pango_layout_set_text(layout, valid, -1);
    g_free(valid);
    pango_font_description_free(font);
    g_object_unref(context);
    return layout;
}

static int line_width(PangoLayoutLine *line)
{
    PangoRectangle logical;
    pango_layout_line_get_pixel_extents(line, NULL, &logical);
    return logical.width;
}

static struct tl_text_extent extent_of(PangoLayout *layout)
{
    struct tl_text_extent extent = {.lines = pango_layout_get_line_count(layout),
                                    .unknown = pango_layout_get_unknown_glyphs_count(layout)};
    for (int i = 0; i < extent.lines; i++) {
        int width = line_width(pango_layout_get_line_readonly(layout, i));
        extent.width = width > extent.width ? width : extent.width;
    }
    return extent;
}

struct tl_text_extent tl_text_measure(const struct tl_text_style *style, const char *text)
{
    PangoLayout *layout = layout_of(style, text);
    struct tl_text_extent extent = extent_of(layout);
    g_object_unref(layout);
    return extent;
}

/* Draws the layout's coverage on a mask, with the top of the first line's em square at x, y. */
static void draw_lines(PangoLayout *layout, const struct tl_text_style *style, cairo_surface_t *mask, int x,
                       int y)
{
    cairo_t *cairo = cairo_create(mask);
    for (int i = 0; i < pango_layout_get_line_count(layout); i++) {
        PangoLayoutLine *line = pango_layout_get_line_readonly(layout, i);
        int spare = style->align == TL_TEXT_LEFT ? 0 : style->width - line_width(line);
        int left = style->align == TL_TEXT_CENTRE ? spare / 2 : spare;
        cairo_move_to(cairo, x + left, (int)(BASELINE * style->size + 0.5) + y + i * style->leading);
        pango_cairo_show_layout_line(cairo, line);
    }
    cairo_destroy(cairo);
    cairo_surface_flush(mask);
}

/* Mixes the colour into the picture by the mask's coverage; the mask's first row lies on the picture's row
 * `top`. The mix is linear in sRGB, which is how screens draw letters and what fonts are designed for. */
static void blend(cairo_surface_t *mask, uint32_t colour, int top, tl_image *picture)
{
    const uint8_t *coverage = cairo_image_surface_get_data(mask);
    int stride = cairo_image_surface_get_stride(mask), height = cairo_image_surface_get_height(mask);
    for (int row = top < 0 ? -top : 0; row < height && top + row < picture->height; row++)
        for (int column = 0; column < picture->width; column++) {
            unsigned share = coverage[(ptrdiff_t)row * stride + column];
            uint8_t *texel = tl_image_bytes(picture) + 3 * ((ptrdiff_t)(top + row) * picture->width + column);
            for (int c = 0; c < 3 && share > 0; c++) {
                unsigned channel = colour >> (16 - 8 * c) & 0xff;
                texel[c] = (uint8_t)((texel[c] * (255 - share) + channel * share + 127) / 255);
            }
        }
}

void tl_text_draw(tl_image *picture, int x, int y, const struct tl_text_style *style, const char *text)
{
    assert(picture->type == TL_IMAGE_U8 && picture->channels == 3);
    assert(style->align == TL_TEXT_LEFT || style->width > 0);
    PangoLayout *layout = layout_of(style, text);
    struct tl_text_extent extent = extent_of(layout);
    if (extent.unknown > 0)
        tl_warn("\"%s\": no font on this machine has all of its letters, so boxes are drawn: install one, "
                "such as "
                "fonts-noto-cjk for Chinese, Japanese and Korean",
                text);
    /* The surface is as wide as the picture, so that text of any length fits a surface of Cairo's, at most
     * 32767 wide; an em above the first line for accents, and one below the last. */
    int height = 3 * style->size + (extent.lines - 1) * style->leading;
    cairo_surface_t *mask = cairo_image_surface_create(CAIRO_FORMAT_A8, picture->width, height);
    draw_lines(layout, style, mask, x, style->size);
    blend(mask, style->colour, y - style->size, picture);
    cairo_surface_destroy(mask);
    g_object_unref(layout);
}
