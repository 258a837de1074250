/* The reference for height fields, by their definition. */
#ifndef TOILE_TESTS_HEIGHT_ORACLE_H
#define TOILE_TESTS_HEIGHT_ORACLE_H

#include "render/detail/field.h"

#include <math.h>

/* The height (m) of the bilinear field at (u, v), in repeats, computed in double. */
static inline double height_at(const struct tl_height_field *field, double u, double v)
{
    int width = field->heights->width, height = field->heights->height;
    double x = (u - floor(u)) * width - 0.5, y = (v - floor(v)) * height - 0.5, sum = 0;
    int column = (int)floor(x), row = (int)floor(y);
    for (int i = 0; i < 4; i++) {
        int at_x = column + (i & 1), at_y = row + (i >> 1);
        double share = (1 - fabs(at_x - x)) * (1 - fabs(at_y - y));
        size_t texel = (size_t)((at_y + height) % height) * (size_t)width + (size_t)((at_x + width) % width);
        sum += share * (double)tl_image_floats(field->heights)[texel];
    }
    return field->turned_over ? -sum : sum;
}

#endif
