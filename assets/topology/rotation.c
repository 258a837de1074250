#include "assets/topology/rotation.h"

#include <math.h>
#include <string.h>

/* The eigenvector of a symmetric matrix's largest eigenvalue, by repeated squaring: a shift by the sum of
 * |entries| makes all eigenvalues positive, so that in the power 2^SQUARINGS the largest one dominates; every
 * column is then the eigenvector. The longest column is taken, as others may vanish. */
#define SQUARINGS 40
static void largest_eigenvector(double m[4][4], double out[4])
{
    double shift = 0, norm;
    for (int i = 0; i < 16; i++)
        shift += fabs(m[i / 4][i % 4]);
    for (int i = 0; i < 4; i++)
        m[i][i] += shift;
    for (int round = 0; round < SQUARINGS; round++) {
        double squared[4][4] = {0};
        norm = 0;
        for (int i = 0; i < 64; i++)
            squared[i / 16][i / 4 % 4] += m[i / 16][i % 4] * m[i % 4][i / 4 % 4];
        for (int i = 0; i < 16; i++)
            norm = fmax(norm, fabs(squared[i / 4][i % 4]));
        for (int i = 0; i < 16; i++)
            m[i / 4][i % 4] = norm > 0 ? squared[i / 4][i % 4] / norm : 0;
    }
    int longest = 0;
    for (int i = 1; i < 4; i++)
        longest = m[i][i] > m[longest][longest] ? i : longest;
    norm = 0;
    for (int i = 0; i < 4; i++)
        norm += m[longest][i] * m[longest][i];
    for (int i = 0; i < 4; i++)
        out[i] = norm > 0 ? m[longest][i] / sqrt(norm) : i == 0;
}

static void set_centre(const vec3s *points, size_t count, double out[3])
{
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (size_t i = 0; i < count; i++)
            sum += (double)points[i].raw[c];
        out[c] = sum * (count > 0 ? 1 / (double)count : 0);
    }
}

struct tl_rotation tl_rotation_fit(const vec3s *from, const vec3s *to, size_t count)
{
    struct tl_rotation fit = {0};
    set_centre(from, count, fit.from);
    set_centre(to, count, fit.to);
    double s[3][3] = {0}, q[4];
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < 9; i++)
            s[i / 3][i % 3] +=
                ((double)from[k].raw[i / 3] - fit.from[i / 3]) * ((double)to[k].raw[i % 3] - fit.to[i % 3]);
    double n[4][4] = {{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
                      {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
                      {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
                      {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}};
    largest_eigenvector(n, q);
    const double rows[3][3] = {{1 - 2 * (q[2] * q[2] + q[3] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
                                2 * (q[1] * q[3] + q[0] * q[2])},
                               {2 * (q[1] * q[2] + q[0] * q[3]), 1 - 2 * (q[1] * q[1] + q[3] * q[3]),
                                2 * (q[2] * q[3] - q[0] * q[1])},
                               {2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
                                1 - 2 * (q[1] * q[1] + q[2] * q[2])}};
    memcpy(fit.rows, rows, sizeof rows);
    return fit;
}
