#include "app/report/legend.h"

#include "app/report/canvas.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* In dots, the smallest letters' pixels. */
enum {
    MARGIN = 5,
    PADDING = 5,
    LETTER = 7,
    LINE = 11,
    TEXT_WIDTH = 170,
    BAR_HEIGHT = 8,
    TICKS = 5,
    COLUMNS = 2
};
enum { LINES_MAX = 8, LINE_SIZE = 64, LARGE_PICTURE = 800 };
#define PAPER 0x181818
#define INK   0xf0f0f0

/* Where it is drawn, and how large. */
struct sheet {
    tl_image *picture;
    int dot; /* pixels of a dot */
    int line_count;
    char lines[LINES_MAX][LINE_SIZE];
};

/* Words of `text` in lines of at most TEXT_WIDTH. */
static void wrap(const char *text, struct sheet *sheet)
{
    char word[LINE_SIZE], *line = NULL;
    int length;
    for (const char *at = text; sscanf(at, "%63s%n", word, &length) == 1; at += length) {
        size_t used = line ? strlen(line) : 0;
        bool fits =
            line && used + 1 + strlen(word) < LINE_SIZE &&
            tl_canvas_words_width(1, line) + tl_canvas_words_width(1, " ") + tl_canvas_words_width(1, word) <=
                TEXT_WIDTH;
        if (!fits && sheet->line_count == LINES_MAX)
            return;
        if (fits) {
            line[used] = ' ';
            memcpy(line + used + 1, word, strlen(word) + 1);
        } else {
            line = sheet->lines[sheet->line_count++];
            memcpy(line, word, strlen(word) + 1);
        }
    }
}

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

static void words(const struct sheet *sheet, int x, int y, const char *text)
{
    tl_canvas_words(sheet->picture, x * sheet->dot, y, sheet->dot, text, INK);
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
    for (int tick = 0; tick < TICKS; tick++) {
        char number[16];
        int at = tick * (TEXT_WIDTH - 1) / (TICKS - 1);
        tl_legend_number(legend, legend->low + span * (float)tick / (TICKS - 1), number);
        int width = tl_canvas_words_width(1, number), left = at - width / 2;
        left = left < 0 ? 0 : left + width > TEXT_WIDTH ? TEXT_WIDTH - width : left;
        box(sheet, x + at, below, 1, 2, INK);
        words(sheet, x + left, below + 3 * sheet->dot, number);
    }
}

static void draw_entries(const struct sheet *sheet, const struct tl_legend *legend, int y)
{
    for (int i = 0; i < legend->entry_count; i++) {
        int x = MARGIN + PADDING + i % COLUMNS * TEXT_WIDTH / COLUMNS,
            row = y + i / COLUMNS * LINE * sheet->dot;
        box(sheet, x, row, LETTER, LETTER, packed(legend->entries[i].colour));
        words(sheet, x + LINE, row, legend->entries[i].label);
    }
}

bool tl_legend_draw(const struct tl_legend *legend, tl_image *picture)
{
    if (legend->title[0] == '\0')
        return true;
    char title[96];
    struct sheet sheet = {.picture = picture, .dot = picture->width < LARGE_PICTURE ? 1 : 2};
    snprintf(title, sizeof title, "%s%s%s", legend->title, legend->unit[0] ? ", " : "", legend->unit);
    wrap(title, &sheet);
    wrap(legend->note, &sheet);
    int rows = sheet.line_count + (legend->entry_count + COLUMNS - 1) / COLUMNS;
    int scale = legend->stop_count > 0 ? BAR_HEIGHT + LINE + PADDING : 0;
    int width = 2 * PADDING + TEXT_WIDTH, height = 2 * PADDING + rows * LINE + scale;
    if ((width + 2 * MARGIN) * sheet.dot > picture->width || 2 * height * sheet.dot > picture->height)
        return false;
    int y = picture->height - (MARGIN + height) * sheet.dot;
    box(&sheet, MARGIN, y, width, height, PAPER);
    y += PADDING * sheet.dot;
    for (int i = 0; i < sheet.line_count; i++, y += LINE * sheet.dot)
        words(&sheet, MARGIN + PADDING, y, sheet.lines[i]);
    if (scale > 0)
        draw_scale(&sheet, legend, y);
    draw_entries(&sheet, legend, y + scale * sheet.dot);
    return true;
}
