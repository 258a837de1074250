#include "app/report/legend.h"

#include "app/report/canvas.h"
#include "app/report/text.h"

#include <math.h>
#include <stdio.h>

/* Sizes in pixels. */
enum {
    MARGIN = 5,
    PADDING = 5,
    TEXT_SIZE = 10,
    LINE = 12,
    TEXT_WIDTH = 170,
    BAR_HEIGHT = 8,
    TICK_HEIGHT = 2,
    TICKS = 5,
    SWATCH = 7,
    COLUMNS = 2,
    COLUMN_WIDTH = TEXT_WIDTH / COLUMNS,
    COLUMN_GAP = 4
};
enum { LINES_MAX = 6, LARGE_PICTURE = 800 };
#define PAPER 0x181818
#define INK   0xf0f0f0

/* The picture, and the legend's unit of length. */
struct sheet {
    tl_image *picture;
    int dot; /* pixels of a dot */
};

static uint32_t packed(vec3s colour)
{
    uint32_t bytes = 0;
    for (int c = 0; c < 3; c++)
        bytes = bytes << 8 | (uint32_t)lroundf(255 * fminf(fmaxf(colour.raw[c], 0), 1));
    return bytes;
}

/* Places and sizes in dots; x from the left, y from the top of the picture in pixels. */
static void box(const struct sheet *sheet, int x, int y, int width, int height, uint32_t colour)
{
    tl_canvas_box(sheet->picture, x * sheet->dot, y, width * sheet->dot, height * sheet->dot, colour);
}

/* Text at most `width` dots wide, in at most `lines` lines. */
static struct tl_text_style style_of(const struct sheet *sheet, int width, int lines)
{
    return (struct tl_text_style){.size = TEXT_SIZE * sheet->dot,
                                  .colour = INK,
                                  .width = width * sheet->dot,
                                  .lines = lines,
                                  .leading = LINE * sheet->dot};
}

void tl_legend_number(const struct tl_legend *legend, float value, char out[16])
{
    const float rounding = 1e-3f;
    float span = legend->high - legend->low;
    snprintf(out, 16, "%.3g", fabsf(value) < rounding * span ? 0 : (double)value);
}

static void draw_scale(const struct sheet *sheet, const struct tl_legend *legend, int y)
{
    float span = legend->high - legend->low;
    int x = MARGIN + PADDING, below = y + BAR_HEIGHT * sheet->dot;
    for (int i = 0; i < TEXT_WIDTH; i++) {
        float value = legend->low + span * ((float)i + 0.5f) / TEXT_WIDTH;
        box(sheet, x + i, y, 1, BAR_HEIGHT, packed(tl_legend_colour(legend, value)));
    }
    const struct tl_text_style style = style_of(sheet, TEXT_WIDTH, 1);
    for (int tick = 0; tick < TICKS; tick++) {
        char number[16];
        int at = tick * (TEXT_WIDTH - 1) / (TICKS - 1);
        tl_legend_number(legend, legend->low + span * (float)tick / (TICKS - 1), number);
        /* Centred below its tick, but within the bar's ends. */
        int width = tl_text_measure(&style, number).width, last = style.width - width;
        int left = at * sheet->dot - width / 2;
        left = left < 0 ? 0 : left > last ? last : left;
        box(sheet, x + at, below, 1, TICK_HEIGHT, INK);
        tl_text_draw(sheet->picture, x * sheet->dot + left, below + (TICK_HEIGHT + 1) * sheet->dot, &style,
                     number);
    }
}

static void draw_entries(const struct sheet *sheet, const struct tl_legend *legend, int y)
{
    for (int i = 0; i < legend->entry_count; i++) {
        int column = i % COLUMNS, row = y + i / COLUMNS * LINE * sheet->dot;
        int x = MARGIN + PADDING + column * COLUMN_WIDTH;
        bool is_last_of_row = column + 1 == COLUMNS || i + 1 == legend->entry_count;
        int room = (is_last_of_row ? TEXT_WIDTH - column * COLUMN_WIDTH : COLUMN_WIDTH - COLUMN_GAP) - LINE;
        const struct tl_text_style style = style_of(sheet, room, 1);
        box(sheet, x, row + sheet->dot, SWATCH, SWATCH, packed(legend->entries[i].colour));
        tl_text_draw(sheet->picture, (x + LINE) * sheet->dot, row, &style, legend->entries[i].label);
    }
}

bool tl_legend_draw(const struct tl_legend *legend, tl_image *picture)
{
    if (legend->title[0] == '\0')
        return true;
    const struct sheet sheet = {.picture = picture, .dot = picture->width < LARGE_PICTURE ? 1 : 2};
    const struct tl_text_style style = style_of(&sheet, TEXT_WIDTH, LINES_MAX);
    char title[96];
    snprintf(title, sizeof title, "%s%s%s", legend->title, legend->unit[0] ? ", " : "", legend->unit);
    int title_rows = tl_text_measure(&style, title).lines;
    int note_rows = legend->note[0] ? tl_text_measure(&style, legend->note).lines : 0;
    int rows = title_rows + note_rows + (legend->entry_count + COLUMNS - 1) / COLUMNS;
    int scale = legend->stop_count > 0 ? BAR_HEIGHT + LINE + PADDING : 0;
    int width = 2 * PADDING + TEXT_WIDTH, height = 2 * PADDING + rows * LINE + scale;
    if ((width + 2 * MARGIN) * sheet.dot > picture->width || 2 * height * sheet.dot > picture->height)
        return false;
    int x = (MARGIN + PADDING) * sheet.dot, y = picture->height - (MARGIN + height) * sheet.dot;
    box(&sheet, MARGIN, y, width, height, PAPER);
    y += PADDING * sheet.dot;
    tl_text_draw(picture, x, y, &style, title);
    y += title_rows * style.leading;
    tl_text_draw(picture, x, y, &style, legend->note);
    y += note_rows * style.leading;
    if (scale > 0)
        draw_scale(&sheet, legend, y);
    draw_entries(&sheet, legend, y + scale * sheet.dot);
    return true;
}
