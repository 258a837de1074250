/* The page of a fabric card. Lengths are millimetres of the page, x to the right and y down. */
#include "app/fabric/card_internal.h"
#include "assets/specimen/cusick.h"

#include <pango/pangocairo.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEFT     15.0
#define RIGHT    (TL_CARD_WIDTH_MM - 15.0)
#define GAP      3.0
#define BLACK    0x202020
#define GREY     0x707070
#define PALE     0xd0d0d0
#define HAIRLINE 0.12
#define SWATCH   ((double)TL_CARD_SWATCH_MM)
#define PICTURE  ((double)TL_CARD_PICTURE_MM)

/* Rows from above. */
#define TITLE_Y    13.0
#define SWATCH_Y   32.0
#define PICTURES_Y 151.0
#define FOOT_Y     225.0
#define BOTTOM     (TL_CARD_HEIGHT_MM - 12.0)

static void set_colour(cairo_t *cairo, unsigned colour)
{
    cairo_set_source_rgb(cairo, (colour >> 16 & 255) / 255.0, (colour >> 8 & 255) / 255.0,
                         (colour & 255) / 255.0);
}

/* ---- Text ---- */

struct text {
    double size;  /* of the em square */
    double width; /* wraps there; 0: one line */
    unsigned colour;
    bool is_bold, is_right; /* ends at x instead of beginning there */
};

/* Metrics without hints: the page is the same at every resolution. */
static PangoLayout *layout_of(cairo_t *cairo, const struct text *style, const char *words)
{
    PangoLayout *layout = pango_cairo_create_layout(cairo);
    PangoContext *context = pango_layout_get_context(layout);
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, options);
    pango_context_set_round_glyph_positions(context, FALSE);
    cairo_font_options_destroy(options);
    PangoFontDescription *font = pango_font_description_from_string(style->is_bold ? "Sans Bold" : "Sans");
    pango_font_description_set_absolute_size(font, style->size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    if (style->width > 0) {
        pango_layout_set_width(layout, (int)(style->width * PANGO_SCALE));
        pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
    }
    char *valid = g_utf8_make_valid(words, -1);
    pango_layout_set_text(layout, valid, -1);
    g_free(valid);
    return layout;
}

/* Returns the text's height. */
static double put(cairo_t *cairo, double x, double y, const struct text *style, const char *words)
{
    PangoLayout *layout = layout_of(cairo, style, words);
    int width, height;
    pango_layout_get_size(layout, &width, &height);
    set_colour(cairo, style->colour);
    cairo_move_to(cairo, style->is_right ? x - (double)width / PANGO_SCALE : x, y);
    pango_cairo_show_layout(cairo, layout);
    g_object_unref(layout);
    return (double)height / PANGO_SCALE;
}

static double height_of(cairo_t *cairo, const struct text *style, const char *words)
{
    PangoLayout *layout = layout_of(cairo, style, words);
    int width, height;
    pango_layout_get_size(layout, &width, &height);
    g_object_unref(layout);
    return (double)height / PANGO_SCALE;
}

static const struct text small = {.size = 2.6, .colour = GREY}, plain = {.size = 2.9, .colour = BLACK};

/* ---- Pictures ---- */

static void put_image(cairo_t *cairo, double x, double y, double side, const tl_image *image)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, image->width, image->height);
    unsigned char *data = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int row = 0; row < image->height; row++)
        for (int column = 0; column < image->width; column++) {
            const uint8_t *texel =
                tl_image_bytes(image) + image->channels * ((ptrdiff_t)row * image->width + column);
            uint32_t value = (uint32_t)texel[0] << 16 | (uint32_t)texel[1] << 8 | texel[2];
            memcpy(data + (ptrdiff_t)row * stride + 4 * column, &value, sizeof value);
        }
    cairo_surface_mark_dirty(surface);
    cairo_save(cairo);
    cairo_translate(cairo, x, y);
    cairo_scale(cairo, side / image->width, side / image->height);
    cairo_set_source_surface(cairo, surface, 0, 0);
    cairo_paint(cairo);
    cairo_restore(cairo);
    cairo_surface_destroy(surface);
}

static void put_line(cairo_t *cairo, double x, double y, double dx, double dy)
{
    cairo_set_line_width(cairo, HAIRLINE);
    cairo_move_to(cairo, x, y);
    cairo_rel_line_to(cairo, dx, dy);
    cairo_stroke(cairo);
}

/* A scale below a picture: `count` millimetres of the cloth over `length` of the page, with a number at each
 * `step` of them. */
static void put_scale(cairo_t *cairo, double x, double y, double length, int count, int step)
{
    const struct text style = {.size = 2.2, .colour = BLACK};
    set_colour(cairo, BLACK);
    put_line(cairo, x, y, length, 0);
    for (int i = 0; i <= count; i++) {
        double at = x + length * i / count;
        bool is_long = i % step == 0;
        set_colour(cairo, BLACK);
        put_line(cairo, at, y, 0, is_long ? 2 : 1.1);
        if (!is_long || i == 0 || i + step >= count) /* the last number stands left of its tick */
            continue;
        char number[16];
        snprintf(number, sizeof number, "%d", i);
        put(cairo, at + 0.3, y + 1.3, &style, number);
    }
    char unit[16];
    snprintf(unit, sizeof unit, "%d mm", count);
    put(cairo, x + length - 0.5, y + 1.3,
        &(const struct text){.size = 2.2, .colour = BLACK, .is_right = true}, unit);
}

/* ---- The parts of the page ---- */

static void put_title(const struct tl_card *card, cairo_t *cairo)
{
    const struct tl_fabric *fabric = &card->fabric;
    put(cairo, LEFT, TITLE_Y, &(const struct text){.size = 8, .colour = BLACK, .is_bold = true},
        tl_fabric_name(fabric));
    char line[512];
    size_t used = 0;
    for (size_t i = 0; i < fabric->file.field_count; i++)
        used += fabric->file.fields[i].is_used;
    if (fabric->is_foreign)
        snprintf(line, sizeof line, "%.300s: %zu of %zu fields are used", fabric->source, used,
                 fabric->file.field_count);
    else
        snprintf(line, sizeof line, "%.300s%s", fabric->source,
                 tl_option_is_file_name(fabric->source) ? "" : ": a fabric of toile");
    put(cairo, LEFT, TITLE_Y + 11, &small, line);
}

static void put_chip(cairo_t *cairo, double x, double y, const char *name,
                     const struct tl_card_colour *colour)
{
    char text[64];
    set_colour(cairo, (unsigned)strtoul(colour->hex.text + 1, NULL, 16));
    cairo_rectangle(cairo, x, y, 22, 16);
    cairo_fill_preserve(cairo);
    set_colour(cairo, PALE); /* a white one shows, too */
    cairo_set_line_width(cairo, HAIRLINE);
    cairo_stroke(cairo);
    put(cairo, x + 24, y, &plain, name);
    snprintf(text, sizeof text, "L* %.1f  a* %.1f  b* %.1f", colour->lab.l, colour->lab.a, colour->lab.b);
    put(cairo, x + 24, y + 4.6, &small, text);
    put(cairo, x + 24, y + 8.6, &small, colour->hex.text);
}

static void put_colours(const struct tl_card *card, cairo_t *cairo, double x)
{
    char text[200];
    const char *open = card->settings.material.openness > 0 ? ", over white" : "";
    if (!card->has_colour) {
        put(cairo, x, SWATCH_Y, &(const struct text){.size = 2.9, .width = RIGHT - x, .colour = BLACK},
            "States no appearance: shown in grey.");
        return;
    }
    put_chip(cairo, x, SWATCH_Y, "Base colour", &card->base);
    put_chip(cairo, x, SWATCH_Y + 18, "Measured on the cloth", &card->measured);
    snprintf(text, sizeof text,
             "\u0394E\u2080\u2080 %.1f between them. Measured: light from everywhere, seen along the normal, "
             "gloss "
             "and yarns included (d/0)%s. CIELAB, D65.",
             card->difference, open);
    put(cairo, x, SWATCH_Y + 36, &(const struct text){.size = 2.4, .width = RIGHT - x, .colour = GREY}, text);
}

/* Three digits, without an exponent; what four decimals cannot show is 0. */
static void format_value(double value, char *out, size_t size)
{
    const double shown = 0.5e-4;
    int decimals = value < shown ? 0 : 2 - (int)floor(log10(value) + 1e-9);
    snprintf(out, size, "%.*f", decimals < 0 ? 0 : decimals > 4 ? 4 : decimals, value);
}

static void put_figures(const struct tl_card *card, cairo_t *cairo, double x)
{
    double y = SWATCH_Y + 48;
    for (int i = 0; i < card->figure_count; i++, y += 5.8) {
        const struct tl_card_figure *figure = &card->figures[i];
        char value[32];
        format_value(figure->value, value, sizeof value);
        set_colour(cairo, PALE);
        put_line(cairo, x, y - 0.5, RIGHT - x, 0);
        put(cairo, x, y, &plain, figure->name);
        put(cairo, RIGHT - 14, y, &(const struct text){.size = 2.9, .colour = BLACK, .is_right = true},
            value);
        put(cairo, RIGHT - 13, y, &plain, figure->unit);
        put(cairo, x, y + 3.1, &(const struct text){.size = 2.0, .colour = GREY}, figure->source);
    }
}

static void put_pictures(const struct tl_card *card, cairo_t *cairo)
{
    const double step = PICTURE + GAP;
    char text[96];
    put_image(cairo, LEFT, SWATCH_Y, SWATCH, &card->swatch);
    put_scale(cairo, LEFT, SWATCH_Y + SWATCH + 0.6, SWATCH, TL_CARD_SWATCH_MM, 10);
    put(cairo, LEFT, SWATCH_Y + SWATCH + 5.5, &small,
        "Flat, at true scale on A4: the warp runs up the page, the weft across it.");
    put_image(cairo, LEFT, PICTURES_Y, PICTURE, &card->close);
    put_scale(cairo, LEFT, PICTURES_Y + PICTURE + 0.6, PICTURE, TL_CARD_CLOSE_MM, 1);
    put_image(cairo, LEFT + step, PICTURES_Y, PICTURE, &card->ball);
    put_image(cairo, LEFT + 2 * step, PICTURES_Y, PICTURE, &card->disc);
    snprintf(text, sizeof text, "Close-up, %.1f times its size", PICTURE / TL_CARD_CLOSE_MM);
    put(cairo, LEFT, PICTURES_Y + PICTURE + 5.5, &small, text);
    put(cairo, LEFT + step, PICTURES_Y + PICTURE + 1.5, &small, "0.5 m square over a ball of 24 cm");
    put(cairo, LEFT + 2 * step, PICTURES_Y + PICTURE + 1.5, &small, "Cusick's drape test: disc of 30 cm");
}

static void put_circle(cairo_t *cairo, double x, double y, double radius)
{
    cairo_set_line_width(cairo, HAIRLINE);
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, radius, 0, 2 * M_PI);
    cairo_stroke(cairo);
}

/* The shadow from above, with the outlines of disc and plate. */
static void put_shadow(const struct tl_card *card, cairo_t *cairo, double x, double y, double side)
{
    char text[96];
    tl_image picture = tl_image_create(TL_CUSICK_SHADOW, TL_CUSICK_SHADOW, 3, TL_IMAGE_U8);
    for (size_t i = 0; i < 3 * (size_t)TL_CUSICK_SHADOW * TL_CUSICK_SHADOW; i++)
        tl_image_bytes(&picture)[i] = tl_image_bytes(&card->shadow)[i / 3] ? 176 : 255;
    put_image(cairo, x, y, side, &picture);
    tl_image_release(&picture);
    set_colour(cairo, GREY);
    put_circle(cairo, x + side / 2, y + side / 2, side * TL_CUSICK_DISC_M / TL_CUSICK_SIDE_M);
    put_circle(cairo, x + side / 2, y + side / 2, side * TL_CUSICK_PLATE_M / TL_CUSICK_SIDE_M);
    snprintf(text, sizeof text, "Shadow of the disc: drape coefficient %.0f %%, %d folds", 100 * card->drape,
             card->folds);
    put(cairo, x, y + side + 1, &(const struct text){.size = 2.6, .width = side + 8, .colour = GREY}, text);
}

/* Draws it as large as fits into `height`. */
static void put_fitted(cairo_t *cairo, double x, double y, double height, const char *words)
{
    struct text style = {.size = 2.8, .width = RIGHT - x, .colour = BLACK};
    while (style.size > 1 && height_of(cairo, &style, words) > height)
        style.size -= 0.1;
    put(cairo, x, y, &style, words);
}

void tl_card_draw_page(const struct tl_card *card, cairo_t *cairo)
{
    const double column = LEFT + SWATCH + 7, shadow = 42;
    set_colour(cairo, 0xffffff);
    cairo_paint(cairo);
    put_title(card, cairo);
    put_colours(card, cairo, column);
    put_figures(card, cairo, column);
    put_pictures(card, cairo);
    put_shadow(card, cairo, LEFT, FOOT_Y, shadow);
    char *words = g_strconcat(card->notes, card->unused[0] ? "Not used: " : "", card->unused, NULL);
    put_fitted(cairo, LEFT + shadow + 10, FOOT_Y, BOTTOM - FOOT_Y, words);
    g_free(words);
}
