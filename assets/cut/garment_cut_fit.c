#include "assets/cut/garment_cut_internal.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

enum { MIN_PASSES = 100, PASSES_PER_PUSH = 4 };
#define SHORT_STIFFNESS 0.15 /* weak: slack cloth buckles instead of pushing its vertices apart */
#define SIDE_M          0.001
#define CLEARANCE_M     0.006 /* kept between the cloth and the body */

static void pull(double a[3], double b[3], bool a_fixed, bool b_fixed, double length)
{
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double now = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    double share = (a_fixed || b_fixed ? 1 : 0.5) * (now > length ? 1 : SHORT_STIFFNESS);
    double move = share * (now - length) / fmax(now, 1e-9);
    for (int k = 0; k < 3; k++) {
        a[k] += a_fixed ? 0 : move * d[k];
        b[k] -= b_fixed ? 0 : move * d[k];
    }
}

/* One Newton step along the distance's gradient towards the clearance; the distance is approximate. */
static void push_out(double p[3], struct tl_body_distance body)
{
    const double step = 1e-4;
    double distance = body.at(body.context, p), gradient[3], norm2 = 0;
    if (distance >= CLEARANCE_M)
        return;
    for (int k = 0; k < 3; k++) {
        double q[3] = {p[0], p[1], p[2]};
        q[k] += step;
        gradient[k] = (body.at(body.context, q) - distance) / step;
        norm2 += gradient[k] * gradient[k];
    }
    for (int k = 0; k < 3; k++)
        p[k] += (CLEARANCE_M - distance) * gradient[k] / fmax(norm2, 0.1);
}

void tl_cut_fit(double (*positions)[3], size_t count, const bool *fixed, const struct tl_fit_edge *edges,
                size_t edge_count, double reach_m, struct tl_body_distance distance, bool keeps_sides)
{
    double *side = TL_NEW_ARRAY(double, count); /* 1 left, -1 right, 0 in the middle */
    for (size_t i = 0; keeps_sides && i < count; i++)
        side[i] = positions[i][0] > SIDE_M ? 1 : positions[i][0] < -SIDE_M ? -1 : 0;
    double total = 0;
    for (size_t e = 0; e < edge_count; e++)
        total += edges[e].length;
    const int passes = (int)fmax(reach_m * (double)edge_count / total, MIN_PASSES);
    for (int pass = 0; pass < passes; pass++) {
        for (size_t e = 0; e < edge_count; e++)
            pull(positions[edges[e].a], positions[edges[e].b], fixed[edges[e].a], fixed[edges[e].b],
                 edges[e].length);
        if ((passes - 1 - pass) % PASSES_PER_PUSH) /* the last pass resolves penetration */
            continue;
        for (size_t i = 0; i < count; i++) {
            if (!fixed[i])
                push_out(positions[i], distance);
            if (side[i] * positions[i][0] < fabs(side[i]) * SIDE_M)
                positions[i][0] = side[i] * SIDE_M;
        }
    }
    free(side);
}
