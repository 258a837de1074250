#include "app/lab/gallery/panels.h"

#include "app/report/canvas.h"
#include "app/report/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PAPER      0xffffffu
#define INK        0x202428u
#define OPEN       0xd4d6d8u /* where neither picture shows anything */
#define FRAME      0x18b4ffu /* around what is magnified */
#define MARGIN     6
#define BAND       (TL_CANVAS_LETTER + 2 * MARGIN) /* a line of text, or a scale below a row */
#define HEADS      (BAND + LEADING)                /* of two lines */
#define HEAD_LINES 2
#define LEADING    (TL_CANVAS_LETTER + MARGIN)

/* What is magnified: a square of 1/ZOOM_PART of the picture's side, ZOOM times. Exact and technique stand one
 * above the other, so that both together are as high as the picture. */
#define ZOOM      4
#define ZOOM_PART (2 * ZOOM)

/* Of the covered pixels this share may differ by more than the scale's end: one pixel on an outline would
 * else make all other differences black. */
#define BEYOND 1e-3

void tl_gallery_shot_release(struct tl_gallery_shot *shot)
{
    tl_image_release(&shot->light);
    tl_image_release(&shot->shown);
    *shot = (struct tl_gallery_shot){0};
}

/* ---- Differences ---- */

static bool is_covered(const struct tl_panel_row *row, size_t pixel)
{
    return tl_image_floats(&row->exact->light)[4 * pixel + 3] > 0 ||
           tl_image_floats(&row->tested->light)[4 * pixel + 3] > 0;
}

/* The largest difference of the three channels. */
static float difference_at(const struct tl_panel_row *row, size_t pixel)
{
    const float *a = tl_image_floats(&row->tested->light) + 4 * pixel,
                *b = tl_image_floats(&row->exact->light) + 4 * pixel;
    return fmaxf(fabsf(a[0] - b[0]), fmaxf(fabsf(a[1] - b[1]), fabsf(a[2] - b[2])));
}

static size_t pixels_of(const struct tl_panel_row *row)
{
    return (size_t)row->exact->light.width * (size_t)row->exact->light.height;
}

/* Pixels that are covered and differ by more than `limit`. */
static size_t count_beyond(const struct tl_panel_row *rows, int count, float limit)
{
    size_t found = 0;
    for (int r = 0; r < count; r++)
        for (size_t i = 0; i < pixels_of(&rows[r]); i++)
            found += is_covered(&rows[r], i) && difference_at(&rows[r], i) > limit;
    return found;
}

double tl_panels_end(const struct tl_panel_row *rows, int count)
{
    static const double mantissas[] = {1, 2, 5};
    size_t covered = count_beyond(rows, count, -1);
    if (count_beyond(rows, count, 0) == 0)
        return 0;
    for (int decade = -7; decade < 5; decade++)
        for (int m = 0; m < 3; m++) {
            double end = mantissas[m] * pow(10, decade);
            if ((double)count_beyond(rows, count, (float)end) <= BEYOND * (double)covered)
                return end;
        }
    return 1e5;
}

/* Dark to light through violet, red and yellow, its lightness rising evenly ("inferno" of matplotlib). */
static uint32_t colour_of(double share)
{
    static const uint8_t stops[][3] = {{0, 0, 4},     {40, 11, 84},   {101, 21, 110}, {159, 42, 99},
                                       {212, 72, 66}, {245, 125, 21}, {250, 193, 39}, {252, 255, 164}};
    const int last = (int)(sizeof stops / sizeof stops[0]) - 1;
    double at = fmin(fmax(share, 0), 1) * last;
    int low = at < last ? (int)at : last - 1;
    uint32_t colour = 0;
    for (int c = 0; c < 3; c++) {
        double value = stops[low][c] + (at - low) * (stops[low + 1][c] - stops[low][c]);
        colour = colour << 8 | (uint32_t)lrint(value);
    }
    return colour;
}

static tl_image difference_of(const struct tl_panel_row *row, double end)
{
    tl_image image = tl_canvas_create(row->exact->light.width, row->exact->light.height, OPEN);
    for (size_t i = 0; i < pixels_of(row); i++) {
        if (!is_covered(row, i))
            continue;
        uint32_t colour = colour_of(end > 0 ? (double)difference_at(row, i) / end : 0);
        for (size_t c = 0; c < 3; c++)
            tl_image_bytes(&image)[3 * i + c] = (uint8_t)(colour >> (16 - 8 * c));
    }
    return image;
}

/* The upper left corner of the square of `side` pixels that holds the largest sum of differences; the middle
 * where there are none. Squares overlap by three quarters. */
static void find_worst(const struct tl_panel_row *row, int side, int *x, int *y)
{
    int width = row->exact->light.width, height = row->exact->light.height, step = side / 4;
    double largest = 0;
    *x = (width - side) / 2;
    *y = (height - side) / 2;
    for (int top = 0; top + side <= height; top += step)
        for (int left = 0; left + side <= width; left += step) {
            double sum = 0;
            for (int i = 0; i < side * side; i++) {
                size_t pixel = (size_t)(top + i / side) * (size_t)width + (size_t)(left + i % side);
                sum += (double)difference_at(row, pixel);
            }
            if (sum > largest) {
                largest = sum;
                *x = left;
                *y = top;
            }
        }
}

/* ---- Pictures on the canvas ---- */

static void paste(tl_image *onto, const tl_image *picture, int x, int y)
{
    for (int row = 0; row < picture->height; row++)
        memcpy(tl_image_bytes(onto) + 3 * ((size_t)(y + row) * (size_t)onto->width + (size_t)x),
               tl_image_bytes(picture) + 3 * (size_t)row * (size_t)picture->width,
               3 * (size_t)picture->width);
}

static void paste_magnified(tl_image *onto, const tl_image *picture, int left, int top, int side, int x,
                            int y)
{
    for (int row = 0; row < side * ZOOM; row++)
        for (int column = 0; column < side * ZOOM; column++) {
            size_t from =
                (size_t)(top + row / ZOOM) * (size_t)picture->width + (size_t)(left + column / ZOOM);
            size_t to = (size_t)(y + row) * (size_t)onto->width + (size_t)(x + column);
            memcpy(tl_image_bytes(onto) + 3 * to, tl_image_bytes(picture) + 3 * from, 3);
        }
}

static void draw_frame(tl_image *canvas, int x, int y, int side)
{
    tl_canvas_box(canvas, x - 1, y - 1, side + 2, 1, FRAME);
    tl_canvas_box(canvas, x - 1, y + side, side + 2, 1, FRAME);
    tl_canvas_box(canvas, x - 1, y, 1, side, FRAME);
    tl_canvas_box(canvas, x + side, y, 1, side, FRAME);
}

static void draw_head(tl_image *canvas, int x, int y, int width, const char *text)
{
    const struct tl_text_style style = {.size = TL_CANVAS_LETTER, .colour = INK, .width = width - 2 * MARGIN};
    tl_text_draw(canvas, x + MARGIN, y + MARGIN, &style, text);
}

static struct tl_text_style column_head(int width, int lines)
{
    return (struct tl_text_style){.size = TL_CANVAS_LETTER,
                                  .colour = INK,
                                  .width = width - 2 * MARGIN,
                                  .lines = lines,
                                  .leading = LEADING};
}

bool tl_panels_head_fits(int side, const char *text)
{
    const struct tl_text_style style = column_head(side, HEAD_LINES + 1);
    return tl_text_measure(&style, text).lines <= HEAD_LINES;
}

/* In two lines where one is too short. */
static void draw_column_head(tl_image *canvas, int x, int width, const char *text)
{
    const struct tl_text_style style = column_head(width, HEAD_LINES);
    int above = tl_text_measure(&style, text).lines < 2 ? LEADING : 0; /* heads end above their pictures */
    tl_text_draw(canvas, x + MARGIN, above + MARGIN, &style, text);
}

/* A bar of the scale's colours between its ends in numbers, with their unit. */
static void draw_scale(tl_image *canvas, int x, int y, int width, double end)
{
    char high[48];
    if (!(end > 0)) {
        draw_head(canvas, x, y, width, "equal in every bit");
        return;
    }
    snprintf(high, sizeof high, "%g  linear radiance", end);
    int low_width = tl_canvas_text_width("0"), bar = x + low_width + 2 * MARGIN;
    int length = width - low_width - tl_canvas_text_width(high) - 5 * MARGIN;
    tl_canvas_text(canvas, x + MARGIN, y + MARGIN, "0", INK);
    for (int i = 0; i < length; i++)
        tl_canvas_box(canvas, bar + i, y + MARGIN, 1, TL_CANVAS_LETTER,
                      colour_of((double)i / (length > 1 ? length - 1 : 1)));
    tl_canvas_text(canvas, bar + (length > 0 ? length : 0) + MARGIN, y + MARGIN, high, INK);
}

static void draw_row(tl_image *canvas, const struct tl_panel_row *row, int side, int y, double end)
{
    int part = side / ZOOM_PART, left, top;
    find_worst(row, part, &left, &top);
    tl_image differs = difference_of(row, end);
    const tl_image *panels[] = {&row->exact->shown, &row->tested->shown, &differs};
    for (int i = 0; i < 3; i++) {
        paste(canvas, panels[i], i * side, y);
        draw_frame(canvas, i * side + left, y + top, part);
    }
    tl_image_release(&differs);
    paste_magnified(canvas, &row->exact->shown, left, top, part, 3 * side, y);
    paste_magnified(canvas, &row->tested->shown, left, top, part, 3 * side, y + part * ZOOM);
    tl_canvas_box(canvas, 3 * side, y + part * ZOOM, part * ZOOM, 1, PAPER);
    draw_scale(canvas, 2 * side, y + side, side, end);
}

void tl_panels_size(int count, int side, int *width, int *height)
{
    *width = 3 * side + side / ZOOM_PART * ZOOM;
    *height = HEADS + count * (side + BAND);
}

tl_image tl_panels_make(const struct tl_panel_row *rows, int count, int side, const char *exact,
                        const char *tested, double end)
{
    int width, height;
    tl_panels_size(count, side, &width, &height);
    tl_image canvas = tl_canvas_create(width, height, PAPER);
    draw_column_head(&canvas, 0, side, exact);
    draw_column_head(&canvas, side, side, tested);
    draw_column_head(&canvas, 2 * side, side, "their difference");
    draw_column_head(&canvas, 3 * side, width - 3 * side, "4 x larger");
    for (int i = 0; i < count; i++)
        draw_row(&canvas, &rows[i], side, HEADS + i * (side + BAND), end);
    return canvas;
}

/* ---- Strips ---- */

void tl_panels_strip_size(int count, int side, int *width, int *height)
{
    *width = count * side;
    *height = 2 * (side + BAND);
}

tl_image tl_panels_strip(const struct tl_gallery_shot *exact, const struct tl_gallery_shot *tested, int count,
                         int side, const char *exact_head, const char *tested_head)
{
    int width, height;
    tl_panels_strip_size(count, side, &width, &height);
    tl_image canvas = tl_canvas_create(width, height, PAPER);
    const struct tl_gallery_shot *const rows[2] = {exact, tested};
    const char *const heads[2] = {exact_head, tested_head};
    for (int r = 0; r < 2; r++) {
        draw_head(&canvas, 0, r * (side + BAND), width, heads[r]);
        for (int i = 0; i < count; i++)
            paste(&canvas, &rows[r][i].shown, i * side, r * (side + BAND) + BAND);
    }
    return canvas;
}
