#include "app/sheet/contact_layout.h"

#include "app/report/canvas.h"
#include "app/report/text.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MARGIN      28
#define GUTTER      6
#define GROUP_GAP   20
#define LINE        24 /* from one line of text to the next */
#define LABEL_MAX   260
#define LABEL_GAP   14
#define FLOW_ASPECT 1.5

#define PAPER 0xf6f4f0u
#define INK   0x1d2126u
#define SOFT  0x6b737bu
#define RULE  0xd8d3cau
#define EMPTY 0xe9e5deu

static bool same_group(const struct tl_contact_label *a, const struct tl_contact_label *b)
{
    return strcmp(a->group, b->group) == 0;
}

static bool begins_group(const struct tl_contact_label *labels, size_t i)
{
    return labels[i].group[0] && (i == 0 || !same_group(&labels[i], &labels[i - 1]));
}

static bool has_names(const struct tl_contact_label *labels, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (labels[i].name[0])
            return true;
    return false;
}

static bool has_groups(const struct tl_contact_label *labels, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (labels[i].group[0])
            return true;
    return false;
}

static bool flows(const struct tl_contact_grid *grid)
{
    return grid->column_count == 1 && grid->row_count > 2;
}

/* Cells in a line of a sheet with one column. The number of lines is what gives the sheet the aspect
 * FLOW_ASPECT; the cells are then spread evenly over these lines, so that the last is not short. */
static size_t cells_across(const struct tl_contact_grid *grid)
{
    double cells = (double)grid->row_count * grid->cell_height / grid->cell_width;
    size_t lines = (size_t)ceil((double)grid->row_count / ceil(sqrt(FLOW_ASPECT * cells)));
    return (grid->row_count + lines - 1) / lines;
}

/* Text in a width, which ends in an ellipsis where it is too long. */
static struct tl_text_style style_of(int width, enum tl_text_align align, uint32_t colour)
{
    return (struct tl_text_style){.size = TL_CANVAS_LETTER, .colour = colour, .width = width, .align = align};
}

/* The width of the column of row labels; 0 where there are none. */
static int label_width(const struct tl_contact_grid *grid)
{
    int widest = 0;
    const struct tl_text_style style = style_of(LABEL_MAX, TL_TEXT_LEFT, INK);
    for (size_t i = 0; i < grid->row_count && !flows(grid); i++) {
        int width = tl_text_measure(&style, grid->rows[i].name).width;
        widest = width > widest ? width : widest;
    }
    return widest ? widest + LABEL_GAP : 0;
}

static int head_height(const struct tl_contact_grid *grid)
{
    int height = MARGIN + LINE + (grid->note[0] ? LINE : 0) + LINE / 2;
    if (flows(grid))
        return height;
    height += has_groups(grid->columns, grid->column_count) ? LINE : 0;
    return height + (has_names(grid->columns, grid->column_count) ? LINE : 0);
}

static int64_t column_x(const struct tl_contact_grid *grid, size_t column)
{
    int64_t x = MARGIN + label_width(grid);
    for (size_t i = 1; i <= column; i++)
        x += grid->cell_width + (begins_group(grid->columns, i) ? GROUP_GAP : GUTTER);
    return x;
}

/* The top of a row's cells. In a sheet with one column also the cell's place in its line. */
static int64_t row_y(const struct tl_contact_grid *grid, size_t row, size_t *place_in_line)
{
    int64_t y = head_height(grid);
    size_t across = flows(grid) ? cells_across(grid) : 1, in_line = 0;
    int below = flows(grid) && has_names(grid->rows, grid->row_count) ? LINE + GUTTER : GUTTER;
    for (size_t i = 0; i <= row; i++) {
        bool begins = begins_group(grid->rows, i), next_line = i > 0 && (begins || in_line == across);
        if (next_line) {
            y += grid->cell_height + below;
            in_line = 0;
        }
        if (begins)
            y += LINE + (i > 0 ? GROUP_GAP : 0);
        in_line++;
    }
    *place_in_line = in_line - 1;
    return y;
}

void tl_contact_place(const struct tl_contact_grid *grid, size_t row, size_t column, int *x, int *y)
{
    size_t in_line;
    *y = (int)row_y(grid, row, &in_line);
    *x = (int)column_x(grid, column) + (int)in_line * (flows(grid) ? grid->cell_width + GUTTER : 0);
}

static int64_t greater(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

void tl_contact_size(const struct tl_contact_grid *grid, int64_t *width, int64_t *height)
{
    size_t in_line, across = flows(grid) ? cells_across(grid) : 1;
    int64_t right = column_x(grid, grid->column_count - 1) + grid->cell_width;
    right += (int64_t)(across - 1) * (grid->cell_width + GUTTER);
    *height = row_y(grid, grid->row_count - 1, &in_line) + grid->cell_height + MARGIN;
    if (flows(grid) && has_names(grid->rows, grid->row_count))
        *height += LINE;
    const char *lines[] = {grid->title, grid->note};
    for (size_t i = 0; i < TL_COUNT(lines); i++)
        right = greater(right, MARGIN + tl_canvas_text_width(lines[i]));
    *width = right + MARGIN;
}

static void write_text(tl_image *sheet, int x, int y, const char *text, int width, uint32_t colour)
{
    const struct tl_text_style style = style_of(width, TL_TEXT_LEFT, colour);
    tl_text_draw(sheet, x, y, &style, text);
}

static void write_centred(tl_image *sheet, int x, int y, const char *text, int width)
{
    const struct tl_text_style style = style_of(width, TL_TEXT_CENTRE, INK);
    tl_text_draw(sheet, x, y, &style, text);
}

static void draw_heads(const struct tl_contact_grid *grid, tl_image *sheet)
{
    int y = head_height(grid);
    bool names = has_names(grid->columns, grid->column_count);
    for (size_t i = 0; i < grid->column_count; i++) {
        int x = (int)column_x(grid, i);
        if (names)
            write_centred(sheet, x, y - LINE, grid->columns[i].name, grid->cell_width);
        if (!begins_group(grid->columns, i))
            continue;
        size_t last = i;
        while (last + 1 < grid->column_count && !begins_group(grid->columns, last + 1))
            last++;
        int width = (int)column_x(grid, last) + grid->cell_width - x, top = y - (names ? 2 : 1) * LINE;
        write_text(sheet, x, top, grid->columns[i].group, width, SOFT);
        tl_canvas_box(sheet, x, top + LINE - 7, width, 1, RULE);
    }
}

static void draw_row_label(const struct tl_contact_grid *grid, size_t row, tl_image *sheet)
{
    int x, y;
    tl_contact_place(grid, row, 0, &x, &y);
    if (begins_group(grid->rows, row)) {
        write_text(sheet, MARGIN, y - LINE, grid->rows[row].group, sheet->width - 2 * MARGIN, INK);
        tl_canvas_box(sheet, MARGIN, y - 7, sheet->width - 2 * MARGIN, 1, RULE);
    }
    if (flows(grid)) {
        write_centred(sheet, x, y + grid->cell_height + 6, grid->rows[row].name, grid->cell_width);
        return;
    }
    if (!grid->rows[row].name[0])
        return;
    const struct tl_text_style style = style_of(x - LABEL_GAP - MARGIN, TL_TEXT_RIGHT, INK);
    tl_text_draw(sheet, MARGIN, y + (grid->cell_height - TL_CANVAS_LETTER) / 2, &style, grid->rows[row].name);
}

tl_image tl_contact_draw(const struct tl_contact_grid *grid)
{
    int64_t width, height;
    tl_contact_size(grid, &width, &height);
    tl_image sheet = tl_canvas_create((int)width, (int)height, PAPER);
    write_text(&sheet, MARGIN, MARGIN, grid->title, (int)width - 2 * MARGIN, INK);
    write_text(&sheet, MARGIN, MARGIN + LINE, grid->note, (int)width - 2 * MARGIN, SOFT);
    if (!flows(grid))
        draw_heads(grid, &sheet);
    for (size_t i = 0; i < grid->row_count; i++)
        draw_row_label(grid, i, &sheet);
    return sheet;
}

void tl_contact_paste(const struct tl_contact_grid *grid, size_t row, size_t column, const tl_image *picture,
                      tl_image *sheet)
{
    int x, y;
    tl_contact_place(grid, row, column, &x, &y);
    size_t channels = (size_t)picture->channels;
    for (int line = 0; line < picture->height && line < grid->cell_height; line++)
        for (int i = 0; i < picture->width && i < grid->cell_width; i++) {
            const uint8_t *from =
                tl_image_bytes(picture) + channels * ((size_t)line * (size_t)picture->width + (size_t)i);
            uint8_t *to =
                tl_image_bytes(sheet) + 3 * ((size_t)(y + line) * (size_t)sheet->width + (size_t)(x + i));
            memcpy(to, from, 3);
        }
}

void tl_contact_mark_empty(const struct tl_contact_grid *grid, size_t row, size_t column, tl_image *sheet)
{
    int x, y;
    tl_contact_place(grid, row, column, &x, &y);
    tl_canvas_box(sheet, x, y, grid->cell_width, grid->cell_height, EMPTY);
    for (int i = 0; i < grid->cell_width; i++) {
        int line = (int)((int64_t)i * (grid->cell_height - 1) / grid->cell_width);
        tl_canvas_box(sheet, x + i, y + line, 1, 2, RULE);
        tl_canvas_box(sheet, x + i, y + grid->cell_height - 2 - line, 1, 2, RULE);
    }
    write_centred(sheet, x, y + (grid->cell_height - TL_CANVAS_LETTER) / 2, "refused", grid->cell_width);
}
