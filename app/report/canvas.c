#include "app/report/canvas.h"

#include "app/report/text.h"

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
                bytes[3 * ((ptrdiff_t)row * canvas->width + column) + c] = (uint8_t)(colour >> (16 - 8 * c));
}

void tl_canvas_text(tl_image *canvas, int x, int y, const char *text, uint32_t colour)
{
    tl_text_draw(canvas, x, y, &(const struct tl_text_style){.size = TL_CANVAS_LETTER, .colour = colour},
                 text);
}

int tl_canvas_text_width(const char *text)
{
    return tl_text_measure(&(const struct tl_text_style){.size = TL_CANVAS_LETTER}, text).width;
}
