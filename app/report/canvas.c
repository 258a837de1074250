#include "app/report/canvas.h"

#include "config/memory.h"

#include <stb_easy_font.h>

#include <stdlib.h>
#include <string.h>

#define SCALE 2 /* pixels of a pixel of the font */

tl_image tl_canvas_create(int width, int height, uint32_t colour)
{
    tl_image canvas = tl_image_create(width, height, 3, TL_IMAGE_U8);
    tl_canvas_box(&canvas, 0, 0, width, height, colour);
    return canvas;
}

void tl_canvas_box(tl_image *canvas, int x, int y, int width, int height, uint32_t colour)
{
    uint8_t *bytes = tl_image_bytes(canvas);
    for (int row = y < 0 ? 0 : y; row < y + height && row < canvas->height; row++)
        for (int column = x < 0 ? 0 : x; column < x + width && column < canvas->width; column++)
            for (int c = 0; c < 3; c++)
                bytes[3 * (row * canvas->width + column) + c] = (uint8_t)(colour >> (16 - 8 * c));
}

/* A corner as stb_easy_font writes it. */
struct corner {
    float x, y, z;
    uint8_t colour[4];
};

void tl_canvas_words(tl_image *canvas, int x, int y, int scale, const char *text, uint32_t colour)
{
    const size_t letter_bytes = 270; /* as the font's documentation says, on average; 500 is never exceeded */
    size_t bytes = (strlen(text) + 1) * 2 * letter_bytes;
    struct corner *corners = tl_alloc(bytes, 1);
    char *copy = tl_copy_string(text); /* the font's interface is not const */
    int quads = stb_easy_font_print(0, 0, copy, NULL, corners, (int)bytes);
    for (int i = 0; i < quads; i++) {
        const struct corner *first = corners + 4 * (ptrdiff_t)i, *third = first + 2;
        tl_canvas_box(canvas, x + scale * (int)first->x, y + scale * (int)first->y,
                      scale * (int)(third->x - first->x), scale * (int)(third->y - first->y), colour);
    }
    free(copy);
    free(corners);
}

int tl_canvas_words_width(int scale, const char *text)
{
    char *copy = tl_copy_string(text);
    int width = scale * stb_easy_font_width(copy);
    free(copy);
    return width;
}

void tl_canvas_text(tl_image *canvas, int x, int y, const char *text, uint32_t colour)
{
    tl_canvas_words(canvas, x, y, SCALE, text, colour);
}

int tl_canvas_text_width(const char *text)
{
    return tl_canvas_words_width(SCALE, text);
}
