#include "assets/specimen/cusick.h"

#include <math.h>

#define TEXEL_M (TL_CUSICK_SIDE_M / TL_CUSICK_SHADOW)

static double side_of_edge(const double a[2], const double b[2], double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void shade_triangle(const double corners[3][2], tl_image *shadow)
{
    double low[2], high[2];
    for (int k = 0; k < 2; k++) {
        low[k] = fmax(floor(fmin(fmin(corners[0][k], corners[1][k]), corners[2][k])), 0);
        high[k] = fmin(fmax(fmax(corners[0][k], corners[1][k]), corners[2][k]), TL_CUSICK_SHADOW - 1);
    }
    for (int row = (int)low[1]; row <= (int)high[1]; row++)
        for (int column = (int)low[0]; column <= (int)high[0]; column++) {
            double x = column + 0.5, y = row + 0.5;
            double a = side_of_edge(corners[0], corners[1], x, y);
            double b = side_of_edge(corners[1], corners[2], x, y);
            double c = side_of_edge(corners[2], corners[0], x, y);
            if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0))
                tl_image_bytes(shadow)[row * TL_CUSICK_SHADOW + column] = 1;
        }
}

tl_image tl_cusick_shadow(const tl_garment *disc, const vec3s *positions)
{
    tl_image shadow = tl_image_create(TL_CUSICK_SHADOW, TL_CUSICK_SHADOW, 1, TL_IMAGE_U8);
    const tl_mesh *mesh = &disc->model.mesh;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        double corners[3][2];
        for (int k = 0; k < 3; k++) {
            vec3s position = positions[mesh->indices[i + (size_t)k]];
            corners[k][0] = (double)position.x / TEXEL_M + TL_CUSICK_SHADOW / 2.0;
            corners[k][1] = (double)position.z / TEXEL_M + TL_CUSICK_SHADOW / 2.0;
        }
        shade_triangle(corners, &shadow);
    }
    return shadow;
}

double tl_cusick_coefficient(const tl_image *shadow)
{
    const double plate = M_PI * TL_CUSICK_PLATE_M * TL_CUSICK_PLATE_M;
    const double whole = M_PI * TL_CUSICK_DISC_M * TL_CUSICK_DISC_M;
    size_t count = 0;
    for (size_t i = 0; i < (size_t)TL_CUSICK_SHADOW * TL_CUSICK_SHADOW; i++)
        count += tl_image_bytes(shadow)[i];
    return ((double)count * TEXEL_M * TEXEL_M - plate) / (whole - plate);
}

int tl_cusick_folds(const tl_garment *disc, const vec3s *positions)
{
    const tl_mesh *mesh = &disc->model.mesh;
    double strongest = 0;
    int folds = 0;
    for (int wave = 2; wave <= 16; wave++) {
        double c = 0, s = 0;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            double x = (double)mesh->positions[i].x, z = (double)mesh->positions[i].z;
            if (hypot(x, z) < 0.999 * TL_CUSICK_DISC_M)
                continue;
            double turn = wave * atan2(z, x);
            c += (double)positions[i].y * cos(turn);
            s += (double)positions[i].y * sin(turn);
        }
        folds = hypot(c, s) > strongest ? wave : folds;
        strongest = fmax(strongest, hypot(c, s));
    }
    return folds;
}
