/* Solids as distance functions: smooth unions and cuts. Metres. Threads: pure. */
#ifndef TOILE_ASSETS_BODY_SOLID_H
#define TOILE_ASSETS_BODY_SOLID_H

#include <math.h>

/* Polynomial smooth minimum (Quilez), C1; the blend is k wide. */
static inline double tl_smooth_min(double a, double b, double k)
{
    double h = fmax(k - fabs(a - b), 0) / k;
    return fmin(a, b) - h * h * k * 0.25;
}

static inline double tl_smooth_max(double a, double b, double k)
{
    return -tl_smooth_min(-a, -b, k);
}

#endif
